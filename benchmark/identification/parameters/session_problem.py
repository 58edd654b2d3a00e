"""What a fit of parameters takes from sessions: presses, trials, free parameters, and what was told and how surely."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from benchmark.errors import InputError
from benchmark.files import Session, Setup, Tool
from benchmark.files.schema import nearest
from benchmark.files.sessions.fit_table import FitTable
from benchmark.files.tool import TOUCHING
from benchmark.files.units import QuantityError, parse_quantity, relative_uncertainty, split_uncertainty
from benchmark.identification.model_error import LARGEST
from benchmark.identification.parameters.fit_problem import FitProblem
from benchmark.identification.parameters.free_parameters import (
    COMMON,
    EDGE_RADIUS,
    MODULUS,
    POISSON,
    RELAXATION,
    Parameter,
    Prior,
    dimension_of_key,
    parameters_of,
    value_of,
    with_values,
)
from benchmark.identification.parameters.law_shapes import POWER, law_shape
from benchmark.identification.parameters.layer_model import FitTrial
from benchmark.identification.parameters.presses.marker_rings import MarkerRings, MarkerRows, rings_of
from benchmark.identification.parameters.presses.press_surrogate import Press
from benchmark.identification.session_fit import SessionFit
from benchmark.identification.sheet_model import FilmedTrial
from benchmark.identification.trial_data import LEAST_ROWS, TrialData
from benchmark.identification.trial_features import contact_range
from benchmark.response.force_curve import Array
from benchmark.response.nearest_curve import tool_name
from benchmark.response.ramp import Ramp
from benchmark.response.ramp_table import EVERYWHERE, CameraView
from benchmark.response.setup_change import RADIUS, THICKNESS

MARGIN = 1.04
"""A press goes this much deeper than its trials do below where the first fit has them touch."""
UNSTATED = {
    "tool.radius": 0.01,
    "tool.edge_radius": 1.0 / math.sqrt(3.0),
    "support.hole_radius": 0.01,
    "support.specimen_radius": 0.01,
    "thickness": 0.035,
    "youngs_modulus": 0.25,
}
"""Relative standard uncertainty of what is told without one: what people know of a set-up.

