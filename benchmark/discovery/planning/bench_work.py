"""A bench that a loop may use: it does a proposed experiment and enters the trials into a copy of the session."""

from __future__ import annotations

import itertools
import shutil
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from bench_hw.capture.order import CaptureOrder
from bench_hw.capture.progress import Silent
from bench_hw.capture.session import capture
from bench_hw.errors import BenchError
from bench_hw.motion.protocol_file import load_protocol
from bench_hw.rig.opening import sheet_of, specimen_of
from bench_hw.rig.rig_file import LoadedRig, load_rig
from bench_hw.storage.folder_lock import scratch
from benchmark.discovery.planning.proposing import Allowed
from benchmark.discovery.report.discovery_record import NextExperiment
from benchmark.errors import DeviceError, InputError
from benchmark.files.sessions.session_folder import digest
from reports import write_text

Asked = Callable[[NextExperiment, Mapping[str, Any]], bool]
"""Shows a person what must be done by hand first; whether it was done."""


class Bench(Protocol):
    """What does experiments for a loop."""

    @property
    def folder(self) -> Path:
        """Of the copy of the session, which grows."""
        ...

    def allowed(self, done: set[str]) -> Allowed:
        """What it can do, but for the experiments that are done."""
        ...

    def ready(self, proposal: NextExperiment) -> bool:
        """Whether what must be done by hand first was done."""
        ...

    def record(self, proposal: NextExperiment, trials: int, number: int) -> tuple[Path, ...]:
        """Do an experiment; the files of its trials, which lie in the copy of the session."""
        ...

    def add(self, proposal: NextExperiment, files: tuple[Path, ...]) -> None:
        """Enter trials into the session file of the copy."""
        ...


def unattended(proposal: NextExperiment, setup: Mapping[str, Any]) -> bool:  # noqa: ARG001 - as a person is asked
    """Nobody is there to do anything by hand."""
    return False


def load_bench(name: str) -> LoadedRig:
    """Read a rig file, or the shipped rig of that name, and what it says lies under the tool.

    Raises
    ------
    InputError
        There is none, or it says something that is not allowed.
    """
    try:
        rig = load_rig(name)
        specimen_of(rig), sheet_of(rig)
        return rig
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
        limit = self.rig.rig.safety.force_limit
        return Allowed(limit, frozenset(done), radii, limit)

    def ready(self, proposal: NextExperiment) -> bool:
        """Whether what must be done by hand first was done."""
        setup = tomllib.loads(proposal.toml).get("setup", {})
        return not setup or self.rig.rig.all_simulated or self.asked(proposal, setup)

    def record(self, proposal: NextExperiment, trials: int, number: int) -> tuple[Path, ...]:
        """Do an experiment; the files of its trials, which lie in the copy of the session.

        They are numbered on from what lies there: a loop may go on from the session of another. What was recorded
        when the bench ends with a fault, or is interrupted, stays in a folder of the copy.

        Raises
        ------
        DeviceError
            The bench ended with a fault.
        InputError
            The bench cannot do it.
        """
        number = _free(self.folder, number)
        recorded = self.folder / f"experiment_{number}"
        with scratch() as folder:
            protocol = folder / "next_experiment.toml"
            write_text(protocol, proposal.toml)
            loaded = load_protocol(protocol)
            specimen = specimen_of(self.rig)
            under = None if specimen is None else specimen.with_setup(loaded.protocol.setup)
            order = CaptureOrder(
                loaded,
                self.rig,
                recorded,
                trials,
                condition=proposal.choice,
                fast=self.rig.rig.all_simulated,
                seed=self.seed + 1000 * number,
            )
            files = tuple(
                Path(shutil.copyfile(file, self.folder / f"experiment_{number}_{place}.mcap"))
                for place, file in enumerate(_captured(order, under), 1)
            )
        shutil.rmtree(recorded)
        return files

    def add(self, proposal: NextExperiment, files: tuple[Path, ...]) -> None:
        """Enter trials into the session file of the copy, with the tool they were made with."""
        enter(self.folder, proposal, [{"file": file.name} for file in files])


def _free(folder: Path, number: int) -> int:
    """The first number from this one on under which no experiment lies in a folder, nor what is left of one."""
    there = {each.name.split("_")[1].split(".")[0] for each in folder.glob("experiment_*")}
    return next(each for each in itertools.count(number) if str(each) not in there)


def _captured(order: CaptureOrder, specimen: Any) -> tuple[Path, ...]:
    try:
        outcome = capture(order, Silent(), specimen=specimen)
    except BenchError as error:
        raise InputError(f"--bench: {error}") from None
    if outcome.fault is not None:
        raise DeviceError(f"--bench: {outcome.fault.message}")
    return outcome.trials


def session_copy(session: Path, folder: Path) -> Path:
    """Copy a session with a session.toml to a folder that will grow, in place of an earlier copy.

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


def kept_experiments(session: Path, folder: Path) -> Path | None:
    """Move an earlier copy in which a bench recorded something out of the way; its new place, None where there is none.

    It is what an interrupted loop leaves: a session of its own, beside the hidden folder in which it grew. Files are
    told by what is in them (`recorded`): a recording may have the name of another one.
    """
    if not folder.is_dir() or not recorded(session, folder):
        return None
    name = folder.parent.name.removeprefix(".").removesuffix(".unfinished")
    places = (folder.parent.with_name(f"{name}-experiments-{number}") for number in itertools.count(1))
    return folder.rename(next(place for place in places if not place.exists()))


def recorded(session: Path, folder: Path) -> bool:
    """Whether a copy of a session holds what the session does not."""
    return not _contents(folder) <= _contents(session)


def _contents(folder: Path) -> set[str]:
    """What the files below a folder hold, each as a digest, but for the session file, which has no measurement."""
    files = (each for each in folder.rglob("*") if each.is_file() and each != folder / "session.toml")
    return {digest(file) for file in files}


def enter(folder: Path, proposal: NextExperiment, trials: Sequence[Mapping[str, str]]) -> None:
    """Enter trials, each by its files, into the session file of a folder, with the tool they were made with."""
    import tomli_w

    path = folder / "session.toml"
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    table["trials"] += [{**trial, "condition": proposal.choice} for trial in trials]
    radius = tomllib.loads(proposal.toml).get("setup", {}).get("tool_radius")
    if radius is not None:
        table.setdefault("conditions", {})[proposal.choice] = {"tool": {**table.get("tool", {}), "radius": radius}}
    write_text(path, tomli_w.dumps(table))
