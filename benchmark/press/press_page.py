"""What `press` was asked for, and the page it gives: one HTML file, its tables, style and script inside.

The page fetches nothing; its policy lets nothing but its own script run.
"""

from __future__ import annotations

import base64
import hashlib
import json
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

from benchmark.errors import InputError
from benchmark.files import Load, Scenario, load_scenario, load_session, shipped_scenarios, shipped_tissues
from benchmark.files.shipped import shipped_sessions
from benchmark.model_file import RepairedModel
from benchmark.press.pressed_specimen import PressedSpecimen, pressed_specimen
from benchmark.response.model_with_effects import load_repair
from benchmark.runs.options import Listener
from reports.palette import stylesheet
from wavemodel import PublishedWave

DEFAULT = "skin-5N"
DEFAULT_PRESSES: Sequence[Mapping[str, str]] = (
    {},
    {"tool.radius": "2.5 mm"},
    {"tissue": "skin_mri_indentation"},
    {"tissue": "skin_porcine_fat", "load.peak": "1 N"},
    {"tissue": "ecoflex_00_30"},
)
"""Changes of the default scenario that a page without a request offers."""
SIGN = b"<title>Press it:"
"""What tells the page from other files that must not be replaced."""
SCRIPTS = ("wave.js", "hands.js", "scene.js", "app.js")
"""In the order in which they stand in the page; the first two run without one."""


@dataclass(frozen=True)
class PressRequest:
    """What the command line asked for; see `python -m benchmark press --help`."""

    what: str | None = None
    tissues: Sequence[str] = ()
    tools: Sequence[str] = ()
    settings: Mapping[str, str] = field(default_factory=dict)
    model: Path | None = None


def specimens(request: PressRequest, listener: Listener) -> list[PressedSpecimen]:
    """Set up every press that was asked for.

    Raises
    ------
    InputError
        Something that cannot be read or pressed.
    """
    scenarios, repair = _resolved(request)
    found = []
    with listener.progress("setting up what can be pressed") as advance:
        for done, scenario in enumerate(scenarios, 1):
            found.append(pressed_specimen(scenario, repair))
            advance("presses", done, len(scenarios), scenario.tissue.name)
    return found


def _resolved(request: PressRequest) -> tuple[list[Scenario], RepairedModel | None]:
    what = Path(request.what) if request.what is not None else None
    if what is not None and what.is_dir():
        inside = [what / name for name in ("scenario.toml", "model.toml") if (what / name).is_file()]
        if not inside:
            repair = None if request.model is None else load_repair(request.model)
            return _varied(_of_session(what, request.settings), request), repair
        what = inside[0]
    if what is not None and what.suffix == ".toml" and "effects" in _keys(what):
        if request.model is not None:
            raise InputError(f"{what} is a model file, and --model gives another: give one of them")
        found = load_repair(what)
        return _varied(_base_of(found, request), request), found
    repair = None if request.model is None else load_repair(request.model)
    if what is None and repair is None and not (request.tissues or request.tools):
        return [load_scenario(DEFAULT, {**change, **request.settings}) for change in DEFAULT_PRESSES], None
    return _varied(_scenario(what, request), request), repair


