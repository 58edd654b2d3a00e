"""Asking for the picture: a process of its own, because a graphics driver that is missing can end the process."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from benchmark.models.result import FieldSnapshot
from benchmark.picture.grid import save_grid

PACKAGES = "libegl1 libegl-mesa0"
"""Debian packages that bring off-screen rendering."""

SECONDS = 180.0


@dataclass(frozen=True)
class Drawn:
    """The picture as PNG, or why there is none, in one sentence."""

    png: bytes
    reason: str = ""


def draw_pressed(snapshot: FieldSnapshot, axis: tuple[float, float], reach: float) -> Drawn:
    """Draw the deformed body of a snapshot.

    Parameters
    ----------
    snapshot
        Fields of the press.
    axis
        (x, y) in m of the tool's axis.
    reach
        Distance in m from it up to which plane layers are shown.
    """
    with tempfile.TemporaryDirectory() as name:
        vtu, png = Path(name) / "pressed.vtu", Path(name) / "pressed.png"
        save_grid(snapshot, vtu)
        place = [repr(value) for value in (*axis, reach)]
        command = [sys.executable, "-m", "benchmark.picture.drawing", str(vtu), str(png), *place]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=SECONDS, check=False, env=_environment()
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            return Drawn(b"", f"the drawing was given up ({type(error).__name__})")
        if done.returncode != 0 or not png.is_file():
            return Drawn(b"", _reason(done.returncode, done.stderr))
        return Drawn(png.read_bytes())


def _environment() -> dict[str, str]:
    """That of a process whose modules do not come from the current folder."""
    paths = [str(Path(__file__).parents[2]), *filter(None, [os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONSAFEPATH": "1", "PYTHONPATH": os.pathsep.join(paths)}


def _reason(code: int, said: str) -> str:
    lines = [line for line in said.splitlines() if line.strip()]
    last = f": {lines[-1].strip()[:200]}" if lines else ""
    return f"off-screen rendering failed (exit code {code}{last})"
