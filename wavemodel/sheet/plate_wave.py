"""The wave of a sheet over a hole: a disc pressed on layers that are clamped round a hole and hang free over it.

Large deflections stretch the sheet, and its tension carries most of the load. Under a pressure or a bonded tool the
sheet is the layered wave's: each layer with its own strain through the thickness, in modes over the radius
(`wavemodel.sheet.layered`); nothing in it is calibrated. What that does not cover, a tool without friction or a
pretension, is the plate theory's (`tension = "local"`), in which three numbers of a bonded tool's edge (`EdgeLaw`) are
calibrated. The clamp holds the sheet's lower face outside the hole, or its whole border at the rim: how far the sheet
gives way behind an edge is worked out, so there is no effective radius to choose.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError, WaveError, require_not_negative, require_positive
from wavemodel.integrators.load_history import Load, checked_load
from wavemodel.integrators.viscoelastic import Damping, Prony
from wavemodel.physics.quasi_static_press import Physics
from wavemodel.sheet.carrier import carrier
from wavemodel.sheet.faces import Faces, faces_of
from wavemodel.sheet.force_depth import LocalTension, PlateBody, SheetBody
from wavemodel.sheet.layered.layered_sheet import layered_sheet
from wavemodel.sheet.layered.sheet_equilibrium import SheetEquilibrium
from wavemodel.sheet.sheet import sheet
from wavemodel.sheet.sheet_runs import SheetFaces, SheetHistory, Statics, options_run, relaxing_run, with_relaxation
from wavemodel.sheet.uniform_tension import UniformTension
from wavemodel.solution import WaveSolution
from wavemodel.specimen import DiscTool, WaveLayer

REACH = 0.4
"""Depth over the hole's radius up to which the set-up goes; a deeper press extends it."""
VERIFIED = {"layered": (0.5, 0.67), "rigid": (0.5, 0.2), "pressure": (0.3, 0.14)}
"""Depth, and thickness of the sheet, over the hole's radius up to which the model was compared with finite elements
(docs/wavemodel.md): the layered one within 1 %, the plate theory within 2.2 %; twice as thick it is up to 22 % off."""
FUNCTIONS, FEWEST = 12, 4
TENSIONS = ("layered", "local", "uniform")
CLAMPS = ("plate", "rim")
LAYERED = ("uniform_pressure", "rigid_bonded")
"""Contacts that the layered sheet covers."""
INTEGRATORS = ("quasi_static", "mid_point")


