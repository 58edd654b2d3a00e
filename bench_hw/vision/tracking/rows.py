"""The table of tracks, written row by row: one for each frame and marker, empty cells where it was not seen."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from bench_hw.atomic import replacing
from bench_hw.tables.output import rounded_cells
from bench_hw.vision.camera.model import FloatArray


class RowWriter:
    """Writes rows into an open table.

    Parameters
    ----------
    stream : TextIO
        Where to; the header is written at once.
    unit : str
        `mm` or `px`.
    """

    def __init__(self, stream: TextIO, unit: str) -> None:
        self._stream = stream
        self.rows = 0
        stream.write(f"time_s,marker,x_{unit},y_{unit},confidence\n")

    def write(self, time: float, places: FloatArray, confidence: FloatArray) -> None:
        """Write a frame.

        Parameters
        ----------
        time : float
            s.
        places : ndarray, shape (m, 2)
            In the table's unit; a marker with NaN in it gets empty cells.
        confidence : ndarray, shape (m,)
            0 to 1.
        """
        stamp = repr(float(time))
        x, y = rounded_cells(places[:, 0]), rounded_cells(places[:, 1])
        cells = enumerate(zip(x, y, confidence.tolist(), strict=True))
        lines = [f"{stamp},{marker},{x},{y},{share:.4f}\n" for marker, (x, y, share) in cells]
        self._stream.write("".join(lines))
        self.rows += len(lines)


@contextmanager
def table_of_tracks(path: Path, unit: str) -> Iterator[RowWriter]:
    """Open a table that appears whole when the block ends well, and not at all otherwise.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as stream:
        yield RowWriter(stream, unit)
