"""What a sweep computes, as one object, and how it differs from another."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib import metadata
from pathlib import Path
from typing import Any

from benchmark.errors import InputError
from benchmark.files import Scenario, load_scenario
from benchmark.resumable import code_version
from benchmark.sweeps.design import Design, Point
from benchmark.sweeps.parameter import Parameter

SCHEMA = 1
MOST_DIFFERENCES = 3
CODE = "code_sha256"
"""Key of the code's hash in `sweep.json`; those of earlier versions have none."""
READ = ("tissue", "load.file")
"""Keys whose values name files."""


@dataclass(frozen=True)
class SweepPlan:
    """A scenario, the keys that vary in it, and the points.

    Attributes
    ----------
    scenario : Scenario
        With the values of `--set`, before anything varies.
    parameters : tuple of Parameter
    design : Design
        How the points were chosen.
    points : tuple of Point
        For each point the value of every parameter.
    scenarios : tuple of Scenario or str
        For each point its scenario, or the reason why its values give none.
    """

    scenario: Scenario
    parameters: tuple[Parameter, ...]
    design: Design
    points: tuple[Point, ...]
    scenarios: tuple[Scenario | str, ...]

    @cached_property
    def document(self) -> dict[str, Any]:
        """`sweep.json`: what tells one sweep from another."""
        drawn = json.dumps(self.points, ensure_ascii=False).encode()
        files = self._files()
        return {
            "schema": SCHEMA,
            "program": metadata.version("tissuebench"),
            CODE: code_version(),
            "scenario": self.scenario.to_table(),
            "vary": {parameter.key: parameter.describe() for parameter in self.parameters},
            "sample": self.design.kind,
            "points": len(self.points),
            "seed": self.design.seed,
            "points_sha256": hashlib.sha256(drawn).hexdigest(),
            **({"files": files} if files else {}),
        }

    def _files(self) -> dict[str, str]:
        """SHA-256 of what points read from files that no table above holds: varied tissues and loads, and surfaces."""
        found: dict[str, str] = {}
        for point, scenario in zip(self.points, self.scenarios, strict=True):
            if isinstance(scenario, str):
                continue
            for parameter, text in zip(self.parameters, point, strict=True):
                if parameter.key in READ and (name := f"{parameter.key} {text}") not in found:
                    found[name] = hashlib.sha256(json.dumps(scenario.to_table()).encode()).hexdigest()
            surface = scenario.fem.surface
            if surface is not None and surface not in found:
                found[surface] = _digest(Path(surface))
        return found


def make_plan(scenario: str, settings: Mapping[str, str], parameters: Sequence[Parameter], design: Design) -> SweepPlan:
    """Choose the points and make their scenarios.

    Raises
    ------
    InputError
        A scenario or a key that cannot be used, a key named twice, or no point with a usable scenario. A single point
        with values that do not go together is no error: it is kept with the reason.
    """
    keys = [parameter.key for parameter in parameters]
    for key in keys:
        if keys.count(key) > 1 or key in settings:
            raise InputError(f"{key} is given twice; allowed: once, as --vary or as --set")
    base = load_scenario(scenario, settings)
    points = design.choose(parameters)
    scenarios = tuple(_scenario(scenario, settings, keys, point) for point in points)
    if all(isinstance(each, str) for each in scenarios):
        raise InputError(f"no point of the sweep is usable; the first: {scenarios[0]}")
    return SweepPlan(base, tuple(parameters), design, points, scenarios)


def _scenario(name: str, settings: Mapping[str, str], keys: Sequence[str], point: Point) -> Scenario | str:
    """The scenario of one point, or why there is none."""
    try:
        return load_scenario(name, {**settings, **dict(zip(keys, point, strict=True))})
    except InputError as error:
        text = str(error)
        for key in keys:
            text = text.replace(f"--set {key}", f"--vary {key}")
        return text


def _digest(path: Path) -> str:
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"{path} cannot be read ({error.strerror or error})") from None


def differences(there: Mapping[str, Any], here: Mapping[str, Any]) -> list[str]:
    """What is different between two `sweep.json`, for a person; the points' checksum only where nothing else is."""
    before, now = dict(_flat(there)), dict(_flat(here))
    changed = [key for key in {**before, **now} if before.get(key) != now.get(key)]
    named = [key for key in changed if key != "points_sha256"] or changed
    said = [f"{key} ({_shown(before, key)} there, {_shown(now, key)} here)" for key in named[:MOST_DIFFERENCES]]
    more = len(named) - len(said)
    return [*said, f"{more} more"] if more > 0 else said


def _flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Every value of a nested table with its dotted key; layers by their names."""
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from _flat(item, f"{path}.{key}" if path else str(key))
    elif isinstance(value, list) and value and all(isinstance(item, Mapping) and "name" in item for item in value):
        for item in value:
            yield from _flat(item, f"{path}.{item['name']}")
    else:
        yield path, value


def _shown(table: Mapping[str, Any], key: str) -> str:
    text = repr(table[key]) if key in table else "nothing"
    return text if len(text) <= 60 else f"{text[:57]}..."
