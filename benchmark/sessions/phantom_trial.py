"""One trial of the phantom session as it was put in."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class TrueTrial:
    """What is drawn for one trial: stiffness over the sheet's, contact (m), tool axis on the grid (m), seed."""

    name: str
    condition: str
    protocol: str
    gain: float
    contact: float
    axis: tuple[float, float]
    seed: int
    film: bool
