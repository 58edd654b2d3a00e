"""The tissue file of what was identified: values, their standard uncertainties, and where they come from.

A value that is not determined stands without one: the curvature where a fit ended says nothing of it.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from benchmark.files import Layer, Tissue
from benchmark.files.tissue import Correlation, PronyTerm
from benchmark.identification.parameters.free_parameters import POISSON, SHARE, Parameter, with_values
from benchmark.identification.parameters.identified import NOT_DETERMINED, Identified
from benchmark.identification.pooling import counted_trials

MOST = 0.99
"""Largest relative uncertainty that a tissue file can carry."""
STATED = ("youngs_modulus", "thickness", "poisson_ratio")
"""Keys of a layer that carry an uncertainty; a law's constants and the relaxation are stated without one."""


def identified_tissue(answer: Identified, specimen: int = 0) -> Tissue:
    """The tissue of one specimen with what was found, each value with its standard uncertainty.

    Values that were told with an uncertainty stand as told; only what was free is changed.
    """
    found = answer.found
    problem = found.problem
    press = next(one for one in problem.presses if one.specimen == specimen)
    free = {k: one for k, one in enumerate(problem.parameters) if press.has(one) and not one.told}
    lost = {k for k, one in zip(problem.free, answer.estimates, strict=True) if one.standing == NOT_DETERMINED}
    sure = {k: one for k, one in free.items() if k not in lost}
    values = {one.key: found.value(k) for k, one in free.items() if not one.fading}
    tissue = with_values(press.setup, values, problem.law)[0]
    fading = {one.key: found.value(k) for k, one in free.items() if one.fading}
    told = press.session.specimen
    layers = tuple(
        _with_relaxation(layer, fading).keeping_uncertainties(
            {
                key: share
                for key, share in told.layer(layer.name).own_uncertainties.items()
                if f"{layer.name}.{key}" not in values
            }
            | _shares(answer, sure, layer.name)
        )
        for layer in tissue.layers
    )
    own = {one.key: k for k, one in sure.items() if one.key.rpartition(".")[2] in STATED}
    unknown = tuple(one.key.split(" [")[0] for one in answer.estimates if not one.identifiable)
    unknown = tuple(key for key in unknown if key.partition(".")[0] in tissue.layer_names)
    changes = {
        "name": f"{told.name}, identified"[:200],
        "layers": layers,
        "citation": provenance(answer),
        "correlations": _correlations(answer, own) or None,
        "not_determined": tuple(dict.fromkeys(unknown)) or None,
    }
    return tissue.model_copy(update=changes)


def _correlations(answer: Identified, own: dict[str, int]) -> tuple[Correlation, ...]:
    """Of each pair of values that stand with an uncertainty, keys and their numbers in the fit."""
    covariance, found = answer.found.fit.covariance, []
    for (first, i), (second, j) in combinations(own.items(), 2):
        size = float(np.sqrt(max(covariance[i, i] * covariance[j, j], 1e-300)))
        value = float(np.clip(covariance[i, j] / size, -1.0, 1.0)) * _way(first) * _way(second)
        found.append(Correlation(between=(first, second), value=round(value, 4)))
    return tuple(found)


def _way(key: str) -> float:
    """Whether a value rises or falls with its coordinate."""
    return -1.0 if key.endswith(POISSON) else 1.0


def _with_relaxation(layer: Layer, fading: dict[str, float]) -> Layer:
    """The layer with the Prony term that was found for it, or for all layers."""
    for start in (f"{layer.name}{SHARE.removesuffix('g')}", "relaxation."):
        if f"{start}g" in fading:
            term = PronyTerm(g=fading[f"{start}g"], tau=fading[f"{start}tau"])
            return layer.model_copy(update={"relaxation": (term,)})
    return layer


def _shares(answer: Identified, free: dict[int, Parameter], layer: str) -> dict[str, float]:
    """Relative standard uncertainties of a layer's free values that stand with one."""
    covariance, out = answer.found.fit.covariance, {}
    for k, one in free.items():
        name, _, key = one.key.rpartition(".")
        if name == layer and key in STATED:
            out[key] = min(_relative(one, float(answer.found.vector[k]), float(covariance[k, k]) ** 0.5), MOST)
    return out


def _relative(one: Parameter, at: float, deviation: float) -> float:
    """Standard uncertainty of a value as a share, from that of its coordinate; at least a part in a million."""
    step = 1e-4
    slope = (one.value(at + step) - one.value(at - step)) / (2.0 * step)
    return max(abs(slope) * deviation / one.value(at), 1e-6)


def provenance(answer: Identified) -> str:
    """Where the values come from, for the file's citation."""
    problem = answer.found.problem
    sessions = dict.fromkeys(press.session for press in problem.presses)
    kinds = {one: ", synthetic" if one.synthetic else "" for one in sessions}
    sources = ", ".join(f"{one.name} ({one.fingerprint[:16]}{kind})" for one, kind in kinds.items())
    unknown = [one.key for one in answer.estimates if one.standing == NOT_DETERMINED]
    said = f" {NOT_DETERMINED}: {', '.join(unknown)}." if unknown else ""
    return (
        f"Identified with the {problem.forward} model from {counted_trials(len(problem.trials))} of {sources}. "
        f"{'; '.join(one.text for one in answer.estimates)}.{said}"
    )
