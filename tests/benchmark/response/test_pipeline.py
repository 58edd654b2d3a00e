import numpy as np
import pytest

from benchmark.physics import TrialContext, catalogue
from benchmark.response.pipeline import trial_force

TIME = np.linspace(0.0, 20.0, 400)
DEPTH = np.minimum(TIME / 0.5, 1.0) * 2e-3
AROUND = TrialContext(5e-3, 1e-2, 2e-3, 2.0, 20.0)
BY_SLUG = {effect.slug: effect for effect in catalogue()}


def _law(depth):
    return 1000.0 * depth


def test_without_effects_it_is_the_law() -> None:
    assert np.allclose(trial_force(_law, (), TIME, DEPTH, AROUND), 2.0 * DEPTH / 2e-3)


def test_body_rig_and_sensor_act_together() -> None:
    added = [
        (BY_SLUG["viscoelastic_relaxation"], {"g_1": 0.3, "tau_1": 1.0}),
        (BY_SLUG["machine_compliance"], {"compliance": 1e-4}),
        (BY_SLUG["force_drift"], {"rate": 0.01, "tau": 1e5}),
    ]
    force = trial_force(_law, added, TIME, DEPTH, AROUND)
    held = 2e-3 * 700.0 / (1.0 + 1e-4 * 700.0)
    assert force[-1] == pytest.approx(held + 0.01 * 20.0, rel=0.02)
