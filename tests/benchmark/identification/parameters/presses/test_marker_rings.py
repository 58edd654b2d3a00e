"""Markers of a sheet fitted along with the force: what a ring shows, its derivatives, and what it tells of layers."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.identification.parameters.free_parameters import with_values
from benchmark.identification.parameters.identifiability import directions, errors_alone
from benchmark.identification.parameters.identified import identify
from benchmark.identification.parameters.law_shapes import shear_modulus
from benchmark.identification.parameters.layer_fit import begun, fit_layers
from benchmark.identification.parameters.presses import press_surrogate
from benchmark.identification.parameters.presses.marker_rings import RINGS, TRUST, MarkerRows, rings_of
from benchmark.identification.sheet_model import FilmedTrial
from benchmark.models.model_result import LowerFace
from benchmark.response.differentiated_ramp import RampDerivative
from benchmark.response.ramp_table import EVERYWHERE, CameraView
from tests.benchmark.identification.parameters.conftest import LAYERS, TRUTH, toy_ramp, zeros_of

RADIUS = np.linspace(0.0, 30e-3, 61)
X, Y = (each.ravel() for each in np.meshgrid(6e-3 * (np.arange(6) - 2.5), 6e-3 * (np.arange(3) - 1.0)))
GRID = np.column_stack([X, Y])
POWERS = np.array([0.4, 0.1, -0.5])
"""Of the layers' moduli in the motion of the lower face: no common factor moves it at prescribed depth."""
NOISE = 2e-6


def toy_face(tissue, depth):
    """A lower face that moves outwards by up to a twelfth of the depth."""
    size = 1e-1 * np.exp(POWERS @ np.log([shear_modulus(one) for one in tissue.layers]))
    shape = (RADIUS / 12e-3) * np.exp(1.0 - RADIUS / 12e-3)
    return LowerFace(depth, RADIUS, size * depth[:, None] * shape, 0.8 * depth[:, None] * np.exp(-RADIUS / 15e-3))


def sheet_ramp(session, tissue, tool, support, depth, keys, model="fem", steps=24, *, judge_mesh=False):
    """The toy with a lower face."""
    plain = toy_ramp(session, tissue, tool, support, depth, keys, model, steps, judge_mesh=judge_mesh)
    face = toy_face(tissue, plain.depth)
    powers = dict(zip((f"{name}.stiffness" for name in LAYERS), POWERS, strict=True))
    by = {
        key: RampDerivative(one.force, powers[key] * face.outward, np.zeros_like(face.sunk))
        for key, one in plain.by.items()
    }
    return replace(plain, face=face, by=by)


def filmed(trial, tissue, view=EVERYWHERE, axis=(0.0, 0.0), seed=1):
    """A film of the toy's markers beside a trial, whose camera stands anywhere."""
    generator = np.random.default_rng(seed)
    depth = np.maximum(trial.depth[::2], 0.0)
    rings = rings_of([FilmedTrial(trial, depth, GRID[None], GRID)], [(0.0, 0.0)], view)[0]
    face = toy_face(tissue, np.linspace(0.0, 1.1 * depth.max(), 30))
    out, sunk = (np.array([np.interp(np.hypot(X, Y), RADIUS, row) for row in one]) for one in (face.outward, face.sunk))
    out, sunk = (np.array([np.interp(depth, face.depth, one) for one in each.T]).T for each in (out, sunk))
    places = view.seen(GRID + out[..., None] * GRID / np.hypot(X, Y)[:, None], sunk) + np.asarray(axis)
    places = places + NOISE * generator.normal(size=places.shape)
    assert len(rings.weights) == RINGS
    return FilmedTrial(trial, trial.depth[::2], places, GRID + np.asarray(axis))


@pytest.fixture
def sheet(toy, monkeypatch):
    """A factory of problems under one tool, with markers or without."""
    monkeypatch.setattr(press_surrogate, "differentiated_ramp", sheet_ramp)

    def problem(markers=True):
        made = toy(tools=(0,))
        if not markers:
            return made
        tissue = with_values(made.presses[0].setup, TRUTH)[0]
        axes = [(1e-4 * k, -5e-5) for k in range(len(made.trials))]
        films = [
            filmed(one.data, tissue, axis=axis, seed=k)
            for k, (one, axis) in enumerate(zip(made.trials, axes, strict=True))
        ]
        rings, rows = rings_of(films, axes, EVERYWHERE)
        trials = tuple(replace(one, film=row) for one, row in zip(made.trials, rows, strict=True))
        return replace(made, trials=trials, presses=(replace(made.presses[0], rings=rings),))

    return problem


