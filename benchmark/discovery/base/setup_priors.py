"""How far a set-up may lie from what a person told of it: the base's nuisances by their keys, and their priors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isinf

import numpy as np

from benchmark.discovery import criteria
from benchmark.files import Session, Support, Tissue
from benchmark.physics import Effect
from benchmark.physics.setup_entry import setup_entry
from benchmark.response.elastic_table import ElasticTable
from benchmark.response.setup_change import CHOICES, RADIUS, choices

MODULUS, STIFFNESS = ".youngs_modulus", ".stiffness"
"""Ends of the keys of a layer's modulus, and of all its stresses where its law has constants of its own."""


def setup_priors(session: Session) -> dict[str, float]:
    """Relative standard deviations of the set-up parameters in which a session's base may be wrong.

    The tool's radius, the hole's, and each layer's thickness and modulus: as files state them, else what people know of
    them (`criteria.SETUP_PRIOR`). One layer's modulus is the common factor on all; a law with constants of its own does
    not follow it, but is as uncertain in all its stresses.
    """
    told = stated(session)
    return {key: told.get(_stated_as(key), _usual(key)) for key in _able(session.specimen, session.support)}


def _stated_as(key: str) -> str:
    """The key under which a person states a parameter's uncertainty."""
    return key.removesuffix(STIFFNESS) + MODULUS if key.endswith(STIFFNESS) else key


def told_priors(session: Session) -> dict[str, float]:
    """Those of a set-up that is trusted: what is stated, and the tool's radius, since an edge acts like another one."""
    told = stated(session)
    return {key: size for key, size in setup_priors(session).items() if _stated_as(key) in told or key == RADIUS}


def _usual(key: str) -> float:
    """What people know of a parameter who do not say how well."""
    return criteria.SETUP_PRIOR[key if key in criteria.SETUP_PRIOR else key.rpartition(".")[2]]


def table_keys(session: Session) -> tuple[str, ...]:
    """All keys by which a session's tables are differentiated: parameters, and choices that could have been others."""
    other = dict.fromkeys(key for _, tool, support in session.setups for key in choices(tool, support))
    return (*setup_priors(session), *other)


def setup_entries(tables: Sequence[ElasticTable]) -> tuple[Effect, ...]:
    """The catalogue's entries of a session's set-up: of every key that all its tables know."""
    known = set.intersection(*(set(table.by) for table in tables))
    keys = [key for key in tables[0].by if key in known]
    return tuple(setup_entry(key, farthest(key), choice=key in CHOICES) for key in keys)


def stated(session: Session) -> dict[str, float]:
    """Relative uncertainties that the files of a session state of its set-ups, the largest over its trials."""
    found: dict[str, float] = {}
    for setup in session.setups:
        for key, share in session.uncertainties(setup).items():
            found[key] = max(share, found.get(key, 0.0))
    return found


def _able(tissue: Tissue, support: Support) -> Iterator[str]:
    """Set-up parameters that can be nuisances of the base."""
    yield RADIUS
    if support.kind == "hole":
        yield "support.hole_radius"
    for layer in tissue.layers:
        if not isinf(layer.thickness):
            yield f"{layer.name}.thickness"
        if len(tissue.layers) > 1:
            yield f"{layer.name}{MODULUS if layer.hyperelastic.shear_modulus is None else STIFFNESS}"


def unused(session: Session, tables: Sequence[ElasticTable]) -> tuple[str, ...]:
    """A warning of stated uncertainties that the base does not take up."""
    known = {_stated_as(key) for key in set.intersection(*(set(table.by) for table in tables))}
    known |= set(_common(session.specimen))
    keys = [key for key in stated(session) if key not in known]
    return (f"stated uncertainties that the base does not take up: {', '.join(keys)}",) if keys else ()


def _common(tissue: Tissue) -> list[str]:
    """The modulus that is the common factor, which is free in any case."""
    return [f"{tissue.layers[0].name}{MODULUS}"] if len(tissue.layers) == 1 else []


def is_setup(name: str) -> bool:
    """Whether a nuisance of the base is a set-up parameter."""
    return "." in name


def is_modulus(name: str) -> bool:
    """Whether a nuisance of the base is a layer's modulus, which it has by its logarithm."""
    return name.endswith((MODULUS, STIFFNESS))


def farthest(name: str) -> float:
    """How far a nuisance of the base may go: the table's second order serves no farther, nor is a power law another."""
    if not is_setup(name):
        return criteria.FAR_EXPONENT if name == "exponent" else np.inf
    if name in CHOICES:
        return 1.0
    return criteria.FAR_MODULUS if is_modulus(name) else criteria.FAR_SETUP


def shares(values: Mapping[str, float]) -> dict[str, float]:
    """Relative changes of set-up parameters from the base's vector, which has moduli by their logarithm."""
    return {key: float(np.expm1(value)) if is_modulus(key) else value for key, value in values.items() if is_setup(key)}
