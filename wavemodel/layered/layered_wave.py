"""The layered vector wave: a disc pressed on a stack of elastic layers, closed form in space and time.

Each layer is an elastic wave equation in (u, v, w), quadratic through the thickness of its sub-layers, on a window of
sine or Bessel modes round the tool. Nothing is calibrated: the answer follows from thickness, density, E and nu alone.
It is linear, small strain, unless finite strain or options of the body are asked for.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property, partial

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError, WaveError, require_positive
from wavemodel.integrators.inertial import ModalSystem, integrate
from wavemodel.integrators.load_history import History, Load, checked_load
from wavemodel.integrators.quasi_static import StaticBody, quasi_static
from wavemodel.integrators.viscoelastic import Damping, Prony
from wavemodel.layered.body_options import finite_strain_of, options_of, with_slip
from wavemodel.layered.dynamics import first_frequency, modal_system, ringing
from wavemodel.layered.face_motion import LayeredFaces
from wavemodel.layered.field import ModalState
from wavemodel.layered.layer_relaxation import of_shape, one_series, series_of, shared, static_body
from wavemodel.layered.notices import notices
from wavemodel.layered.press import Press, prepare
from wavemodel.layered.shear_limit import ShearLimit
from wavemodel.layered.stack.laminate import BASES
from wavemodel.layered.static_runs import ElasticLaw, finite_strain_run, options_run
from wavemodel.layered.surface import Surface, surface
from wavemodel.layered.window import WaveDiscretisation
from wavemodel.physics.in_plane_stress import InPlaneStress, in_plane_stress
from wavemodel.physics.quasi_static_press import Physics
from wavemodel.solution import WaveSolution
from wavemodel.specimen import DiscTool, WaveLayer

SLOW = 0.02
"""A load is slow if inertia changes the deflection by no more than about this share of its peak."""
INTEGRATORS = ("auto", "quasi_static", "exact")
RELAXING = ("moduli", "shape")


class LayeredWave:
    """A disc-shaped tool on a stack of layers; the constructor does the set-up, `run` a load history.

    Parameters
    ----------
    layers
        L layers from the surface down.
    tool
        Uniform pressure, or rigid and flat, frictionless or bonded; at finite strain also with friction, where tissue
        slides over a rounded edge.
    support
        "bonded", or "free" (nothing under the lower face, the window's border simply supported).
    discretisation
        Window, modes and sub-layers; found automatically by default.
    integrator
        "exact" (with inertia), "quasi_static" (without), or "auto": quasi-static where the load is slow against
        the first frequency, and always under depth control, whose data are measured and would be differentiated
        twice.
    damping
        Proportional to mass and stiffness; none by default.
    relaxation
        Prony series: for all layers, or one (or None) for each; E is then the initial modulus. None: the
        layers are elastic. Series that differ are followed without inertia.
    pretension
        In-plane tensile stress before the press, Pa: one for all layers, one for x and one for y, or an
        `InPlaneStress` with one for each layer. Where x and y differ, the sharp part of the field close to the tool
        (see `WaveDiscretisation.static_correction`) takes their mean.
    large_press
        "auto": "corrected" where that covers tool, base and integrator, else "linear", which warns beyond small strain.
        "linear", or "corrected": the elastic answer is that of a neo-Hookean stack with these moduli under finite
        strain, worked out once in the wave's own modes (see `wavemodel.layered.finite_strain`) to 0.4 of the stack; no
        inertia. "deep": the same to 0.75 of the stack, and from where that ends along the law's tangent, which a
        warning marks. Series that differ between layers then relax what the correction adds by the linear body's creep.
    physics
        Options of the body beyond elasticity, all off by default (see `Physics`); no inertia. Damping by stiffness and
        a shared relaxation take part; series that differ do not.
    slip
        A `ShearLimit`: an interface, or the clamp of the lowest face, that is bonded up to a shear stress and then
        slides at it; no inertia. None: bonded for good.
    relaxing
        "moduli": a series is of all moduli of a layer alike, and Poisson's ratio stays. "shape": it is of the shear
        modulus alone, as in the finite elements; the tool then loses that much force in an endless hold
        (`layer_relaxation.of_shape`), while fields keep their form.
    reach
        Depth, m, to which a large press is worked out, where that is less than `large_press` says: a shallow press of
        a thick stack is set up in a tenth of the time.

    Attributes
    ----------
    press
        The set-up, with the errors of its sub-layers and border.
    law
        Force over depth of the elastic body; what `QuasiStaticPress` takes.
    first_frequency
        Lowest natural frequency of the carried modes, Hz.

    Raises
    ------
    NotCoveredError
        For a support or contact that the model does not describe.
    WaveError
        For a value outside its range.
    """

    def __init__(
        self,
        layers: Sequence[WaveLayer],
        tool: DiscTool,
        support: str = "bonded",
        discretisation: WaveDiscretisation = WaveDiscretisation(),  # noqa: B008 (frozen)
        *,
        integrator: str = "auto",
        damping: Damping | None = None,
        relaxation: Prony | Sequence[Prony | None] | None = None,
        pretension: float | Sequence[float] | InPlaneStress | None = None,
        large_press: str = "auto",
        physics: Physics | None = None,
        slip: ShearLimit | None = None,
        relaxing: str = "moduli",
        reach: float | None = None,
    ) -> None:
        if integrator not in INTEGRATORS:
            raise WaveError(f"integrator = {integrator!r} is not allowed: one of {', '.join(INTEGRATORS)}")
        if relaxing not in RELAXING:
            raise WaveError(f"relaxing = {relaxing!r} is not allowed: one of {', '.join(RELAXING)}")
        if reach is not None:
            require_positive("reach", reach, "m")
        self.layers, self.tool = tuple(layers), tool
        self.integrator, self.damping = integrator, damping or Damping()
        self.relaxation = series_of(relaxation, len(self.layers))
        stress = in_plane_stress(pretension, len(layers))
        touched = tool if large_press == "linear" or integrator == "exact" else tool.at_first_touch
        made = partial(prepare, tool=touched, base=_base(support), chosen=discretisation, stress=stress)
        elastic = made(self.layers)
        if relaxing == "shape":
            self.relaxation = of_shape(
                self.layers, self.relaxation, elastic.compliance, lambda changed: made(changed).compliance
            )
        self.body: StaticBody
        self.press: Press
        self.body, self.press = static_body(elastic, self.layers, tool, self.relaxation, self.damping)
        self.first_frequency: float = first_frequency(self.press)
        self.options = options_of(with_slip(physics, slip, self.press), self.relaxation, self.damping, integrator)
        large = finite_strain_of(large_press, self.press, tool, integrator, reach)
        self.press = replace(self.press, field=replace(self.press.field, large=large))
        self.law = ElasticLaw(self.press.compliance, large)
        if integrator == "exact":
            self._modal_system  # noqa: B018 (set-up, not part of a run)

    @property
    def window(self) -> float:
        """Side of the square window, or diameter of the round one, m."""
        return self.press.field.domain.width

    @property
    def modes(self) -> int:
        """N: the modes are m, n = 1..N, or as many along a radius of the disc."""
        return self.press.field.domain.modes

    @property
    def sublayers(self) -> tuple[int, ...]:
        """Number of sub-layers in each layer."""
        stack = self.press.stack
        return tuple(int(n) for n in np.diff(stack.top_of_layer, append=stack.sublayers))

    @property
    def unknowns(self) -> int:
        """Modes carried, times the unknowns through the thickness."""
        return self.press.field.domain.pairs * self.press.stack.unknowns_per_mode

    def run(self, control: str, time: FloatArray, value: FloatArray) -> WaveSolution[LayeredFaces]:
        """Go through a load history from rest.

        Parameters
        ----------
        control
            "force" or "depth" (of the top face on the axis, or of a rigid tool).
        time
            (n,) in s, rising. The state before the first is unloaded at rest, from time zero on.
        value
            (n,) in N or m, press positive, linear between the instants.

        Raises
        ------
        WaveError
            If the history is not usable.
        """
        load = checked_load(control, time, value)
        added = ringing(load, self.first_frequency, self.damping)
        method = self._method(load, added)
        history = integrate(load, self._modal_system) if method == "exact" else self._static_run(load)
        return WaveSolution(
            time=load.time,
            force=history.force,
            depth=load.value if load.control == "depth" else history.depth,
            layer_names=tuple(layer.name for layer in self.layers),
            top_deflection=history.top_deflection,
            integrator=method,
            warnings=notices(self.press, self.tool, history, method, added),
            faces=LayeredFaces(self.press, history),
        )

    def _static_run(self, load: Load) -> History:
        if self.options is not None:
            return options_run(load, self.press, self.law, self.options)
        if self.law.large is not None:
            return finite_strain_run(load, self.body, self.law)
        return quasi_static(load, self.body)

    def static_state(self, force: float) -> ModalState:
        """State at rest under an elastic force (N), by the initial moduli, for `Surface.frame`."""
        return ModalState(self.press.unit * force, force, force)

    @cached_property
    def _modal_system(self) -> ModalSystem:
        return modal_system(self.press, self.tool.rigid, self.damping, one_series(self.relaxation))

    def _method(self, load: Load, added: float) -> str:
        if self.integrator != "auto":
            return self.integrator
        slow = load.control == "depth" or added <= SLOW
        slow = slow or shared(self.relaxation) is None or self.options is not None or self.law.large is not None
        return "quasi_static" if slow else "exact"

    def surface(self, x: FloatArray, y: FloatArray) -> Surface:
        """Tables for frames at vertices x (P,) by y (Q,), m from the tool axis; see `Surface.frame`."""
        return surface(self.press.field, np.asarray(x), np.asarray(y), len(self.layers))


def _base(support: str) -> str:
    if support in ("hole", "half_space"):
        raise NotCoveredError(f"the layered wave does not cover the support {support!r}; it covers 'bonded'")
    if support not in BASES:
        raise WaveError(f"support = {support!r} is not allowed: 'bonded', 'free', 'hole' or 'half_space'")
    return support
