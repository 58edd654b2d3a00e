import math
import re
from dataclasses import replace

import numpy as np
import pytest

from benchmark.discovery.discovery_result import VERDICTS, ChannelSize, ConditionEstimate, Estimate, LookAlike
from benchmark.discovery.report.disagreement_sections import representative
from benchmark.discovery.report.discovery_page import discovery_page, discovery_verdict
from benchmark.discovery.report.discovery_record import NextExperiment, Round
from benchmark.discovery.report.effect_sections import next_section
from benchmark.errors import DeviceError
from reports import render_page

pytestmark = pytest.mark.usefixtures("undrawn")  # test_discovery_files draws the page once
ENVIRONMENT = {"made": "today", "packages": {"tissuebench": "0"}}


def _text(record) -> str:
    html = render_page(discovery_page(record, ENVIRONMENT, ["where.csv"]))
    return re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", re.sub(r"<(style|svg).*?</\1>", " ", html, flags=re.S)))


def test_the_story_is_told_in_order(record) -> None:
    text = _text(record)
    story = [
        record.found.statement, "Measured against simulated", "Where", "Which effect", "The effect",
        "The gap, before and after", "What remains", "What to measure next", "How this was found",
    ]  # fmt: skip
    sections = [section.title for section in discovery_page(record, ENVIRONMENT, []).sections]
    assert sections == story[1:]
    assert text.index(record.found.statement) < text.index(story[1])


def test_one_screen_tells_where_which_what_and_how_much(record) -> None:
    page = discovery_page(record, ENVIRONMENT, [])
    steps = {step.question: f"{step.answer} {step.detail}" for step in page.story.steps}
    assert list(steps) == [
        "Where", "Which effect", "What it does to the model", "How the gap shrinks", "What to measure next",
    ]  # fmt: skip
    assert re.search(r"press force, \w+.*[+−]\d", steps["Where"])
    assert "viscoelastic relaxation, or" in steps["Which effect"]
    assert re.search(r"Misfit 0\.025 → 0\.0007\d* mm", steps["What it does to the model"])
    assert "% of it is closed" in steps["How the gap shrinks"]
    text = _text(record)
    assert text.index("How the gap shrinks") < text.index("Contents")


def test_screen_and_section_name_the_place_where_most_happens(record) -> None:
    """Beside a hold in which a relaxation takes 0.27 N off, a base that bent had left 0.031 N in the press."""
    hold = replace(record.found.where[0], phase="hold", size=-0.27, residual=-0.01, percent_of_signal=0.5)
    press = replace(hold, phase="load", size=0.02, residual=0.031, percent_of_signal=1.55)
    either_order = [replace(record, found=replace(record.found, where=each)) for each in ((hold, press), (press, hold))]
    for other in either_order:
        page = discovery_page(other, ENVIRONMENT, [])
        step = next(step for step in page.story.steps if step.question == "Where")
        assert re.search(r", hold: −0\.01\d* N", step.answer)
        assert "(the effect adds -0.27 N to the simulation)" in step.detail
        assert re.search(r"Largest: press force, hold", _text(other))
    assert hold.largest_percent == pytest.approx(13.5)
    assert press.largest_percent == pytest.approx(1.55)
    assert replace(press, residual=None).largest_percent == replace(press, residual=0.0).largest_percent == 1.55


def test_without_an_effect_the_story_claims_nothing(empty) -> None:
    untested = replace(empty, found=replace(empty.found, verdict="cannot_tell", p=None))
    tested = replace(empty, found=replace(empty.found, verdict="cannot_tell", p=0.03))
    for record, where in (
        (empty, "Nowhere beyond chance"),
        (tested, "Nowhere beyond chance"),
        (untested, "Not tested"),
    ):
        story = discovery_page(record, ENVIRONMENT, []).story
        if story is not None:
            assert [step.answer for step in story.steps[:2]] == [where, "None is named"]
            assert len(story.steps) == 3


def test_the_named_effect_has_equation_parameters_and_source(record) -> None:
    text = _text(record)
    for words in ("G = 1 - sum g_j", "Fung", "0.31", "0.29", "share that fades", "poroelastic drainage"):
        assert words in text
    assert "Synthetic data" in text
    assert "pig &lt;1&gt;" in text


@pytest.mark.parametrize("verdict", VERDICTS)
def test_every_verdict_has_its_words(record, verdict: str) -> None:
    other = replace(record, found=replace(record.found, verdict=verdict))
    shown = discovery_verdict(other)
    assert shown.points[0].startswith(f"Verdict {verdict}:")
    assert shown.status == {"named": "good", "no_discrepancy": "good", "cannot_tell": "unknown"}.get(verdict, "finding")
    assert next_section(other).blocks


