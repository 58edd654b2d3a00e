"""Options of a layered wave that go beyond the linear wave: checked, and put together."""

from dataclasses import replace

from wavemodel.corrected import correction
from wavemodel.errors import NotCoveredError, WaveError
from wavemodel.integrators.damping import Damping
from wavemodel.integrators.prony import Prony
from wavemodel.large_press.law import LargePress
from wavemodel.memory import shared
from wavemodel.physics.body import Physics
from wavemodel.physics.damping import ViscousDamping
from wavemodel.press import Press
from wavemodel.shear_limit import ShearLimit, interface_slip
from wavemodel.specimen import DiscTool

LARGE_PRESS = ("linear", "corrected", "deep")


def options_of(physics: Physics | None, series: tuple[Prony, ...], damping: Damping, integrator: str) -> Physics | None:
    """The options of a body, with the wave's own relaxation and damping among them.

    Raises
    ------
    NotCoveredError
        With inertia, or with layers that relax each in its own way.
    WaveError
        If relaxation or damping is given twice.
    """
    if physics is None:
        return None
    _without_inertia("options of the body", integrator)
    common = shared(series)
    if common is None:
        raise NotCoveredError("options of the body need one relaxation for all layers, not one for each")
    for name, own, other in (
        ("relaxation", physics.relaxation is not None, bool(common.strength)),
        ("damping", physics.damping is not None, damping.stiffness_time > 0.0),
    ):
        if own and other:
            raise WaveError(f"{name} is given twice, to the wave and in its physics: give one of them")
    if common.strength:
        physics = replace(physics, relaxation=common)
    if damping.stiffness_time:
        physics = replace(physics, damping=ViscousDamping(damping.stiffness_time))
    return physics


def with_slip(physics: Physics | None, slip: ShearLimit | None, press: Press) -> Physics | None:
    """The options of a body with an interface that slides.

    Raises
    ------
    NotCoveredError
        With a free lower face.
    WaveError
        If the stack has no such interface, or slip is given twice.
    """
    if slip is None:
        return physics
    if physics is not None and physics.slip is not None:
        raise WaveError("slip is given twice, to the wave and in its physics: give one of them")
    return replace(physics or Physics(), slip=interface_slip(press, slip))


def large_press_of(word: str, press: Press, tool: DiscTool, integrator: str) -> LargePress | None:
    """The correction of a large press, or None.

    Raises
    ------
    WaveError
        If the word is not one of `LARGE_PRESS`.
    NotCoveredError
        With inertia, or where the correction does not cover tool or support.
    """
    if word not in LARGE_PRESS:
        raise WaveError(f"large_press = {word!r} is not allowed: one of {', '.join(LARGE_PRESS)}")
    if word == "linear":
        return None
    _without_inertia("the large-press correction", integrator)
    return correction(press, tool, deep=word == "deep")


def _without_inertia(what: str, integrator: str) -> None:
    if integrator == "exact":
        raise NotCoveredError(f"the layered wave does not cover inertia with {what}: use 'auto' or 'quasi_static'")
