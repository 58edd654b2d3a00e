"""Every kind of file that a person or another program may bring: a valid one, how it is changed, and what reads it."""

from __future__ import annotations

import io
import shutil
import sys
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from json import dumps, loads
from pathlib import Path
from typing import Any
from unittest.mock import patch

from tests.torture.commands import CONTRACT, MAPS, is_plain
from tests.torture.inputs import Kind, RefusedError, changed_bytes, changed_json, changed_rows, changed_table
from tests.torture.scene import CAMERA, GATE, PAD, attempt_text, trial_text

ROOT = Path(__file__).parents[2]
MARKERS = "time_s,marker,x_mm,y_mm\n" + "".join(f"{0.1 * t:.1f},{m},{m}.5,0\n" for t in range(10) for m in range(3))
SESSION = {
    "schema": 1, "name": "s", "trials": [{"file": "a.csv", "condition": "c", "markers": "a_markers.csv"}],
    "tool": {"radius": "5 mm", "contact": "rigid_bonded"}, "support": {"kind": "hole", "hole_radius": "30 mm"},
    "camera": {"marker_rows": 1, "marker_columns": 3, "marker_spacing": "5 mm", "distance": "70 mm"},
    "fit": {"free": ["pad.youngs_modulus"], "law": "gent", "forward": "wave", "bounds": {"thickness": ["1 mm", "9 mm"]},
            "priors": {"thickness": {"value": "5 mm +/- 10 %", "source": "a gauge"}}},
}  # fmt: skip
SURFACE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
FACETS = "".join(
    f"facet normal 0 0 0\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet\n"
    for a, b, c in (("0 0 0", "0 1 0", "1 0 0"), ("0 0 0", "1 0 0", "0 0 1"), ("1 0 0", "0 1 0", "0 0 1"))
)
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"
)
RELAXATION = {"name": "viscoelastic_relaxation", "parameters": {
    "g_1": {"value": "0.3", "ci95": ["0.2", "0.4"]}, "tau_1": {"value": "2 s", "ci95": ["1 s", "3 s"]}}}  # fmt: skip
MODEL = {"schema": 1, "base": {"tissue": "skin_forearm", "model": "wave"}, "effects": [RELAXATION]}
CONTEXT = {
    "schema": 1, "name": "a trainer", "question_of_interest": "Is it right?", "context_of_use": "Presses to 5 N.",
    "model_influence": "high", "decision_consequence": "low", "quantities": ["force over depth"], "max_force": "5 N",
}  # fmt: skip
BASELINE = {
    "schema": 1, "gate": "small", "fingerprint": "5403", "made": "2026-11-23T02:52:27+00:00", "revision": "a916",
    "machine": {"processor": "a", "python": "3.11.7", "packages": {"numpy": "2.4.6", "scipy": "1.17.1"}},
    "accuracy": {"w.max_deformation_mm.dermis": {"value": 4.4, "unit": "mm", "reason": None}},
    "timing": {"wave.frame": {"ratios": [3.6, 3.2, 3.4]}},
}  # fmt: skip
CHECKED = {
    "schema": 1, "made": "2026-11-23T02:52:27+00:00", "revision": "a916", "machine": "a", "against": None,
    "passed": True, "accuracy": {"w.max_deformation_mm.dermis": 4.4},
    "timing": {"wave.frame": {"ratio": 3.4, "ci95": [3.2, 3.6], "allowed": 3.9}},
}  # fmt: skip
"""A line of the history of the gate's checks."""


def kinds(folder: Path) -> list[Kind]:
    """All of them, in a folder whose parent has a finished run, a recording, pictures and a session."""
    (folder / "s").mkdir(parents=True, exist_ok=True)
    (folder / "s" / "a.csv").write_text(trial_text(40))
    (folder / "s" / "a_markers.csv").write_text(MARKERS)
    return [
        *_of_models(folder),
        *_of_sessions(folder),
        *_of_results(folder),
        *_of_solvers(),
        *_of_bench(folder),
        *_of_presses(folder),
        *_of_others(folder),
    ]


