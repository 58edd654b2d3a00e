"""The wave of a sheet over a hole: a disc pressed on layers that are clamped round a hole and hang free over it.

Large deflections stretch the sheet, and its tension carries most of the load. Nothing but three numbers of the tool's
edge (`edge_law`) is calibrated. The clamp holds the sheet's lower face only, outside the hole: how far the sheet gives
way behind that edge is worked out from layered elasticity (`edge`), so there is no effective radius to choose.
"""

from collections.abc import Sequence

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError, WaveError, require_positive
from wavemodel.integrators.load_history import Load, checked_load
from wavemodel.integrators.viscoelastic import Damping, Prony
from wavemodel.physics.quasi_static_press import Physics
from wavemodel.sheet.carrier import carrier
from wavemodel.sheet.force_depth import PreparedLaw, plate_law
from wavemodel.sheet.sheet import sheet
from wavemodel.sheet.sheet_runs import PlateHistory, Statics, fading_run, memory_of, options_run
from wavemodel.sheet.solution import PlateSolution
from wavemodel.sheet.uniform_tension import UniformTension
from wavemodel.specimen import DiscTool, WaveLayer

REACH = 0.4
"""Depth over the hole's radius up to which the set-up goes; a deeper press extends it."""
VERIFIED = {"rigid": (0.5, 0.2), "pressure": (0.3, 0.14)}
"""Depth, and thickness of the sheet, over the hole's radius up to which the model was compared with finite elements and
found within 2.2 %. Sheets twice as thick are up to 6 % off under a rigid tool and 8 to 22 %
under a pressure."""


