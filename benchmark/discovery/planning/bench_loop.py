"""The closed loop: the experiment that best separates the rivals, done on the bench, its trials added, decided again.

A new measurement may rule a rival out in two ways. The trials of the new condition are predicted by each rival from
the trials before: one that predicts them far worse is out. A rigid block in the specimen's place measures the rig's
give itself: where there is none, the rival that needs it is out; where it is as large as that rival says, the others
are. What the bench records is added to a copy of the session; the session itself stays as it is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.discovery_result import Array
from benchmark.discovery.evidence.gains import held_out, held_out_conditions
from benchmark.discovery.planning.bench_work import Bench
from benchmark.discovery.planning.proposing import DEPTH_READ, GIVES, Allowed
from benchmark.discovery.planning.rivals import Rival, rivals
from benchmark.discovery.report.discovery_record import NextExperiment, Round
from benchmark.discovery.workflow import Findings
from benchmark.errors import InputError
from benchmark.files.sessions.trials import read_table

BLOCK, RULER = "rigid block", "ruler image"

Decide = Callable[[Path, frozenset[str]], Findings]
"""The discovery of a session without effects that were ruled out."""
Propose = Callable[[Findings, Allowed], NextExperiment | None]


@dataclass
class Loop:
    """The rounds so far and what they ruled out."""

    bench: Bench
    budget: int
    decide: Decide
    propose: Propose
    rounds: list[Round] = field(default_factory=list)
    measured: list[str] = field(default_factory=list)
    out: frozenset[str] = frozenset()

    def run(self) -> Findings:
        """Go round until one name stands, nothing can be proposed, or the budget ends; the last answer."""
        found = self.decide(self.bench.folder, self.out)
        done = {RULER}  # nothing of a loop reads a picture
        while len(self.rounds) < self.budget:
            proposal = self.propose(found, self.bench.allowed(done))
            if proposal is None or not self.bench.ready(proposal):
                return found
            done.add(proposal.choice)
            found = self._round(found, proposal)
        return found

    def _round(self, found: Findings, proposal: NextExperiment) -> Findings:
        standing = rivals(found)[:2]
        number = len(self.rounds) + 1
        separation: float | None
        if proposal.choice == BLOCK:
            files = self.bench.record(proposal, 1, number)
            separation, lost = judged_by_block(standing, files[0])
        else:
            count = max(each.size for each in found.calibrated.base.model.problem.study.conditions)
            self.bench.add(proposal, self.bench.record(proposal, count, number))
            self.measured.append(proposal.choice)
            found = self.decide(self.bench.folder, self.out)
            separation, lost = judged_by_prediction(found, standing, self.measured)
        if lost:
            self.out |= lost
            found = self.decide(self.bench.folder, self.out)
        self.rounds.append(
            Round(
                rivals=proposal.rivals,
                choice=proposal.choice,
                words=proposal.words,
                separation_now=proposal.separation_now,
                expected=proposal.separation,
                found=separation,
                minutes=proposal.minutes,
                ruled_out=tuple(sorted(lost)),
                verdict=found.discovery.verdict,
                answer=tuple(effect.slug for effect in found.discovery.effects),
                remaining=len(rivals(found)),
            )
        )
        return found


HALF = 0.5
"""A rig that gives way by less than this share of what a rival says is not what the rival says."""
SURE_OF_GIVE = 3.0
"""Standard deviations by which a measured give must lie on one side of that."""


def judged_by_block(standing: tuple[Rival, ...], trial: Path) -> tuple[float, frozenset[str]]:
    """Separation in standard deviations, and the slugs that the rig's own give rules out."""
    slug, name = next(iter(GIVES.items()))
    said = next(float(rival.values[slug][name]) for rival in standing if slug in rival.slugs)
    give, error = rigs_give(trial)
    distance = (give - HALF * said) / error
    if abs(distance) < SURE_OF_GIVE:
        return abs(distance) / HALF, frozenset()
    lost = frozenset({slug}) if distance < 0.0 else _without(standing, slug)
    return abs(distance) / HALF, lost


def _without(standing: tuple[Rival, ...], slug: str) -> frozenset[str]:
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


def judged_by_prediction(
    found: Findings, standing: tuple[Rival, ...], measured: Sequence[str]
) -> tuple[float | None, frozenset[str]]:
    """Separation by what each rival predicts of new conditions, each from all others, and the slugs that lose by it.

    A rival is out where the trials of the new conditions together speak decisively against it, half of that without
    the one that speaks most, and by more than the winner itself falls short of what it would say having seen them.
    """
    fits = [_fit_of(found, rival) for rival in standing]
    if any(fit is None for fit in fits):
        return None, frozenset()
    first, second = (fit for fit in fits if fit is not None)
    lead = _predicted(first, measured) - _predicted(second, measured)
    total = float(lead.sum())
    winner, loser = (first, standing[1]) if total > 0.0 else (second, standing[0])
    most = float(np.max(np.sign(total) * lead))
    short = float(np.sum(_of(winner, measured, held_out(winner)) - _predicted(winner, measured)))
    sure = abs(total) >= max(criteria.DECISIVE, short) and abs(total) - most >= 0.5 * criteria.DECISIVE
    other = standing[0] if loser is standing[1] else standing[1]
    lost = frozenset(set(loser.slugs) - set(other.slugs)) if sure else frozenset()
    return math.sqrt(2.0 * abs(total)), lost


def _fit_of(found: Findings, rival: Rival) -> Fit | None:
    """The best fit to the grown session with a rival's effects; None where none was made."""
    chosen = found.selection
    fits: Iterator[Fit] = iter((chosen.chosen, *(fit for each in chosen.rivals.values() for fit in each)))
    made = [*fits, *(scored.fit for scored in chosen.candidates)]
    same = [fit for fit in made if {effect.slug for effect in fit.model.effects} == set(rival.slugs)]
    return min(same, key=lambda fit: fit.objective, default=None)


def _predicted(fit: Fit, measured: Sequence[str]) -> Array:
    return _of(fit, measured, held_out_conditions(fit))


def _of(fit: Fit, measured: Sequence[str], each: Array) -> Array:
    """The entries (R,) of some conditions' trials."""
    names = [one.name for one in fit.model.problem.study.conditions]
    return np.asarray(each[[names[trial.condition] in measured for trial in fit.model.problem.trials]])
