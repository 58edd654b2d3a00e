"""How a pressure dents the face it acts on, beyond the bending and shear of the sheet.

In small strain it is the layered elasticity of the sheet with both faces free, less what the plate already has:

    w_face(k) - (1 + top k^2) (1 + bulge k^2) / (D k^4) - 1 / (S k^2),

with the bulge of that face and of the top one, on which the pressure works. The plate's terms cancel at small k; what
is left is as local as the sheet is thin.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.domains.endless import Endless, endless
from wavemodel.layers.compliance import every_face, exact_faces
from wavemodel.layers.laminate import laminate
from wavemodel.loads.half_space import HalfSpace
from wavemodel.loads.uniform import UniformPressure
from wavemodel.plate.section import Section
from wavemodel.specimen import WaveLayer

SMALLEST = 0.15
"""k h below which the difference is taken as constant: it is, and the digits of its terms cancel."""
SHARPEST, REACH = 400.0, 3.0


@dataclass(frozen=True)
class Indentation:
    """Answer to a pressure of unit force.

    Attributes
    ----------
    spectrum
        q wavenumbers.
    faces
        (q, L + 1) deflection of the faces, m/Pa, less the half-space's on the surface.
    load
        UniformPressure of the tool.
    body
        The half-space.
    reach
        Beyond this radius (m) there is none.
    """

    spectrum: Endless
    faces: FloatArray
    load: UniformPressure
    body: HalfSpace
    reach: float

    def deflection(self, radius: FloatArray) -> FloatArray:
        """(L + 1, R) per force at radii (R,), m/N."""
        near = np.minimum(radius, self.reach)
        transform = self.load.transform(self.spectrum.wavenumber)[:, 0, 1]
        out = self.spectrum.at_radius(self.faces.T * transform, near)
        out[0] += self.load.half_space_deflection(self.body, near)[:, 0]
        out[:, radius > self.reach] = 0.0
        return out


def indentation(layers: Sequence[WaveLayer], section: Section, bulge: FloatArray, radius: float) -> Indentation:
    """Set up the indentation under a pressure on a disc.

    Parameters
    ----------
    layers, section
        The sheet.
    bulge
        (L + 1,) deflection of the faces per curvature, m2.
    radius
        Of the disc, m.
    """
    stack = laminate(layers, [(1.0,)] * len(layers), "free")
    reach = radius + REACH * section.thickness
    spectrum = endless(max(SHARPEST / radius, 30.0 / section.thickness), reach + radius)
    k = spectrum.wavenumber
    resolved = np.maximum(k, SMALLEST / section.thickness)
    exact = every_face(stack, exact_faces(resolved, stack))[:, :, 1, 1]
    square = resolved[:, None] ** 2
    bent = (1.0 + bulge[0] * square) * (1.0 + bulge * square) / (section.bending * square**2)
    faces = exact - bent - 1.0 / (section.shear * square)
    body = HalfSpace.of(float(stack.shear_modulus[0]), float(stack.lame_modulus[0]))
    faces[:, 0] -= body.normal / k
    return Indentation(spectrum, faces, UniformPressure(radius), body, reach)
