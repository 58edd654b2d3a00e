"""Small problems the tests of the finite-element package share."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import fem
from fem.assembly.system import System

SKIN = ((1e-4, 1e6), (1.5e-3, 1e5), (1e-2, 2e4))


@pytest.fixture(autouse=True, scope="session")
def one_thread() -> None:
    """Timing and round-off of the solver must not depend on what else runs on the machine."""
    from threadpoolctl import threadpool_limits

    threadpool_limits(1)


@pytest.fixture
def skin() -> Callable[..., fem.Problem]:
    """Three skin layers (0.1, 1.5 and 10 mm) under a 5 mm tool."""

    def make(contact: str = "uniform_pressure", kinematics: str = "finite", nu: float = 0.48, **other) -> fem.Problem:
        layers = tuple(
            fem.Layer(name, thickness, 1000.0, fem.NeoHookean(modulus, nu))
            for name, (thickness, modulus) in zip(("epidermis", "dermis", "fat"), SKIN, strict=True)
        )
        return fem.Problem(layers, fem.Tool(5e-3, contact), fem.Support("bonded"), kinematics, **other)

    return make


@pytest.fixture
def slab() -> Callable[..., fem.Problem]:
    """One layer of 15 mm, 20 kPa, under a 5 mm tool."""

    def make(
        contact: str = "rigid_bonded",
        kinematics: str = "finite",
        nu: float = 0.49,
        thickness: float = 15e-3,
        density: str = "default",
        support: fem.Support = fem.Support("bonded"),  # noqa: B008 (frozen)
    ) -> fem.Problem:
        layer = fem.Layer("slab", thickness, 1000.0, fem.NeoHookean(2e4, nu))
        return fem.Problem((layer,), fem.Tool(5e-3, contact), support, kinematics, fem.Discretisation(density))

    return make


@pytest.fixture
def ramp() -> Callable[..., fem.Load]:
    """Linear ramp to a peak in n steps."""

    def make(control: str, peak: float, n: int = 10) -> fem.Load:
        k = np.arange(1, n + 1)
        return fem.Load(control, k / n, peak * k / n)

    return make


@pytest.fixture
def triangle() -> Callable[..., fem.Load]:
    """Up to a peak at half time and back to zero, n steps."""

    def make(control: str, peak: float, n: int = 20) -> fem.Load:
        k = np.arange(1, n + 1)
        return fem.Load(control, k / n, peak * np.minimum(k, n - k) / (n / 2))

    return make


@pytest.fixture(scope="session")
def elastic_energy() -> Callable[[System, np.ndarray], float]:
    """Return the function that gives the elastic energy in J of a body of one law at unknowns y (n,)."""

    def energy(system: System, y: np.ndarray) -> float:
        elements = system.elements
        deformation = elements.deformation(system.element_displacement(y))
        (group,), weight, change = elements.laws.groups, elements.geometry.weight, deformation.volume_change
        mean = np.einsum("iqe,qe->ie", elements.geometry.pressure, weight * change)
        at_points = group.law.energy(deformation, group.parameters) + 0.5 * elements.point_modulus * change**2
        return float((weight * at_points).sum() + 0.5 * (elements.field_modulus * mean**2).sum())

    return energy
