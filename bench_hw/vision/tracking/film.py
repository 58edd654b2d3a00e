"""Tracking a whole film: a trial or video to a table of tracks, a picture at a time; memory does not grow with it.

The first picture that shows the whole grid gives every marker its number for good.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from bench_hw.errors import InputError
from bench_hw.storage.atomic import check_replaceable
from bench_hw.vision import Progress
from bench_hw.vision.camera.camera_file import read_camera
from bench_hw.vision.camera.pinhole import Camera, survey_domain
from bench_hw.vision.frames.opening import TrialFrames, open_frames
from bench_hw.vision.frames.source import Frame, FrameSource
from bench_hw.vision.markers.detection import GridError, detect_grid
from bench_hw.vision.markers.grid import DetectedGrid, Layout, Picture
from bench_hw.vision.tracking.methods import METHODS
from bench_hw.vision.tracking.overlay import Still, overlay_video
from bench_hw.vision.tracking.pipeline import Pipeline, Sinks, TrackOutcome
from bench_hw.vision.tracking.places import Places, read_sinking, table_of_tracks

FIRST_PICTURES = 30
"""In so many pictures the grid is looked for; a second of the paper's video."""


@dataclass(frozen=True, slots=True)
class TrackOrder:
    """What to track, and how.

    Parameters
    ----------
    source : str
        A trial, video, folder or pattern of pictures, as `open_frames` takes it.
    camera : pathlib.Path
        The `camera.toml`.
    out : pathlib.Path
        The table; replaced if it exists.
    method : str
        One of `METHODS`.
    layout : Layout, optional
        The grid as it lies in the picture; the paper's 18 markers without it.
    rate : float, optional
        Pictures per second of a video or pictures, Hz.
    pixels : bool
        Undistorted pixels instead of millimetres.
    sinking : pathlib.Path, optional
        Table of how far the markers sank: perspective is corrected with it.
    recentre : bool
        Take the middle of the grid in the first picture as the origin instead of the camera file's.
    overlay, still : pathlib.Path, optional
        Video (.avi) and picture (.png) with what was found drawn in.
    """

    source: str
    camera: Path
    out: Path
    method: str = "subpixel"
    layout: Layout | None = None
    rate: float | None = None
    pixels: bool = False
    sinking: Path | None = None
    recentre: bool = False
    overlay: Path | None = None
    still: Path | None = None


def track(order: TrackOrder, progress: Progress | None = None) -> TrackOutcome:
    """Track the markers of a trial or video.

    Parameters
    ----------
    order : TrackOrder
        What to do.
    progress : callable, optional
        Told about each picture.

    Returns
    -------
    TrackOutcome
        What was written, and everything that was not as it should be.

    Raises
    ------
    InputError
        Nothing to read, the wrong camera file, not the grid that is allowed, or a jump that cannot be linked.
        Nothing is written then.
    """
    _check(order)
    camera = read_camera(order.camera)
    sinking = None if order.sinking is None else read_sinking(order.sinking)
    places = Places(camera, pixels=order.pixels, sinking=sinking, recentre=order.recentre)
    source = open_frames(order.source, order.rate)
    frames = source.frames()
    beginning = find_beginning(frames, camera, order.layout, source.name)
    tracker = METHODS[order.method](beginning.grey, beginning.grid, camera)
    still = None if order.still is None else Still(beginning.grid.centres)
    with ExitStack() as stack:
        table = stack.enter_context(table_of_tracks(order.out, places.unit))
        video = stack.enter_context(overlay_video(order.overlay, source.rate, camera.size))
        sinks = Sinks(table, video, still)
        pipeline = Pipeline(source, camera, beginning.grid, tracker, places, sinks)
        for frame in beginning.before:
            pipeline.pass_over(frame)
        for frame in chain((beginning.frame,), frames):
            pipeline.take(frame)
            if progress is not None:
                progress(pipeline.tally.frames, source.expected)
        if still is not None and order.still is not None:
            still.write(order.still)
    about_camera = (*_about_camera(camera), *_another_camera(source, order.camera))
    warnings = (*about_camera, *source.notes(), *pipeline.tally.warnings(), *pipeline.knocks.warnings())
    return TrackOutcome(order.out, order.method, beginning.grid, pipeline.tally, source.synthetic, warnings)


def _check(order: TrackOrder) -> None:
    if order.method not in METHODS:
        raise InputError(f"method {order.method!r}; allowed: {', '.join(METHODS)}")
    if order.sinking is not None and order.pixels:
        raise InputError("perspective is corrected in millimetres; allowed: `--sinking` or `--pixels`")
    if order.rate is not None and not 0.0 < order.rate < 1e6:
        raise InputError(f"{order.rate:g} pictures a second; allowed: more than 0")
    written = [path.resolve() for path in (order.out, order.overlay, order.still) if path is not None]
    read = [path.resolve() for path in (Path(order.source), order.camera, order.sinking) if path is not None]
    for path in written:
        if path in read or written.count(path) > 1:
            raise InputError(f"{path}: this file is read or written already; allowed: another name")
        if path.exists() and path.parent == _pictures(order.source):
            raise InputError(f"{path}: the file exists where pictures are read; allowed: another folder")
    check_replaceable(order.out, b"time_s,marker,", "a table of markers")


def _pictures(source: str) -> Path | None:
    """The folder of a source of pictures; None for a single file."""
    path = Path(source)
    return None if path.is_file() else (path if path.is_dir() else path.parent).resolve()


def _about_camera(camera: Camera) -> list[str]:
    domain = survey_domain(camera)
    return [] if domain.whole else [f"the camera file: {domain}"]


def _another_camera(source: FrameSource, path: Path) -> list[str]:
    """Whether a trial tells of another camera file than the one that is used."""
    told = source.camera_file if isinstance(source, TrialFrames) else ""
    if not told or told == hashlib.sha256(path.read_bytes()).hexdigest():
        return []
    return [
        f"the trial was captured with another camera file than {path}: all places go by the file that is given, and "
        "are off by what the cameras differ in; its own is camera.toml in the folder it was captured into"
    ]


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
    grid : DetectedGrid
        The markers in it.
    """

    before: tuple[Frame, ...]
    frame: Frame
    grey: Picture
    grid: DetectedGrid


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
