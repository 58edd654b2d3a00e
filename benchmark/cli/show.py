"""What a finished run prints: verdict, warnings, where the report is."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmark.cli.console import Console
from benchmark.errors import SolverError
from benchmark.runs import RunOutcome

if TYPE_CHECKING:
    from benchmark.discovery.report.discovery_files import DiscoveryOutcome


def show_runs(
    outcomes: Sequence[RunOutcome], console: Console, *, as_json: bool, found: DiscoveryOutcome | None = None
) -> int:
    """Print the outcomes and return the exit code; `found` joins them in the JSON object.

    Raises
    ------
    SolverError
        A solver stopped early; results up to there are on disk.
    """
    if as_json:
        objects = [{**outcome.document, "out": str(outcome.folder)} for outcome in outcomes]
        more = {} if found is None else {"discovery": {**found.document, "out": str(found.folder)}}
        print_json(objects[0] if len(objects) == 1 else {"schema": 1, "runs": objects, **more})
    for outcome in outcomes:
        for warning in outcome.warnings:
            console.say(f"  warning: {warning}")
        if not as_json:
            print(f"{outcome.document['name']}: {outcome.headline}")
            fem = outcome.document.get("models", {}).get("fem", {}).get("notes", {})
            if "discretisation error" in fem:
                print(f"  FEM mesh: {fem['discretisation error']}")
            print(f"  report: {outcome.report}")
    stopped = [outcome for outcome in outcomes if not outcome.complete]
    if stopped:
        several = len(outcomes) > 1
        said = [(f"{outcome.document['name']}: " if several else "") + _stopped(outcome) for outcome in stopped]
        raise SolverError(". ".join(said))
    return 0


def _stopped(outcome: RunOutcome) -> str:
    """Why the models of a run stopped early, and where what they reached is."""
    failures = [
        f"{model['name']} {model['failure']}{_last(outcome.folder, model)}"
        for model in outcome.document["models"].values()
        if model["failure"]
    ]
    return f"{'; '.join(failures)}. Results up to there are in {outcome.folder}, marked incomplete"


def show_discovery(outcome: DiscoveryOutcome, console: Console, *, as_json: bool) -> int:
    """Print what a discovery found and return exit code 0."""
    for warning in outcome.warnings:
        console.say(f"  warning: {warning}")
    if as_json:
        print_json({**outcome.document, "out": str(outcome.folder)})
    else:
        print(
            f"{outcome.document['name']}: {outcome.document['verdict']}: {outcome.headline}\n"
            f"  report: {outcome.folder / 'report.html'}"
        )
        for line in outcome.lines:
            print(f"  {line}")
    return 0


def _last(folder: Path, model: dict[str, Any]) -> str:
    """How deep the last state of equilibrium is, and where to look at it."""
    last = model["last_state"]
    if last is None:
        return ""
    return f"; that state is {last['depth_mm']:.4g} mm deep, see {folder / last['fields']}"


def print_json(value: Any) -> None:
    """Print one JSON object on stdout."""
    from reports.atomic import plain

    json.dump(plain(value), sys.stdout, indent=2, ensure_ascii=False)
    print()
