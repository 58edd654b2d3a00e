"""Presses of one long record as trials of their own, where a session has too few records to compare."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from bench_hw.tables import MarkerTable, TrialTable
from benchmark.discovery import criteria
from benchmark.discovery.trials.segments import segments
from benchmark.files import Session, Trial


def by_cycles(session: Session) -> tuple[Session, tuple[str, ...]]:
    """A session of one or two long records with each press as a trial, and what a reader must know of it.

    Sessions with enough records, and records with too few presses, stay as they are: what happens from press to press
    within a trial is evidence (softening, set), which is lost where presses count as trials that start alike.
    """
    if len(session.trials) >= criteria.LEAST_TRIALS:
        return session, ()
    split = {trial.name: tuple(_presses(trial)) for trial in session.trials}
    long = {name: parts for name, parts in split.items() if len(parts) >= criteria.LEAST_TRIALS}
    if not long:
        return session, ()
    trials = tuple(each for trial in session.trials for each in long.get(trial.name, (trial,)))
    warnings = tuple(
        f"record {name}: its {len(parts)} presses count as trials; what one press leaves to the next shows as a trend "
        "over the trial number only"
        for name, parts in long.items()
    )
    return replace(session, trials=trials), warnings


def _presses(trial: Trial) -> Iterator[Trial]:
    """The presses of a record, numbered from 1, each from the middle of the rest before it to that after it."""
    marks = _borders(trial.table.time, trial.table.depth)
    for number, (first, last) in enumerate(pairwise(marks), start=1):
        table, markers = _rows(trial.table, first, last), trial.markers
        start, end = table.time[0], table.time[-1]
        yield replace(
            trial,
            name=f"{trial.name} press {number}",
            table=table,
            markers=None if markers is None else _frames(markers, (markers.time >= start) & (markers.time <= end)),
        )


def _borders(time: NDArray[np.float64], depth: NDArray[np.float64]) -> list[int]:
    """Rows between the presses of a record, its ends included: the middle of a rest, or the reversal without one."""
    pieces = segments(time, depth)
    marks = [0]
    for number, piece in enumerate(pieces):
        if piece.kind != "press" or piece.cycle < 2:
            continue
        before = pieces[number - 1]
        if before.cycle == piece.cycle:
            continue
        marks.append((before.first + before.last) // 2 if before.kind == "rest" else piece.first)
    return [*marks, depth.size]


def _rows(table: TrialTable, first: int, last: int) -> TrialTable:
    rows = slice(first, last)
    extra = {name: values[rows] for name, values in table.extra.items()}
    return replace(table, time=table.time[rows], depth=table.depth[rows], force=table.force[rows], extra=extra)


def _frames(markers: MarkerTable, seen: NDArray[np.bool_]) -> MarkerTable:
    return replace(markers, time=markers.time[seen], marker=markers.marker[seen], x=markers.x[seen], y=markers.y[seen])
