"""Markers as people make them: each from its own resting place, the scale judged against the print."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.blind.cases import CaseName
from benchmark.blind.session_files import case
from benchmark.discovery import Settings, criteria, discover
from benchmark.discovery.base.effect_model import EffectModel
from benchmark.discovery.base.trials_problem import TrialsProblem
from benchmark.discovery.trials.marker_layout import grid, layout
from benchmark.discovery.trials.preparing import prepare
from benchmark.discovery.trials.printed_grid import printed_grid, resting_places
from benchmark.files import Camera
from benchmark.files.sessions.session_loading import load_session

CAMERA = Camera(marker_rows=3, marker_columns=6, marker_spacing=6e-3)
NOMINAL = grid(CAMERA)
SCATTER = 0.06e-3
QUICK = Settings(rows=100, workers=1)


def rests(rng, scatter=SCATTER, scale=1.0, turn=0.0, move=(0.0, 0.0), tracking=1e-6, trials=10):
    """Resting places (trials, 18, 2) of a sheet printed `scatter` m off its grid."""
    turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    places = scale * (NOMINAL + rng.normal(0.0, scatter, NOMINAL.shape)) @ turned.T + move
    return places + rng.normal(0.0, tracking, (trials, *NOMINAL.shape))


def test_scatter_scale_and_places_are_found():
    rng = np.random.default_rng(1)
    found = [printed_grid(CAMERA, NOMINAL, rests(rng, scale=1.01, move=(2e-3, -1e-3), turn=0.02)) for _ in range(200)]
    assert np.sqrt(np.mean([each.scatter**2 for each in found])) == pytest.approx(SCATTER, rel=0.03)
    off = [(each.scale - 1.01) / each.scale_error for each in found]
    assert np.std(off) == pytest.approx(1.0, abs=0.15)
    assert np.mean(off) == pytest.approx(0.0, abs=0.25)
    middle = np.mean([each.origin for each in found], axis=0)
    assert middle == pytest.approx([2e-3, -1e-3], abs=4 * SCATTER / np.sqrt(18 * 200))
    off = [(each.origin - [2e-3, -1e-3]) / each.centre_error for each in found]
    assert np.std(off) == pytest.approx(1.0, abs=0.1)
    assert "markers scatter by 0.0" in found[0].remark


def test_a_frame_is_taken_at_its_word_where_the_print_allows_it():
    rng = np.random.default_rng(8)
    found = [printed_grid(CAMERA, NOMINAL, rests(rng)) for _ in range(200)]
    at_word = [each for each in found if (each.origin == 0.0).all()]
    assert len(at_word) > 195
    for each in at_word:
        assert each.centre_error < 1e-6
    middle = np.array([each.places.mean(axis=0) for each in at_word])
    assert np.std(middle) == pytest.approx(SCATTER / np.sqrt(18), rel=0.1)


@pytest.mark.parametrize(("move", "camera_moves"), [(0.1e-3, 0.0), (0.0, 0.1e-3)])
def test_a_frame_that_lies_elsewhere_or_moves_tells_the_axis_by_the_markers_alone(move, camera_moves):
    rng = np.random.default_rng(9)
    places = rests(rng, move=(move, 0.0)) + rng.normal(0.0, camera_moves, (10, 1, 2))
    found = printed_grid(CAMERA, NOMINAL, places)
    assert found.origin == pytest.approx(places.mean(axis=(0, 1)), abs=1e-6)
    assert found.centre_error == pytest.approx(SCATTER / np.sqrt(18), rel=0.2)


def test_a_frame_laid_through_the_markers_middle_tells_the_axis_no_better():
    places = rests(np.random.default_rng(10))
    found = printed_grid(CAMERA, NOMINAL, places - places.mean(axis=(0, 1)))
    assert found.centre_error == pytest.approx(SCATTER / np.sqrt(18), rel=0.2)


@pytest.mark.parametrize(
    ("waits", "air", "off"),
    [(0.5, 0.5e-3, 0.0), (0.0, 0.8e-3, 0.0), (0.0, 0.35e-3, 15e-6)],
    ids=["it waits", "a long way there", "a short way there"],
)
def test_a_press_before_the_depth_is_zero_moves_no_resting_place(waits, air, off):
    """The tool touches 0.3 mm above the depth that is told as zero."""
    time = np.arange(0.0, 4.0, 0.01)
    depth = np.clip((time - waits) * 0.5e-3, 0.0, None) - air
    frames = np.arange(0.01, 3.9, 1.0 / 30.0)
    pressed = np.clip(np.interp(frames, time, depth) + 0.3e-3, 0.0, None)
    markers = NOMINAL * (1.0 + 0.1 / 18e-3 * pressed[:, None, None])
    raw = SimpleNamespace(time=time, depth=depth, frames=frames, markers=markers)
    found = resting_places([raw], np.ones(len(NOMINAL), dtype=bool))[0]
    assert abs(found - NOMINAL).max() <= off + 1e-12


def test_a_grid_within_tracking_is_trusted():
    rng = np.random.default_rng(2)
    exact = [printed_grid(CAMERA, NOMINAL, rests(rng, scatter=0.0, scale=1.02)).exact for _ in range(200)]
    assert np.mean(exact) > 0.97
    found = printed_grid(CAMERA, NOMINAL, rests(rng, scatter=0.0))
    assert (found.places is NOMINAL, found.scale_error, found.remark) == (True, 0.0, "")
    assert found.centre_error == 0.0


def test_a_plane_not_quite_parallel_is_no_scatter():
    tilted = rests(np.random.default_rng(3), scatter=0.0) * [1.01, 1.0]
    assert printed_grid(CAMERA, NOMINAL, tilted).exact


def test_one_marker_far_off_tells_nothing_of_scale_and_scatter():
    places = rests(np.random.default_rng(4))
    before = printed_grid(CAMERA, NOMINAL, places)
    places[:, 0] += [0.8e-3, 0.3e-3]
    after = printed_grid(CAMERA, NOMINAL, places)
    assert after.scale == pytest.approx(before.scale, abs=before.scale_error)
    assert after.scatter == pytest.approx(before.scatter, rel=0.15)
    assert after.places[0] - before.places[0] == pytest.approx([0.8e-3, 0.3e-3], abs=0.05e-3)


def test_what_is_stated_is_used():
    stated = CAMERA.model_copy(update={"print_scatter": 0.1e-3, "scale_uncertainty": 0.003})
    found = printed_grid(stated, NOMINAL, rests(np.random.default_rng(5)))
    print_alone = 0.1e-3 / np.sqrt(np.sum(NOMINAL**2))
    assert found.scatter == 0.1e-3
    assert found.scale_error == pytest.approx(np.hypot(print_alone, 0.003))
    trusted = printed_grid(
        CAMERA.model_copy(update={"scale_uncertainty": 0.003}), NOMINAL, rests(np.random.default_rng(6), scatter=0.0)
    )
    assert (trusted.exact, trusted.scale_error) == (True, 0.003)


def distorted(places, lens):
    """Places (..., m, 2) seen through a lens that moves the outermost ones by a share of their radius."""
    square = np.sum(places**2, axis=-1, keepdims=True)
    return places * (1.0 + lens * square / np.sum(NOMINAL**2, axis=1).max())


def test_a_grid_at_rest_tells_the_lens():
    rng = np.random.default_rng(7)
    found = [printed_grid(CAMERA, NOMINAL, distorted(rests(rng, turn=0.02), 0.008)) for _ in range(200)]
    off = [(each.lens - 0.008) / each.lens_error for each in found]
    assert np.mean([each.lens_error for each in found]) == pytest.approx(0.0042, rel=0.05)
    assert np.std(off) == pytest.approx(1.0, abs=0.15)
    assert np.mean(off) == pytest.approx(0.0, abs=0.25)
    exact = printed_grid(CAMERA, NOMINAL, rests(rng, scatter=0.0))
    assert exact.exact
    assert abs(exact.lens) < 4.0 * exact.lens_error < 2e-4


def test_markers_on_one_ring_tell_no_lens():
    angle = np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
    ring = 6e-3 * np.column_stack([np.cos(angle), np.sin(angle)])
    places = ring + np.random.default_rng(8).normal(0.0, SCATTER, ring.shape)
    found = printed_grid(CAMERA, ring, np.tile(places, (3, 1, 1)))
    assert (found.lens, found.lens_error) == (0.0, np.inf)


def test_what_the_grid_tells_of_the_lens_is_weighed_with_what_calibrations_leave():
    plain = layout(NOMINAL, CAMERA.marker_spacing)
    assert plain.lens_within(0.005) == (0.0, 0.005)
    mean, left = replace(plain, lens=0.008, lens_error=0.005).lens_within(0.005)
    assert (mean, left) == pytest.approx((0.004, 0.005 / np.sqrt(2.0)))
    mean, left = replace(plain, lens=0.008, lens_error=1e-6).lens_within(0.005)
    assert (mean, left) == pytest.approx((0.008, criteria.LENS_FORM * 0.005))


@pytest.fixture(scope="module")
def sheet(tmp_path_factory):
    """A sheet without any effect, its markers printed 0.06 mm off."""
    return case(CaseName("null", "", 140, 0.0, print_scatter=SCATTER), tmp_path_factory.mktemp("printed"))[0]


def changed(sheet, folder, change):
    """The session with `change(number, x, y)` in mm applied to the markers."""
    folder.mkdir()
    for path in sheet.iterdir():
        if not path.name.startswith("markers"):
            (folder / path.name).write_bytes(path.read_bytes())
            continue
        lines = path.read_text().splitlines()
        rows = [line.split(",") for line in lines[1:]]
        moved = [(t, n, *change(int(n), float(x), float(y))) for t, n, x, y in rows]
        text = "\n".join([lines[0], *(f"{t},{n},{x:.9f},{y:.9f}" for t, n, x, y in moved)])
        (folder / path.name).write_text(text + "\n")
    return load_session(folder)


def test_print_scatter_raises_no_alarm(sheet):
    answer = discover(load_session(sheet), settings=QUICK)
    assert answer.verdict == "no_discrepancy"
    said = next(text for text in answer.warnings if "markers scatter" in text)
    assert float(re.search(r"by ([\d.]+) mm", said)[1]) == pytest.approx(0.06, rel=0.4)


@pytest.mark.slow
def test_a_scale_error_beyond_the_print_is_named(sheet, tmp_path):
    answer = discover(changed(sheet, tmp_path / "s", lambda n, x, y: (1.02 * x, 1.02 * y)), settings=QUICK)
    assert answer.effects[0].slug == "marker_scale_error"
    assert answer.effects[0].parameters[0].value == pytest.approx(0.02, abs=0.004)


def test_the_base_begins_with_the_lens_that_the_resting_grid_shows(sheet, tmp_path):
    far = 1e3 * np.sqrt(np.sum(NOMINAL**2, axis=1).max())
    bent = changed(
        sheet, tmp_path / "s", lambda n, x, y: tuple(v * (1.0 + 0.02 * (x * x + y * y) / far**2) for v in (x, y))
    )
    for session, least, most in ((load_session(sheet), -0.008, 0.008), (bent, 0.004, 0.02)):
        study = prepare(session, 100)
        problem = TrialsProblem(study, (SimpleNamespace(outward=True),), None, None, ())
        assert least < problem.shape_means["lens"] < most
        assert 0.002 < problem.shape_priors["lens"] < 0.004  # 0.005 without the grid
        mean, precision = EffectModel(problem, ()).prior(np.zeros(len(problem.shapes)))
        place = problem.shapes.index("lens")
        assert (mean[place], precision[place] ** -0.5) == pytest.approx(
            (problem.shape_means["lens"], problem.shape_priors["lens"])
        )
        assert np.count_nonzero(mean) == 1
        off = study.layout.centre_error * np.sqrt(np.sum(study.layout.rest**2, axis=1).max())
        assert 0.0 < off < 0.05 * 0.06e-3 / np.sqrt(18)  # the frame's origin is the tool axis
        assert problem.shape_priors["centre_x"] == problem.shape_priors["centre_y"] == study.layout.centre_error


def test_an_offset_of_one_marker_is_no_signal(sheet, tmp_path):
    shifted = changed(sheet, tmp_path / "s", lambda n, x, y: (x + 0.7 * (n == 4), y))
    one, other = (prepare(each, 100) for each in (load_session(sheet), shifted))
    for before, after in zip(one.conditions, other.conditions, strict=True):
        off = after.signals - before.signals
        middle = np.nanmean(off, axis=(0, 1))
        assert np.nanmax(abs(off - middle)) < 1e-9
        assert abs(middle[[one.names.index(f"radial_{ring}") for ring in (1, 2, 3)]]).max() < 0.01e-3
        assert after.around.markers[4] - before.around.markers[4] == pytest.approx([0.7e-3, 0.0], abs=0.05e-3)
