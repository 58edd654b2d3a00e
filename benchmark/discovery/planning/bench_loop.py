"""The closed loop: the experiment that best separates the rivals, done on the bench, its trials added, decided again.

A new measurement may rule a rival out in two ways. The trials of the new condition are predicted by each rival from
the trials before: one that predicts them far worse is out. A rigid block in the specimen's place measures the rig's
give itself: where there is none, the rival that needs it is out; where it is as large as that rival says, the others
are. What the bench records is added to a copy of the session; the session itself stays as it is.
"""

from __future__ import annotations

import math
import shutil
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from bench_hw.capture.order import CaptureOrder
from bench_hw.capture.progress import Silent
from bench_hw.capture.session import capture
from bench_hw.errors import BenchError
from bench_hw.motion.protocol_file import load_protocol
from bench_hw.rig.opening import sheet_of, specimen_of
from bench_hw.rig.rig_file import LoadedRig, load_rig
from bench_hw.storage.folder_lock import scratch
from bench_hw.trial_file import read_trial_mcap
from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.discovery_result import Array
from benchmark.discovery.evidence.gains import held_out, held_out_conditions
from benchmark.discovery.planning.proposing import DEPTH_READ, GIVES, Allowed
from benchmark.discovery.planning.rivals import Rival, rivals
from benchmark.discovery.report.discovery_record import NextExperiment, Round
from benchmark.discovery.workflow import Findings
from benchmark.errors import DeviceError, InputError
from reports import write_text

Asked = Callable[[NextExperiment, Mapping[str, Any]], bool]
"""Shows a person what must be done by hand first; whether it was done."""
BLOCK = "rigid block"


def unattended(proposal: NextExperiment, setup: Mapping[str, Any]) -> bool:  # noqa: ARG001 - as a person is asked
    """Nobody is there to do anything by hand."""
    return False


def load_bench(name: str) -> LoadedRig:
    """Read a rig file, or the shipped rig of that name.

    Raises
    ------
    InputError
        There is none, or it says something that is not allowed.
    """
    try:
        return load_rig(name)
    except BenchError as error:
        raise InputError(f"--bench: {error}") from None


@dataclass(frozen=True)
class BenchWork:
    """A bench that the loop may use.

    Attributes
    ----------
    rig : LoadedRig
    folder : Path
        Of the copy of the session, which grows.
    asked
        Shows a person what must be done by hand first.
    seed : int
        Of simulated devices.
    """

    rig: LoadedRig
    folder: Path
    asked: Asked
    seed: int

    def allowed(self, done: set[str]) -> Allowed:
        """What the bench can do."""
        specimen, sheet = specimen_of(self.rig), sheet_of(self.rig)
        radii = None if specimen is None else tuple(1e-3 * tool.radius_mm for tool in specimen.file.tools)
        radii = radii if sheet is None else (sheet.table.tool_radius,)
        return Allowed(self.rig.rig.safety.force_limit, frozenset(done), radii)

    def record(self, proposal: NextExperiment, trials: int, number: int) -> tuple[Path, ...]:
        """Do an experiment; the files of its trials, which lie in the copy of the session.

        Raises
        ------
        DeviceError
            The bench ended with a fault.
        InputError
            The bench cannot do it.
        """
        with scratch() as folder:
            protocol = folder / "next_experiment.toml"
            write_text(protocol, proposal.toml)
            loaded = load_protocol(protocol)
            specimen = specimen_of(self.rig)
            under = None if specimen is None else specimen.with_setup(loaded.protocol.setup)
            order = CaptureOrder(
                loaded,
                self.rig,
                folder / "session",
                trials,
                condition=proposal.choice,
                fast=self.rig.rig.all_simulated,
                seed=self.seed + 1000 * number,
            )
            outcome = _captured(order, under)
            return tuple(
                Path(shutil.copyfile(file, self.folder / f"experiment_{number}_{place}.mcap"))
                for place, file in enumerate(outcome, 1)
            )

    def add(self, proposal: NextExperiment, files: tuple[Path, ...]) -> None:
        """Enter trials into the session file of the copy, with the tool they were made with."""
        import tomli_w

        path = self.folder / "session.toml"
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        table["trials"] += [{"file": file.name, "condition": proposal.choice} for file in files]
        radius = tomllib.loads(proposal.toml).get("setup", {}).get("tool_radius")
        if radius is not None:
            table.setdefault("conditions", {})[proposal.choice] = {"tool": {**table.get("tool", {}), "radius": radius}}
        write_text(path, tomli_w.dumps(table))


