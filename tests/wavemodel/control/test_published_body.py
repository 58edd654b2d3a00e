"""Section 3.4 of the paper: eq. (8) as printed and corrected, the patch moved to the contact, and the way back."""

import numpy as np
import pytest

from wavemodel import PublishedWave, WaveError
from wavemodel.control import Grid, InteractiveTissue, PublishedBody

GRID = Grid(100e-3, 100e-3, 1e-3)
DEPTH = 0.8e-3


def tissue(variant="corrected", **law):
    return InteractiveTissue(PublishedBody(PublishedWave(variant), **law), GRID)


def test_the_paper_s_example():
    """A hit at (60, 50) mm moves (48-71) mm along x and (38-61) mm along y, and nothing else."""
    tool = tissue()
    tool.touch(0, 60e-3, 50e-3, DEPTH)
    moved = np.argwhere(np.abs(tool.frame(1e-3)[0]) > 0.02 * DEPTH)
    assert moved.min(axis=0).tolist() == [49, 39]
    assert moved.max(axis=0).tolist() == [71, 61]


@pytest.mark.parametrize(("variant", "times"), [("corrected", 1.0), ("as_printed", 39.20117)])
def test_eq_8_gives_back_the_depth_and_as_printed_the_amplitude_times_that(variant, times):
    tool = tissue(variant)
    tool.touch(0, 60e-3, 50e-3, DEPTH)
    frame = tool.frame(1e-3)[0]
    assert frame[60, 50] == pytest.approx(times * DEPTH, rel=1e-6)
    expected = PublishedWave().deflection(np.array([6.8026e-3, 11.80265e-3]), np.array([11.80265e-3]), 0.0)[:, 0]
    assert frame[55, 50] / frame[60, 50] == pytest.approx(expected[0] / expected[1], rel=1e-4)


def test_pushed_half_way_it_returns_in_the_stated_steps():
    tool = tissue()
    tool.touch(0, 60e-3, 50e-3, 10e-3)
    tool.frame(1e-3)
    tool.release(0, steps=8)
    depths = [tool.frame(1e-3)[0, 60, 50] for _ in range(8)]
    wave = PublishedWave()
    middle = 0.5 * wave.side
    start, end = wave.time_of_depth(np.array([10e-3, 0.0]), middle, middle)
    times = start + (end - start) * np.arange(1, 9) / 8
    expected = [wave.deflection(np.array([middle]), np.array([middle]), t)[0, 0] for t in times]
    np.testing.assert_allclose(depths, expected, atol=1e-9)
    assert depths[-1] == 0.0


def test_in_physical_time_it_takes_what_is_left_of_a_quarter_period():
    tool = tissue("as_printed")
    tool.touch(0, 60e-3, 50e-3, DEPTH)
    tool.frame(0.01)
    tool.release(0)
    left = np.arcsin(0.8) / 1.74092
    frames = int(left / 0.01)
    depths = [tool.frame(0.01)[0, 60, 50] for _ in range(frames + 1)]
    assert depths[-2] > 0.0
    assert depths[-1] == 0.0


def test_force_is_read_off_the_bench_s_law():
    tool = tissue(depths=(0.0, 1e-3), forces=(0.0, 0.5))
    tool.touch(0, 60e-3, 50e-3, DEPTH)
    tool.frame(1e-3)
    assert tool.force[0] == pytest.approx(0.4)
    bare = tissue()
    bare.touch(0, 60e-3, 50e-3, DEPTH)
    bare.frame(1e-3)
    assert np.isnan(bare.force[0])


def test_depths_beyond_eq_8_are_refused():
    with pytest.raises(WaveError, match="0 to 1 mm"):
        tissue("as_printed").touch(0, 50e-3, 50e-3, 1.1e-3)


@pytest.mark.parametrize(
    ("wave", "law", "word"),
    [
        (PublishedWave(modes=2), {}, "modes = 2"),
        (PublishedWave(), {"depths": (0.0, 1e-3), "forces": (0.0,)}, "as many"),
        (PublishedWave(), {"depths": (1e-3, 0.0), "forces": (0.0, 1.0)}, "rise"),
    ],
)
def test_unusable_bodies_are_refused(wave, law, word):
    with pytest.raises(WaveError, match=word):
        PublishedBody(wave, **law)
