"""The engine of least squares against closed forms, dense solutions and SciPy."""

from dataclasses import dataclass

import numpy as np
import pytest
import scipy

from benchmark.response.least_squares import EXACT, Search, descend, fit_record, least_squares, scaled_inverse, settled
from benchmark.response.trials_model import RecordModel, TrialColumns, TrialsEvaluation, differences

TIME = np.linspace(0.0, 1.0, 40)
TIGHT = Search(most=50, gain=0.0, share=1e-14)


@dataclass(frozen=True)
class Straight:
    """R trials measured as slope x design + own level + own drift, linear in everything."""

    measured: np.ndarray
    design: np.ndarray
    trial_precision: np.ndarray
    trial_bounds: tuple | None = None
    precision: float = 0.0

    @property
    def bounds(self):
        return np.full(2, -np.inf), np.full(2, np.inf)

    @property
    def own(self):
        return np.column_stack([np.ones_like(TIME), TIME])

    def prior(self, start):
        return np.zeros(2), np.full(2, self.precision)

    def evaluated(self, vector, nuisance):
        signals = [self.design[k] @ vector + self.own @ own for k, own in enumerate(nuisance)]
        return TrialsEvaluation(vector, nuisance, signals, [m - s for m, s in zip(self.measured, signals, strict=True)])

    def columns(self, at, warm=None):
        return TrialColumns(list(self.design), self.nuisance_columns(at))

    def nuisance_columns(self, at):
        return [self.own] * len(self.measured)


def straight(trials=4, **options):
    rng = np.random.default_rng(3)
    design = rng.normal(size=(trials, TIME.size, 2))
    own = rng.normal(0.0, 0.3, (trials, 2))
    measured = design @ np.array([2.0, -1.0]) + own[:, :1] + own[:, 1:] * TIME + rng.normal(size=(trials, TIME.size))
    return Straight(measured, design, np.array([4.0, 9.0]), **options)


def dense(model, trials):
    """Vector and normal matrix of the same problem with all nuisances in one system."""
    count = len(trials)
    rows = [
        np.hstack([model.design[k], *(model.own if other == k else np.zeros_like(model.own) for other in trials)])
        for k in trials
    ]
    matrix = np.vstack(rows)
    prior = np.diag([model.precision] * 2 + list(model.trial_precision) * count)
    normal = matrix.T @ matrix + prior
    return np.linalg.solve(normal, matrix.T @ np.concatenate([model.measured[k] for k in trials])), normal


def test_eliminating_nuisances_gives_the_dense_solution_its_covariance_and_its_density() -> None:
    model = straight(precision=0.5)
    fitted = least_squares(model, np.zeros(2), np.zeros((4, 2)), search=TIGHT)
    solution, normal = dense(model, range(4))
    assert fitted.vector == pytest.approx(solution[:2], rel=1e-9)
    assert fitted.nuisance.ravel() == pytest.approx(solution[2:], rel=1e-8, abs=1e-10)
    assert fitted.covariance == pytest.approx(np.linalg.inv(normal)[:2, :2], rel=1e-8)
    away = fitted.vector + 0.1
    variance = np.eye(TIME.size) + model.own @ np.diag(1.0 / model.trial_precision) @ model.own.T
    off = model.measured - model.design @ away
    expected = [-0.5 * o @ np.linalg.solve(variance, o) - 0.5 * np.linalg.slogdet(variance)[1] for o in off]
    assert fitted.log_density(away) == pytest.approx(expected, rel=1e-9)


def test_the_fit_without_a_trial_is_that_of_the_others() -> None:
    model = straight()
    fitted = least_squares(model, np.zeros(2), np.zeros((4, 2)), search=TIGHT)
    solution, _ = dense(model, (0, 2, 3))
    assert fitted.without(np.arange(4) == 1) == pytest.approx(solution[:2], rel=1e-7)


