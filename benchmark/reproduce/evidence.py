"""What the items and figures are made from: the markers of the shipped session, and two presses to 5 N."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from bench_hw.vision.displacement import fit_parabolas, moving_average
from benchmark.files import Session, load_scenario, load_session
from benchmark.models import Array
from benchmark.runs.options import Listener, RunOptions
from benchmark.runs.record import RunRecord
from benchmark.runs.scenario_run import run_scenario
from benchmark.runs.trials.film_tables import MarkerMotion, motions_of
from benchmark.runs.trials.filming import Tracked, session_films
from benchmark.runs.trials.table_one import table_one
from benchmark.sessions import SHIPPED

SESSION, CONDITION = "phantom", "press"
"""The article's protocol: ten equal presses."""
TABLE_2, FIVE_NEWTON = "paper", "skin-5N"


@dataclass(frozen=True)
class Chain:
    """The article's marker chain on the trials of a session.

    Attributes
    ----------
    trials
        How many.
    synthetic
        Whether they were computed, not measured.
    variables
        Table 1 in the article's own way, mean over the trials, by the names of `fitted_parameters.csv`.
    r2
        Of every parabola, (k,).
    shown
        The trial that is drawn.
    depth
        Of its tool at its frames, (f,) m.
    places
        Of its markers, (f, m, 2) m.
    tracked
        Its film tracked now; None for tracks that came with the session.
    """

    trials: int
    synthetic: bool
    variables: Mapping[str, float | None]
    r2: Array
    shown: MarkerMotion
    depth: Array
    places: Array
    tracked: Tracked | None


@dataclass(frozen=True)
class Evidence:
    """Everything that was run: `table_2` is the load history behind Table 2, `press` the press to 5 N of skin."""

    chain: Chain
    table_2: RunRecord
    press: RunRecord


def gather(listener: Listener) -> Evidence:
    """Track and fit the shipped session, and run both presses.

    Raises
    ------
    InputError, SolverError
        As the runs they are; neither occurs with what ships.
    """
    session = load_session(SHIPPED / SESSION)
    chain = follow_chain(session, listener)
    options = RunOptions(repeats=0)
    table_2, press = (run_scenario(load_scenario(name), options, listener) for name in (TABLE_2, FIVE_NEWTON))
    return Evidence(chain, table_2, press)


def follow_chain(session: Session, listener: Listener) -> Chain:
    """Follow the article from pictures to Table 1 on the trials of one condition."""
    camera = session.camera
    assert camera is not None  # the shipped session has one
    session = replace(session, trials=tuple(trial for trial in session.trials if trial.condition == CONDITION))
    films = session_films(session, listener)
    motions = motions_of(films.films, camera)
    shown = motions[0]
    table = next(trial.table for trial in session.trials if trial.name == shown.trial)
    return Chain(
        len(motions),
        session.synthetic,
        {row.name: row.value for row in table_one(session, motions, {})},
        np.concatenate([_r2(motion) for motion in motions]),
        shown,
        np.interp(shown.time, table.time, table.depth),
        films.films[CONDITION, shown.trial].places,
        next((each for each in films.tracked if each.trial == shown.trial), None),
    )


def _r2(motion: MarkerMotion) -> Array:
    """Of the parabolas over the frames with deformation, after the article's moving average."""
    moved = moving_average(motion.moved, mode="causal")[motion.window]
    return np.asarray(fit_parabolas(motion.time[motion.window], moved).r2.ravel())
