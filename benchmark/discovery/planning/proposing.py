"""Which experiment separates the rivals of a discovery, weighed by separation per minute at the bench."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from bench_hw.motion.protocol_file import MOST_FORCE
from benchmark.child_processes import mapping
from benchmark.discovery import criteria
from benchmark.discovery.answer.verdict import NOTHING
from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.evidence.shortlist import unseen
from benchmark.discovery.planning.rivals import Rival, expected, nearest, rivals, separation, under
from benchmark.discovery.report.discovery_record import NextExperiment
from benchmark.discovery.trials.study import ConditionData
from benchmark.discovery.workflow import Findings
from benchmark.errors import InputError, TissuebenchError
from benchmark.experiments.menu import (
    SECOND_TOOLS,
    Experiment,
    Usual,
    menu,
    minutes,
    motion,
    protocol_toml,
    rigid_block,
    ruler_image,
    same_again,
    second_tools,
    shallower,
)
from benchmark.files import Setup
from benchmark.physics.description import Sign
from benchmark.response.elastic_table import ElasticTable, TableOf

ROWS = 400
"""Rows of a trial on which rivals are compared: about what a trial's autocorrelated samples are worth at most."""
DEPTH_READ, BLOCK_TIMES = 0.02e-3, 10.0
"""Standard deviation with which a rig's give under a rigid block is taken to be read, m, and how many times harder than
the specimen the block is pressed: a give is read as well under a large force as under a small one."""
RULER_READ = 2e-3
"""Relative standard deviation of a scale read off a ruler's picture."""
LEAST_GIVE = 1.0 / 3.0
"""A rig that gives way by less than this share of what a rival says is not what the rival says.

It may well be less than one: bearings give way more under small loads than under large ones, and a block is pressed
harder than a specimen.
"""
SURE_OF_GIVE = 3.0
"""Standard deviations by which a measured give must lie on one side of that."""


@dataclass(frozen=True)
class Allowed:
    """What may be proposed.

    Attributes
    ----------
    most_force : float
        Largest press of the specimen, N.
    done : set of str
        Entries of the menu that were done already.
    radii : tuple of float or None
        Radii of the tools that are there, m; None: any.
    rig_force : float
        Largest force that the rig bears, N.
    """

    most_force: float = math.inf
    done: AbstractSet[str] = frozenset()
    radii: tuple[float, ...] | None = None
    rig_force: float = math.inf


ANYTHING = Allowed()
SPARE = 0.8
"""Of the rig's force limit, beyond which no press is proposed."""


def propose(
    found: Findings,
    table_of: TableOf | None = None,
    allowed: Allowed = ANYTHING,
    workers: int = 1,
) -> NextExperiment | None:
    """Return the experiment that separates the answer from its nearest look-alike; None where there is none.

    Where trials disagree with the model and something was not looked for that another motion shows, that motion comes
    first (`opening`): among causes of which the true one may be missing there is nothing to choose.

    Entries that a model cannot follow are left out of the menu, and so are those that tell no more than as many trials
    of the session's own press would. They are weighed by as many trials as a condition of the session has, but by no
    more than a test of trials needs: the rivals may be told apart by one. Of those that promise to decide the one that
    tells most a minute is taken, a calibration before all: it measures what trials tell by the forms of effects only.
    Where none promises to decide, the one that promises most.

    Parameters
    ----------
    found
        A discovery with its fits.
    table_of
        The elastic answer of a specimen under a tool; without it no second tool is proposed.
    allowed
        What may be proposed.
    workers
        Processes that work out the elastic answers under other tools; with more than one, `table_of` can be pickled.
    """
    standing = rivals(found)
    conditions = found.calibrated.base.model.problem.study.conditions
    allowed = replace(allowed, done=allowed.done | _there(conditions))
    condition = _own_condition(conditions, allowed.done)
    shows = opening(found, standing, condition, allowed)
    if shows is not None or len(standing) < 2:
        return shows
    first, second = nearest(standing)
    seen = _with_this_tool(first, second, condition, allowed)
    if table_of is not None:
        seen |= _tools(first, second, condition, table_of, allowed, workers)
    seen |= _calibrations(standing, condition, allowed.rig_force)
    few = min(condition.size, criteria.ENOUGH_TRIALS)
    again = seen.pop(SAME, (None, 0.0))[1]
    entries = [_Entry(experiment, size, few) for name, (experiment, size) in seen.items() if name not in allowed.done]
    weighed = [each for each in entries if each.separation(few) > again * math.sqrt(few)]
    if not weighed:
        return None
    deciding = [each for each in weighed if each.decides]
    best = max(deciding, key=lambda each: (each.once, each.rate()), default=max(weighed, key=_Entry.promise))
    if best.once:
        first, second = sorted(parted(standing, best.experiment.name) or (), key=standing.index)
    return NextExperiment(
        rivals=(_distinct(first, second), _distinct(second, first)),
        choice=best.experiment.name,
        words=best.experiment.words,
        separation_now=again * math.sqrt(condition.size),
        separation=best.promise(),
        minutes=best.minutes(best.trials),
        menu={each.experiment.name: (each.separation(few), each.minutes(few)) for each in weighed},
        toml=protocol_toml(best.experiment),
        trials=best.trials,
    )


