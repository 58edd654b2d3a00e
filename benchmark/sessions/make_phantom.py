"""Makes the shipped phantom session: synthetic presses of a silicone sheet over a hole, filmed from below.

    python -m benchmark.sessions.make_phantom FOLDER

Nothing in it is measured, and every file says so. The sheet is `hidden_sheet`; the bench's own drivers capture it on
its simulated devices: ten presses of the published protocol (2 mm at 1 mm/s), three of a richer one. A simulated camera
with the published lens distortion films the 18 markers. Of the first trial of each protocol the film is kept, of the
others the markers as `track` finds them. What differs from trial to trial (stiffness, contact, where the tool meets the
grid) and what the devices add (counts of 0.049 mm, noise) is drawn from one seed; `truth.toml` names it all and is not
read by any fit. The fit works with the same finite elements: it tests the chain from pictures to parameters, not the
physics.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from bench_hw.capture.order import CaptureOrder
from bench_hw.capture.progress import Silent
from bench_hw.capture.session import capture
from bench_hw.motion.protocol_file import load_protocol
from bench_hw.rig.rig_file import LoadedRig, simulated_rig
from bench_hw.simulated.specimen import MarkerGrid
from bench_hw.simulated.tabulated import SheetTable, TabulatedSpecimen, write_sheet
from bench_hw.tables import write_trial_csv
from bench_hw.trial_file import read_trial_mcap
from bench_hw.vision.tracking.film import TrackOrder, track
from benchmark.errors import SolverError
from benchmark.sessions.phantom_sheet import RELAXATION, TrueTrial, hidden_sheet, session_text, truth_text

PRESSES: Final = (("press", "paper_press", 10), ("rich", "rich_press", 3))
"""Condition, protocol and number of trials."""
SEED: Final = 20
GRID: Final = MarkerGrid(rows=3, columns=6, spacing=8e-3)
DISTORTION: Final = (0.07, -0.48, -0.01, -0.01, 0.0)
"""The published lens (section 3.2.1); it folds over inside the picture below a focal length of some 610 px."""
GAIN_SCATTER: Final = 0.02
CONTACT: Final = 5e-3
CONTACT_SCATTER: Final = 0.05e-3
AXIS_SCATTER: Final = 0.3e-3
RATE: Final = 100.0
CAMERA: Final = {
    "rate": "12 Hz",
    "focal_px": 650.0,
    "distortion": list(DISTORTION),
    "noise": 2.0,
    "quality": 80,
}


def main(arguments: list[str] | None = None) -> int:
    """Write the session into the folder that the command line names."""
    parser = argparse.ArgumentParser(description="Make the synthetic phantom session.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--sheet", type=Path, help="also write the sheet's table here")
    options = parser.parse_args(arguments)
    sheet, trials = hidden_sheet(), tuple(drawn_trials(np.random.default_rng(SEED)))
    if options.sheet is not None:
        write_sheet(options.sheet, sheet)
    with tempfile.TemporaryDirectory() as scratch:
        made = Path(scratch) / "session"
        made.mkdir()
        for trial in trials:
            make_trial(sheet, trial, Path(scratch) / trial.name, made)
            print(f"{trial.name} made", flush=True)
        (made / "session.toml").write_text(session_text(trials, GRID), encoding="utf-8")
        (made / "truth.toml").write_text(truth_text(trials), encoding="utf-8")
        shutil.copytree(made, options.folder, dirs_exist_ok=True)
    print(f"{len(trials)} synthetic trials in {options.folder}")
    return 0


def drawn_trials(generator: np.random.Generator) -> Iterator[TrueTrial]:
    """Draw what differs from trial to trial."""
    number = 0
    for condition, protocol, count in PRESSES:
        for index in range(1, count + 1):
            number += 1
            yield TrueTrial(
                name=f"{condition}_{index:02d}",
                condition=condition,
                protocol=protocol,
                gain=float(np.exp(generator.normal(0.0, GAIN_SCATTER))),
                contact=CONTACT + float(generator.normal(0.0, CONTACT_SCATTER)),
                axis=(float(generator.normal(0.0, AXIS_SCATTER)), float(generator.normal(0.0, AXIS_SCATTER))),
                seed=1000 * SEED + number,
                film=index == 1,
            )


def make_trial(sheet: SheetTable, trial: TrueTrial, scratch: Path, folder: Path) -> None:
    """Capture a trial with the bench's drivers and keep its film, or its tables.

    Raises
    ------
    SolverError
        The capture ended with a fault.
    """
    specimen = TabulatedSpecimen(sheet, RELAXATION, trial.gain, trial.axis, GRID)
    order = CaptureOrder(
        load_protocol(_protocol(trial)), _rig(trial), scratch, condition=trial.condition, fast=True, seed=trial.seed
    )
    outcome = capture(order, Silent(), specimen=specimen)
    if outcome.fault is not None:
        raise SolverError(f"{trial.name}: {outcome.fault.message}")
    captured = outcome.trials[0]
    shutil.copyfile(scratch / "camera.toml", folder / "camera.toml")
    if trial.film:
        shutil.copyfile(captured, folder / f"{trial.name}.mcap")
        return
    write_trial_csv(folder / f"{trial.name}.csv", replace(read_trial_mcap(captured), extra={}, extra_units={}))
    track(TrackOrder(str(captured), scratch / "camera.toml", folder / f"{trial.name}_markers.csv"))


def _protocol(trial: TrueTrial) -> str:
    """The protocol's file beside this one, or the name of one that ships with the bench."""
    path = Path(__file__).with_name(f"{trial.protocol}.toml")
    return str(path) if path.is_file() else trial.protocol


def _rig(trial: TrueTrial) -> LoadedRig:
    """The simulated bench: depth zero is where the file says, the sheet a little off it."""
    return simulated_rig(
        {
            "force": {"rate": f"{RATE:g} Hz"},
            "camera": dict(CAMERA),
            "simulation": {"contact": f"{1e3 * trial.contact:.6f} mm", "seed": trial.seed},
        }
    )


if __name__ == "__main__":
    sys.exit(main())