def _of_models(folder: Path) -> list[Kind]:
    """Tissues, scenarios, model files, effects, gates."""
    from bench_hw.configuration import read_toml
    from benchmark.dossier.context import load_context
    from benchmark.files import load_scenario, load_tissue
    from benchmark.gate.plan import load_plan
    from benchmark.models.user_file import UserCode, read_user_file
    from benchmark.physics import load_effects
    from benchmark.response.model_with_effects import load_repair

    scenario = load_scenario("skin-5N")
    known = tissue_with_deviations(scenario.tissue.to_table())
    shipped = Path(load_plan.__code__.co_filename).parent
    gate = read_toml(shipped / "default.toml")[0]
    shutil.copytree(shipped / "scenarios", folder / "gate" / "scenarios", dirs_exist_ok=True)
    load = "time_s,force_N\n0,0\n1,1\n2,2\n3,0\n"
    own, effect = (ROOT / "examples" / f"own_{name}.py" for name in ("model", "effect"))
    return [
        Kind("tissue", "t.toml", changed_table(scenario.tissue.to_table()), load_tissue),
        Kind("tissue, shown", "t.toml", changed_bytes(PAD.encode()), _cli("benchmark", "tissues", "{}")),
        Kind("identified.toml", "identified.toml", changed_table(known), load_tissue),
        Kind("scenario", "sc.toml", changed_table(scenario.to_table()), load_scenario),
        Kind("scenario, shown", "sc.toml", changed_bytes(scenario.to_toml().encode()), _cli("benchmark", "scenarios",
                                                                                            "{}")),
        Kind("load csv", "load.csv", changed_rows(load), _load),
        Kind("model.toml", "model.toml", changed_table(MODEL), lambda path: load_repair(path, None)),
        Kind("effects file", "effects.py", changed_bytes(effect.read_bytes()), load_effects),
        Kind("own model", "own.py", changed_bytes(own.read_bytes()), lambda path: UserCode(read_user_file(path))),
        Kind("gate.toml", "gate/gate.toml", changed_table(gate), load_plan),
        Kind("gate.toml, checked", "gate.toml", changed_bytes(GATE.encode()),
             _cli("benchmark", "check", "--gate", "{}", "--baseline", "none.json")),
        Kind("dossier context", "context.toml", changed_table(CONTEXT), load_context),
    ]  # fmt: skip


def _of_sessions(folder: Path) -> list[Kind]:
    """Trials, sessions, markers, fit files."""
    from bench_hw.tables import read_marker_csv
    from benchmark.files import load_session
    from benchmark.files.sessions.fit_table import FitTable
    from benchmark.runs.parameters_run import ParameterWish

    press = trial_text(40)
    del folder
    return [
        Kind("trial csv", "c/t.csv", changed_rows(press), lambda path: load_session(path.parent)),
        Kind("trial csv bytes", "c/t.csv", changed_bytes(press.encode()), lambda path: load_session(path.parent)),
        Kind("session.toml", "s/session.toml", changed_table(SESSION), lambda path: load_session(path.parent)),
        Kind("markers csv", "m/t_markers.csv", changed_rows(MARKERS), read_marker_csv),
        Kind("fit file", "fit.toml", changed_table({"fit": SESSION["fit"]}),
             lambda path: ParameterWish(file=path).table(FitTable())),
        Kind("force csv, imported", "f.csv", changed_rows(press), _cli("bench_hw", "import", "{}", *MAPS, "--out",
                                                                       "out.csv", out="out.csv")),
    ]  # fmt: skip


