"""The errors of the bench: each knows the exit code of the command line it ends.

What is wrong with a file or an argument is an `InputError` (exit 2); what a device did wrong is a
`DeviceError` (exit 5). The text is one paragraph: what, where, which value, what is allowed. A library that
an installation may leave out is named with the extra that has it.
"""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType


class BenchError(Exception):
    """Anything the bench refuses or cannot do; `exit_code` is what the command line ends with."""

    exit_code = 2


class InputError(BenchError, ValueError):
    """An argument, a configuration or a file that cannot be used (exit code 2)."""

    exit_code = 2


class DeviceError(BenchError):
    """A device that is missing, wrong, silent or broken (exit code 5)."""

    exit_code = 5


class TrialFileError(InputError):
    """A native trial file that cannot be written, read or recovered.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    problem : str
        What is wrong, and what is allowed.
    """

    def __init__(self, path: Path, problem: str) -> None:
        super().__init__(f"{path}: {problem}")
        self.path = path
        self.problem = problem


class TableError(InputError):
    """A CSV table that is refused, with the place of the first thing that is wrong.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    problem : str
        What is wrong.
    allowed : str
        What would have been accepted.
    row : int, optional
        Line of the file, counted from 1 (the header is line 1).
    column : str, optional
        Name of the column.
    value : str, optional
        The cell as it stands in the file.
    """

    def __init__(
        self,
        path: Path,
        problem: str,
        allowed: str,
        *,
        row: int | None = None,
        column: str | None = None,
        value: str | None = None,
    ) -> None:
        self.path = path
        self.problem = problem
        self.allowed = allowed
        self.row = row
        self.column = column
        self.value = value
        super().__init__(f"{path}{self._place()}: {problem}; allowed: {allowed}")

    def _place(self) -> str:
        parts = [] if self.row is None else [f"row {self.row}"]
        parts += [] if self.column is None else [f"column {self.column!r}"]
        parts += [] if self.value is None else [f"value {_shortened(self.value)!r}"]
        return f" ({', '.join(parts)})" if parts else ""


def _shortened(value: str, length: int = 40) -> str:
    return value if len(value) <= length else value[: length - 3] + "..."


EXTRAS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "cv2": ("pictures and films need OpenCV", "camera"),
        "dask": ("a cluster needs Dask", "cluster"),
        "distributed": ("a cluster needs Dask", "cluster"),
        "pyvista": ("surfaces and solids need VTK, by PyVista", "solids"),
        "pytetwild": ("a solid from a surface needs fTetWild, by pytetwild", "solids"),
        "vtkmodules": ("surfaces and solids need VTK, by PyVista", "solids"),
    }
)
"""For each module what needs it, and the extra of the package that has it."""


_BESIDE = re.compile(r"\.(.+?)(?:\.[0-9a-f]{8}\.(?:part|tmp)|\.lock)")
"""What is written first in the place of NAME, and its lock."""


def system_words(error: OSError) -> str:
    """What the system refused, without its number; the file is named as a person did, not by its part or its lock."""
    said = error.strerror or str(error)
    if not error.strerror or not isinstance(error.filename, str | bytes):
        return said
    path = Path(os.fsdecode(error.filename))
    beside = _BESIDE.fullmatch(path.name)
    return f"{path.with_name(beside[1]) if beside else path}: {said}"


def refusal(error: BaseException) -> OSError | None:
    """What the system refused: the error, or the ring of links that `Path.resolve` calls a RuntimeError; else None."""
    if isinstance(error, OSError):
        return error
    met = error.__context__ if isinstance(error, RuntimeError) else None
    return met if isinstance(met, OSError) and met.errno == errno.ELOOP else None


def what_is_missing(error: BaseException) -> str | None:
    """Say what needs the library that was not found, and how to get it; None where it is no optional one."""
    if not isinstance(error, ModuleNotFoundError) or error.name is None:
        return None
    module = error.name.partition(".")[0]
    return how_to_get(module) if module in EXTRAS else None


def how_to_get(module: str) -> str:
    """Say what needs a module of `EXTRAS`, and the command that installs it."""
    need, extra = EXTRAS[module]
    return f"{need}, which is not installed: pip install 'tissuebench[{extra}]' (or [all])"
