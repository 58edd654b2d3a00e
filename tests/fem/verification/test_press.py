"""Mesh error of the default mesh at large press, against the fine mesh: what the gated cases leave out."""

import numpy as np
import pytest

import fem


def depths(problem, force):
    load = fem.Load("force", np.arange(1.0, 11.0), force * np.arange(1, 11) / 10)
    return fem.prepare(problem).run(load).top_deflection


@pytest.mark.slow
@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
@pytest.mark.parametrize("nu", [0.48, 0.49, 0.499])
def test_very_soft_fat_too(contact, nu):
    def problem(density):
        layers = tuple(
            fem.Layer(name, h, 1000.0, fem.NeoHookean(modulus, nu))
            for name, h, modulus in (("e", 1e-4, 1e6), ("d", 1.5e-3, 1e5), ("f", 8e-3, 1e4))
        )
        return fem.Problem(
            layers, fem.Tool(5e-3, contact), fem.Support("bonded"), discretisation=fem.Discretisation(density)
        )

    np.testing.assert_allclose(depths(problem("default"), 5.0), depths(problem("fine"), 5.0), rtol=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("modulus", [60e3, 150e3])
def test_a_sheet_over_a_hole(modulus):
    def problem(density):
        sheet = fem.Layer("sheet", 4e-3, 1070.0, fem.NeoHookean(modulus, 0.49))
        return fem.Problem(
            (sheet,),
            fem.Tool(5e-3, "rigid_bonded"),
            fem.Support("hole", 0.03),
            discretisation=fem.Discretisation(density),
        )

    force = 1.5 * modulus / 60e3
    np.testing.assert_allclose(depths(problem("default"), force), depths(problem("fine"), force), rtol=5e-3)
