"""The first picture that shows the whole grid: there every marker gets its number for good."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from bench_hw.errors import InputError
from bench_hw.vision.camera.model import Camera
from bench_hw.vision.frames.model import Frame
from bench_hw.vision.markers.detection import GridError, detect_grid
from bench_hw.vision.markers.model import Grid, Layout, Picture

FIRST_PICTURES = 30
"""In so many pictures the grid is looked for; a second of the paper's video."""


@dataclass(frozen=True, eq=False, slots=True)
class Beginning:
    """Where tracking begins.

    Parameters
    ----------
    before : tuple of Frame
        Pictures without the whole grid, before it.
    frame : Frame
        The first picture with it.
    grey : ndarray of uint8, shape (height, width)
        That picture.
    grid : Grid
        The markers in it.
    """

    before: tuple[Frame, ...]
    frame: Frame
    grey: Picture
    grid: Grid


def find_beginning(frames: Iterator[Frame], camera: Camera, layout: Layout | None, name: str) -> Beginning:
    """Take pictures until one shows the grid.

    Parameters
    ----------
    frames : iterator of Frame
        Taken from as far as needed.
    camera : Camera
        Whose size the pictures must have.
    layout : Layout, optional
        As in `detect_grid`.
    name : str
        What is read, for messages.

    Raises
    ------
    InputError
        A picture of another size than the camera's, none that can be read, or none of the first thirty shows the
        grid.
    """
    before: list[Frame] = []
    problem: GridError | None = None
    for frame in frames:
        if frame.grey is not None:
            check_size(frame.grey, camera, f"{name}: picture {frame.number}")
            try:
                grid = detect_grid(frame.grey, layout, camera.straightened)
                return Beginning(tuple(before), frame, frame.grey, grid)
            except GridError as error:
                problem = error if problem is None or error.found > problem.found else problem
        before.append(frame)
        if len(before) >= FIRST_PICTURES:
            break
    if problem is None:
        raise InputError(f"{name}: none of the first {len(before)} pictures can be decoded; allowed: at least one")
    raise InputError(f"{name}: no picture of the first {len(before)} shows the grid of markers; the best has {problem}")


def check_size(grey: Picture, camera: Camera, what: str) -> None:
    """Refuse a picture that is not of the camera's size.

    Raises
    ------
    InputError
        Names both sizes.
    """
    height, width = grey.shape
    if (width, height) != camera.size:
        raise InputError(
            f"{what} is {width} x {height} pixels; "
            f"allowed: {camera.size[0]} x {camera.size[1]}, the camera file's image_size"
        )
