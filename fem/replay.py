"""The memory of a body at other points than those of the equations, by following its states again."""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol, TypeVar

from fem.arrays import FloatArray
from fem.assembly import ElementLaws, Memory
from fem.deformation import Deformation


class Recovery(Protocol):
    """What evaluates fields."""

    @property
    def laws(self) -> ElementLaws:
        """Laws of the elements."""
        ...

    @property
    def finite(self) -> bool:
        """Whether the kinematics is finite."""
        ...

    def deformation(self, displacement: FloatArray) -> Deformation:
        """Deformation at the points of the fields of nodal displacements (N, components)."""
        ...


AnyRecovery = TypeVar("AnyRecovery", bound=Recovery)


def remembering(recovery: AnyRecovery, time: FloatArray, displacement: FloatArray) -> AnyRecovery:
    """Recovery whose laws remember the steps so far.

    Parameters
    ----------
    recovery
        Recovery of the body at rest; returned as it is where no layer relaxes.
    time
        Times (n,) in s of the steps.
    displacement
        Nodal displacements (n, N, components) in m.
    """
    laws = recovery.laws
    if laws.prony is None:
        return recovery
    memory, before = None, min(0.0, float(time[0]))
    for end, u in zip(time.tolist(), displacement, strict=True):
        deformation = recovery.deformation(u)
        if memory is None:
            memory = Memory.of_rest(laws.prony, deformation.H.shape)
        elastic = laws.second_stress(deformation) if recovery.finite else laws.linear_stress(deformation)
        memory, before = memory.after(end - before, elastic), end
    if memory is None:
        return recovery
    return replace(recovery, laws=laws.relaxing(*memory.ahead(0.0)))  # type: ignore[type-var]
