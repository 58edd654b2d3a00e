"""The page of a check."""

import re
from dataclasses import replace

from benchmark.gate.check_page import check_page
from benchmark.gate.history.history_file import HistoryEntry
from benchmark.gate.versions import Origin
from reports import render_page

ORIGIN = Origin(
    {
        "made": "2026-01-02T03:04:05+00:00",
        "processor": "any",
        "usable_cores": 2,
        "python": "3.11.7",
        "packages": {"tissuebench": "0.1.0", "numpy": "2", "scipy": "1", "pypardiso": None},
    },
    "abc+",
)


def entry(ratio: float, allowed: float | None = 2.24) -> HistoryEntry:
    timing = {"frame": {"ratio": ratio, "ci95": [0.99 * ratio, 1.01 * ratio], "allowed": allowed}}
    return HistoryEntry("2026-01-02", "abc", "any", None, True, {}, timing)


def words(html: str) -> str:
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", html))


def test_a_failed_check_leads_with_what_failed(verdict) -> None:
    noisy = replace(verdict(slow=True), warnings=["the machine is noisy"])
    html = render_page(check_page(noisy, [entry(2.0), entry(2.6)], ORIGIN))
    text = words(html)
    assert text.index("1 of 1 timing slower") < text.index("the machine is noisy") < text.index("Trend")
    assert "frame: baseline 2 x the reference workload, now 2.6" in text
    assert "abc+" in text


def test_chances_of_error_are_said(verdict) -> None:
    text = words(render_page(check_page(verdict(), [], ORIGIN)))
    assert "chance of a false alarm" in text
    assert "chance to miss twice the margin" in text
    assert "below 1e-06" in text


def test_the_trend_needs_two_checks(verdict) -> None:
    one, two = ([entry(2.0)] * count for count in (1, 2))
    assert "<svg" not in render_page(check_page(verdict(), one, ORIGIN))
    assert "<svg" in render_page(check_page(verdict(), two, ORIGIN))


def test_a_gate_without_times_has_a_page(verdict) -> None:
    text = words(render_page(check_page(replace(verdict(), timing=[]), [], ORIGIN)))
    assert "This gate times nothing" in text


def test_names_are_escaped(verdict) -> None:
    html = render_page(check_page(replace(verdict(), gate="<b>mine</b>"), [], ORIGIN))
    assert "<b>mine</b>" not in html
