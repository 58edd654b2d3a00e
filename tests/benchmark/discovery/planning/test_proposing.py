import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.planning import proposing
from benchmark.discovery.planning.proposing import (
    Allowed,
    _bearable,
    _calibrations,
    _distinct,
    _own_condition,
    _tools,
    enough_trials,
    propose,
    usual_press,
)
from benchmark.experiments.menu import (
    Usual,
    menu,
    minutes,
    motion,
    protocol_toml,
    rigid_block,
    same_again,
    second_tools,
    shallower,
)
from benchmark.physics import Effect, TrialContext, catalogue


def _condition(kind: str) -> SimpleNamespace:
    time = np.linspace(0.0, 10.0, 101)
    depth = np.interp(time, [0.0, 2.0, 8.0, 10.0], [0.0, 2e-3, 2e-3, 0.0])
    phase = np.select(
        [time < 2.0, time < 8.0], [PHASES.index("load"), PHASES.index("hold")], PHASES.index("unload_high")
    )
    around = TrialContext(5e-3, 4e-3, 2e-3, 3.0, 10.0)
    return SimpleNamespace(
        time=np.tile(time, (3, 1)), depth=np.tile(depth, (3, 1)), phase=phase, cycle=np.ones(101, dtype=int),
        around=around, support=SimpleNamespace(kind=kind),
    )  # fmt: skip


def _found(study: SimpleNamespace, verdict: str = "lookalikes", known: tuple[Effect, ...] = ()) -> SimpleNamespace:
    study.layout = None
    for condition in study.conditions:
        if not hasattr(condition, "phase"):
            condition.__dict__.update({**vars(_condition("bonded")), **vars(condition)})
    base = SimpleNamespace(model=SimpleNamespace(problem=SimpleNamespace(study=study)))
    found = SimpleNamespace(verdict=verdict)
    return SimpleNamespace(calibrated=SimpleNamespace(base=base), discovery=found, known=known)


def _rival(*slugs: str, **values: dict[str, float]) -> SimpleNamespace:
    return SimpleNamespace(slugs=slugs, values=values)


def test_the_usual_press_is_read_off_the_trials() -> None:
    usual = usual_press(_condition("bonded"))
    assert usual.depth == pytest.approx(2e-3)
    assert usual.speed == pytest.approx(1e-3)
    assert usual.hold == pytest.approx(6.0, abs=0.2)
    assert usual.thickness == 4e-3
    assert usual_press(_condition("hole")).thickness == np.inf


def test_an_experiment_gets_as_many_trials_as_are_to_decide() -> None:
    assert enough_trials(5, 20.0) == 5
    assert enough_trials(5, 7.0) == 10
    assert enough_trials(5, 1.0) == 15
    assert enough_trials(5, 0.0) == 15


@pytest.mark.parametrize(
    ("there", "alone", "trials", "apart", "now"),
    [
        (49, 100.0, 6, 100.0 * 6**0.5, 7.0),  # one would do: no more than a test of trials needs
        (5, 5.0, 5, 5.0 * 5**0.5, 5**0.5),  # as many as there are
        (49, 3.2, 9, 3.2 * 9**0.5, 7.0),  # as many as are to decide
        (49, 1.1, 18, 1.1 * 18**0.5, 7.0),  # more than another press as before, if less than 49 of them
        (49, 0.9, None, None, 7.0),  # less than another press as before
    ],
)
def test_many_trials_of_a_session_are_not_asked_for_again(monkeypatch, there, alone, trials, apart, now) -> None:
    usual = usual_press(_condition("bonded"))
    again, deeper = same_again(usual), menu(usual)[0]
    seen = {"same again": (again, 1.0), deeper.name: (deeper, alone)}
    monkeypatch.setattr(proposing, "rivals", lambda found: (_rival("a"), _rival("b")))
    monkeypatch.setattr(proposing, "_with_this_tool", lambda *_: dict(seen))
    study = SimpleNamespace(
        by_force=False, conditions=[SimpleNamespace(size=there, name="slow", around=_condition("hole").around)]
    )
    found = propose(_found(study))
    if trials is None:
        assert found is None
        return
    assert (found.trials, found.choice) == (trials, deeper.name)
    assert (found.separation, found.separation_now) == (pytest.approx(apart), pytest.approx(now))
    assert found.minutes == minutes(deeper, trials)
    assert found.menu[deeper.name][1] == minutes(deeper, min(there, 6))