def _captured(order: CaptureOrder, specimen: Any) -> tuple[Path, ...]:
    try:
        outcome = capture(order, Silent(), specimen=specimen)
    except BenchError as error:
        raise InputError(f"--bench: {error}") from None
    if outcome.fault is not None:
        raise DeviceError(f"--bench: {outcome.fault.message}")
    return outcome.trials


def session_copy(session: Path, folder: Path) -> Path:
    """Copy a session with a session.toml to a folder that will grow.

    Raises
    ------
    InputError
        It has no session.toml: a tool under which new trials are made must be known.
    """
    if not (session / "session.toml").is_file():
        raise InputError(f"{session}: --bench needs a session.toml that says what was pressed with what")
    if folder.exists():
        shutil.rmtree(folder)
    try:
        shutil.copytree(session, folder)
    except OSError:  # a part of a session is of no use
        shutil.rmtree(folder, ignore_errors=True)
        raise
    return folder


Decide = Callable[[Path, frozenset[str]], Findings]
"""The discovery of a session without effects that were ruled out."""
Propose = Callable[[Findings, Allowed], NextExperiment | None]


@dataclass
class Loop:
    """The rounds so far and what they ruled out."""

    bench: BenchWork
    budget: int
    decide: Decide
    propose: Propose
    rounds: list[Round] = field(default_factory=list)
    out: frozenset[str] = frozenset()

    def run(self) -> Findings:
        """Go round until one name stands, nothing can be proposed, or the budget ends; the last answer."""
        found = self.decide(self.bench.folder, self.out)
        done: set[str] = set()
        while len(self.rounds) < self.budget:
            proposal = self.propose(found, self.bench.allowed(done))
            if proposal is None or not self._done_by_hand(proposal):
                return found
            done.add(proposal.choice)
            found = self._round(found, proposal)
        return found

    def _done_by_hand(self, proposal: NextExperiment) -> bool:
        setup = tomllib.loads(proposal.toml).get("setup", {})
        return not setup or self.bench.rig.rig.all_simulated or self.bench.asked(proposal, setup)

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
            found = self.decide(self.bench.folder, self.out)
            separation, lost = judged_by_prediction(found, standing, proposal.choice)
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
    table = read_trial_mcap(trial)
    peak = int(np.argmax(table.force))
    rows = slice(0, peak + 1)
    pressed = table.force[rows] > 0.1 * table.force[peak]
    force, depth = table.force[rows][pressed], table.depth[rows][pressed]
    if force.size < 3 or np.ptp(force) <= 0.0:
        raise InputError(f"{trial.name}: the rigid block was not pressed")
    slope = float(np.polyfit(force, depth, 1)[0])
    return slope, DEPTH_READ / float(np.ptp(force))


def judged_by_prediction(
    found: Findings, standing: tuple[Rival, ...], condition: str
) -> tuple[float | None, frozenset[str]]:
    """Separation by what each rival predicts of a condition from the others, and the slugs that lose by it.

    A rival is out where every trial of the condition speaks against it, they do so decisively together, and by more
    than the winner itself falls short of what it would say having seen the condition.
    """
    fits = [_fit_of(found, rival) for rival in standing]
    if any(fit is None for fit in fits):
        return None, frozenset()
    first, second = (fit for fit in fits if fit is not None)
    lead = _predicted(first, condition) - _predicted(second, condition)
    total = float(lead.sum())
    separation = math.sqrt(2.0 * abs(total))
    winner, loser = (first, standing[1]) if total > 0.0 else (second, standing[0])
    short = float(np.sum(_of(winner, condition, held_out(winner)) - _predicted(winner, condition)))
    sure = bool((lead > 0.0).all() or (lead < 0.0).all()) and abs(total) >= max(criteria.DECISIVE, short)
    other = standing[0] if loser is standing[1] else standing[1]
    return separation, frozenset(set(loser.slugs) - set(other.slugs)) if sure else frozenset()


def _fit_of(found: Findings, rival: Rival) -> Fit | None:
    """The best fit to the grown session with a rival's effects; None where none was made."""
    chosen = found.selection
    fits: Iterator[Fit] = iter((chosen.chosen, *(fit for each in chosen.rivals.values() for fit in each)))
    made = [*fits, *(scored.fit for scored in chosen.candidates)]
    same = [fit for fit in made if {effect.slug for effect in fit.model.effects} == set(rival.slugs)]
    return min(same, key=lambda fit: fit.objective, default=None)


def _predicted(fit: Fit, condition: str) -> Array:
    return _of(fit, condition, held_out_conditions(fit))


def _of(fit: Fit, condition: str, each: Array) -> Array:
    """The entries (R,) of a condition's trials."""
    names = [one.name for one in fit.model.problem.study.conditions]
    return np.asarray(each[[names[trial.condition] == condition for trial in fit.model.problem.trials]])