class PlateWave:
    """A disc-shaped tool on layers over a round hole, on the hole's axis; the constructor does the set-up.

    Parameters
    ----------
    layers
        L layers from the surface down.
    tool
        Uniform pressure, or rigid and flat, bonded or frictionless.
    support
        "hole".
    hole_radius
        In m; the lower face is held outside it.
    modes
        Radial functions for each of u, w and the rotation. None: 12, right to 1e-4.
    pretension
        Of the sheet before the press, N/m, equal in all directions.
    reach
        Depth up to which the set-up finds equilibria, m. None: 0.4 of the hole's radius. A run that goes beyond it
        extends the set-up.
    tension
        "local": the sheet's own, at any strain, neo-Hookean. "uniform": Kirchhoff's and Carrier's, the same everywhere,
        Hookean. None: "local", or "uniform" with the integrator "mid_point".
    integrator
        "quasi_static" (without inertia) or "mid_point" (with it, energy kept; a uniform tension only).
    damping
        With inertia: proportional to mass and stiffness; none by default.
    tool_mass
        With inertia: of a rigid tool, kg.
    relaxation
        Fading memory of the whole sheet, without inertia; E is then the initial modulus. None: elastic.
    physics
        Options of the body beyond elasticity, without inertia; all off by default (see `Physics`).

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
        support: str = "hole",
        hole_radius: float | None = None,
        modes: int | None = None,
        *,
        pretension: float = 0.0,
        reach: float | None = None,
        tension: str | None = None,
        integrator: str = "quasi_static",
        damping: Damping | None = None,
        tool_mass: float = 0.0,
        relaxation: Prony | None = None,
        physics: Physics | None = None,
    ) -> None:
        self.layers, self.tool, self.hole_radius = tuple(layers), tool, checked_hole(tool, support, hole_radius)
        self.modes, self.integrator = checked_count(modes), integrator
        self.tension = checked_tension(tension, integrator)
        for name, value, unit in (("pretension", pretension, "N/m"), ("tool_mass", tool_mass, "kg")):
            if not 0.0 <= value < float("inf"):
                raise WaveError(f"{name} = {value:g} {unit} is not allowed: finite and not negative")
        if reach is not None:
            require_positive("reach", reach, "m")
        hole = self.hole_radius
        law = plate_law(self.layers, tool, sheet(self.layers, tool, hole, self.modes, pretension))
        self.unknowns: int = law.sheet.unknowns
        self._damping = damping or Damping()
        self._options, self._series = memory_of(relaxation, physics, integrator), relaxation
        self._moving = UniformTension(carrier(law.sheet, tool_mass), law.faces, law.dent)
        self._statics: Statics = self._moving
        if self.tension == "local":
            self._statics = PreparedLaw(law, REACH * hole if reach is None else reach)

    @property
    def window(self) -> float:
        """Diameter of the hole, m."""
        return 2.0 * self.hole_radius

    @property
    def first_frequency(self) -> float:
        """Lowest natural frequency of the sheet with the tool on it, at rest, Hz."""
        return self._moving.wave.first_frequency

    def force_of_depth(self, depth: FloatArray) -> FloatArray:
        """Press (n,) in N at depths (n,) in m, at rest; with the local tension splines between equilibria.

        Raises
        ------
        WaveError
            If the sheet has no equilibrium at the deepest.
        """
        return self._statics.rest("depth", np.asarray(depth, dtype=np.float64))[0]

    def depth_of_force(self, force: FloatArray) -> FloatArray:
        """Depth (n,) in m under presses (n,) in N; the inverse of `force_of_depth`.

        Raises
        ------
        WaveError
            If the sheet has no equilibrium at the largest.
        """
        return self._statics.rest("force", np.asarray(force, dtype=np.float64))[1]

    def field(self, depth: float, radii: FloatArray) -> FloatArray:
        """Outward and downward displacement of the layers' faces at rest.

        Parameters
        ----------
        depth
            Of the press, m.
        radii
            (m,) from the axis before the press, up to the hole's, m.

        Returns
        -------
        ndarray (2, L + 1, m)
            In m, the lowest face included.

        Raises
        ------
        WaveError
            If the sheet has no equilibrium at the depth.
        """
        return self._statics.field(depth, np.asarray(radii, dtype=np.float64))

    def run(self, control: str, time: FloatArray, value: FloatArray) -> PlateSolution:
        """Go through a load history.

        Parameters
        ----------
        control
            "force" or "depth" (of the top face on the axis, or of a rigid tool).
        time
            (n,) in s, rising; with inertia each step is as long as the history's.
        value
            (n,) in N or m, press positive.

        Raises
        ------
        WaveError
            If the history is not usable or the sheet has no equilibrium under it.
        """
        load = checked_load(control, time, value)
        history = self._history(load)
        return PlateSolution(
            time=load.time,
            force=history.force,
            depth=history.depth,
            layer_names=tuple(layer.name for layer in self.layers),
            top_deflection=history.axis,
            integrator=self.integrator,
            warnings=self._warnings(history),
            energy=history.energy,
            _hole=self.hole_radius,
            _faces=history.faces,
        )

    def _history(self, load: Load) -> PlateHistory:
        if self.integrator == "mid_point":
            return self._moving.move(load, self._damping)
        if self._options is not None:
            return options_run(load, self._statics, self._options, 0.1 * self.hole_radius)
        if self._series is not None:
            return fading_run(load, self._statics, self._series)
        return self._statics.run(load)

    def _warnings(self, history: PlateHistory) -> tuple[str, ...]:
        verified = VERIFIED["rigid" if self.tool.rigid else "pressure"]
        sizes = float(np.abs(history.depth).max()), sum(layer.thickness for layer in self.layers)
        return tuple(
            f"sheet over a hole: {what}, {size * 1e3:.3g} mm, is {100 * size / self.hole_radius:.3g} % of the hole's "
            f"radius, beyond the {100 * most:.0f} % up to which the model was verified"
            for what, size, most in zip(("the deepest press", "its thickness"), sizes, verified, strict=True)
            if size > most * self.hole_radius
        )


FUNCTIONS, FEWEST = 12, 4
TENSIONS = ("local", "uniform")
INTEGRATORS = ("quasi_static", "mid_point")


def checked_hole(tool: DiscTool, support: str, hole_radius: float | None) -> float:
    """The hole's radius, m, of a support and tool that the sheet covers.

    Raises
    ------
    NotCoveredError
        For another support, or a tool with friction.
    WaveError
        If the radius is missing, not positive, or not above the tool's.
    """
    if support in ("bonded", "half_space"):
        raise NotCoveredError(f"the sheet over a hole does not cover the support {support!r}; it covers 'hole'")
    if support != "hole":
        raise WaveError(f"support = {support!r} is not allowed: 'hole', 'bonded' or 'half_space'")
    if tool.contact == "rigid_frictional":
        raise NotCoveredError(
            "the sheet over a hole does not cover tool contact 'rigid_frictional': slip under friction is not "
            "followed; uniform_pressure, rigid_frictionless and rigid_bonded are covered"
        )
    if hole_radius is None:
        raise WaveError("hole_radius is missing: needed for the support 'hole'")
    require_positive("hole_radius", hole_radius, "m")
    if tool.radius >= hole_radius:
        raise WaveError(
            f"hole_radius = {hole_radius * 1e3:g} mm is not allowed with a tool of {tool.radius * 1e3:g} mm radius: "
            "it must be wider than the tool"
        )
    return hole_radius


def checked_count(modes: int | None) -> int:
    """Radial functions for each field.

    Raises
    ------
    WaveError
        If there are too few.
    """
    count = FUNCTIONS if modes is None else modes
    if count < FEWEST:
        raise WaveError(f"modes = {count} is not allowed: at least {FEWEST}")
    return count


def checked_tension(tension: str | None, integrator: str) -> str:
    """Word for the tension, "local" or "uniform", to go with the integrator.

    Raises
    ------
    WaveError
        If a word is unknown, or inertia is wanted with a local tension.
    """
    if integrator not in INTEGRATORS:
        raise WaveError(f"integrator = {integrator!r} is not allowed: one of {', '.join(INTEGRATORS)}")
    moving = integrator == "mid_point"
    chosen = ("uniform" if moving else "local") if tension is None else tension
    if chosen not in TENSIONS:
        raise WaveError(f"tension = {tension!r} is not allowed: one of {', '.join(TENSIONS)}")
    if moving and chosen == "local":
        raise WaveError("tension = 'local' is not allowed with the integrator 'mid_point': only 'uniform' is")
    return chosen
