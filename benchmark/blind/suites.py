"""The suites: which cases they have, with settings that are the same for all."""

from __future__ import annotations

from benchmark.blind.case import CaseName
from benchmark.blind.hidden import CATALOGUE, OUTSIDE
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

SUITES = ("small", "first", "medium", "full")


def suite(name: str, seed: int = 0) -> tuple[CaseName, ...]:
    """The cases of a suite.

    Parameters
    ----------
    name : str
        "small": 4 nulls and each effect once. "first": each effect with 5 seeds and 40 nulls. "medium" adds pairs
        (2 seeds) and effects outside the catalogue (4 seeds, stronger). "full": 10 seeds, 100 nulls, 5 seeds a
        pair, 10 seeds each outside.
    seed : int
        Of the first case of each kind; the others follow it.

    Raises
    ------
    InputError
        There is no such suite.
    """
    if name not in SUITES:
        raise InputError(f"--suite {name!r}: there is no such suite; allowed: {', '.join(SUITES)}")
    effects, nulls, pairs, outside = {
        "small": (1, 4, 0, 0),
        "first": (5, 40, 0, 0),
        "medium": (5, 40, 2, 4),
        "full": (10, 100, 5, 10),
    }[name]
    return (
        *(CaseName("effect", slug, seed + number, STRONG) for number in range(effects) for slug in CATALOGUE),
        *(CaseName("null", "", seed + number, 0.0) for number in range(nulls)),
        *(CaseName("pair", pair, seed + number, STRONG) for number in range(pairs) for pair in PAIRS),
        *(CaseName("outside", slug, seed + number, STRONGER) for number in range(outside) for slug in OUTSIDE),
    )


def chosen(cases: tuple[CaseName, ...], slugs: tuple[str, ...]) -> tuple[CaseName, ...]:
    """The cases of some effects (by slug, pair or "null"); all without any.

    Raises
    ------
    InputError
        A slug is in no case.
    """
    known = {case.slug or "null" for case in cases}
    for slug in slugs:
        if slug not in known:
            raise InputError(f"--cases {slug!r}: no case of this suite; allowed: {', '.join(sorted(known))}")
    return tuple(case for case in cases if not slugs or (case.slug or "null") in slugs)
