"""A check from request to result folder: measure, compare, write `check.json`, tables and report."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from benchmark.gate.accuracy import AccuracyRow, compare_values, curve_remarks, unsteady_remarks, wide_remarks
from benchmark.gate.baseline import StoredValue, differing
from benchmark.gate.check_basis import CheckBasis, stored_baseline
from benchmark.gate.check_page import check_page
from benchmark.gate.ci_files import JUNIT_SIGN, MARKDOWN_SIGN, junit_text, markdown_text
from benchmark.gate.history.history_file import HISTORY_SIGN, HistoryEntry, append, read_history
from benchmark.gate.plan import CheckRequest, GatePlan, load_plan
from benchmark.gate.processes import Measured, Party, measure
from benchmark.gate.timing import DECISIVE, Judge, TimingRow
from benchmark.gate.verdict import CheckVerdict
from benchmark.gate.versions import Origin, gated_values, origin_of, rival, this_version
from benchmark.runs.options import Listener
from benchmark.runs.output.destination import check_file, claimed, destination, remove_earlier
from reports import write_csv, write_json, write_page, write_text, write_whole
from reports.formatting import counted


@dataclass(frozen=True)
class CheckOutcome:
    """A finished check on disk: its folder, the verdict, and the content of `check.json`."""

    folder: Path
    verdict: CheckVerdict
    document: dict[str, Any]

    @property
    def report(self) -> Path:
        """The page."""
        return self.folder / "report.html"


def check(request: CheckRequest, listener: Listener) -> CheckOutcome:
    """Compare this version with a baseline or another revision, write a report, and add to the history.

    An earlier check's files for a CI service are removed first: one that ends with an error leaves none.

    Raises
    ------
    NotComparableError
        No baseline, one of another schema or gate, or a revision that this gate cannot measure.
    InputError
        Files or options that cannot be used.
    SolverError
        This version's code fails, beyond a solver that stops early.
    OSError
        Where the file system refuses; no report is written then.
    """
    remove_earlier(request.junit, JUNIT_SIGN)
    remove_earlier(request.markdown, MARKDOWN_SIGN)
    with claimed(request.out, "check"):
        inputs = (request.baseline_path, request.gate, request.history_path)
        return _checked(request, destination(request.out, "check", inputs), listener)


def _checked(request: CheckRequest, folder: Path, listener: Listener) -> CheckOutcome:
    check_file(request.junit, "--junit", JUNIT_SIGN, "the list of a check")
    check_file(request.markdown, "--markdown", MARKDOWN_SIGN, "the summary of a check")
    check_file(request.history_path, "--history", HISTORY_SIGN, "a history of checks")
    plan = load_plan(request.gate)
    baseline = stored_baseline(request, plan)
    origin = origin_of(plan, request.seed)
    with ExitStack() as stack:
        other = None if request.against is None else stack.enter_context(rival(plan, request.against))
        basis = CheckBasis(baseline, other, str(request.baseline_path))
        verdict, measured = _verdict(plan, basis, origin, request.seed, listener)
    verdict = replace(verdict, warnings=(*verdict.warnings, *_record(request, origin, verdict)))
    entries, _ = read_history(request.history_path)
    _write_for_ci(request, verdict)
    return CheckOutcome(folder, verdict, write_check(folder, verdict, measured, entries, origin))


def _write_for_ci(request: CheckRequest, verdict: CheckVerdict) -> None:
    if request.junit is not None:
        write_text(request.junit, junit_text(verdict))
    if request.markdown is not None:
        write_text(request.markdown, markdown_text(verdict))


def _verdict(
    plan: GatePlan, basis: CheckBasis, origin: Origin, seed: int, listener: Listener
) -> tuple[CheckVerdict, Measured]:
    """Measure and compare."""
    head, file = this_version(plan), plan.file
    listener.say(f"gate {file.name}: values of {counted(len(plan.cases), 'case')}")
    values = gated_values(head)
    compared = basis.values()
    accuracy = compare_values(values, compared, file.tolerances, basis.values_from)
    measured, timing = _times(head, basis, origin, seed, listener)
    accepted = basis.accepted_here(origin)
    unseen = (
        f"the baseline was accepted at this same revision, and {differing(accepted)} from the one before: unseen here"
    )
    warnings = (
        *([unseen] if accepted else []),
        *curve_remarks(values, compared, basis.values_from),
        *wide_remarks(values, file.tolerances),
        *unsteady_remarks(values, _once_more(head, accuracy)),
        *basis.remarks(origin, file.timing.other_machine_margin),
        *remarks(measured, timing),
    )
    verdict = CheckVerdict(
        gate=file.name,
        accuracy=accuracy,
        timing=timing,
        accuracy_source=basis.values_from,
        timing_source=basis.times_from,
        rounds=measured.rounds,
        against=None if basis.rival is None else basis.rival.commit,
        warnings=warnings,
        accepted_here=accepted,
    )
    return verdict, measured


def _once_more(head: Party, rows: Sequence[AccuracyRow]) -> Mapping[str, StoredValue]:
    """The values of users' models with a red row, measured again: a model may answer differently each time."""
    red = [row.quantity for row in rows if not row.passed]
    own = [case for case in head.plan.cases if case["own"] is not None]
    cases = tuple(case for case in own if any(name.startswith(f"{case['name']}.") for name in red))
    return gated_values(replace(head, plan=replace(head.plan, cases=cases))) if cases else {}


