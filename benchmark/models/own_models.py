"""A user's own FEA in the FEM's place, and a user's own fast model in the wave's."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench_hw.storage.regular_file import TABLE, read_regular
from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.model_file import RepairedModel
from benchmark.models.fea_results import READERS
from benchmark.models.model_result import Array, Drive, ModelResult, profile_radii, slips
from benchmark.models.prepare import scenario_drive
from benchmark.models.reference_table import (
    check_at_peak,
    check_layers,
    check_radii,
    header_sign,
    history,
    parted,
    profile,
    read_rows,
    template,
)
from benchmark.models.user_file import UserFile
from reports import write_csv

FAR_APART = 100.0
"""Models this many times apart are not in the same unit, rather than wrong: mm and m, or um and mm, are 1000."""
NO_TIME = "a table has no compute time: timing and speed-up of the FEM are empty"
EMPTY = "a table has no profile and no compute time: the profile, timing and speed-up of the FEM are empty"


@dataclass(frozen=True)
class Reference:
    """A user's own FEA: what reports call it, its values as a model's, and its file."""

    name: str
    result: ModelResult
    path: Path


def read_reference(path: Path, scenario: Scenario) -> Reference:
    """Read the FEA of a scenario.

    Parameters
    ----------
    path : Path
        A CSV file with the columns `layer, fem_mm` (deflection of the layer's top face on the tool axis, press
        positive) and either `step, time_s, force_N` (one row for each step, from 1, and layer), or `time_s`, or the
        load (`force_N`, `depth_mm`) alone, over which the FEA's own steps are interpolated. Rows with a `radius_mm`
        above 0 are the profile at peak load. More columns are allowed; semicolons and decimal commas are read, too. Or
        what a solver printed, where it is no such table by its ending: `.dat` and `.frd` of CalculiX, `.log` and `.txt`
        of FEBio (see `benchmark.models.fea_results`).
    scenario : Scenario
        What it is the FEA of: its layers, and the times and loads of its steps.

    Raises
    ------
    InputError
        File, line and column: a column or a cell that is missing or no number, layers, steps or loads that differ from
        the scenario's.
    """
    reader = None if header_sign(path) else READERS.get(path.suffix.lower())
    axis, off = parted(read_rows(path) if reader is None else reader(path, scenario))
    drive, names = scenario_drive(scenario), scenario.tissue.layer_names
    check_layers(axis, names)
    found = history(axis, drive, names)
    check_at_peak(off, drive, "with a radius above 0; that is the profile at the peak load", unsaid=0.0)
    check_radii(off, scenario.tool.radius, _widest(scenario))
    peak, radii = int(np.abs(drive.value).argmax()), profile_radii(scenario.tool.radius)
    shape = profile(off, names, radii, found.top[peak])
    result = ModelResult(
        model="fem",
        layers=names,
        time=drive.time,
        force=found.force,
        depth=drive.value if drive.control == "depth" else found.top[:, 0],
        top_deflection=found.top,
        profile_radii=radii,
        profile=shape,
        peak_step=peak,
        unknowns=None,
        notes=_notes(path, found.how),
        warnings=(
            EMPTY if np.isnan(shape).all() else NO_TIME,
            *slips(found.force, found.top, scenario.tissue.thickness, "fem_mm is in mm"),
            *_not_as_deep(path, drive, found.top[:, 0], names[0]),
        ),
    )
    return Reference(f"FEA of {path.name}", result, path)


def _not_as_deep(path: Path, drive: Drive, top: Array, layer: str) -> tuple[str, ...]:
    """That the surface's deflection (n,), m, is of another size than the depth the scenario prescribes it."""
    largest, expected = (float(np.nanmax(np.abs(each), initial=0.0)) for each in (top, drive.value))
    if drive.control != "depth" or not largest or 1.0 / FAR_APART < largest / expected < FAR_APART:
        return ()
    return (
        f"{path}, column fem_mm: the largest deflection of {layer} is {1e3 * largest:.3g} mm, where the scenario "
        f"presses it {1e3 * expected:.3g} mm deep; fem_mm is in mm",
    )


def _widest(scenario: Scenario) -> float:
    """The largest radius of tool, hole and specimen, or the thickness where that is more, in m."""
    support, thickness = scenario.support, scenario.tissue.thickness
    sizes = (scenario.tool.radius, support.hole_radius, support.specimen_radius, thickness)
    return max(size for size in sizes if size is not None and np.isfinite(size))


def write_template(path: Path, scenario: Scenario) -> None:
    """Write the table of a scenario's steps and layers, to be filled in with the deflections of a user's own FEA.

    Raises
    ------
    InputError
        Something is there already.
    OSError
        Where the file system refuses.
    """
    if path.exists():
        raise InputError(f"{path} is there already and is not overwritten; give another --out")
    write_csv(path, template(scenario_drive(scenario), scenario.tissue.layer_names))


def _notes(path: Path, how: str) -> dict[str, str]:
    digest = hashlib.sha256(read_regular(path, TABLE)).hexdigest()
    plain = {"model": f"the user's own FEA, {path}", "SHA-256 of the file": digest}
    return {**plain, "its steps": how} if how else plain


@dataclass(frozen=True)
class Own:
    """A user's own fast model in the wave's place and own FEA in the FEM's; None keeps the model of the harness.

    `repair` switches the effects of a model file on, in both models of the harness.
    """

    wave: UserFile | None = None
    reference: Reference | None = None
    repair: RepairedModel | None = None

    def place(self, model: str) -> UserFile | RepairedModel | None:
        """What a process of `"fem"` or `"wave"` needs to know of it."""
        return self.wave if model == "wave" and self.wave is not None else self.repair

    def name(self, model: str) -> str | None:
        """What the user calls the model in the place of `"fem"` or `"wave"`; None where there is none."""
        if model == "fem":
            return None if self.reference is None else self.reference.name
        return None if self.wave is None else self.wave.name


NOTHING = Own()
