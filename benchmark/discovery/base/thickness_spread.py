"""Whether the trials of a session press specimens of different thickness, told by how replicates differ.

A thicker sheet is stiffer, and its lower face moves farther for the same press. The gain takes up the first; the second
shows in the markers of each trial, in the shape that the finite elements give for it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.base_shape import THICKNESS
from benchmark.discovery.base.effect_model import SHAPE_STEP, Fit
from benchmark.discovery.base.trials_problem import OWN
from benchmark.response.force_curve import Array


def unlike_in_thickness(fitted: Fit, signals: Sequence[Array], errors: Sequence[Array]) -> bool:
    """Whether replicates differ as specimens of unlike thickness do.

    Parameters
    ----------
    fitted
        Base without thicknesses of the trials' own.
    signals
        Of each trial (n, C) with it.
    errors
        What each trial's signals (n, C) do not share with its mates'; NaN for one without mates.
    """
    problem = fitted.model.problem
    known = [k for k, rows in enumerate(errors) if np.isfinite(rows).all()]
    if len(known) < criteria.ENOUGH_ALIKE or not any(k.endswith(THICKNESS) for t in problem.tables for k in t.by):
        return False
    thicker, taken = _thicker(fitted, signals), _unlike_mates(fitted)
    found = np.array([_share(fitted, index, errors[index], thicker[index], taken[index]) for index in known])
    shares, deviations = found.T
    variance = float(np.mean(shares**2) - np.mean(deviations**2))
    usual = float(np.median(np.abs(shares)) / max(float(np.median(deviations)), 1e-12))
    return usual > criteria.THICKNESS_SEEN and variance > criteria.LEAST_THICKNESS**2


def thickness_spread(fitted: Fit) -> float:
    """Standard deviation of a fit's own thicknesses within conditions, as a share; 0 where there are none."""
    if not fitted.model.problem.prior.thickness:
        return 0.0
    own, groups = fitted.nuisance[:, OWN.index("thickness")], _conditions(fitted)
    rest = own - np.array([own[groups == number].mean() for number in groups])
    freedom = max(own.size - np.unique(groups).size, 1)
    return float(np.clip(np.sqrt(rest @ rest / freedom), criteria.LEAST_THICKNESS, criteria.MOST_THICKNESS))


def _conditions(fitted: Fit) -> Array:
    """(R,) number of each trial's condition."""
    return np.array([trial.condition for trial in fitted.model.problem.trials])


def _thicker(fitted: Fit, signals: Sequence[Array]) -> list[Array]:
    """Derivative of each trial's signals (n, C) by the share by which its specimen is thicker."""
    model, other = fitted.model, fitted.nuisance.copy()
    other[:, OWN.index("thickness")] += SHAPE_STEP
    moved = model.signals(fitted.vector, other)
    return [(more - less) / SHAPE_STEP for more, less in zip(moved, signals, strict=True)]


def _unlike_mates(fitted: Fit) -> Array:
    """(R, q) nuisances of the trials less those of their mates in the mean, scaled as their errors are."""
    groups = _conditions(fitted)
    out = np.zeros_like(fitted.nuisance)
    for number in np.unique(groups):
        mine = groups == number
        own = fitted.nuisance[mine]
        out[mine] = (own - own.mean(axis=0)) * np.sqrt(len(own) / max(len(own) - 1.0, 1.0))
    return out


def _share(fitted: Fit, index: int, error: Array, thicker: Array, taken: Array) -> tuple[float, float]:
    """By how much a trial's specimen is thicker than its mates', and the standard deviation of that.

    What the trial's other nuisances (q,) have taken up of it is put back, and all are told together.
    """
    model, nuisances = fitted.model, fitted.columns.nuisance[index]
    rows, first = model.white.flat(index, error) + nuisances @ taken, model.white.flat(index, thicker)
    columns = np.column_stack([first, nuisances])
    inner = columns.T @ columns + np.diag([0.0, *model.trial_precision])
    inverse = np.linalg.pinv(inner, hermitian=True)
    amount = inverse @ (columns.T @ rows)
    left = rows - columns @ amount
    variance = float(left @ left) / max(int(np.count_nonzero(rows)), 1)
    return float(amount[0]), float(np.sqrt(max(variance * inverse[0, 0], 0.0)))
