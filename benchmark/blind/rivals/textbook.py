"""Rivals as a textbook has them: least BIC among single effects, a Gaussian process of the misfit, sparse terms."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from bench_hw.tables import TrialTable
from benchmark.blind.motion import Array
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.discovery_result import Discovery, NamedEffect
from benchmark.discovery.evidence.selection import usable
from benchmark.discovery.evidence.shortlist import screen
from benchmark.discovery.trials.preparing import prepare
from benchmark.errors import InputError
from benchmark.files import Session
from benchmark.physics import catalogue

ROWS, FITTED = 220, 4
COMMON, AROUND = 0.9, 5
SAMPLES, BINS = 60, 24
DECISIVE = 10.0
"""Difference of BIC, and of twice the log marginal likelihood, that Kass and Raftery (1995) call very strong."""
SMALLEST_TERM = 0.02
"""Share of the peak force below which sparse regression drops a term."""
SINDY_NAMES = {"d^4": "strain_stiffening", "v": "viscous_damping", "d v": "viscous_damping", "1": "force_drift"}
SINDY_NAMES |= {"sign v": "dry_friction", "d sign v": "dry_friction"}


def plain_bic(session: Session, *, seed: int) -> Discovery:  # noqa: ARG001
    """The single effect with the least BIC beside the discovery's own base, every sample counted as independent.

    No held-out trials, no rival within reach, no second effect.
    """
    base = calibrate(session, prepare(session, ROWS)).base
    promising = screen(base, [effect for effect in catalogue() if usable(base, effect)])[:FITTED]
    scored = [(_bic(base, fit_candidate(base, each.effect)), each.effect.slug) for each in promising]
    gained, slug = min(scored, default=(0.0, ""))
    return simple_answer("named", (slug,)) if gained < -DECISIVE else simple_answer("no_discrepancy")


def _bic(base: Fit, fitted: Fit) -> float:
    """BIC with the effect less BIC without it."""
    samples = sum(trial.signals.size for trial in base.model.problem.trials)
    more = len(fitted.vector) - len(base.vector)
    return 2.0 * (fitted.objective - base.objective) + more * float(np.log(samples))


def gaussian_process(session: Session, *, seed: int) -> Discovery:
    """Kennedy and O'Hagan's discrepancy: whether a process over depth and rate explains the base's misfit beyond noise.

    It says that there is a discrepancy (verdict `outside_catalogue`) and names nothing.

    Raises
    ------
    InputError
        scikit-learn is not installed.
    """
    try:
        from sklearn.gaussian_process import GaussianProcessRegressor
        from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel
    except ImportError:
        raise InputError("the rival gaussian_process needs scikit-learn: pip install 'tissuebench[rivals]'") from None
    places, misfit = _binned(calibrate(session, prepare(session, ROWS)).base)
    of = partial(GaussianProcessRegressor, random_state=seed, n_restarts_optimizer=2)
    noise = WhiteKernel(1.0, (1e-6, 1e2))
    signal = ConstantKernel(1.0, (1e-4, 1e3)) * RBF([0.5, 0.5], (0.05, 10.0)) + WhiteKernel(0.1, (1e-6, 1e2))
    with_it, without = (of(kernel).fit(places, misfit).log_marginal_likelihood_value_ for kernel in (signal, noise))
    found = 2.0 * (with_it - without) - 3.0 * np.log(misfit.size) > DECISIVE
    return simple_answer("outside_catalogue" if found else "no_discrepancy")


def _binned(base: Fit) -> tuple[Array, Array]:
    """Places (n, 2) in depth and rate, over their largest, and the base's mean misfit (n,) there, in its spread."""
    trials = base.model.problem.trials
    simulated = base.model.signals(base.vector, base.nuisance)
    rest = np.concatenate([trial.signals[:, 0] - each[:, 0] for trial, each in zip(trials, simulated, strict=True)])
    depth = np.concatenate([trial.motion.depth for trial in trials])
    rate = np.concatenate([np.gradient(trial.motion.depth, trial.motion.time) for trial in trials])
    depth, rate = depth / depth.max(), rate / np.abs(rate).max()
    cell = np.digitize(depth, np.linspace(0, 1, BINS)) * 100 + np.digitize(rate, np.linspace(-1, 1, 9))
    kept = [np.flatnonzero((cell == number) & (depth > 0.0)) for number in np.unique(cell[depth > 0.0])]
    places = np.array([[depth[rows].mean(), rate[rows].mean()] for rows in kept])
    means = np.array([rest[rows].mean() for rows in kept])
    return places, means / means.std()


