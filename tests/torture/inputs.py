"""Files that nobody meant: valid ones of each schema, changed by Hypothesis, and given to what reads them.

A reader may take a file or refuse it in one short paragraph. Any other exception is what the command line ends with
code 70 for; more than 30 s is a hang.
"""

from __future__ import annotations

import json
import signal
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tomli_w
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st

HANG = 30.0
LONGEST = 2000
"""Characters of a paragraph."""

NASTY = st.one_of(
    st.sampled_from(
        [
            "", " ", "nan", "inf mm", "-1 mm", "0 mm", "1e400 mm", "1e-160 N", "5", "5 parsec", "5 mm +/- 0 mm",
            "5 mm +/- 500 %", "\u00fc", "a\nb", "\x00", "../../etc/passwd", "/dev/zero", "~", "=1+1", "<b>", "9" * 5000,
            "--", "%", "5 mm mm", 0, -1, 2**63, 1e308, -0.0, float("inf"), float("nan"), True, [], {}, [[]], ["5 mm"],
            {"a": 1}, [1, 2, 3] * 50,
        ]
    ),
    st.text(max_size=30),
    st.integers(-(2**70), 2**70).filter(lambda n: abs(n) < 2**63),
    st.floats(),
    st.recursive(st.integers(0, 3), lambda inner: st.lists(inner, max_size=3), max_leaves=5),
)  # fmt: skip
CELLS = st.sampled_from(
    ["", "nan", "inf", "1e308", "-1e308", "1e-320", "abc", "=1+1", '"', '"1', "1,2", "0x10", "1_000", " 1", "9" * 400]
)
BYTES = st.sampled_from([b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"\r", b"\n\n", b"\x1a", b",", b'"', b"[", b"]]"])


def changed_json(document: dict[str, Any]) -> st.SearchStrategy[bytes]:
    """A JSON file changed as `changed_table` does."""
    return changed_table(document, json.dumps)


def changed_table(table: dict[str, Any], dump: Callable[[Any], str] = tomli_w.dumps) -> st.SearchStrategy[bytes]:
    """A TOML file with up to three of its values, at any depth, replaced, removed or renamed."""

    @st.composite
    def change(draw: Callable[..., Any]) -> bytes:
        copy = json.loads(json.dumps(table))
        for _ in range(draw(st.integers(0, 3))):
            node = copy
            while True:
                keys = list(node) if isinstance(node, dict) else list(range(len(node)))
                if not keys:
                    break
                key = draw(st.sampled_from(keys))
                if isinstance(node[key], dict | list) and node[key] and draw(st.booleans()):
                    node = node[key]
                    continue
                what = draw(st.sampled_from(["replace", "replace", "remove", "rename"]))
                value = node.pop(key) if what != "replace" else None
                if what == "rename" and isinstance(node, dict):
                    node[draw(st.text(min_size=1, max_size=12))] = value
                elif what == "replace":
                    node[key] = draw(NASTY)
                break
        try:
            return dump(copy).encode("utf-8", "replace")
        except (TypeError, ValueError):
            return b"\xff"

    return change()


def changed_bytes(data: bytes) -> st.SearchStrategy[bytes]:
    """A file that was cut, or had bytes put in, taken out or flipped."""

    @st.composite
    def change(draw: Callable[..., Any]) -> bytes:
        found = bytearray(data)
        for _ in range(draw(st.integers(0, 4))):
            at = draw(st.integers(0, max(len(found) - 1, 0)))
            what = draw(st.sampled_from(["cut", "insert", "flip", "remove", "repeat"]))
            if what == "cut":
                del found[at:]
            elif what == "insert":
                found[at:at] = draw(BYTES)
            elif what == "flip" and found:
                found[at] ^= 1 << draw(st.integers(0, 7))
            elif what == "remove":
                del found[at : at + draw(st.integers(1, 200))]
            else:
                found[at:at] = found[at : at + 50]
        return bytes(found)

    return change()


def changed_rows(text: str) -> st.SearchStrategy[bytes]:
    """A CSV file with some of its cells, rows or its header changed."""

    @st.composite
    def change(draw: Callable[..., Any]) -> bytes:
        lines = text.splitlines()
        for _ in range(draw(st.integers(0, 4))):
            row = draw(st.integers(0, len(lines) - 1))
            cells = lines[row].split(",")
            what = draw(st.sampled_from(["cell", "cell", "cell", "drop", "swap", "double", "blank"]))
            if what == "cell":
                cells[draw(st.integers(0, len(cells) - 1))] = draw(CELLS)
                lines[row] = ",".join(cells)
            elif what == "drop":
                lines[row] = ",".join(cells[:-1])
            elif what == "swap":
                other = draw(st.integers(0, len(lines) - 1))
                lines[row], lines[other] = lines[other], lines[row]
            elif what == "double":
                lines.insert(row, lines[row])
            else:
                lines[row] = ""
        return "\n".join(lines).encode("utf-8", "replace")

    return change()


