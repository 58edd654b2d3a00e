"""What a person says of a file where it does not say so itself, and how an error asks for it."""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final

from bench_hw.errors import InputError

_NO_COLUMNS: Mapping[str, str] = MappingProxyType({})

TARGETS: Final[Mapping[str, str]] = MappingProxyType(
    {"time": "time_s", "depth": "depth_mm", "force": "force_N", "gap": "gap_mm"}
)
"""The columns of a trial by the names of the options that say where each stands."""

AUTOMATIC: Final = "auto"
KEPT: Final = "none"


@dataclass(frozen=True)
class Told:
    """Options of reading; what is empty is found out.

    Parameters
    ----------
    columns : Mapping[str, str]
        By `time`, `depth`, `force`, `gap`, `stress`, `strain`: SOURCE or SOURCE:UNIT, as `parse_source` reads it.
    rate : float or None
        Rows per second, Hz, for a file without times.
    decimal, delimiter, encoding : str
        Of a text file.
    sheets : tuple of str
        The sheets (or groups, or tests) that are trials; empty for all that hold a record.
    drop_empty : bool
        Leave out rows in which a cell that is needed is empty or no number.
    touch : str
        `auto`: depth is counted from the first touch where the record begins in air; `none`: as the file has it.
    height, area : float or None
        Of the specimen, m and m2, for a file of stress and strain.
    tool : bool
        Whether the file or a person tells of a tool, which is narrower than the specimen.
    """

    columns: Mapping[str, str] = field(default_factory=lambda: _NO_COLUMNS)
    rate: float | None = None
    decimal: str = ""
    delimiter: str = ""
    encoding: str = ""
    sheets: tuple[str, ...] = ()
    drop_empty: bool = False
    touch: str = AUTOMATIC
    height: float | None = None
    area: float | None = None
    tool: bool = False

    def __post_init__(self) -> None:
        if self.decimal not in ("", ".", ","):
            raise InputError(f"import.decimal = {self.decimal!r}; allowed: . or ,")
        if self.touch not in (AUTOMATIC, KEPT):
            raise InputError(f"import.touch = {self.touch!r}; allowed: {AUTOMATIC} or {KEPT}")
        if self.rate is not None and not self.rate > 0.0:
            raise InputError(f"import.rate = {self.rate} Hz; allowed: a rate above zero")


@dataclass(frozen=True)
class ColumnSource:
    """Where a column stands: its header or `#3`, its unit ("" as the file says), and its sign (0: found out)."""

    name: str
    unit: str
    sign: int


_SOURCE = re.compile(r"(?P<sign>[+-]?)(?P<name>.+?)(?::(?P<unit>[^:]*))?", re.DOTALL)


def parse_source(role: str, text: str) -> ColumnSource:
    """Read `Load`, `Load:kgf`, `-Load:N` (press negative), `#3:mm`; a name with a colon needs one more at its end.

    Raises
    ------
    InputError
        There is no name.
    """
    found = _SOURCE.fullmatch(text.strip())
    if found is None or not found["name"].strip("+- "):
        raise InputError(f'import.{role} = {text!r}; allowed: "COLUMN" or "COLUMN:UNIT", with - before it to turn it')
    sign = {"": 0, "+": 1, "-": -1}[found["sign"]]
    return ColumnSource(found["name"].strip(), (found["unit"] or "").strip(), sign)


def asking(role: str, example: str) -> str:
    """How to say where a column stands: in a session, and in `bench_hw import`."""
    target = TARGETS.get(role)
    own = f'--set import.{role}="{example}"'
    return f"{own} (bench_hw import: --map {target}={example})" if target else own


ONLY_OF_SESSIONS: Final = ("height", "area")
"""What `bench_hw import` has no option for."""


def asking_key(key: str, example: str) -> str:
    """How to say another option: in a session, and in `bench_hw import` where that has it."""
    own = f'--set import.{key}="{example}"'
    if key in ONLY_OF_SESSIONS:
        return own
    value = "" if example == "true" else f" {shlex.quote(example)}"
    return f"{own} (bench_hw import: --{key.replace('_', '-')}{value})"
