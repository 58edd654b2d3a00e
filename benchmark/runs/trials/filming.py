"""The films of a session: marker tracks as they come with a trial, or tracked now in the pictures inside its file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from bench_hw.errors import BenchError, TrialFileError
from bench_hw.storage.folder_lock import scratch
from bench_hw.tables import MarkerTable
from bench_hw.vision.camera.camera_file import read_camera
from bench_hw.vision.camera.pinhole import Camera, distance_of
from bench_hw.vision.displacement.tracks import tracks_of
from benchmark.errors import InputError
from benchmark.files import Session, Trial
from benchmark.files.sessions.doubts import check_markers, doubtful_markers
from benchmark.files.sessions.film_clock import on_trials_clock
from benchmark.files.sessions.trials import read_markers
from benchmark.identification import Film
from benchmark.response import CameraView
from benchmark.runs.options import Listener
from benchmark.runs.trials.film_cache import KeptFilm, film_key, keep_film, kept_film

if TYPE_CHECKING:
    from bench_hw.vision.markers.grid import Layout
    from benchmark.files.sessions.description import Camera as SessionCamera

Key = tuple[str, str]


@dataclass(frozen=True)
class Tracked:
    """A film that was tracked in this run: its table (text), a still of the farthest motion (PNG), and what to say."""

    trial: str
    table: bytes
    still: bytes | None
    frames: int
    missing_percent: float


Found = tuple[MarkerTable, Tracked | None, tuple[str, ...]]
"""Tracks of one trial, what was tracked now, and what to say of it."""


@dataclass(frozen=True)
class Films:
    """The films of a session, by condition and name of the trial.

    Attributes
    ----------
    films
        Tracks over frames.
    tracked
        What was tracked now.
    view
        The camera.
    warnings
        One sentence each.
    """

    films: Mapping[Key, Film]
    tracked: tuple[Tracked, ...]
    view: CameraView
    warnings: tuple[str, ...] = ()


NO_FILMS = Films({}, (), CameraView())


def session_films(session: Session, listener: Listener) -> Films:
    """Read, or track, the markers of all trials; nothing without [camera] in the session.

    Raises
    ------
    InputError
        A camera file or film that cannot be used, another number of markers, a marker beyond the grid.
    """
    camera = session.camera
    if camera is None:
        return NO_FILMS
    layout = _layout(camera)
    films: dict[Key, Film] = {}
    tracked: list[Tracked] = []
    warnings: list[str] = []
    for trial, found in zip(session.trials, _sources(session, layout, listener), strict=True):
        if found is None:
            continue
        table, track_of_it, said = found
        try:
            tracks = tracks_of(table, layout.count)
        except BenchError as error:
            raise InputError(f"trial {trial.name}: {error}") from None
        films[trial.condition, trial.name] = Film(tracks.time, tracks.places)
        tracked += [] if track_of_it is None else [track_of_it]
        warnings += said
    view, said = _view(session)
    return Films(films, tuple(tracked), view, (*warnings, *(said if films else ())))


def with_markers(session: Session, listener: Listener) -> tuple[Session, tuple[str, ...]]:
    """The session with the markers of its films, tracked now, in the trials; and what to say of them.

    Raises
    ------
    InputError
        A camera file or film that cannot be used.
    """
    if session.camera is None:
        return session, ()
    layout = _layout(session.camera)
    trials: list[Trial] = []
    warnings: list[str] = []
    for trial, found in zip(session.trials, _sources(session, layout, listener), strict=True):
        trials.append(trial if found is None else replace(trial, markers=found[0]))
        warnings += () if found is None else found[2]
    return replace(session, trials=tuple(trials)), tuple(warnings)


def _layout(camera: SessionCamera) -> Layout:
    """The grid of the session's markers; where markers are found needs OpenCV, so it is loaded for films alone."""
    from bench_hw.vision.markers.grid import Layout

    return Layout(camera.marker_rows, camera.marker_columns)


def _sources(session: Session, layout: Layout, listener: Listener) -> Iterator[Found | None]:
    for trial in session.trials:
        if trial.markers is not None:
            yield trial.markers, None, ()
        elif trial.film is not None:
            yield _on_clock(session, trial, _track(session, trial, trial.film, layout, listener))
        elif trial.path.suffix.lower() == ".mcap" and _camera_file(session) is not None and _filmed(trial.path):
            yield _track(session, trial, trial.path, layout, listener)
        else:
            yield None


