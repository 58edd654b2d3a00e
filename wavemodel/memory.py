"""Which layer fades how, and the body without inertia that follows from it."""

from collections.abc import Sequence
from itertools import groupby

from wavemodel import subdivision
from wavemodel.errors import NotCoveredError, WaveError
from wavemodel.integrators.damping import Damping
from wavemodel.integrators.prony import NO_FADING, Prony
from wavemodel.integrators.quasi_static import SharedBody, StaticBody
from wavemodel.layers.laminate import laminate
from wavemodel.layerwise import layerwise
from wavemodel.press import Press
from wavemodel.specimen import WaveLayer


def series_of(relaxation: Prony | Sequence[Prony | None] | None, layers: int) -> tuple[Prony, ...]:
    """One series a layer.

    Raises
    ------
    WaveError
        If their number is not that of the layers.
    """
    if relaxation is None:
        return (NO_FADING,) * layers
    if isinstance(relaxation, Prony):
        return (relaxation,) * layers
    if len(relaxation) != layers:
        raise WaveError(
            f"relaxation: {len(relaxation)} series for {layers} layers; one (or None) for each, or one for all"
        )
    return tuple(one or NO_FADING for one in relaxation)


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


def static_body(
    press: Press, layers: Sequence[WaveLayer], rigid: bool, series: tuple[Prony, ...], damping: Damping
) -> tuple[StaticBody, Press]:
    """The body without inertia, and the press with what its remainder needs."""
    common, retardation = shared(series), damping.stiffness_time
    if common is not None:
        return SharedBody(press.unit[None], press.unit_axis[None], press.compliance, common, retardation), press
    stack = press.stack
    tension = None if stack.tension is None else stack.tension[stack.top_of_layer]
    whole = laminate(layers, subdivision.uniform([1] * len(layers)), stack.base, tension)
    return layerwise(press, whole, rigid, series, retardation)
