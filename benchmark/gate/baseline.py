"""The baseline that a check is compared with, a JSON file."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from bench_hw.storage.regular_file import DOCUMENT, read_regular
from benchmark.errors import InputError, NotComparableError
from benchmark.files.schema import validated
from benchmark.files.sources import Source, merge_conflict
from reports import write_json

SCHEMA = 1
DEFAULT = Path("tissuebench-baseline.json")
BASELINE_SIGN = b'"fingerprint"'
"""What tells it from files that must not be replaced, such as a check's own `check.json`."""

Finite = Annotated[float, Field(allow_inf_nan=False)]
Ratio = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]


class _Stored(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class StoredValue(_Stored):
    """A gated value with its unit; `reason` says why there is none.

    `curve` has it at each load step, by the words for the step (None: no finite number there); None of what is no
    load history, and of baselines from before there were curves.
    """

    value: Finite | None
    unit: str
    reason: str | None = None
    curve: Mapping[str, Finite | None] | None = None


class StoredTiming(_Stored):
    """A timed quantity: for each measured process its time in units of its references."""

    ratios: Annotated[list[Ratio], Field(min_length=1)]


class Machine(_Stored):
    """What a ratio of times depends on besides the code."""

    processor: str
    python: str
    packages: Mapping[str, str | None]

    def same_as(self, other: Machine) -> bool:
        """Whether ratios carry over: the same processor and Python (first two numbers)."""
        return self.processor == other.processor and self.python.split(".")[:2] == other.python.split(".")[:2]

    def differences(self, here: Machine) -> list[str]:
        """Packages that have another version here, as "numpy 2.4.6 (here 2.4.5)"."""
        return [
            f"{name} {version} (here {here.packages.get(name)})"
            for name, version in self.packages.items()
            if version != here.packages.get(name)
        ]


class Baseline(_Stored):
    """A baseline.

    Attributes
    ----------
    schema_
        Of the file.
    gate
        Name of the gate it was made with.
    fingerprint
        Of what was timed and how (see `plan.GatePlan`).
    made
        Date and time, UTC.
    revision
        Commit of the product, with "+" where it had changes; None outside a repository.
    machine
        Where it was made.
    accuracy, timing
        By quantity.
    differed
        Gated values that were farther from those of the baseline that this one replaced than the gate allows.
    """

    schema_: Annotated[int, Field(alias="schema")] = SCHEMA
    gate: str
    fingerprint: str
    made: str
    revision: str | None
    machine: Machine
    accuracy: Mapping[str, StoredValue]
    timing: Mapping[str, StoredTiming]
    differed: list[str] = Field(default_factory=list)


def differing(names: Sequence[str]) -> str:
    """How many values differ, the first of them by name, as the beginning of a sentence."""
    more = f" and {len(names) - 3} more" if len(names) > 3 else ""
    shown = f"({', '.join(names[:3])}{more})"
    return f"1 gated value {shown} differs" if len(names) == 1 else f"{len(names)} gated values {shown} differ"


def write_baseline(path: Path, baseline: Baseline) -> Path:
    """Write a baseline, whole or not at all; raises OSError where the file system refuses."""
    table = baseline.model_dump(by_alias=True)
    for value in table["accuracy"].values():
        if value["curve"] is None:
            del value["curve"]
    if not table["differed"]:
        del table["differed"]
    return write_json(path, table)


@contextmanager
def staged_baseline(path: Path, baseline: Baseline) -> Iterator[None]:
    """Write a baseline beside its place, read it back, and put it there when the block succeeds.

    Raises
    ------
    OSError
        Where the file system refuses; the old baseline then stays.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{path.name}.new")
    try:
        write_baseline(beside, baseline)
        read_baseline(beside)
        yield
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def read_baseline(path: Path, gate: Path | None = None) -> Baseline:
    """Read a baseline; a refusal says how to make one with the gate file `gate` (None: the shipped gate).

    Raises
    ------
    NotComparableError
        There is none, or it has another schema.
    InputError
        The file is no baseline.
    """
    table = _table(path, gate)
    if table.get("schema") != SCHEMA:
        raise NotComparableError(
            f"{path} has schema {table.get('schema')!r} and this version compares with schema {SCHEMA}; "
            f"{how_to(path, gate)}"
        )
    try:
        return validated(Baseline, table, Source(str(path)))
    except InputError as error:
        raise InputError(f"{str(error).rstrip('.')}; the file is no whole baseline; {how_to(path, gate)}") from None


def how_to(path: Path, gate: Path | None = None) -> str:
    """How to make a baseline with a gate file (None: the shipped one), as the end of a sentence."""
    of = "" if gate is None else f" --gate {shlex.quote(str(gate))}"
    made = f"python -m benchmark check{of} --baseline {shlex.quote(str(path))} --accept"
    return f"make one from this version with: {made}"


def _each_key_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object; raises ValueError where a key is there twice, as after a merge that kept both sides."""
    table = dict(pairs)
    if len(table) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for index, name in enumerate(names) if name in names[:index])
        raise ValueError(f"the key {twice!r} is there twice, as after a merge that kept both sides")
    return table


def _table(path: Path, gate: Path | None) -> dict[str, Any]:
    away = f"move it away and {how_to(path, gate)}"
    text = ""
    try:
        text = read_regular(path, DOCUMENT).decode("utf-8-sig")
        table = json.loads(text, object_pairs_hook=_each_key_once)
    except FileNotFoundError:
        raise NotComparableError(f"there is no baseline {path} to compare with; {how_to(path, gate)}") from None
    except OSError as error:
        raise InputError(f"{path}: this baseline cannot be read ({error.strerror or error})") from None
    except (ValueError, RecursionError) as error:
        conflict = merge_conflict(text)
        settle = f"settle it, or {how_to(path, gate)}" if conflict else away
        raise InputError(f"{path}: this baseline is no JSON ({conflict or error}); {settle}") from None
    if not isinstance(table, dict):
        raise InputError(f"{path}: this baseline is no JSON object; {away}")
    return table
