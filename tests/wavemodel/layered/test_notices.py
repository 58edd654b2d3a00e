import numpy as np
import pytest

from wavemodel import DiscTool, LayeredWave, WaveDiscretisation


def warnings_of(layers, force=1e-3, duration=5.0, **options):
    wave = LayeredWave(layers, DiscTool(5e-3), **{"large_press": "linear", **options})
    return wave.run("force", np.array([0.5, 1.0]) * duration, np.array([0.5, 1.0]) * force).warnings


def test_a_small_slow_press_with_all_automatic_has_none(skin):
    assert warnings_of(skin()) == ()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"force": 1.0}, "linear, for small strain"),
        ({"force": 100.0}, "is 2270 % of the"),
        ({"discretisation": WaveDiscretisation(window=24e-3)}, "border of the 24 mm window"),
        ({"discretisation": WaveDiscretisation(sublayers=(1, 1, 1))}, "sub-layers cost"),
        ({"duration": 0.02, "integrator": "quasi_static"}, "inertia is left out"),
    ],
)
def test_says_what_costs_accuracy(skin, options, words):
    found = warnings_of(skin(), **options)
    assert len(found) == 1
    assert words in found[0]


def test_a_pull_is_said_to_be_of_small_strain(skin):
    """Of a pressure that sucks, a tenth of the stack high, the finite elements are a tenth of the depth away."""
    wave = LayeredWave(skin(), DiscTool(3e-3), discretisation=WaveDiscretisation(window=40e-3, modes=24))
    height = wave.press.stack.height
    for depth, said in ((-0.1 * height, True), (-0.01 * height, False), (0.1 * height, False)):
        texts = wave.run("depth", np.ones(1), np.array([depth])).warnings
        assert any("a pull to" in text and "small strain" in text for text in texts) is said
