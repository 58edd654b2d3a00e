"""Cases of the layered wave: a punch on a bonded layer, exact layered elasticity, closed forms of its integrators."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from benchmark.models import Array
from fem.verification import Case, Quantity, layered
from fem.verification.indentation import (
    HAYES_INDENTATION,
    HAYES_KAPPA,
    HAYES_POISSON_RATIO,
    HAYES_RADIUS,
    HAYES_SOURCE,
    HAYES_YOUNGS_MODULUS,
    hayes_kappa,
)
from fem.verification.layered_elasticity import axis_deflection
from wavemodel import Damping, DiscTool, LayeredWave, WaveDiscretisation, WaveLayer

STACK = "skin_bonded"
STATIC_PERCENT, CREEP_PERCENT = 0.1, 0.1
DENSITY = 1000.0
CREEP_TIME, CREEP_POINTS = 0.5, np.linspace(0.2, 4.0, 20)  # long against inertia, which the closed form lacks
VOIGT = "Kelvin-Voigt solid under a {load} force, closed form"


def cases() -> tuple[Case, ...]:
    """Every case."""
    punches = [Case(f"wave_hayes/ratio_{ratio:g}", HAYES_SOURCE, partial(punch, ratio)) for ratio in HAYES_KAPPA]
    return (
        *punches,
        Case(f"wave_layered/{STACK}", layered.SOURCE, interfaces),
        Case(f"wave_disc/{STACK}", layered.SOURCE, partial(interfaces, "disc")),
        Case("wave_creep/held", VOIGT.format(load="held"), partial(creep, held)),
        Case("wave_creep/ramp", VOIGT.format(load="ramped"), partial(creep, ramped)),
    )


def punch(ratio: float) -> tuple[Quantity, ...]:
    """Stiffness of a bonded layer of thickness a / ratio under a frictionless punch."""
    layer = WaveLayer(
        "layer",
        HAYES_RADIUS / ratio,
        DENSITY,
        HAYES_YOUNGS_MODULUS,
        HAYES_POISSON_RATIO,
    )
    wave = LayeredWave([layer], DiscTool(HAYES_RADIUS, "rigid_frictionless"), large_press="linear")
    force = float(wave.run("depth", np.ones(1), np.array([HAYES_INDENTATION])).force[0])
    return (Quantity("", HAYES_KAPPA[ratio], hayes_kappa(force), "", STATIC_PERCENT, wave.unknowns),)


def interfaces(domain: str = "rectangle") -> tuple[Quantity, ...]:
    """Deflection on the axis at the surface and at each interface of skin on a rigid base."""
    wave = _skin(Damping(), "quasi_static", domain)
    force = layered.PRESSURE * np.pi * layered.RADIUS**2
    found = wave.run("force", np.ones(1), np.array([force])).top_deflection[0]
    exact = axis_deflection(layered.STACKS[STACK], layered.RADIUS, layered.PRESSURE)
    return tuple(
        Quantity(f"interface_{n}", 1e3 * reference, 1e3 * ours, "mm", STATIC_PERCENT, wave.unknowns)
        for n, (reference, ours) in enumerate(zip(exact.tolist(), found.tolist(), strict=True))
    )


def held(time: Array) -> tuple[Array, Array]:
    """Force of 1 N from the start on, and its creep w / c = 1 - exp(-t / eta)."""
    return np.ones_like(time), -np.expm1(-time / CREEP_TIME)


def ramped(time: Array) -> tuple[Array, Array]:
    """Force of 1 N per second, and its creep w / c = t - eta (1 - exp(-t / eta))."""
    return time, time + CREEP_TIME * np.expm1(-time / CREEP_TIME)


def creep(load: Callable[[Array], tuple[Array, Array]]) -> tuple[Quantity, ...]:
    """Depth of skin whose damping follows its stiffness, at the instant with the largest error."""
    wave, time = _skin(Damping(0.0, CREEP_TIME), "exact"), CREEP_POINTS
    force, exact = load(np.concatenate(([1e-6], time)))
    found = wave.run("force", np.concatenate(([1e-6], time)), force).depth[1:]
    reference = wave.press.compliance * exact[1:]
    worst = int(np.argmax(np.abs(found / reference - 1.0)))
    return (Quantity("", 1e3 * float(reference[worst]), 1e3 * float(found[worst]), "mm", CREEP_PERCENT, wave.unknowns),)


def _skin(damping: Damping, integrator: str, domain: str = "rectangle") -> LayeredWave:
    stack = layered.STACKS[STACK]
    rows = zip(stack.thickness.tolist(), stack.youngs_modulus.tolist(), stack.poisson_ratio.tolist(), strict=True)
    layers = [WaveLayer(f"layer {n}", t, DENSITY, modulus, nu) for n, (t, modulus, nu) in enumerate(rows)]
    return LayeredWave(
        layers,
        DiscTool(layered.RADIUS),
        discretisation=WaveDiscretisation(domain=domain),
        integrator=integrator,
        damping=damping,
        large_press="linear",
    )
