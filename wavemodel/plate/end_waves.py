"""Waves that decay from an edge, round the axis: modified Bessel functions of s r, inwards I, outwards K.

With S = I_0(s r) or K_0(s r), lap S = s^2 S, and a shape (U, W) of the strip: u = U S' / s, w = W S.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import ive, kve

from wavemodel.arrays import FloatArray
from wavemodel.plate.strip import ComplexArray, Strip


@dataclass(frozen=True)
class EndWaves:
    """m waves on one side of an edge.

    Attributes
    ----------
    root
        (m,) s in 1/m, Re s > 0.
    shape
        (2n, m) of the strip's unknowns (U, W).
    edge
        Radius of the edge, m.
    outwards
        Whether they decay outwards.
    """

    root: ComplexArray
    shape: ComplexArray
    edge: float
    outwards: bool

    def functions(self, radius: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """S / S(edge) and S' / (s S(edge)) at radii (R,) on the waves' side: (m, R) each."""
        far, near = self.root[:, None] * radius, self.root[:, None] * self.edge
        if self.outwards:
            decay = np.exp(near - far) / kve(0, near)
            return kve(0, far) * decay, -kve(1, far) * decay
        decay = np.exp(far.real - near.real) / ive(0, near)
        return ive(0, far) * decay, ive(1, far) * decay

    def at_edge(self, section: Strip) -> tuple[ComplexArray, ComplexArray]:
        """Displacement and nodal forces (2n, m) each on the cylinder through the edge."""
        flat = section.horizontal[:, None]
        value, slope = (part[:, 0] for part in self.functions(np.array([self.edge])))
        displacement = np.where(flat, self.shape * slope, self.shape * value)
        rate = np.where(flat, self.shape * value, self.shape * slope) * self.root
        return displacement, section.traction(displacement, rate, self.edge)

    def displacement(self, node: int, radius: FloatArray, amplitude: ComplexArray) -> FloatArray:
        """(2, R) u and w of a node at radii (R,) for amplitudes (m,) of the waves."""
        value, slope = self.functions(radius)
        u = (self.shape[2 * node] * amplitude) @ slope
        w = (self.shape[2 * node + 1] * amplitude) @ value
        return np.stack([u.real, w.real])
