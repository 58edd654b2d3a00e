"""Results of a run as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fem.arrays import FloatArray
from fem.errors import FemError

if TYPE_CHECKING:
    from fem.mesh.solid import AnyMesh
    from fem.results.fields import FieldRecovery, Fields


@dataclass(frozen=True)
class StepReport:
    """Told to the callback after each accepted load step.

    Attributes
    ----------
    step, total
        Number of the step, from 1, and how many there are.
    time
        In s.
    force
        Press in N.
    depth
        Deflection of the top face on the axis (of the tool if rigid) in m.
    newton_iterations
        Newton corrections in this step.
    cuts
        How often the step had to be halved.
    """

    step: int
    total: int
    time: float
    force: float
    depth: float
    newton_iterations: int
    cuts: int


@dataclass(frozen=True)
class Failure:
    """Where and why a run stopped.

    Attributes
    ----------
    step
        Number of the step, from 1, that was not reached.
    time
        Its time in s.
    control
        "force" or "depth": what `reached` and `target` are.
    reached
        Load value (N or m) of the last state in equilibrium.
    target
        Load value (N or m) that was wanted.
    reason
        In words.
    """

    step: int
    time: float
    control: str
    reached: float
    target: float
    reason: str

    def __str__(self) -> str:
        """One sentence."""
        unit = "N" if self.control == "force" else "m"
        return (
            f"step {self.step} (time {self.time:g} s): {self.control} {self.target:g} {unit} not reached, "
            f"last equilibrium at {self.reached:g} {unit}: {self.reason}"
        )


@dataclass(frozen=True)
class Resumed:
    """What a run took over from a checkpoint.

    Attributes
    ----------
    steps
        Accepted steps that were not computed again.
    seconds
        CPU time in s that they took in the processes before.
    """

    steps: int
    seconds: float


@dataclass(frozen=True)
class Solution:
    """What a run gives; n accepted steps, L layers from the surface down.

    Attributes
    ----------
    time
        (n,) in s.
    force
        Press (n,) in N.
    reaction
        Force (n,) in N that the support returns, from the internal forces; a check on `force`.
    depth
        Deflection (n,) in m of the top face on the axis (of the tool if rigid), press positive.
    layer_names
        (L,)
    top_deflection
        Deflection (n, L) in m of each layer's top face on the axis, press positive.
    max_strain
        (n,) largest principal strain (absolute; Green-Lagrange, or small strain in linear kinematics)
        of the elements' mean strains.
    displacement
        Nodal displacements (n, N, 2) in m: u_r, u_z (z upwards); (n, N, 3) in three dimensions.
    pressure
        Coefficients (n, p, E), p = 3 if axisymmetric, of the mean stress in the elements, in Pa times the
        root of a volume.
    complete
        Whether all steps were reached.
    failure
        Where and why not, or None.
    warnings
        Texts for people.
    mesh
        The mesh.
    recovery
        Evaluates stress and strain; used by :meth:`fields`.
    resumed
        What was taken over from a checkpoint; None in a run from rest.
    last
        Of a run that stopped between two steps: the same steps with, as one more row, the last state of equilibrium.
    unstable_from
        Depth in m of the first state on the way that is known not to be stable, or None.
    """

    time: FloatArray
    force: FloatArray
    reaction: FloatArray
    depth: FloatArray
    layer_names: tuple[str, ...]
    top_deflection: FloatArray
    max_strain: FloatArray
    displacement: FloatArray
    pressure: FloatArray
    complete: bool
    failure: Failure | None
    warnings: tuple[str, ...]
    mesh: AnyMesh
    recovery: FieldRecovery
    resumed: Resumed | None = None
    last: Solution | None = None
    unstable_from: float | None = None

    def profile(self, step: int, radii: FloatArray) -> FloatArray:
        """Deflection of each layer's top face at reference radii (from the tool's axis along +x).

        Parameters
        ----------
        step
            Row of the arrays of this solution: 0 is the first load step, -1 the last.
        radii
            Reference radii (m,) in m, not negative.

        Returns
        -------
        ndarray
            Deflection (L, m) in m, press positive, by the element's quadratic shape functions; NaN
            outside the mesh.

        Raises
        ------
        FemError
            If a radius is negative or not finite, or there is no such step.
        """
        r = np.asarray(radii, dtype=np.float64)
        if r.ndim != 1 or not np.isfinite(r).all() or (r < 0.0).any():
            raise FemError("radii: must be a one-dimensional array of finite values >= 0 m")
        u = self._displacement_at(step)
        return self.mesh.profile(-u[:, -1], r)

    def fields(self, step: int) -> Fields:
        """Displacement, stress and strain at one step, as plain arrays for a file writer.

        Parameters
        ----------
        step
            Row of the arrays of this solution: 0 is the first load step, -1 the last.

        Raises
        ------
        FemError
            If there is no such step.
        """
        displacement = self._displacement_at(step)
        end = range(len(self.time))[step] + 1
        recovery = self.recovery.remembering(self.time[:end], self.displacement[:end])
        return recovery.fields(displacement, self.pressure[step])

    def _displacement_at(self, step: int) -> FloatArray:
        count = len(self.time)
        if not -count <= step < count:
            raise FemError(f"step = {step}: the solution has {count} steps, rows 0 to {count - 1}")
        out: FloatArray = self.displacement[step]
        return out
