"""Whether the views can determine a camera: enough of them, and different enough from one another."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from bench_hw.errors import InputError
from bench_hw.vision.calibration.board import Board, BoardView
from bench_hw.vision.calibration.fit import NAMES, CameraFit, MapError
from bench_hw.vision.camera.pinhole import FloatArray

FEWEST_VIEWS = 20
FEWEST_DIFFERENT = 10
_SAME = 0.02
"""Views whose corners lie within this share of the picture's width (rms) count as the same."""
LEAST_TILT = 4.0
"""Degrees, rms, of the boards' normals about their mean."""
LARGEST_DEVIATION = 0.005
"""Of focal lengths and centre, as a share of the focal length."""
LARGEST_MAP_ERROR = 0.25
"""Pixels; above it a camera is refused."""
LARGEST_EXTRAPOLATION = 1.0
"""Pixels, over the whole picture."""
GOOD_MAP_ERROR = 0.05
GOOD_EXTRAPOLATION = 0.2
_GOOD_COVERAGE = 0.6
_FIELDS = (8, 6)


def check_number(views: Sequence[BoardView], board: Board) -> list[FloatArray]:
    """Give the corners of the views that can be used.

    Raises
    ------
    InputError
        Fewer than twenty can; the message says why the others cannot.
    """
    corners = [view.corners for view in views if view.corners is not None]
    if len(corners) >= FEWEST_VIEWS:
        return corners
    reasons = "; ".join(explain(views))
    raise InputError(
        f"too few views: {len(corners)} of {len(views)} pictures show the board with {board} inner corners well; "
        f"allowed: at least {FEWEST_VIEWS}" + (f" ({reasons})" if reasons else "")
    )


def explain(views: Sequence[BoardView]) -> list[str]:
    """Say for each reason which views cannot be used."""
    names = defaultdict(list)
    for view in views:
        if view.corners is None:
            names[view.reason.partition(" (")[0]].append(view)
    return [f"{reason} in {len(group)}, such as {group[0].name}" + _detail(group[0]) for reason, group in names.items()]


def _detail(view: BoardView) -> str:
    _, bracket, detail = view.reason.partition(" (")
    return f" ({detail}" if bracket else ""


def check_variety(corners: Sequence[FloatArray], size: tuple[int, int]) -> None:
    """Refuse views that are the same again and again.

    Raises
    ------
    InputError
        Fewer than ten different views.
    """
    different: list[FloatArray] = []
    for view in corners:
        if all(_apart(view, other) > _SAME * size[0] for other in different):
            different.append(view)
    if len(different) < FEWEST_DIFFERENT:
        raise InputError(
            f"the views are too alike: of {len(corners)} only {len(different)} differ by more than "
            f"{100 * _SAME:g} % of the picture's width; allowed: at least {FEWEST_DIFFERENT} different ones, the board "
            "in all parts of the picture and tilted all ways"
        )


def _apart(one: FloatArray, other: FloatArray) -> float:
    """Rms distance of the corners, whichever end of the board they begin at."""
    straight, turned = one - other, one - other[::-1]
    return float(np.sqrt(min((straight**2).sum(axis=1).mean(), (turned**2).sum(axis=1).mean())))


def check_fit(fit: CameraFit) -> None:
    """Refuse a camera whose focal length or centre the views leave open.

    Raises
    ------
    InputError
        Names the parameter, its value and deviation.
    """
    middle = fit.normals.mean(axis=0)
    away = np.arccos(np.clip(fit.normals @ middle / np.linalg.norm(middle), -1.0, 1.0))
    tilt = float(np.degrees(np.sqrt((away**2).mean())))
    if tilt < LEAST_TILT:
        raise InputError(
            f"the views are too alike: the board is always tilted the same way, within {tilt:.1f} degrees (rms); "
            f"allowed: at least {LEAST_TILT:g} degrees; tilt it 10 to 30 degrees all ways"
        )
    values = (*fit.camera.focal, *fit.camera.centre)
    focal = float(np.mean(fit.camera.focal))
    for name, value, deviation in zip(NAMES, values, fit.deviations, strict=False):
        if not deviation <= LARGEST_DEVIATION * focal:
            raise InputError(
                f"the views are too alike to tell the camera's {name}: {value:.1f} +- {deviation:.1f} px; "
                f"allowed: +- {LARGEST_DEVIATION * focal:.1f} px; take views with the board tilted 10 to 30 degrees "
                "all ways"
            )


def check_map(error: MapError) -> None:
    """Refuse a map that held-out views contradict.

    Raises
    ------
    InputError
        Its error is above a quarter of a pixel where the views have corners, or above a pixel all over.
    """
    if not (error.total <= LARGEST_MAP_ERROR and error.everywhere <= LARGEST_EXTRAPOLATION):
        raise InputError(
            f"the views do not determine the distortion: the map is off by {error.total:.2g} px over held-out views "
            f"and by {error.everywhere:.2g} px over the whole picture; allowed: {LARGEST_MAP_ERROR} px and "
            f"{LARGEST_EXTRAPOLATION:g} px; take more views, in the corners of the picture, too, and keep k3 fixed"
        )


def coverage_warnings(corners: Sequence[FloatArray], size: tuple[int, int], error: MapError) -> list[str]:
    """Warn of poor coverage and of errors that are larger than good."""
    fields = np.unique(np.floor(np.concatenate(list(corners)) / size * _FIELDS).astype(int), axis=0)
    share = len(fields) / (_FIELDS[0] * _FIELDS[1])
    warnings = []
    if share < _GOOD_COVERAGE:
        warnings.append(f"the corners cover {100 * share:.0f} % of the picture: elsewhere the map is a guess")
    if error.total > GOOD_MAP_ERROR:
        warnings.append(f"the map's error over held-out views is {error.total:.2g} px rms; good is {GOOD_MAP_ERROR}")
    if error.everywhere > GOOD_EXTRAPOLATION:
        warnings.append(f"off the corners of the views the map's error is {error.everywhere:.2g} px rms")
    return warnings
