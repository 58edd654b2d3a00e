"""One problem as plain arrays in a file, and its material.

It loads nothing but NumPy, so that no program's process pays for another one's libraries.
Every program gets the same nodes, elements, supports and nodal forces.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

LAYERS = ((1.0e-4, 1.0e6), (1.5e-3, 1.0e5), (8.0e-3, 1.0e4))  # thickness in m, Young's modulus in Pa
POISSON = 0.48


@dataclass(frozen=True)
class Case:
    """One problem.

    Attributes
    ----------
    kind
        "linear" (hex20, three dimensions) or "hyperelastic" (9-node axisymmetric).
    nodes, elements
        Positions (N, dim) in m and nodes (n, E) in scikit-fem's order.
    vtk_order
        Element nodes in VTK's order, as far as it is the other programs'.
    layer
        Layer of each element (E,).
    fixed
        Displacements (dim, N) that are zero.
    load
        Vertical nodal forces (N,) in N at the end of the ramp.
    steps
        Load steps.
    """

    kind: str
    nodes: np.ndarray
    elements: np.ndarray
    vtk_order: np.ndarray
    layer: np.ndarray
    fixed: np.ndarray
    load: np.ndarray
    steps: int

    @property
    def unknowns(self) -> int:
        """Displacements that are not fixed."""
        return int((~self.fixed).sum())

    def save(self, path: Path) -> None:
        """Write the arrays."""
        np.savez(path, **asdict(self))


def load_case(path: Path) -> Case:
    """Read what :meth:`Case.save` wrote."""
    with np.load(path) as data:
        values = {name: data[name] for name in data.files}
    return Case(**{**values, "kind": str(values["kind"]), "steps": int(values["steps"])})