def _of_results(folder: Path) -> list[Kind]:
    """What verbs wrote and others read: results, baselines, tables."""
    from benchmark.files import load_scenario
    from benchmark.gate.baseline import read_baseline
    from benchmark.models import read_reference
    from benchmark.runs.finished.saved_run import read_run

    finished = folder.parent / "finished"
    scenario = load_scenario(str(finished / "scenario.toml"))
    result = loads((finished / "results.json").read_text())
    deep = (finished / "tables" / "max_deformation.csv").read_text()
    timing = (finished / "tables" / "timing.csv").read_text()
    (folder / "run").mkdir(exist_ok=True)
    _with(finished, folder / "run" / "none")
    return [
        Kind("reference csv", "r.csv", changed_rows(deep), lambda path: read_reference(path, scenario)),
        Kind("results.json", "run/results.json", changed_json(result), lambda path: read_run(_with(finished, path))),
        Kind("results.json bytes", "run/results.json", changed_bytes(dumps(result).encode()),
             lambda path: read_run(_with(finished, path))),
        Kind("run's table", "run/tables/max_deformation.csv", changed_rows(deep),
             lambda path: read_run(_with(finished, path))),
        Kind("run's timing", "run/tables/timing.csv", changed_rows(timing),
             lambda path: read_run(_with(finished, path))),
        Kind("result in a dossier", "run/results.json", changed_json(result), _dossier(finished)),
        Kind("gate's history", "checks.jsonl",
             changed_table(CHECKED, lambda one: f"{dumps(CHECKED)}\n{dumps(one)}\n" * 3),
             _cli("benchmark", "report", "{}", "--out", "drawn", out="drawn")),
        Kind("baseline.json", "b.json", changed_json(BASELINE), read_baseline),
        Kind("baseline.json bytes", "b.json", changed_bytes(dumps(BASELINE).encode()), read_baseline),
    ]  # fmt: skip


def _of_solvers() -> list[Kind]:
    """What other finite-element codes print, given as `--reference`."""
    from benchmark.models import read_reference
    from tests.benchmark.models.fea_results.test_solver_results import SCENARIO, TEXTS

    return [
        Kind(f"reference {name}", f"solver/{name}", changed_bytes(text.encode()),
             lambda path: read_reference(path, SCENARIO))
        for name, text in TEXTS.items()
    ]  # fmt: skip


def _of_presses(folder: Path) -> list[Kind]:
    """Records of a hand, messages of a page that is open, and a recording that grows while it is watched."""
    from benchmark.files import load_scenario
    from benchmark.press.live_capture import LiveCapture
    from benchmark.press.press_server import FemOnDemand
    from benchmark.press.pressed_specimen import pressed_specimen

    asked = FemOnDemand([pressed_specimen(load_scenario("skin-5N", {"fem.mesh": "coarse", "load.peak": "2 N"}))])

    def answered(path: Path) -> None:
        answer = asked.answer(path.read_bytes().decode("utf-8", "replace"))
        dumps(answer, allow_nan=False)
        if "error" in answer:
            raise RefusedError(answer["error"])

    def watched(path: Path) -> None:
        live = LiveCapture(path)
        for _ in range(3):
            if "error" in (news := live.look()):
                raise RefusedError(news["error"])

    message = {"press": 0, "history": [[0.1, 1e-4], [0.2, 2e-4]], "strength": [0.3], "time_s": [1.0]}
    record, cut = attempt_text(0.05, 120), (folder.parent / "cut.mcap").read_bytes()
    assess = _cli("benchmark", "assess", "{}", "--out", "assessed", out="assessed")
    return [
        Kind("record to assess", "hand/attempt.csv", changed_rows(record), assess),
        Kind("record to assess, bytes", "hand/attempt.csv", changed_bytes(record.encode()), assess),
        Kind("message to press", "message.json", changed_json(message), answered),
        Kind("message to press, bytes", "message.json", changed_bytes(dumps(message).encode()), answered),
        Kind("recording, watched", "live/trial_001.mcap.part", changed_bytes(cut), watched),
    ]


def _of_bench(folder: Path) -> list[Kind]:
    """Rigs, protocols, cameras, recordings, pictures."""
    from bench_hw.configuration import read_toml
    from bench_hw.motion.protocol_file import shipped_protocols
    from bench_hw.rig.rig_file import load_rig, shipped_rigs
    from bench_hw.trial_file import read_trial_mcap

    scene = folder.parent
    rig = read_toml(shipped_rigs()["simulated"])[0]
    protocol = read_toml(shipped_protocols()["paper_press"])[0]
    data = (scene / "trial.mcap").read_bytes()
    picture = (scene / "pictures" / "frame_003.png").read_bytes()
    film = ("track", str(folder / "film"), "--camera", str(scene / "camera.toml"), "--out", "out.csv")
    shutil.copytree(scene / "pictures", folder / "film", dirs_exist_ok=True)
    dry = ("capture", "{}", "--dry-run")
    still = ("track", str(scene / "pictures"), "--camera", "{}", "--out", "out.csv")
    return [
        Kind("rig.toml", "rig.toml", changed_table(rig), load_rig),
        Kind("protocol.toml", "pr.toml", changed_table(protocol), _cli("bench_hw", *dry)),
        Kind("camera.toml", "cam.toml", changed_bytes(CAMERA.encode()), _cli("bench_hw", *still, out="out.csv")),
        Kind("picture of a film", "film/frame_003.png", changed_bytes(picture), _cli("bench_hw", *film, out="out.csv")),
        Kind("trial mcap", "t.mcap", changed_bytes(data), read_trial_mcap),
        Kind("trial mcap, inspected", "t.mcap", changed_bytes(data), _cli("bench_hw", "inspect", "{}")),
        Kind("trial mcap, recovered", "t.mcap", changed_bytes(data),
             _cli("bench_hw", "recover", "{}", "--out", "out.mcap", out="out.mcap")),
        Kind("trial mcap, exported", "t.mcap", changed_bytes(data),
             _cli("bench_hw", "export", "{}", "--out", "out", out="out")),
    ]  # fmt: skip


