"""An interface, or the clamp of the lowest face, that is bonded up to a shear stress and then slides at it.

What slides is the whole of it, from the force on at which the largest shear stress on the bonded interface comes to the
limit; the tissue then has the stiffness that it has on a frictionless interface (see `InterfaceSlip`). Both follow from
the layers: nothing but the stress is given. Shear and stiffnesses are those of small strain.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import j1

from wavemodel.arrays import FloatArray
from wavemodel.domains.domain import Endless, endless
from wavemodel.errors import NotCoveredError, WaveError, require_positive
from wavemodel.layered.press import Press
from wavemodel.layered.remainder import DEEPEST, work
from wavemodel.layered.stack.compliance import every_face, exact_faces, inverse
from wavemodel.layered.stack.laminate import Laminate
from wavemodel.layered.tractions import solve_contact
from wavemodel.physics.elastic import InterfaceSlip

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


def shear_on(laminate: Laminate, blocks: FloatArray, load: FloatArray, node: int) -> FloatArray:
    """(n,) amplitude of the shear traction that the body above a face passes on to what is below.

    Parameters
    ----------
    laminate
        A stack on a bonded base.
    blocks
        (n, S, 4, 4) stiffness of its sub-layers between their faces.
    load
        (n, 2) on the surface, along U and W.
    node
        Face: 1 to S - 1 below so many sub-layers, S for the lowest, which is clamped.
    """
    moved = np.einsum("nsij,nj->nsi", every_face(laminate, blocks), load)
    upper, lower = moved[:, node - 1], moved[:, node]
    held = blocks[:, node - 1, 2:, :2] @ upper[..., None] + blocks[:, node - 1, 2:, 2:] @ lower[..., None]
    return np.asarray(-held[:, 0, 0])


def sliding_surface(laminate: Laminate, blocks: FloatArray, node: int) -> FloatArray:
    """(n, 2, 2) compliance of the surface, m/Pa, when one face passes on no shear; see `shear_on`."""
    top, across, bottom = blocks[..., :2, :2], blocks[..., 2:, :2], blocks[..., 2:, 2:]
    last = laminate.sublayers - 1
    schur = top[:, last]
    if node == laminate.sublayers:
        row = across[:, last, 0]
        schur = schur - row[:, :, None] * row[:, None, :] / bottom[:, last, 0, 0, None, None]
    for s in range(last - 1, -1, -1):
        if node == s + 1:
            schur = _without_shear(schur)
        carry = -inverse(bottom[:, s] + schur) @ across[:, s]
        schur = top[:, s] + np.swapaxes(across[:, s], -1, -2) @ carry
    return inverse(schur)


def _without_shear(stiffness: FloatArray) -> FloatArray:
    """Stiffness (n, 2, 2) of what moves along U as it likes."""
    out = np.zeros_like(stiffness)
    out[:, 1, 1] = stiffness[:, 1, 1] - stiffness[:, 0, 1] ** 2 / stiffness[:, 0, 0]
    return out
