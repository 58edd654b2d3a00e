import pytest

from benchmark.runs.output.document import describe_environment
from benchmark.sweeps.point import PointResult, failed
from benchmark.sweeps.sensitivity import SweepFindings
from benchmark.sweeps.sweep_page import sweep_page
from benchmark.sweeps.sweep_run import SweepProgress, say_failures, say_unusable


def test_the_estimate_rests_on_what_this_command_did() -> None:
    now, said = [100.0], []
    progress = SweepProgress(10, 4, lambda *words: said.append(words), clock=lambda: now[0])
    for point in (5, 6):
        now[0] += 30.0
        progress.add(PointResult(point, "ok"))
    assert progress.remaining() == pytest.approx(120.0)
    assert said == [("points", 5, 10, "2 min left"), ("points", 6, 10, "2 min left")]


def test_failures_are_counted_and_the_end_has_no_estimate() -> None:
    now, said = [0.0], []
    progress = SweepProgress(3, 0, lambda *words: said.append(words[3]), clock=lambda: now[0])
    for point, seconds in ((1, 5.0), (2, 10000.0), (3, 1.0)):
        now[0] += seconds
        progress.add(failed(point, "no luck"))
    assert said == ["10 s left, 1 failed", "83 min left, 2 failed", "3 failed"]


def test_points_that_failed_are_named_with_their_values_and_the_reason(plan_of) -> None:
    plan, said = plan_of("tool.radius=1 mm,2 mm,3 mm,4 mm,5 mm"), []
    rows = [failed(point, "the solver stopped") for point in (1, 2, 3, 4)] + [PointResult(5, "ok")]
    say_failures(rows, plan, said.append)
    assert said[0] == "point 1 (tool.radius 1 mm) failed: the solver stopped"
    assert len(said) == 4
    assert said[3] == "1 more point failed; the reasons are in the report"


def test_points_without_a_scenario_are_told_of_at_the_start(plan_of) -> None:
    """A misspelt tissue was told of after the last point, hours later."""
    plan, said = plan_of("tissue=skin_forearm,skin_forarm", "tool.radius=2 mm,3"), []
    say_unusable([1, 2, 3, 4], plan, said.append)
    (line,) = said
    assert line.startswith(
        "3 of 4 points cannot be computed; the first is point 2 (tissue skin_forearm, tool.radius 3): "
    )
    assert "--vary tool.radius: the bare number 3 has no unit" in line
    say_unusable([1], plan, said.append)
    assert len(said) == 1


def test_a_warning_of_many_points_keeps_its_figures(plan_of) -> None:
    plan = plan_of("tool.radius=1 mm,2 mm,3 mm")
    rows = [PointResult(point, "ok", warnings=f"the press is {point}.5 mm deep") for point in (1, 2)]
    page = sweep_page(plan, [*rows, PointResult(3, "ok")], SweepFindings(), describe_environment(seed=0))
    assert page.notices[0].items == ["point 1, and 1 more with figures of their own: the press is 1.5 mm deep"]


def test_a_varied_key_that_changes_no_result_is_named_in_the_headline(plan_of) -> None:
    plan = plan_of("dermis.youngs_modulus=1 MPa,2 MPa")
    rows = [PointResult(point, "ok", values={"fem_depth_mm": 1.0}) for point in (1, 2)]
    page = sweep_page(plan, rows, SweepFindings(("dermis.youngs_modulus",)), describe_environment(seed=0))
    assert page.verdict.headline == "All 2 points have results; no result depends on dermis.youngs_modulus."
