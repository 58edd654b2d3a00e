"""All cases of the finite-element solver, family after family."""

from __future__ import annotations

from collections.abc import Callable

from fem.verification import (
    block,
    cook,
    cylinder,
    half_space,
    hayes,
    hertz,
    homogeneous,
    laws,
    layered,
    le1,
    manufactured,
    patch,
    press,
    prony,
    slipping,
    solid_patch,
)
from fem.verification.case import Case

FAMILIES: tuple[Callable[[], tuple[Case, ...]], ...] = (
    patch.cases,
    manufactured.cases,
    homogeneous.cases,
    laws.cases,
    half_space.cases,
    hayes.cases,
    hertz.cases,
    layered.cases,
    slipping.cases,
    cylinder.cases,
    cook.cases,
    le1.cases,
    press.cases,
    prony.cases,
    solid_patch.cases,
    block.cases,
)


def fem_cases() -> tuple[Case, ...]:
    """Every case, their names all different."""
    return tuple(case for family in FAMILIES for case in family())
