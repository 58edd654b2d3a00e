"""Presses of a three-layer skin, small and finite strain, set up once."""

from functools import cache

import pytest

from benchmark.files import load_scenario
from benchmark.press.press_page import document
from benchmark.press.pressed_specimen import pressed_specimen
from wavemodel import DiscTool, LayeredWave, Prony, WaveDiscretisation, WaveLayer

SKIN = (
    WaveLayer("epidermis", 0.2e-3, 1150.0, 1e6, 0.48),
    WaveLayer("dermis", 1.5e-3, 1116.0, 2e5, 0.48),
    WaveLayer("fat", 8e-3, 971.0, 3e4, 0.48),
)


@pytest.fixture(scope="session")
def wave():
    """A wave with few modes, of small or of finite strain."""

    @cache
    def wave(large_press="linear"):
        discretisation = WaveDiscretisation(window=40e-3, modes=24)
        return LayeredWave(SKIN, DiscTool(3e-3), discretisation=discretisation, large_press=large_press)

    return wave


@pytest.fixture(scope="session")
def series():
    return Prony((0.3, 0.2), (0.05, 0.6))


@pytest.fixture(scope="session")
def specimen():
    return pressed_specimen(load_scenario("skin-5N", {"fem.mesh": "coarse", "load.peak": "2 N"}))


@pytest.fixture(scope="session")
def page_document(specimen):
    return document([specimen])
