"""Options of the surface under the tool: adhesion when it is lifted, dry friction, permanent set."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import BoolArray, FloatArray
from wavemodel.errors import require_between
from wavemodel.integrators.scan import DECAYED, decaying_sum
from wavemodel.physics.load_segment import LoadSegment, Memory


@dataclass(frozen=True)
class Adhesion:
    """Once touched, the surface follows the tool above its place, F = -f(|d|), until -F exceeds the pull-off force.

    The flat punch that lets go all at once (K. Kendall 1971, J Phys D 4:1186); after that there is no force until the
    tool touches again.

    Attributes
    ----------
    force
        Pull-off force in N, 0 to 1e3; zero: off.
    """

    force: float = 0.0

    def __post_init__(self) -> None:
        require_between("adhesion", "force", self.force, "N", 0.0, 1e3)

    def touching(self, depth: FloatArray, pull: FloatArray, held: bool) -> BoolArray:
        """(n,) whether tool and tissue are in contact.

        Parameters
        ----------
        depth
            (n,) below the surface, m.
        pull
            (n,) force with which the surface resists being pulled so far, N; counts where the depth is negative.
        held
            Whether they were in contact before the first sample.
        """
        pressed = depth >= 0.0
        loose = ~pressed & (pull > self.force)
        decided = np.where(pressed, 1, np.where(loose, -1, 0))
        at = np.maximum.accumulate(np.where(decided != 0, np.arange(depth.size), -1))
        last = np.where(at >= 0, decided[at], 1 if held else -1)
        return np.asarray(last > 0)


@dataclass(frozen=True)
class DryFriction:
    """F = f + z, dz/dd = (F_c sign(d') - z) / length * sign(d'): Dahl's model, solved exactly between samples.

    From rest z rises over the length to F_c = force + coefficient f and swings between -F_c and +F_c; a wide cycle
    loses 2 F_c a unit of depth. As the length goes to zero it is Coulomb's friction. It ends with the contact.
    (P. R. Dahl 1968, A solid friction model, TOR-0158(3107-18)-1.)

    Attributes
    ----------
    force
        Part of F_c that does not depend on the press, N, 0 to 1e3; zero, with a zero coefficient: off.
    length
        Over which friction builds up, m, 1e-9 to 1.
    coefficient
        Of the elastic force, 0 to 10.
    """

    force: float
    length: float
    coefficient: float = 0.0

    def __post_init__(self) -> None:
        require_between("dry friction", "force", self.force, "N", 0.0, 1e3)
        require_between("dry friction", "length", self.length, "m", 1e-9, 1.0)
        require_between("dry friction", "coefficient", self.coefficient, "", 0.0, 10.0)

    def act(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) friction that acts beside the elastic force of the segment."""
        depth = np.where(segment.touching, segment.depth, 0.0)
        last, start = memory or (float(depth[0]) if segment.endless else 0.0, 0.0)
        moved = np.diff(depth, prepend=last)
        left = np.diff(segment.touching, prepend=True) & ~segment.touching
        way = np.where(left, DECAYED, np.where(segment.touching, np.abs(moved) / self.length, 0.0))
        limit = np.where(segment.touching, self.force + self.coefficient * np.abs(segment.force), 0.0)
        friction = decaying_sum(way, -np.expm1(-way) * np.sign(moved) * limit, start)
        friction = np.where(segment.touching, friction, 0.0)
        return friction, (float(depth[-1]), float(friction[-1]))


@dataclass(frozen=True)
class PermanentSet:
    """Below the deepest depth d_m so far the surface stands at s = fraction max(d_m - onset, 0).

    What the tool meets is d_c = (d - s) d_m / (d_m - s): the first loading is the base law, unloading starts from its
    peak and ends at s, and reloading follows it back (elastic unloading of an elastic-plastic body, with the recovery
    of W. C. Oliver and G. M. Pharr 1992, J Mater Res 7:1564, scaled instead of shifted).

    Attributes
    ----------
    fraction
        0 to 0.95; zero: off.
    onset
        Depth that leaves no set, m, 0 to 10.
    """

    fraction: float
    onset: float = 0.0

    def __post_init__(self) -> None:
        require_between("permanent set", "fraction", self.fraction, "", 0.0, 0.95)
        require_between("permanent set", "onset", self.onset, "m", 0.0, 10.0)

    def meet(self, depth: FloatArray, memory: Memory) -> tuple[FloatArray, FloatArray, Memory]:
        """Depth below the surface (n,) that the tool (n,) meets, the surface (n,), m, and the memory."""
        deepest = np.maximum.accumulate(np.maximum(depth, memory[0] if memory else 0.0))
        surface = self.fraction * np.maximum(deepest - self.onset, 0.0)
        scale = np.divide(deepest, deepest - surface, out=np.ones_like(depth), where=deepest > 0.0)
        return (depth - surface) * scale, surface, (float(deepest[-1]),)
