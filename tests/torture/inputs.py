"""Files that nobody meant: valid ones of each schema, changed by Hypothesis, and given to what reads them.

A reader may take a file or refuse it in one short paragraph. Any other exception is what the command line ends with
code 70 for; more than 30 s is a hang.
"""

from __future__ import annotations

import json
import time
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tomli_w
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st

from tests.torture.scene import CAMERA, trial_text

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


def changed_table(table: dict[str, Any]) -> st.SearchStrategy[bytes]:
    """A TOML file with up to three of its values, at any depth, replaced, removed or renamed."""

    @st.composite
    def change(draw: Callable[..., Any]) -> bytes:
        copy = json.loads(json.dumps(table))
        for _ in range(draw(st.integers(1, 3))):
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
            return tomli_w.dumps(copy).encode("utf-8", "replace")
        except (TypeError, ValueError):
            return b"\xff"

    return change()


def changed_bytes(data: bytes) -> st.SearchStrategy[bytes]:
    """A file that was cut, or had bytes put in, taken out or flipped."""

    @st.composite
    def change(draw: Callable[..., Any]) -> bytes:
        found = bytearray(data)
        for _ in range(draw(st.integers(1, 4))):
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
        for _ in range(draw(st.integers(1, 4))):
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


def torture(folder: Path, until: float, seed: int, each: int) -> dict[str, Count]:
    """Give `each` changed files of every kind to what reads them, until the time is over."""
    counts: dict[str, Count] = {}
    for kind in kinds(folder):
        if time.monotonic() < until:
            counts[kind.name] = Count()
            _try(kind, folder, counts[kind.name], until, seed, each)
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
            _judge(kind, path, count)

    one()


def _judge(kind: Kind, path: Path, count: Count) -> None:
    from bench_hw.errors import BenchError
    from benchmark.errors import TissuebenchError
    from fem import FemError

    started = time.monotonic()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            kind.read(path)
        count.taken += 1
    except (BenchError, TissuebenchError, FemError) as error:
        count.refused += 1
        if len(str(error)) > LONGEST or not str(error).strip():
            count.failures.append(f"no paragraph: {len(str(error))} characters")
    except Exception as error:
        count.failures.append(f"{type(error).__name__}: {str(error)[:150]} for {path.read_bytes()[:2000]!r}")
    seconds = time.monotonic() - started
    count.slowest = max(count.slowest, seconds)
    if seconds > HANG:
        count.failures.append(f"it took {seconds:.0f} s")


