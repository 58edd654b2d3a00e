"""Rigid frictionless punch on a bonded layer (Hayes, Keer, Herrmann and Mockros, J. Biomech. 5 (1972) 541).

kappa = (1 - nu^2) F / (2 a E w) at nu = 0.45, recomputed to five digits from the paper's integral equation.
"""

import pytest

import fem

KAPPA = {0.2: 1.2523, 0.4: 1.5993, 0.6: 2.0328, 0.8: 2.5354, 1.0: 3.0914, 1.5: 4.6576, 2.0: 6.4206}
A, E, NU, W = 5e-3, 2e4, 0.45, 1e-5


@pytest.mark.parametrize("ratio", sorted(KAPPA))
def test_indentation_stiffness_within_three_thousandths(ratio):
    layer = fem.Layer("cartilage", A / ratio, 1100.0, fem.LinearElastic(E, NU))
    problem = fem.Problem((layer,), fem.Tool(A, "rigid_frictionless"), fem.Support("bonded"), "linear")
    force = fem.prepare(problem).run(fem.Load("depth", [1.0], [W])).force[0]
    assert (1 - NU**2) * force / (2 * A * E * W) == pytest.approx(KAPPA[ratio], rel=1e-3)
