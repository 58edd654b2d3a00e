"""Foreign code in a process of its own: VTK's readers, which a damaged file ends, and the mesher, for its seed.

`python -m fem.mesh.surface.own_process read FILE` writes points and triangles to standard output; STL has no indices
and is read where it is wanted, see `surface_file`. With `fill` the mesher's arguments come by standard input.
"""

from __future__ import annotations

import ctypes
import importlib.util
import io
import logging
import mmap
import os
import platform
import subprocess
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

import numpy as np
import numpy.typing as npt

from fem.arrays import FloatArray, IntArray
from fem.errors import FemError

TIME = 120.0
"""Seconds that reading a file may take: a liver of 200,000 triangles needs two, most of it the start of VTK."""
MEMORY = (4 << 30, 100)
"""Address space of the process in bytes, and for each byte of the file."""
SEED_SOURCE = "_ZNSt13random_device9_M_getvalEv"
"""std::random_device::operator() in libstdc++: pytetwild 0.4.2 shuffles the triangles by it before it inserts them."""
RETURN_SEED = b"\xb8\x2a\x00\x00\x00\xc3"
"""x86-64: mov eax, 42; ret. fTetWild's other generator has this seed, too."""


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
    try:
        done = _run("read", str(file.absolute()), time=TIME)
    except subprocess.TimeoutExpired:
        raise FemError(f"surface {file}: cannot be read within {TIME:g} s; is it damaged?") from None
    if done.returncode == 1 and done.stderr:
        raise FemError(f"surface {file}: {_last_line(done).partition(': ')[2]}")
    if done.returncode != 0:
        raise FemError(
            f"surface {file}: its reader crashed; allowed: faces that name points of the file, and as many points and "
            "faces as it says"
        )
    with np.load(io.BytesIO(done.stdout), allow_pickle=False) as arrays:
        return arrays["points"], arrays["triangles"]


def tetrahedralize_apart(**arguments: npt.ArrayLike) -> tuple[FloatArray, IntArray]:
    """Points (P, 3) and tetrahedra (E, 4) by fTetWild in a process of its own, from one seed and by one thread.

    Equal arguments give equal arrays on one machine where `_set_seed` can set the seed; elsewhere each run has another
    mesh. The process has to be a new one each time: a second generator of fTetWild goes on from call to call.

    Parameters
    ----------
    **arguments
        Those of `pytetwild.tetrahedralize`.

    Raises
    ------
    FemError
        The mesher is not installed, or failed.
    """
    if importlib.util.find_spec("pytetwild") is None:
        raise FemError("geometry = 'surface' needs the mesher pytetwild, which is not installed")
    stream = io.BytesIO()
    np.savez(stream, allow_pickle=False, **arguments)
    done = _run("fill", given=stream.getvalue())
    if done.returncode != 0:
        raise FemError(f"surface: the mesher failed ({_last_line(done) or f'exit code {done.returncode}'})")
    with np.load(io.BytesIO(done.stdout), allow_pickle=False) as arrays:
        return arrays["points"], arrays["tetrahedra"]


def _run(*words: str, given: bytes = b"", time: float | None = None) -> subprocess.CompletedProcess[bytes]:
    """Run this module as a process, with bytes for its standard input and the time in s that it may take."""
    root = str(Path(__file__).resolve().parents[3])
    path = os.pathsep.join(each for each in (root, os.environ.get("PYTHONPATH", "")) if each)
    command = [sys.executable, "-m", "fem.mesh.surface.own_process", *words]
    environment = {**os.environ, "PYTHONPATH": path, "PYTHONSAFEPATH": "1", "PYTHONIOENCODING": "utf-8"}
    return subprocess.run(command, input=given, env=environment, capture_output=True, timeout=time, check=False)


def _last_line(done: subprocess.CompletedProcess[bytes]) -> str:
    """The last line of what a process said of its failure, or ""."""
    return (done.stderr.decode("utf-8", "replace").strip().splitlines() or [""])[-1]


def has_seed() -> bool:
    """Whether the mesher's seed can be set here, so far as that can be told without doing it."""
    return _seed_source() is not None


def _seed_source() -> int | None:
    """Where the code of the C++ library's random device is; None where it is another library or processor."""
    if sys.platform != "linux" or platform.machine() != "x86_64":
        return None
    try:
        return ctypes.cast(ctypes.CDLL("libstdc++.so.6")[SEED_SOURCE], ctypes.c_void_p).value
    except (OSError, AttributeError):
        return None


def _set_seed() -> bool:
    """Let the C++ library's random device give one number in this process; whether it does.

    pytetwild has no argument for the seed. Possible with libstdc++ on x86-64, where the system lets a process change
    its own code.
    """
    place = _seed_source()
    if place is None:
        return False
    protect = ctypes.CDLL(None).mprotect
    protect.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int)
    start = place - place % mmap.PAGESIZE
    length = place + len(RETURN_SEED) - start
    if protect(start, length, mmap.PROT_READ | mmap.PROT_WRITE) != 0:
        return False
    ctypes.memmove(place, RETURN_SEED, len(RETURN_SEED))
    return bool(protect(start, length, mmap.PROT_READ | mmap.PROT_EXEC) == 0)


def _fill(given: BinaryIO, out: BinaryIO) -> int:
    from pytetwild.pytetwild import tetrahedralize

    _set_seed()
    with np.load(io.BytesIO(given.read()), allow_pickle=False) as arrays:
        arguments = {name: value if value.ndim else value.item() for name, value in arrays.items()}
    points, tetrahedra = tetrahedralize(**arguments, num_threads=1)
    return _write(out, points=np.asarray(points, dtype=np.float64), tetrahedra=np.asarray(tetrahedra, dtype=np.int64))


def _read(file: Path, out: BinaryIO) -> int:
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
    return _write(out, points=points, triangles=triangles)


def _write(out: BinaryIO, **arrays: FloatArray | IntArray) -> int:
    stream = io.BytesIO()
    np.savez(stream, allow_pickle=False, **arrays)
    out.write(stream.getvalue())
    return 0


def _main(words: list[str]) -> int:
    with os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)  # what the libraries print is no part of the arrays
        return _read(Path(words[1]), out) if words[0] == "read" else _fill(sys.stdin.buffer, out)


if __name__ == "__main__":
    sys.exit(_main(sys.argv[1:]))
