"""All cases of the finite-element solver, family after family."""

from __future__ import annotations

from collections.abc import Callable

from fem.verification import (
    block,
    homogeneous,
    indentation,
    layered,
    manufactured,
    patch,
    press,
    pretension,
    prony,
    sections,
)
from fem.verification.case import Case

FAMILIES: tuple[Callable[[], tuple[Case, ...]], ...] = (
    patch.cases,
    manufactured.cases,
    homogeneous.cases,
    homogeneous.law_cases,
    homogeneous.another_code_cases,
    indentation.half_space_cases,
    indentation.hayes_cases,
    indentation.hertz_cases,
    layered.cases,
    layered.slipping_cases,
    sections.cylinder_cases,
    sections.cook_cases,
    sections.le1_cases,
    press.cases,
    prony.cases,
    pretension.cases,
    patch.solid_cases,
    block.cases,
)


def fem_cases() -> tuple[Case, ...]:
    """Every case, their names all different."""
    return tuple(case for family in FAMILIES for case in family())
