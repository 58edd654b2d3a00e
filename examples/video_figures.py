"""The pictures of docs/video.md, from the shipped film (synthetic): `python examples/video_figures.py [FOLDER]`."""

import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import matplotlib.pyplot as plt
import pandas as pd

PHANTOM = Path(__file__).parents[1] / "benchmark" / "sessions" / "phantom"
ROWS, COLUMNS = slice(120, 345), slice(90, 550)
"""Of the picture, where the markers are."""


def tracked(folder: Path) -> tuple[Path, Path]:
    """Track the film as the page says; the still and the table."""
    still, table = folder / "still.png", folder / "markers.csv"
    source = [PHANTOM / "press_01.mcap", "--camera", PHANTOM / "camera.toml", "--out", table, "--still", still]
    subprocess.run([sys.executable, "-m", "bench_hw", "track", *map(str, source), "--quiet"], check=True)
    return still, table


def moved(table: Path) -> plt.Figure:
    """How far each marker is from where it began, over time."""
    markers = pd.read_csv(table)
    figure, axes = plt.subplots(figsize=(6, 3))
    for _, rows in markers.groupby("marker"):
        x, y = (rows[name] - rows[name].iloc[:10].mean() for name in ("x_mm", "y_mm"))
        axes.plot(rows["time_s"], 1e3 * (x**2 + y**2) ** 0.5, linewidth=0.8)
    axes.set(xlabel="time (s)", ylabel="way of each marker (µm)", title="one press of 2 mm, synthetic")
    return figure


if __name__ == "__main__":
    out = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    with tempfile.TemporaryDirectory() as folder:
        still, table = tracked(Path(folder))
        shown = cv2.imread(str(still))[ROWS, COLUMNS]
        cv2.imwrite(str(out / "video-still.png"), shown & 0xF0, [cv2.IMWRITE_PNG_COMPRESSION, 9])
        moved(table).savefig(out / "video-markers.png", dpi=80, bbox_inches="tight")
