"""Elastic effects as terms of the finite elements' own equations, with the numbers by which a refit changes them.

What the catalogue fits is the shape of a force; a solid has constants. Stiffening becomes Yeoh's c20 and c30 of every
layer over its c10, the same under any tool; pretension is the stress in the layers. Relaxation has a memory and is no
part of an elastic table (`solid_press.fading`); other effects have no term in the FEM.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from benchmark.files import Session
from benchmark.files.tissue import Layer, NeoHookean, Yeoh
from benchmark.physics import Effect, EffectParameter
from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Values
from benchmark.physics.setup_entry import PREFIX
from benchmark.response.setup_change import PRETENSION as STRESS

C20, C30 = "law.c20", "law.c30"
"""Keys of the numbers in a table, beside the stress's."""
MOST_GROWN = 2.0
"""A round may change a number by this share of its value, or by `LEAST_STEP` where that is more: derivatives serve no
farther."""
LEAST_STEP = 1.0
PER_GROWTH, THIRD = 1.5, 0.07
"""C20 over c10 by the growth of the force, and c30 by c20, where a refit begins. Cost."""
LEAST_START, MOST_START = 0.05, 5.0


@dataclass(frozen=True)
class NativeTerm:
    """How the finite elements carry an elastic effect.

    Attributes
    ----------
    slug : str
    words : str
        What it is in the solid.
    numbers : tuple of EffectParameter
        Its numbers, named by their keys in a table.
    start : (session, the effect's values) -> numbers by key
        Where a refit begins.
    changed : (session, numbers) -> the session with them
    ramp_keys : (session) -> by key, weights of the keys by which a ramp is differentiated
    refused : (session) -> why this specimen cannot carry it, or None
    """

    slug: str
    words: str
    numbers: tuple[EffectParameter, ...]
    start: Callable[[Session, Values], dict[str, float]]
    changed: Callable[[Session, Values], Session]
    ramp_keys: Callable[[Session], Mapping[str, Mapping[str, float]]]
    refused: Callable[[Session], str | None]


def as_entry(number: EffectParameter, now: float) -> Effect:
    """A number of a term as an entry that changes the table: by an amount, or by a share where it is a stress."""
    share = number.name == STRESS
    low = -0.9 if share else number.low - now
    high = MOST_GROWN if share else min(max(MOST_GROWN * now, LEAST_STEP), number.high - now)
    parameter = linear("change", "", low, high, number.meaning, 0.0)
    card = EffectDescription(f"{PREFIX}{number.name}", "setup", number.meaning, "", "", (parameter,))
    return Effect(card, "change")


def moved(number: str, now: float, change: float) -> float:
    """The number after a change of its entry."""
    return now * (1.0 + change) if number == STRESS else now + change


def _modulus(layer: Layer) -> float:
    """C10 in Pa of a layer at rest."""
    return 0.5 * (layer.hyperelastic.shear_modulus or layer.shear_modulus)


def _stiffened(session: Session, numbers: Values) -> Session:
    layers = tuple(
        layer.model_copy(
            update={
                "hyperelastic": Yeoh(
                    law="yeoh",
                    c10=_modulus(layer),
                    c20=numbers[C20] * _modulus(layer),
                    c30=numbers[C30] * _modulus(layer),
                )
            }
        )
        for layer in session.specimen.layers
    )
    return replace(session, specimen=session.specimen.model_copy(update={"layers": layers}))


def _constants(session: Session) -> Mapping[str, Mapping[str, float]]:
    """Each layer's constant by its modulus, so that the ratio is common to all."""
    layers = session.specimen.layers
    return {
        key: {f"{each.name}.hyperelastic.{key.removeprefix('law.')}": _modulus(each) for each in layers}
        for key in (C20, C30)
    }


def _constants_about(session: Session, values: Values) -> dict[str, float]:
    """Constants that stiffen a press about as much: its strain goes with depth over tool radius, not over thickness."""
    wide = session.tool.radius / session.specimen.thickness
    growth = PER_GROWTH * (values["b_1"] + values["b_2"]) * min(wide, 1.0) ** 2
    about = float(np.clip(growth, LEAST_START, MOST_START))
    return {C20: about, C30: THIRD * about}


def _own_law(session: Session) -> str | None:
    """Why a specimen does not take Yeoh's constants; None where all its layers are neo-Hookean."""
    if session.settings.get("fem.kinematics") == "linear":
        return "strain stiffening needs finite strain"
    own = [each for each in session.specimen.layers if not isinstance(each.hyperelastic, NeoHookean)]
    own += [each for each in session.specimen.layers if each.fibre is not None]
    return f"the layer {own[0].name} has a law of its own, which stiffens by itself" if own else None


STIFFENING = NativeTerm(
    "strain_stiffening",
    "Yeoh's law in every layer, c20 and c30 over c10 the same in all",
    (
        linear(C20, "", 0.0, 100.0, "c20 over c10 of every layer"),
        linear(C30, "", 0.0, 100.0, "c30 over c10 of every layer"),
    ),
    _constants_about,
    _stiffened,
    _constants,
    _own_law,
)
PRETENSION = NativeTerm(
    "pretension",
    "in-plane stress of all layers before the press",
    (linear(STRESS, "Pa", 0.0, 5e6, "in-plane stress of all layers"),),
    lambda session, values: {STRESS: max(values["pretension"], 1.0)},  # noqa: ARG005
    lambda session, numbers: replace(session, settings={**session.settings, STRESS: f"{numbers[STRESS]:.12g} Pa"}),
    lambda session: {STRESS: {STRESS: 1.0}},  # noqa: ARG005 - one number of any specimen
    lambda session: None,  # noqa: ARG005
)
TERMS = {term.slug: term for term in (STIFFENING, PRETENSION)}
"""By the effect's slug."""
