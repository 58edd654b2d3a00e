"""A folder as a person has it: a session, a finished run, recordings, pictures, and things that are none of ours."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import cv2
import numpy as np

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
FOREIGN = {"notes.txt": "mine", ".git/HEAD": "ref: refs/heads/main\n", ".p.unfinished.bak": "mine", "data.part": "mine"}


def trial_text(rows: int = 200, peak: float = 2.0) -> str:
    """A synthetic press as CSV."""
    depth = 2.0 * np.minimum(np.arange(rows), rows - np.arange(rows)) / (rows / 2)
    force = peak * (np.maximum(depth - 0.05, 0.0) / 2.0) ** 1.3
    table = zip(np.arange(rows) * 0.05, depth, force, strict=True)
    return "time_s,depth_mm,force_N\n" + "".join(f"{t:.3f},{d:.6f},{f:.6f}\n" for t, d, f in table)


def make_scene(folder: Path) -> Path:
    """Put everything into a new folder that the commands read, and what they must not touch."""
    folder.mkdir(parents=True)
    for name, text in FOREIGN.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    (folder / "session").mkdir()
    for number, peak in enumerate((1.9, 2.0, 2.1), start=1):
        (folder / "session" / f"press_{number}.csv").write_text(trial_text(peak=peak))
    (folder / "foreign.csv").write_text(trial_text())
    (folder / "camera.toml").write_text(CAMERA)
    _pictures(folder / "pictures")
    return folder


def complete_scene(folder: Path) -> None:
    """Add what commands of ours make: a recording, one that was cut, a finished run."""
    run(_command("capture", "made"), folder)
    recording = (folder / "made" / "trial_001.mcap").read_bytes()
    (folder / "trial.mcap").write_bytes(recording)
    (folder / "cut.mcap").write_bytes(recording[: int(0.8 * len(recording))])
    run(_command("run", "finished"), folder)


def _command(verb: str, out: str) -> Command:
    found = next(each for each in COMMANDS if each.verb == verb)
    return Command(verb, found.module, (*found.words[:-1], out), out)


def _pictures(folder: Path) -> None:
    folder.mkdir()
    for frame in range(12):
        picture = np.full((480, 640), 220, np.uint8)
        for row in range(3):
            for column in range(6):
                place = (int(100 + 80 * column + frame), int(120 + 100 * row))
                cv2.circle(picture, place, 12, 20, -1, cv2.LINE_AA)
        cv2.imwrite(str(folder / f"frame_{frame:03d}.png"), picture)


def contents(folder: Path, without: tuple[str, ...] = ()) -> dict[str, str]:
    """Hash of every file of a folder by its path, but of those under the names `without`."""
    found = {}
    for parent, folders, files in os.walk(folder):
        for name in (*files, *(each for each in folders if not any(Path(parent, each).iterdir()))):
            path = Path(parent, name)
            relative = path.relative_to(folder).as_posix()
            if relative.split("/")[0] not in without:
                data = path.read_bytes() if path.is_file() else b"folder"
                found[relative] = hashlib.sha256(data).hexdigest()
    return found
