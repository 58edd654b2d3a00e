"""The window of a press: its domain and modes, chosen or following the tool and the stack, and their share of the load.

A window with zero border equals the endless specimen under loads of alternating sign at every multiple of its side
a, so what its border costs is read off the endless response g: near the border at most g(a/2), on the axis 4 g(a).

The load's smooth part, a share s(k) of its transform, is carried by the modes; the sharp rest, 1 - s(k), that no mode
of the window resolves, acts only close to the tool and is answered statically (`remainder`). s falls from one to zero
below the largest wavenumber of the modes, smoothly, so that the rest stays local.
"""

from dataclasses import dataclass
from math import hypot, isfinite

import numpy as np
from scipy.special import erfc

from wavemodel.arrays import FloatArray
from wavemodel.domains.disc import Disc
from wavemodel.domains.domain import WaveDomain, endless
from wavemodel.domains.rectangle import Rectangle
from wavemodel.errors import WaveError, require_positive
from wavemodel.layered.stack.compliance import compliance, exact_faces
from wavemodel.layered.stack.laminate import Laminate
from wavemodel.layered.tractions import uniform_pressure

CENTRE, WIDTH = 0.65, 0.14
LOCAL = 4.5
"""The remainder has decayed (by exp(-LOCAL^2 / 4), to below 1 %) LOCAL / (WIDTH limit) away from the tool."""
DOMAINS = ("rectangle", "disc")
FEWEST_FOR_CORRECTION = 8
"""With fewer modes the smooth part of a load, which the modes carry, would be next to nothing."""
BORDER_COST = 0.001
"""Of the peak, wherever the profile is printed; the contract is 0.005."""
PROFILE_RADII = 4.25
"""The window reaches at least this many tool radii to each side: the profile needs four."""
RESOLUTION = 12.0
"""Largest wavenumber of the modes times the tool's radius."""
FEWEST_MODES, MOST_MODES = 24, 512
MOST_GIVEN = 4096
"""With 2048 a stack of two layers takes 0.2 GB, four times as much with twice as many."""
REACH, SAMPLES = 8.0, 161
"""The far field is looked at over so many heights of the stack, at so many distances."""


@dataclass(frozen=True)
class Taper:
    """Share of the modes.

    Attributes
    ----------
    limit
        Largest wavenumber carried by the modes along an axis, rad/m.
    active
        Where not, the modes carry all and there is no remainder.
    """

    limit: float
    active: bool = True

    def modes(self, wavenumber: FloatArray) -> FloatArray:
        """s(k), (n,) to (n,)."""
        if not self.active:
            return np.ones_like(wavenumber)
        share: FloatArray = 0.5 * erfc((wavenumber / self.limit - CENTRE) / WIDTH)
        return share

    def remainder(self, wavenumber: FloatArray) -> FloatArray:
        """1 - s(k), without loss of digits where it is small."""
        share: FloatArray = 0.5 * erfc((CENTRE - wavenumber / self.limit) / WIDTH)
        return share

    @property
    def locality(self) -> float:
        """How far beyond the tool's edge the remainder reaches, m."""
        return LOCAL / (WIDTH * self.limit)


@dataclass(frozen=True)
class WaveDiscretisation:
    """Window, modes and sub-layers of a layered wave; what is None is found automatically.

    Attributes
    ----------
    window
        Side of the square window, or diameter of the round one, m. None: so wide that the border costs at most 0.1 % of
        the peak in it.
    modes
        N, for m, n = 1..N, or N along a radius of the disc. None: as many as carry the smooth part of the load, k a up
        to 12.
    domain
        "rectangle" with sines, or "disc" with Bessel modes: N of them for a tool in its middle, all directions for one
        off it.
    place
        (x, y) of the tool from the middle of the window, m. Off the middle even modes take part too.
    sublayers
        Number of equal sub-layers in each layer. None: as many as it takes for 0.05 % of each layer's peak.
    static_correction
        Whether what the modes leave out of the load is answered statically (see `wavemodel.layered.remainder`).
        None: from 8 modes up.

    Raises
    ------
    WaveError
        If the domain is unknown, the window is not positive, a count is below one, or there are too few modes for the
        correction, or more than `MOST_GIVEN`.
    """

    window: float | None = None
    modes: int | None = None
    domain: str = "rectangle"
    place: tuple[float, float] = (0.0, 0.0)
    sublayers: tuple[int, ...] | None = None
    static_correction: bool | None = None

    def __post_init__(self) -> None:
        if self.sublayers is not None:
            object.__setattr__(self, "sublayers", tuple(self.sublayers))
        if self.domain not in DOMAINS:
            raise WaveError(f"domain = {self.domain!r} is not allowed: one of {', '.join(DOMAINS)}")
        if self.window is not None:
            require_positive("window", self.window, "m")
        if len(self.place) != 2 or not all(map(isfinite, self.place)):
            raise WaveError(f"place = {self.place} is not allowed: two finite lengths x and y, in m")
        if self.modes is not None and self.modes < 1:
            raise WaveError(f"modes = {self.modes} is not allowed: at least 1")
        if self.modes is not None and self.modes > MOST_GIVEN:
            raise WaveError(f"modes = {self.modes} is not allowed: at most {MOST_GIVEN}, or memory runs out")
        if self.sublayers is not None and any(count < 1 for count in self.sublayers):
            raise WaveError(f"sublayers = {self.sublayers} is not allowed: at least 1 in each layer")
        if self.static_correction and self.modes is not None and self.modes < FEWEST_FOR_CORRECTION:
            raise WaveError(
                f"modes = {self.modes} is not allowed with the static correction: at least {FEWEST_FOR_CORRECTION}"
            )

    @property
    def corrected(self) -> bool:
        """Whether the static correction is on."""
        if self.static_correction is None:
            return self.modes is None or self.modes >= FEWEST_FOR_CORRECTION
        return self.static_correction


