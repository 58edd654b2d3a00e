"""Bad input, kind by kind: one error that names the value and what is allowed, and nothing changed by it."""

import numpy as np
import pytest

from wavemodel import (
    Damping,
    DiscTool,
    InPlaneStress,
    LayeredWave,
    PlateWave,
    Prony,
    WaveDiscretisation,
    WaveError,
    WaveLayer,
)

TOOL = DiscTool(5e-3)
SKIN = [WaveLayer("dermis", 1.5e-3, 1116.0, 1e5, 0.48), WaveLayer("fat", 10e-3, 971.0, 2e4, 0.48)]


@pytest.mark.parametrize(
    ("make", "named"),
    [
        (lambda: WaveLayer("fat", 0.0, 971.0, 2e4, 0.48), ("'fat'", "thickness = 0 m", "above zero")),
        (lambda: WaveLayer("fat", 1e-2, 971.0, 2e4, 0.5), ("poisson_ratio = 0.5", "below 0.5")),
        (
            lambda: LayeredWave(SKIN, TOOL, discretisation=WaveDiscretisation(window=9e-3), large_press="linear"),
            ("window = 9 mm", "wider than the tool"),
        ),
        (
            lambda: LayeredWave(
                SKIN,
                TOOL,
                discretisation=WaveDiscretisation(window=30e-3, modes=16, place=(11e-3, 0.0)),
                large_press="linear",
            ),
            ("place = 11 mm", "inside"),
        ),
        (lambda: PlateWave(SKIN, TOOL, hole_radius=4e-3), ("hole_radius = 4 mm", "wider than the tool")),
        (lambda: Prony((0.6, 0.4), (1.0, 2.0)), ("strength", "below 1")),
        (lambda: Damping(-1.0), ("-1", "negative")),
        (lambda: LayeredWave(SKIN, TOOL, pretension=-1e5, large_press="linear"), ("-100000 Pa", "0 to")),
        (lambda: LayeredWave(SKIN, TOOL, integrator="euler", large_press="linear"), ("'euler'", "exact")),
        (lambda: InPlaneStress((np.nan,), (0.0,)), ("nan Pa", "0 to")),
    ],
)
def test_a_model_that_cannot_be_is_not_made(make, named):
    with pytest.raises(WaveError) as caught:
        make()
    message = str(caught.value)
    assert "\n" not in message
    for word in named:
        assert word in message


@pytest.mark.parametrize(
    ("control", "time", "value", "word"),
    [
        ("depth", [1.0, 2.0], [1e-3, 9e-3], "9 mm is beyond the range"),
        ("force", [1.0, 2.0], [0.1, 1e3], "1000 N is beyond the range"),
        ("force", [2.0, 1.0], [0.1, 0.2], "time"),
        ("force", [1.0, 2.0], [0.1, np.nan], "not finite|not a number|finite"),
        ("pressure", [1.0], [0.1], "'pressure'"),
    ],
)
def test_a_history_that_cannot_be_followed_leaves_the_model_as_it_was(control, time, value, word):
    wave = LayeredWave(SKIN, TOOL, discretisation=WaveDiscretisation(window=60e-3, modes=24), large_press="corrected")
    before = wave.run("force", np.ones(1), np.array([0.3]))
    with pytest.raises(WaveError, match=word):
        wave.run(control, np.array(time), np.array(value))
    after = wave.run("force", np.ones(1), np.array([0.3]))
    np.testing.assert_array_equal(after.depth, before.depth)
    np.testing.assert_array_equal(after.profile(0, np.array([0.0, 4e-3])), before.profile(0, np.array([0.0, 4e-3])))
