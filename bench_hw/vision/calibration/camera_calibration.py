"""Pictures of a board to a `camera.toml`, or a refusal with its reason and no file."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from bench_hw.errors import InputError
from bench_hw.storage.atomic import check_replaceable
from bench_hw.vision import Progress
from bench_hw.vision.calibration.board import Board, BoardView, look_for_board, read_picture
from bench_hw.vision.calibration.fit import NAMES, CameraFit, MapError, fit_camera, held_out_map_error
from bench_hw.vision.calibration.scale import PlaneScale, measure_plane
from bench_hw.vision.calibration.views import (
    check_fit,
    check_map,
    check_number,
    check_variety,
    coverage_warnings,
    explain,
)
from bench_hw.vision.camera.camera_file import camera_tables, write_camera
from bench_hw.vision.camera.pinhole import Camera, InvertibleDomain, Plane, Quality, survey_domain
from bench_hw.vision.frames.opening import picture_files

USUAL_MARK = 1e-3
"""Distance of a ruler's finest marks, m."""


@dataclass(frozen=True, slots=True)
class CalibrationOrder:
    """What to calibrate from.

    Parameters
    ----------
    images : tuple of pathlib.Path
        Views of the board; a folder stands for the pictures in it.
    board : Board
        The board.
    out : pathlib.Path
        The `camera.toml`; replaced if it exists.
    plane : pathlib.Path, optional
        Picture of the board or of a ruler in the marker plane; without it there is no scale.
    mark : float
        Distance of the ruler's finest marks, m.
    origin : str
        Of the marker plane: `axis` (where the optical axis meets it), `plane` (the middle of the board or ruler in
        the plane's picture), or `X,Y` in undistorted pixels.
    free_k3 : bool
        Fit k3, too.
    """

    images: tuple[Path, ...]
    board: Board
    out: Path
    plane: Path | None = None
    mark: float = USUAL_MARK
    origin: str = "axis"
    free_k3: bool = False


@dataclass(frozen=True, eq=False, slots=True)
class CalibrationOutcome:
    """What `calibrate` found.

    Parameters
    ----------
    out : pathlib.Path
        The file.
    camera : Camera
        What it says.
    fit : CameraFit
        With the parameters' deviations.
    error : MapError
        Of the map.
    domain : InvertibleDomain
        Where the distortion can be inverted.
    warnings : tuple of str
        A sentence each.
    """

    out: Path
    camera: Camera
    fit: CameraFit
    error: MapError
    domain: InvertibleDomain
    warnings: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Give it as it stands in the JSON of `calibrate`."""
        return {
            **camera_tables(self.camera),
            "out": str(self.out),
            "deviations": dict(zip(NAMES, self.fit.deviations.tolist(), strict=True)),
            "map_error_parts_px": asdict(self.error),
            "invertible": {
                "fraction": self.domain.fraction,
                "nearest_px": None if self.domain.whole else self.domain.nearest,
            },
            "warnings": list(self.warnings),
        }


FARTHEST_ORIGIN = 100_000.0
"""Of the marker plane, px from the picture's first one."""


def calibrate(order: CalibrationOrder, progress: Progress | None = None) -> CalibrationOutcome:
    """Calibrate a camera and write its file.

    Parameters
    ----------
    order : CalibrationOrder
        From what.
    progress : callable, optional
        Told about each picture.

    Raises
    ------
    InputError
        A picture cannot be read or has another size; too few views (blurred, another board, none), views too alike
        to tell the parameters, a map that held-out views contradict, or no scale in the plane's picture. No file is
        written then.
    """
    order = replace(order, images=_pictures(order.images))
    if order.out.resolve() in [path.resolve() for path in (*order.images, order.plane or order.out.parent)]:
        raise InputError(f"{order.out}: this file is read; allowed: another name")
    check_replaceable(order.out, b"[matrix]", "a camera file")
    _given_origin(order.origin)
    views, size = _views(order, progress)
    corners = check_number(views, order.board)
    check_variety(corners, size)
    fit = fit_camera(corners, order.board, size, order.free_k3)
    check_fit(fit)
    error = held_out_map_error(corners, order.board, fit.camera, order.free_k3)
    check_map(error)
    scale = None if order.plane is None else measure_plane(order.plane, order.board, fit.camera, order.mark)
    camera = replace(
        fit.camera,
        plane=None if scale is None else Plane(scale.scale, scale.scale_std, _origin(order.origin, fit.camera, scale)),
        quality=Quality(len(corners), fit.reprojection_rms, error.total),
    )
    domain = survey_domain(camera)
    warnings = [f"left out: {reason}" for reason in explain(views)]
    warnings += coverage_warnings(corners, size, error) + ([] if scale is None else list(scale.warnings))
    warnings += [] if domain.whole else [str(domain)]
    write_camera(order.out, camera, _remarks(fit, order, domain, scale))
    return CalibrationOutcome(order.out, camera, fit, error, domain, tuple(warnings))


def _pictures(given: tuple[Path, ...]) -> tuple[Path, ...]:
    """The views that were given, those of folders in the natural order of their names."""
    return tuple(each for path in given for each in (picture_files(str(path)) if path.is_dir() else [path]))


def _views(order: CalibrationOrder, progress: Progress | None) -> tuple[list[BoardView], tuple[int, int]]:
    """Look at all pictures; they must be of one size."""
    views: list[BoardView] = []
    size: tuple[int, int] | None = None
    for number, path in enumerate(order.images):
        grey = read_picture(path)
        height, width = grey.shape
        if size is None:
            size = (width, height)
        if (width, height) != size:
            raise InputError(
                f"{path}: the picture is {width} x {height} pixels; "
                f"allowed: {size[0]} x {size[1]}, as {order.images[0]}"
            )
        views.append(look_for_board(grey, order.board, str(path)))
        if progress is not None:
            progress(number + 1, len(order.images))
    if size is None:
        raise InputError("no pictures; allowed: at least 20 views of the board")
    return views, size


def _origin(text: str, camera: Camera, scale: PlaneScale) -> tuple[float, float]:
    if text == "axis":
        return camera.centre
    if text == "plane":
        return scale.middle
    return _given_origin(text) or camera.centre


def _given_origin(text: str) -> tuple[float, float] | None:
    """The origin in pixels where it is given so; None for a name. Raises InputError."""
    if text in ("axis", "plane"):
        return None
    x, _, y = text.partition(",")
    try:
        place = float(x), float(y)
    except ValueError:
        place = (math.nan, math.nan)
    if not all(abs(each) <= FARTHEST_ORIGIN for each in place):
        allowed = f"axis, plane, or X,Y in undistorted pixels, each from {-FARTHEST_ORIGIN:g} to {FARTHEST_ORIGIN:g}"
        raise InputError(f"origin {text!r}: allowed are {allowed}")
    return place


def _remarks(
    fit: CameraFit, order: CalibrationOrder, domain: InvertibleDomain, scale: PlaneScale | None
) -> dict[str, str]:
    deviations = ", ".join(f"{name} {value:.2g}" for name, value in zip(NAMES, fit.deviations, strict=True) if value)
    remarks = {"standard deviations": deviations, "domain": str(domain)}
    if scale is not None:
        remarks["plane"] = f"from a {scale.kind}, origin: {order.origin}"
    return remarks