def kinds(folder: Path) -> list[Kind]:
    """Every kind of file that a person or another program may bring."""
    from bench_hw.configuration import read_toml
    from bench_hw.motion.protocol_file import load_protocol, shipped
    from bench_hw.rig.rig_file import load_rig, shipped_rigs
    from bench_hw.trial_file import read_trial_mcap
    from bench_hw.trial_file.inspection import inspect_trial
    from bench_hw.vision.camera.camera_file import read_camera
    from benchmark.files import load_scenario, load_session, load_tissue
    from benchmark.gate.baseline import read_baseline
    from benchmark.gate.plan import load_plan
    from benchmark.models import read_reference
    from benchmark.response.model_with_effects import load_repair
    from benchmark.runs.finished.saved_run import read_run
    from fem import read_surface

    scenario = load_scenario("skin-5N")
    press = trial_text(40)
    rig = read_toml(shipped_rigs()["simulated"])[0]
    protocol = read_toml(shipped()["paper_press"])[0]
    markers = "time_s,marker,x_mm,y_mm\n" + "".join(f"{0.1 * t:.1f},{m},{m}.5,0\n" for t in range(10) for m in range(3))
    session = {
        "schema": 1, "name": "s", "trials": [{"file": "a.csv", "condition": "c", "markers": "a_markers.csv"}],
        "tool": {"radius": "5 mm", "contact": "rigid_bonded"}, "support": {"kind": "hole", "hole_radius": "30 mm"},
        "camera": {"marker_rows": 1, "marker_columns": 3, "marker_spacing": "5 mm", "distance": "70 mm"},
    }  # fmt: skip
    (folder / "s").mkdir(parents=True, exist_ok=True)
    (folder / "s" / "a.csv").write_text(press)
    (folder / "s" / "a_markers.csv").write_text(markers)
    finished, recording = folder.parent / "finished", folder.parent / "trial.mcap"
    surface = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    facets = "".join(
        f"facet normal 0 0 0\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet\n"
        for a, b, c in (("0 0 0", "0 1 0", "1 0 0"), ("0 0 0", "1 0 0", "0 0 1"), ("1 0 0", "0 1 0", "0 0 1"))
    )
    relaxation = {"name": "viscoelastic_relaxation", "parameters": {"g_1": {"value": "0.3", "ci95": ["0.2", "0.4"]}}}
    model = {"schema": 1, "base": {"tissue": "skin_forearm", "model": "wave"}, "effects": [relaxation]}
    gate = read_toml(Path(load_plan.__code__.co_filename).with_name("default.toml"))[0]
    table = (finished / "tables" / "max_deformation.csv").read_text() if finished.exists() else press
    result = (finished / "results.json").read_bytes() if finished.exists() else b"{}"
    return [
        Kind("tissue", "t.toml", changed_table(scenario.tissue.to_table()), load_tissue),
        Kind("scenario", "sc.toml", changed_table(scenario.to_table()), load_scenario),
        Kind("scenario bytes", "sc.toml", changed_bytes(scenario.to_toml().encode()), load_scenario),
        Kind("trial csv", "c/t.csv", changed_rows(press), lambda path: load_session(path.parent)),
        Kind("trial csv bytes", "c/t.csv", changed_bytes(press.encode()), lambda path: load_session(path.parent)),
        Kind("session.toml", "s/session.toml", changed_table(session), lambda path: load_session(path.parent)),
        Kind("markers csv", "m/t_markers.csv", changed_rows(markers), _markers),
        Kind("load csv", "load.csv", changed_rows("time_s,force_N\n0,0\n1,1\n2,2\n3,0\n"), _load),
        Kind("reference csv", "r.csv", changed_rows(table), lambda path: read_reference(path, scenario)),
        Kind(
            "results.json", "run/results.json", changed_bytes(result), lambda path: _run_with(finished, path, read_run)
        ),
        Kind("model.toml", "model.toml", changed_table(model), lambda path: load_repair(path, None)),
        Kind("gate.toml", "gate.toml", changed_table(gate), load_plan),
        Kind("baseline.json", "b.json", changed_bytes(b'{"schema": 1, "gate": "x", "accuracy": {}}'), read_baseline),
        Kind("rig.toml", "rig.toml", changed_table(rig), load_rig),
        Kind("protocol.toml", "pr.toml", changed_table(protocol), load_protocol),
        Kind("camera.toml", "cam.toml", changed_bytes(CAMERA.encode()), read_camera),
        Kind("trial mcap", "t.mcap", changed_bytes(recording.read_bytes()), read_trial_mcap),
        Kind("trial mcap, inspect", "t.mcap", changed_bytes(recording.read_bytes()), inspect_trial),
        Kind("surface obj", "s.obj", changed_bytes(surface.encode()), lambda path: read_surface(path, "mm")),
        Kind("surface stl", "s.stl", changed_bytes(f"solid a\n{facets}endsolid a\n".encode()), _stl),
    ]


def _stl(path: Path) -> object:
    from fem import read_surface

    return read_surface(path, "mm")


def _markers(path: Path) -> object:
    from bench_hw.tables import read_marker_csv

    return read_marker_csv(path)


def _load(path: Path) -> object:
    from benchmark.files import load_scenario

    return load_scenario("skin-5N", {"load": f'{{ shape = "table", file = "{path}" }}'})


def _run_with(finished: Path, path: Path) -> Path:
    import shutil

    for name in ("scenario.toml", "environment.json"):
        shutil.copy(finished / name, path.parent / name)
    shutil.copytree(finished / "tables", path.parent / "tables", dirs_exist_ok=True)
    return path.parent


def rows(counts: dict[str, Count]) -> list[tuple[str, ...]]:
    """The table by kind."""
    body = [
        (
            name,
            str(c.taken + c.refused + len(c.failures)),
            str(c.taken),
            str(c.refused),
            f"{c.slowest:.1f}",
            str(len(c.failures)),
        )
        for name, c in counts.items()
    ]
    total = Counter[int]()
    for row in body:
        total.update({k: int(row[k]) for k in (1, 2, 3, 5)})
    slowest = max((c.slowest for c in counts.values()), default=0.0)
    last = ("all", str(total[1]), str(total[2]), str(total[3]), f"{slowest:.1f}", str(total[5]))
    return [("kind", "files", "taken", "refused", "slowest, s", "failures"), *body, last]