@pytest.mark.parametrize(
    ("sizes", "chosen", "trials"),
    [
        ({"slower": 4.0, "faster": 2.0}, "slower", 6),  # both are to decide: what tells most a minute
        ({"slower": 2.0, "rest in air": 2.3}, "rest in air", 18),  # 8.5 by 18 trials rules nobody out, 9.8 does
        ({"slower": 2.0, "rest in air": 2.1}, "rest in air", 18),  # neither is to decide: what promises most
        ({"slower": 2.0, "rigid block": 9.0}, "rigid block", 1),
        ({"slower": 2.2, "rigid block": 8.9}, "slower", 18),
        ({"slower": 400.0, "rigid block": 9.0}, "rigid block", 1),  # what is measured itself before what forms tell
    ],
)
def test_what_decides_goes_before_what_is_quick(monkeypatch, sizes, chosen, trials) -> None:
    usual = usual_press(_condition("bonded"))
    entries = {each.name: each for each in (*menu(usual), rigid_block(3.0))}
    menus = {name: (entries[name], size) for name, size in sizes.items()}
    block = {name: menus.pop(name) for name in ("rigid block",) if name in menus}
    names = ("setup.tool.radius", "setup.support.hole_radius", "a", "machine_compliance")
    standing = tuple(map(_rival, names))
    monkeypatch.setattr(proposing, "rivals", lambda found: standing)
    monkeypatch.setattr(proposing, "_with_this_tool", lambda *_: {"same again": (same_again(usual), 1.0), **menus})
    monkeypatch.setattr(proposing, "_calibrations", lambda *_: block)
    study = SimpleNamespace(by_force=False, conditions=[SimpleNamespace(size=10, name="slow")])
    session = _found(study)
    found = propose(session)
    assert (found.choice, found.trials) == (chosen, trials)
    other = "machine_compliance" if chosen == "rigid block" else "a"  # the nearest rival with an effect
    assert found.rivals == ("setup.tool.radius", other)
    others = propose(session, allowed=Allowed(done={chosen}))
    assert others.choice == next(name for name in sizes if name != chosen)
    assert propose(session, allowed=Allowed(done=set(sizes))) is None


def test_an_experiment_differs_from_the_sessions_own_press_and_not_from_the_experiment_before() -> None:
    slow, fast, wider = (
        SimpleNamespace(size=size, name=name) for size, name in ((4, "slow"), (6, "fast"), (15, "wider tool"))
    )
    assert _own_condition((slow, fast, wider), {"ruler image", "wider tool"}) is fast
    assert _own_condition((slow, fast, wider), frozenset()) is wider
    assert _own_condition((wider,), {"wider tool"}) is wider  # a user's own name


def test_what_a_session_has_of_the_menu_is_not_proposed_again(monkeypatch) -> None:
    """A loop goes on from a grown session: no other motion joins its conditions, and they are not its own press."""
    usual, seen_from = usual_press(_condition("bonded")), []

    def with_this_tool(first, second, condition, allowed):
        seen_from.append(condition.name)
        return {"same again": (same_again(usual), 1.0), **{each.name: (each, 9.0) for each in menu(usual)[:3]}}

    monkeypatch.setattr(proposing, "rivals", lambda found: (_rival("a"), _rival("b")))
    monkeypatch.setattr(proposing, "_with_this_tool", with_this_tool)
    sizes = {"press": 3, "longer hold": 9, "deeper": 9, "tool of 8 mm": 18, "wider tool": 18}
    conditions = [
        SimpleNamespace(size=size, name=name, around=_condition("hole").around) for name, size in sizes.items()
    ]
    study = SimpleNamespace(by_force=False, conditions=conditions)
    found = propose(_found(study))
    assert seen_from == ["press"]
    assert found.choice == "slower"


