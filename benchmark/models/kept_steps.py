"""The steps of a long FEM run kept on disk, so that the same run goes on from there after it was killed."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from pathlib import Path

import fem
from benchmark.models.keeping import Keeping
from fem.analysis.checkpoint import Checkpoint, Progress
from fem.analysis.prepared import Model

STEPS, STEPS_AT_EDGE, MESH = "fem_steps.kept", "fem_steps_edge_{:g}.kept", "fem_mesh.kept"
LEAST_PAUSE = 2.0
"""Wall s between two writings, and before the first: a run that is shorter keeps nothing."""
SHARE = 0.02
"""Of the time, the most that writing takes."""


def kept_steps(keeping: Keeping, model: Model, load: fem.Load, edge: float) -> KeptSteps:
    """The steps of a load history, in a file of its own for each size of the elements at the tool's edge."""
    path = keeping.folder / (STEPS if edge == 1.0 else STEPS_AT_EDGE.format(edge))
    return KeptSteps(model.checkpoint(load, path), len(load.time), keeping.say)


def kept_mesh(keeping: Keeping) -> Path:
    """The file of a mesh that is made once; its folder is made."""
    keeping.folder.mkdir(parents=True, exist_ok=True)
    return keeping.folder / MESH


class KeptSteps:
    """Keeps a run's steps now and then, and never stops it: what cannot be read or written is said and left.

    Parameters
    ----------
    checkpoint : Checkpoint
        The file.
    total : int
        Steps of the load history.
    say : callable
        Told in a sentence what was found, and what went wrong.
    """

    def __init__(self, checkpoint: Checkpoint, total: int, say: Callable[[str], None]):
        self._checkpoint, self._total, self._say = checkpoint, total, say
        self._due = time.monotonic() + LEAST_PAUSE

    def read(self) -> Progress | None:
        """The steps of an earlier run; None where there are none to go on from."""
        try:
            found = self._checkpoint.read()
        except fem.CheckpointError as error:
            self._say(f"the FEM starts afresh: {str(error).rpartition(';')[0]}")
            self._checkpoint.path.unlink(missing_ok=True)
            return None
        if found is not None:
            self._say(f"the FEM goes on after step {len(found.steps)} of {self._total}, kept by an unfinished run")
        return found

    def write(self, progress: Progress) -> None:
        """Keep the steps if it is time to."""
        started = time.monotonic()
        if started < self._due:
            return
        try:
            self._checkpoint.path.parent.mkdir(parents=True, exist_ok=True)
            self._checkpoint.write(progress)
        except (OSError, fem.CheckpointError) as error:
            self._say(f"the FEM's steps are not kept: {error}")
            self._due = math.inf
            return
        now = time.monotonic()
        self._due = now + max(LEAST_PAUSE, (now - started) / SHARE)
