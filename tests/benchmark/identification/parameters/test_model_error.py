"""How a press of the model may be wrong, and what a fit says where that is let in."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.files import Tool
from benchmark.files.sessions.fit_table import FitTable
from benchmark.identification.model_error import (
    COUNT,
    LENGTH,
    OTHER_CODE,
    PLAIN,
    SHARE_OF_MESH,
    SHARE_TAKEN,
    SIZE,
    ModelError,
    functions,
    jumps,
    model_error,
    taken,
)
from benchmark.identification.parameters.identifiability import directions, discrepancy_use
from benchmark.identification.parameters.identified import identify
from benchmark.identification.parameters.layer_fit import begun, fit_layers
from benchmark.identification.parameters.pressed_set_ups import followed, press_all
from benchmark.identification.parameters.presses import press_surrogate
from benchmark.identification.parameters.session_problem import assembled
from tests.benchmark.identification.parameters.conftest import MODULI, TRUTH, zeros_of

BEND, ALLOWED = 0.02, 0.02


def test_the_discrepancy_is_the_process_that_it_is_said_to_be() -> None:
    """Variance and correlation of the sum of its functions are those of a squared exponential."""
    error = ModelError(0.005, 0.005, 0.02)
    own = error.deviations[PLAIN:, None] * functions(101)[PLAIN:]
    covariance = own.T @ own
    assert covariance[50, 50] == pytest.approx(0.02**2, rel=0.02)
    assert covariance[50, 70] / covariance[50, 50] == pytest.approx(np.exp(-0.5 * (0.2 / LENGTH) ** 2), abs=0.02)
    assert functions(5)[:PLAIN].tolist() == [[1.0] * 5, [-1.0, -0.5, 0.0, 0.5, 1.0]]
    assert error.deviations.size == COUNT == len(functions(5))


def test_the_coarser_the_mesh_the_less_a_press_is_trusted() -> None:
    fine, coarse, untold = (model_error(each) for each in (0.0, -0.012, None))
    assert (fine.size, fine.slope, fine.bend) == (SIZE, OTHER_CODE, OTHER_CODE)
    assert coarse.bend == coarse.slope == pytest.approx(np.hypot(OTHER_CODE, SHARE_OF_MESH * 0.012))
    assert fine.bend < untold.bend < coarse.bend
    assert fine.size < untold.size < coarse.size


def test_a_press_is_no_surer_than_nodes_that_come_into_touch_leave_it() -> None:
    """Fits of two balls trusted their bend to 0.05 %, where it jumped by 0.25 %, and missed the modulus put in."""
    tools = [Tool(radius=5e-3, edge_radius=edge, contact="rigid_frictionless") for edge in (0.5e-3, 2.5e-3, 5e-3)]
    assert [jumps(tool) for tool in tools] == pytest.approx([4e-5, 1e-3, 7e-4])
    assert [jumps(tool) for tool in (Tool(radius=5e-3), Tool(radius=5e-3, contact="rigid_frictionless"))] == [0.0, 0.0]
    plain, jumping = model_error(0.0), model_error(0.0, jumping=1e-3)
    for name in ("size", "slope", "bend"):
        assert getattr(jumping, name) == pytest.approx(np.hypot(getattr(plain, name), 1e-3))


def test_what_is_asked_for_is_the_least_that_a_press_is_mistrusted() -> None:
    asked = model_error(0.0, trust=0.003, discrepancy=0.02)
    assert (asked.size, asked.slope, asked.bend) == (0.003, 0.003, 0.02)


def test_the_estimated_error_of_the_mesh_is_taken_off_every_press(toy, monkeypatch) -> None:
    """The toy's force is too large by the usual part of 2 % and says so: the fit finds what it finds without either."""
    told, share = press_surrogate.differentiated_ramp, 1.0 - 0.02 * SHARE_TAKEN

    def coarse(*args, judge_mesh=False):
        ramp = told(*args, judge_mesh=judge_mesh)
        by = {key: replace(one, force=one.force / share) for key, one in ramp.by.items()}
        return replace(ramp, force=ramp.force / share, by=by, mesh_error=0.02 if judge_mesh else None)

    values = []
    for ramp in (told, coarse):
        monkeypatch.setattr(press_surrogate, "differentiated_ramp", ramp)
        problem = replace(toy(), trust=0.01, discrepancy=0.01)
        found = fit_layers(begun(problem, np.zeros(len(problem.trials)), zeros_of(problem)))
        values.append([found.value(k) for k in problem.free])
    assert values[1] == pytest.approx(values[0], rel=1e-3)


