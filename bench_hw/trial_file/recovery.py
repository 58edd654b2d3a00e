"""Saving what is whole in a cut or damaged trial file into a new one."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bench_hw.errors import TrialFileError
from bench_hw.storage.atomic import replacing
from bench_hw.trial_file.mcap_output import ChunkedWriter, NewFile, sync_folder
from bench_hw.trial_file.metadata import RECOVERY, TRIAL, sealed
from bench_hw.trial_file.scan import Scan, read_messages, scan_trial
from bench_hw.trial_file.writer import part_of

SCHEMA = 1
_LISTED_DAMAGES = 5


@dataclass(frozen=True)
class RecoveryOutcome:
    """What a recovery kept and what it could not.

    Parameters
    ----------
    out : pathlib.Path
        The new file.
    whole : bool
        Whether every message that was recorded is in it.
    reason : str
        What is damaged or missing; empty where nothing is.
    kept : dict of str to int
        Messages by channel name.
    lost_bytes : int
        Bytes of the recording that could not be used.
    """

    out: Path
    whole: bool
    reason: str
    kept: dict[str, int]
    lost_bytes: int

    def to_dict(self) -> dict[str, Any]:
        """Give it as it stands in the JSON of `recover`."""
        return {
            "schema": SCHEMA,
            "out": str(self.out),
            "whole": self.whole,
            "reason": self.reason,
            "kept": self.kept,
            "lost_bytes": self.lost_bytes,
        }


def recover_trial(path: Path | str, out: Path | str) -> RecoveryOutcome:
    """Write everything that is whole in a trial file into a new one; the original is only read.

    Messages keep their bytes, times, sequence numbers and order. The new file is a trial like any other; where
    something was lost it says so itself.

    Parameters
    ----------
    path : path-like
        The trial: cut, damaged, still named `.part`, or quite whole.
    out : path-like
        The new file, `NAME.mcap`; must not exist.

    Raises
    ------
    TrialFileError
        The file cannot be read, nothing in it can be kept, or the new one exists or cannot be written. No new
        file is left behind then.
    """
    path, out = Path(path), Path(out)
    scan = scan_trial(path)
    kept = {info.name: scan.rows[n] for n, info in scan.channels.items() if scan.rows.get(n)}
    reason = _reason(scan)
    if not kept:
        raise TrialFileError(path, f"nothing can be kept ({reason or 'the trial has no records'})")
    part_of(out)
    try:
        with replacing(out) as temporary:  # no `.part`, which would be a recording that was cut off
            _copy(scan, temporary, reason)
        sync_folder(out.parent)
    except OSError as error:
        raise TrialFileError(out, f"the recovered trial cannot be written ({error.strerror or error})") from error
    return RecoveryOutcome(out, scan.whole, reason, kept, scan.lost_bytes)


def _copy(scan: Scan, part: Path, reason: str) -> None:
    file = NewFile(part)
    try:
        writer = ChunkedWriter(file, scan.channels, _metadata(scan, reason))
        for message in read_messages(scan):
            number, sequence = message.channel, message.sequence
            writer.add(number, message.time, message.data, sequence, message.publish_time)
        writer.finish()
        file.sync()
    finally:
        file.close()


def _metadata(scan: Scan, reason: str) -> dict[str, dict[str, str]]:
    metadata = {} if scan.header is None else {TRIAL: dict(scan.header)}
    if scan.recovery is not None:
        metadata[RECOVERY] = dict(scan.recovery)
    elif not scan.whole:
        entries = {"source": scan.path.name, "reason": reason, "lost_bytes": str(scan.lost_bytes)}
        metadata[RECOVERY] = sealed(entries)
    return metadata


def _reason(scan: Scan) -> str:
    listed = [str(damage) for damage in scan.damages[:_LISTED_DAMAGES]]
    more = len(scan.damages) - len(listed)
    listed += [f"and {more} more damaged places"] if more > 0 else []
    return "; ".join(listed + scan.losses())
