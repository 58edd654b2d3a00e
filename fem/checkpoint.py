"""Checkpoints: the accepted steps of a nonlinear run in one file, so that a run that was killed goes on from there.

The file holds every state of equilibrium that the prediction knows, so a resumed run takes the same way as an
uninterrupted one. It carries a fingerprint of problem, mesh and load history and serves these only.
"""

from __future__ import annotations

import hashlib
import os
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.errors import FemError
from fem.load import Load
from fem.mesh import AnyMesh
from fem.problem import Problem
from fem.solving import State

FORMAT = "fem checkpoint 2"


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
    """

    time: FloatArray
    reactions: FloatArray
    strains: FloatArray
    steps: IntArray
    values: FloatArray
    times: FloatArray
    states: tuple[State, ...]


@dataclass(frozen=True)
class Checkpoint:
    """The file of one run.

    Attributes
    ----------
    path
        Where it is; it need not exist yet.
    fingerprint
        See :func:`fingerprint`.
    """

    path: Path
    fingerprint: str

    def write(self, progress: Progress) -> None:
        """Replace the file by the present progress; it is written whole or not at all.

        Raises
        ------
        FemError
            If it cannot be written.
        """
        arrays = {f.name: getattr(progress, f.name) for f in fields(progress) if f.name != "states"}
        for f in fields(State):
            arrays[f"state_{f.name}"] = np.stack([np.asarray(getattr(state, f.name)) for state in progress.states])
        part = self.path.with_name(f"{self.path.name}.part")
        try:
            with part.open("wb") as file:
                np.savez(file, format=FORMAT, fingerprint=self.fingerprint, **arrays)
                file.flush()
                os.fsync(file.fileno())
            part.replace(self.path)
        except OSError as error:
            raise FemError(f"checkpoint {self.path}: cannot be written ({error})") from error

    def read(self) -> Progress | None:
        """Progress in the file; None if there is no such file.

        Raises
        ------
        FemError
            If the file is damaged, no checkpoint, or of another problem, mesh or load history.
        """
        if not self.path.exists():
            return None
        try:
            with np.load(self.path, allow_pickle=False) as data:
                arrays = {name: data[name] for name in data.files}
            found, owner = str(arrays["format"]), str(arrays["fingerprint"])
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
            raise FemError(f"checkpoint {self.path}: is damaged or no checkpoint ({error}); remove it") from error
        if found != FORMAT or owner != self.fingerprint:
            raise FemError(
                f"checkpoint {self.path}: is of another problem, mesh or load history; "
                "give the file another name, or remove it to start anew"
            )
        return _progress(arrays)


def _progress(arrays: dict[str, np.ndarray]) -> Progress:
    columns = {f.name: arrays[f"state_{f.name}"] for f in fields(State)}
    states = tuple(_state({name: column[n] for name, column in columns.items()}) for n in range(len(arrays["values"])))
    return Progress(**{f.name: arrays[f.name] for f in fields(Progress) if f.name != "states"}, states=states)


def _state(values: Mapping[str, Any]) -> State:
    numbers: dict[str, Any] = {name: value if np.ndim(value) else float(value) for name, value in values.items()}
    return State(**numbers)


def fingerprint(problem: Problem, mesh: AnyMesh, load: Load) -> str:
    """Hash of everything that decides the steps of a run."""
    digest = hashlib.sha256(repr(_words(problem)).encode())
    digest.update(load.control.encode())
    for array in (mesh.nodes, mesh.elements, mesh.layer, load.time, load.value):
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()


def _words(problem: Problem) -> tuple[object, ...]:
    """The problem without its surface, of which the mesh says enough."""
    return tuple(getattr(problem, f.name) for f in fields(problem) if f.name != "surface")
