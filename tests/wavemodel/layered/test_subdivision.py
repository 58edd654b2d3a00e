import numpy as np
import pytest

from wavemodel.layered import subdivision
from wavemodel.layered.stack.laminate import laminate
from wavemodel.layered.tractions import uniform_pressure
from wavemodel.layered.window import Taper


def measure(layers, radius, base="bonded"):
    whole = laminate(layers, [(1.0,)] * len(layers), base)
    return subdivision.yardstick(whole, uniform_pressure(radius), Taper(12.0 / radius), 60.0)


@pytest.mark.parametrize("base", ["bonded", "free"])
@pytest.mark.parametrize("radius", [1e-3, 5e-3])
def test_automatic_sublayers_meet_their_tolerance(skin, radius, base):
    yardstick = measure(skin(), radius, base)
    fractions = subdivision.automatic(skin(), base, yardstick)
    assert subdivision.error(laminate(skin(), fractions, base), yardstick) <= subdivision.TOLERANCE
    assert [sum(parts) for parts in fractions] == pytest.approx([1.0] * 3)


def test_small_tools_take_more_sublayers_than_large_ones(skin):
    counts = [sum(map(len, subdivision.automatic(skin(), "bonded", measure(skin(), r)))) for r in (1e-3, 5e-3)]
    assert counts[0] > counts[1]


def test_sublayers_are_thinner_near_the_tool(skin):
    thick = [skin()[2]]
    parts = subdivision.automatic(thick, "bonded", measure(thick, 1e-3))[0]
    assert parts[0] == min(parts)
    assert parts[-1] == max(parts)
    assert parts[-1] >= 4 * parts[0]


def test_uniform_counts():
    assert subdivision.uniform((1, 2)) == ((1.0,), (0.5, 0.5))


def test_error_of_the_coarsest_cut_is_that_of_the_notes(skin):
    """PHYSICS: 5 mm disc, nu 0.48: one sub-layer a layer 0.55 %, 1/1/2 0.05 to 0.2 % on thin fat."""
    yardstick = measure(skin(5e-3), 5e-3)
    one, two = (
        subdivision.error(laminate(skin(5e-3), subdivision.uniform(n), "bonded"), yardstick)
        for n in ((1, 1, 1), (1, 1, 2))
    )
    assert 0.002 < one < 0.03
    assert two < 0.5 * one
    assert np.isfinite(two)