MEMORY = ("viscoelastic_relaxation", "poroelastic_drainage")


def _unheld() -> SimpleNamespace:
    """A press to and fro without a hold, at one speed, and the air after it."""
    time = np.linspace(0.0, 10.0, 101)
    depth = np.interp(time, [0.0, 4.0, 8.0, 10.0], [0.0, 2e-3, 0.0, -1e-3])
    stages = ("load", "unload_high", "after_lift_off")
    phase = np.select([time < 4.0, time < 8.0], [PHASES.index(name) for name in stages[:2]], PHASES.index(stages[2]))
    around = TrialContext(5e-3, 4e-3, 2e-3, 3.0, 10.0)
    return SimpleNamespace(
        time=np.tile(time, (3, 1)), depth=np.tile(depth, (3, 1)), phase=phase, cycle=np.ones(101, dtype=int),
        around=around, support=SimpleNamespace(kind="bonded"), size=3, name="press",
    )  # fmt: skip


@pytest.mark.parametrize("standing", [("dry_friction",), ("dry_friction", "permanent_set")])
@pytest.mark.parametrize("verdict", ["named", "lookalikes", "outside_catalogue"])
def test_what_was_not_looked_for_is_shown_before_rivals_are_separated(monkeypatch, standing, verdict) -> None:
    """Of a relaxing sheet pressed without a hold dry friction was named, and experiments were spent on its rivals."""
    monkeypatch.setattr(proposing, "rivals", lambda found: tuple(map(_rival, standing)))
    monkeypatch.setattr(proposing, "_simulated", lambda *_: 0.0)
    found = propose(_found(SimpleNamespace(conditions=(_unheld(),), by_force=False), verdict, catalogue()))
    assert (found.choice, found.trials, found.opens) == ("longer hold", 3, MEMORY)
    assert found.rivals == ("dry_friction", "+".join(MEMORY))
    assert "hold for 60 s" in found.words
    assert '"hold"' in found.toml
    assert (found.menu, np.isnan([found.separation, found.separation_now]).all()) == ({}, True)
    again = propose(
        _found(SimpleNamespace(conditions=(_unheld(),), by_force=False), verdict, catalogue()),
        allowed=Allowed(done={"longer hold"}),
    )
    assert (again.choice, again.opens) == ("slower", MEMORY)


def test_where_trials_agree_or_a_bench_cannot_nothing_is_shown(monkeypatch) -> None:
    monkeypatch.setattr(proposing, "rivals", lambda found: (_rival(),))
    monkeypatch.setattr(proposing, "_simulated", lambda *_: 0.0)
    for verdict in ("no_discrepancy", "cannot_tell"):
        assert propose(_found(SimpleNamespace(conditions=(_unheld(),), by_force=False), verdict, catalogue())) is None
    assert (
        propose(_found(SimpleNamespace(conditions=(_unheld(),), by_force=False), "named")) is None
    )  # all were looked for
    monkeypatch.setattr(proposing, "_simulated", lambda *_: None)  # too much force
    assert propose(_found(SimpleNamespace(conditions=(_unheld(),), by_force=False), "named", catalogue())) is None


def test_a_tool_that_would_press_too_hard_is_pressed_less_deep(monkeypatch) -> None:
    monkeypatch.setattr(proposing, "expected", lambda *given: SimpleNamespace(signals=8e3 * given[3][:, None]))
    usual = Usual(2e-3, 1e-3, 5.0, math.inf)
    wider, condition = second_tools(usual, 5e-3)[0], SimpleNamespace(name="slow")
    assert _bearable(_rival("slip"), condition, wider, 20.1) is None  # 16 N, of which 0.8 are allowed
    depth = _bearable(_rival("slip"), condition, wider, 10.0)
    assert depth == pytest.approx(1e-3)
    less = shallower(usual, 5e-3, wider, depth)
    assert (less.name, less.tool_radius) == (wider.name, wider.tool_radius)
    assert 0.0 < motion(less, 400)[1].max() <= 1e-3
    assert "since deeper would be too hard" in less.words
    assert "hold for 12.8 s" in less.words
    monkeypatch.setattr(proposing, "expected", None)  # without a limit nothing is evaluated
    assert _bearable(_rival("slip"), condition, wider, math.inf) is None


