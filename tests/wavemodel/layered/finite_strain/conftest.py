"""A small body in few modes."""

import pytest

from wavemodel import WaveLayer
from wavemodel.layered.finite_strain.modal_body import StackBody, disc_modes, thickness_of
from wavemodel.layered.stack.laminate import laminate


@pytest.fixture(scope="session")
def small_body() -> StackBody:
    """Two layers, two sub-layers each, eight modes on 20 mm."""
    layers = [WaveLayer("a", 1e-3, 1000.0, 1e5, 0.48), WaveLayer("b", 5e-3, 1000.0, 2e4, 0.45)]
    return StackBody(disc_modes(20e-3, 8 * 3.1 / 20e-3), thickness_of(laminate(layers, [(0.5, 0.5)] * 2, "bonded")))
