"""The table `[fit]` of a session, or of a file of its own: what a fit leaves free, and what is known beforehand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from pydantic import Field

from benchmark.files.schema import FileModel, Name

Law = Literal["neo_hookean", "mooney_rivlin", "yeoh", "gent", "ogden", "fibres"]


class PriorEntry(FileModel):
    """What is known of a free parameter beforehand.

    Attributes
    ----------
    value : str
        With its standard uncertainty, "1.5 mm +/- 10 %".
    source : str
        Who says so: a publication, a gauge.
    """

    value: Name
    source: Name


class FitTable(FileModel):
    """What `fit` does.

    Attributes
    ----------
    free : tuple of str
        Keys as in `--set`, and `LAYER.relaxation`, `relaxation`, `thickness`, `stiffness_factor`, a law's constant.
    law : str or None
        Law that all layers get; None keeps the specimen's own.
    forward : str
        fem | wave.
    per_specimen : tuple of str
        Free keys that each session has for itself; the others are shared.
    specimen_pattern : str or None
        Regular expression on a trial's name whose first group is its specimen: trials of one specimen go together.
    discrepancy : str, float or None
        Standard deviation of a discrepancy of the model over depth, a share of the force, "1 %".
    markers : bool
        Whether the markers of trials over a hole are fitted along with the force.
    exact : tuple of str
        Told values that are taken without any uncertainty; ("all",) for all.
    fixed : mapping
        Values by key that the specimen's file has otherwise; they are exact.
    bounds : mapping
        Lower and upper bound by free key.
    priors : mapping of PriorEntry
        By free key.
    """

    free: tuple[Name, ...] = ()
    law: Law | None = None
    forward: Literal["fem", "wave"] = "fem"
    per_specimen: tuple[Name, ...] = ()
    specimen_pattern: Name | None = None
    discrepancy: str | float | None = None
    markers: bool = True
    exact: tuple[Name, ...] = ()
    fixed: Mapping[str, str | float] = Field(default_factory=dict)
    bounds: Mapping[str, tuple[str | float, str | float]] = Field(default_factory=dict)
    priors: Mapping[str, PriorEntry] = Field(default_factory=dict)
