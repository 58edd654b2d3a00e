"""Strain stiffening: the force grows faster with depth than the base law."""

from dataclasses import dataclass

from wavemodel.arrays import FloatArray
from wavemodel.physics.course import Course, Memory, require


@dataclass(frozen=True)
class StrainStiffening:
    """F = f(d) (1 + b_1 x + b_2 x^2), x = |d| / length.

    The first terms of any smooth hyperelastic law; on a bonded base it fits a neo-Hookean body to 0.02 % with the
    height of the stack as the length (Hayes et al. 1972, J Biomech 5:541 for the linear law that is corrected).

    Attributes
    ----------
    linear, quadratic
        b_1 and b_2, 0 to 1e4; both zero: off.
    length
        In m, 1e-6 to 10.
    """

    linear: float = 0.0
    quadratic: float = 0.0
    length: float = 1e-2

    def __post_init__(self) -> None:
        require("strain stiffening", "linear", self.linear, "", 0.0, 1e4)
        require("strain stiffening", "quadratic", self.quadratic, "", 0.0, 1e4)
        require("strain stiffening", "length", self.length, "m", 1e-6, 10.0)

    def act(self, course: Course, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        x = abs(course.depth) / self.length
        return course.force * (1.0 + x * (self.linear + self.quadratic * x)), memory
