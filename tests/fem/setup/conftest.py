"""The sheet over a hole whose mesh is judged."""

from collections.abc import Callable

import pytest

import fem

STACK = ((1.5e-3, 3.5e5), (2e-3, 1.8e5), (1.5e-3, 2.6e5))


@pytest.fixture
def sheet() -> Callable[..., fem.Problem]:
    """Three layers (1.5, 2 and 1.5 mm) over a hole of 15 mm radius, under a 5 mm tool."""

    def make(contact: str, kinematics: str = "finite", **mesh) -> fem.Problem:
        law = fem.LinearElastic if kinematics == "linear" else fem.NeoHookean
        layers = tuple(fem.Layer(f"{n}", h, 1000.0, law(E, 0.49)) for n, (h, E) in enumerate(STACK))
        support = fem.Support("hole", 15e-3)
        return fem.Problem(layers, fem.Tool(5e-3, contact), support, kinematics, fem.Discretisation(**mesh))

    return make