def _of_others(folder: Path) -> list[Kind]:
    """Surfaces, and files of instruments."""
    from fem import read_surface
    from tests.instruments.samples import SAMPLES

    def surface(path: Path) -> object:
        return read_surface(path, "mm")

    return [
        Kind("surface obj", "s.obj", changed_bytes(SURFACE.encode()), surface),
        Kind("surface stl", "s.stl", changed_bytes(f"solid a\n{FACETS}endsolid a\n".encode()), surface),
        Kind("surface ply", "s.ply", changed_bytes(PLY.encode()), surface),
        *(_of_instrument(name, folder) for name in SAMPLES),
    ]


def _of_instrument(name: str, folder: Path) -> Kind:
    from tests.instruments.samples import SAMPLES

    place = folder / "instruments"
    place.mkdir(exist_ok=True)
    sample = SAMPLES[name].write(place)
    command = _cli("bench_hw", "import", "{}", "--out", "out", out="out")
    return Kind(f"instrument: {name}", f"instruments/{sample.name}", changed_bytes(sample.read_bytes()), command)


def tissue_with_deviations(table: dict[str, Any]) -> dict[str, Any]:
    """A tissue as `fit --free` writes it, with what it is uncertain by."""
    layers = [{**each, "youngs_modulus": f"{each['youngs_modulus']} +/- 10 %"} for each in table["layers"]]
    return {**table, "layers": layers}


def _cli(module: str, *words: str, out: str = "") -> Callable[[Path], object]:
    """A command line in this process, in the folder above its file; `{}` stands for the file."""

    def read(path: Path) -> None:
        place = path.parent / (out or "nothing")
        err = io.StringIO()
        said = [
            str(place) if before == "--out" else word.format(path)
            for before, word in zip(("", *words), words, strict=False)
        ]
        with redirect_stderr(err), redirect_stdout(io.StringIO()):
            code = _code(module, said)
        shutil.rmtree(place, ignore_errors=True) if place.is_dir() else place.unlink(missing_ok=True)
        text = err.getvalue().strip()
        if code not in CONTRACT or not is_plain(text):
            raise RuntimeError(f"exit {code}: {text[-400:]}")
        if code:
            raise RefusedError(text)

    return read


def _code(module: str, words: list[str]) -> int:
    with patch.object(sys, "argv", ["torture", *words]):
        try:
            if module == "benchmark":
                from benchmark.cli.app import main

                return main(words)
            from bench_hw.cli import main as bench

            return bench()
        except SystemExit as end:
            return end.code if isinstance(end.code, int) else 1


def _dossier(finished: Path) -> Callable[[Path], object]:
    command = _cli("benchmark", "dossier", "{}", "--out", "gathered", out="gathered")
    return lambda path: command(_with(finished, path))


def _load(path: Path) -> object:
    from benchmark.files import load_scenario

    return load_scenario("skin-5N", {"load": f'{{ shape = "table", file = "{path}" }}'})


def _with(finished: Path, path: Path) -> Path:
    """A folder of a run whose other files are whole."""
    folder = next(parent for parent in path.parents if parent.name == "run")
    for file in finished.rglob("*"):
        place = folder / file.relative_to(finished)
        if file.is_file() and place != path and file.suffix != ".vtu":
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, place)
    return folder
