"""A folder as a person has it: a session, a finished run, recordings, pictures, and things that are none of ours."""

from __future__ import annotations

import hashlib
import os
import shutil
from collections.abc import Collection
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from bench_hw.storage.folder_lock import SIGN
from tests.torture.commands import COMMANDS, Command, run

CAMERA = """schema = 1
image_size = [640, 480]
[matrix]
fx = 800.0
fy = 800.0
cx = 320.0
cy = 240.0
[distortion]
k1 = 0.0
k2 = 0.0
p1 = 0.0
p2 = 0.0
[plane]
mm_per_px = 0.1
"""
PAD = """schema = 1
name = "pad"
citation = "synthetic, for the torture test"
[[layers]]
name = "pad"
thickness = "10 mm"
density = "1000 kg/m^3"
youngs_modulus = "20 kPa"
poisson_ratio = 0.49
"""
SHEET = """schema = 1
name = "pressed_pad"
specimen = "pad.toml"
synthetic = true
trials = [
  { file = "press_1.csv", condition = "press" },
  { file = "press_2.csv", condition = "press" },
  { file = "press_3.csv", condition = "press" },
]
[tool]
radius = "5 mm"
contact = "rigid_bonded"
[support]
kind = "bonded"
"""
CONTEXT = """schema = 1
name = "a trainer"
question_of_interest = "Is it right?"
context_of_use = "Presses to 5 N."
model_influence = "high"
decision_consequence = "low"
quantities = ["force over depth"]
max_force = "5 N"
"""
GATE = """schema = 1
name = "small"
[timing]
rounds = [1, 1]
blocks = 1
margin = "90 %"
[[tolerances]]
quantity = "*"
rtol = "0.1 %"
atol = "0 mm"
[[cases]]
name = "linear.wave"
model = "wave"
scenario = "skin-5N"
set = { "wave.large_press" = "linear", "load.observations" = "2" }
[[timed]]
name = "wave.frame"
workload = "wave_frame"
scenario = "skin-5N"
references = ["elements"]
calls = 1
"""
FOREIGN = {"notes.txt": "mine", ".git/HEAD": "ref: refs/heads/main\n", ".p.unfinished.bak": "mine", "data.part": "mine"}


def trial_text(rows: int = 200, peak: float = 2.0, deepest: float = 2.0, power: float = 1.3) -> str:
    """A synthetic press as CSV, with a touch at 0.05 mm."""
    depth = deepest * np.minimum(np.arange(rows), rows - np.arange(rows)) / (rows / 2)
    force = peak * (np.maximum(depth - 0.05, 0.0) / deepest) ** power
    table = zip(np.arange(rows) * 0.05, depth, force, strict=True)
    return "time_s,depth_mm,force_N\n" + "".join(f"{t:.3f},{d:.6f},{f:.6f}\n" for t, d, f in table)


