import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fem.mesh.grading import Feature, Sizing, every_second, graded_line

lengths = st.floats(1e-4, 10.0)


@given(st.lists(lengths, min_size=2, max_size=4), st.floats(0.05, 0.9), st.floats(1e-3, 0.5))
@settings(max_examples=50, deadline=None)
def test_lines_increase_and_keep_every_break(steps, growth, share):
    breaks = tuple(np.concatenate(([0.0], np.cumsum(steps))).tolist())
    line = graded_line(breaks, Sizing((Feature(breaks[1], share * min(steps), growth),)))
    assert (np.diff(line) > 0.0).all()
    assert set(breaks) <= set(line.tolist())


def test_sizes_follow_the_feature():
    sizing = Sizing((Feature(1.0, 0.01, 0.3),))
    line = graded_line((0.0, 1.0, 10.0), sizing)
    middle = 0.5 * (line[1:] + line[:-1])
    assert (np.diff(line) <= 1.2 * sizing.size(middle)).all()
    assert (np.diff(line) >= 0.5 * sizing.size(middle)).all()


def test_largest_size_holds_up_to_its_end():
    line = graded_line((0.0, 1.0, 3.0), Sizing((Feature(3.0, 0.5, 1.0),), ((1.0, 0.1),)))
    assert np.diff(line)[line[1:] <= 1.0].max() <= 0.1 + 1e-12


def test_twice_the_density_halves_every_element():
    sizing = Sizing((Feature(0.0, 0.02, 0.4),))
    coarse, fine = (graded_line((0.0, 5.0), sizing, density) for density in (1.0, 2.0))
    np.testing.assert_allclose(fine[::2], coarse, rtol=1e-6)


def test_far_sizes_grow_by_one():
    feature = Feature(0.0, 0.1, 0.4, far=10.0)
    near, far = feature.size_at(np.array([10.0, 20.0]))
    assert far - near == 10.0


def test_every_second_line_goes_but_beside_sharp_places():
    line, breaks = np.arange(13.0), (0.0, 4.0, 12.0)
    np.testing.assert_array_equal(every_second(line, breaks), np.arange(0.0, 13.0, 2.0))
    np.testing.assert_array_equal(every_second(line, breaks, (4.0,)), [0, 2, 3, 4, 5, 6, 8, 10, 12])
    np.testing.assert_array_equal(every_second(line, breaks, (0.0, 12.0)), [0, 1, 2, 4, 6, 8, 10, 11, 12])
