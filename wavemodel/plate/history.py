"""What a sheet over a hole does under a load history, whichever way its tension is worked out."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from wavemodel.arrays import FloatArray
from wavemodel.integrators.load import Load


@dataclass(frozen=True)
class PlateHistory:
    """A run over n steps.

    Attributes
    ----------
    force, depth
        (n,) in N and m.
    axis
        (n, L) deflection of each layer's top face on the axis, m.
    energy
        (n,) in J, kinetic energy included; None where it is not followed.
    faces
        Step and radii (m,), up to the hole's, to (2, L + 1, m): outward and downward displacement of the faces, m.
    """

    force: FloatArray
    depth: FloatArray
    axis: FloatArray
    energy: FloatArray | None
    faces: Callable[[int, FloatArray], FloatArray]


class Statics(Protocol):
    """A sheet at rest under a press."""

    def rest(self, control: str, value: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Force (n,) in N and depth (n,) in m where one of them, "force" or "depth", is given."""
        ...

    def field(self, depth: float, radii: FloatArray) -> FloatArray:
        """(2, L + 1, m): outward and downward displacement of the faces at radii (m,), m."""
        ...

    def run(self, load: Load) -> PlateHistory:
        """Equilibria at the instants of a load history."""
        ...
