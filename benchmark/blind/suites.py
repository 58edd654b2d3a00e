"""The suites of blind cases: which effects, seeds, families and labs; each the same from the same seed."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from itertools import product

from benchmark.blind.cases import FAMILIES, CaseKind, CaseName
from benchmark.blind.hidden import CATALOGUE, OUTSIDE
from benchmark.blind.labs import LABS
from benchmark.blind.second_forms import SECOND_OUTSIDE
from benchmark.errors import InputError

STRONG, STRONGER = 20.0, 40.0
PAIRS = (
    "viscoelastic_relaxation+machine_compliance",
    "strain_stiffening+viscoelastic_relaxation",
    "dry_friction+force_drift",
    "stress_softening+camera_latency",
    "permanent_set+perspective",
    "backlash+viscous_damping",
    "adhesion+anisotropy",
    "tool_inertia+interface_slip",
    "contact_gap+off_centre_load",
    "poroelastic_drainage+marker_scale_error",
)
"""Pairs of effects that act in different ways; each has both at full strength."""
MORE_PAIRS = ("dry_friction+strain_stiffening", "adhesion+viscoelastic_relaxation")
"""Friction masks stiffening in deep presses (Bacca, Soft Matter 2025), and a bond pulls while memory fades."""
SUITES = ("small", "first", "medium", "labs", "full")
MIXED = {"labs": (38, 6, 10, 6), "full": (400, 60, 200, 100)}
"""Singles, pairs, nulls and effects outside the catalogue of the suites over both families and all labs."""
STRIDE = 4
"""Labs between the cases of neighbouring effects, of nine: an effect meets each lab in nine rounds."""


def suite(name: str, seed: int = 0) -> tuple[CaseName, ...]:
    """The cases of a suite.

    Parameters
    ----------
    name : str
        "small": 4 nulls and each effect once. "first": each effect with 5 seeds and 40 nulls. "medium" adds pairs
        (2 seeds) and effects outside the catalogue (4 seeds, stronger). "labs" and "full": `MIXED`.
    seed : int
        Of the first case of each kind; the others follow it.

    Raises
    ------
    InputError
        There is no such suite.
    """
    if name not in SUITES:
        raise InputError(f"--suite {name!r}: there is no such suite; allowed: {', '.join(SUITES)}")
    if name in MIXED:
        return _mixed(*MIXED[name], seed)
    effects, nulls, pairs, outside = {"small": (1, 4, 0, 0), "first": (5, 40, 0, 0), "medium": (5, 40, 2, 4)}[name]
    return (
        *(CaseName("effect", slug, seed + number, STRONG) for number in range(effects) for slug in CATALOGUE),
        *(CaseName("null", "", seed + number, 0.0) for number in range(nulls)),
        *(CaseName("pair", pair, seed + number, STRONG) for number in range(pairs) for pair in PAIRS),
        *(CaseName("outside", slug, seed + number, STRONGER) for number in range(outside) for slug in OUTSIDE),
    )


def _mixed(singles: int, pairs: int, nulls: int, outside: int, seed: int) -> tuple[CaseName, ...]:
    """Cases over both families and all labs, in an order in which any first part of them is as mixed as the whole."""
    kinds: tuple[tuple[CaseKind, Sequence[tuple[str, str]], int, float], ...] = (
        ("effect", _each(tuple(CATALOGUE)), singles, STRONG),
        ("pair", _each((*PAIRS, *MORE_PAIRS)), pairs, STRONG),
        ("null", [(family, "") for family in FAMILIES for _ in "ab"], nulls, 0.0),
        (
            "outside",
            [*(("first", slug) for slug in OUTSIDE), *(("second", slug) for slug in SECOND_OUTSIDE)],
            outside,
            STRONGER,
        ),
    )
    names = [name for kind in kinds for name in _spread(*kind, seed)]
    return tuple(sorted(names, key=lambda name: hashlib.sha256(f"{name.text} order".encode()).digest()))


def _each(slugs: Sequence[str]) -> list[tuple[str, str]]:
    """All of them, then all of them in the other family, and so on; neighbours of different families."""
    return [(FAMILIES[(number + turn) % 2], slug) for turn, (number, slug) in product((0, 1), enumerate(slugs))]


def _spread(kind: CaseKind, turns: Sequence[tuple[str, str]], count: int, strength: float, seed: int) -> list[CaseName]:
    """Cases by turns, each with a seed of its own; labs go on with each round, so that no effect keeps to one."""
    labs = tuple(LABS)
    out = []
    for number in range(count):
        turn, place = divmod(number, len(turns))
        family, slug = turns[place]
        lab = labs[(place * STRIDE + turn) % len(labs)]
        out.append(CaseName(kind, slug, seed + number, strength, family=family, lab=lab))
    return out


def chosen(cases: tuple[CaseName, ...], slugs: tuple[str, ...], labs: tuple[str, ...] = ()) -> tuple[CaseName, ...]:
    """The cases of some effects (by slug, pair or "null") in some labs; all without any.

    Raises
    ------
    InputError
        A slug or a lab is in no case.
    """
    return _among(
        _among(cases, "--cases", slugs, lambda case: case.slug or "null"), "--labs", labs, lambda case: case.lab
    )


def _among(
    cases: tuple[CaseName, ...], option: str, wanted: tuple[str, ...], of: Callable[[CaseName], str]
) -> tuple[CaseName, ...]:
    """Those of which something is among what an option wants; all where it wants nothing."""
    known = {of(case) for case in cases}
    for each in wanted:
        if each not in known:
            raise InputError(f"{option} {each!r}: no case of this suite; allowed: {', '.join(sorted(known))}")
    return tuple(case for case in cases if not wanted or of(case) in wanted)
