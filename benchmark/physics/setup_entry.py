"""A set-up that is not as told, as an entry of the catalogue: one a parameter or choice of a session's set-up.

An entry has no term of its own: it changes the elastic base beyond what a person may be expected to be wrong by, by the
derivatives of the base's table. Its slug is `setup.` and the key as in `--set` (`setup.support.clamp`).
"""

from __future__ import annotations

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Effect

PREFIX = "setup."
SOURCE = "derivatives of the finite-element base by the set-up; see docs/discovery-method.md"
MEANINGS = {
    "support.clamp": "share of the way to the other clamp: at the rim of the hole for a plate round it",
    "tool.contact": "share of the way to the other contact: sliding for sticking",
    "tool.radius": "relative change of the tool's radius",
    "support.hole_radius": "relative change of the hole's radius",
    "thickness": "relative change of the layer's thickness",
    "youngs_modulus": "natural logarithm of the factor on the layer's modulus beside the common one",
    "stiffness": "natural logarithm of the factor on all the layer's stresses beside the common one",
    "poisson_ratio": "relative change of the layer's Poisson's ratio",
}
"""What the parameter of an entry is, by its key or the last part of it."""


def setup_entry(key: str, farthest: float, *, choice: bool) -> Effect:
    """The entry of one key.

    Parameters
    ----------
    key
        As in `--set`.
    farthest
        How far the change may go, either way.
    choice
        Whether the key has no number: the change is then the share of the way to the other choice, from 0 up.
    """
    meaning = MEANINGS.get(key) or MEANINGS.get(key.rpartition(".")[2], f"relative change of {key}")
    start, low = (1.0, 0.0) if choice else (0.2 * farthest, -farthest)
    description = EffectDescription(
        slug=PREFIX + key,
        acts_on="setup",
        sentence=f"The set-up is not as told: {key} is another.",
        equation="base(key) = base + change d base / d key (to second order)",
        source=SOURCE,
        parameters=(linear("share" if choice else "change", "", low, farthest, meaning, start),),
    )
    return Effect(description, description.parameters[0].name)


def setup_key(slug: str) -> str | None:
    """The key of a set-up entry by its slug; None for an effect."""
    return slug.removeprefix(PREFIX) if slug.startswith(PREFIX) else None


def effect_name(slug: str) -> str:
    """An effect in words, strain stiffening; of a set-up entry what is not as told: another support.hole_radius."""
    key = setup_key(slug)
    return slug.replace("_", " ") if key is None else f"another {key}"
