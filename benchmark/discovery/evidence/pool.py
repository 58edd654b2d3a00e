"""Candidate fits in processes: the same answers as one after the other, kept in a folder as they come."""

from __future__ import annotations

import hashlib
import json
import multiprocessing
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from benchmark.child_processes import end_with_parent
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.base.effect_model import Fit
from benchmark.physics import Effect, load_effects

Listener = Callable[[str, int, int, str], None]
"""Called with stage, done, total and the best so far."""


def silent(stage: str, done: int, total: int, best: str) -> None:
    """A listener that says nothing."""


@dataclass
class Pool:
    """Fits candidates; see `pool`."""

    executor: ProcessPoolExecutor | None
    store: Path | None
    key: str
    listener: Listener = field(default=silent)

    def fits(self, stage: str, jobs: Sequence[tuple[Fit, Effect]]) -> list[Fit]:
        """One fit for each base and effect, in their order."""
        done: dict[int, Fit] = {}
        best = ""
        for index, made in self._made(jobs):
            done[index] = made
            lowest = min(done, key=lambda k: done[k].objective)
            best = jobs[lowest][1].slug
            self.listener(stage, len(done), len(jobs), best)
        return [done[k] for k in range(len(jobs))]

    def _made(self, jobs: Sequence[tuple[Fit, Effect]]) -> Iterator[tuple[int, Fit]]:
        waiting: dict[Future[Fit], int] = {}
        for index, (base, effect) in enumerate(jobs):
            known = self._recall(base, effect)
            if self.executor is None:
                made = fit_candidate(base, effect, known=known)
                self._keep(base, effect, made)
                yield index, made
            else:
                waiting[self.executor.submit(fit_candidate, base, effect, known=known)] = index
        for future in as_completed(waiting):
            index = waiting[future]
            made = future.result()
            self._keep(*jobs[index], made)
            yield index, made

    def _file(self, base: Fit, effect: Effect) -> Path | None:
        if self.store is None:
            return None
        slugs = "+".join([*(each.slug for each in base.model.effects), f"{effect.slug}-{len(effect.names)}"])
        name = hashlib.sha256(f"{self.key} {slugs}".encode()).hexdigest()[:24]
        return self.store / f"{name}.json"

    def _recall(self, base: Fit, effect: Effect) -> tuple[np.ndarray, np.ndarray] | None:
        file = self._file(base, effect)
        try:
            table = json.loads(file.read_text()) if file is not None and file.is_file() else None
            return None if table is None else (np.array(table["vector"]), np.array(table["nuisance"]))
        except (OSError, ValueError, KeyError):
            return None

    def _keep(self, base: Fit, effect: Effect, made: Fit) -> None:
        file = self._file(base, effect)
        if file is None:
            return
        file.parent.mkdir(parents=True, exist_ok=True)
        part = file.with_suffix(".part")
        part.write_text(json.dumps({"vector": made.vector.tolist(), "nuisance": made.nuisance.tolist()}))
        part.replace(file)


@contextmanager
def pool(workers: int, store: Path | None, key: str, own: Sequence[Effect], listener: Listener) -> Iterator[Pool]:
    """A pool of processes, or none with one worker.

    Parameters
    ----------
    workers
        Processes.
    store
        Folder where fits are kept, from which an interrupted discovery goes on.
    key
        What a kept fit depends on.
    own
        Effects from a user's files, which each process loads again.
    listener
        Told of progress.
    """
    if workers <= 1:
        yield Pool(None, store, key, listener)
        return
    files = tuple(dict.fromkeys(effect.origin for effect in own if effect.origin))
    context = multiprocessing.get_context("spawn")
    before = {name: os.environ.get(name) for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")}
    os.environ.update(dict.fromkeys(before, "1"))
    try:
        with ProcessPoolExecutor(workers, context, initializer=_prepare, initargs=(files,)) as executor:
            yield Pool(executor, store, key, listener)
    finally:
        for variable, value in before.items():
            if value is None:
                os.environ.pop(variable, None)
            else:
                os.environ[variable] = value


def _prepare(files: Sequence[str]) -> None:
    end_with_parent()
    for file in files:
        load_effects(file)


def fingerprint(*parts: Any) -> str:
    """SHA-256 of the texts of some values."""
    return hashlib.sha256("\n".join(map(repr, parts)).encode()).hexdigest()
