"""The parts that an installation may leave out, by the library that is missing then."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

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
