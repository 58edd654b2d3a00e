"""One scenario on several tissues: a run of each in a folder of its own, and one report that sets them side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.models import Own
from benchmark.runs.options import Listener, RunOptions
from benchmark.runs.output.destination import destination, file_name
from benchmark.runs.output.document import describe_environment
from benchmark.runs.output.run_folder import RunOutcome, write_run
from benchmark.runs.output.unfinished import unfinished
from benchmark.runs.record import RunRecord
from benchmark.runs.report import tissues_page
from benchmark.runs.scenario_run import run_scenario
from benchmark.runs.tables import tissue_columns
from reports import whole_folder, write_csv, write_json, write_page


def run_tissues(
    name: str,
    tissues: Sequence[str],
    settings: Mapping[str, str],
    out: Path | None,
    own: Own,
    options: RunOptions,
    listener: Listener,
) -> list[RunOutcome]:
    """Run the scenario called `name` on each tissue and compare the results.

    The folder holds `TISSUE/` with the whole result of each, `report.html`, `tables/tissues.csv` and `results.json`.

    Returns
    -------
    list of RunOutcome
        The comparison, then each tissue's run.

    Raises
    ------
    InputError
        A tissue that cannot be read, or two of one name.
    SolverError
        A model's process failed; nothing is written then.
    """
    folders = [file_name(Path(tissue).stem) for tissue in tissues]
    if len(set(folders)) < len(folders):
        raise InputError(f"--tissue: {', '.join(tissues)} are not different; each needs a name of its own")
    scenarios = [load_scenario(name, {**settings, "tissue": tissue}) for tissue in tissues]
    target = destination(out, f"{scenarios[0].name}-tissues")
    with unfinished(target) as keep:
        records = {
            folder: run_scenario(
                scenario, replace(options, keep=keep / folder), listener, name=f"{scenario.name}, {folder}", own=own
            )
            for folder, scenario in zip(folders, scenarios, strict=True)
        }
        document = _document(records)
        page = tissues_page(records, describe_environment(seed=options.seed))
        with whole_folder(target) as new:
            outcomes = [write_run(record, new / folder) for folder, record in records.items()]
            write_csv(new / "tables" / "tissues.csv", tissue_columns(records))
            write_json(new / "results.json", document)
            write_page(new / "report.html", page)
    whole = RunOutcome(target, document, page.verdict.headline, complete=True, warnings=())
    return [whole, *(replace(outcome, folder=target / outcome.folder.name) for outcome in outcomes)]


def _document(records: Mapping[str, RunRecord]) -> dict[str, Any]:
    """`results.json` of the comparison."""
    first = next(iter(records.values()))
    return {
        "schema": 1,
        "name": f"{first.scenario.name} on {len(records)} tissues",
        "scenario": first.scenario.name,
        "complete": all(record.complete for record in records.values()),
        "tissues": list(records),
        "table": tissue_columns(records),
    }