class RefusedError(Exception):
    """A command line refused a file with an exit code of the contract, in one paragraph."""


class HangError(BaseException):
    """Something takes too long."""


@dataclass
class Count:
    """What became of the files of a kind: taken, refused, and failures in words."""

    taken: int = 0
    refused: int = 0
    slowest: float = 0.0
    failures: list[str] = field(default_factory=list)

    @property
    def files(self) -> int:
        """How many were tried."""
        return self.taken + self.refused + len(self.failures)


@dataclass(frozen=True)
class Kind:
    """A kind of file: its name, where it is put, valid content, how it is changed, and what reads it."""

    name: str
    place: str
    strategy: st.SearchStrategy[bytes]
    read: Callable[[Path], object]


def torture(folder: Path, until: float, seed: int, each: int, names: tuple[str, ...] = ("",)) -> dict[str, Count]:
    """Give `each` changed files of the kinds that begin with `names` to what reads them.

    Each kind has its part of the time that is left.
    """
    from tests.torture.kinds import kinds

    counts: dict[str, Count] = {}
    asked = [kind for kind in kinds(folder) if kind.name.startswith(names)]
    for waiting, kind in zip(range(len(asked), 0, -1), asked, strict=True):
        count, now = counts.setdefault(kind.name, Count()), time.monotonic()
        _try(kind, folder, count, now + (until - now) / waiting, seed, each)
        for text in count.failures:
            print(f"{kind.name}: {text}", file=sys.stderr, flush=True)
        print(f"  {' | '.join(_row(kind.name, count))}", file=sys.stderr, flush=True)
    return counts


def _try(kind: Kind, folder: Path, count: Count, until: float, seed: int, each: int) -> None:
    @seeded(seed)
    @settings(
        max_examples=each,
        database=None,
        deadline=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(kind.strategy)
    def one(data: bytes) -> None:
        if time.monotonic() < until:
            path = folder / kind.place
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
            _judge(kind, path, folder, count)

    one()


def _judge(kind: Kind, path: Path, folder: Path, count: Count) -> None:
    from bench_hw.errors import BenchError
    from benchmark.errors import TissuebenchError
    from fem import FemError

    started, before = time.monotonic(), _names(folder)
    try:
        with warnings.catch_warnings(), _bounded():
            warnings.simplefilter("error", RuntimeWarning)
            kind.read(path)
        count.taken += 1
    except (BenchError, TissuebenchError, FemError, RefusedError) as error:
        count.refused += 1
        if len(str(error)) > LONGEST or not str(error).strip():
            count.failures.append(f"no paragraph: {len(str(error))} characters for {_start(path)}")
    except HangError:
        count.failures.append(f"it took more than {HANG:.0f} s for {_start(path)}")
    except Exception as error:
        count.failures.append(f"{type(error).__name__}: {str(error)[:400]} for {_start(path)}")
    left = _names(folder) - before
    if left:
        count.failures.append(f"left {', '.join(sorted(left)[:3])} for {_start(path)}")
        for name in left:
            (folder / name).unlink(missing_ok=True)
    count.slowest = max(count.slowest, time.monotonic() - started)


def _start(path: Path) -> str:
    return repr(path.read_bytes()[:1500])


def _names(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir()}


@contextmanager
def _bounded() -> Iterator[None]:
    """End what takes longer than a person waits."""

    def ring(*_: object) -> None:
        raise HangError

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, HANG)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def rows(counts: dict[str, Count]) -> list[tuple[str, ...]]:
    """The table by kind."""
    body = [_row(name, each) for name, each in counts.items()]
    totals = [str(sum(int(row[k]) for row in body)) for k in (1, 2, 3, 5)]
    slowest = max((each.slowest for each in counts.values()), default=0.0)
    last = ("all", *totals[:3], f"{slowest:.1f}", totals[3])
    return [("kind", "files", "taken", "refused", "slowest, s", "failures"), *body, last]


def _row(name: str, c: Count) -> tuple[str, ...]:
    return name, str(c.files), str(c.taken), str(c.refused), f"{c.slowest:.1f}", str(len(c.failures))
