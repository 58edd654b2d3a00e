"""The file `camera.toml`: plain numbers, units in the names of the keys, in millimetres and pixels."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import tomli_w
from pydantic import Field

from bench_hw.configuration import StrictModel, read_toml, validated
from bench_hw.storage.atomic import write_text
from bench_hw.vision.camera.pinhole import Camera, Plane, Quality

SCHEMA = 1
Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Pixels = Annotated[int, Field(ge=16, le=32_000, strict=True)]


class _Matrix(StrictModel):
    fx: Positive
    fy: Positive
    cx: Number
    cy: Number


class _Distortion(StrictModel):
    k1: Number
    k2: Number
    p1: Number
    p2: Number
    k3: Number = 0.0


class _Plane(StrictModel):
    mm_per_px: Positive | None = None
    mm_per_px_std: NotNegative = 0.0
    origin_px: tuple[Number, Number] | None = None


class _Quality(StrictModel):
    views: Annotated[int, Field(ge=0)]
    reprojection_rms_px: NotNegative
    map_error_rms_px: NotNegative


class _File(StrictModel):
    schema_: Annotated[Literal[1], Field(alias="schema")]
    image_size: tuple[Pixels, Pixels]
    matrix: _Matrix
    distortion: _Distortion
    plane: _Plane | None = None
    quality: _Quality | None = None


def read_camera(path: Path | str) -> Camera:
    """Read a `camera.toml`.

    Raises
    ------
    InputError
        The file is missing, no TOML, of another schema, or a key is missing, unknown or not allowed.
    """
    path = Path(path)
    file = validated(_File, read_toml(path)[0], str(path))
    matrix, lens, quality = file.matrix, file.distortion, file.quality
    return Camera(
        size=file.image_size,
        focal=(matrix.fx, matrix.fy),
        centre=(matrix.cx, matrix.cy),
        distortion=(lens.k1, lens.k2, lens.p1, lens.p2, lens.k3),
        plane=_plane_of(file),
        quality=None
        if quality is None
        else Quality(quality.views, quality.reprojection_rms_px, quality.map_error_rms_px),
    )


def _plane_of(file: _File) -> Plane | None:
    plane = file.plane
    if plane is None or plane.mm_per_px is None:
        return None
    origin = (file.matrix.cx, file.matrix.cy) if plane.origin_px is None else plane.origin_px
    return Plane(plane.mm_per_px / 1e3, plane.mm_per_px_std / 1e3, origin)


def camera_tables(camera: Camera) -> dict[str, Any]:
    """Give what stands in the file: tables of plain numbers."""
    tables: dict[str, Any] = {
        "schema": SCHEMA,
        "image_size": list(camera.size),
        "matrix": dict(zip(("fx", "fy", "cx", "cy"), (*camera.focal, *camera.centre), strict=True)),
        "distortion": dict(zip(("k1", "k2", "p1", "p2", "k3"), camera.distortion, strict=True)),
    }
    if camera.plane is not None:
        tables["plane"] = {
            "mm_per_px": _in_mm(camera.plane.scale),
            "mm_per_px_std": _in_mm(camera.plane.scale_std),
            "origin_px": list(camera.plane.origin),
        }
    if camera.quality is not None:
        tables["quality"] = {
            "views": camera.quality.views,
            "reprojection_rms_px": camera.quality.reprojection_rms,
            "map_error_rms_px": camera.quality.map_error_rms,
        }
    return tables


def _in_mm(metres: float) -> float:
    """Millimetres without the last digit, which the factor leaves wrong."""
    return float(f"{metres * 1e3:.15g}")


def write_camera(path: Path | str, camera: Camera, remarks: Mapping[str, str] | None = None) -> Path:
    """Write a `camera.toml`, whole or not at all, and return its path.

    Parameters
    ----------
    path : path-like
        The file.
    camera : Camera
        What to write.
    remarks : Mapping[str, str], optional
        Written as comments at the top, `name: text`.

    Raises
    ------
    InputError
        A value that `read_camera` would refuse; nothing is written.
    OSError
        The folder cannot be written.
    """
    head = "".join(f"# {name}: {text}\n" for name, text in (remarks or {}).items())
    return write_text(Path(path), head + tomli_w.dumps(camera_tables(camera)), read_camera)