def test_the_tools_of_the_menu_are_pressed_no_harder_than_the_bench_bears(monkeypatch) -> None:
    """A session's press of 2 mm, under tools that all ask for 8 N a mm."""
    monkeypatch.setattr(proposing, "expected", lambda *given: SimpleNamespace(signals=8e3 * given[3][:, None]))
    monkeypatch.setattr(proposing, "under", lambda rival, *_: rival)
    monkeypatch.setattr(
        proposing, "_simulated", lambda a, b, condition, experiment, most: motion(experiment, 400)[1].max()
    )
    condition = _condition("bonded")
    tool = SimpleNamespace(radius=5e-3, model_copy=lambda update: SimpleNamespace(**update))
    condition.__dict__.update(tool=tool, name="slow", setup=(SimpleNamespace(thickness=20e-3), tool, condition.support))
    for most_force, deepest in ((10.0, 1e-3), (100.0, 2e-3)):
        seen = _tools(_rival("a"), _rival("b"), condition, lambda *_: object(), Allowed(most_force), 1)
        assert len(seen) == 4
        assert all(size == pytest.approx(deepest, rel=0.02) for _, size in seen.values())


def test_a_rigid_block_is_for_a_rig_that_gives_way() -> None:
    relaxing = _rival("viscoelastic_relaxation")
    giving = _rival("machine_compliance", machine_compliance={"compliance": 1e-4})
    for standing in ((giving, relaxing), (relaxing, _rival("slip"), giving)):
        ((experiment, size),) = _calibrations(standing, _condition("bonded")).values()
        assert experiment.name == "rigid block"
        assert "press to 30 N, or as hard as the rig and its force sensor bear" in experiment.words
        assert size == pytest.approx(1e-4 * 30.0 / 0.02e-3)
    assert _calibrations((relaxing, relaxing), _condition("bonded")) == {}
    assert _calibrations((giving, giving), _condition("bonded")) == {}


@pytest.mark.parametrize(("bears", "force"), [(20.0, 16.0), (1e3, 30.0)])
def test_a_rigid_block_is_pressed_no_harder_than_the_rig_bears(bears, force) -> None:
    giving = _rival("machine_compliance", machine_compliance={"compliance": 1e-4})
    ((_, size),) = _calibrations((giving, _rival("slip")), _condition("bonded"), bears).values()
    assert size == pytest.approx(1e-4 * force / 0.02e-3)


def test_a_rigid_block_is_pressed_no_harder_than_a_protocol_may_say() -> None:
    condition = _condition("bonded")
    condition.around = replace(condition.around, peak_force=50.0)
    giving = _rival("machine_compliance", machine_compliance={"compliance": 1e-4})
    ((experiment, _),) = _calibrations((giving, _rival("slip")), condition).values()
    assert "press to 100 N" in experiment.words
    assert protocol_toml(experiment)


def test_a_ruler_is_for_a_wrong_scale() -> None:
    scaled = _rival("marker_scale_error", marker_scale_error={"error": -0.02})
    ((experiment, size),) = _calibrations((_rival("interface_slip"), scaled), _condition("bonded")).values()
    assert experiment.name == "ruler image"
    assert size == pytest.approx(10.0)


def test_rivals_are_called_by_what_they_do_not_share() -> None:
    first, second = _rival("a", "b"), _rival("a", "c")
    assert (_distinct(first, second), _distinct(second, first)) == ("b", "c")
