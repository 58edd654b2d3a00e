"""What a model hands to the harness, whoever computed it: plain arrays, SI, press positive."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StepProgress:
    """One accepted load step, for progress displays (SI)."""

    step: int
    total: int
    force: float
    depth: float


@dataclass(frozen=True)
class RunFailure:
    """Where a solver stopped before the end of its load history.

    `step` counts from 1; `reached` and `target` are the last accepted and the wanted load, in the unit of the
    control (N or m).
    """

    step: int
    time: float
    reached: float
    target: float
    unit: str
    reason: str

    def __str__(self) -> str:
        return (
            f"step {self.step} at {self.time:.6g} s: the load {self.target:.6g} {self.unit} could not be reached, "
            f"the last converged load is {self.reached:.6g} {self.unit} ({self.reason})"
        )


@dataclass(frozen=True)
class Resumption:
    """What a run took over from one that was interrupted.

    `steps` of `total` were not computed again; they took `seconds` of CPU time, which no timing holds.
    """

    steps: int
    total: int
    seconds: float

    def __str__(self) -> str:
        return (
            f"resumed after step {self.steps} of {self.total}, which an interrupted run of the same problem had kept; "
            f"they took {self.seconds:.3g} s of CPU there"
        )


@dataclass(frozen=True)
class FieldSnapshot:
    """The deformed continuum at one step, ready for a VTU file.

    `points` (P, 3) in m, `cells` (C, k) indices into the points, `cell_type` the VTK cell type number, arrays keyed by
    name with one row a point or a cell.
    """

    step: int
    points: Array
    cells: NDArray[np.int64]
    cell_type: int
    point_data: Mapping[str, Array]
    cell_data: Mapping[str, Array]


@dataclass(frozen=True)
class LastState:
    """The last state of equilibrium of a run that stopped early, at a step or between two.

    `time` in s, `force` in N, `depth` in m, `top_deflection` (L,) in m; `field` is None in a run that was read back.
    """

    time: float
    force: float
    depth: float
    top_deflection: Array
    field: FieldSnapshot | None = None

    def __str__(self) -> str:
        return f"the last state of equilibrium, at {self.force:.4g} N, is {1e3 * self.depth:.4g} mm deep"


@dataclass(frozen=True)
class ModelResult:
    """A model's answer to a scenario.

    Attributes
    ----------
    model
        `"fem"` or `"wave"`.
    layers
        Layer names from the surface down, L of them.
    time, force, depth
        (n,) s, N, m. The depth is the deflection of the top face on the tool axis (of the tool, if rigid).
    top_deflection
        (n, L) m, deflection of each layer's top face on the tool axis.
    profile_radii, profile
        (m,) m and (L, m) m: deflection over the reference radius at `peak_step`; NaN outside the model's domain.
    peak_step
        Index (from 0) of the step with the largest load.
    unknowns
        Unknowns of the model; None where it does not say.
    notes
        Choices the model made, by name, as readable text.
    warnings
        Where the model left its range, one sentence each.
    failure
        None when the whole load history was followed.
    fields
        Snapshots of the continuum (FEM only).
    resumed
        What was taken over from an interrupted run; None where all was computed at once.
    last
        Of a run that stopped early its last state of equilibrium, if it has one (FEM only).
    """

    model: str
    layers: tuple[str, ...]
    time: Array
    force: Array
    depth: Array
    top_deflection: Array
    profile_radii: Array
    profile: Array
    peak_step: int
    unknowns: int | None
    notes: Mapping[str, str] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    failure: RunFailure | None = None
    fields: tuple[FieldSnapshot, ...] = ()
    resumed: Resumption | None = None
    last: LastState | None = None

    @property
    def complete(self) -> bool:
        """Whether the whole load history was followed."""
        return self.failure is None

    def max_deformation(self) -> Array:
        """(L,) m: of each layer, the deflection of largest magnitude over the history, signed; NaN without a step."""
        if not self.top_deflection.size:
            return np.full(len(self.layers), np.nan)
        rows = np.abs(self.top_deflection).argmax(axis=0)
        return np.asarray(self.top_deflection[rows, np.arange(len(self.layers))])


class UncoveredError(Exception):
    """The model has no answer to this scenario; the reason is the message."""


OnStep = Callable[[StepProgress], None]


def silent(_: StepProgress) -> None:
    """Report no progress."""


Picture = Callable[[], Array]
"""Draws a frame: the deflection (L, P, Q) in m of every layer's face at vertices; the next may reuse its memory."""

Reading = Callable[[], ModelResult]
"""What is left once a load history was followed; it is no part of the history's time."""


@dataclass(frozen=True)
class Drive:
    """A load history: force in N or depth in m over time in s, both (n,), press positive."""

    control: Literal["force", "depth"]
    time: Array
    value: Array


class PreparedModel(Protocol):
    """A model after its one-time set-up."""

    def follow(self, drive: Drive, on_step: OnStep = silent) -> Reading:
        """Follow a load history from rest; calling what comes back reads profiles, fields and notes off it."""
        ...

    def run(self, drive: Drive, on_step: OnStep = silent) -> ModelResult:
        """Follow a load history from rest and read everything off it."""
        ...