BRINGS: Mapping[str, frozenset[Sign]] = {
    "longer hold": frozenset({"hold"}),
    "slower": frozenset({"second_rate"}),
    "faster": frozenset({"second_rate"}),
}
"""Signs that entries of the menu have beside `RETURN`, which each of them has."""
RETURN: frozenset[Sign] = frozenset({"unloading", "lift_off"})


def opening(
    found: Findings, standing: Sequence[Rival], condition: ConditionData, allowed: Allowed
) -> NextExperiment | None:
    """The experiment that shows most of what was not looked for; None where trials agree, or where none shows any.

    Of several the first of the menu, a hold: a memory shows in it at all its times.
    """
    study = found.calibrated.base.model.problem.study
    hidden = () if found.discovery.verdict in NOTHING else unseen(study, found.known)
    best: tuple[Experiment, tuple[str, ...]] | None = None
    for experiment in menu(usual_press(condition)) if hidden else ():
        left = unseen(study, found.known, RETURN | BRINGS.get(experiment.name, frozenset()))
        shows = tuple(slug for slug in hidden if slug not in left)
        if experiment.name in allowed.done or len(shows) <= (0 if best is None else len(best[1])):
            continue
        if _simulated(standing[0], standing[-1], condition, experiment, allowed.most_force) is not None:
            best = experiment, shows
    if best is None:
        return None
    (experiment, shows), trials = best, min(condition.size, criteria.ENOUGH_TRIALS)
    return NextExperiment(
        rivals=("+".join(standing[0].slugs) or "none", "+".join(shows)),
        choice=experiment.name,
        words=experiment.words,
        separation_now=math.nan,
        separation=math.nan,
        minutes=minutes(experiment, trials),
        menu={},
        toml=protocol_toml(experiment),
        trials=trials,
        opens=shows,
    )


def _there(conditions: Sequence[ConditionData]) -> set[str]:
    """Entries of the menu that a session has a condition of, as one that a loop has grown: none is entered again.

    The session's own press may have changed since, and a condition holds trials of one motion.
    """
    entries = {*SECOND_TOOLS, *(each.name for each in menu(Usual(1e-3, 1e-3, 0.0, math.inf)))}
    return {each.name for each in conditions if each.name in entries or each.name.startswith("tool of ")}


def _own_condition(conditions: Sequence[ConditionData], done: AbstractSet[str]) -> ConditionData:
    """The largest of a session's own conditions, from which experiments differ: none of those that a loop has added."""
    own = [each for each in conditions if each.name not in done]
    return max(own or conditions, key=lambda each: each.size)