def _times(
    head: Party, basis: CheckBasis, origin: Origin, seed: int, listener: Listener
) -> tuple[Measured, tuple[TimingRow, ...]]:
    """Measure until it is clear, and judge."""
    file, same = head.plan.file, basis.same_machine(origin)
    judge = Judge(file.timed, file.timing, paired=basis.rival is not None, same_machine=same, seed=seed)
    parties = (head,) if basis.rival is None else (head, basis.rival.party)
    with listener.progress(
        f"gate {file.name}: {counted(len(file.timed), 'time')} against {basis.times_from}"
    ) as advance:
        measured = measure(
            parties,
            lambda found: judge.clear(found.ratios[0], basis.ratios(found)),
            lambda done, most: advance("processes", done, most, ""),
        )
    return measured, judge.rows(measured.ratios[0], basis.ratios(measured))


def remarks(measured: Measured, timing: Sequence[TimingRow]) -> list[str]:
    """What a reader must know of the measurement itself."""
    found = []
    if not measured.sees_waiting:
        found.append(
            "this system does not tell waiting from other programs' turns: times are CPU times, sleep is unseen"
        )
    if measured.rounds < DECISIVE and not all(row.passed for row in timing):
        found.append(
            f"slower by {counted(measured.rounds, 'round')} of processes, of which the gate file allows no more: only "
            f"from {DECISIVE} on are the highest and the lowest left out, and with four an unchanged model was once "
            "18 % slower; rounds = [3, 10] in [timing] decides"
        )
    loud = [row for row in timing if row.caught > row.wanted]
    if loud:
        names = ", ".join(
            f"{row.quantity} ({100 * row.caught:.0f} % instead of {100 * row.wanted:.0f} %)" for row in loud
        )
        found.append(
            f"too noisy to catch a slowdown of twice the margin in 19 of 20 checks: {names}; "
            "more rounds in the gate file, or a quieter machine, help"
        )
    return found


def _record(request: CheckRequest, origin: Origin, verdict: CheckVerdict) -> list[str]:
    """Add the check to the history; what goes wrong there is a warning, since the verdict stands without it."""
    _, unread = read_history(request.history_path)
    lines = f"{request.history_path}: {counted(unread, 'line')} of this history cannot be read, left in place"
    warnings = [lines] if unread else []
    entry = HistoryEntry(
        made=origin.made,
        revision=origin.revision,
        machine=origin.machine.processor,
        against=verdict.against,
        passed=verdict.passed,
        accuracy={row.quantity: row.now for row in verdict.accuracy if row.at is None},
        timing={
            row.quantity: {"ratio": row.now, "ci95": list(row.ci95), "allowed": row.allowed} for row in verdict.timing
        },
    )
    try:
        append(request.history_path, entry)
    except OSError as error:
        warnings.append(f"{request.history_path}: the history cannot be written ({error.strerror or error})")
    return warnings


DOCUMENT = "check.json"


def write_check(
    folder: Path, verdict: CheckVerdict, measured: Measured, history: Sequence[HistoryEntry], origin: Origin
) -> dict[str, Any]:
    """Write a check and return the content of `check.json`.

    Raises
    ------
    OSError
        Where the file system refuses; `folder` is then as it was.
    """
    document = {**verdict.to_dict(), "revision": origin.revision}
    page = check_page(verdict, history, origin)

    def fill(new: Path) -> None:
        write_json(new / DOCUMENT, document)
        write_json(new / "environment.json", origin.environment)
        write_csv(new / "tables" / "accuracy.csv", _columns([row.to_dict() for row in verdict.accuracy]))
        write_csv(new / "tables" / "rounds.csv", round_columns(measured))
        write_page(new / "report.html", page)

    write_whole(folder, fill)
    return document


def round_columns(measured: Measured) -> dict[str, list[Any]]:
    """Every measured process: side, its number, quantity, and time in units of its references."""
    rows = [
        (side, number, quantity, math.exp(value))
        for side, ratios in zip(("now", "against"), measured.ratios, strict=False)
        for quantity, values in ratios.items()
        for number, value in enumerate(values, start=1)
    ]
    names = ("side", "process", "quantity", "ratio")
    return {name: [row[column] for row in rows] for column, name in enumerate(names)}


def _columns(rows: Sequence[Mapping[str, Any]]) -> dict[str, list[Any]]:
    return {name: [row[name] for row in rows] for name in rows[0]}
