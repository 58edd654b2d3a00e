"""An interface, or the clamp of the lowest face, that is bonded up to a shear stress and then slides at it.

What slides is the whole of it, from the force on at which the largest shear stress on the bonded interface comes to the
limit; the tissue then has the stiffness that it has on a frictionless interface (see `InterfaceSlip`). Both follow from
the layers: nothing but the stress is given. Shear and stiffnesses are those of small strain.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import j1

from wavemodel.arrays import FloatArray
from wavemodel.domains.endless import Endless, endless
from wavemodel.errors import NotCoveredError, WaveError, require_positive
from wavemodel.layers.compliance import every_face, exact_faces
from wavemodel.layers.laminate import Laminate
from wavemodel.layers.sliding import shear_on, sliding_surface
from wavemodel.loads.rigid import solve_contact
from wavemodel.physics.slip import InterfaceSlip
from wavemodel.press import Press
from wavemodel.remainder import DEEPEST, work

RADII, NEAR = 400, 3.0
"""Where the largest stress is looked for: so many radii, and as many round the tool's edge, to `NEAR` depths away."""


@dataclass(frozen=True)
class ShearLimit:
    """The most shear stress that an interface passes on.

    Attributes
    ----------
    stress
        In Pa, above 0.
    face
        1 to L - 1 for the interface below so many layers, L for the clamp of the lowest face. None: of the interfaces
        between layers the one that slides first.

    Raises
    ------
    WaveError
        If the face is no interface or the stress is not positive.
    """

    stress: float
    face: int | None = None

    def __post_init__(self) -> None:
        if self.face is not None and self.face < 1:
            raise WaveError(f"slip: face = {self.face} is not allowed: 1 for the first interface, 2, .. to the lowest")
        require_positive("slip: stress", self.stress, "Pa")


def interface_slip(press: Press, limit: ShearLimit) -> InterfaceSlip:
    """What a limit is for the whole press: the force at which it slides, and the share of stiffness that it carries.

    Raises
    ------
    NotCoveredError
        With a free lower face.
    WaveError
        If the stack has no such face.
    """
    stack = press.stack
    if stack.base != "bonded":
        raise NotCoveredError("the layered wave does not cover slip with a free lower face: a bonded base is covered")
    nodes = [*stack.top_of_layer.tolist(), stack.sublayers]
    chosen = nodes[1:-1] if limit.face is None else nodes[limit.face : limit.face + 1]
    if not chosen:
        raise WaveError(
            "slip: a single layer has no interface; its lowest face is face = 1"
            if limit.face is None
            else f"slip: face = {limit.face} is not allowed: 1 to {len(nodes) - 1}, the lowest face of the stack"
        )
    return min((_slip_of(press, limit.stress, node) for node in chosen), key=lambda slip: slip.limit)


def _slip_of(press: Press, stress: float, node: int) -> InterfaceSlip:
    stack = press.stack
    depth = float(stack.thickness[:node].sum())
    radius = press.field.traction.basis.radius
    line = endless(DEEPEST / depth, 4.0 * (radius + stack.height))
    share = 1.0 - press.compliance / _sliding_compliance(press, line, node)
    return InterfaceSlip.at_shear(stress, _largest_shear(press, line, node), share)


def _seen(press: Press, line: Endless) -> tuple[Laminate, FloatArray, FloatArray]:
    """The stack, its exact sub-layers and the load of the tool at the wavenumbers of a line."""
    k = line.wavenumber
    return press.stack, exact_faces(k, press.stack), press.field.traction.transform(k)


def _largest_shear(press: Press, line: Endless, node: int) -> float:
    """On the bonded interface per force on the tool, Pa/N."""
    stack, blocks, load = _seen(press, line)
    edge, depth = press.field.traction.basis.radius, float(stack.thickness[:node].sum())
    away = np.linspace(0.0, 2.0 * (edge + stack.height), RADII)
    radius = np.concatenate([away, np.maximum(edge + depth * np.linspace(-NEAR, NEAR, RADII), 0.0)])
    shear = (shear_on(stack, blocks, load, node) * line.weight) @ j1(np.outer(line.wavenumber, radius))
    return float(np.abs(shear).max())


def _sliding_compliance(press: Press, line: Endless, node: int) -> float:
    """Depth per force on a frictionless interface, the contact of a rigid tool solved anew, m/N."""
    stack, blocks, load = _seen(press, line)
    softer = sliding_surface(stack, blocks, node) - every_face(stack, blocks)[:, 0]
    if press.flexibility is None:
        return press.compliance + float(np.einsum("nj,nj,n->", softer[:, 1], load, line.weight))
    basis = press.field.traction.basis
    flexibility = press.flexibility + work(basis.transform(line.wavenumber), softer, line.weight)
    coefficients = solve_contact(basis, flexibility).coefficients
    return float(coefficients @ flexibility @ coefficients)