def fitted(problem):
    return fit_layers(begun(problem, np.zeros(len(problem.trials)), zeros_of(problem)))


def test_a_ring_shows_the_mean_motion_of_its_markers_wherever_the_camera_stands(sheet) -> None:
    problem = sheet()
    rings, film = problem.presses[0].rings, problem.trials[3].film
    deep = int(np.argmax(film.depth))
    face = toy_face(with_values(problem.presses[0].setup, TRUTH)[0], np.linspace(0.0, 2.2e-3, 30))
    seen = rings.seen(face, film.depth[deep : deep + 1])[0]
    assert film.moved[deep] == pytest.approx(seen, abs=4.0 * NOISE)
    assert rings.weights.sum(axis=1) == pytest.approx(1.0)
    assert np.count_nonzero(rings.weights, axis=1).tolist() == [6, 6, 6]


def test_a_ring_changes_with_the_face_as_differences_say_under_perspective_too(sheet) -> None:
    rings = replace(sheet().presses[0].rings, view=CameraView(0.2, (2e-3, -1e-3)))
    face, levels = (
        toy_face(with_values(sheet().presses[0].setup, TRUTH)[0], np.linspace(0.0, 2e-3, 9)),
        np.array([1e-3, 2e-3]),
    )
    more, deeper = 0.3 * face.outward, 0.2 * face.sunk
    sides = [replace(face, outward=face.outward + s * more, sunk=face.sunk + s * deeper) for s in (-1e-3, 1e-3)]
    want = (rings.seen(sides[1], levels) - rings.seen(sides[0], levels)) / 2e-3
    assert rings.changes(face, more, deeper, levels) == pytest.approx(want, rel=1e-5)


def test_the_columns_of_a_filmed_fit_are_its_differences(sheet) -> None:
    found = fitted(sheet())
    model, vector, nuisance = found.model, found.vector + 0.01, found.fit.nuisance
    at = model.evaluated(vector, nuisance)
    columns = model.columns(at)
    for index in range(vector.size):
        step = np.zeros(vector.size)
        step[index] = 1e-5
        sides = [model.evaluated(vector + sign * step, nuisance).residuals[2] for sign in (-1.0, 1.0)]
        assert (sides[0] - sides[1]) / 2e-5 == pytest.approx(columns.vector[2][:, index], rel=1e-4, abs=1e-3)
    zero = np.zeros(nuisance.shape)
    zero[2, -1] = 1e-4
    sides = [model.evaluated(vector, nuisance + sign * zero).residuals[2] for sign in (-1.0, 1.0)]
    assert (sides[0] - sides[1]) / 2e-4 == pytest.approx(columns.nuisance[2][:, -1], rel=1e-6, abs=1e-6)


def test_markers_tell_layers_that_the_force_under_one_tool_does_not(sheet) -> None:
    with_markers, alone = (fitted(sheet(markers)) for markers in (True, False))
    errors = [errors_alone(one.fit, one.problem.free) for one in (with_markers, alone)]
    assert (errors[0] < 0.5 * errors[1]).all()
    off = with_markers.vector[:3] - np.log(list(TRUTH.values()))
    assert (np.abs(off) < 3.0 * np.sqrt(np.diag(with_markers.fit.covariance)[:3])).all()
    said = identify(with_markers, (), directions(with_markers), ["one"] * 5, ("toy",)).to_dict()["markers"]
    assert said["trials"] == 5
    assert said["residual_um"] == pytest.approx(1e6 * NOISE / np.sqrt(6.0), rel=0.3)
    noise = with_markers.model.film_noise[0].deviation
    assert noise == pytest.approx(NOISE / np.sqrt(6.0), rel=0.3)
    assert errors[0][POWERS.argmin()] > TRUST


def test_a_film_that_saw_other_markers_is_left_out(sheet) -> None:
    trial = sheet().trials[0].data
    film = FilmedTrial(trial, trial.depth[:40], np.broadcast_to(GRID, (40, *GRID.shape)), GRID)
    other = replace(film, places=film.places + 5e-3, rest=GRID + 5e-3)
    rows = rings_of([film, film, other], [(0.0, 0.0)] * 3, EVERYWHERE)[1]
    assert [isinstance(one, MarkerRows) for one in rows] == [True, True, False]
    few = replace(film, places=film.places[:, :4], rest=GRID[:4])
    assert rings_of([few], [(0.0, 0.0)], EVERYWHERE) is None