@dataclass(frozen=True)
class _Entry:
    """An entry of the menu: the separation by one trial of it, and the trials that are usual."""

    experiment: Experiment
    alone: float
    usual: int

    @property
    def once(self) -> bool:
        """Whether it is a calibration, which is not repeated."""
        return self.experiment.name in MEASURED

    @property
    def trials(self) -> int:
        """As many as are to decide."""
        return 1 if self.once else enough_trials(self.usual, self.separation(self.usual))

    @property
    def decides(self) -> bool:
        """Whether so many trials promise as much as rules a rival out."""
        return self.promise() >= (SURE_OF_GIVE / LEAST_GIVE if self.once else criteria.PROMISED)

    def promise(self) -> float:
        """Separation by so many, standard deviations."""
        return self.separation(self.trials)

    def rate(self) -> float:
        """What the usual trials tell a minute: squared separation over bench time."""
        return self.separation(self.usual) ** 2 / self.minutes(self.usual)

    def separation(self, trials: int) -> float:
        """Of the rivals by so many trials, standard deviations."""
        return self.alone if self.once else self.alone * math.sqrt(trials)

    def minutes(self, trials: int) -> float:
        """At the bench."""
        return minutes(self.experiment, 1 if self.once else trials)


def enough_trials(usual: int, size: float) -> int:
    """Trials by which an experiment decides, whose rivals are `size` standard deviations apart in the usual number."""
    wanted = math.ceil(usual * (criteria.PROMISED / max(size, 1e-9)) ** 2)
    return min(max(wanted, usual), criteria.MOST_TIMES * usual)


Seen: TypeAlias = dict[str, tuple[Experiment, float]]
"""Name to experiment, and separation in standard deviations by one trial of it."""
SAME, BLOCK, RULER = "same again", "rigid block", "ruler image"
MEASURED = {BLOCK: ("machine_compliance", "compliance"), RULER: ("marker_scale_error", "error")}
"""Calibrations, with the effect and the parameter that each measures."""


def _with_this_tool(first: Rival, second: Rival, condition: ConditionData, allowed: Allowed) -> Seen:
    """The entries that can be done with the tool in place."""
    usual = usual_press(condition)
    out: Seen = {}
    for experiment in (same_again(usual), *menu(usual)):
        size = _simulated(first, second, condition, experiment, allowed.most_force)
        if size is not None:
            out[experiment.name] = (experiment, size)
    return out


def _tools(
    first: Rival, second: Rival, condition: ConditionData, table_of: TableOf, allowed: Allowed, workers: int
) -> Seen:
    """Other tools, each with the elastic answer of the specimen under it."""
    usual, radius = usual_press(condition), condition.tool.radius
    wanted = second_tools(usual, radius, allowed.radii)
    experiments = [each for each in wanted if each.name not in allowed.done]
    tools = [condition.tool.model_copy(update={"radius": each.tool_radius}) for each in experiments]
    specimen, _, support = condition.setup
    jobs = [(table_of, (specimen, tool, support), condition.around.peak_depth) for tool in tools]
    with mapping(min(workers, len(jobs))) as mapped:
        tables = list(mapped(_table_under, jobs))
    out: Seen = {}
    for experiment, tool, table in zip(experiments, tools, tables, strict=True):
        if table is None:
            continue
        pair = [under(rival, condition.name, tool, table) for rival in (first, second)]
        depth = _bearable(pair[0], condition, experiment, allowed.most_force)
        borne = experiment if depth is None else shallower(usual, radius, experiment, depth)
        size = _simulated(pair[0], pair[1], condition, borne, allowed.most_force)
        if size is not None:
            out[experiment.name] = (borne, size)
    return out


