from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.identification.parameters.law_selection import scores, simplest


def answer(residuals, shape=""):
    held = SimpleNamespace(trial_rms_percent=tuple(residuals))
    own = [SimpleNamespace(key="law.jm", text=shape)] if shape else []
    return SimpleNamespace(held_out=[held], estimates=own)


def test_the_law_that_predicts_better_is_first_and_the_others_are_behind() -> None:
    good, bad = np.linspace(0.9, 1.1, 8), np.linspace(1.9, 2.1, 8)
    first, second = scores({"neo_hookean": answer(bad), "gent": answer(good, "law.jm 2")})
    assert (first.law, second.law) == ("gent", "neo_hookean")
    assert not second.tied
    assert second.behind == pytest.approx(np.log(2.0), abs=0.02)
    assert simplest((first, second)) == "gent"


def test_laws_that_predict_alike_are_tied_and_the_plain_one_goes_on() -> None:
    base = np.linspace(0.9, 1.1, 8)
    found = scores({"neo_hookean": answer(1.001 * base), "yeoh": answer(base, "law.c20_over_c10 0.01")})
    assert all(one.tied for one in found)
    assert "tied" in found[1].text
    assert simplest(found) == "neo_hookean"


def test_without_anything_held_out_no_law_is_chosen() -> None:
    assert scores({"yeoh": SimpleNamespace(held_out=[], estimates=[])}) == ()
