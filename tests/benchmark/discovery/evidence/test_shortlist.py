"""What trials can show, by their motions, layers and markers; and on which of very many candidates are compared."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery import criteria
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.evidence.gains import effective_size
from benchmark.discovery.evidence.shortlist import (
    MARKERS,
    Screened,
    compared,
    missing,
    not_shown,
    on_all,
    on_some,
    promising,
    remark,
    shown,
    unseen,
)
from benchmark.discovery.trials.preparing import prepare
from benchmark.physics import catalogue
from benchmark.physics.description import SIGNS

BY_SLUG = {effect.slug: effect for effect in catalogue()}
PEAK = 4e-3


@pytest.fixture(scope="module")
def base(tmp_path_factory, quick_session):
    from benchmark.files import load_session

    session = load_session(quick_session.write_session(tmp_path_factory.mktemp("many") / "s", trials=5))
    return calibrate(session, prepare(session, 60)).base


def test_trials_are_spread_over_the_conditions_and_their_order(base):
    assert compared(base) == list(range(10))
    assert compared(base, most=6) == [0, 2, 4, 5, 7, 9]


def test_few_trials_are_used_whole(base):
    assert on_some(base, compared(base)) is base
    assert on_all(base, base) is base
    assert remark(10, 10) == ()


def test_a_fit_to_some_knows_those_alone(base):
    some = on_some(base, compared(base, most=6))
    assert len(some.model.problem.trials) == len(some.nuisance) == len(some.blocks.misfit) == 6
    assert np.isfinite(some.objective)
    assert on_all(base, some) is base
    assert "6 of them" in remark(6, 10)[0]


def test_what_one_step_must_gain_is_what_bic_asks_of_a_parameter(base):
    asked = 0.5 * (np.log(effective_size(base)) - criteria.ACCEPT_BIC)
    assert 3.0 < asked < 10.0

    def ranked(*won):
        return tuple(Screened(None, each, np.zeros((1, 10))) for each in won)

    assert promising(base, ranked(1.001 * asked, 0.1))
    assert not promising(base, ranked(0.999 * asked, 0.1))
    assert not promising(base, ())


def condition(*stages, layers=1, hole=np.inf):
    """Rows of stages (phase, end depth in m, seconds), ten a stage, pressed from the surface."""
    depth, time, phase = [0.0], [0.0], [PHASES.index(stages[0][0])]
    for name, end, seconds in stages:
        depth += np.linspace(depth[-1], end, 11)[1:].tolist()
        time += (time[-1] + np.linspace(0.0, seconds, 11)[1:]).tolist()
        phase += [PHASES.index(name)] * 10
    around = SimpleNamespace(peak_depth=PEAK, layers=("layer",) * layers, hole_radius=hole)
    return SimpleNamespace(
        depth=np.array([depth] * 2), time=np.array([time] * 2), phase=np.array(phase),
        cycle=np.ones(len(phase), dtype=int), around=around,
    )  # fmt: skip


def study(*conditions, layout=None, by_force=False):
    return SimpleNamespace(conditions=conditions, layout=layout, by_force=by_force)


LOADING = ("load", PEAK, 2.0)
HOLD = ("hold", PEAK, 5.0)
BACK = (("unload_high", 0.5 * PEAK, 1.0), ("unload_low", 0.0, 1.0))
AIR = ("after_lift_off", -0.5e-3, 1.0)


@pytest.mark.parametrize(
    ("made", "expected"),
    [
        (study(condition(LOADING)), set()),
        (study(condition(LOADING, HOLD)), {"hold"}),
        (study(condition(LOADING, *BACK)), {"unloading"}),
        (study(condition(LOADING, ("unload_high", 0.9 * PEAK, 0.5))), set()),  # a tenth back is no unloading
        (study(condition(LOADING, *BACK, AIR)), {"unloading", "lift_off"}),
        (study(condition(LOADING), condition(("load", PEAK, 0.5))), {"second_rate"}),
        (study(condition(LOADING), condition(("load", PEAK, 1.5))), set()),  # a third faster is one rate
        (study(condition(LOADING, layers=2)), {"interface"}),
        (study(condition(LOADING, hole=15e-3)), {"interface"}),
    ],
)
def test_the_signs_of_a_session_are_those_of_its_motion_and_layers(made, expected):
    assert shown(made) == expected | {"free_force"}


def test_loading_alone_shows_stiffening_and_a_floor_but_nothing_of_rate_memory_or_return():
    alone = study(condition(LOADING))
    lacking = not_shown(alone, catalogue())
    assert {"strain_stiffening", "bottoming_out", "pretension", "machine_compliance"}.isdisjoint(lacking)
    hidden = "viscoelastic_relaxation viscous_damping stress_softening permanent_set poroelastic_drainage dry_friction"
    assert set(hidden.split()) <= set(lacking)
    assert lacking["dry_friction"] == "unloading"
    assert lacking["viscoelastic_relaxation"] == "a hold or a second rate"
    assert lacking["interface_slip"] == "a second layer or a clamp and unloading"


def test_what_another_motion_would_show_is_what_lacks_no_layer_and_no_marker():
    to_and_fro = study(condition(LOADING, *BACK, AIR))
    memory = ("viscoelastic_relaxation", "poroelastic_drainage")
    assert unseen(to_and_fro, catalogue()) == memory
    assert unseen(to_and_fro, catalogue(), {"hold"}) == ()
    assert set(unseen(study(condition(LOADING)), catalogue(), {"unloading", "lift_off"})) == set(memory)
    assert unseen(study(condition(LOADING, HOLD, *BACK, AIR)), catalogue()) == ()


def test_slip_needs_something_to_slide_on():
    assert missing(study(condition(LOADING, *BACK)), BY_SLUG["interface_slip"]) == ("a second layer or a clamp",)
    assert missing(study(condition(LOADING, *BACK, layers=2)), BY_SLUG["interface_slip"]) == ()


def test_a_prescribed_force_that_stands_shows_no_saturation_and_no_motion_would():
    """At the top it is flat because it is held there."""
    held = study(condition(LOADING, HOLD, *BACK, AIR), by_force=True)
    assert [slug for slug, lacks in not_shown(held, catalogue()).items() if "prescribed" in lacks] == [
        "force_saturation"
    ]
    assert "force_saturation" not in unseen(held, catalogue())
    assert missing(study(condition(LOADING)), BY_SLUG["force_saturation"]) == ()


def test_a_weight_that_is_off_between_two_rows_is_an_unloading():
    """Its way back has no row: the depth falls from one rest to the next."""
    off = condition(LOADING, HOLD, ("hold", 0.1 * PEAK, 1e-6))
    assert "unloading" in shown(study(off, by_force=True))
    assert "unloading" not in shown(study(condition(LOADING, HOLD), by_force=True))


def test_what_shows_in_markers_alone_needs_them():
    assert missing(study(condition(LOADING)), BY_SLUG["perspective"]) == (MARKERS,)
    assert missing(study(condition(LOADING), layout=object()), BY_SLUG["perspective"]) == ()


def test_every_need_of_the_catalogue_is_a_known_sign():
    needs = {sign for effect in catalogue() for each in effect.description.needs for sign in each}
    assert needs == set(SIGNS)
