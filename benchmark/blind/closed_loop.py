"""The closed loop on a blind case: a bench that does what is proposed on the true body with its hidden effects."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pandas as pd

from bench_hw.configuration import validated
from bench_hw.motion.plan import plan
from bench_hw.motion.protocol_file import Move, Protocol
from benchmark.blind.body.presses import DEEPEST
from benchmark.blind.cases import BlindCase, generator
from benchmark.blind.motion import Array, ReportedMotion, rounded
from benchmark.blind.session_files import DEPTH_SCATTER, write_trial
from benchmark.discovery import Settings
from benchmark.discovery.discovery_result import Discovery
from benchmark.discovery.planning.bench_loop import Loop
from benchmark.discovery.planning.bench_work import enter, session_copy
from benchmark.discovery.planning.proposing import BLOCK, DEPTH_READ, Allowed, propose
from benchmark.discovery.report.discovery_record import NextExperiment
from benchmark.discovery.workflow import Findings, findings
from benchmark.files.sessions.session_loading import load_session
from benchmark.files.units import LENGTH, parse_quantity
from benchmark.response.fem_table import fem_or_wave_table

BLOCK_ROWS = 200
SPARE_DEPTH = 1.1
"""Of the deepest press of session and protocol, to which a body is pressed under another tool.

Under wide ones the press finds no balance much deeper.
"""


@dataclass(frozen=True)
class HiddenBench:
    """The bench of a blind case's lab.

    Attributes
    ----------
    made : BlindCase
    folder : Path
        Of the copy of its session, which grows.
    """

    made: BlindCase
    folder: Path

    def allowed(self, done: set[str]) -> Allowed:
        """Any tool, and of the body as much force as it has been computed for."""
        deepest = float(self.made.scene.body.force(np.array([DEEPEST]))[0])
        return Allowed(deepest, frozenset(done))

    def ready(self, proposal: NextExperiment) -> bool:  # noqa: ARG002 - as a person is asked
        """Whatever must be done by hand is done."""
        return True

    def record(self, proposal: NextExperiment, trials: int, number: int) -> tuple[Path, ...]:
        """Do an experiment on the true body; the files of its trials."""
        rng = generator(self.made.name, f"experiment {number}")
        protocol = validated(Protocol, tomllib.loads(proposal.toml), proposal.choice)
        if proposal.choice == BLOCK:
            return (self._block(self.folder / f"block_{number}.csv", protocol, rng),)
        radius, made = protocol.setup.get("tool_radius"), self.made
        if radius is not None:
            depth = max(made.scene.scale.deep, *(step.depth_to for step in plan(protocol).steps))
            made = under_tool(made, parse_quantity(radius, LENGTH), min(SPARE_DEPTH * depth, DEEPEST))
        files = []
        for place in range(1000 * number + 1, 1000 * number + 1 + trials):
            moved = _motion(made, protocol, 1.0 + DEPTH_SCATTER * rng.uniform(-1.0, 1.0))
            write_trial(made, moved, self.folder, place, "", rng)
            files.append(self.folder / f"trial_{place:03d}.csv")
        return tuple(files)

    def add(self, proposal: NextExperiment, files: tuple[Path, ...]) -> None:
        """Enter trials with their markers into the session file of the copy."""
        markers = [file.with_name(file.name.replace("trial", "markers")) for file in files]
        entries = [
            {"file": file.name} | ({"markers": seen.name} if seen.is_file() else {})
            for file, seen in zip(files, markers, strict=True)
        ]
        enter(self.folder, proposal, entries)

    def _block(self, file: Path, protocol: Protocol, rng: np.random.Generator) -> Path:
        """A press against a block that does not give way: the depth is what the rig loses, and how it is read."""
        peak = max(each.force for each in protocol.segments if isinstance(each, Move) and each.force is not None)
        force = peak * np.linspace(0.0, 1.0, BLOCK_ROWS)
        time, lost = np.arange(BLOCK_ROWS) / self.made.scene.rate, np.zeros(BLOCK_ROWS)
        for effect in self.made.effects:
            if effect.gives_way:
                lost = lost - effect.travel(time, np.zeros(BLOCK_ROWS), force)
        read = lost + DEPTH_READ * float(rng.normal()) * force / peak
        columns = {"time_s": time, "depth_mm": 1e3 * read, "force_N": force}
        pd.DataFrame(columns).to_csv(file, index=False)
        return file


def under_tool(made: BlindCase, radius: float, deepest: float = DEEPEST) -> BlindCase:
    """The case's specimen and effects under a tool of another radius, m, that presses no deeper than so many m."""
    body = made.scene.body
    specimen = replace(body.specimen, tool_radius=radius)
    scene = made.scene.with_body(replace(body, specimen=specimen, deepest=deepest))
    return replace(made, scene=scene, effects=tuple(effect.under_tool(radius) for effect in made.effects))


def _motion(made: BlindCase, protocol: Protocol, depth_factor: float) -> ReportedMotion:
    """The reported motion of a protocol, whose depths below the surface go so much deeper."""
    steps = plan(protocol).steps
    times = np.array([0.0, *(step.start + step.duration for step in steps)])
    depths: Array = np.array([steps[0].depth_from, *(step.depth_to for step in steps)])
    depths = np.where(depths > 0.0, depth_factor * depths, depths)
    return rounded(times, depths, made.scene.rate, made.scene.frame_rate)


@dataclass
class LoopAnswer:
    """The answers of a loop, first to last, and how many experiments were done."""

    answers: list[Discovery] = field(default_factory=list)
    experiments: int = 0


def closed_loop(made: BlindCase, session: Path, most: int) -> LoopAnswer:
    """Decide, and do up to so many proposed experiments while rivals stand, on a copy of a case's session."""
    folder = session_copy(session, session.with_name(f"{session.name}-grown"))
    out, settings = LoopAnswer(), Settings(seed=made.name.seed, workers=1)

    def decide(path: Path, without: frozenset[str]) -> Findings:
        found = findings(load_session(path), settings=settings, without=without)
        out.answers.append(found.discovery)
        return found

    def proposed(found: Findings, allowed: Allowed) -> NextExperiment | None:
        grown = load_session(folder)
        return propose(found, fem_or_wave_table(grown, ()), allowed)

    loop = Loop(HiddenBench(made, folder), most, decide, proposed)
    out.answers.append(loop.run().discovery)
    out.experiments = len(loop.rounds)
    return out
