"""How a press of the model may be wrong, and what a fit says where that is let in."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.files.sessions.fit_table import FitTable
from benchmark.identification.parameters.identifiability import directions, discrepancy_use
from benchmark.identification.parameters.identified import identify
from benchmark.identification.parameters.layer_fit import begun, fit_layers
from benchmark.identification.parameters.presses.model_error import LENGTH, ModelError
from benchmark.identification.parameters.session_problem import assembled
from tests.benchmark.identification.parameters.conftest import MODULI, TRUTH, zeros_of

BEND, ALLOWED = 0.02, 0.02


def test_the_discrepancy_is_the_process_that_it_is_said_to_be() -> None:
    """Variance and correlation of the sum of its functions are those of a squared exponential."""
    error = ModelError(0.005, 0.02)
    own = error.deviations[2:, None] * error.functions(101)[2:]
    covariance = own.T @ own
    assert covariance[50, 50] == pytest.approx(0.02**2, rel=0.02)
    assert covariance[50, 70] / covariance[50, 50] == pytest.approx(np.exp(-0.5 * (0.2 / LENGTH) ** 2), abs=0.02)
    assert ModelError(0.005).functions(5).tolist() == [[1.0] * 5, [-1.0, -0.5, 0.0, 0.5, 1.0]]


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
