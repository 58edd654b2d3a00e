"""What a trial file says about itself: the header's fields as MCAP metadata, guarded by a checksum.

MCAP protects chunks by a CRC but not metadata, and a flipped digit of a serial number or a flipped sign of
the press axis would go unnoticed. So each metadata record carries the CRC-32 of its own entries, is
repeated along the file, and counts only where its checksum fits.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping
from typing import get_args

from bench_hw.trial_file.encoding import CHANNELS, NANOSECONDS, nanoseconds
from bench_hw.trial_file.records import PressAxis, TrialHeader

TRIAL = "tissuebench.trial"
RECOVERY = "tissuebench.recovery"
SCHEMA = "1"
_CHECKSUM = "crc32"
_PREFIXES = {"serials": "serial.", "calibrations": "calibration.", "settings": "setting."}


def header_entries(header: TrialHeader) -> dict[str, str]:
    """Give the metadata entries of a header, checksum included."""
    entries = {
        "schema": SCHEMA,
        "name": header.name,
        "started": header.started,
        "clock_epoch_ns": str(nanoseconds(header.clock_epoch)),
        "press_axis": header.press_axis,
        "protocol": header.protocol,
        "protocol_text": header.protocol_text,
        "synthetic": "true" if header.synthetic else "false",
        "channels": json.dumps({number: info.topic for number, info in CHANNELS.items()}),
    }
    for field, prefix in _PREFIXES.items():
        entries |= {f"{prefix}{key}": value for key, value in getattr(header, field).items()}
    return sealed(entries)


def sealed(entries: Mapping[str, str]) -> dict[str, str]:
    """Add the checksum of the entries to them."""
    return {**entries, _CHECKSUM: _checksum(entries)}


def is_sealed(entries: Mapping[str, str]) -> bool:
    """Say whether the entries carry their own checksum."""
    return entries.get(_CHECKSUM) == _checksum(entries)


def _checksum(entries: Mapping[str, str]) -> str:
    text = json.dumps(sorted((key, value) for key, value in entries.items() if key != _CHECKSUM))
    return f"{zlib.crc32(text.encode()):08x}"


def read_header(entries: Mapping[str, str]) -> TrialHeader:
    """Turn sealed entries back into a header.

    Raises
    ------
    ValueError
        Another schema, or a press axis there is none of.
    KeyError
        An entry is missing.
    """
    if entries["schema"] != SCHEMA:
        raise ValueError(f"schema {entries['schema']!r} of the trial metadata; allowed: {SCHEMA!r}")
    axis = press_axis(entries["press_axis"])
    groups = {
        field: {key[len(prefix) :]: value for key, value in entries.items() if key.startswith(prefix)}
        for field, prefix in _PREFIXES.items()
    }
    return TrialHeader(
        name=entries["name"],
        started=entries["started"],
        clock_epoch=int(entries["clock_epoch_ns"]) / NANOSECONDS,
        press_axis=axis,
        protocol=entries["protocol"],
        protocol_text=entries["protocol_text"],
        synthetic=entries["synthetic"] == "true",
        **groups,
    )


def press_axis(text: str) -> PressAxis:
    """Check the name of a press axis.

    Raises
    ------
    ValueError
        It is none of +x, -x, +y, -y, +z, -z.
    """
    names: tuple[PressAxis, ...] = get_args(PressAxis)
    for name in names:
        if text == name:
            return name
    raise ValueError(f"press axis {text!r}; allowed: {', '.join(names)}")
