"""The window of a press: which domain, how many modes, and whether the tool fits."""

from math import hypot

import numpy as np

from wavemodel.automatic import enough_modes
from wavemodel.domains.disc import Disc
from wavemodel.domains.domain import Domain
from wavemodel.domains.rectangle import Rectangle
from wavemodel.errors import WaveError
from wavemodel.settings import Settings
from wavemodel.taper import Taper


def window_of(settings: Settings, radius: float, width: float) -> tuple[Domain, Taper]:
    """Lay a window round a tool.

    Parameters
    ----------
    settings
        Domain, place and modes.
    radius
        Of the tool, m.
    width
        Side of the square, or diameter of the disc, m.

    Returns
    -------
    tuple
        The domain, and how the load is shared between its modes and the remainder.

    Raises
    ------
    WaveError
        If the tool does not fit.
    """
    _require_room(settings, radius, width)
    return (_disc if settings.domain == "disc" else _rectangle)(settings, radius, width)


def _rectangle(settings: Settings, radius: float, width: float) -> tuple[Domain, Taper]:
    count = enough_modes(width, radius) if settings.modes is None else settings.modes
    taper = Taper(count * np.pi / width, settings.corrected)
    directed = settings.pretension is not None and settings.pretension.directed
    cutoff = taper.limit if taper.active else np.inf
    return Rectangle(width, width, count, cutoff=cutoff, directed=directed, place=settings.place), taper


def _disc(settings: Settings, radius: float, width: float) -> tuple[Domain, Taper]:
    border = 0.5 * width
    count = enough_modes(border, radius) if settings.modes is None else settings.modes
    return Disc(border, count, settings.place), Taper(count * np.pi / border, settings.corrected)


def _require_room(settings: Settings, radius: float, width: float) -> None:
    if radius >= 0.5 * width:
        raise WaveError(
            f"window = {width * 1e3:g} mm is not allowed with a tool of {radius * 1e3:g} mm radius: "
            "it must be wider than the tool"
        )
    furthest = hypot(*settings.place) if settings.domain == "disc" else max(map(abs, settings.place))
    if furthest + radius > 0.5 * width:
        raise WaveError(
            f"place = {furthest * 1e3:g} mm from the middle is not allowed: the tool of {radius * 1e3:g} mm "
            f"radius must be inside the window of {width * 1e3:g} mm"
        )
