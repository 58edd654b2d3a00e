"""What simple methods see of a session: its force beside depth and rate, and the form of their answers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench_hw.tables import TrialTable
from benchmark.blind.motion import Array
from benchmark.discovery.discovery_result import Discovery, NamedEffect
from benchmark.files import Session

COMMON, AROUND = 0.9, 5


@dataclass(frozen=True, eq=False)
class ForceSamples:
    """Samples of all trials, (n,) each, over their largest: force, pressed depth (0 in air), rate; and the trial."""

    force: Array
    depth: Array
    rate: Array
    trial: Array


def force_samples(session: Session, rows: int) -> ForceSamples:
    """Samples of a session, about `rows` a trial; trials of other stiffness are made equal where all have been."""
    tables = [trial.table for trial in session.trials]
    reached = COMMON * min(float(np.max(table.depth)) for table in tables)
    parts = [_of_trial(number, table, rows, reached) for number, table in enumerate(tables)]
    force, depth, rate, trial = (np.concatenate(column) for column in zip(*parts, strict=True))
    return ForceSamples(force / np.abs(force).max(), depth / depth.max(), rate / np.abs(rate).max(), trial)


def _of_trial(number: int, table: TrialTable, rows: int, reached: float) -> tuple[Array, Array, Array, Array]:
    """Force over that at the first passing of a depth that all trials reach, pressed depth, rate, and the number."""
    first = int(np.flatnonzero(table.depth >= reached)[0])
    there = float(np.median(table.force[max(first - AROUND, 0) : first + AROUND]))
    picked = np.linspace(0, table.time.size - 1, min(rows, table.time.size)).astype(int)
    rate = np.gradient(table.depth, table.time)
    pressed = np.clip(table.depth, 0.0, None)[picked]
    return table.force[picked] / there, pressed, rate[picked], np.full(picked.size, float(number))


def simple_answer(verdict: str, effects: tuple[str, ...] = ()) -> Discovery:
    """An answer with a verdict and names alone."""
    return Discovery(
        verdict=verdict,
        statement="",
        p=None,
        effects=tuple(NamedEffect(slug, 1.0, (), ()) for slug in effects),
        where=(),
        contrasts=(),
        gap=(),
        smallest_visible={},
        candidates=(),
        base=(),
        remains=(),
        warnings=(),
        traces=(),
        conditions=(),
        channels=(),
        trials=(),
        seconds=0.0,
    )
