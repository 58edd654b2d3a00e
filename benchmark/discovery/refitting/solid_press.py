"""A specimen in the FEM or the wave model with effects in it: its elastic tables, and what a memory adds to the force.

A table is expanded at the numbers of the effects' terms and the set-up as told, by the model's own derivatives; where
the set-up is another, the force of a press of that set-up takes the place of the expansion's.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, Protocol, TypeAlias

import numpy as np

from benchmark.discovery.discovery_result import Array
from benchmark.discovery.refitting.native_terms import NativeTerm
from benchmark.errors import InputError
from benchmark.files import Session, Setup, stretched_tissue
from benchmark.files.tissue import PronyTerm
from benchmark.models import Drive, prepare
from benchmark.response.differentiated_ramp import DifferentiatedRamp, differentiated_ramp, elastic_ramp
from benchmark.response.elastic_table import POINTS, ElasticTable, SeparableField, SetupDerivative
from benchmark.response.fem_table import ramp_table, with_choices
from benchmark.response.ramp import setup_scenario
from benchmark.response.setup_change import CHOICES, changed_setup
from benchmark.response.wave_table import MARGIN, wave_table

MODULUS, STIFFNESS = ".youngs_modulus", ".stiffness"
STEPS = 16
"""Load steps of a press."""
MOST_SHARE = 0.98
"""Of the shear modulus that may fade."""
ModelName: TypeAlias = Literal["fem", "wave"]
Numbers: TypeAlias = Mapping[str, float]
"""Of the terms, by their keys."""


class Specimen(Protocol):
    """A session's specimen in one model."""

    @property
    def name(self) -> ModelName:
        """Which model."""
        ...

    def table(self, setup: Setup, depth: float, numbers: Numbers) -> ElasticTable:
        """The table of a set-up as told down to a depth in m, with derivatives; raises like `pressed`."""
        ...

    def pressed(self, setup: Setup, depth: float, numbers: Numbers, changes: Numbers) -> ElasticTable:
        """The table of the set-up with its changes, choices left out, without derivatives.

        Raises
        ------
        InputError
            The model does not cover it.
        """
        ...


@dataclass(frozen=True, eq=False)
class WaveSpecimen:
    """In the wave model: its own elastic law, and effects as options on top of it."""

    session: Session
    keys: tuple[str, ...]
    name: ModelName = "wave"
    _made: dict[object, ElasticTable] = field(default_factory=dict)

    def table(self, setup: Setup, depth: float, numbers: Numbers) -> ElasticTable:
        """See `Specimen`; `numbers` are none."""
        del numbers
        return _kept(
            self._made,
            (setup, depth),
            lambda: wave_table(
                *_under(self.session, setup), depth, [key for key in self.keys if _has(self.session, setup, key)]
            ),
        )

    def pressed(self, setup: Setup, depth: float, numbers: Numbers, changes: Numbers) -> ElasticTable:
        """See `Specimen`."""
        del numbers
        return _kept(
            self._made,
            (setup, depth, _frozen(changes)),
            lambda: wave_table(*moved_setup(self.session, setup, changes), depth, ()),
        )