A tool's radius to 1 %, a thickness to 2 to 5 %, a layer's modulus to 20 to 50 %. First choice; `exact` takes it away.
An edge has one where nobody told it: between a sharp one and twice the assumed one any is as likely (a rectangular
distribution, JCGM 100:2008, 4.3.7).
"""
UNSTATED_POISSON = 0.5
"""Standard uncertainty of log(1 - 2 nu) where none is told: 0.45 to 0.488 round 0.475."""


@dataclass(frozen=True, eq=False)
class FittedBase:
    """A session with the fit of one common stiffness, which a fit of parameters begins with.

    `followed` are the tools that the model covers in each set-up, the one told first, each with its ramp; `films` what
    cameras saw of trials over a hole, with where the tool's axis met the face (m), by condition and name; `view` the
    camera.
    """

    session: Session
    fit: SessionFit
    trials: Sequence[TrialData]
    followed: Mapping[Setup, tuple[tuple[Tool, Ramp], ...]]
    films: Mapping[tuple[str, str], tuple[FilmedTrial, tuple[float, float]]] = field(default_factory=dict)
    view: CameraView = EVERYWHERE


@dataclass(frozen=True, eq=False)
class Assembled:
    """A problem with where its trials begin, and what a reader must know of how it came about."""

    problem: FitProblem
    touches: Array
    zeros: Array
    warnings: tuple[str, ...]


def assembled(bases: Sequence[FittedBase], wish: FitTable) -> Assembled:
    """Put sessions together for a fit.

    Raises
    ------
    InputError
        A key that a specimen does not have, or values that cannot be used.
    """
    discrepancy = _discrepancy(wish)
    check_exact(wish.exact, [setup for base in bases for setup in base.session.setups], "[fit] exact")
    presses, trials, keys, warnings = _presses(bases, wish)
    if not trials:
        raise InputError("no trial is left for a fit of parameters: none reaches into the model's range")
    free = _free(bases, presses, wish)
    told = _told(presses, wish, {one.key for one in free})
    problem = FitProblem(presses, trials, (*free, *told), wish.law, wish.forward, discrepancy=discrepancy)
    problem = replace(problem, parameters=_started(problem, bases), specimens=_specimens(trials, wish))
    own = [bases[specimen].fit.trial(*key) for specimen, key in keys]
    touches, zeros = np.array([one.onset for one in own]), np.array([one.zero for one in own])
    return Assembled(problem, touches, zeros, warnings)


def _discrepancy(wish: FitTable) -> float:
    """The discrepancy over depth that is let into the model, a share of the force."""
    if wish.discrepancy is None:
        return 0.0
    share = quantity("discrepancy", wish.discrepancy)
    if not 0.0 < share <= LARGEST:
        raise InputError(
            f"[fit] discrepancy = {wish.discrepancy!r}: allowed is a share of the force above 0 and up to "
            f'{100 * LARGEST:.0f} %, as in "1 %"'
        )
    return share


def _specimens(trials: Sequence[FitTrial], wish: FitTable) -> tuple[str, ...]:
    """The specimen of each trial by the pattern that is told; empty without one."""
    if wish.specimen_pattern is None:
        return ()
    try:
        pattern = re.compile(wish.specimen_pattern)
    except re.error as error:
        raise InputError(f"[fit] specimen_pattern: no regular expression: {error}") from None
    if pattern.groups < 1:
        raise InputError("[fit] specimen_pattern: needed is a group in brackets, which is the specimen")
    found = {one.data.name: pattern.search(one.data.name) for one in trials}
    stray = [name for name, match in found.items() if match is None or match[1] is None]
    if stray:
        raise InputError(f"[fit] specimen_pattern: the trial {stray[0]} does not match {wish.specimen_pattern!r}")
    return tuple(f"{one.press}: {match[1]}" for one in trials if (match := found[one.data.name]) is not None)


def _presses(
    bases: Sequence[FittedBase], wish: FitTable
) -> tuple[tuple[Press, ...], tuple[FitTrial, ...], list[tuple[int, tuple[str, str]]], tuple[str, ...]]:
    """Presses, their trials, each trial's specimen and name, and what was changed of them."""
    presses: list[Press] = []
    trials, keys, warnings = [], [], []
    for specimen, base in enumerate(bases):
        for setup in base.session.setups:
            fitted = _trials_of(base, setup)
            if not fitted:
                continue
            onsets = [base.fit.trial(data.name, data.condition).onset for data in fitted]
            wanted = MARGIN * max(float(data.depth.max()) - onset for data, onset in zip(fitted, onsets, strict=True))
            press, said = _press(specimen, base, setup, wanted)
            press = replace(press, setup=with_values(press.setup, _fixed(press.setup, wish)))
            warnings += said
            rings, films = _films(base, fitted) if wish.markers else (None, {})
            press = replace(press, rings=rings)
            for data, onset in zip(fitted, onsets, strict=True):
                if int((data.depth <= onset + press.depth).sum()) >= LEAST_ROWS:
                    touch = contact_range(data.depth, data.force)
                    one = replace(FitTrial.of(data, len(presses), touch, onset), film=films.get(data.key))
                    trials.append(one.up_to(press.depth))
                    keys.append((specimen, (data.name, data.condition)))
            presses.append(press)
    return tuple(presses), tuple(trials), keys, tuple(warnings)


def _films(
    base: FittedBase, trials: Sequence[TrialData]
) -> tuple[MarkerRings | None, Mapping[tuple[str, str], MarkerRows | None]]:
    """The rings of markers of a set-up, and what the films of its trials show of them; None without any."""
    keys = [one.key for one in trials if one.key in base.films]
    if not keys:
        return None, {}
    films, axes = zip(*(base.films[key] for key in keys), strict=True)
    made = rings_of(films, axes, base.view)
    return (None, {}) if made is None else (made[0], dict(zip(keys, made[1], strict=True)))


def _trials_of(base: FittedBase, setup: Setup) -> list[TrialData]:
    """The trials of a set-up that the first fit could use."""
    used = {each.key for each in base.fit.trials}
    pairs = zip(base.session.trials, base.trials, strict=True)
    return [data for trial, data in pairs if base.session.setup(trial) == setup and data.key in used]


