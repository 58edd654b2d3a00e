"""The set-up of one tool on one stack: window, modes, sub-layers, contact traction and static answer."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.domains.domain import WaveDomain
from wavemodel.errors import WaveError
from wavemodel.layered import subdivision
from wavemodel.layered.field import Field
from wavemodel.layered.remainder import Remainder, remainder, work
from wavemodel.layered.stack.compliance import Compliance, compliance
from wavemodel.layered.stack.laminate import Laminate, laminate
from wavemodel.layered.tractions import (
    Traction,
    TractionBasis,
    UniformPressure,
    enough_functions,
    punch_tractions,
    solve_contact,
)
from wavemodel.layered.window import Taper, WaveDiscretisation, automatic_window, border_cost, window_of
from wavemodel.physics.in_plane_stress import InPlaneStress
from wavemodel.specimen import DiscTool, WaveLayer


@dataclass(frozen=True)
class Parts:
    """Static response of the window and of the remainder to each of J basis tractions.

    Attributes
    ----------
    domain
        Window and modes.
    basis
        The tractions.
    modal
        Compliance of the sub-layers at the K wavenumbers of the modes.
    load
        (K, J, 2) of the tractions along U and W.
    share
        (K,) share of the load that the modes carry.
    rest
        Answer to what they leave out; None where they carry all.
    """

    domain: WaveDomain
    basis: TractionBasis
    modal: Compliance
    load: FloatArray
    share: FloatArray
    rest: Remainder | None

    @cached_property
    def remainder_flexibility(self) -> FloatArray:
        """(J, J) work of each traction on the remainder's displacement under each other, m/N."""
        count = self.basis.net_force.size
        return np.zeros((count, count)) if self.rest is None else self.rest.flexibility

    @cached_property
    def flexibility(self) -> FloatArray:
        """(J, J) work of each traction on the whole displacement under each other, m/N."""
        weight = self.share * self.domain.axis_weight
        return np.asarray(work(self.load, self.modal.faces[:, 0], weight) + self.remainder_flexibility)

    def contact(self, rigid: bool) -> Traction:
        """The traction of unit force: solved for under a rigid tool, else the basis's only one."""
        return solve_contact(self.basis, self.flexibility) if rigid else Traction(self.basis, np.ones(1))


def parts(stack: Laminate, domain: WaveDomain, basis: TractionBasis, taper: Taper, rest: Remainder | None) -> Parts:
    """Evaluate a stack on a window for the tractions of a tool."""
    k = domain.wavenumber
    return Parts(domain, basis, compliance(k, stack), basis.transform(k), taper.modes(k), rest)


@dataclass(frozen=True)
class Press:
    """A tool in a window over a stack, ready to run.

    Attributes
    ----------
    stack
        The sub-layers.
    sublayer_error, border_cost
        Largest errors of a layer's deflection, over its peak, against the exact statics of the endless specimen:
        by the sub-layers, and by the border of a window that the user chose (zero for an automatic one).
    field
        Window, contact traction and remainder.
    share
        (K,) share of the load that the modes carry.
    load
        (K, 2) of the modes per unit force, along U and W.
    unit
        (L, K) static amplitudes per unit force, m3/N.
    unit_axis
        (L,) static deflection of each layer's top face on the axis per unit force, m/N.
    compliance
        Depth per force in statics, m/N: of the top face on the axis, or of the tool if it is rigid.
    remainder_axis, remainder_depth
        The remainder's part of the last two: (L,) and a number.
    modal_stack
        The sub-layers as the modes see them: with the in-plane stress of each one's direction.
    flexibility
        (J, J) work of each traction function of a rigid tool on the displacement under each other, m/N; else None.
    """

    stack: Laminate
    sublayer_error: float
    border_cost: float
    field: Field
    share: FloatArray
    load: FloatArray
    unit: FloatArray
    unit_axis: FloatArray
    compliance: float
    remainder_axis: FloatArray
    remainder_depth: float
    modal_stack: Laminate
    flexibility: FloatArray | None = None


