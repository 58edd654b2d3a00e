"""The page of a blind run: what is reached, what is not, what was not measured."""

from dataclasses import replace

import pytest

from benchmark.blind.scoring.judging import IMPOSSIBLE, Judged, table, unanswered
from benchmark.blind.scoring.lab_measures import lab_table
from benchmark.blind.scoring.scoreboard import scoreboard
from benchmark.blind.suites import suite
from reports import Page, Table, render_page

ENVIRONMENT = {"made": "2026-11-23T00:00:00+00:00", "packages": {"tissuebench": "0.1.0"}}
SETTINGS = {"suite": "labs", "seed": 40, "discoverer": "benchmark.discovery:discover"}


def answered(right: bool) -> list[Judged]:
    cases = []
    for name in suite("labs", 40):
        said = name.slug if right and name.kind in ("effect", "pair") else "" if right else "perspective"
        empty = unanswered(name, "named" if said else "no_discrepancy", "")
        cases.append(replace(empty, said=said, reported=said, first_set=said, seconds=20.0))
    return cases


def page_of(cases: list[Judged]) -> Page:
    return scoreboard(SETTINGS, (*table(cases), *lab_table(cases)), cases, ENVIRONMENT)


def rows_of(page: Page, caption: str) -> list[tuple]:
    tables = [block for section in page.sections for block in section.blocks if isinstance(block, Table)]
    return next(list(each.rows) for each in tables if each.caption == caption)


def test_what_is_not_reached_is_said_first() -> None:
    page = page_of(answered(right=False))
    assert page.verdict.status == "finding"
    assert page.verdict.points[0].startswith("right name first: 0.0")
    assert page.verdict.points[-1].endswith("more, below")
    assert page.notices[0].kind == "synthetic"
    misses = rows_of(page, "What was taken for what")
    assert sum(row[-1] for row in misses if row[0] == "none") == 10


def test_reached_and_surely_reached_are_two_things() -> None:
    page = page_of(answered(right=True))
    reached = {row[0]: row[-1] for row in rows_of(page, "Every measure")}
    assert reached["printed: right name first"] == "yes, not sure"  # four of four: 40 to 100 %
    assert reached["tissue: sensor, confident"] == "yes, not sure"
    assert reached["rivals separated after the next experiments"] == "not measured here"
    assert reached["seconds, ten trials with markers"] == "yes"


def test_what_is_reached_but_not_sure_is_not_good() -> None:
    nulls = [case for case in answered(right=True) if case.kind == "null"][:1]
    verdict = page_of(nulls).verdict
    assert verdict.status == "unknown"
    assert verdict.headline.startswith("Too few cases to be sure of ")
    assert all(point.endswith("reached but not sure") for point in verdict.points)


def test_every_case_has_its_place_by_lab_and_family() -> None:
    page = page_of(answered(right=True))
    rows = rows_of(page, "Cases by lab and family")
    assert len(rows) == 18
    assert sum(row[2] for row in rows) == sum(row[3] for row in rows) == 38
    assert sum(row[5] for row in rows) == 6
    assert sum(row[7] for row in rows) == 16
    effects = rows_of(page, "How often the hidden effect was named first")
    assert len(effects) == 22
    assert sum(int(row[-1].partition("/")[2]) for row in effects) == 38


def test_a_page_can_be_made_of_any_run() -> None:
    cases = answered(right=True)
    lost = replace(cases[0], verdict=IMPOSSIBLE)
    assert "<h1" in render_page(page_of([lost, *cases[1:]]))
    nulls = [case for case in cases if case.kind == "null"]
    assert page_of(nulls).verdict.headline.endswith("bars are reached.")
    assert page_of([lost]).verdict.status == "unknown"


@pytest.mark.parametrize("name", ["labs", "full"])
def test_labs_without_cases_are_no_rows(name: str) -> None:
    cases = [case for case in answered(right=True) if case.lab == "printed"]
    page = scoreboard({**SETTINGS, "suite": name}, lab_table(cases), cases, ENVIRONMENT)
    assert {row[0] for row in rows_of(page, "Cases by lab and family")} == {"printed"}
