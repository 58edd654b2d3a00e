"""What a capture is asked for, and the checks that need no device: they come before anything is opened."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from bench_hw.capture.session_keys import specimen_source
from bench_hw.configuration import validated
from bench_hw.errors import InputError
from bench_hw.motion.protocol_file import LoadedProtocol, Protocol
from bench_hw.rig.rig_file import LoadedRig
from bench_hw.trial_file.records import TrialHeader


@dataclass(frozen=True, slots=True)
class CaptureOrder:
    """One call of `capture`.

    Parameters
    ----------
    protocol : LoadedProtocol
        What the tool does in each trial.
    rig : LoadedRig
        The bench.
    out : pathlib.Path
        The session's folder.
    trials : int
        How many to record.
    condition : str
        What the trials share, for the session file; by default the protocol's name.
    specimen : str
        Name of a shipped tissue or a tissue file, for the session file; may be empty.
    fast : bool
        Simulated time: faster than real time, for simulated devices only.
    append : bool
        Add the trials to a session that exists.
    pause : float
        Rest between two trials, s.
    seed : int, optional
        Of the simulated devices; by default the rig's. Appended trials take it plus the number of those there.
    session_keys : Mapping[str, str]
        More keys of the session file (`tool.radius` = "5 mm").
    """

    protocol: LoadedProtocol
    rig: LoadedRig
    out: Path
    trials: int = 1
    condition: str = ""
    specimen: str = ""
    fast: bool = False
    append: bool = False
    pause: float = 0.0
    seed: int | None = None
    session_keys: Mapping[str, str] = field(default_factory=dict)


def check_order(order: CaptureOrder) -> None:
    """Refuse what cannot be carried out on this rig.

    Raises
    ------
    InputError
        Simulated time with real devices, a number of trials below one, a specimen that there is not, a speed the
        actuator has not, or a depth outside the travel.
    """
    rig, protocol = order.rig.rig, order.protocol.protocol
    if order.specimen:
        specimen_source(order.specimen, order.out)
    if order.trials < 1:
        raise InputError(f"--trials {order.trials}: allowed is 1 or more")
    if order.fast and not rig.without_hardware:
        real = ", ".join(sorted(rig.kinds - {"simulated"}))
        raise InputError(f"--fast: {order.rig.path} has real devices ({real}); allowed with simulated ones only")
    if rig.replay is not None and order.trials > 1:
        raise InputError(f"--trials {order.trials}: {order.rig.path} replays one trial; allowed is 1")
    if protocol.fastest > rig.actuator.max_speed * (1.0 + 1e-9):
        raise InputError(
            f"{order.protocol.path}: a speed of {protocol.fastest * 1e3:g} mm/s; allowed is up to the actuator's "
            f"max_speed of {rig.actuator.max_speed * 1e3:g} mm/s ({order.rig.path})"
        )
    if rig.actuator.contact is not None:
        check_depths(order, rig.actuator.contact)


def check_replay(order: CaptureOrder, recorded: TrialHeader) -> None:
    """Refuse another motion, or another press axis, than the replayed trial was recorded with.

    Raises
    ------
    InputError
        They differ.
    """
    text, rig = recorded.protocol_text, order.rig.rig
    if text and _protocol_of(text) != order.protocol.protocol:
        raise InputError(
            f"{order.protocol.path}: {recorded.name} was recorded with another protocol ({recorded.protocol!r}), and "
            f"the replayed tool goes where it went then; allowed is that protocol ({order.rig.path}, replay.trial)"
        )
    if recorded.press_axis != rig.force.press_axis:
        raise InputError(
            f"{order.rig.path}: force.press_axis is {rig.force.press_axis}; allowed is that of the replayed trial, "
            f"{recorded.press_axis}"
        )


def _protocol_of(text: str) -> Protocol | None:
    """The protocol that a trial file holds; None where it is none that is understood today."""
    try:
        return validated(Protocol, tomllib.loads(text), "replay.trial")
    except (InputError, tomllib.TOMLDecodeError):
        return None


def check_depths(order: CaptureOrder, zero: float) -> None:
    """Check every depth of the protocol against the travel, with depth zero at position `zero` (m).

    Raises
    ------
    InputError
        A depth lies outside.
    """
    if not order.protocol.protocol.moves:
        return
    low, high = order.rig.rig.travel
    for depth in (*order.protocol.protocol.depths, order.protocol.protocol.rest_depth):
        if not low <= zero + depth <= high:
            raise InputError(
                f"{order.protocol.path}: depth {depth * 1e3:g} mm is position {(zero + depth) * 1e3:.2f} mm with the "
                f"specimen at {zero * 1e3:.2f} mm; allowed is the travel of {low * 1e3:g} to {high * 1e3:g} mm "
                f"({order.rig.path}, safety.travel)"
            )
