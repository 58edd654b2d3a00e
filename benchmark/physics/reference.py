"""The effects as a page of the reference tells them: Markdown from their declarations."""

from __future__ import annotations

from collections.abc import Iterator

from benchmark.physics.description import EffectDescription
from benchmark.physics.registry import catalogue

HEAD = """## Effects

What a model can lack, by the name that `discover`, `model.toml` and reports use, in the order of the catalogue. Keys of
`[physics]` state the same quantities in a scenario. "On top" acts on the force of an elastic press (quasi-linear).
"""


def effects_reference() -> str:
    """A section for each effect: equation, source, how wave and FEM carry it, and its parameters with their bounds."""
    effects = ((effect.richer or effect).description for effect in catalogue())
    return "\n".join([HEAD, *(line for each in effects for line in _section(each))])


def _section(effect: EffectDescription) -> Iterator[str]:
    yield from (f"### `{effect.slug}`", "", f"{effect.sentence} Acts on: {effect.acts_on}.", "")
    yield from (f"    {effect.equation}", "", f"Source: {effect.source}.")
    if effect.acts_on == "body":
        yield from ("", f"Wave: {effect.in_wave or 'not carried'}. FEM: {effect.in_fem or 'not carried'}.")
    yield from ("", "| parameter | unit | a fit searches | key of `[physics]` | is |", "|---|---|---|---|---|")
    for each in effect.parameters:
        key = f"`{each.key}`" if each.key else ""
        yield f"| `{each.name}` | {each.unit} | {each.low:g} to {each.high:g} | {key} | {each.meaning} |"
    for each in effect.options:
        yield f"| | {each.unit} | not searched | `{each.key}` | {each.meaning} |"
    yield ""