def prepare(
    layers: Sequence[WaveLayer],
    tool: DiscTool,
    base: str,
    chosen: WaveDiscretisation,
    stress: InPlaneStress | None = None,
) -> Press:
    """Set up a press; see `WaveDiscretisation` for what may be left to it. `stress` is that before the press.

    Raises
    ------
    WaveError
        If the tool does not fit the window, the number of sub-layers is not given for each layer, a window is
        missing with a free lower face, or a rigid tool is to do without the static correction.
    NotCoveredError
        If the tool's contact is not covered.
    """
    whole = laminate(layers, subdivision.uniform([1] * len(layers)), base, None if stress is None else stress.mean)
    domain, taper = _window(whole, tool, chosen, stress is not None and stress.directed)
    narrow = chosen.window is not None and base == "bonded"
    border = border_cost(whole, tool.radius, domain.width) if narrow else 0.0
    stack, mistake = _sublayers(layers, whole, chosen, _yardstick(whole, tool, taper, domain))
    basis = _basis(whole, tool, chosen)
    rest = remainder(whole, basis, taper, domain) if taper.active else None
    modal = _seen_by_modes(stack, domain, stress)
    return _assemble(stack, modal, (mistake, border), parts(modal, domain, basis, taper, rest), tool.rigid)


def _seen_by_modes(stack: Laminate, domain: WaveDomain, stress: InPlaneStress | None) -> Laminate:
    if stress is None or not stress.directed:
        return stack
    counts = np.diff(stack.top_of_layer, append=stack.sublayers)
    return replace(stack, tension=np.repeat(stress.along(domain.direction), counts, axis=1))


def _window(whole: Laminate, tool: DiscTool, chosen: WaveDiscretisation, directed: bool) -> tuple[WaveDomain, Taper]:
    if chosen.window is None and whole.base == "free":
        raise WaveError("window: needed with a free lower face, where an endless specimen has nothing to rest on")
    side = automatic_window(whole, tool.radius) if chosen.window is None else chosen.window
    return window_of(chosen, tool.radius, side, directed=directed)


def _yardstick(whole: Laminate, tool: DiscTool, taper: Taper, domain: WaveDomain) -> subdivision.Yardstick:
    """Sub-layers under a rigid tool are chosen by the traction of a flat punch on a half-space."""
    basis = punch_tractions(tool.radius, tool.contact, 1) if tool.rigid else UniformPressure(tool.radius)
    return subdivision.yardstick(whole, Traction(basis, basis.net_force), taper, domain.lowest)


def _basis(whole: Laminate, tool: DiscTool, chosen: WaveDiscretisation) -> TractionBasis:
    if not tool.rigid:
        return UniformPressure(tool.radius)
    if not chosen.corrected:
        raise WaveError(
            "static_correction: needed under a rigid tool (and with it at least 8 modes), for no number of modes "
            "resolves the traction at the tool's edge"
        )
    return punch_tractions(tool.radius, tool.contact, enough_functions(float(whole.thickness[0]) / tool.radius))


def _sublayers(
    layers: Sequence[WaveLayer], whole: Laminate, chosen: WaveDiscretisation, measure: subdivision.Yardstick
) -> tuple[Laminate, float]:
    if chosen.sublayers is None:
        fractions = subdivision.automatic(layers, whole.base, measure, whole.tension)
    elif len(chosen.sublayers) == len(layers):
        fractions = subdivision.uniform(chosen.sublayers)
    else:
        raise WaveError(
            f"sublayers = {chosen.sublayers} is not allowed: one number for each of the {len(layers)} layers"
        )
    stack = laminate(layers, fractions, whole.base, whole.tension)
    return stack, subdivision.error(stack, measure)


def _assemble(stack: Laminate, modal: Laminate, costs: tuple[float, float], made: Parts, rigid: bool) -> Press:
    traction = made.contact(rigid)
    coefficients = traction.coefficients
    load = np.einsum("kji,j->ki", made.load, coefficients)
    unit = np.ascontiguousarray(made.modal.respond(load)[..., 1].T) * made.share
    field = Field(made.domain, traction, made.rest)
    rest_axis = field.remainder(np.zeros(1), layers=unit.shape[0])[:, 0]
    unit_axis = unit @ made.domain.axis_weight + rest_axis
    depth, rest_depth = float(unit_axis[0]), float(rest_axis[0])
    if rigid:
        depth, rest_depth = (
            float(coefficients @ work @ coefficients) for work in (made.flexibility, made.remainder_flexibility)
        )
    return Press(
        stack=stack,
        sublayer_error=costs[0],
        border_cost=costs[1],
        field=field,
        share=made.share,
        load=load,
        unit=unit,
        unit_axis=unit_axis,
        compliance=depth,
        remainder_axis=rest_axis,
        remainder_depth=rest_depth,
        modal_stack=modal,
        flexibility=made.flexibility if rigid else None,
    )
