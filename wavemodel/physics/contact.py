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
    """A surface that does not come back: the deepest depth d_m so far leaves s = fraction max(d_m - onset, 0).

    Without a delay s is there at once, and what the tool meets is d_c = (d - s) d_m / (d_m - s): the first loading is
    the base law, unloading starts from its peak and ends at s, and reloading follows it back (elastic unloading of an
    elastic-plastic body, with the recovery of W. C. Oliver and G. M. Pharr 1992, J Mater Res 7:1564, scaled instead of
    shifted). With a delay the base law is that of a press too fast to leave a set, the surface sinks to s as
    s' = (fraction max(d_m - onset, 0) - s) / delay while the tool stands below the untouched surface, and
    d_c = d - s: creep that is not recovered (W. N. Findley, J. S. Lai and K. Onaran 1976, Creep and Relaxation of
    Nonlinear Viscoelastic Materials, chapter 1), so that the force falls in a hold, too.

    Attributes
    ----------
    fraction
        0 to 0.95; zero: off.
    onset
        Depth that leaves no set, m, 0 to 10.
    delay
        With which the surface sinks, s, 0 to 1e6; zero: at once.
    """

    fraction: float
    onset: float = 0.0
    delay: float = 0.0

    def __post_init__(self) -> None:
        require_between("permanent set", "fraction", self.fraction, "", 0.0, 0.95)
        require_between("permanent set", "onset", self.onset, "m", 0.0, 10.0)
        require_between("permanent set", "delay", self.delay, "s", 0.0, 1e6)

    def meet(self, duration: FloatArray, depth: FloatArray, memory: Memory) -> tuple[FloatArray, FloatArray, Memory]:
        """Depth below the surface (n,) that the tool meets, the surface (n,), m, and the memory.

        Parameters
        ----------
        duration
            (n,) of the steps that end at the samples, s; the first is zero where the body has been so for ever.
        depth
            (n,) of the tool, m.
        memory
            Deepest depth and surface before the first sample, m; empty at rest.
        """
        if self.fraction == 0.0:
            return depth, np.zeros_like(depth), memory
        before, stood = memory or (0.0, 0.0)
        deepest = np.maximum.accumulate(np.maximum(depth, before))
        surface = self.fraction * np.maximum(deepest - self.onset, 0.0)
        if self.delay > 0.0:
            start = self.fraction * max(before - self.onset, 0.0)
            surface = self._sunk(duration, depth, surface, (start, stood))
            return depth - surface, surface, (float(deepest[-1]), float(surface[-1]))
        scale = np.divide(deepest, deepest - surface, out=np.ones_like(depth), where=deepest > 0.0)
        return (depth - surface) * scale, surface, (float(deepest[-1]), float(surface[-1]))

    def _sunk(self, duration: FloatArray, depth: FloatArray, end: FloatArray, start: tuple[float, float]) -> FloatArray:
        """Surface (n,) that sinks to `end` (n,), which is taken as linear in a step, from its (end, surface) before."""
        first_end, stood = start
        way = np.where(depth > 0.0, duration / self.delay, 0.0)
        if duration[0] == 0.0:
            way[0], first_end = DECAYED, float(end[0])
        moved = np.diff(end, prepend=first_end)
        lag = np.divide(-np.expm1(-way), way, out=np.ones_like(way), where=way > 0.0)
        kept = np.exp(-np.minimum(way, DECAYED))
        gain = end - kept * (end - moved) - lag * moved
        return np.asarray(decaying_sum(way, gain, stood))
