"""A film that started at another time is put on the trial's clock by the press itself. All synthetic."""

from dataclasses import replace

import numpy as np
import pytest

from bench_hw.tables import MarkerTable, TrialTable
from benchmark.errors import InputError
from benchmark.files import load_session
from benchmark.files.sessions.film_clock import doubtful_clocks, film_shift, on_trials_clock
from benchmark.files.shipped import shipped_sessions
from tests.instruments.samples import press


def quadratic(depth):
    return 0.15 * depth + 0.02 * depth**2


def trial_and_film(shift, seed, cycles=1, noise=5e-6, hold=2.0, law=quadratic):
    """A trial, and a film at 30 Hz of nine markers that move out as a law of the depth (mm), behind by `shift`."""
    one, random = press(rate=100.0, cycles=cycles, hold=hold), np.random.default_rng(seed)
    table = TrialTable(one.time, 1e-3 * one.depth, one.force)
    frames = np.arange(one.time[0] + 0.1, one.time[-1] - 0.1, 1 / 30)
    depth = np.clip(np.interp(frames, one.time, one.depth), 0.0, None)
    grid = np.array([(x, y) for y in (-8.0, 0.0, 8.0) for x in (-8.0, 0.0, 8.0)])
    places = grid[None] * (1.0 + law(depth)[:, None, None] / 10.0)
    places = 1e-3 * places + random.normal(0.0, noise, places.shape)
    marker = np.tile(np.arange(9), len(frames))
    times = np.repeat(frames - shift, 9)
    return table, MarkerTable(times, marker, places[..., 0].ravel(), places[..., 1].ravel())


@pytest.mark.parametrize("shift", [-3.217, 0.0, 12.4])
def test_the_shift_is_found_within_its_uncertainty(shift):
    found = [film_shift("a", *trial_and_film(shift, seed)) for seed in range(8)]
    errors = np.array([each.shift - shift for each in found])
    assert np.abs(errors).max() < 0.02
    assert np.sqrt((errors**2).mean()) < 3.0 * np.mean([each.deviation for each in found]) + 2e-3
    assert all(each.deviation < 0.02 for each in found)


def test_the_markers_come_on_the_trials_clock_and_it_is_said():
    table, markers = trial_and_film(2.5, 1)
    moved, said = on_trials_clock("a", table, markers)
    np.testing.assert_allclose(moved.time - markers.time, 2.5, atol=0.02)
    assert "shifted by 2.5" in said
    assert "standard deviation" in said


def test_markers_that_do_not_follow_the_press_are_refused():
    table, markers = trial_and_film(0.0, 1, noise=5e-3)
    with pytest.raises(InputError, match="do not follow the press"):
        film_shift("a", table, markers)


def test_a_film_of_one_press_of_many_is_asked_for():
    table, markers = trial_and_film(0.0, 1, cycles=4)
    one = markers.time < 0.25 * markers.time.max()
    part = MarkerTable(markers.time[one], markers.marker[one], markers.x[one], markers.y[one])
    with pytest.raises(InputError, match=r"shifted by .* and by"):
        film_shift("a", table, part)


def test_a_film_off_the_clock_that_it_is_said_to_share_is_told() -> None:
    """Half a second was taken without a word by `fit` and `run`."""
    films = [trial_and_film(shift, seed, noise=2e-6) for seed, shift in enumerate((0.0, 0.5, 0.03))]
    films.append(trial_and_film(0.0, 3, noise=5e-3))
    (said,) = doubtful_clocks("abcd", *zip(*films, strict=True))
    assert said.startswith("the markers follow the press at other times than their own: b (+0.5")
    assert said.count(" s)") == 1


def at_frames(markers, chosen, times):
    """The film with the frames `chosen` at other times."""
    index = (9 * np.asarray(chosen)[:, None] + np.arange(9)).ravel()
    return MarkerTable(np.repeat(times, 9), markers.marker[index], markers.x[index], markers.y[index])


@pytest.mark.parametrize("seed", range(4))
def test_a_film_with_a_gap_or_at_another_rate_is_refused_with_both_shifts(seed):
    table, markers = trial_and_film(0.0, seed)
    times = np.unique(markers.time)
    count, middle = len(times), len(times) // 2
    gap = [*range(middle - 40), *range(middle - 25, count)]
    fast = [k for k in (round(each / 0.9) for each in range(count)) if k < count]
    for chosen in (gap, fast):
        with pytest.raises(InputError, match=r"beginning is shifted by .* s, its end by .*true rate"):
            film_shift("a", table, at_frames(markers, chosen, times[: len(chosen)]))


def test_pictures_that_repeat_the_one_before_are_left_out():
    errors = []
    for seed in range(4):
        table, markers = trial_and_film(0.8, seed)
        times = np.unique(markers.time)
        doubled = at_frames(markers, np.arange(len(times)) // 2 * 2, times)
        errors.append(film_shift("a", table, doubled).shift - 0.8)
    assert abs(np.mean(errors)) < 0.004  # with them half a frame, 0.017 s


@pytest.mark.parametrize("seed", range(4))
def test_a_gap_or_a_rate_too_small_to_be_sure_of_is_in_the_deviation_and_said(seed):
    """One to three pictures, or 1 % of the rate, moved the shift by up to fifteen of its standard deviations."""
    table, markers = trial_and_film(0.0, seed, noise=2e-6)
    times = np.unique(markers.time)
    count = len(times)
    films = [([*range(80), *range(80 + lost, count)], times[: count - lost]) for lost in (1, 2)]
    films += [(range(count), times[0] + rate * (times - times[0])) for rate in (0.99, 1.01)]
    for chosen, stamps in films:
        _, said = on_trials_clock("a", table, at_frames(markers, chosen, stamps))
        found = film_shift("a", table, at_frames(markers, chosen, stamps))
        assert abs(found.shift) < 2.5 * found.deviation < 0.15
        assert "beginning and end differ by" in said


@pytest.mark.parametrize("law", [quadratic, lambda depth: 0.1 * depth**1.5, lambda depth: 0.03 * depth**3])
@pytest.mark.parametrize("hold", [0.0, 2.0])
def test_a_sound_film_of_any_law_is_taken(law, hold):
    """The distance of noisy markers begins with a corner, and a quadratic of the depth has none of these laws."""
    for seed in range(4):
        found = film_shift("a", *trial_and_film(0.3, seed, hold=hold, law=law))
        assert found.shift == pytest.approx(0.3, abs=6e-3)


def test_a_shipped_film_with_few_pictures_in_motion_is_not_doubted():
    """Half of what six deviations part was told: 0.11 s, where the shift is right to 0.003 s."""
    trials = load_session(shipped_sessions()["phantom"]).trials
    filmed = [trial for trial in trials if trial.markers is not None and trial.name in ("press_07", "press_09")]
    assert len(filmed) == 2
    for trial in filmed:
        late = replace(trial.markers, time=trial.markers.time - 0.816)
        found = film_shift(trial.name, trial.table, late)
        assert found.shift == pytest.approx(0.816, abs=4e-3)
        assert found.deviation < 6e-3
