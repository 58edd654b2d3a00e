"""The press that all answer: three layers of skin, a disc of 5 mm, small strain; and the finite elements of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import fem
from wavemodel import WaveLayer

RADIUS, FORCE, REACH = 5e-3, 0.1, 20e-3
"""Of the tool, m; the press, N; the vertices lie on a square of twice the reach, m."""
LAYERS = (("epidermis", 0.1e-3, 1e6), ("dermis", 1.5e-3, 1e5), ("fat", 10e-3, 2e4))
DENSITY, POISSON_RATIO = 1000.0, 0.48


def wave_layers() -> list[WaveLayer]:
    """The stack in the wave's terms."""
    return [WaveLayer(name, h, DENSITY, e, POISSON_RATIO) for name, h, e in LAYERS]


def fem_model(radius: float = RADIUS, mesh: str = "fine", kinematics: str = "linear") -> fem.Model:
    """The stack in the solver's terms under a disc of some radius, m."""
    law = fem.LinearElastic if kinematics == "linear" else fem.NeoHookean
    return fem.prepare(
        fem.Problem(
            layers=tuple(fem.Layer(name, h, DENSITY, law(e, POISSON_RATIO)) for name, h, e in LAYERS),
            tool=fem.Tool(radius, "uniform_pressure"),
            support=fem.Support("bonded", None),
            kinematics=kinematics,
            discretisation=fem.Discretisation(mesh, None),
        )
    )


@dataclass(frozen=True)
class Reference:
    """Deflection of each layer's top face per newton, (L, R) m/N at radii (R,) m."""

    radii: np.ndarray
    deflection: np.ndarray

    def at(self, distance: np.ndarray) -> np.ndarray:
        """(L, ...) m/N at distances (...), m."""
        return np.stack([np.interp(distance, self.radii, row) for row in self.deflection])


def reference(radius: float = RADIUS) -> Reference:
    """Solve the press by finite elements, fine mesh."""
    solution = fem_model(radius).run(fem.Load("force", np.ones(1), np.array([FORCE])))
    radii = np.linspace(0.0, 1.5 * REACH, 601)
    return Reference(radii, solution.profile(0, radii) / FORCE)


def vertices(count: int) -> np.ndarray:
    """(count,) positions along one side, m from the tool axis."""
    return np.linspace(-REACH, REACH, count)


def errors(found: np.ndarray, exact: np.ndarray) -> np.ndarray:
    """(L,) largest error at the vertices, (L, P, Q) each, in % of the layer's peak; NaN for a layer it lacks."""
    peak = np.abs(exact).max(axis=(1, 2))
    return 100.0 * np.abs(found - exact).max(axis=(1, 2)) / peak
