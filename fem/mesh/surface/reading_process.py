"""Surface files read by VTK in a process of their own: a file whose faces name points that it lacks ends that process.

`python -m fem.mesh.surface.reading_process FILE` writes points and triangles to standard output. STL has no indices
and is read where it is wanted, see `surface_file`.
"""

from __future__ import annotations

import io
import logging
import os
import subprocess
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.errors import FemError

TIME = 120.0
"""Seconds that reading a file may take: a liver of 200,000 triangles needs two, most of it the start of VTK."""
MEMORY = (4 << 30, 100)
"""Address space of the process in bytes, and for each byte of the file."""


def read_triangles(file: Path) -> tuple[FloatArray, IntArray]:
    """Points (P, 3) in the file's unit and corners (T, 3) of its triangles, read by VTK in this process.

    Raises
    ------
    FemError
        It cannot be read, or has no triangles.
    """
    import pyvista

    try:
        with _silent():
            data = pyvista.read(file)
        polygons = data if isinstance(data, pyvista.PolyData) else data.extract_surface(algorithm="dataset_surface")
        triangles = polygons.triangulate().clean(tolerance=1e-9)
    except (ValueError, RuntimeError, OSError, AttributeError, MemoryError) as error:
        raise FemError(f"surface {file}: cannot be read ({error})") from error
    if triangles.n_cells == 0 or triangles.faces.size == 0:
        raise FemError(f"surface {file}: has no triangles")
    corners = np.asarray(triangles.faces).reshape(-1, 4)[:, 1:].astype(np.int64)
    return np.asarray(triangles.points, dtype=np.float64), corners


@contextmanager
def _silent() -> Iterator[None]:
    """What the reader has to say ends in one error, not in the log of VTK."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            yield
    finally:
        logging.disable(before)


def read_apart(file: Path) -> tuple[FloatArray, IntArray]:
    """The same in a process of its own, whose crash is an error of the file.

    Raises
    ------
    FemError
        As `read_triangles`; or the process crashed, took too long, or too much memory.
    """
    root = str(Path(__file__).resolve().parents[3])
    path = os.pathsep.join(each for each in (root, os.environ.get("PYTHONPATH", "")) if each)
    command = [sys.executable, "-m", "fem.mesh.surface.reading_process", str(file.absolute())]
    environment = {**os.environ, "PYTHONPATH": path, "PYTHONSAFEPATH": "1", "PYTHONIOENCODING": "utf-8"}
    try:
        done = subprocess.run(command, env=environment, capture_output=True, timeout=TIME, check=False)
    except subprocess.TimeoutExpired:
        raise FemError(f"surface {file}: cannot be read within {TIME:g} s; is it damaged?") from None
    if done.returncode == 1 and done.stderr:
        said = done.stderr.decode("utf-8", "replace").strip().splitlines()
        raise FemError(f"surface {file}: {said[-1].partition(': ')[2]}")
    if done.returncode != 0:
        raise FemError(
            f"surface {file}: its reader crashed; allowed: faces that name points of the file, and as many points and "
            "faces as it says"
        )
    with np.load(io.BytesIO(done.stdout), allow_pickle=False) as arrays:
        return arrays["points"], arrays["triangles"]


def _main(file: Path) -> int:
    if sys.platform != "win32":
        import resource

        least, times = MEMORY
        most = least + times * file.stat().st_size
        hard = resource.getrlimit(resource.RLIMIT_AS)[1]
        resource.setrlimit(resource.RLIMIT_AS, (most if hard < 0 else min(most, hard), hard))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        points, triangles = read_triangles(file)
    except FemError as error:
        print(str(error).replace(f"surface {file}: ", ": ", 1), file=sys.stderr)
        return 1
    stream = io.BytesIO()
    np.savez(stream, points=points, triangles=triangles)
    sys.stdout.buffer.write(stream.getvalue())
    return 0


if __name__ == "__main__":
    sys.exit(_main(Path(sys.argv[1])))
