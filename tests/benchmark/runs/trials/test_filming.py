"""Films of a session: tracked in the run, read from tables, and refused where they do not fit the grid."""

import shutil
from contextlib import nullcontext
from pathlib import Path

import cv2
import numpy as np
import pytest

from bench_hw.trial_file import read_trial_mcap
from bench_hw.vision.frames.opening import TrialFrames
from benchmark.errors import InputError
from benchmark.files import load_session
from benchmark.runs.trials.film_tables import circles, marker_fits, motions_of
from benchmark.runs.trials.filming import session_films, with_markers
from benchmark.runs.trials.table_one import table_one
from benchmark.sessions import SHIPPED

PHANTOM = Path(SHIPPED) / "phantom"
HEAD = """\
schema = 1
name = "small"
specimen = "rtv3498_sheet"
synthetic = true
[tool]
radius = "5 mm"
contact = "rigid_bonded"
[support]
kind = "hole"
hole_radius = "30 mm"
[camera]
marker_rows = {rows}
marker_columns = {columns}
marker_spacing = "8 mm"
{camera}
[[trials]]
file = "press_01.mcap"
condition = "press"
[[trials]]
file = "press_02.csv"
markers = "press_02_markers.csv"
condition = "press"
"""


class Quiet:
    def say(self, text: str) -> None:
        pass

    def progress(self, title: str):
        return nullcontext(lambda *_: None)


@pytest.fixture
def session(tmp_path):
    """The first two trials of the phantom in a folder of their own."""
    for name in ("press_01.mcap", "press_02.csv", "press_02_markers.csv", "camera.toml"):
        shutil.copy(PHANTOM / name, tmp_path)

    def load(rows=3, columns=6, camera='file = "camera.toml"'):
        (tmp_path / "session.toml").write_text(HEAD.format(rows=rows, columns=columns, camera=camera))
        return load_session(tmp_path)

    return load


def test_pictures_in_a_trial_are_tracked_and_tables_are_read(session) -> None:
    loaded = session()
    films = session_films(loaded, Quiet())
    assert list(films.films) == [("press", "press_01"), ("press", "press_02")]
    assert [each.trial for each in films.tracked] == ["press_01"]
    assert films.tracked[0].still is not None
    assert films.tracked[0].still.startswith(b"\x89PNG")
    assert films.view.distance == pytest.approx(70e-3)
    motions = motions_of(films.films, loaded.camera)
    first, second = (float(np.nanmax(np.hypot(*motion.moved.T))) for motion in motions)
    assert first == pytest.approx(second, rel=0.2)
    fits = marker_fits(motions)
    assert len(fits["r2"]) == 2 * 18 * 2
    assert np.median([r2 for r2 in fits["r2"] if np.isfinite(r2)]) > 0.85
    circle = circles(motions)
    ratio = np.nanmedian(np.asarray(circle["radius_nine_mm"]) / np.asarray(circle["radius_ring_mm"]))
    assert ratio == pytest.approx(1.0 - 0.057, abs=0.003)
    rows = {row.name: row for row in table_one(loaded, motions, {})}
    assert 18.0 < rows["published.a"].value < 20.0
    assert "sound.a" not in rows
    for row in rows.values():
        assert (row.ci95_low is not None) == row.identifiable
    assert "cannot be told from 0 (+/- " in rows["published.O_0"].source


def test_a_filmed_trial_gets_its_markers_and_a_table_stays(session) -> None:
    loaded = session()
    assert loaded.trials[0].markers is None
    made, said = with_markers(loaded, Quiet())
    assert np.unique(made.trials[0].markers.marker).size == loaded.camera.marker_rows * loaded.camera.marker_columns
    assert made.trials[1].markers is loaded.trials[1].markers
    assert made.fingerprint == loaded.fingerprint
    assert all(isinstance(text, str) for text in said)


def test_a_trial_without_a_camera_file_is_not_tracked(session) -> None:
    films = session_films(session(camera='distance = "70 mm"'), Quiet())
    assert list(films.films) == [("press", "press_02")]
    assert films.view.distance == pytest.approx(70e-3)


def test_an_unknown_distance_is_said(session) -> None:
    films = session_films(session(camera=""), Quiet())
    assert np.isinf(films.view.distance)
    assert any("perspective is left out" in text for text in films.warnings)


@pytest.mark.parametrize(("rows", "columns", "camera"), [(3, 5, ""), (3, 5, 'file = "camera.toml"')])
def test_another_grid_is_refused(session, rows, columns, camera) -> None:
    with pytest.raises(InputError, match="marker"):
        session_films(session(rows, columns, camera), Quiet())


def test_the_same_pictures_are_tracked_once(session, tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("TISSUEBENCH_CACHE", str(tmp_path / "kept"))
    first = session_films(session(), Quiet())

    def never(*_: object) -> None:
        raise AssertionError("it was tracked again")

    monkeypatch.setattr("bench_hw.vision.tracking.film.track", never)
    again = session_films(session(), Quiet())
    assert again.tracked == first.tracked
    assert again.warnings == first.warnings
    for key, film in first.films.items():
        np.testing.assert_array_equal(again.films[key].places, film.places)


FILMED = """\
schema = 1
name = "webcam"
specimen = "rtv3498_sheet"
[tool]
radius = "5 mm"
contact = "rigid_bonded"
[camera]
marker_rows = 3
marker_columns = 6
marker_spacing = "8 mm"
{camera}
clock = "press"
[[trials]]
file = "force.csv"
film = "film.avi"
condition = "press"
{more}
"""


@pytest.fixture
def webcam(tmp_path):
    """The phantom's first press as a lab without a bench has it: a video that started later, and a force file."""
    frames = [frame for frame in TrialFrames(PHANTOM / "press_01.mcap").frames() if frame.time >= 0.8]
    rate = (len(frames) - 1) / (frames[-1].time - frames[0].time)
    writer = cv2.VideoWriter(str(tmp_path / "film.avi"), cv2.VideoWriter.fourcc(*"FFV1"), rate, (640, 480), False)
    for frame in frames:
        writer.write(frame.grey)
    writer.release()
    table = read_trial_mcap(PHANTOM / "press_01.mcap")
    rows = zip(table.time[::5], 1e3 * table.depth[::5], table.force[::5], strict=True)
    lines = (f"{time:.4f},{depth:.4f},{force:.5f}" for time, depth, force in rows)
    (tmp_path / "force.csv").write_text("\n".join(["Time (s),Displacement (mm),Load (N)", *lines]))
    shutil.copy(PHANTOM / "camera.toml", tmp_path)

    def load(camera='file = "camera.toml"', more=""):
        (tmp_path / "session.toml").write_text(FILMED.format(camera=camera, more=more))
        return load_session(tmp_path)

    return load, frames[0].time


def test_a_video_that_started_at_another_time_is_put_on_the_force_s_clock_by_the_press(webcam):
    load, began = webcam
    found = session_films(load(), Quiet())
    film = found.films["press", "force"]
    assert film.time[0] == pytest.approx(began, abs=0.02)
    (said,) = (text for text in found.warnings if "clock is shifted" in text)
    assert "standard deviation 0.00" in said
    first = float(found.tracked[0].table.decode().splitlines()[1].split(",")[0])
    assert first == pytest.approx(film.time[0], abs=1e-9)  # the table that is kept is on that clock, too


def test_a_film_needs_its_camera_and_no_tracks_beside_it(webcam):
    load, _ = webcam
    with pytest.raises(InputError, match="tracked with its camera"):
        load(camera="")
    with pytest.raises(InputError, match="allowed: markers or film"):
        load(more='markers = "force.csv"')
