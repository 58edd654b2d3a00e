"""What goes beyond the linear wave, checked and set up: options of the body, slip, and finite strain."""

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import j0

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError, WaveError
from wavemodel.integrators.viscoelastic import Damping, Prony
from wavemodel.layered.field import ModalState
from wavemodel.layered.finite_strain.correction import FiniteStrainLaw, finite_strain_law
from wavemodel.layered.finite_strain.equilibrium import SHORTEST, ModalEquilibrium, press_path, spacing_of
from wavemodel.layered.finite_strain.modal_body import POINTS_PER_MODE, StackBody, disc_modes, thickness_of
from wavemodel.layered.finite_strain.sliding_contact import RoundedTool, SlidingContact
from wavemodel.layered.finite_strain.tool_contact import BondedContact, PressureContact, ToolContact
from wavemodel.layered.layer_relaxation import shared
from wavemodel.layered.press import Press
from wavemodel.layered.shear_limit import ShearLimit, interface_slip
from wavemodel.physics.quasi_static_press import Physics
from wavemodel.physics.time_dependent import ViscousDamping
from wavemodel.specimen import LEAST_FACE, DiscTool

LARGE_PRESS = ("auto", "linear", "corrected", "deep")
RESOLUTION, MOST_MODES = 16.0, 256
"""Largest wavenumber times the tool's radius or the stack's height, whichever is less, and the most modes."""
SHARPER = 32.0
"""The first under a rigid tool on layers with laws of their own: where those stiffen, the edge's part that the modes do
not have stays as soft as at rest. With 16 profiles are up to 3.5 % off, with 32 up to 1.3 %."""
SLIDING = 64.0
"""The first under a tool over whose edge the tissue slides: the touched part of the edge is a few modes wide."""
FEWER_POINTS = 2.0
"""Radial points a mode under such a tool, whose modes go farther than they must: depths change by 0.02 %."""
SHORTEST_SLIDING = 0.25
"""Share of the first step of force at which a sliding path ends: a step that fails takes as long as ten others."""
SHARP_REACH, SHARP_POINTS = 3.0, 600
"""Radii of the tool to which the linear surface has more than such modes, and points of the table of that."""
BORDER = 0.75
"""Radius of the disc over the side of the window, which just lets the linear field die away."""
REACH, DEEP = 0.4, 0.75
"""The path goes to this depth, in heights of the stack; the second on demand."""
VERIFIED, VERIFIED_PRESSURE, VERIFIED_RADII = 0.3, 0.4, 1.75
"""Compared with finite-strain FEM up to these depths, on four skins: heights of the stack under a rigid tool, and
heights of the stack and radii under a pressure. There, on 1 to 12 mm of radius, maxima and profiles are within 0.9 % of
peak at every load; under a bonded rigid tool within 1.7 % and 2.7 %. Two radii deep a pressure of 1 to 2 mm of radius
is up to 4 % off."""
BEYOND = 1.05
"""Times the depth that is asked for, since modes alone are up to some per cent stiffer than the whole."""
FEWEST_LEVELS = 4
DEEPEST_START = 10.0
"""Radii of the tool that the path's first step, a share of the height, may press: with 50 no step that a path allows
finds an equilibrium, after a minute."""


def verified_depth(tool: DiscTool, height: float) -> float:
    """Depth, m, down to which finite strain was compared with the finite elements on stacks of that height, m."""
    if tool.rigid:
        return VERIFIED * height
    return min(VERIFIED_PRESSURE * height, VERIFIED_RADII * tool.radius)


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


def finite_strain_of(
    word: str, press: Press, tool: DiscTool, integrator: str, reach: float | None = None
) -> FiniteStrainLaw | None:
    """What finite strain adds, or None; to a depth, m, where that is less than the word says.

    Raises
    ------
    WaveError
        If the word is not one of `LARGE_PRESS`.
    NotCoveredError
        With inertia, or where the correction does not cover tool or support.
    """
    if word not in LARGE_PRESS:
        raise WaveError(f"large_press = {word!r} is not allowed: one of {', '.join(LARGE_PRESS)}")
    if word == "linear" or (word == "auto" and integrator == "exact"):
        return None
    if word == "auto":
        return _where_covered(press, tool, reach)
    _without_inertia("the large-press correction", integrator)
    return correction(press, tool, reach, deep=word == "deep")


def _where_covered(press: Press, tool: DiscTool, reach: float | None) -> FiniteStrainLaw | None:
    """The correction, or None where it does not cover the press; a run beyond small strain then warns."""
    try:
        return correction(press, tool, reach)
    except WaveError:
        if tool.contact == "rigid_frictional":
            raise
        return None