def attempt_text(astray: float, rows: int = 400) -> str:
    """A synthetic record of a hand that goes to three targets."""
    time = 0.01 * np.arange(rows)
    target = np.minimum(3 * np.arange(rows) // rows, 2)
    aims = np.array([[10.0, 10.0, 1.0], [30.0, 12.0, 2.0], [20.0, 35.0, 1.5]])[target]
    here = aims * (1.0 - np.exp(-(time % 1.34) / 0.2))[:, None] + astray * np.sin(57.0 * time)[:, None]
    here[:, 2] = np.maximum(here[:, 2], 0.0)
    head = "time_s,tool,x_mm,y_mm,depth_mm,force_N,target,target_x_mm,target_y_mm,target_depth_mm\n"
    numbers = np.column_stack([time, 0 * time, here, 1.3 * here[:, 2], target, aims])
    return head + "".join(",".join(f"{number:.10g}" for number in row) + "\n" for row in numbers)


def make_scene(folder: Path) -> Path:
    """Put everything into a new folder that the commands read, and what they must not touch."""
    folder.mkdir(parents=True)
    for name, text in FOREIGN.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    (folder / "session").mkdir()
    for number, peak in enumerate((1.9, 2.0, 2.1), start=1):
        (folder / "session" / f"press_{number}.csv").write_text(trial_text(peak=peak))
    shutil.copytree(folder / "session", folder / "sheet")
    (folder / "sheet" / "pad.toml").write_text(PAD)
    (folder / "sheet" / "session.toml").write_text(SHEET)
    shutil.copytree(folder / "sheet", folder / "pads")  # shallow presses, which the finite elements follow at once
    for number, peak in enumerate((0.60, 0.62, 0.64), start=1):
        (folder / "pads" / f"press_{number}.csv").write_text(trial_text(80, peak, 1.0, 1.05))
    (folder / "gate.toml").write_text(GATE)
    (folder / "context.toml").write_text(CONTEXT)
    shutil.copytree(folder / "session", folder / "fresh")
    for group, astray in (("experts", 0.05), ("novices", 0.4)):
        (folder / group).mkdir()
        for number in range(1, 4):
            (folder / group / f"attempt_{number}.csv").write_text(attempt_text(astray * (1.0 + 0.1 * number)))
    (folder / "foreign.csv").write_text(trial_text())
    (folder / "camera.toml").write_text(CAMERA)
    _pictures(folder / "pictures")
    return folder


def complete_scene(folder: Path, verbs: Collection[str]) -> None:
    """Add what commands of ours make and `verbs` read: a recording, one that was cut, finished runs, a baseline."""
    if {"export", "recover"} & set(verbs):
        run(_command("capture", "made"), folder)
        recording = (folder / "made" / "trial_001.mcap").read_bytes()
        (folder / "trial.mcap").write_bytes(recording)
        (folder / "cut.mcap").write_bytes(recording[: int(0.8 * len(recording))])
    if {"report", "report, two", "dossier"} & set(verbs):
        run(_command("run", "finished"), folder)
        shutil.copytree(folder / "finished", folder / "other")
    if "check" in verbs:
        run(_command("check --accept", "base.json"), folder)
    if "calibrate" in verbs:
        _boards(folder / "boards")


def make_litter(folder: Path) -> None:
    """What a kill leaves, for `clean` to remove: a lock, kept steps, a folder and a file that were being written."""
    (folder / ".q.lock").write_text(f"{SIGN}run, process 1 on nowhere\n")
    (folder / ".q.unfinished").mkdir(exist_ok=True)
    (folder / ".q.unfinished" / "fem_steps.kept").write_bytes(b"steps")
    (folder / ".q.0123abcd.part").mkdir(exist_ok=True)
    (folder / ".q.csv.0123abcd.part").write_text("half")
    os.utime(folder / ".q.csv.0123abcd.part", (0, 0))


def _command(verb: str, out: str) -> Command:
    found = next(each for each in COMMANDS if each.verb == verb)
    return Command(verb, found.module, tuple(out if word == found.out else word for word in found.words), out)


def _boards(folder: Path) -> None:
    """Views of a chessboard through a camera without distortion, softened as a lens does."""
    folder.mkdir()
    draw, square = np.random.default_rng(3), 40
    flat = np.full((9 * square, 12 * square), 225, np.uint8)
    for row in range(7):
        for column in range(10):
            if (row + column) % 2 == 0:
                flat[(row + 1) * square : (row + 2) * square, (column + 1) * square : (column + 2) * square] = 30
    corners = np.array([[x, y, 0.0] for x in (-48.0, 48.0) for y in (-36.0, 36.0)])  # mm
    pixels = np.array([[x, y] for x in (0.0, 12.0 * square) for y in (0.0, 9.0 * square)], np.float32)
    lens = np.array([[620.0, 0.0, 326.0], [0.0, 618.0, 233.0], [0.0, 0.0, 1.0]])
    for view in range(24):
        turn = np.array([*draw.uniform(-0.5, 0.5, 2), draw.uniform(-0.3, 0.3)])
        place = np.array([*draw.uniform(-18.0, 18.0, 2), draw.uniform(130.0, 180.0)])
        seen = cv2.projectPoints(corners, turn, place, lens, np.zeros(5))[0].reshape(-1, 2).astype(np.float32)
        onto = cv2.getPerspectiveTransform(pixels, seen)
        large = cv2.warpPerspective(
            flat, np.diag([2.0, 2.0, 1.0]) @ onto, (1280, 960), borderValue=225, flags=cv2.INTER_LINEAR
        )
        picture = cv2.GaussianBlur(cv2.resize(large, (640, 480), interpolation=cv2.INTER_AREA), (0, 0), 0.7)
        noisy = picture + draw.normal(0.0, 2.0, picture.shape)
        _write_picture(folder / f"view_{view:02d}.png", np.clip(noisy, 0, 255).astype(np.uint8))


def _pictures(folder: Path) -> None:
    folder.mkdir()
    for frame in range(12):
        picture = np.full((480, 640), 220, np.uint8)
        for row in range(3):
            for column in range(6):
                place = (int(100 + 80 * column + frame), int(120 + 100 * row))
                cv2.circle(picture, place, 12, 20, -1, cv2.LINE_AA)
        _write_picture(folder / f"frame_{frame:03d}.png", picture)


def _write_picture(path: Path, picture: NDArray[np.uint8]) -> None:
    """Not by OpenCV itself, which a path of bytes that are no text crashes."""
    path.write_bytes(cv2.imencode(path.suffix, picture)[1].tobytes())


def contents(folder: Path, without: tuple[str, ...] = ()) -> dict[str, str]:
    """Hash of every file of a folder by its path, but of those at or under the paths `without`."""
    found = {}
    for parent, folders, files in os.walk(folder):
        for name in (*files, *(each for each in folders if not any(Path(parent, each).iterdir()))):
            path = Path(parent, name)
            relative = path.relative_to(folder).as_posix()
            if not any(f"{relative}/".startswith(f"{name}/") for name in without):
                data = path.read_bytes() if path.is_file() else b"folder"
                found[relative] = hashlib.sha256(data).hexdigest()
    return found