def _bearable(rival: Rival, condition: ConditionData, experiment: Experiment, most_force: float) -> float | None:
    """Depth, m, at which a rival expects as much force as may be proposed; None where the experiment stays below it."""
    if math.isinf(most_force):
        return None
    time, depth = motion(experiment, ROWS)
    try:
        force = expected(rival, condition.name, time, depth).signals[:, 0]
    except (InputError, ValueError, ArithmeticError):
        return None
    first = int(np.argmax(force > SPARE * most_force))
    if first == 0:
        return None
    return float(np.interp(SPARE * most_force, force[first - 1 : first + 1], depth[first - 1 : first + 1]))


def _table_under(job: tuple[TableOf, Setup, float]) -> ElasticTable | None:
    """The elastic answer under a tool; None where there is none."""
    table_of, setup, depth = job
    try:
        return table_of(*setup, depth)
    except TissuebenchError:
        return None


def _simulated(
    first: Rival, second: Rival, condition: ConditionData, experiment: Experiment, most_force: float
) -> float | None:
    """Separation by one trial; None where a model does not follow the motion, or the force is too large."""
    time, depth = motion(experiment, ROWS)
    try:
        a = expected(first, condition.name, time, depth)
        size = separation(
            a.signals,
            lambda vector: expected(second, condition.name, time, depth, vector).signals,
            second.vector,
            second.covariance,
            a.noise,
            time,
        )
    except (InputError, ValueError, ArithmeticError):
        return None
    if float(a.signals[:, 0].max()) > SPARE * most_force or not math.isfinite(size):
        return None
    return math.sqrt(size)


def _calibrations(standing: Sequence[Rival], condition: ConditionData, most_force: float = math.inf) -> Seen:
    """Measurements of the instrument alone, where only some of the rivals say that there is something to see."""
    force = min(BLOCK_TIMES * float(condition.around.peak_force), SPARE * most_force, MOST_FORCE)
    read = ((rigid_block(force), force / DEPTH_READ), (ruler_image(), 1.0 / RULER_READ))
    out: Seen = {}
    for experiment, precision in read:
        pair = parted(standing, experiment.name)
        said = 0.0 if pair is None else measured(pair[0], experiment.name)
        if said:
            out[experiment.name] = (experiment, abs(said) * precision)
    return out


def parted(standing: Sequence[Rival], calibration: str) -> tuple[Rival, Rival] | None:
    """The nearest rivals with and without the effect that a calibration measures; None where all have it, or none."""
    slug, _ = MEASURED[calibration]
    having = [rival for rival in standing if slug in rival.slugs]
    lacking = [rival for rival in standing if slug not in rival.slugs]
    return (having[0], lacking[0]) if having and lacking else None


def measured(rival: Rival, calibration: str) -> float:
    """What a rival says that a calibration measures."""
    slug, name = MEASURED[calibration]
    return float(rival.values[slug][name])


def usual_press(condition: ConditionData) -> Usual:
    """What the trials of a condition did: depth, speed while loading, time held."""
    time, depth = np.median(condition.time, axis=0), np.median(condition.depth, axis=0)
    loading, holding = (_rows(condition, name) for name in ("load", "hold"))
    speeds = np.abs(np.diff(depth)) / np.maximum(np.diff(time), 1e-9)
    speed = float(np.median(speeds[loading[1:]])) if loading[1:].any() else 1e-3
    steps = np.diff(time, prepend=time[0])
    held = float(steps[holding].sum())
    limit = math.inf if condition.support.kind == "hole" else condition.around.thickness
    return Usual(float(depth.max()), max(speed, 1e-5), min(held, 3600.0), limit)


def _rows(condition: ConditionData, phase: str) -> np.ndarray:
    """(n,) whether a row is in a phase of the first press."""
    return np.asarray((condition.phase == PHASES.index(phase)) & (condition.cycle <= 1))


def _distinct(rival: Rival, other: Rival) -> str:
    """What a rival has that the other has not."""
    own = [slug for slug in rival.slugs if slug not in other.slugs]
    return "+".join(own or rival.slugs)
