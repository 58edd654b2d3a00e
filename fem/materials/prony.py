"""Relaxation of a layer: a Prony series on the isochoric stress, exact for stresses that are linear over each step.

With S the elastic isochoric second Piola-Kirchhoff stress times J^(2/3), h the step, x = h / tau and
phi = (1 - e^-x) / x, each Prony term follows H' = e^-x H + g phi (S' - S), and the stress is
J^(-2/3) DEV[(1 - sum g) S' + sum H'] (J. C. Simo, Comput. Methods Appl. Mech. Engrg. 60 (1987) 153; the recursion:
R. L. Taylor, K. S. Pister and G. L. Goudreau, Int. J. Numer. Methods Engrg. 2 (1970) 45). So the step sees a share
a = 1 - sum g (1 - phi) of the elastic stress and an overstress B = sum (e^-x H - g phi S) that is known before it,
with the potential J^(-2/3) B : C / 2: the tangent stays symmetric. In small strain S is the deviatoric stress.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.errors import FemError, require_positive


@dataclass(frozen=True)
class PronyTerm:
    """One term of the series.

    Attributes
    ----------
    g
        Fraction of the initial shear stiffness that relaxes, above 0 and below 1.
    tau
        Time constant in s, above 0.

    Raises
    ------
    FemError
        If a value is outside its range.
    """

    g: float
    tau: float

    def __post_init__(self) -> None:
        if not 0.0 < self.g < 1.0:
            raise FemError(f"relaxation: g = {self.g:g}: must be above 0 and below 1")
        require_positive("relaxation: tau", self.tau, "s")


def require_something_left(terms: tuple[PronyTerm, ...], where: str) -> None:
    """Refuse a series that leaves no stiffness.

    Raises
    ------
    FemError
        If the fractions add up to 1 or more.
    """
    total = sum(term.g for term in terms)
    if total >= 1.0:
        raise FemError(f"{where}: the fractions g add up to {total:.6g}, their sum must stay below 1")


@dataclass(frozen=True)
class Prony:
    """Series of all elements.

    Attributes
    ----------
    g
        Fractions (T, E), zero where an element has fewer terms.
    tau
        Time constants (T, E) in s.
    """

    g: FloatArray
    tau: FloatArray

    def weights(self, duration: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """e^-x (T, E), g phi (T, E) and the share a (E,) of a step of a duration in s, which may be zero."""
        x = duration / self.tau
        phi = np.where(x > 0.0, -np.expm1(-x) / np.where(x > 0.0, x, 1.0), 1.0)
        share: FloatArray = 1.0 - (self.g * (1.0 - phi)).sum(axis=0)
        return np.exp(-x), self.g * phi, share


@dataclass(frozen=True)
class Memory:
    """What the material remembers at its points.

    Attributes
    ----------
    prony
        The series.
    elastic
        S of the last state, (components, q, E) in Pa.
    terms
        H of each Prony term, (T, components, q, E) in Pa.
    """

    prony: Prony
    elastic: FloatArray
    terms: FloatArray

    @classmethod
    def of_rest(cls, prony: Prony, shape: tuple[int, ...]) -> Memory:
        """Nothing to remember; shape (components, q, E)."""
        return cls(prony, np.zeros(shape), np.zeros((len(prony.g), *shape)))

    def ahead(self, duration: float) -> tuple[FloatArray, FloatArray]:
        """Share a (E,) and overstress B (components, q, E) in Pa of the next step."""
        decay, rate, share = self.prony.weights(duration)
        over = np.einsum("te,tkqe->kqe", decay, self.terms) - rate.sum(axis=0) * self.elastic
        return share, over

    def after(self, duration: float, elastic: FloatArray) -> Memory:
        """Memory after a step that ends with the elastic stress S' (components, q, E) in Pa."""
        decay, rate, _ = self.prony.weights(duration)
        change = rate[:, None, None, :] * (elastic - self.elastic)
        return Memory(self.prony, elastic, decay[:, None, None, :] * self.terms + change)


def prony_of(series: tuple[tuple[PronyTerm, ...], ...], layer: IntArray) -> Prony | None:
    """Series of elements by their layer (E,); None where no layer relaxes."""
    longest = max((len(terms) for terms in series), default=0)
    if longest == 0:
        return None
    g, tau = np.zeros((longest, len(series))), np.ones((longest, len(series)))
    for n, terms in enumerate(series):
        g[: len(terms), n] = [term.g for term in terms]
        tau[: len(terms), n] = [term.tau for term in terms]
    return Prony(g[:, layer], tau[:, layer])
