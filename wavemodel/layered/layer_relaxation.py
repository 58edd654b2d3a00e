"""Which layer relaxes how, and the static answer of a press on them as fields of a few shared lags.

The contact traction of a rigid tool is that of the initial moduli throughout. Its work, and with it the tool's depth,
is stationary against what creep shifts it by; the face under the tool does not stay quite flat: where one layer loses
half of its modulus and its neighbour a fifth, the depth is 0.3 % and the face 3 % off.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np
from numpy.polynomial import Polynomial

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError, WaveError
from wavemodel.integrators.lags import creep
from wavemodel.integrators.quasi_static import LayerwiseBody, SharedBody, StaticBody
from wavemodel.integrators.viscoelastic import ELASTIC, Damping, Prony
from wavemodel.layered import subdivision
from wavemodel.layered.press import Press
from wavemodel.layered.remainder import Remainder, deflections, less_half_space, work
from wavemodel.layered.stack.compliance import exact_faces, layer_faces, quadratic_faces
from wavemodel.layered.stack.creep import LagNodes, StackCreep, lag_nodes, stack_creep
from wavemodel.layered.stack.laminate import Laminate, laminate
from wavemodel.specimen import DiscTool, WaveLayer

LEAST_VOLUME = 5e-4
"""0.5 less Poisson's ratio, below which a layer does not change its volume, and shape is all that relaxes."""


def series_of(relaxation: Prony | Sequence[Prony | None] | None, layers: int) -> tuple[Prony, ...]:
    """One series a layer.

    Raises
    ------
    WaveError
        If their number is not that of the layers.
    """
    if relaxation is None:
        return (ELASTIC,) * layers
    if isinstance(relaxation, Prony):
        return (relaxation,) * layers
    if len(relaxation) != layers:
        raise WaveError(
            f"relaxation: {len(relaxation)} series for {layers} layers; one (or None) for each, or one for all"
        )
    return tuple(one or ELASTIC for one in relaxation)


def shared(series: tuple[Prony, ...]) -> Prony | None:
    """The series that all layers have in common, or None."""
    return series[0] if len(list(groupby(series))) == 1 else None


def one_series(series: tuple[Prony, ...]) -> Prony:
    """The shared series, which a run with inertia needs.

    Raises
    ------
    NotCoveredError
        If layers differ.
    """
    common = shared(series)
    if common is None:
        raise NotCoveredError(
            "the layered wave does not cover inertia with layers that relax each in its own way: give one series for "
            "all layers, or the integrator 'quasi_static'"
        )
    return common


def of_shape(
    layers: Sequence[WaveLayer],
    series: Sequence[Prony],
    initial: float,
    compliance: Callable[[Sequence[WaveLayer]], float],
) -> tuple[Prony, ...]:
    """Series by which all moduli relax so that the tool loses the force that it does where bulk moduli stay.

    Of layers that share a series, by the correspondence principle (R. M. Christensen, Theory of Viscoelasticity, 1982,
    section 2.2) of the elastic stiffness over the shear moduli, a ratio of straight lines through three presses. Of
    layers that differ, each one's loss after an endless hold is scaled to that of two presses, and the times stay.

    Parameters
    ----------
    layers
        L, with their initial moduli.
    series
        L, of their shear moduli.
    initial
        Depth per force, m/N, of an elastic press on the layers.
    compliance
        The same of layers like them.
    """
    relaxing = [n for n, one in enumerate(series) if one.strength and _changes_volume(layers[n])]
    if not relaxing:
        return tuple(series)
    if shared(tuple(series)) is not None:
        lost = 1.0 - series[0].long_term
        middle, last = (initial / compliance([_softer_in_shape(one, g) for one in layers]) for g in (0.5 * lost, lost))
        return (_corresponding(series[0], middle, last),) * len(layers)
    out = list(series)
    for n in relaxing:
        lost = 1.0 - series[n].long_term
        moduli, shape = (
            compliance([*layers[:n], change(layers[n], lost), *layers[n + 1 :]])
            for change in (_softer, _softer_in_shape)
        )
        out[n] = _scaled(series[n], (1.0 - initial / shape) / (1.0 - initial / moduli))
    return tuple(out)


def _changes_volume(layer: WaveLayer) -> bool:
    return 0.5 - layer.poisson_ratio >= LEAST_VOLUME


def _scaled(series: Prony, share: float) -> Prony:
    return Prony(tuple(min(share, 1.0) * g for g in series.strength), series.time)


