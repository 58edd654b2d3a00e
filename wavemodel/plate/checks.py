"""What the sheet over a hole accepts."""

from wavemodel.errors import NotCoveredError, WaveError, require_positive
from wavemodel.specimen import DiscTool

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
