"""Adhesion: the tissue holds the tool when it is lifted, until the pull is too much."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import BoolArray, FloatArray
from wavemodel.physics.course import require


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
        require("adhesion", "force", self.force, "N", 0.0, 1e3)

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
