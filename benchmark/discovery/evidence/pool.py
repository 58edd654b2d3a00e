"""Candidate fits in processes: the same answers as one after the other, kept in a folder as they come.

A kept fit is the whole fit, to the last bit, so that an interrupted discovery ends with the answer it would have had.
"""

from __future__ import annotations

import hashlib
import io
import re
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from bench_hw.storage.regular_file import TABLE, read_sealed, sealed
from benchmark.child_processes import Mapped, PoolContext, begin_in_pool, single_threaded_children
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.base.effect_model import EffectModel, Fit
from benchmark.models.user_file import modules_of
from benchmark.physics import Effect, load_effects
from benchmark.response.least_squares import Blocks
from benchmark.response.trials_model import TrialColumns
from reports import write_bytes
from reports.manifest import remove_known

ARRAYS = ("vector", "nuisance", "objective", "precision", "prior_mean")
KEPT = re.compile(r"[0-9a-f]{24}\.(?:npz|json|part)|\.[0-9a-f]{24}\.npz\.[0-9a-f]{8}\.part")
"""Names of the files in which fits are kept, those of earlier versions among them."""

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
    made: WeakKeyDictionary[Fit, dict[tuple[str, int], Fit]] = field(default_factory=WeakKeyDictionary)
    """Fits of each base, by slug and number of parameters of what was added to it, as long as the base lives."""

    @property
    def map(self) -> Mapped:
        """`map` by the processes, where there are any."""
        return map if self.executor is None else self.executor.map

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
        """Each job's number and fit as they come; the same job gives the same fit again."""
        same: dict[tuple[Fit, tuple[str, int]], list[int]] = {}
        for index, (base, effect) in enumerate(jobs):
            known = self.made.setdefault(base, {}).get(_name(effect))
            if known is None:
                same.setdefault((base, _name(effect)), []).append(index)
            else:
                yield index, known
        new = list(same.values())
        for place, fit in self._worked_out([jobs[numbers[0]] for numbers in new]):
            base, effect = jobs[new[place][0]]
            self.made[base][_name(effect)] = fit
            yield from ((index, fit) for index in new[place])

    def _worked_out(self, jobs: Sequence[tuple[Fit, Effect]]) -> Iterator[tuple[int, Fit]]:
        """The same of jobs that are new, or kept in the folder by an earlier run."""
        waiting: dict[Future[Fit], int] = {}
        for index, (base, effect) in enumerate(jobs):
            kept = self._recall(base, effect)
            if kept is not None:
                yield index, kept
            elif self.executor is None:
                yield index, self._keep(base, effect, fit_candidate(base, effect))
            else:
                waiting[self.executor.submit(fit_candidate, base, effect)] = index
        for future in as_completed(waiting):
            index = waiting[future]
            yield index, self._keep(*jobs[index], future.result())

    def _file(self, base: Fit, effect: Effect) -> Path | None:
        """Where a fit is kept: by all that it follows from."""
        if self.store is None:
            return None
        slugs = "+".join([*(each.slug for each in base.model.effects), "{}-{}".format(*_name(effect))])
        name = hashlib.sha256(f"{self.key} {slugs}".encode())
        name.update(stored(base))
        return self.store / f"{name.hexdigest()[:24]}.npz"

    def _recall(self, base: Fit, effect: Effect) -> Fit | None:
        file = self._file(base, effect)
        content = None if file is None else read_sealed(file, TABLE)
        return None if content is None else restored(content, base, effect)

    def _keep(self, base: Fit, effect: Effect, made: Fit) -> Fit:
        """Keep a fit, and give it as it will be recalled, so that an interruption changes nothing."""
        file, content = self._file(base, effect), stored(made)
        if file is not None:
            write_bytes(file, sealed(file.name, content))
        return restored(content, base, effect)


def _name(effect: Effect) -> tuple[str, int]:
    """Slug and number of parameters: an effect with more terms is another one."""
    return effect.slug, len(effect.names)


def stored(made: Fit) -> bytes:
    """All of a fit but its model, to the last bit."""
    arrays = {name: getattr(made, name) for name in ARRAYS}
    arrays |= {f"blocks_{each.name}": getattr(made.blocks, each.name) for each in fields(Blocks)}
    for each in fields(TrialColumns):
        arrays |= {f"{each.name}_{i:04d}": value for i, value in enumerate(getattr(made.columns, each.name))}
    stream = io.BytesIO()
    np.savez(stream, **arrays)  # its time stamps are constant: the same fit has the same bytes
    return stream.getvalue()


def restored(content: bytes, base: Fit, effect: Effect) -> Fit:
    """The fit of `base` with `effect` that was `stored`."""
    with np.load(io.BytesIO(content), allow_pickle=False) as data:
        arrays = {name: data[name] for name in data.files}
    trials = range(len(base.model.problem.trials))
    plain = {name: arrays[name] for name in ARRAYS if name != "objective"}
    return Fit(
        model=EffectModel(base.model.problem, (*base.model.effects, effect)),
        objective=float(arrays["objective"]),
        blocks=Blocks(**{each.name: arrays[f"blocks_{each.name}"] for each in fields(Blocks)}),
        columns=TrialColumns(
            **{each.name: [arrays[f"{each.name}_{i:04d}"] for i in trials] for each in fields(TrialColumns)}
        ),
        **plain,
    )


def forget(store: Path) -> None:
    """Remove the fits kept in a folder; anything else in it stays."""
    remove_known(store, lambda name: KEPT.fullmatch(name) is not None)


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
    with (
        single_threaded_children(),
        ProcessPoolExecutor(workers, PoolContext(), initializer=_prepare, initargs=(files,)) as executor,
    ):
        yield Pool(executor, store, key, listener)


def _prepare(files: Sequence[str]) -> None:
    begin_in_pool()
    for file in files:
        load_effects(file)


def fingerprint(*parts: Any) -> str:
    """SHA-256 of the texts of some values."""
    return hashlib.sha256("\n".join(map(repr, parts)).encode()).hexdigest()


def own_code(effect: Effect) -> tuple[str, str]:
    """What a user's effect says of itself, and a hash of its file and of the modules from that folder it imported."""
    digest = hashlib.sha256()
    if effect.origin:
        file = Path(effect.origin)
        digest.update(file.read_bytes())
        for name, module in sorted(modules_of(file.parent).items()):
            digest.update(name.encode() + b"\0" + (module.read_bytes() if module.is_file() else b""))
    return repr(effect.description), digest.hexdigest()
