"""D: what the base explains has none, and it grows with the root of the repeats."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.blind.cases import BlindCase, CaseName, make_case
from benchmark.blind.hidden.hidden_effect import Hidden
from benchmark.blind.labs import USUAL_MODULUS_ERROR, USUAL_THICKNESS_ERROR, LabConditions
from benchmark.blind.scene import Noise, whiten
from benchmark.blind.session_files import remembered
from benchmark.blind.simulate import Signals
from benchmark.blind.strength import base_of, strength


class _Gain(Hidden):
    slug = "gain"

    def push(self, time, depth, elastic):
        return self.amplitude * elastic


def test_a_gain_is_no_effect(saturation: BlindCase) -> None:
    scene = saturation.scene
    assert strength(scene, base_of(scene), [_Gain(scale=scene.scale, amplitude=0.2)]) < 1e-6


def test_more_trials_make_an_effect_stronger(saturation: BlindCase) -> None:
    more = replace(saturation.scene, repeats=4 * saturation.scene.repeats)
    assert strength(more, base_of(more), saturation.effects) == pytest.approx(2 * saturation.strength, rel=1e-6)


def test_whitened_noise_is_white_with_unit_size(saturation: BlindCase) -> None:
    scene = replace(saturation.scene, grid=None, force_noise=Noise(0.01, 0.9))
    noise = remembered(scene.force_noise, (200_000,), np.random.default_rng(1))
    assert noise.std() == pytest.approx(0.01, rel=0.05)
    white = whiten(scene, Signals(noise, None, None)).force
    assert white.std() == pytest.approx(1.0, rel=0.05)
    assert abs(np.mean(white[1:] * white[:-1])) < 0.02


def test_what_nobody_states_of_the_layers_takes_up_what_looks_like_it() -> None:
    """A perspective looks like another thickness; a bond that tears after the press looks like none."""
    perspective = make_case(CaseName("effect", "perspective", 39108, lab="printed"))
    adhesion = make_case(CaseName("effect", "adhesion", 0, lab="printed"))
    assert perspective.unexplained < 0.5 * perspective.strength
    assert 0.95 * adhesion.strength < adhesion.unexplained <= 1.001 * adhesion.strength
    assert make_case(CaseName("null", "", 0)).unexplained is None


def test_a_lab_that_states_its_errors_is_taken_at_its_word() -> None:
    stated = LabConditions(name="as_labs_are", thickness_error=0.01, modulus_error=0.1)
    assert stated.unsure == stated
    silent = replace(stated, stated=False).unsure
    assert (silent.thickness_error, silent.modulus_error) == (USUAL_THICKNESS_ERROR, USUAL_MODULUS_ERROR)
    assert LabConditions().unsure.doubtful
    worse = LabConditions(thickness_error=0.1, stated=False)
    assert worse.unsure.thickness_error == 0.1