def sindy(session: Session, *, seed: int) -> Discovery:  # noqa: ARG001
    """Sparse regression (pysindy's STLSQ) of the force on terms of depth and rate; the largest beyond the elastic ones.

    Raises
    ------
    InputError
        pysindy is not installed.
    """
    try:
        from pysindy.optimizers import STLSQ
    except ImportError:
        raise InputError("the rival sindy needs pysindy: pip install 'tissuebench[rivals]'") from None
    samples = force_samples(session, 4 * SAMPLES)
    names, terms = _library(samples)
    scale = np.abs(terms).max(axis=0)
    found = np.ravel(STLSQ(threshold=SMALLEST_TERM, alpha=1e-6).fit(terms / scale, samples.force[:, None]).coef_)
    sizes = {name: abs(size) for name, size in zip(names, found, strict=True) if name in SINDY_NAMES and size}
    if not sizes:
        return simple_answer("no_discrepancy")
    return simple_answer("named", (SINDY_NAMES[max(sizes, key=lambda name: sizes[name])],))


def _library(samples: ForceSamples) -> tuple[list[str], Array]:
    """Names and values (n, terms) of the library."""
    d, v = samples.depth, samples.rate
    touching, way = (d > 0.0).astype(float), np.sign(v) * (np.abs(v) > 0.02)
    library = {
        "d": d, "d^2": d**2, "d^3": d**3, "d^4": d**4, "1": np.ones_like(d), "v": touching * v, "d v": d * v,
        "sign v": touching * way, "d sign v": d * way,
    }  # fmt: skip
    return list(library), np.column_stack(list(library.values()))


@dataclass(frozen=True, eq=False)
class ForceSamples:
    """Samples of all trials, (n,) each, over their largest: force, pressed depth (0 in air), rate; and the trial."""

    force: Array
    depth: Array
    rate: Array
    trial: Array


def force_samples(session: Session, rows: int) -> ForceSamples:
    """Samples of a session, about `rows` a trial; trials of other stiffness are made equal where all have been."""
    tables = [trial.table for trial in session.trials]
    reached = COMMON * min(float(np.max(table.depth)) for table in tables)
    parts = [_of_trial(number, table, rows, reached) for number, table in enumerate(tables)]
    force, depth, rate, trial = (np.concatenate(column) for column in zip(*parts, strict=True))
    return ForceSamples(force / np.abs(force).max(), depth / depth.max(), rate / np.abs(rate).max(), trial)


def _of_trial(number: int, table: TrialTable, rows: int, reached: float) -> tuple[Array, Array, Array, Array]:
    """Force over that at the first passing of a depth that all trials reach, pressed depth, rate, and the number."""
    first = int(np.flatnonzero(table.depth >= reached)[0])
    there = float(np.median(table.force[max(first - AROUND, 0) : first + AROUND]))
    picked = np.linspace(0, table.time.size - 1, min(rows, table.time.size)).astype(int)
    rate = np.gradient(table.depth, table.time)
    pressed = np.clip(table.depth, 0.0, None)[picked]
    return table.force[picked] / there, pressed, rate[picked], np.full(picked.size, float(number))


def simple_answer(verdict: str, effects: tuple[str, ...] = ()) -> Discovery:
    """An answer with a verdict and names alone."""
    return Discovery(
        verdict=verdict,
        statement="",
        p=None,
        effects=tuple(NamedEffect(slug, 1.0, (), ()) for slug in effects),
        where=(),
        contrasts=(),
        gap=(),
        smallest_visible={},
        candidates=(),
        base=(),
        remains=(),
        warnings=(),
        traces=(),
        conditions=(),
        channels=(),
        trials=(),
        seconds=0.0,
    )