def _press(specimen: int, base: FittedBase, setup: Setup, wanted: float) -> tuple[Press, list[str]]:
    """A press under the tool that the model follows deepest, to the depth wanted (m), or as deep as it goes."""
    tissue, told, support = setup
    tool, reach, said = told, wanted, []
    followed = base.followed.get(setup, ())
    whole = [(other, ramp) for other, ramp in followed if ramp.failure is None]
    deepest = whole[0] if whole else max(followed, key=lambda each: float(each[1].depth[-1]), default=None)
    if deepest is not None:
        tool, ramp = deepest
        if ramp.failure is not None:
            reach = min(wanted, 0.97 * float(ramp.depth[-1]))
            said.append(f"parameters are fitted to the first {1e3 * reach:.3g} mm: deeper the model does not go")
        if tool != told:
            said.append(f"parameters are fitted with {tool_name(tool, told)} in the place of the tool as told")
    return Press(specimen, base.session, (tissue, tool, support), reach), said


def check_wish(wish: FitTable, setup: Setup) -> None:
    """Refuse keys and values that a fit to presses of a set-up would refuse, before anything is computed.

    A tool's edge is left to the fit, which may give one to a tool that was told without.

    Raises
    ------
    InputError
        Names table and key, and what is allowed.
    """
    setup = with_values(setup, _fixed(setup, wish))
    for key in _free_keys(wish):
        if key != EDGE_RADIUS:
            for one in parameters_of(key, setup, wish.law):
                _informed(one, wish)


def check_exact(keys: Iterable[str], setups: Iterable[Setup], place: str) -> None:
    """Refuse keys of `exact` that are told by no set-up; raises InputError that begins with the place."""
    known = list(dict.fromkeys(key for setup in setups for key in _tellable(setup, set())))
    for key in keys:
        if key not in ("all", *known):
            raise InputError(
                f"{place} {key}: nothing of that name is told of these trials; {nearest(key, ['all', *known])}"
            )


def _free_keys(wish: FitTable) -> list[str]:
    """What is free, a law's constant of shape among it; raises InputError for a key that is told of and not free."""
    keys = list(dict.fromkeys(wish.free))
    shape = "" if wish.law is None else law_shape(wish.law).key
    if shape and shape not in keys and not any(".hyperelastic." in key for key in keys):
        keys.append(shape)
    told = {"[fit] per_specimen": wish.per_specimen, "[fit.bounds]": wish.bounds, "[fit.priors]": wish.priors}
    for table, given in told.items():
        for key in given:
            if not _covers(keys, key):
                raise InputError(f"{table} {key}: this is not among what is free (--free); {nearest(key, keys)}")
    return keys


def _free(bases: Sequence[FittedBase], presses: Sequence[Press], wish: FitTable) -> tuple[Parameter, ...]:
    """The free parameters, shared ones once and per-specimen ones for each session that has them."""
    keys = _free_keys(wish)
    out: list[Parameter] = []
    for key in keys:
        own = key in wish.per_specimen and len(bases) > 1
        for specimen in range(len(bases)) if own else (None,):
            at = next(one for one in presses if specimen in (None, one.specimen))
            out += [replace(_informed(one, wish), specimen=specimen) for one in parameters_of(key, at.setup, wish.law)]
    return tuple(out)


def _fixed(setup: Setup, wish: FitTable) -> dict[str, float]:
    """Values that `[fit.fixed]` states, SI; raises InputError for a key that the set-up does not have."""
    for key in wish.fixed:
        value_of(key, setup, "[fit.fixed]")
    return {key: quantity(key, text) for key, text in wish.fixed.items()}


def _covers(keys: Sequence[str], key: str) -> bool:
    return key in keys or any(key.startswith(f"{one}.") and one.endswith(RELAXATION) for one in keys)


def _informed(parameter: Parameter, wish: FitTable) -> Parameter:
    """A free parameter with the bounds and the prior that a person gives."""
    key = parameter.key
    if key in wish.bounds:
        low, high = (quantity(key, end) for end in wish.bounds[key])
        if not low < high or (low <= 0.0 and not parameter.signed):
            above = "" if parameter.signed else " above 0"
            raise InputError(f"[fit.bounds] {key}: allowed are two values{above}, the lower one first")
        inside = 1e-6 * (high - low)
        start = min(max(parameter.start, low + inside), high - inside)
        parameter = replace(parameter, low=low, high=high, start=start)
    if key in wish.priors:
        entry = wish.priors[key]
        plain, uncertain = split_uncertainty(entry.value)
        if uncertain is None:
            raise InputError(f'[fit.priors] {key}: give a value with its uncertainty, such as "120 kPa +/- 30 %"')
        value = quantity(key, plain)
        try:
            share = relative_uncertainty(value, uncertain, dimension_of_key(key))
        except QuantityError as error:
            raise InputError(f"[fit.priors] {key}: {error}") from None
        parameter = replace(parameter, prior=Prior(value, _deviation(key, value, share), entry.source), start=value)
    return parameter


