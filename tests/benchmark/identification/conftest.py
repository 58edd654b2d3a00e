"""Synthetic trials with a known truth: a convex elastic curve, AR(1) noise, gain, zero and onset of each trial."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.signal import lfilter

from benchmark.identification import TrialData
from benchmark.response import ForceCurve


@dataclass(frozen=True)
class Layer:
    name: str
    thickness: float
    youngs_modulus: float
    poisson_ratio: float


def autoregressive(generator, rows, rho):
    """(rows,) stationary AR(1) noise of standard deviation 1."""
    white = generator.normal(size=rows + 200) * np.sqrt(1 - rho**2)
    return lfilter([1.0], [1.0, -rho], white)[200:]


def elastic_curve(reach=9e-3, points=30):
    depth = np.linspace(0.0, reach, points + 1)[1:]
    return ForceCurve(depth, 300.0 * depth * (1.0 + (depth / 5e-3) ** 1.5))


def make_trial(name="a", condition="slow", *, factor=1.7, zero=0.01, onset=2e-4, noise=0.0, rho=0.0, rows=160, seed=0):
    """Rest in the air, press to 5 mm in 6 s, hold 3 s, lift off; noise as a fraction of the peak force."""
    time = 0.1 * np.arange(rows) * 160 / rows
    depth = np.interp(time, [0, 1, 7, 10, 16], [-5e-4, -5e-4, 5e-3, 5e-3, -5e-4])
    curve = elastic_curve()
    force = zero + factor * curve(depth - onset)
    peak = force.max()
    force = force + noise * peak * autoregressive(np.random.default_rng(seed), rows, rho)
    return TrialData(name, condition, time, depth, force, curve)


def make_session(generator, trials=10, *, factor=1.7, scatter=0.08, noise=0.01, rho=0.8):
    return [
        make_trial(
            f"trial_{number:03d}",
            factor=factor * np.exp(scatter * generator.normal()),
            zero=generator.normal(0.0, 0.02),
            onset=generator.normal(0.0, 1e-4),
            noise=noise,
            rho=rho,
            seed=int(generator.integers(2**31)),
        )
        for number in range(trials)
    ]


def make_fading_trial(*, g=0.5, tau=2.0, factor=1.7, noise=0.005, seed=0, name="a"):
    """A trial whose force fades: one Prony term g, tau (s), integrated exactly for piecewise-linear force."""
    elastic = make_trial(name, factor=factor, zero=0.0)
    time, curve, step = elastic.time, elastic.curve, 0.1
    depth = np.interp(time, [0, 1, 4, 16], [-5e-4, -5e-4, 5e-3, 5e-3])
    force = factor * curve(depth - 2e-4)
    decay, memory = np.exp(-step / tau), np.zeros_like(force)
    for row in range(1, len(force)):
        memory[row] = decay * memory[row - 1] + g * (force[row] - force[row - 1]) * (1 - decay) * tau / step
    ripple = noise * force.max() * np.random.default_rng(seed).normal(size=len(force))
    return TrialData(name, "slow", time, depth, 0.01 + (1 - g) * force + memory + ripple, curve)


@pytest.fixture
def silicone():
    return Layer("silicone", 1e-2, 2e4, 0.48)


@pytest.fixture
def skin():
    return [
        Layer("epidermis", 1e-4, 1e6, 0.48),
        Layer("dermis", 1.5e-3, 1e5, 0.48),
        Layer("fat", float("inf"), 2e4, 0.49),
    ]


@pytest.fixture
def curve():
    return elastic_curve()


@pytest.fixture
def trial():
    """Factory of one elastic trial."""
    return make_trial


@pytest.fixture
def session():
    """Factory of a session's trials."""
    return make_session


@pytest.fixture
def fading_trial():
    """Factory of a trial whose force fades."""
    return make_fading_trial


@pytest.fixture
def ar1():
    """Factory of autoregressive noise."""
    return autoregressive