@dataclass(frozen=True)
class PlateSettings:
    """How a sheet over a hole is worked out; what is None is chosen.

    Attributes
    ----------
    modes
        Of the plate theory: radial functions for each of u, w and the rotation. None: 12, right to 1e-4.
    reach
        Depth up to which the set-up finds equilibria, m. None: 0.4 of the hole's radius. A run that goes beyond it
        extends the set-up.
    tension
        "layered": the layered sheet's own, at any strain, neo-Hookean. "local": the same by the plate theory.
        "uniform": Kirchhoff's and Carrier's, the same everywhere, Hookean. None: "layered" under a pressure or a bonded
        tool without pretension, else "local"; "uniform" with the integrator "mid_point".
    integrator
        "quasi_static" (without inertia) or "mid_point" (with it, energy kept; a uniform tension only).
    damping
        With inertia: proportional to mass and stiffness.
    tool_mass
        With inertia: of a rigid tool, kg.

    Raises
    ------
    WaveError
        For a word that is unknown, a value outside its range, too few functions, or inertia with another tension than
        the uniform one.
    """

    modes: int | None = None
    reach: float | None = None
    tension: str | None = None
    integrator: str = "quasi_static"
    damping: Damping = Damping()  # noqa: RUF009 (frozen)
    tool_mass: float = 0.0

    def __post_init__(self) -> None:
        if self.functions < FEWEST:
            raise WaveError(f"modes = {self.modes} is not allowed: at least {FEWEST}")
        if self.integrator not in INTEGRATORS:
            raise WaveError(f"integrator = {self.integrator!r} is not allowed: one of {', '.join(INTEGRATORS)}")
        if self.tension is not None and self.tension not in TENSIONS:
            raise WaveError(f"tension = {self.tension!r} is not allowed: one of {', '.join(TENSIONS)}")
        if self.moving and self.tension not in (None, "uniform"):
            raise WaveError(f"tension = {self.tension!r} is not allowed with inertia: only 'uniform' is")
        require_not_negative("tool_mass", self.tool_mass, "kg")
        if self.reach is not None:
            require_positive("reach", self.reach, "m")

    @property
    def functions(self) -> int:
        """Radial functions for each field."""
        return FUNCTIONS if self.modes is None else self.modes

    @property
    def moving(self) -> bool:
        """Whether inertia counts."""
        return self.integrator == "mid_point"

    @property
    def uniform(self) -> bool:
        """Whether the tension is the same everywhere."""
        return self.moving or self.tension == "uniform"


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
    settings
        How it is worked out.
    pretension
        Of the sheet before the press, N/m, equal in all directions.
    relaxation
        Prony series of the whole sheet, without inertia; E is then the initial modulus. None: elastic.
    physics
        Options of the body beyond elasticity, without inertia; all off by default (see `Physics`).
    clamp
        "plate": the lower face is held outside the hole; "rim": the sheet ends at the hole, where its whole border is
        held (the layered sheet only).

    Raises
    ------
    NotCoveredError
        For a support, contact or clamp that the model does not describe.
    WaveError
        For a value outside its range.
    """

    def __init__(
        self,
        layers: Sequence[WaveLayer],
        tool: DiscTool,
        support: str = "hole",
        hole_radius: float | None = None,
        settings: PlateSettings = PlateSettings(),
        *,
        pretension: float = 0.0,
        relaxation: Prony | None = None,
        physics: Physics | None = None,
        clamp: str = "plate",
    ) -> None:
        self.layers, self.tool, self.hole_radius = tuple(layers), tool, _checked_hole(tool, support, hole_radius)
        require_not_negative("pretension", pretension, "N/m")
        self.settings, self.pretension, hole = settings, pretension, self.hole_radius
        self.tension = _tension_of(settings, tool, clamp, pretension)
        self._options, self._series = with_relaxation(physics, relaxation, settings.integrator), relaxation
        body: SheetBody
        if self.tension == "layered":
            layered = layered_sheet(self.layers, tool, hole, clamp)
            body, self._modes = SheetEquilibrium(layered), layered.place.modes.count
        else:
            body, self._modes = PlateBody(self._faces), settings.functions
        self.unknowns: int = body.unknowns
        reach = REACH * hole if settings.reach is None else settings.reach
        self._statics: Statics = self._moving if self.tension == "uniform" else LocalTension(body, reach, self._name)

    @property
    def _name(self) -> str:
        """The sheet with what it is given by, for messages."""
        total, hole = (1e3 * size for size in (sum(layer.thickness for layer in self.layers), self.hole_radius))
        return f"a sheet with a thickness of {total:.4g} mm over a hole (hole_radius) of {hole:.4g} mm"

    @cached_property
    def _faces(self) -> Faces:
        """Of the plate theory's sheet at rest."""
        at_rest = sheet(self.layers, self.tool, self.hole_radius, self.settings.functions, self.pretension)
        return faces_of(self.layers, self.tool, at_rest)

    @cached_property
    def _moving(self) -> UniformTension:
        return UniformTension(carrier(self._faces.sheet, self.settings.tool_mass), self._faces)

    @property
    def modes(self) -> int:
        """Modes over the radius, or by the plate theory functions for each of u, w and the rotation."""
        return self._modes

    @property
    def window(self) -> float:
        """Diameter of the hole, m."""
        return 2.0 * self.hole_radius

    @property
    def first_frequency(self) -> float:
        """Lowest natural frequency of the sheet with the tool on it, at rest, Hz, by the plate theory on a plate."""
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

    def run(self, control: str, time: FloatArray, value: FloatArray) -> WaveSolution[SheetFaces]:
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
        return WaveSolution(
            time=load.time,
            force=history.force,
            depth=history.depth,
            layer_names=tuple(layer.name for layer in self.layers),
            top_deflection=history.axis,
            integrator=self.settings.integrator,
            warnings=self._warnings(history),
            faces=SheetFaces(self.hole_radius, history.faces),
            energy=history.energy,
        )

    def _history(self, load: Load) -> SheetHistory:
        if self.settings.moving:
            return self._moving.move(load, self.settings.damping)
        if self._options is not None:
            return options_run(load, self._statics, self._options, 0.1 * self.hole_radius)
        if self._series is not None:
            return relaxing_run(load, self._statics, self._series, self.tool.sticks)
        return self._statics.run(load)

    def _warnings(self, history: SheetHistory) -> tuple[str, ...]:
        by_plate = "rigid" if self.tool.rigid else "pressure"
        verified = VERIFIED["layered" if self.tension == "layered" else by_plate]
        sizes = float(np.abs(history.depth).max()), sum(layer.thickness for layer in self.layers)
        return tuple(
            f"sheet over a hole: {what}, {size * 1e3:.3g} mm, is {100 * size / self.hole_radius:.3g} % of the hole's "
            f"radius, beyond the {100 * most:.0f} % up to which the model was verified"
            for what, size, most in zip(("the deepest press", "its thickness"), sizes, verified, strict=True)
            if size > most * self.hole_radius
        )


def _tension_of(settings: PlateSettings, tool: DiscTool, clamp: str, pretension: float) -> str:
    """The tension that is followed.

    Raises
    ------
    WaveError
        If the clamp is neither word.
    NotCoveredError
        If it does not cover the tool, the pretension or the clamp.
    """
    if clamp not in CLAMPS:
        raise WaveError(f"clamp = {clamp!r} is not allowed: one of {', '.join(CLAMPS)}")
    covered = tool.contact in LAYERED and pretension == 0.0
    chosen = "uniform" if settings.uniform else settings.tension or ("layered" if covered else "local")
    if chosen == "layered" and not covered:
        raise NotCoveredError(
            f"the layered sheet over a hole does not cover tool contact {tool.contact!r} with a pretension of "
            f"{pretension:g} N/m: {' and '.join(LAYERED)} without pretension are covered"
        )
    if clamp == "rim" and chosen != "layered":
        raise NotCoveredError(
            "the plate theory of a sheet over a hole does not cover a clamp at the rim; the layered sheet does, under "
            f"{' or '.join(LAYERED)}, without inertia or pretension"
        )
    return chosen


def _checked_hole(tool: DiscTool, support: str, hole_radius: float | None) -> float:
    """The hole's radius, m, of a support and tool that the sheet covers."""
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
