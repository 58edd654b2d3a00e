"""The catalogue is whole, and a user's own effect joins it."""

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.physics import SLUGS, catalogue, load_effects

OWN = '''
"""A force offset that goes with the depth squared."""

from dataclasses import replace

from benchmark.physics import EffectDescription, Effect, EffectParameter, Readings

DESCRIPTION = EffectDescription(
    slug="square_offset",
    acts_on="observation",
    sentence="An offset grows with the depth squared.",
    equation="F_read = F + c d^2",
    source="an example",
    parameters=(EffectParameter("c", "N/m^2", (1.0,), 0.0, 1e6, False, "strength"),),
)


def observe(values, readings, motion, context):
    return replace(readings, force=readings.force + values["c"] * motion.depth**2)


EFFECT = Effect(DESCRIPTION, "c", observe=observe)
'''


def test_the_catalogue_has_its_22_entries_in_order():
    assert tuple(effect.slug for effect in catalogue()) == SLUGS
    assert len(SLUGS) == 22


def test_effects_act_on_drive_body_or_observation():
    assert {effect.description.acts_on for effect in catalogue()} == {"drive", "body", "observation"}


def test_an_own_effect_is_loaded_from_its_file(tmp_path):
    from benchmark.physics import Motion, Readings

    file = tmp_path / "my_effect.py"
    file.write_text(OWN)
    (own,) = load_effects(file)
    assert own.slug == "square_offset"
    assert own.origin == str(file)
    depth = np.array([0.0, 2.0])
    motion = Motion(depth, depth, depth)
    made = own.observe({"c": 3.0}, Readings(np.ones(2)), motion, None)
    assert made.force == pytest.approx([1.0, 13.0])
    assert list(tmp_path.iterdir()) == [file]
    file.write_text(OWN.replace("square_offset", "square_origin"))  # as long, and perhaps in the same second
    assert load_effects(file)[0].slug == "square_origin"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 1\n", "no Effect"),
        ("import no_such_module_at_all\n", "does not run"),
        (OWN.replace("square_offset", "backlash"), "is taken"),
        ("import os\nos._exit(0)\n", "does not run"),
    ],
)
def test_an_unusable_file_is_refused(tmp_path, text, message):
    file = tmp_path / "bad.py"
    file.write_text(text)
    with pytest.raises(InputError, match=message):
        load_effects(file)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="no such effects file"):
        load_effects(tmp_path / "none.py")
