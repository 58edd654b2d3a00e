import tomllib

import numpy as np
import pytest

from benchmark.discovery.discovery_request import DiscoverRequest, answer
from benchmark.errors import InputError
from benchmark.files import load_session, load_tissue
from benchmark.files.shipped import session_folder, shipped_sessions
from benchmark.scripting import Unheard
from benchmark.sessions import HIDDEN_EFFECT, SHIPPED
from benchmark.sessions.make_gel_pad import PRESSES, TRIALS, hidden_pad, trials, truth_text

PAD = SHIPPED / HIDDEN_EFFECT


def test_it_is_whole_small_and_says_that_it_is_synthetic() -> None:
    session = load_session(PAD)
    assert session.synthetic
    assert [trial.condition for trial in session.trials] == [press.name for press in PRESSES for _ in range(TRIALS)]
    named = {trial.path.name for trial in session.trials} | {"session.toml", "pad.toml"}
    assert {file.name for file in PAD.iterdir()} == named
    assert sum(file.stat().st_size for file in PAD.iterdir()) < 300_000


def test_the_truth_lies_apart_and_nothing_in_the_session_gives_it_away() -> None:
    text = (SHIPPED / f"{HIDDEN_EFFECT}_truth.toml").read_text()
    assert text == truth_text()
    truth = tomllib.loads(text)
    assert not [file for file in PAD.iterdir() if "truth" in file.name or truth["effect"] in file.read_text()]


def test_what_is_pressed_is_stiffer_in_its_law_than_what_is_told() -> None:
    told = load_tissue(PAD / "pad.toml")
    for real, said in zip(hidden_pad(told).layers, told.layers, strict=True):
        assert said.hyperelastic.law == "neo_hookean"
        assert real.hyperelastic.law == "yeoh"
        assert real.hyperelastic.shear_modulus == pytest.approx(real.shear_modulus)
        assert real.hyperelastic.c20 > 0.0


def test_trials_differ_in_gain_touch_zero_and_noise() -> None:
    press = PRESSES[0]
    corners, depths = press.corners()
    curve = (corners, np.clip(1e3 * depths, 0.0, None))
    made = list(trials(press, curve, np.random.default_rng(1)))
    assert len(made) == TRIALS
    peaks = [float(table.force.max()) for table in made]
    assert len(set(peaks)) == TRIALS
    assert peaks == pytest.approx([1e3 * press.depth] * TRIALS, rel=0.06)


def test_a_bare_name_means_the_shipped_session_unless_a_folder_is_called_so(tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert {"phantom", HIDDEN_EFFECT} <= set(shipped_sessions())
    bare = type(PAD)(HIDDEN_EFFECT)
    assert session_folder(bare) == PAD
    assert load_session(bare).name == HIDDEN_EFFECT
    bare.mkdir()
    assert session_folder(bare) == bare
    with pytest.raises(InputError, match=r"no such session folder or file, and the shipped ones are gel_pad, phantom"):
        load_session("nowhere")


@pytest.mark.slow
def test_the_hidden_effect_is_found(tmp_path) -> None:
    truth = tomllib.loads((SHIPPED / f"{HIDDEN_EFFECT}_truth.toml").read_text())
    found = answer(DiscoverRequest([PAD], out=tmp_path / "out"), Unheard()).found
    assert found.effects[0].slug == truth["effect"]
    assert found.verdict in ("named", "conditional")
    assert all(gap.closed > 0.9 for gap in found.gap if gap.closed is not None)
