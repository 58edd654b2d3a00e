"""Effects added in their own form are found again: circular, a check of the chain and not of the method."""

import numpy as np
import pytest

from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.criteria import Settings
from benchmark.discovery.evidence.gains import conditions, gain, held_out
from benchmark.discovery.evidence.pool import pool, silent
from benchmark.discovery.evidence.selection import ruled_out, select
from benchmark.discovery.trials.preparing import prepare
from benchmark.physics import catalogue

SETTINGS = Settings(rows=45, workers=1, bootstraps=50)
SOME = tuple(
    effect
    for effect in catalogue()
    if effect.slug in ("viscoelastic_relaxation", "viscous_damping", "force_drift", "machine_compliance")
)
DRAINAGE = next(effect for effect in catalogue() if effect.slug == "poroelastic_drainage")


def relaxing(time, depth, elastic):
    from wavemodel import Prony
    from wavemodel.physics import Physics, QuasiStaticPress

    order = np.argsort(depth)

    def law(wanted):
        return np.interp(wanted, depth[order], elastic[order])

    press = QuasiStaticPress(law, Physics(relaxation=Prony((0.12,), (0.8,))))
    return press.force(time + 1e-3, depth)


def drifting(time, depth, elastic):
    return elastic + 0.06 * elastic.max() * time / time.max()


def chosen(session, effects=SOME):
    calibrated = calibrate(session, prepare(session, SETTINGS.rows))
    with pool(1, None, "", (), silent) as work:
        return select(calibrated.base, effects, SETTINGS, work)


def test_relaxation_is_found_with_its_parameters(session_of):
    made = chosen(session_of(force=relaxing, noise=0.003))
    assert [effect.slug for effect in made.chosen.model.effects] == ["viscoelastic_relaxation"]
    values = made.chosen.model.values(made.chosen.vector)["viscoelastic_relaxation"]
    assert values["g_1"] == pytest.approx(0.12, rel=0.15)
    assert values["tau_1"] == pytest.approx(0.8, rel=0.25)
    assert made.steps[0].gain.z > 3.0
    assert made.steps[0].delta_bic < -20.0


def test_drift_is_no_relaxation(session_of):
    made = chosen(session_of(force=drifting, noise=0.003))
    assert [effect.slug for effect in made.chosen.model.effects] == ["force_drift"]
    assert "viscoelastic_relaxation" not in made.lookalikes["force_drift"]


def test_nothing_is_found_where_nothing_is(session_of):
    made = chosen(session_of(seed=3))
    assert made.chosen is made.base
    assert made.steps == ()
    assert np.isfinite(made.base.objective)


def test_what_a_measurement_rules_out_leaves_the_nearest_that_stood(session_of):
    made = chosen(session_of(force=relaxing, noise=0.003), (*SOME, DRAINAGE))
    assert made.lookalikes == {"viscoelastic_relaxation": ("poroelastic_drainage",)}
    (drained,) = made.rivals["viscoelastic_relaxation"]
    surer = ruled_out(made, {"poroelastic_drainage", "setup.tool.radius"})
    assert surer.chosen is made.chosen
    assert (surer.lookalikes, surer.own) == ({"viscoelastic_relaxation": ()}, made.own)
    other = ruled_out(made, {"viscoelastic_relaxation"})
    assert other.chosen is drained
    assert (other.lookalikes, other.rivals) == ({"poroelastic_drainage": ()}, {"poroelastic_drainage": ()})
    alone = gain(held_out(drained), held_out(made.base), conditions(drained))
    assert other.own["poroelastic_drainage"].mean == pytest.approx(alone.mean)
    assert ruled_out(made, {"viscoelastic_relaxation", "poroelastic_drainage"}) is made
