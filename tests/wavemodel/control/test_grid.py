import pytest

from wavemodel import WaveError
from wavemodel.control import Grid


def test_vertices_and_windows():
    grid = Grid(10e-3, 4e-3, 1e-3)
    assert (grid.x.size, grid.y.size) == (11, 5)
    assert grid.window(5e-3, 2e-3, 2e-3) == (3, 8, 0, 5)
    assert grid.window(0.0, 4e-3, 1.5e-3) == (0, 2, 3, 5)
    assert grid.most_vertices(2e-3) == 6 * 5


@pytest.mark.parametrize(
    ("lengths", "word"), [((0.0, 1.0, 0.1), "width"), ((1.0, 1.0, -1.0), "spacing"), ((1.0, 0.5, 0.6), "spacing")]
)
def test_unusable_grids_are_refused(lengths, word):
    with pytest.raises(WaveError, match=word):
        Grid(*lengths)