def _corresponding(series: Prony, middle: float, last: float) -> Prony:
    """The series of a stiffness k(m), of a share m of the shear modulus, that relaxes with it.

    Parameters
    ----------
    series
        Of m, from 1 to m1 in the end.
    middle, last
        k half-way to m1 and at m1, over k(1).
    """
    end = series.long_term
    shares, found = np.array([1.0, 0.5 * (1.0 + end), end]), np.array([1.0, middle, last])
    p, q, r = np.linalg.solve(np.column_stack((np.ones(3), shares, -found * shares)), found)
    whole = Polynomial([1.0])
    for time in series.time:
        whole *= Polynomial([1.0, time])
    left = whole
    for g, time in zip(series.strength, series.time, strict=True):
        left = left - g * (whole // Polynomial([1.0, time]))
    below, above = whole + r * left, p * whole + q * left
    rates = below.roots()
    strength = above(rates) / (rates * below.deriv()(rates))
    if np.iscomplexobj(rates) or (rates >= 0.0).any() or (strength <= 0.0).any():
        return _scaled(series, (1.0 - last) / (1.0 - end))
    return Prony(tuple(strength), tuple(-1.0 / rates))


def _softer(layer: WaveLayer, lost: float) -> WaveLayer:
    """The layer without a share of its moduli."""
    return replace(layer, youngs_modulus=(1.0 - lost) * layer.youngs_modulus, law=None)


def _softer_in_shape(layer: WaveLayer, lost: float) -> WaveLayer:
    """The layer without a share of its shear modulus, with the bulk modulus as it was."""
    shear, bulk = (1.0 - lost) * layer.shear_modulus, layer.lame_modulus + layer.shear_modulus * 2.0 / 3.0
    modulus, ratio = 9.0 * bulk * shear / (3.0 * bulk + shear), (3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear)
    return replace(layer, youngs_modulus=modulus, poisson_ratio=ratio, law=None)


def static_body(
    press: Press, layers: Sequence[WaveLayer], tool: DiscTool, series: tuple[Prony, ...], damping: Damping
) -> tuple[StaticBody, Press]:
    """The body without inertia, and the press with what its remainder needs."""
    common, retardation = shared(series), damping.stiffness_time
    if common is not None:
        unit, axis = press.unit[None], press.unit_axis[None]
        return SharedBody(unit, axis, press.compliance, common, retardation, tool.sticks), press
    stack = press.stack
    tension = None if stack.tension is None else stack.tension[stack.top_of_layer]
    whole = laminate(layers, subdivision.uniform([1] * len(layers)), stack.base, tension)
    body, press = layer_creep(press, whole, tool.rigid, series, retardation)
    return replace(body, sticks=tool.sticks), press


@dataclass(frozen=True)
class _Creep:
    """What creeps: the modes and, where there is one, the remainder with the half-space in it."""

    modal: StackCreep
    sharp: StackCreep | None
    surface_rate: FloatArray
    surface_weight: FloatArray
    surface_instant: float

    @property
    def nodes(self) -> LagNodes:
        sharp = [] if self.sharp is None else [self.sharp.rate.ravel(), self.surface_rate]
        return lag_nodes(np.concatenate([self.modal.rate.ravel(), *sharp]))


def layer_creep(
    press: Press, whole: Laminate, rigid: bool, series: Sequence[Prony], retardation: float
) -> tuple[LayerwiseBody, Press]:
    """Set up creep by layers.

    Parameters
    ----------
    press
        The set-up by the initial moduli.
    whole
        The stack with one sub-layer a layer.
    rigid
        Whether the face under the tool moves as one.
    series
        L, from the surface down.
    retardation
        Kelvin-Voigt time, s.

    Returns
    -------
    tuple
        The body, and the press with the remainder's fields.
    """
    made = _creep(press, whole, series, retardation)
    nodes = made.nodes
    faces = _by_node(made.modal, nodes)
    unit = np.einsum("bklij,kj->bkli", faces, press.load)[..., 1] * press.share[:, None]
    rests = _remainders(press.field.rest, made, nodes)
    coefficients, weight = press.field.traction.coefficients, press.field.domain.axis_weight
    axis = np.einsum("bkl,k->bl", unit, weight)
    if rests:
        axis = axis + deflections(rests, coefficients, np.zeros(1))[..., 0]
    depth = axis[:, 0].copy()
    if rigid:
        for b, one in enumerate(rests):
            modal = work(press.load[:, None], faces[b, :, 0], press.share * weight)
            depth[b] = modal[0, 0] + coefficients @ one.flexibility @ coefficients
    body = LayerwiseBody(np.ascontiguousarray(np.swapaxes(unit, 1, 2)), axis, depth, nodes.rate)
    return body, replace(press, field=replace(press.field, creeping=rests))


def _creep(press: Press, whole: Laminate, series: Sequence[Prony], retardation: float) -> _Creep:
    stack, rest = press.modal_stack, press.field.rest
    k = press.field.domain.wavenumber
    modal = stack_creep(layer_faces(stack, quadratic_faces(k, stack)), stack.base, series, retardation)
    sharp = None
    if rest is not None:
        q = np.maximum(rest.spectrum.wavenumber, press.field.domain.lowest)
        sharp = stack_creep(exact_faces(q, whole), stack.base, series, retardation)
    surface = creep(series[0], retardation)
    return _Creep(modal, sharp, 1.0 / surface.time, surface.weight, surface.instant)


def _by_node(made: StackCreep, nodes: LagNodes) -> FloatArray:
    """(B, n, L, 2, 2): what comes at once, and each shared lag."""
    shared = np.einsum("nmM,nmlij->Mnlij", nodes.share(made.rate), made.faces, optimize=True)
    return np.concatenate([made.instant[None], shared])


def _remainders(rest: Remainder | None, made: _Creep, nodes: LagNodes) -> tuple[Remainder, ...]:
    """B fields of the remainder; none where there is no remainder."""
    if rest is None or made.sharp is None:
        return ()
    factors = [made.surface_instant, *(made.surface_weight @ nodes.share(made.surface_rate))]
    fields = []
    for faces, factor in zip(_by_node(made.sharp, nodes), factors, strict=True):
        body = rest.body.times(float(factor))
        sharp = less_half_space(faces, rest.share, body, rest.spectrum.wavenumber)
        fields.append(replace(rest, faces=sharp, body=body))
    return tuple(fields)
