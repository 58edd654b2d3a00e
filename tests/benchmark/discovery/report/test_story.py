"""The first screen: its picture is of what happens, and its sign is the measurement's."""

from dataclasses import replace

import numpy as np

from benchmark.discovery.report.story import story, telling
from benchmark.discovery.report.words import place_words


def test_a_channel_in_which_only_noise_happens_is_not_the_picture(record) -> None:
    chosen = telling(record)
    quiet = replace(chosen, channel="marker_x", condition="quiet", measured=1e-3 * np.ones(chosen.time.size))
    quiet = replace(quiet, before=0.0 * chosen.time, after=0.0 * chosen.time, noise=np.full(chosen.time.size, 1e-3))
    other = replace(record, found=replace(record.found, traces=(*record.found.traces, quiet)))
    assert telling(other) == chosen


def test_the_picture_is_of_a_channel_whose_gap_shrinks(record) -> None:
    chosen = telling(record)
    assert chosen.channel in {gap.channel for gap in record.found.gap if gap.closed is not None}
    loud = replace(chosen, channel="marker_x", condition="loud", before=chosen.measured + 1e6)
    other = replace(record, found=replace(record.found, traces=(*record.found.traces, loud)))
    assert telling(other) == chosen
    none = tuple(replace(gap, closed=None) for gap in other.found.gap)
    assert telling(replace(other, found=replace(other.found, gap=none, where=()))) == loud
    assert telling(replace(other, found=replace(other.found, gap=none))).channel != "marker_x"  # nothing is told of it


def test_the_gap_is_of_a_channel_in_which_they_disagree(record) -> None:
    """Not of the one that is nearest to noise, of which an effect of the force closes nothing."""
    force = next(gap for gap in record.found.gap if gap.channel == "force_z")
    noise = replace(force, channel="marker_x", rmse_before=1.0, rmse_after=1.0, noise_floor=1e-6, closed=-2e-5)
    place = replace(record.found.where[0], channel="force_z")
    found = replace(record.found, gap=(replace(force, closed=0.9), noise), where=(place,))
    told = [step.answer for step in story(replace(record, found=found)).steps]
    assert any(answer.startswith("90 % of it is closed") for answer in told)
    unplaced = story(replace(record, found=replace(found, where=()))).steps
    assert any(step.answer.startswith("−0.002 % of it is closed") for step in unplaced)


def test_what_changes_its_sign_is_neither_more_nor_less(record) -> None:
    place = replace(record.found.where[0], size=0.2, residual=None, percent_of_signal=9.0, either_way=True)
    told = story(replace(record, found=replace(record.found, where=(place,)))).steps[0].answer
    assert "±0.20 N" in told
    assert "more and less than simulated in turn" in told
    assert "more and less than simulated in turn" in place_words(place)


def test_depths_next_to_touch_are_told_as_zero(record) -> None:
    place = replace(record.found.where[0], depth=(1e-9, 6.157e-3), condition="slow")
    told = story(replace(record, found=replace(record.found, where=(place,)))).steps[0].detail
    assert "slow, 0 to 6.16 mm deep" in told
    assert "(slow), 0 to 6.16 mm: " in place_words(place)
    assert "−0.5 to 6.16 mm" in place_words(replace(place, depth=(-5e-4, 6.157e-3)))


def test_more_or_less_is_what_was_measured_not_what_the_effects_add(record) -> None:
    place = replace(record.found.where[0], size=0.5, residual=-0.2, percent_of_signal=-9.0)
    told = story(replace(record, found=replace(record.found, where=(place,))))
    assert told.steps[0].answer.endswith("(9.0 %), less than simulated")
    assert "−0.20 N" in told.steps[0].answer


def test_a_run_has_a_weight_and_no_confidence(record) -> None:
    alone = tuple(replace(effect, lookalikes=()) for effect in record.found.effects)
    told = replace(record, found=replace(record.found, effects=alone))
    of_run, of_session = (story(replace(told, source=source)).steps[1].detail for source in ("run", "session"))
    assert "Confidence" in of_session
    assert "Confidence" not in of_run
    assert "of the likelihood among the candidates; one run has no noise, so nothing is tested" in of_run


def test_a_set_up_entry_in_a_sentence_says_that_it_is_another_one(record) -> None:
    first = record.found.effects[0]
    effects = (
        replace(first, lookalikes=("setup.support.hole_radius",)),
        replace(first, slug="setup.tool.radius", lookalikes=()),
    )
    told = [step.answer for step in story(replace(record, found=replace(record.found, effects=effects))).steps]
    assert "viscoelastic relaxation and another tool.radius, or another support.hole_radius" in "\n".join(told)
