"""The layered vector wave: a disc pressed on a stack of elastic layers, closed form in space and time.

Each layer is an elastic wave equation in (u, v, w), quadratic through the thickness of its sub-layers, on a window of
sine modes round the tool. Nothing is calibrated: the answer follows from thickness, density, E and nu alone. It is
linear: small strain.
"""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from wavemodel import notices
from wavemodel.arrays import FloatArray
from wavemodel.dynamics import first_frequency, modal_system, ringing
from wavemodel.errors import NotCoveredError, WaveError
from wavemodel.field import Snapshot
from wavemodel.integrators.damping import Damping
from wavemodel.integrators.exact import ModalSystem, integrate
from wavemodel.integrators.load import Load, checked_load
from wavemodel.integrators.quasi_static import quasi_static
from wavemodel.layers.laminate import BASES
from wavemodel.press import Press, prepare
from wavemodel.settings import Settings
from wavemodel.solution import WaveSolution
from wavemodel.specimen import DiscTool, WaveLayer
from wavemodel.surface import Surface, surface

SLOW = 0.02
"""A load is slow if inertia changes the deflection by no more than about this share of its peak."""
INTEGRATORS = ("auto", "quasi_static", "exact")


class LayeredWave:
    """A disc-shaped tool on a stack of layers; the constructor does the set-up, `run` a load history.

    Parameters
    ----------
    layers
        L layers from the surface down.
    tool
        Uniform pressure, or rigid and flat, frictionless or bonded.
    support
        "bonded", or "free" (nothing under the lower face, the window's border simply supported).
    window
        Side of the square window, m. None: so wide that the border costs at most 0.1 % of the peak in it.
    modes
        N, for m, n = 1..N. None: as many as carry the smooth part of the load, k a up to 12.
    sublayers
        Number of equal sub-layers in each layer. None: as many as it takes for 0.05 % of each layer's peak.
    static_correction
        Whether what the modes leave out of the load is answered statically (see `wavemodel.remainder`). None: from
        8 modes up.
    integrator
        "exact" (with inertia), "quasi_static" (without), or "auto": quasi-static where the load is slow against
        the first frequency, and always under depth control, whose data are measured and would be differentiated
        twice.
    damping
        Proportional to mass and stiffness; none by default.

    Attributes
    ----------
    press
        The set-up, with the errors of its sub-layers and border.
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
        window: float | None = None,
        modes: int | None = None,
        *,
        sublayers: Sequence[int] | None = None,
        static_correction: bool | None = None,
        integrator: str = "auto",
        damping: Damping | None = None,
    ) -> None:
        if integrator not in INTEGRATORS:
            raise WaveError(f"integrator = {integrator!r} is not allowed: one of {', '.join(INTEGRATORS)}")
        counts = None if sublayers is None else tuple(sublayers)
        settings = Settings(window, modes, counts, static_correction)
        self.layers, self.tool = tuple(layers), tool
        self.integrator, self.damping = integrator, damping or Damping()
        self.press: Press = prepare(self.layers, tool, _base(support), settings)
        self.first_frequency: float = first_frequency(self.press)
        if integrator == "exact":
            self._modal_system  # noqa: B018 (set-up, not part of a run)

    @property
    def window(self) -> float:
        """Side of the square window, m."""
        return self.press.field.domain.width

    @property
    def modes(self) -> int:
        """N: the modes are m, n = 1..N."""
        return self.press.field.domain.modes

    @property
    def sublayers(self) -> tuple[int, ...]:
        """Number of sub-layers in each layer."""
        stack = self.press.stack
        return tuple(int(n) for n in np.diff(stack.top_of_layer, append=stack.sublayers))

    @property
    def unknowns(self) -> int:
        """Pairs (m, n) carried, times the unknowns through the thickness."""
        return self.press.field.domain.pairs * self.press.stack.unknowns_per_mode

    def run(self, control: str, time: FloatArray, value: FloatArray) -> WaveSolution:
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
        method = self._method(load)
        if method == "exact":
            history = integrate(load, self._modal_system)
        else:
            lag = self.damping.stiffness_time
            press = self.press
            history = quasi_static(load, press.unit, press.unit_axis, press.compliance, lag)
        return WaveSolution(
            time=load.time,
            force=history.force,
            depth=history.depth,
            layer_names=tuple(layer.name for layer in self.layers),
            top_deflection=history.top_deflection,
            integrator=method,
            warnings=notices.notices(self.press, history, method, ringing(load, self.first_frequency, self.damping)),
            _field=self.press.field,
            _history=history,
        )

    def static_state(self, force: float) -> Snapshot:
        """State at rest under a force (N), for `Surface.frame`."""
        return Snapshot(self.press.unit * force, force)

    @cached_property
    def _modal_system(self) -> ModalSystem:
        return modal_system(self.press, self.tool.rigid, self.damping)

    def _method(self, load: Load) -> str:
        if self.integrator != "auto":
            return self.integrator
        slow = load.control == "depth" or ringing(load, self.first_frequency, self.damping) <= SLOW
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
