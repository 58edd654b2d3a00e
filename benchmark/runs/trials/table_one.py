"""Table 1 of the article from a session's trials: in the article's own way, and in one whose units are right."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress

import numpy as np

from bench_hw.errors import BenchError, InputError
from bench_hw.vision.displacement import maximum_radius, moving_average, published_variables, sound_variables
from benchmark.files import Session, Trial
from benchmark.identification import FittedParameter
from benchmark.identification.pooling import counted_trials, mean_interval
from benchmark.runs.trials.film_tables import MarkerMotion

OURS = "Table 1 with dimensions that are right, mean over {} of condition {}"
THEIRS = "Table 1 in the article's own way, units mixed as there, mean over {} of condition {}"
CANCEL = ": markers on opposite sides cancel in the averages"

Values = dict[str, tuple[float, str]]


Placed = Callable[[MarkerMotion, np.ndarray], np.ndarray]
"""From a motion and the depths (f,) at its frames to the markers' true displacements, (f, m, 2) m."""


def table_one(
    session: Session, motions: Sequence[MarkerMotion], placed: Mapping[str, Placed]
) -> tuple[FittedParameter, ...]:
    """Return rows of Table 1 for the first condition with markers; none where no trial gives one.

    Parameters
    ----------
    session, motions
        The trials and their markers.
    placed : mapping
        By trial, what takes perspective off; without it only the article's own way is given, which leaves it in.
    """
    by_name = {motion.trial: motion for motion in motions}
    trials = [trial for trial in session.trials if trial.name in by_name]
    if not trials:
        return ()
    condition = trials[0].condition
    found: dict[str, list[Values]] = {THEIRS: [], OURS: []}
    for trial in trials:
        if trial.condition == condition:
            motion = by_name[trial.name]
            with suppress(BenchError):
                found[THEIRS].append(_published(trial, motion))
            if trial.name in placed:
                with suppress(BenchError):
                    found[OURS].append(_sound(session, trial, motion, placed[trial.name]))
    return tuple(row for source, values in found.items() for row in _rows(values, source, condition))


def _rows(values: Sequence[Mapping[str, tuple[float, str]]], source: str, condition: str) -> list[FittedParameter]:
    if not values:
        return []
    said = source.format(counted_trials(len(values)), condition)
    rows = []
    for name, (_, unit) in values[0].items():
        each = [value[name][0] for value in values if math.isfinite(value[name][0])]
        if len(each) < 2:
            single = each[0] if each else None
            rows.append(FittedParameter(name, single, unit, None, None, False, f"{said}; a single value"))
            continue
        mean, half, _ = mean_interval(each)
        row = FittedParameter(name, mean, unit, mean - half, mean + half, True, said)
        clear = abs(mean) > half
        rows.append(row if clear else row.unidentified(f"; cannot be told from 0 (+/- {half:.2g}, 95 %){CANCEL}"))
    return rows


def _depth(trial: Trial, motion: MarkerMotion) -> np.ndarray:
    return np.interp(motion.time, trial.table.time, trial.table.depth)


def _published(trial: Trial, motion: MarkerMotion) -> Values:
    window = motion.window
    moved = moving_average(motion.moved, mode="causal")[window]
    found = published_variables(moved, motion.radius_nine[window], _depth(trial, motion)[window])
    values: Values = {}
    for name, coefficients in (("O", found.o), ("p", found.p)):
        for power, value in zip((2, 1, 0), coefficients, strict=True):
            values[f"published.{name}_{power}"] = (value, f"mm/frame^{power}")
    values |= {
        "published.d": (found.d, ""),
        "published.a": (found.a, "mm"),
        "published.b": (found.b, "mm"),
        "published.lambda_11": (found.wave_number, "m/s/mm"),
        "published.B_11": (found.amplitude, "mm"),
        "published.B_11_as_printed": (found.amplitude_as_printed, "mm"),
    }
    return values


def _sound(session: Session, trial: Trial, motion: MarkerMotion, placed: Placed) -> Values:
    """Sides of the window from the markers' motion; tension of a membrane that takes the peak force at its depth."""
    if motion.block is None:
        return {}
    depths = _depth(trial, motion)
    largest = maximum_radius(motion.time, motion.radius_nine)
    depth = float(depths[largest.frame])
    if depth <= 0.0:
        raise InputError("the radius is largest where the tool does not touch: nothing moved in this film")
    force = float(np.interp(largest.time, trial.table.time, trial.table.force))
    layers = session.setup(trial)[0].layers
    hole, tool = trial.support.hole_radius or 3.0 * trial.tool.radius, trial.tool.radius
    tension = force * math.log(hole / tool) / (2.0 * math.pi * depth)
    mass = sum(layer.density * layer.thickness for layer in layers)
    thickness = sum(layer.thickness for layer in layers)
    nine = motion.block.nine
    found = sound_variables(
        motion.rest[nine],
        placed(motion, depths)[largest.frame][nine],
        largest.radius,
        depth,
        math.sqrt(max(tension / mass, 0.0)),
        thickness,
    )
    return {
        "sound.d": (1e3 * found.d, "mm"),
        "sound.a": (1e3 * found.a, "mm"),
        "sound.b": (1e3 * found.b, "mm"),
        "sound.c": (found.c, "m/s"),
        "sound.lambda_11": (found.wave_number, "1/s"),
        "sound.B_11": (1e3 * found.amplitude, "mm"),
    }