def _keys(path: Path) -> set[str]:
    """The first-level keys of a TOML file; none where it cannot be read, which its own reader then says."""
    try:
        return set(tomllib.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return set()


def _scenario(what: Path | None, request: PressRequest) -> Scenario:
    """The scenario that a word or a file means; a tissue is pressed as in the default one."""
    if what is None:
        return load_scenario(DEFAULT, request.settings)
    name = str(what)
    is_tissue = name in shipped_tissues() or (what.suffix == ".toml" and "layers" in _keys(what))
    if is_tissue:
        return load_scenario(DEFAULT, {"tissue": name, **request.settings})
    if name in shipped_sessions() and name not in shipped_scenarios():
        return _of_session(shipped_sessions()[name], request.settings)
    if what.suffix != ".toml" and name not in shipped_scenarios():
        known = ", ".join((*shipped_scenarios(), *shipped_tissues()))
        raise InputError(
            f"{name!r} is no scenario, tissue, run or model file; these ship: {known}. A path to a file of your own "
            "ends in .toml."
        )
    return load_scenario(name, request.settings)


def _base_of(repair: RepairedModel, request: PressRequest) -> Scenario:
    """What a model file was found on: the shipped session it names, else its tissue under the default tool.

    Raises
    ------
    InputError
        Neither ships: the session or the tissue is to be named beside the file.
    """
    session = shipped_sessions().get(str(repair.evidence.get("session", repair.tissue)))
    if session is not None:
        return _of_session(session, request.settings)
    if repair.tissue not in shipped_tissues():
        raise InputError(
            f"{request.what}: the tissue of this model, {repair.tissue!r}, does not ship; allowed: the session that it "
            "was found on, or a tissue's TOML file, with the model beside it: press SESSION --model model.toml"
        )
    return load_scenario(DEFAULT, {"tissue": repair.tissue, **request.settings})


def _of_session(path: Path, settings: Mapping[str, str]) -> Scenario:
    """The specimen, tool and support of a session, pressed as deep as its trials.

    Raises
    ------
    InputError
        The folder holds no result and no session.
    """
    try:
        read = load_session(path, settings)
    except InputError as error:
        results = "no result of run or discover (no scenario.toml and no model.toml), and no session of trials"
        raise InputError(f"{path} is {results}: {error}") from error
    deepest = max(float(trial.table.depth.max()) for trial in read.trials)
    load = Load(control="depth", peak=deepest, shape="ramp", duration=1.0, observations=1)
    return read.scenario(read.specimen, read.tool, read.support, load)


def _varied(scenario: Scenario, request: PressRequest) -> list[Scenario]:
    """The scenario, and it with each further tissue and tool."""
    from benchmark.files import Source, scenario_from_table

    table, source = scenario.to_table(), Source("press")
    asked = [("--tissue", "tissue", tissue) for tissue in request.tissues]
    asked += [("--tool", "tool.radius", radius) for radius in request.tools]
    found = [scenario]
    for option, key, value in asked:
        try:
            found.append(scenario_from_table(table, source, {key: value}))
        except InputError as error:
            raise InputError(f"{option}: {str(error).removeprefix(f'--set {key}: ')}") from error
    return found


def document(found: Sequence[PressedSpecimen]) -> dict[str, Any]:
    """What the page draws: every press with its tables, and the article's membrane, as plain JSON values."""
    return {
        "schema": 1,
        "specimens": [_specimen(one) for one in found],
        "published": {
            name: _published(variant) for name, variant in (("printed", "as_printed"), ("corrected", "corrected"))
        },
    }


def _specimen(one: PressedSpecimen) -> dict[str, Any]:
    scenario, ramp = one.scenario, one.fem
    return {
        "name": scenario.name,
        "tissue": scenario.tissue.name,
        "layers": [{"name": layer.name, "thickness_m": layer.thickness} for layer in scenario.tissue.layers],
        "contact": scenario.tool.contact,
        "support": scenario.support.kind,
        "hole_radius_m": scenario.support.hole_radius,
        "wave": one.wave.to_dict(),
        "memory": one.memory.to_dict(),
        "fem": None
        if ramp is None
        else {
            "table": ramp.table.to_dict(),
            "unknowns": ramp.unknowns,
            "levels": ramp.levels,
            "setup_s": ramp.setup_seconds,
            "wall_s": ramp.wall_seconds,
            "cpu_s": ramp.cpu_seconds,
        },
        "after": None if one.after is None else {"table": one.after.to_dict(), "memory": one.after_memory.to_dict()},
        "effects": list(one.effects),
        "remarks": list(one.remarks),
    }


def _published(variant: str) -> dict[str, float]:
    wave = PublishedWave(variant)
    coefficient = float(wave.coefficient[0, 0])
    return {
        "side_m": wave.side,
        "coefficient_m": coefficient,
        "frequency_per_s": float(wave.frequency[0, 0]),
        "deepest_m": 1e-3 if variant == "as_printed" else abs(coefficient),
    }


def render_press_page(document: Mapping[str, Any], *, served: bool = False, live: bool = False) -> str:
    """The page.

    Parameters
    ----------
    document
        What `document` gives.
    served
        Whether it may speak with the server that it came from; a saved file may speak with nobody.
    live
        Whether it shows a running capture, too.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined

    templates = Environment(
        loader=PackageLoader("benchmark.press", "page"), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    code = script(*SCRIPTS, *(("live.js",) if live else ()))
    data = json.dumps(document, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    ramps = [one["fem"]["levels"] for one in document["specimens"] if one["fem"] is not None]
    return templates.get_template("press.html.j2").render(
        palette=stylesheet(),
        style=part("press.css"),
        script=code,
        policy=f"'sha256-{base64.b64encode(hashlib.sha256(code.encode()).digest()).decode('ascii')}'",
        data=data,
        served=served,
        live=live,
        levels=max(ramps, default=0),
        version=version("tissuebench"),
    )


def script(*names: str) -> str:
    """The page's script, of these files (all that a page without a capture has)."""
    return "\n" + "\n".join(part(name) for name in names or SCRIPTS)


def part(name: str) -> str:
    """One of the page's files."""
    return files("benchmark.press").joinpath("page", name).read_text("utf-8")
