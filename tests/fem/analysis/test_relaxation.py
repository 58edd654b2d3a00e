"""Layers that relax: closed forms of creep and relaxation, small and finite strain."""

import numpy as np
import pytest

import fem
from fem.analysis.equilibrium import State
from fem.analysis.prediction import RecentStates

TERMS = (fem.PronyTerm(0.3, 0.5), fem.PronyTerm(0.2, 4.0))


def skin(kinematics, relaxation=TERMS, nu=0.48, **other):
    layers = tuple(
        fem.Layer(name, h, 1000.0, fem.NeoHookean(E, nu), relaxation if name == "fat" else ())
        for name, h, E in (("dermis", 1.5e-3, 1e5), ("fat", 1e-2, 2e4))
    )
    return fem.prepare(
        fem.Problem(
            layers,
            fem.Tool(5e-3, "rigid_bonded"),
            fem.Support("bonded"),
            kinematics,
            fem.Discretisation("coarse"),
            **other,
        )
    )


def ramp_hold(control, peak):
    time = [0.2, 0.4, 0.6, 0.8, 1.0, 2.0, 5.0, 50.0]
    return fem.Load(control, time, peak * np.minimum(time, 1.0))


@pytest.mark.parametrize("kinematics", ["linear", "finite"])
def test_a_held_depth_loses_force_and_a_held_force_gains_depth(kinematics):
    model = skin(kinematics)
    held = model.run(ramp_hold("depth", 1e-3))
    assert held.complete
    assert (np.diff(held.force[4:]) < 0).all()
    np.testing.assert_allclose(held.reaction, held.force, rtol=1e-6)
    crept = model.run(ramp_hold("force", 0.5))
    assert (np.diff(crept.depth[4:]) > 0).all()
    np.testing.assert_allclose(crept.reaction, crept.force, rtol=1e-6)


def test_a_small_finite_press_is_the_linear_one():
    """What is left of the elastic force is the same; the meshes, and so the forces, are not."""
    load = ramp_hold("depth", 1e-7)
    linear, finite = (
        skin(kinematics).run(load).force / skin(kinematics, ()).run(load).force for kinematics in ("linear", "finite")
    )
    np.testing.assert_allclose(finite, linear, rtol=1e-3)


def test_a_sudden_press_is_elastic_and_an_endless_one_relaxed():
    load = fem.Load("depth", [0.0, 1e5, 2e5], [1e-3] * 3)
    found = skin("finite").run(load).force
    rest = fem.Load("depth", [1.0], [1e-3])
    assert found[0] == pytest.approx(float(skin("finite", ()).run(rest).force[0]), rel=1e-9)
    assert found[2] == pytest.approx(found[1], rel=1e-5)


def test_fields_remember():
    """The stress of the fields after a hold is lower than after the ramp, at the same depth."""
    model = skin("finite")
    solution = model.run(ramp_hold("depth", 1e-3))
    under = [np.linalg.norm(solution.fields(step).cauchy_stress[0]) for step in (4, 7)]
    assert under[1] < 0.9 * under[0]


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: fem.PronyTerm(0.0, 1.0), "g = 0"),
        (lambda: fem.PronyTerm(0.5, 0.0), "tau"),
        (lambda: fem.Layer("a", 1e-3, 1e3, fem.NeoHookean(1e4, 0.4), (fem.PronyTerm(0.6, 1.0),) * 2), "below 1"),
    ],
)
def test_series_that_leave_nothing_are_refused(make, match):
    with pytest.raises(fem.FemError, match=match):
        make()


def test_prediction_follows_the_rate():
    known = RecentStates(0.0, 0.0, State(np.zeros(1), np.zeros((1, 1)), 0.0))
    for t in (1.0, 2.0):
        known.add(2 * t, t, State(np.array([t**2]), np.zeros((1, 1)), t))
    assert known.predict(6.0, 3.0).y[0] == pytest.approx(9.0)
    assert known.predict(4.0, 3.0).y[0] == pytest.approx(4.0)
    assert known.predict(2.0, 3.0).y[0] == pytest.approx(1.0)


@pytest.mark.parametrize("control", ["depth", "force"])
@pytest.mark.parametrize("apart", [2e-16, 1e-10, 1e-6, 1e-4])
def test_two_loads_that_are_nearly_the_same_tell_no_direction(control, apart):
    """A sine of 40 rows once stopped where two of them differed by rounding: an element turned inside out."""
    layer = fem.Layer("a", 15e-3, 1e3, fem.NeoHookean(44.7e3, 0.49), (fem.PronyTerm(0.4, 0.3),))
    model = fem.prepare(fem.Problem((layer,), fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded")))
    most, time = {"depth": 2e-3, "force": 0.5}[control], 0.2 * np.arange(1.0, 6.0)
    near, same = (
        model.run(fem.Load(control, time, most * np.array([0.5, 1.0, 1.0 + more, 0.5, 0.25]))) for more in (apart, 0.0)
    )
    assert near.complete
    assert near.force == pytest.approx(same.force, rel=1e-6 + 20.0 * apart)
    assert near.depth == pytest.approx(same.depth, rel=1e-6 + 20.0 * apart)
