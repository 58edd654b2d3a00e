"""One factor for several layers: what a plain fit must say of it."""

from types import SimpleNamespace

import pytest

from benchmark.identification import fit_session
from benchmark.runs.parameters_run import common_factor_warnings
from benchmark.scripting import Unheard
from tests.benchmark.identification.parameters import conftest as layered

toy = layered.toy


@pytest.fixture
def plain_fit(toy):
    """Factory of sessions of the toy specimen with their fit of one factor."""

    def fitted(truth, tools=(0, 1)):
        data = [(k, layered.toy_trial(n, k, f"t{n}", truth=truth)) for k in tools for n in range(5)]
        told = layered.ToySession()
        told.trials = [
            SimpleNamespace(tool=layered.TOOLS[k], support=layered.SUPPORT, condition=one.condition, name=one.name)
            for k, one in data
        ]
        rows = [one for _, one in data]
        return SimpleNamespace(
            session=told, fit=fit_session(rows, layered.TISSUE.layers), trials=rows, followed={}, filmed=None, sheets={}
        )

    return fitted


def test_a_specimen_whose_layers_differ_is_not_passed_with_one_factor(plain_fit) -> None:
    moduli = [one.youngs_modulus for one in layered.TISSUE.layers]
    wrong = dict(zip(layered.MODULI, (moduli[0], 0.5 * moduli[1], 1.5 * moduli[2]), strict=True))
    said = common_factor_warnings(plain_fit(wrong), Unheard())
    assert any("the layers differ" in text and "--free" in text for text in said)


def test_a_specimen_with_one_factor_is_passed_and_one_tool_is_told_to_tell_no_layers_apart(plain_fit) -> None:
    even = {key: 1.3 * one.youngs_modulus for key, one in zip(layered.MODULI, layered.TISSUE.layers, strict=True)}
    assert not any("the layers differ" in text for text in common_factor_warnings(plain_fit(even), Unheard()))
    said = common_factor_warnings(plain_fit(even, tools=(1,)), Unheard())
    assert any("cannot tell which layer differs" in text for text in said)
