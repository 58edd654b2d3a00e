import pytest

from wavemodel import DiscTool, NotCoveredError, WaveError
from wavemodel.plate.checks import checked_count, checked_hole, checked_tension

TOOL = DiscTool(5e-3, "rigid_bonded")


def test_sound_input_passes():
    assert checked_hole(TOOL, "hole", 30e-3) == 30e-3
    assert checked_count(None) == 12
    assert [checked_tension(None, way) for way in ("quasi_static", "mid_point")] == ["local", "uniform"]


@pytest.mark.parametrize(
    ("tool", "support", "hole", "message"),
    [
        (TOOL, "hole", None, "missing"),
        (TOOL, "hole", 4e-3, "wider than the tool"),
        (TOOL, "hole", -1.0, "above zero"),
        (TOOL, "floating", 30e-3, "'floating'"),
    ],
)
def test_unusable_holes_are_refused(tool, support, hole, message):
    with pytest.raises(WaveError, match=message):
        checked_hole(tool, support, hole)


@pytest.mark.parametrize(("tool", "support"), [(TOOL, "bonded"), (DiscTool(5e-3, "rigid_frictional"), "hole")])
def test_what_is_not_covered_says_so(tool, support):
    with pytest.raises(NotCoveredError, match="cover"):
        checked_hole(tool, support, 30e-3)


@pytest.mark.parametrize(
    ("tension", "integrator"), [("tight", "quasi_static"), (None, "euler"), ("local", "mid_point")]
)
def test_unusable_methods_are_refused(tension, integrator):
    with pytest.raises(WaveError, match="not allowed"):
        checked_tension(tension, integrator)


def test_too_few_functions_are_refused():
    with pytest.raises(WaveError, match="modes = 3"):
        checked_count(3)