def _filmed(path: Path) -> bool:
    from bench_hw.vision.frames.opening import TrialFrames

    try:
        TrialFrames(path)
    except TrialFileError:
        return False
    return True


def _camera_file(session: Session) -> Path | None:
    camera = session.camera
    return None if camera is None or camera.file is None else session.folder / camera.file


def _on_clock(session: Session, trial: Trial, found: Found) -> Found:
    """Tracks of a film that started at another time, on the trial's clock by the press itself."""
    markers, tracked, said = found
    if session.camera is None or session.camera.clock != "press" or tracked is None:
        return found
    moved, sentence = on_trials_clock(trial.name, trial.table, markers)
    shift = float(moved.time[0] - markers.time[0])
    return moved, replace(tracked, table=_later(tracked.table, shift)), (*said, sentence)


def _later(table: bytes, shift: float) -> bytes:
    """A table of tracks whose first column, the time in s, is later by `shift`."""
    head, *rows = table.decode("utf-8").splitlines()
    moved = (f"{float(time) + shift!r},{rest}" for time, _, rest in (row.partition(",") for row in rows))
    return "\n".join([head, *moved, ""]).encode("utf-8")


def _track(session: Session, trial: Trial, pictures: Path, layout: Layout, listener: Listener) -> Found:
    """The tracks of a trial's pictures: kept from an earlier command on the same ones, or made now."""
    camera = _camera_file(session)
    assert camera is not None
    assert session.camera is not None
    key = film_key(pictures, camera, (layout.rows, layout.columns))
    film = kept_film(key)
    if film is None:
        film = _tracked_now(trial, pictures, camera, layout, listener)
        keep_film(key, film)
    else:
        listener.say(f"{trial.name}: the same pictures were tracked before, their tracks are taken")
    with scratch() as folder:
        table = folder / "markers.csv"
        table.write_bytes(film.table)
        markers = replace(read_markers(table), source=str(pictures))
    check_markers(trial.table, markers, session.camera)
    tracked = Tracked(trial.name, film.table, film.still, film.frames, film.missing_percent)
    said = (f"{trial.name}: {text}" for text in film.warnings)
    return markers, tracked, (*said, *doubtful_markers([trial.name], [markers], session.camera))


def _tracked_now(trial: Trial, pictures: Path, camera: Path, layout: Layout, listener: Listener) -> KeptFilm:
    """Track the pictures of a trial in a folder that is gone afterwards."""
    from bench_hw.vision.tracking.film import TrackOrder, track

    with scratch() as folder, listener.progress(f"{trial.name}: tracking the markers") as advance:
        out, still = folder / "markers.csv", folder / "still.png"
        order = TrackOrder(str(pictures), camera, out, layout=layout, still=still)
        try:
            outcome = track(order, lambda done, total: advance("tracking", done, total or done, f"picture {done}"))
        except BenchError as error:
            raise InputError(f"{error}.") from None
        picture = still.read_bytes() if still.is_file() else None
        missing = 100.0 * float(outcome.tally.missing.mean()) / max(outcome.tally.frames, 1)
        return KeptFilm(out.read_bytes(), picture, outcome.tally.frames, missing, tuple(outcome.warnings))


def _view(session: Session) -> tuple[CameraView, tuple[str, ...]]:
    """The camera's distance and axis, from its file or from the session."""
    path = _camera_file(session)
    try:
        camera = None if path is None else read_camera(path)
    except BenchError as error:
        raise InputError(f"{error}.") from None
    distance = session.camera.distance if session.camera is not None else None
    if distance is None and (camera is None or camera.plane is None):
        return CameraView(), ("the camera's distance is not known: perspective is left out of the markers' fit",)
    if camera is None or camera.plane is None:
        return CameraView(float(distance or 0.0)), ()
    return CameraView(distance_of(camera) if distance is None else distance, _centre(camera)), ()


def _centre(camera: Camera) -> tuple[float, float]:
    """Where the camera's axis meets the plane, m from the tracks' origin."""
    assert camera.plane is not None
    x, y = (-distance_of(camera) * camera.to_normalised(np.asarray(camera.plane.origin))).tolist()
    return x, y