def window_of(
    chosen: WaveDiscretisation, radius: float, width: float, *, directed: bool = False
) -> tuple[WaveDomain, Taper]:
    """Lay a window round a tool.

    Parameters
    ----------
    chosen
        Domain, place and modes.
    radius
        Of the tool, m.
    width
        Side of the square, or diameter of the disc, m.
    directed
        Whether modes of one wavenumber but of different directions count as different.

    Returns
    -------
    tuple
        The domain, and how the load is shared between its modes and the remainder.

    Raises
    ------
    WaveError
        If the tool does not fit.
    """
    _require_room(chosen, radius, width)
    round_window = chosen.domain == "disc"
    span = 0.5 * width if round_window else width
    count = enough_modes(span, radius) if chosen.modes is None else chosen.modes
    taper = Taper(count * np.pi / span, chosen.corrected)
    if round_window:
        return Disc(span, count, chosen.place), taper
    cutoff = taper.limit if taper.active else np.inf
    return Rectangle(width, width, count, cutoff=cutoff, directed=directed, place=chosen.place), taper


def _require_room(chosen: WaveDiscretisation, radius: float, width: float) -> None:
    if radius >= 0.5 * width:
        raise WaveError(
            f"window = {width * 1e3:g} mm is not allowed with a tool of {radius * 1e3:g} mm radius: "
            "it must be wider than the tool"
        )
    furthest = hypot(*chosen.place) if chosen.domain == "disc" else max(map(abs, chosen.place))
    if furthest + radius > 0.5 * width:
        raise WaveError(
            f"place = {furthest * 1e3:g} mm from the middle is not allowed: the tool of {radius * 1e3:g} mm "
            f"radius must be inside the window of {width * 1e3:g} mm"
        )


def far_field(laminate: Laminate, radius: float, distance: FloatArray) -> FloatArray:
    """(L, R) deflection over each layer's peak at distances (R,) from the axis, for the endless specimen."""
    spectrum = endless(RESOLUTION / radius, float(distance[-1]) + radius)
    load = uniform_pressure(radius).transform(spectrum.wavenumber)
    answer = compliance(spectrum.wavenumber, laminate, exact_faces).respond(load)[..., 1].T
    answer = answer * np.exp(-((spectrum.wavenumber * radius / (0.5 * RESOLUTION)) ** 4))
    field = spectrum.at_radius(answer, np.concatenate([[0.0], distance]))
    relative: FloatArray = field[:, 1:] / field[:, :1]
    return relative


def automatic_window(laminate: Laminate, radius: float) -> float:
    """Side of the square window, m: the border costs at most `BORDER_COST` of the peak anywhere in it."""
    nearest = PROFILE_RADII * radius
    distance = np.linspace(nearest, nearest + REACH * laminate.height, SAMPLES)
    field = np.abs(far_field(laminate, radius, distance)).max(axis=0)
    at_border = _settled_below(BORDER_COST, distance, field)
    on_axis = 0.5 * _settled_below(BORDER_COST / 4.0, distance, field)
    return 2.0 * max(at_border, on_axis)


def border_cost(laminate: Laminate, radius: float, side: float) -> float:
    """What the border of a window (m) costs at most in it, over a layer's peak."""
    distance = np.linspace(0.5 * side, 0.5 * side + REACH * laminate.height, SAMPLES)
    field = np.abs(far_field(laminate, radius, distance)).max(axis=0)
    return float(max(field.max(), 4.0 * field[distance >= side].max(initial=0.0)))


def _settled_below(level: float, distance: FloatArray, field: FloatArray) -> float:
    """First distance from which on the field stays below the level."""
    above = np.flatnonzero(field > level)
    return float(distance[min(above[-1] + 1, distance.size - 1)] if above.size else distance[0])


def enough_modes(side: float, radius: float) -> int:
    """N for a window (m) and a tool (m): the load's smooth part, up to k a = 12, fits below the cut-off."""
    return int(np.clip(np.ceil(RESOLUTION * side / (np.pi * radius)), FEWEST_MODES, MOST_MODES))
