"""What a capture is asked for, and the checks that need no device: they come before anything is opened."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from bench_hw.errors import InputError
from bench_hw.motion.protocol_file import LoadedProtocol
from bench_hw.rig.rig_file import LoadedRig


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
        Name of a shipped tissue or path inside the folder, for the session file; may be empty.
    fast : bool
        Simulated time: faster than real time, for simulated devices only.
    append : bool
        Add the trials to a session that exists.
    pause : float
        Rest between two trials, s.
    seed : int, optional
        Of the simulated devices; by default the rig's.
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
        Simulated time with real devices, a number of trials below one, a speed the actuator has not, or a
        depth outside the travel.
    """
    rig, protocol = order.rig.rig, order.protocol.protocol
    if order.trials < 1:
        raise InputError(f"--trials {order.trials}: allowed is 1 or more")
    if order.fast and not rig.all_simulated:
        real = ", ".join(sorted(rig.kinds - {"simulated"}))
        raise InputError(f"--fast: {order.rig.path} has real devices ({real}); allowed with simulated ones only")
    if protocol.fastest > rig.actuator.max_speed * (1.0 + 1e-9):
        raise InputError(
            f"{order.protocol.path}: a speed of {protocol.fastest * 1e3:g} mm/s; allowed is up to the actuator's "
            f"max_speed of {rig.actuator.max_speed * 1e3:g} mm/s ({order.rig.path})"
        )
    if rig.actuator.contact is not None:
        check_depths(order, rig.actuator.contact)


def check_depths(order: CaptureOrder, zero: float) -> None:
    """Check every depth of the protocol against the travel, with depth zero at position `zero` (m).

    Raises
    ------
    InputError
        A depth lies outside.
    """
    low, high = order.rig.rig.travel
    for depth in (*order.protocol.protocol.depths, order.protocol.protocol.rest_depth):
        if not low <= zero + depth <= high:
            raise InputError(
                f"{order.protocol.path}: depth {depth * 1e3:g} mm is position {(zero + depth) * 1e3:.2f} mm with the "
                f"specimen at {zero * 1e3:.2f} mm; allowed is the travel of {low * 1e3:g} to {high * 1e3:g} mm "
                f"({order.rig.path}, safety.travel)"
            )
