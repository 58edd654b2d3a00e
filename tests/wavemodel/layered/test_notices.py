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
        ({"discretisation": WaveDiscretisation(window=24e-3)}, "border of the 24 mm window"),
        ({"discretisation": WaveDiscretisation(sublayers=(1, 1, 1))}, "sub-layers cost"),
        ({"duration": 0.02, "integrator": "quasi_static"}, "inertia is left out"),
    ],
)
def test_says_what_costs_accuracy(skin, options, words):
    found = warnings_of(skin(), **options)
    assert len(found) == 1
    assert words in found[0]