def test_nuisances_keep_their_bounds_as_scipy_has_it() -> None:
    low, high = np.full((4, 2), -0.1), np.full((4, 2), 0.15)
    high[2, 1] = low[2, 1] = 0.05  # fixed
    model = straight(trial_bounds=(low, high))
    fitted = least_squares(model, np.zeros(2), np.clip(np.zeros((4, 2)), low, high), search=TIGHT)

    def whole(x):
        nuisance = x[2:].reshape(4, 2)
        at = model.evaluated(x[:2], nuisance)
        return np.concatenate([*at.residuals, (nuisance * np.sqrt(model.trial_precision)).ravel()])

    slack = np.where(high > low, 0.0, 1e-12)
    ends = [np.concatenate([[side] * 2, e.ravel()]) for side, e in ((-np.inf, low - slack), (np.inf, high + slack))]
    start = np.concatenate([np.zeros(2), (0.5 * (low + high)).ravel()])
    other = scipy.optimize.least_squares(whole, start, bounds=ends, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    assert fitted.vector == pytest.approx(other.x[:2], rel=1e-5)
    assert (fitted.nuisance >= low).all()
    assert (fitted.nuisance <= high).all()
    assert np.isin(fitted.nuisance, [-0.1, 0.15]).sum() >= 2
    assert fitted.nuisance[2, 1] == 0.05


def test_a_start_beyond_the_bounds_is_brought_within() -> None:
    """There it fits better than anything allowed, so that no step from it would be taken."""
    low, high = np.full((4, 2), -0.05), np.full((4, 2), 0.05)
    free, model = straight(), straight(trial_bounds=(low, high))
    start = least_squares(free, np.zeros(2), np.zeros((4, 2)), search=TIGHT)
    fitted = least_squares(model, start.vector, start.nuisance, search=TIGHT)
    other = least_squares(model, np.zeros(2), np.zeros((4, 2)), search=TIGHT)
    assert fitted.objective > start.objective
    assert fitted.vector == pytest.approx(other.vector, rel=1e-6)
    assert ((fitted.nuisance >= low) & (fitted.nuisance <= high)).all()


def test_nuisances_settle_within_their_bounds_and_the_others_make_up_for_it() -> None:
    low, high = np.full((4, 2), -0.1), np.full((4, 2), 0.1)
    model = straight(trial_bounds=(low, high))
    fitted = least_squares(model, np.zeros(2), np.zeros((4, 2)), search=TIGHT)
    assert settled(model, fitted.vector, np.full((4, 2), 0.3), EXACT) == pytest.approx(fitted.nuisance, abs=1e-6)


def test_a_fit_that_goes_on_keeps_its_priors_and_says_when_it_has_ended() -> None:
    model = straight(precision=0.5)
    whole = least_squares(model, np.zeros(2), np.zeros((4, 2)), search=TIGHT)
    part = least_squares(model, np.zeros(2), np.zeros((4, 2)), search=Search(most=1, damping=1.0))
    again = least_squares(model, part.vector, part.nuisance, search=TIGHT, around=part.prior_mean)
    assert whole.converged
    assert not part.converged
    assert again.objective == pytest.approx(whole.objective, rel=1e-12)


def rosenbrock(vector):
    return -np.array([10.0 * (vector[1] - vector[0] ** 2), 1.0 - vector[0]])


@pytest.mark.parametrize("high", [np.inf, 0.6])
def test_a_record_ends_where_scipy_ends_also_at_a_bound(high) -> None:
    bounds = np.array([-2.0, -2.0]), np.array([high, 2.0])
    record = RecordModel(rosenbrock, lambda v: differences(rosenbrock, v, 1e-6, bounds), bounds)
    fitted = fit_record(record, np.array([-1.2, 1.0]))
    other = scipy.optimize.least_squares(rosenbrock, [-1.2, 1.0], bounds=bounds, xtol=1e-15, ftol=1e-15)
    assert fitted.vector == pytest.approx(other.x, abs=1e-6)
    assert fitted.nuisance.shape == (1, 0)


def test_a_fixed_parameter_stays_and_has_no_derivative() -> None:
    bounds = np.array([0.5, -2.0]), np.array([0.5, 2.0])
    fitted = fit_record(
        RecordModel(rosenbrock, lambda v: differences(rosenbrock, v, 1e-6, bounds), bounds), np.array([0.5, 1.0])
    )
    assert fitted.vector == pytest.approx([0.5, 0.25], abs=1e-9)
    assert (fitted.columns.vector[0][:, 0] == 0.0).all()


def test_what_the_data_do_not_feel_stays_where_it_began() -> None:
    def residual(vector):
        return np.ones(5) - vector[0] * np.arange(5)

    bounds = np.full(2, -np.inf), np.full(2, np.inf)
    fitted = fit_record(
        RecordModel(residual, lambda v: differences(residual, v, 1e-6, bounds), bounds), np.array([0.0, 0.7])
    )
    assert fitted.vector[0] == pytest.approx(10.0 / 30.0)
    assert fitted.vector[1] == 0.7


def test_with_no_steps_the_start_is_looked_up() -> None:
    model = straight()
    fitted = least_squares(model, np.array([1.0, 2.0]), np.zeros((4, 2)), search=Search(most=0))
    assert fitted.vector.tolist() == [1.0, 2.0]
    assert (fitted.nuisance == 0.0).all()


@dataclass(frozen=True)
class Late:
    """Trials of a bell that is late by a nuisance: Gauss-Newton without damping leaps away from afar."""

    measured: np.ndarray
    trial_precision: np.ndarray
    trial_bounds: None = None
    bounds: tuple = (np.zeros(0), np.zeros(0))

    @staticmethod
    def bell(late):
        return np.exp(-(((TIME - 0.5 - late) / 0.1) ** 2))

    def prior(self, start):
        return start, start

    def evaluated(self, vector, nuisance):
        signals = [self.bell(own[0]) for own in nuisance]
        return TrialsEvaluation(vector, nuisance, signals, [m - s for m, s in zip(self.measured, signals, strict=True)])

    def nuisance_columns(self, at):
        return [((self.bell(own[0] + 1e-6) - self.bell(own[0] - 1e-6)) / 2e-6)[:, None] for own in at.nuisance]

    def columns(self, at, warm=None):
        return TrialColumns([np.zeros((TIME.size, 0))] * len(self.measured), self.nuisance_columns(at))


def test_nuisances_settle_where_two_undamped_steps_would_leap_away() -> None:
    late = np.array([0.0, 0.09, -0.11])
    model = Late(np.array([Late.bell(each) for each in late]), np.array([1e-6]))
    start = np.zeros((3, 1))
    undamped = start.copy()
    for _ in range(2):
        at = model.evaluated(np.zeros(0), undamped)
        for k, n in enumerate(model.nuisance_columns(at)):
            undamped[k] += np.linalg.solve(n.T @ n + np.diag(model.trial_precision), n.T @ at.residuals[k])
    assert np.abs(undamped[:, 0] - late).max() > 5e-3
    found = settled(model, np.zeros(0), start, EXACT)
    assert found[:, 0] == pytest.approx(late, abs=1e-5)


def test_what_is_weakly_told_in_large_units_does_not_seem_known():
    """Stiffnesses of 1e6 for a share and 1e-11 for a stress in Pa, slightly correlated: variances by hand."""
    one, other, both = 1e6, 1e-11, 1e-3
    found = scaled_inverse(np.array([[one, both], [both, other]]))
    determinant = one * other - both**2
    np.testing.assert_allclose(found, np.array([[other, -both], [-both, one]]) / determinant, rtol=1e-9)
    np.testing.assert_allclose(scaled_inverse(np.zeros((2, 2))), 0.0)


def test_derivatives_that_are_known_at_the_start_are_not_worked_out_again():
    asked = []

    class Asked(Straight):
        def columns(self, at, warm=None):
            asked.append(at.vector.copy())
            return super().columns(at, warm)

    plain = straight()
    model = Asked(plain.measured, plain.design, plain.trial_precision)
    start, own = np.array([0.5, 0.5]), np.zeros((4, 2))
    known = plain.columns(plain.evaluated(start, own))
    ended = descend(model, start, own, known=known, search=Search(most=1))
    assert asked == []
    assert not ended.converged
    np.testing.assert_array_equal(
        ended.finished().vector, least_squares(plain, start, own, search=Search(most=1)).vector
    )
    assert len(asked) == 1
    assert len(known.only([2, 0]).vector) == 2
    assert known.only([2, 0]).vector[0] is known.vector[2]


class Arctan:
    """One trial of level arctan(own) beside a slope of the vector."""

    bounds = (np.full(1, -np.inf), np.full(1, np.inf))
    trial_precision, trial_bounds = np.array([1e-6]), None

    def prior(self, start):
        return np.zeros(1), np.zeros(1)

    def evaluated(self, vector, nuisance):
        signal = vector[0] * TIME + np.arctan(10.0 * (nuisance[0, 0] - 3.0))
        return TrialsEvaluation(vector, nuisance, [signal], [2.0 * TIME - signal])

    def columns(self, at, warm=None):
        return TrialColumns([TIME[:, None]], self.nuisance_columns(at))

    def nuisance_columns(self, at):
        return [np.full((TIME.size, 1), 10.0 / (1.0 + 100.0 * (at.nuisance[0, 0] - 3.0) ** 2))]


def test_a_trials_own_step_that_overshoots_is_damped_too() -> None:
    """It went uphill however small the vector's step became, and the fit ended where it stood."""
    fitted = least_squares(Arctan(), np.array([2.0]), np.array([[2.5]]), search=Search(most=60, gain=0.0, share=1e-12))
    assert fitted.vector == pytest.approx(2.0, abs=1e-3)
    assert fitted.nuisance == pytest.approx(np.array([[3.0]]), abs=1e-3)
