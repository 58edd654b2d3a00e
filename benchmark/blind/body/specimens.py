"""The specimens that blind sessions press, as their files tell of them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

HOLE_RADIUS = 30e-3
MODULUS_ERROR, THICKNESS_ERROR = 0.25, 0.04
"""Standard deviations of what a laboratory knows of a layer, as shares; the modulus by its logarithm."""


@dataclass(frozen=True)
class ToldLayer:
    """A layer: m, kg/m3, Pa."""

    name: str
    thickness: float
    density: float
    youngs_modulus: float
    poisson_ratio: float


@dataclass(frozen=True)
class ToldSpecimen:
    """What the session file says of specimen and tool.

    Attributes
    ----------
    name : str
    layers : tuple of ToldLayer
        From the surface down.
    support : str
        "hole" (of `HOLE_RADIUS`; its lower face carries markers) or "bonded" (no markers).
    tool_radius : float
        m.
    """

    name: str
    layers: tuple[ToldLayer, ...]
    support: str
    tool_radius: float

    @property
    def has_markers(self) -> bool:
        """Whether a camera sees its lower face."""
        return self.support == "hole"


def _sheet(name: str, thickness: float, youngs_modulus: float, tool_radius: float) -> ToldSpecimen:
    return ToldSpecimen(name, (ToldLayer("silicone", thickness, 1100.0, youngs_modulus, 0.49),), "hole", tool_radius)


def _skin(name: str, dermis: float, fat: float, tool_radius: float) -> ToldSpecimen:
    layers = (
        ToldLayer("epidermis", 0.1e-3, 1150.0, 1.5e6, 0.48),
        ToldLayer("dermis", 1.5e-3, 1116.0, dermis, 0.48),
        ToldLayer("fat", 10e-3, 971.0, fat, 0.48),
    )
    return ToldSpecimen(name, layers, "bonded", tool_radius)


SHEETS = (
    _sheet("sheet_soft", 4.0e-3, 180e3, 5.0e-3),
    _sheet("sheet_thick", 5.0e-3, 250e3, 6.0e-3),
    _sheet("sheet_thin", 3.5e-3, 400e3, 4.5e-3),
)
SKINS = (_skin("skin_stiff", 0.8e6, 50e3, 5.0e-3), _skin("skin_soft", 0.3e6, 25e3, 4.0e-3))
SECOND_SHEETS = (_sheet("film", 3.0e-3, 300e3, 4.0e-3), _sheet("pad", 6.0e-3, 120e3, 7.0e-3))
SECOND_SKINS = (
    ToldSpecimen(
        "two_layers",
        (ToldLayer("dermis", 2.0e-3, 1116.0, 0.4e6, 0.48), ToldLayer("fat", 9e-3, 971.0, 40e3, 0.48)),
        "bonded",
        4.5e-3,
    ),
)
SPECIMENS = {"first": (SHEETS, SKINS), "second": (SECOND_SHEETS, SECOND_SKINS)}
"""Of each family: those with markers, and those without."""


def misjudged(
    specimen: ToldSpecimen,
    rng: np.random.Generator,
    modulus_error: float = MODULUS_ERROR,
    thickness_error: float = THICKNESS_ERROR,
) -> ToldSpecimen:
    """The specimen as a laboratory tells it: each layer's modulus and thickness off by these standard deviations."""
    layers = tuple(
        replace(
            layer,
            youngs_modulus=layer.youngs_modulus * float(np.exp(modulus_error * rng.normal())),
            thickness=layer.thickness * float(1.0 + thickness_error * rng.normal()),
        )
        for layer in specimen.layers
    )
    return replace(specimen, layers=layers)
