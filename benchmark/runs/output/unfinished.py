"""Unfinished work beside the folder of its result, from which the same run goes on after it was interrupted."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from benchmark.errors import InputError, InterruptedRunError, SolverError
from reports.manifest import ForeignFilesError, remove_empty, remove_known
from reports.result_folder import KeptElsewhereError

KEPT = re.compile(r"(?:fem_steps\w*|fem_steps_edge_[0-9.e+-]+|fem_mesh)\.kept(?:\.[0-9]+\.part)?")
"""Names of the files in which the FEM keeps its steps and its mesh."""


@contextmanager
def unfinished(folder: Path) -> Iterator[Path]:
    """Lend the hidden folder `.NAME.unfinished` beside a result to its run, and remove it when the result is written.

    It is made only when a run is long enough to keep something. An interruption or a crash leaves what is in it, and so
    does a file system that takes the result nowhere; where the result is kept elsewhere, it goes.

    Raises
    ------
    InputError
        There is something else of that name, or the file system refused, with what to do.
    InterruptedRunError, SolverError
        An interruption or a crash that left something, with what to do.
    """
    path = folder.with_name(f".{folder.name}.unfinished")
    _refuse_other(path)
    try:
        yield path
    except KeyboardInterrupt:
        if _holds_work(path):
            raise InterruptedRunError(f"interrupted; {_left(path, folder)}") from None
        raise
    except SolverError as error:
        if _holds_work(path):
            raise SolverError(f"{error}; {_left(path, folder)}") from error
        raise
    except KeptElsewhereError:
        remove_known(path, is_kept)
        raise
    except ForeignFilesError:
        raise
    except OSError as error:
        if _holds_work(path):
            raise InputError(f"{folder} cannot be written: {error.strerror or error}; {_left(path, folder)}") from error
        raise
    finally:
        remove_empty({path, *path.rglob("*")})
    remove_known(path, is_kept)


def is_kept(name: str) -> bool:
    """Whether a file in a folder of unfinished work is ours, by its name."""
    return KEPT.fullmatch(name) is not None


def _refuse_other(path: Path) -> None:
    """Refuse a name that is taken by something of somebody else's, which would be removed at the end."""
    others = path.is_dir() and any(not each.is_dir() and not is_kept(each.name) for each in path.rglob("*"))
    if others or (path.exists() and not path.is_dir()):
        raise InputError(
            f"{path} is where an unfinished run is kept, but holds something else; move it, or give another --out"
        )


def _holds_work(path: Path) -> bool:
    """Whether anything was kept; a folder may have been made before an input was refused."""
    return any(each.is_file() for each in path.rglob("*"))


def _left(path: Path, folder: Path) -> str:
    """What a person may do after an interruption."""
    return f"what was computed is in {path}; the same command with --out {folder} goes on from there"
