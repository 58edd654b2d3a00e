"""Presses of one long record as trials of their own, where a session has too few records to compare."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from bench_hw.tables import MarkerTable, TrialTable
from benchmark.discovery import criteria
from benchmark.discovery.trials.segments import prescribed, segments
from benchmark.files import Session, Trial

REMEMBERED, LEAST_REMEMBERED = 240, 3
"""Presses before them that all presses of a record remember together, and that each does at least: of 24 all, of 80 and
more three each."""


def by_cycles(session: Session) -> tuple[Session, tuple[str, ...]]:
    """A session of one or two long records with each press as a trial, and what a reader must know of it.

    Sessions with enough records, and records with too few presses, stay as they are. Each press keeps the record before
    it: what tissue remembers of that (relaxation, softening, a set) is part of the press.
    """
    if len(session.trials) >= criteria.LEAST_TRIALS:
        return session, ()
    by_force = session.drive == "force"
    split = {trial.name: tuple(_presses(trial, by_force)) for trial in session.trials}
    long = {name: parts for name, parts in split.items() if len(parts) >= criteria.LEAST_TRIALS}
    if not long:
        return session, ()
    trials = tuple(each for trial in session.trials for each in long.get(trial.name, (trial,)))
    warnings = tuple(
        f"record {name}: its {len(parts)} presses count as trials; each after the {_remembered(len(parts))} before"
        for name, parts in long.items()
    )
    return replace(session, trials=trials), warnings


def _presses(trial: Trial, by_force: bool) -> Iterator[Trial]:
    """The presses of a record, numbered from 1, each from the middle of the rest before it to that after it."""
    marks = _borders(trial.table.time, prescribed(trial.table.force) if by_force else trial.table.depth)
    remembered = _remembered(len(marks) - 1)
    for number, (first, last) in enumerate(pairwise(marks), start=1):
        table, markers = _rows(trial.table, first, last), trial.markers
        start, end = table.time[0], table.time[-1]
        yield replace(
            trial,
            name=f"{trial.name} press {number}",
            table=table,
            earlier=_rows(trial.table, marks[max(number - 1 - remembered, 0)], first) if first else None,
            markers=None if markers is None else _frames(markers, (markers.time >= start) & (markers.time <= end)),
        )


def _remembered(presses: int) -> int:
    """How many presses before it each press of a record remembers."""
    return max(REMEMBERED // presses, LEAST_REMEMBERED)


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