def test_what_goes_with_the_depth_is_taken_off_as_it_does() -> None:
    growing = np.array([0.0, 0.001, 0.004])
    np.testing.assert_allclose(taken(0.01, growing), growing + SHARE_TAKEN * 0.006)
    assert taken(0.01, 0.0) == pytest.approx(0.01 * SHARE_TAKEN)
    assert taken(None, growing) == 0.0


def test_a_press_has_what_the_finite_elements_leave_at_the_edge_at_each_depth(toy, monkeypatch) -> None:
    told = press_surrogate.differentiated_ramp

    def held(*args, judge_mesh=False):
        ramp = told(*args, judge_mesh=judge_mesh)
        return replace(ramp, mesh_error=0.01 if judge_mesh else None, at_edge=0.01 * (ramp.depth / ramp.depth[-1]) ** 2)

    problem, pressed = toy(), []
    for ramp in (told, held):
        monkeypatch.setattr(press_surrogate, "differentiated_ramp", ramp)
        judged, (found, *_) = followed(problem, np.zeros(problem.size))
        pressed.append((found, press_all(judged, np.zeros(problem.size))[0]))
    for plain, taken_off in zip(*pressed, strict=True):
        share = 1.0 - taken_off.force[1:] / plain.force[1:]
        np.testing.assert_allclose(share, 0.01 * (plain.depth[1:] / plain.depth[-1]) ** 2, atol=3e-5)


@pytest.fixture
def bent(toy):
    """A fit to trials whose force is bent over depth by 2 %, which no parameter of the model does alike."""

    def fit(discrepancy):
        problem = toy(noise=2e-3, gain=3e-3, fade=lambda _, force, __: force * (1.0 + bend(force)))
        problem = replace(problem, discrepancy=discrepancy)
        return fit_layers(begun(problem, np.zeros(len(problem.trials)), zeros_of(problem)))

    def bend(force):
        share = np.maximum(force, 0.0) / force.max()
        return BEND * 4.0 * share * (1.0 - share)

    return fit


def answer(found):
    return identify(found, (), directions(found), [one.data.condition for one in found.problem.trials], ("toy",))


def test_what_bends_the_force_is_taken_for_the_specimen_unless_the_model_may_be_wrong(bent) -> None:
    plain, free = (answer(bent(share)) for share in (0.0, ALLOWED))
    assert any(not one.low < 1e-3 * TRUTH[one.key] < one.high for one in plain.estimates if one.low is not None)
    for place, key in enumerate(MODULI):
        assert free.profiles[place].low <= np.log(TRUTH[key]) <= free.profiles[place].high
    assert discrepancy_use(plain.found) is None
    use = discrepancy_use(free.found)
    assert max(abs(size) for _, _, size in use.taken) == pytest.approx(100.0 * BEND, rel=0.6)
    assert all(0.0 <= share < 1.0 for share in use.variance.values())
    assert max(use.variance.values()) > 0.5
    assert any("confounded with every parameter" in text for text in free.warnings)
    assert free.to_dict()["discrepancy"]["percent"] == pytest.approx(100.0 * ALLOWED)


@pytest.mark.parametrize("value", ["0 %", "40 %", "1 mm"])
def test_a_discrepancy_that_is_no_share_is_refused(value) -> None:
    with pytest.raises(InputError, match="discrepancy"):
        assembled([], FitTable(free=("a.youngs_modulus",), discrepancy=value))


def test_rows_are_kept_as_deep_as_the_press_below_where_the_trial_touches(toy) -> None:
    """Not below the earliest touch that the force allows, which would let presses go deeper than any trial."""
    trial = replace(toy().trials[0], onset=-1e-4)
    assert trial.touch.low < -1.5e-4
    assert trial.up_to(1e-3).data.depth.max() == pytest.approx(0.9e-3, abs=2e-5)


def test_a_fit_states_how_far_it_trusts_each_press(toy_fit) -> None:
    first, second = answer(toy_fit()).to_dict()["model_error"]
    assert first["tool_radius_mm"] == pytest.approx(5.0)
    assert first["mesh_percent"] == 0.0
    assert first["bend_percent"] == second["bend_percent"] == pytest.approx(100.0 * OTHER_CODE)
