"""The trend over the checks in a history."""

from dataclasses import replace

import pytest

from benchmark.gate.history.history_file import HistoryEntry
from benchmark.gate.history.trend import MOST_CHECKS, trend_figure, trends


def entry(ratio: float, *, machine: str = "A", against: str | None = None, accepted: bool = False) -> HistoryEntry:
    timing = {
        "frame": {
            "ratio": ratio,
            "ci95": None if accepted else [0.98 * ratio, 1.02 * ratio],
            "allowed": None if accepted else 2.24,
        }
    }
    return HistoryEntry("2026-01-02", "abc", machine, against, None if accepted else True, {}, timing)


def test_checks_are_relative_to_the_first() -> None:
    (found,) = trends([entry(2.0, accepted=True), entry(2.1), entry(2.6)], "A", against=False)
    assert [point.ratio for point in found.points] == pytest.approx([1.0, 1.05, 1.3])
    assert [point.failed for point in found.points] == [False, False, True]
    assert found.points[0].ci95 is None
    assert found.points[1].ci95 == pytest.approx((0.98 * 1.05, 1.02 * 1.05))
    assert found.points[2].allowed == pytest.approx(1.12)


def test_only_alike_checks_are_in_one_trend() -> None:
    history = [entry(2.0), entry(9.0, machine="B"), entry(7.0, against="abc"), entry(2.2)]
    (found,) = trends(history, "A", against=False)
    assert [point.ratio for point in found.points] == pytest.approx([1.0, 1.1])
    assert trends(history, "A", against=True) == []
    assert trends([], "A", against=False) == []


def test_quantities_that_are_gone_or_new() -> None:
    new = replace(entry(2.0), timing={**entry(2.0).timing, "fit": {"ratio": 1.0, "ci95": None, "allowed": None}})
    assert [each.quantity for each in trends([entry(2.0), new], "A", against=False)] == ["frame"]
    assert [each.quantity for each in trends([entry(2.0), new, new], "A", against=False)] == ["frame", "fit"]
    assert trends([new, replace(entry(2.0), timing={})], "A", against=False) == []


def test_a_long_history_shows_its_end() -> None:
    (found,) = trends([entry(1.0 + k) for k in range(MOST_CHECKS + 20)], "A", against=False)
    assert len(found.points) == MOST_CHECKS
    assert found.points[-1].ratio == pytest.approx((MOST_CHECKS + 20) / 21)


def test_the_figure_says_what_it_shows() -> None:
    figure = trend_figure(trends([entry(2.0), entry(2.6)], "A", against=False))
    assert figure.panels[0].title == "frame"
    assert "1 called slower" in figure.panels[0].alt
    assert "1 to 1.3" in figure.panels[0].alt
    assert figure.panels[0].svg.startswith("<svg") or "<svg" in figure.panels[0].svg
