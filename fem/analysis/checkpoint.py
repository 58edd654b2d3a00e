"""Checkpoints: the accepted steps of a nonlinear run in one file, so that a run that was killed goes on from there.

The file holds every state of equilibrium that the prediction knows, so a resumed run takes the same way as an
uninterrupted one. It carries a fingerprint of problem, mesh, load history and solver and serves these only.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from fem.analysis.equilibrium import State
from fem.arrays import FloatArray, IntArray
from fem.kept_file import fingerprint, read_kept, write_kept
from fem.load import Load
from fem.mesh.solid import AnyMesh
from fem.problem.problem import Problem

FORMAT = "fem checkpoint 7"


@dataclass(frozen=True)
class Progress:
    """How far a run has come: n accepted steps, k states of equilibrium.

    Attributes
    ----------
    time, reactions, strains
        Of the accepted steps, (n,) in s, N and 1.
    steps
        Which of the states each accepted step is, (n,).
    values
        Load value (k,) in N or m of each state.
    times
        Time (k,) in s of each state.
    states
        The states in the order in which they were found, the one before the first step included.
    settled
        What the corrections had chosen (k, c) in each state; see :attr:`fem.assembly.item.EquationItem.settled`.
    accounts
        Energy up to each state (k, 4); see :class:`fem.analysis.limit_points.Account`.
    seconds
        CPU time in s that all of them took, in however many processes.
    """

    time: FloatArray
    reactions: FloatArray
    strains: FloatArray
    steps: IntArray
    values: FloatArray
    times: FloatArray
    states: tuple[State, ...]
    settled: FloatArray
    accounts: FloatArray
    seconds: float


class Keeper(Protocol):
    """Where a run keeps how far it has come."""

    def read(self) -> Progress | None:
        """What was kept; None to start from rest."""
        ...

    def write(self, progress: Progress) -> None:
        """Keep the present progress; called after each accepted step."""
        ...


@dataclass(frozen=True)
class Checkpoint:
    """The file of one run.

    Attributes
    ----------
    path
        Where it is; it need not exist yet.
    fingerprint
        See :func:`run_fingerprint`.
    """

    path: Path
    fingerprint: str

    def write(self, progress: Progress) -> None:
        """Replace the file by the present progress; it is written whole or not at all.

        Raises
        ------
        CheckpointError
            If it cannot be written.
        """
        arrays = {f.name: getattr(progress, f.name) for f in fields(progress) if f.name != "states"}
        for f in fields(State):
            arrays[f"state_{f.name}"] = np.stack([np.asarray(getattr(state, f.name)) for state in progress.states])
        write_kept(self.path, FORMAT, self.fingerprint, arrays)

    def read(self) -> Progress | None:
        """Progress in the file; None if there is no such file.

        Raises
        ------
        CheckpointError
            If the file is damaged, no checkpoint, or of another problem, mesh, load history or solver.
        """
        arrays = read_kept(self.path, FORMAT, self.fingerprint)
        return None if arrays is None else _progress(arrays)


def _progress(arrays: dict[str, np.ndarray]) -> Progress:
    columns = {f.name: arrays[f"state_{f.name}"] for f in fields(State)}
    states = tuple(_state({name: column[n] for name, column in columns.items()}) for n in range(len(arrays["values"])))
    named: dict[str, Any] = {f.name: arrays[f.name] for f in fields(Progress) if f.name not in ("states", "seconds")}
    return Progress(**named, states=states, seconds=float(arrays["seconds"]))


def _state(values: Mapping[str, Any]) -> State:
    numbers: dict[str, Any] = {name: value if np.ndim(value) else float(value) for name, value in values.items()}
    return State(**numbers)


def run_fingerprint(problem: Problem, mesh: AnyMesh, load: Load) -> str:
    """Hash of everything that decides the steps of a run; of the problem's surface the mesh says enough."""
    words = tuple(getattr(problem, f.name) for f in fields(problem) if f.name != "surface")
    return fingerprint((words, load.control), (mesh.nodes, mesh.elements, mesh.layer, mesh.base, load.time, load.value))