def test_outside_the_catalogue_nothing_counts_as_named(record) -> None:
    text = _text(replace(record, found=replace(record.found, verdict="outside_catalogue")))
    assert "The nearest entries, which are not named" in text
    assert "Before" not in text[: text.index("Which effect")]


def test_what_could_not_be_tested_is_neither_green_nor_called_nothing(empty) -> None:
    found = replace(empty.found, verdict="cannot_tell", p=None, smallest_visible={})
    html = render_page(discovery_page(replace(empty, found=found), ENVIRONMENT, []))
    assert 'class="verdict unknown"' in html
    assert ">Unknown<" in html
    text = _text(replace(empty, found=found))
    assert text.count("cannot reach the level") == 2
    assert "at least 6 trials" in text
    assert "Nothing significant remains" not in text
    assert "more than chance" not in text


def test_nothing_found_says_what_could_have_been_seen(empty) -> None:
    text = _text(empty)
    assert "0.015 N in press force" in text
    assert "No place in which the disagreement is more than chance" in text
    assert "Synthetic data" not in text


def test_evidence_that_is_missing_is_no_number(record) -> None:
    bare = [replace(each, z=math.nan, gain=math.nan, gain_standard_error=math.nan) for each in record.found.candidates]
    places = [replace(each, p=math.nan) for each in record.found.where]
    text = _text(replace(record, found=replace(record.found, candidates=tuple(bare), where=tuple(places), p=None)))
    assert "nan" not in text.lower().replace("maintenance", "")
    assert "not tested" in text


def test_the_proposal_stands_with_its_protocol(record) -> None:
    rivals = ("viscoelastic_relaxation", "force_drift")
    proposal = NextExperiment(rivals, "rest", "Rest 60 s.", 6.9, 40.8, 22.0, {"rest": (40.8, 22.0)}, "[[segments]]\n")
    text = _text(replace(record, proposal=proposal))
    for words in ("Rest 60 s.", "40.8 standard deviations by", "the session tells 6.9", "[[segments]]"):
        assert words in text


def test_what_an_experiment_shows_that_was_not_looked_for_is_told_without_a_separation(record, tmp_path) -> None:
    hidden = "viscoelastic_relaxation+poroelastic_drainage"
    rivals, none = ("dry_friction", hidden), float("nan")
    shows = NextExperiment(
        rivals, "longer hold", "Hold for 60 s.", none, none, 4.9, {}, "[[segments]]\n", 3, tuple(hidden.split("+"))
    )
    text = _text(replace(record, proposal=shows))
    assert text.count("was not looked for: viscoelastic relaxation, poroelastic drainage; 3 trials, 5 min") == 2
    held = Round(
        rivals, "longer hold", "Hold for 60 s.", none, none, None, 3, 4.9, (), "named", ("viscoelastic_relaxation",), 1
    )
    told = _text(replace(record, proposal=None, grown=tmp_path, rounds=(held,)))
    assert "Hold for 60 s. Shown, and not looked for before: viscoelastic relaxation+poroelastic drainage." in told
    assert not re.search(r"\bnan\b", f"{text} {told}")


def test_each_round_at_the_bench_is_told_and_stands_in_a_table(record, tmp_path) -> None:
    first = Round(
        rivals=("viscoelastic_relaxation", "poroelastic_drainage"),
        choice="wider tool",
        words="Change the tool to one of 8 mm radius and press as before.",
        separation_now=0.1,
        expected=15.2,
        found=4.3,
        trials=5,
        minutes=11.0,
        ruled_out=(),
        verdict="lookalikes",
        answer=("poroelastic_drainage",),
        remaining=2,
    )
    last = replace(first, choice="longer hold", ruled_out=("viscoelastic_relaxation",), remaining=1)
    text = _text(replace(record, proposal=None, grown=tmp_path, rounds=(first, last)))
    assert "4 standard deviations apart, 15 expected. Poroelastic drainage stands beside a rival." in text
    assert "Viscoelastic relaxation ruled out; poroelastic drainage stands alone." in text
    assert "Viscoelastic relaxation against poroelastic drainage:" in text
    assert re.search(r"longer hold viscoelastic relaxation / poroelastic drainage 0.1 15.2 4.3 5 11", text)
    assert "2 more experiments: wider tool; longer hold" in text
    assert "before its time" not in text
    for rounds in ((), (first,)):
        stopped = DeviceError("--bench: the force sensor is silent")
        text = _text(replace(record, proposal=None, grown=tmp_path, rounds=rounds, stopped=stopped))
        assert "The loop ended before its time: --bench: the force sensor is silent." in text
        assert "No experiment was done" not in text


def test_one_trial_a_channel_and_condition_is_shown_the_held_out_one(found) -> None:
    chosen = representative(found.traces)
    assert [(trace.channel, trace.condition) for trace in chosen] == [
        ("force_z", "slow"), ("force_z", "fast"), ("marker_radial", "slow"), ("marker_radial", "fast"),
    ]  # fmt: skip
    assert [trace.held_out for trace in chosen] == [False, True, False, True]


