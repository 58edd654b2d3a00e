from pathlib import Path

import numpy as np

from benchmark.physics import Motion, Readings, TrialContext, load_effects

FILE = Path(__file__).parents[2] / "examples/own_effect.py"


def test_the_example_is_an_effect_that_softens_with_time() -> None:
    (effect,) = load_effects(FILE)
    assert effect.slug == "warming"
    time = np.linspace(0.0, 100.0, 50)
    motion = Motion(time, np.full(50, 1e-3), np.zeros(50))
    around = TrialContext(5e-3, 1e-2, 1e-3, 1.0, 100.0)
    read = effect.observe({"s": 0.2, "tau": 5.0}, Readings(np.ones(50)), motion, around)
    assert read.force[0] == 1.0
    assert read.force[-1] < 0.81
    assert (np.diff(read.force) < 0.0).all()