@dataclass(frozen=True, eq=False)
class FemSpecimen:
    """In the finite elements, with the terms that they carry."""

    session: Session
    keys: tuple[str, ...]
    terms: tuple[NativeTerm, ...] = ()
    name: ModelName = "fem"
    _made: dict[object, ElasticTable] = field(default_factory=dict)

    def changed(self, numbers: Numbers) -> Session:
        """The session with the terms' numbers in its specimen."""
        session = self.session
        for term in self.terms:
            session = term.changed(session, numbers)
        return session

    def table(self, setup: Setup, depth: float, numbers: Numbers) -> ElasticTable:
        """See `Specimen`."""
        return _kept(self._made, (setup, depth, _frozen(numbers)), lambda: self._expanded(setup, depth, numbers))

    def pressed(self, setup: Setup, depth: float, numbers: Numbers, changes: Numbers) -> ElasticTable:
        """See `Specimen`."""
        return _kept(
            self._made,
            (setup, depth, _frozen(numbers), _frozen(changes)),
            lambda: self._plain(setup, depth, numbers, changes),
        )

    def _plain(self, setup: Setup, depth: float, numbers: Numbers, changes: Numbers) -> ElasticTable:
        session = self.changed(numbers)
        ramp = elastic_ramp(session, *moved_setup(session, setup, changes), MARGIN * depth, STEPS)
        _reaches(float(ramp.depth[-1]), depth)
        press = DifferentiatedRamp(ramp.depth, ramp.force, ramp.face)
        return ramp_table(press, np.linspace(0.0, float(ramp.depth[-1]), POINTS))

    def _expanded(self, setup: Setup, depth: float, numbers: Numbers) -> ElasticTable:
        """The table of the set-up as told, with derivatives by its keys and by the terms' numbers."""
        session = self.changed(numbers)
        weights = {key: each for term in self.terms for key, each in term.ramp_keys(self.session).items()}
        names = {key: _of_law(session, key) for key in self.keys if _has(session, setup, key)}
        wanted = dict.fromkeys([*names.values(), *(name for each in weights.values() for name in each)])
        under = _under(session, setup)
        ramp = differentiated_ramp(session, *under, MARGIN * depth, list(wanted), steps=STEPS, second=True)
        _reaches(float(ramp.depth[-1]), depth)
        plain = ramp_table(ramp, np.linspace(0.0, float(ramp.depth[-1]), POINTS))
        by = {key: plain.by[name] for key, name in names.items()}
        for key, each in weights.items():
            by[key] = _together([(weight, plain.by[name]) for name, weight in each.items()])
        choices = [key for key in self.keys if key in CHOICES]
        return with_choices(session, under, replace(plain, by=by), choices)

    def fading(
        self, setup: Setup, motion: tuple[Array, Array], numbers: Numbers, series: Mapping[float, float]
    ) -> Array:
        """Force (n,) N of a press through times and depths (n,), with a Prony series of every layer's shear.

        Parameters
        ----------
        setup
            As told.
        motion
            Times s from just after rest, and depths m.
        numbers
            Of the elastic terms.
        series
            Share of the shear modulus that fades by its time in s.

        Raises
        ------
        InputError, UncoveredError
            The solver does not follow it.
        """
        session = self.changed(numbers)
        whole = sum(series.values())
        if whole >= MOST_SHARE:
            raise InputError(f"no more than {100 * MOST_SHARE:g} % of the layers' shear may fade")
        terms = tuple(PronyTerm(g=share, tau=time) for time, share in series.items())
        tissue, tool, support = _under(session, setup)
        layers = tuple(layer.model_copy(update={"relaxation": terms}) for layer in tissue.layers)
        scenario = setup_scenario(session, (tissue.model_copy(update={"layers": layers}), tool, support))
        result = prepare("fem", scenario).run(Drive("depth", *motion))
        if not result.complete:
            raise InputError("the finite elements stop within the press")
        return np.asarray(result.force)


def _reaches(reached: float, depth: float) -> None:
    if reached < depth:
        raise InputError(f"the finite elements stop at {1e3 * reached:.3g} mm of {1e3 * depth:.3g} mm")


def _under(session: Session, setup: Setup) -> Setup:
    """A set-up as told with the session's specimen, whose numbers may be others, in its height."""
    told, tool, support = setup
    return stretched_tissue(session.specimen, told.thickness), tool, support


def _has(session: Session, setup: Setup, key: str) -> bool:
    """Whether a set-up has a number of this key."""
    try:
        changed_setup(*_under(session, setup), key, 0.0)
    except InputError:
        return False
    return True


def _of_law(session: Session, key: str) -> str:
    """The key of all stresses where a layer's law does not follow its modulus."""
    name = key.removesuffix(MODULUS)
    own = key.endswith(MODULUS) and session.specimen.layer(name).hyperelastic.shear_modulus is not None
    return name + STIFFNESS if own else key


def moved_setup(session: Session, setup: Setup, changes: Numbers) -> Setup:
    """The set-up with its numbers changed; choices are left out."""
    moved = _under(session, setup)
    for key, change in changes.items():
        if change != 0.0 and key not in CHOICES and _has(session, setup, key):
            moved = changed_setup(*moved, _of_law(session, key), change)
    return moved


def agreeing(told: ElasticTable, changes: Numbers, pressed: ElasticTable) -> ElasticTable:
    """The table with its forces scaled so that with the changes, choices left out, it gives those of a press."""
    expanded = told.force_with({key: change for key, change in changes.items() if key not in CHOICES})
    force = np.interp(told.depth, pressed.depth, pressed.force)
    ratio = np.divide(force, expanded, out=np.ones_like(force), where=expanded > 0.0)
    by = {key: replace(each, force=ratio * each.force) for key, each in told.by.items()}
    return replace(told, force=ratio * told.force, by=by)


def _kept(made: dict[object, ElasticTable], at: object, make: Callable[[], ElasticTable]) -> ElasticTable:
    """What was made before, or is now."""
    if at not in made:
        made[at] = make()
    return made[at]


def _frozen(numbers: Numbers) -> tuple[tuple[str, float], ...]:
    return tuple(sorted(numbers.items()))


def _together(parts: Sequence[tuple[float, SetupDerivative]]) -> SetupDerivative:
    """First orders of several parameters that change together, each by its weight."""
    force = np.sum([weight * each.force[:1] for weight, each in parts], axis=0)
    outward = [(weight, each.outward[0]) for weight, each in parts if each.outward]
    sink = [(weight, each.sink[0]) for weight, each in parts if each.sink]
    return SetupDerivative(force, _sum(outward), _sum(sink))


def _sum(parts: list[tuple[float, SeparableField]]) -> tuple[SeparableField, ...]:
    if not parts:
        return ()
    (weight, first), *others = parts
    return (SeparableField(weight * first.amplitudes, first.shapes).plus(others),)