def test_a_miss_beyond_the_tolerance_is_never_green(record, empty) -> None:
    sizes = (ChannelSize("force_z", 2.0, 0.3, 0.16),)
    for each in (record, empty):
        shown = discovery_verdict(replace(each, found=replace(each.found, sizes=sizes)))
        assert shown.status == "finding"
        assert any("still misses press force by 0.30 N (tolerance 0.16 N)" in point for point in shown.points)
    small = (ChannelSize("force_z", 2.0, 0.1, 0.16),)
    assert discovery_verdict(replace(record, found=replace(record.found, sizes=small))).status == "good"


def test_an_unknown_floor_is_called_so(record) -> None:
    gap = tuple(replace(each, noise_floor=None, closed=None, ci95=None) for each in record.found.gap)
    assert "not known" in _text(replace(record, found=replace(record.found, gap=gap)))


def test_residual_and_contribution_stand_side_by_side(record) -> None:
    first = replace(record.found.where[0], size=-0.88, residual=0.34)
    found = replace(record.found, where=(first, *record.found.where[1:]))
    text = _text(replace(record, found=found))
    assert "0.34 N more than simulated" in text
    assert "the effect adds -0.88 N" in text
    assert "effect's contribution" in text or "effect&#x27;s contribution" in text or "effect&#39;s" in text


@pytest.mark.parametrize("verdict", ["named", "conditional", "lookalikes", "partly_explained", "outside_catalogue"])
def test_constancy_and_the_rivals_own_parameters_stand_under_every_verdict(record, verdict: str) -> None:
    (effect,) = record.found.effects
    moved = tuple(
        ConditionEstimate("tau_1", condition, value, "s", (0.9 * value, 1.1 * value), agrees)
        for condition, value, agrees in (("slow", 3.0, True), ("fast", 30.0, False))
    )
    rival = LookAlike("poroelastic_drainage", (Estimate("drainage_share", 0.417, "", (0.4, 0.43)),), 0.06, 7.0)
    changed = replace(effect, by_condition=moved, rivals=(rival,))
    text = _text(replace(record, found=replace(record.found, verdict=verdict, effects=(changed,))))
    assert "other parameters: tau_1 in fast" in text
    assert "0.417" in text
    alone = replace(record.found, verdict=verdict, conditions=("slow",))
    assert "not known: there is one condition" in _text(replace(record, found=alone))


def test_values_that_differ_surely_and_pass_for_alike_are_told(record) -> None:
    """The share that forms may differ by is no agreement within intervals."""
    (effect,) = record.found.effects
    joint = effect.parameters[0]
    for far, words in ((1.0, "the same parameters in all"), (1.2, "alike in all, to 35 % or a factor of 2")):
        value = far * joint.value
        own = ConditionEstimate(joint.name, "slow", value, joint.unit, (0.95 * value, 1.05 * value), True)
        text = _text(replace(record, found=replace(record.found, effects=(replace(effect, by_condition=(own,)),))))
        assert words in text
        assert (f"leaves out the joint value: {joint.name} in slow" in text) is (far > 1.0)


def test_what_was_not_looked_for_says_what_it_needs(record, empty) -> None:
    for each in (record, empty):
        found = replace(each.found, not_shown={"dry_friction": "unloading"})
        assert "dry friction: needs unloading" in _text(replace(each, found=found))


def test_a_miss_that_chance_may_explain_was_tested(empty) -> None:
    found = replace(empty.found, verdict="cannot_tell", p=0.4)
    text = _text(replace(empty, found=found))
    assert "cannot reach the level" not in text
    assert discovery_verdict(replace(empty, found=found)).status == "unknown"


def test_rivals_that_are_far_apart_already_say_why_they_stay(record) -> None:
    rivals = ("viscoelastic_relaxation", "poroelastic_drainage")
    far = NextExperiment(rivals, "rest", "Rest.", 96.0, 140.0, 22.0, {"rest": (140.0, 22.0)}, "")
    assert "textbook forms are far apart" in _text(replace(record, proposal=far))
    assert "textbook forms" not in _text(replace(record, proposal=replace(far, separation_now=2.0)))


@pytest.mark.parametrize(("pull", "small"), [(0.01, True), (0.1, False)])
def test_a_short_pull_is_not_small_for_its_mean_over_a_phase(record, pull: float, small: bool) -> None:
    first = record.found.traces[0]
    after = first.before.copy()
    after[5] -= pull * np.abs(first.measured).max()
    where = tuple(replace(place, percent_of_signal=1.5) for place in record.found.where)
    found = replace(record.found, where=where, traces=(replace(first, after=after),))
    points = discovery_verdict(replace(record, found=found)).points
    assert any("small in practice" in point for point in points) is small