def quantity(key: str, text: str | float) -> float:
    """A value of a key, SI; raises InputError."""
    dimension = dimension_of_key(key)
    if isinstance(text, float | int):
        text = str(text)
    try:
        return parse_quantity(text, dimension)
    except QuantityError as error:
        raise InputError(f"[fit] {key}: {error}") from None


def _deviation(key: str, value: float, share: float) -> float:
    """Standard uncertainty of a coordinate from that of its value, as a share."""
    if key == POWER:
        return share * abs(value) / math.hypot(1.0, value)
    return 2.0 * value * share / (1.0 - 2.0 * value) if key.endswith(POISSON) else share


def _told(presses: Sequence[Press], wish: FitTable, free: set[str]) -> tuple[Parameter, ...]:
    """What was told of set-ups and is not free, as parameters with a prior.

    Parts of one session, which differ in height, have but their thickness of their own.
    """
    if "all" in wish.exact:
        return ()
    one_session = len({press.session.folder for press in presses}) == 1
    out: dict[tuple[str, object], Parameter] = {}
    taken = {*free, *wish.exact, *wish.fixed}
    for press in presses:
        stated = press.session.uncertainties(press.setup)
        for key in _tellable(press.setup, free):
            if key in taken or (key == EDGE_RADIUS and key not in stated and not _edge_assumed(press)):
                continue
            of_tool = key in (RADIUS, EDGE_RADIUS)
            common = of_tool or (one_session and not key.endswith(f".{THICKNESS}"))
            tool, specimen = press.setup[1] if of_tool else None, None if common else press.specimen
            value = value_of(key, press.setup)
            share = stated.get(key)
            spread = _deviation(key, value, share) if share is not None else _unstated(key)
            source = _told_by(key, share)
            one = parameters_of(key, press.setup, None)[0]
            one = replace(one, prior=Prior(value, spread, source), told=True, specimen=specimen, tool=tool)
            out.setdefault((key, tool if of_tool else specimen), one)
    return tuple(out.values())


def _edge_assumed(press: Press) -> bool:
    return press.setup[1].edge_radius in press.session.assumed_edges


def _told_by(key: str, share: float | None) -> str:
    if share is not None:
        return f"told to {100 * share:.2g} %"
    return "assumed" if key == EDGE_RADIUS else "told without its uncertainty"


def _unstated(key: str) -> float:
    if key.endswith(POISSON):
        return UNSTATED_POISSON
    return UNSTATED.get(key) or UNSTATED[key.rpartition(".")[2]]


def _tellable(setup: Setup, free: set[str]) -> Iterator[str]:
    """Keys of a set-up that were told and move the force."""
    tissue, tool, support = setup
    yield "support.specimen_radius" if support.cylinder else RADIUS
    if tool.contact in TOUCHING and tool.edge_radius is not None:
        yield EDGE_RADIUS
    if support.kind == "hole":
        yield "support.hole_radius"
    for layer in tissue.layers:
        if not math.isinf(layer.thickness) and THICKNESS not in free:
            yield f"{layer.name}.thickness"
        if COMMON not in free:
            yield f"{layer.name}.{MODULUS}"
        yield f"{layer.name}.{POISSON}"


def _started(problem: FitProblem, bases: Sequence[FittedBase]) -> tuple[Parameter, ...]:
    """The parameters with moduli that begin at the stiffness that the first fits found."""
    out = []
    for one in problem.parameters:
        if one.key == COMMON or (one.key.endswith(MODULUS) and not one.told and one.prior is None):
            specimens = range(len(bases)) if one.specimen is None else (one.specimen,)
            factor = float(np.exp(np.mean([np.log(bases[k].fit.stiffness_factor) for k in specimens])))
            one = replace(one, start=min(max(one.start * factor, 1.01 * one.low), 0.99 * one.high))
        out.append(one)
    return tuple(out)
