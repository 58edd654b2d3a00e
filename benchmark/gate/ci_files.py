"""A check where CI services show it: JUnit XML for their lists of tests, Markdown for a summary or a comment."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree

from benchmark.gate.accuracy import AccuracyRow
from benchmark.gate.timing import TimingRow
from benchmark.gate.verdict import CheckVerdict, time_words, value_words
from reports.formatting import counted

SUITE = "tissuebench check"
HEADING = "Regression check `"
JUNIT_SIGN, MARKDOWN_SIGN = f'<testsuites name="{SUITE}'.encode(), HEADING.encode()
"""What tells these files from others that must not be replaced."""


def junit_text(verdict: CheckVerdict) -> str:
    """The check as JUnit XML, which Jenkins and GitLab read: one test case a gated quantity."""
    groups: Sequence[tuple[str, list[tuple[str, str | None]]]] = (
        ("accuracy", [(row.quantity, None if row.passed else value_words(row)) for row in verdict.accuracy]),
        ("time", [(row.quantity, None if row.passed else time_words(row)) for row in verdict.timing]),
    )
    root = ElementTree.Element("testsuites", name=f"{SUITE}: {verdict.gate}")
    for name, cases in groups:
        failed = sum(failure is not None for _, failure in cases)
        counts = {"tests": str(len(cases)), "failures": str(failed), "errors": "0", "skipped": "0"}
        suite = ElementTree.SubElement(root, "testsuite", {"name": f"{verdict.gate}.{name}", **counts})
        for quantity, failure in cases:
            place = f"{verdict.gate}.{name}"
            case = ElementTree.SubElement(suite, "testcase", classname=place, name=quantity, time="0")
            if failure is not None:
                kind = "changed" if name == "accuracy" else "slower"
                ElementTree.SubElement(case, "failure", message=failure, type=kind).text = failure
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def markdown_text(verdict: CheckVerdict) -> str:
    """The check as Markdown: verdict, what got worse or better, times, and what a check here would have seen."""
    mark = "✅" if verdict.passed else "❌"
    parts = [
        f"### {mark} {HEADING}{verdict.gate}`\n\n{verdict.headline()}",
        f"Values against {verdict.accuracy_source}; times against {verdict.timing_source}.",
        _bullets("Got worse", verdict.failures()),
        _bullets("Got better", verdict.improvements()),
        _times(verdict.timing),
        _power(verdict),
        _bullets("Read these before you trust the verdict", verdict.warnings),
        _values(verdict.accuracy),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def _bullets(title: str, lines: Sequence[str]) -> str:
    return "" if not lines else f"**{title}**\n\n" + "\n".join(f"- {_plain(line)}" for line in lines)


def _times(rows: Sequence[TimingRow]) -> str:
    if not rows:
        return ""
    head = "| time | change | 95 % interval | allowed | |\n|---|---|---|---|---|"
    lines = [
        f"| {_plain(row.quantity)} | {_share(row.now, row)} | {_share(row.ci95[0], row)} to {_share(row.ci95[1], row)} "
        f"| {_share(row.allowed, row)} | {'ok' if row.passed else '**slower**'} |"
        for row in rows
    ]
    return "\n".join([head, *lines])


def _share(value: float, row: TimingRow) -> str:
    """A time as its distance from the baseline's."""
    return f"{100 * (value / row.baseline - 1.0):+.1f} %"


def _power(verdict: CheckVerdict) -> str:
    """The smallest slowdown and the smallest change of a value that this check would have seen."""
    worst = max(verdict.timing, key=lambda row: row.caught, default=None)
    seen = [] if worst is None else [f"a slowdown of {100 * worst.caught:.0f} % in 19 of 20 checks ({worst.quantity})"]
    shares = [row.allowed / abs(row.baseline) for row in verdict.accuracy if row.baseline and row.at is None]
    seen += [f"a value off by {100 * max(shares):.2g} % in every check"] if shares else []
    return f"Seen at least: {'; '.join(seen)}." if seen else ""


def _values(rows: Sequence[AccuracyRow]) -> str:
    head = "| value | baseline | now | allowed difference | |\n|---|---|---|---|---|"
    lines = [
        f"| {_plain(row.label)} | {_number(row.baseline)} | {_number(row.now)} | {row.allowed:.2g} {row.unit} "
        f"| {'ok' if row.passed else '**changed**'} |"
        for row in rows
    ]
    table = "\n".join([head, *lines])
    return f"<details><summary>{counted(len(rows), 'gated value')}</summary>\n\n{table}\n\n</details>"


def _number(value: float | None) -> str:
    return "none" if value is None else f"{value:.7g}"


def _plain(text: str) -> str:
    """Text in which Markdown and HTML mean nothing."""
    for sign, instead in (("&", "&amp;"), ("<", "&lt;"), ("|", "\\|"), ("*", "\\*"), ("_", "\\_"), ("`", "\\`")):
        text = text.replace(sign, instead)
    return " ".join(text.split())
