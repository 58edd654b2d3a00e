"""What trials can show: an effect is looked for only where its sign is among their motions, layers and markers."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.evidence.showing import MARKERS, missing, not_shown, shown
from benchmark.physics import catalogue
from benchmark.physics.description import SIGNS

BY_SLUG = {effect.slug: effect for effect in catalogue()}
PEAK = 4e-3


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


def study(*conditions, layout=None):
    return SimpleNamespace(conditions=conditions, layout=layout)


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
    assert shown(made) == expected


def test_loading_alone_shows_stiffening_and_a_floor_but_nothing_of_rate_memory_or_return():
    alone = study(condition(LOADING))
    lacking = not_shown(alone, catalogue())
    assert {"strain_stiffening", "bottoming_out", "pretension", "machine_compliance"}.isdisjoint(lacking)
    hidden = "viscoelastic_relaxation viscous_damping stress_softening permanent_set poroelastic_drainage dry_friction"
    assert set(hidden.split()) <= set(lacking)
    assert lacking["dry_friction"] == "unloading"
    assert lacking["viscoelastic_relaxation"] == "a hold or a second rate"
    assert lacking["interface_slip"] == "a second layer or a clamp and unloading"


def test_slip_needs_something_to_slide_on():
    assert missing(study(condition(LOADING, *BACK)), BY_SLUG["interface_slip"]) == ("a second layer or a clamp",)
    assert missing(study(condition(LOADING, *BACK, layers=2)), BY_SLUG["interface_slip"]) == ()


def test_what_shows_in_markers_alone_needs_them():
    assert missing(study(condition(LOADING)), BY_SLUG["perspective"]) == (MARKERS,)
    assert missing(study(condition(LOADING), layout=object()), BY_SLUG["perspective"]) == ()


def test_every_need_of_the_catalogue_is_a_known_sign():
    needs = {sign for effect in catalogue() for each in effect.description.needs for sign in each}
    assert needs == set(SIGNS)
