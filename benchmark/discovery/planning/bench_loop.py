"""The closed loop: the experiment that best separates the rivals, done on the bench, its trials added, decided again.

A new measurement may rule a rival out in two ways. Both rivals are fitted to the trials of the new condition, too: one
that foretells trials far worse than before is out, if enough was promised: rivals that are little apart may be taken
for each other by what their forms miss of the true one. A rigid block in the specimen's place measures the rig's give
itself: where there is none, the rival that needs it is out; where it is as large as that rival says, the others are.
What the bench records is added to a copy of the session; the session itself stays as it is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.evidence.gains import held_out, held_out_conditions
from benchmark.discovery.planning.bench_work import Bench
from benchmark.discovery.planning.proposing import (
    BLOCK,
    DEPTH_READ,
    LEAST_GIVE,
    MEASURED,
    RULER,
    SURE_OF_GIVE,
    Allowed,
    measured,
    parted,
)
from benchmark.discovery.planning.rivals import Rival, nearest, rivals
from benchmark.discovery.report.discovery_record import NextExperiment, Round
from benchmark.discovery.workflow import Findings, without_ruled_out
from benchmark.errors import DeviceError, InputError, SolverError
from benchmark.files.sessions.trials import read_table
from reports import write_text

Decide = Callable[[Path, frozenset[str]], Findings]
"""The discovery of a session without effects that were ruled out."""
Propose = Callable[[Findings, Allowed], NextExperiment | None]


@dataclass
class Loop:
    """The rounds so far, what they ruled out, and the error with which the bench ended them before their time."""

    bench: Bench
    budget: int
    decide: Decide
    propose: Propose
    rounds: list[Round] = field(default_factory=list)
    measured: list[str] = field(default_factory=list)
    leads: dict[tuple[tuple[str, ...], ...], Leads] = field(default_factory=dict)
    promised: dict[tuple[tuple[str, ...], ...], float] = field(default_factory=dict)
    out: frozenset[str] = frozenset()
    stopped: DeviceError | InputError | SolverError | None = None

    def run(self) -> Findings:
        """Go round until one name stands, nothing can be proposed, the budget or the bench ends; the last answer.

        What an experiment that fails has entered into the session is taken out again; its files stay.
        """
        found = self.decide(self.bench.folder, self.out)
        done = {RULER}  # nothing of a loop reads a picture
        while len(self.rounds) < self.budget:
            proposal = self.propose(found, self.bench.allowed(done))
            if proposal is None or not self.bench.ready(proposal):
                return found
            done.add(proposal.choice)
            entered = self.bench.folder / "session.toml"
            before = entered.read_text(encoding="utf-8")
            try:
                found = self._round(found, proposal)
            except (DeviceError, InputError, SolverError) as error:
                write_text(entered, before)
                self.stopped = error
                return found
        return found

    def _round(self, found: Findings, proposal: NextExperiment) -> Findings:
        standing = rivals(found)
        number = len(self.rounds) + 1
        separation: float | None
        if proposal.choice == BLOCK:
            files = self.bench.record(proposal, proposal.trials, number)
            separation, lost = judged_by_block(standing, files[0])
            found = without_ruled_out(found, lost) if lost else found
        else:
            self.bench.add(proposal, self.bench.record(proposal, proposal.trials, number))
            found, separation, lost = self._decided(found, standing, proposal)
        self.out |= lost
        self.rounds.append(
            Round(
                rivals=proposal.rivals,
                choice=proposal.choice,
                words=proposal.words,
                separation_now=proposal.separation_now,
                expected=proposal.separation,
                found=separation,
                trials=proposal.trials,
                minutes=proposal.minutes,
                ruled_out=tuple(sorted(lost)),
                verdict=found.discovery.verdict,
                answer=tuple(effect.slug for effect in found.discovery.effects),
                remaining=len(rivals(found)),
            )
        )
        return found

    def _decided(
        self, found: Findings, standing: tuple[Rival, ...], proposal: NextExperiment
    ) -> tuple[Findings, float | None, frozenset[str]]:
        """The answer with the new trials, how far apart they set the rivals, and what they rule out.

        Trials that show what was not looked for before rule nothing out: it was no rival.
        """
        if proposal.opens:
            self.measured.append(proposal.choice)
            return self.decide(self.bench.folder, self.out), None, frozenset()
        two = tuple(sorted(nearest(standing), key=lambda rival: rival.slugs))  # one pair, whichever is first now
        pair = _apart(two)
        if pair not in self.leads:
            self.leads[pair] = leads(found, two) or {}
        self.promised[pair] = math.hypot(self.promised.get(pair, 0.0), proposal.separation)
        self.measured.append(proposal.choice)
        found = self.decide(self.bench.folder, self.out)
        separation, lost = judged_by_trials(found, two, self.measured, self.leads[pair])
        if self.promised[pair] < criteria.PROMISED:
            lost = frozenset()
        if lost:
            found = self.decide(self.bench.folder, self.out | lost)
        return found, separation, lost


def judged_by_block(standing: Sequence[Rival], trial: Path) -> tuple[float, frozenset[str]]:
    """Separation in standard deviations, and the slugs that the rig's own give rules out.

    Raises
    ------
    InputError
        The block was not pressed, or no rival says that the rig gives way.
    """
    pair = parted(standing, BLOCK)
    if pair is None:
        raise InputError(f"{trial.name}: a rigid block tells nothing of what is in question")
    said = measured(pair[0], BLOCK)
    give, error = rigs_give(trial)
    distance = (give - LEAST_GIVE * said) / error
    slug = MEASURED[BLOCK][0]
    lost, apart = (frozenset({slug}), said - give) if distance < 0.0 else (_without(standing, slug), give)
    return apart / error, lost if abs(distance) >= SURE_OF_GIVE else frozenset()


def _without(standing: Sequence[Rival], slug: str) -> frozenset[str]:
    """What the rivals that lack an effect have in its place."""
    having = {each for rival in standing if slug in rival.slugs for each in rival.slugs}
    return frozenset(
        each for rival in standing if slug not in rival.slugs for each in rival.slugs if each not in having
    )


def rigs_give(trial: Path) -> tuple[float, float]:
    """Give of the rig against a rigid block and its standard deviation, m/N: depth over force while it is pressed.

    Raises
    ------
    InputError
        The block was not pressed.
    """
    table = read_table(trial)
    peak = int(np.argmax(table.force))
    rows = slice(0, peak + 1)
    pressed = table.force[rows] > 0.1 * table.force[peak]
    force, depth = table.force[rows][pressed], table.depth[rows][pressed]
    if force.size < 3 or np.ptp(force) <= 0.0:
        raise InputError(f"{trial.name}: the rigid block was not pressed")
    slope = float(np.polyfit(force, depth, 1)[0])
    return slope, DEPTH_READ / float(np.ptp(force))


Leads: TypeAlias = dict[tuple[str, str], float]
"""By how much the first of two rivals foretells a trial, by condition and name, better than the second: log density."""


def leads(found: Findings, standing: tuple[Rival, ...]) -> Leads | None:
    """What each trial says for the first of two rivals, each fitted to all others; None where one was not fitted."""
    fits = _fits_of(found, standing)
    if fits is None:
        return None
    first, second = fits
    problem = first.model.problem
    names = [one.name for one in problem.study.conditions]
    each = held_out(first) - held_out(second)
    return {(names[t.condition], t.name): float(lead) for t, lead in zip(problem.trials, each, strict=True)}


def judged_by_trials(
    found: Findings, standing: tuple[Rival, ...], measured: Sequence[str], before: Leads
) -> tuple[float | None, frozenset[str]]:
    """Separation by what all trials say for a rival beyond what they said before, and the slugs that lose by it.

    What an experiment promises is how far apart the rivals are once both are fitted to all trials
    (`rivals.separation`), and that is what is counted: an old trial speaks, too, against a rival that had to give way
    to the new ones. A rival is out where all trials together speak decisively against it, half of that without the one
    that speaks most, and the winner foretells the new conditions, each from all others: it falls short of their trials
    one by one by less than they speak for it, or by less than half of what the loser does.
    """
    after, fits = leads(found, standing), _fits_of(found, standing)
    if after is None or fits is None:
        return None, frozenset()
    told = np.array([lead - before.get(trial, 0.0) for trial, lead in after.items()])
    total = float(told.sum())
    order = (0, 1) if total > 0.0 else (1, 0)
    winner, loser = (standing[place] for place in order)
    others = abs(total) - float(np.max(np.sign(total) * told))
    missed, theirs = (_short(fits[place], measured) for place in order)
    foretells = abs(total) >= missed or theirs >= 2.0 * missed + criteria.DECISIVE
    sure = foretells and abs(total) >= criteria.DECISIVE and others >= 0.5 * criteria.DECISIVE
    lost = frozenset(set(loser.slugs) - set(winner.slugs)) if sure else frozenset()
    return math.sqrt(2.0 * abs(total)), lost


def _short(fit: Fit, measured: Sequence[str]) -> float:
    """By how much a fit foretells new conditions worse than their trials one by one, log density."""
    names = [one.name for one in fit.model.problem.study.conditions]
    new = np.array([names[trial.condition] in measured for trial in fit.model.problem.trials])
    return float(np.sum((held_out(fit) - held_out_conditions(fit))[new]))


def _apart(standing: Sequence[Rival]) -> tuple[tuple[str, ...], ...]:
    """What each of two rivals has that the other has not."""
    shared = set.intersection(*(set(rival.slugs) for rival in standing))
    return tuple(tuple(slug for slug in rival.slugs if slug not in shared) for rival in standing)


def _fits_of(found: Findings, standing: Sequence[Rival]) -> tuple[Fit, Fit] | None:
    """The best fits to the grown session with the effects of two rivals; None where one was not made.

    Where the new trials have shown that something that both share is not there, both are meant without it.
    """
    chosen = found.selection
    fits: Iterator[Fit] = iter((chosen.chosen, *(fit for each in chosen.rivals.values() for fit in each)))
    made = [*fits, *(scored.fit for scored in chosen.candidates)]
    for pair in ([rival.slugs for rival in standing], _apart(standing)):
        same = [[fit for fit in made if {e.slug for e in fit.model.effects} == set(slugs)] for slugs in pair]
        if all(pair) and all(same):
            first, second = (min(each, key=lambda fit: fit.objective) for each in same)
            return first, second
    return None
