"""What a model hands to the harness, whoever computed it: plain arrays, SI, press positive."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from fem import MeshError

Array = NDArray[np.float64]
_SAME = 1e-9


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
class FemChoices:
    """What the finite-element solver chose or was told.

    `kinematics` "finite" or "linear", `edge` how much larger than usual the elements at the tool's edge are.
    """

    kinematics: str
    geometry: str
    mesh: str
    edge: float
    linear_solver: str

    def notes(self) -> dict[str, str]:
        """The choices by name, in words."""
        larger = "" if self.edge == 1.0 else f", elements at the tool's edge {self.edge:g} times larger"
        return {
            "kinematics": "finite strain" if self.kinematics == "finite" else "small strain",
            "geometry": self.geometry,
            "mesh": self.mesh + larger,
            "linear solver": self.linear_solver,
        }


STRAINS = {
    "linear": "small strain",
    "corrected": "finite strain of the layers",
    "deep": "finite strain of the layers, followed deep",
}
"""How a layered wave takes the strain of its layers."""
SHEET = "sheet over a hole, finite deflection with its local tension"
CALIBRATED = (
    "; three numbers of a bonded tool's edge were identified once on finite elements of eleven sheets, that of the "
    "shipped phantom among them, and are the same for all sheets"
)


@dataclass(frozen=True)
class WaveChoices:
    """What a wave model chose or was told.

    Attributes
    ----------
    strain
        "linear", "corrected" or "deep" (`STRAINS`) of the layered wave; None of a sheet over a hole.
    window
        Width in m.
    modes
        N of the layered wave's m, n = 1..N, or of the sheet's radial functions.
    calibrated
        Whether numbers of it were identified on finite elements.
    """

    strain: str | None
    window: float
    modes: int
    calibrated: bool = False

    @property
    def plane_modes(self) -> int | None:
        """N of modes m, n = 1..N, which a run may refine; None of a sheet."""
        return None if self.strain is None else self.modes

    def notes(self) -> dict[str, str]:
        """The choices by name, in words."""
        if self.strain is None:
            return {
                "model": SHEET + (CALIBRATED if self.calibrated else "; no calibration"),
                "window": f"the hole, {1e3 * self.window:.4g} mm wide",
                "modes": f"{self.modes} radial functions each",
            }
        return {
            "model": f"layered vector wave, {STRAINS[self.strain]}, no calibration",
            "window": f"{1e3 * self.window:.4g} mm",
            "modes": f"m, n = 1..{self.modes}",
        }


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
    choices
        What the model chose, as facts; None of a user's own.
    last
        Of a run that stopped early its last state of equilibrium, if it has one (FEM only).
    mesh_error
        Estimated discretisation error at the largest load; None where it was not asked for or cannot be told.
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
    choices: FemChoices | WaveChoices | None = None
    mesh_error: MeshError | None = None

    @property
    def complete(self) -> bool:
        """Whether the whole load history was followed."""
        return self.failure is None

    def max_deformation(self) -> Array:
        """(L,) m: of each layer, the deflection of largest magnitude over the history, signed; NaN if none."""
        if not self.top_deflection.size:
            return np.full(len(self.layers), np.nan)
        rows = np.nan_to_num(np.abs(self.top_deflection), nan=-1.0).argmax(axis=0)
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

    def times(self, share: float) -> Drive:
        """The history with its load times a share."""
        return Drive(self.control, self.time, share * self.value)


class PreparedModel(Protocol):
    """A model after its one-time set-up."""

    def follow(self, drive: Drive, on_step: OnStep = silent) -> Reading:
        """Follow a load history from rest; calling what comes back reads profiles, fields and notes off it."""
        ...

    def run(self, drive: Drive, on_step: OnStep = silent) -> ModelResult:
        """Follow a load history from rest and read everything off it."""
        ...


@dataclass(frozen=True)
class Keeping:
    """A folder for unfinished work, which need not exist yet, and who is told what was found or done there."""

    folder: Path
    say: Callable[[str], None]


REACH = 5.0
PER_RADIUS = 10


def profile_radii(tool_radius: float) -> Array:
    """Radii (m,) in m from the axis to five tool radii, ten to a radius, the tool's edge among them."""
    return np.asarray(tool_radius / PER_RADIUS * np.arange(int(REACH * PER_RADIUS) + 1), dtype=np.float64)


def slips(force: Array, top: Array, thickness: float, unit: str) -> tuple[str, ...]:
    """What looks like a slip of sign or unit in deflections (n, L), m, that somebody else worked out.

    `force` (n,) N may be empty of values (NaN) as the deflections may; `thickness` (m) is the tissue's, and `unit` says
    in words what deflections are given in.
    """
    said = []
    if float(np.nansum(force * top[:, 0])) < 0.0:
        said.append("its deflections point out of the tissue under a press; both are positive into the tissue")
    largest = float(np.abs(top[np.isfinite(top)]).max(initial=0.0))
    if largest > thickness:
        said.append(
            f"its largest deflection, {1e3 * largest:.4g} mm, is more than the thickness of the tissue, "
            f"{1e3 * thickness:.4g} mm; {unit}"
        )
    return tuple(said)


@dataclass(frozen=True)
class LowerFace:
    """Displacement of the lower face at each depth of a ramp; SI.

    `depth` (k,) of the press and `radius` (m,), the distance from the tool axis before it, increase from 0; `outward`
    and `sunk` (k, m) are away from the axis and downwards.
    """

    depth: Array
    radius: Array
    outward: Array
    sunk: Array


def lower_face(result: ModelResult) -> LowerFace | None:
    """Take the lower face out of a depth ramp that kept every field; None where a step has none.

    Parameters
    ----------
    result : ModelResult
        Of an axisymmetric run prepared with `every_field`.
    """
    if not result.time.size or len(result.fields) != result.time.size:
        return None
    points = result.fields[0].points
    low = float(points[:, 2].min())
    rows = np.flatnonzero((points[:, 2] <= low + _SAME) & (np.abs(points[:, 1]) <= _SAME))
    rows = rows[np.argsort(points[rows, 0])]
    radius = points[rows, 0]
    moved = np.array([field.point_data["displacement_m"][rows] for field in result.fields])
    moved = np.concatenate([np.zeros((1, *moved.shape[1:])), moved])
    return LowerFace(np.append(0.0, result.depth), radius, moved[:, :, 0], -moved[:, :, 2])
