"""Options that depend on time: relaxation by a Prony series, poroelastic drainage, viscous damping."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import require_between
from wavemodel.integrators.lags import LagMemory, LagStage, LagSum, relaxation, slopes
from wavemodel.integrators.viscoelastic import Prony
from wavemodel.physics.load_segment import LoadSegment, Memory

TERMS = 12
SMALLEST = 0.05
"""A contact is taken as no smaller than this share of the tool's radius."""
CONTACTS = 512


@dataclass(frozen=True)
class RelaxingForce:
    """F(t) = int G(t - t') df(t'), G = 1 - sum g_j (1 - e^(-t / tau_j)); exact for f linear in each step.

    Y. C. Fung, Biomechanics: Mechanical Properties of Living Tissues, section 7.6.

    Attributes
    ----------
    series
        g_j (together below 1) and tau_j in s.
    """

    series: Prony

    def act(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        return _followed(self.stage(segment, memory), segment)

    def stage(self, segment: LoadSegment, memory: Memory) -> LagStage:
        """Its lags over the steps of a segment, with their memory."""
        law = relaxation(self.series)
        return LagStage(law, segment.duration / law.time[:, None], _remembered(memory, segment, law.time.size))


@dataclass(frozen=True)
class PoroelasticDrainage:
    """F = int (1 - g (1 - phi(xi - xi'))) df, xi = int D / a^2 dt, phi = sum 8 / (n pi)^2 e^(-(n pi / 2)^2 xi), n odd.

    phi is the share of the load that the fluid carries in one-dimensional consolidation (Terzaghi; H. F. Wang, Theory
    of Linear Poroelasticity, section 6.3): 1 - 2 sqrt(xi / pi) at first, as all diffusion. That times go with a^2 / D
    is what Hu et al. (2010, Appl Phys Lett 96:121904) measure by indentation. 12 terms; what is beyond is in the
    last.

    Attributes
    ----------
    strength
        g, 0 to 0.99: the share that drains away; zero: off.
    diffusivity
        D in m2/s, 1e-15 to 1.
    radius
        Of the tool, m, 1e-6 to 1: the largest a.
    edge
        Radius of the tool's rounded edge, m, 0 to `radius`: 0 is a sharp flat face, which touches whole, `radius` a
        ball.
    """

    strength: float
    diffusivity: float
    radius: float
    edge: float = 0.0

    def __post_init__(self) -> None:
        require_between("drainage", "strength", self.strength, "", 0.0, 0.99)
        require_between("drainage", "diffusivity", self.diffusivity, "m2/s", 1e-15, 1.0)
        require_between("drainage", "radius", self.radius, "m", 1e-6, 1.0)
        require_between("drainage", "edge", self.edge, "m", 0.0, self.radius)

    def contact_radius(self, depth: FloatArray) -> FloatArray:
        """(n,) a in m at depths (n,), m.

        Under a flat face of radius b with a rounded edge e, on a half-space, d = a int_b^a f' / sqrt(a^2 - r^2) dr with
        f = (r - b)^2 / 2 e (I. N. Sneddon 1965, Int J Eng Sci 3:47): of a ball, b = 0, Hertz's a^2 = e d.
        """
        if self.edge <= 0.0:
            return np.full_like(depth, self.radius)
        flat = self.radius - self.edge
        contact = np.linspace(max(flat, SMALLEST * self.radius), self.radius, CONTACTS)
        sunk = contact / self.edge * (np.sqrt(contact**2 - flat**2) - flat * np.arccos(flat / contact))
        return np.asarray(np.interp(np.sqrt(np.maximum(depth, 0.0)), np.sqrt(sunk), contact))

    def act(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force; exact for f linear in xi within each step."""
        return _followed(self.stage(segment, memory), segment)

    def stage(self, segment: LoadSegment, memory: Memory) -> LagStage:
        """Its lags over the steps of a segment, with their memory."""
        rate, weight = _spectrum()
        step = segment.duration * self.diffusivity / self.contact_radius(segment.depth) ** 2
        law = LagSum(1.0, -self.strength * weight, 1.0 / rate)
        return LagStage(law, step * rate[:, None], _remembered(memory, segment, TERMS))


def _remembered(memory: Memory, segment: LoadSegment, count: int) -> LagMemory:
    """Where so many lags stand before a segment."""
    first = float(segment.force[0]) if segment.endless else 0.0
    last, *state = memory or (first,) * (count + 1)
    return LagMemory(last, np.array(state))


def _followed(stage: LagStage, segment: LoadSegment) -> tuple[FloatArray, Memory]:
    force, lags = stage.follow(segment.force)
    return force, (float(segment.force[-1]), *np.real(lags[:, -1]).tolist())


def _spectrum() -> tuple[FloatArray, FloatArray]:
    """Rates (in units of D / a^2) and weights, which sum to one."""
    odd = np.arange(1, 2 * TERMS, 2, dtype=np.float64)
    weight: FloatArray = 8.0 / (odd * np.pi) ** 2
    weight[-1] += 1.0 - weight.sum()
    rate: FloatArray = (0.5 * np.pi * odd) ** 2
    return rate, weight


@dataclass(frozen=True)
class ViscousDamping:
    """F = f + eta df_e/dt (Kelvin-Voigt; for a linear law eta K times the speed).

    The rate is that of the step that ends at a sample, as in the layered wave.

    Attributes
    ----------
    retardation
        eta in s, 0 to 1e4; zero: off.
    """

    retardation: float

    def __post_init__(self) -> None:
        require_between("viscous damping", "retardation", self.retardation, "s", 0.0, 1e4)

    def act(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force that the damping adds to the elastic force of the segment."""
        last = memory[0] if memory else float(segment.force[0]) if segment.endless else 0.0
        rate = slopes(segment.duration, segment.force, last)
        return np.where(segment.touching, self.retardation * rate, 0.0), (float(segment.force[-1]),)