def _without_inertia(what: str, integrator: str) -> None:
    if integrator == "exact":
        raise NotCoveredError(f"the layered wave does not cover inertia with {what}: use 'auto' or 'quasi_static'")


def correction(press: Press, tool: DiscTool, reach: float | None = None, *, deep: bool = False) -> FiniteStrainLaw:
    """Set up the correction of a press.

    Parameters
    ----------
    press, tool
        What is pressed; where the tissue slides over the tool's edge, the press is that of its face.
    reach
        Depth, m, to which it is wanted, if that is less than `REACH` of the stack.
    deep
        Follow it to `DEEP`, and let the law go on from where the path ends, along its tangent, to the stack's height.

    Raises
    ------
    NotCoveredError
        For pretension, a free lower face, or a contact other than "uniform_pressure", "rigid_bonded", and
        "rigid_frictionless" and "rigid_frictional" with a rounded edge and a flat face.
    WaveError
        If the stack finds no equilibrium beyond small loads.
    """
    if press.stack.tension is not None:
        raise NotCoveredError("the large-press correction does not cover pretension")
    if press.stack.base != "bonded":
        raise NotCoveredError("the large-press correction covers a bonded base, not a free lower face")
    _require_contact(tool)
    height = press.stack.height
    far = min((DEEP if deep else REACH) * height, np.inf if reach is None else BEYOND * reach)
    if spacing_of(height, far) > DEEPEST_START * tool.radius:
        raise WaveError("large press: the tool is too small beside the stack for a path to its heights")
    border = BORDER * press.field.domain.width
    limit = min(max(_resolution(press, tool) / tool.radius, RESOLUTION / height), 3.1 * MOST_MODES / border)
    points = FEWER_POINTS if tool.slides else POINTS_PER_MODE
    body = StackBody(disc_modes(border, limit, points), thickness_of(press.stack))
    equilibrium = ModalEquilibrium(body, contact_of(press, tool, body))
    shortest = SHORTEST_SLIDING if tool.slides else SHORTEST
    path = press_path(equilibrium, height, far, shortest)
    if path.force.size < FEWEST_LEVELS:
        raise WaveError("large press: no equilibrium was found beyond a small load")
    radius = tool.radius if tool.rigid and not tool.slides else 0.0  # a thick skin comes off the middle of a face
    k, deepest = body.radial.wavenumber, height if deep else 0.0
    sharp = _sharp(press, k, path.linear_deflection[0], tool) if tool.slides else None
    return finite_strain_law(path, k, press.compliance, radius, deepest, sharp, grips=tool.friction > 0.0)


def _sharp(press: Press, wavenumber: FloatArray, modal: FloatArray, tool: DiscTool) -> CubicSpline:
    """The surface's linear deflection per force, m/N, over the radius, m, less that of a path's modes (N,)."""
    radius = np.linspace(0.0, SHARP_REACH * tool.radius, SHARP_POINTS)
    whole = press.field.along_x(ModalState(press.unit, 1.0), radius)[0]
    fading = np.clip(2.0 * (1.0 - radius / radius[-1]), 0.0, 1.0)
    return CubicSpline(radius, fading * (whole - modal @ j0(np.outer(wavenumber, radius))))


def _require_contact(tool: DiscTool) -> None:
    if tool.contact in ("uniform_pressure", "rigid_bonded") or tool.slides:
        return
    raise NotCoveredError(
        f"the large-press correction does not cover tool contact {tool.contact!r} with edge_radius = "
        f"{1e3 * tool.edge_radius:g} mm: 'uniform_pressure', 'rigid_bonded', and 'rigid_frictionless' and "
        f"'rigid_frictional' with an edge above 0 and up to {1e3 * (1.0 - LEAST_FACE) * tool.radius:g} mm are covered"
    )


def _resolution(press: Press, tool: DiscTool) -> float:
    if tool.slides:
        return SLIDING
    return SHARPER if tool.rigid and any(press.stack.laws) else RESOLUTION


def contact_of(press: Press, tool: DiscTool, body: StackBody) -> ToolContact:
    """How the tool of a press pushes the modes of a body."""
    traction = press.field.traction
    if press.flexibility is None:
        return PressureContact(body, traction.basis)
    if tool.slides:
        return SlidingContact(
            body, RoundedTool(tool.radius, tool.edge_radius), traction, press.compliance, tool.friction
        )
    return BondedContact(body, traction.basis, press.flexibility)
