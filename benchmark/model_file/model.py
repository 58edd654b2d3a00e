"""A model under repair as a file holds it: a base, the effects that were added, and what speaks for them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Value:
    """A parameter in SI, with its 95 % interval where one is known."""

    value: float
    unit: str
    ci95: tuple[float, float] | None = None


@dataclass(frozen=True)
class AddedEffect:
    """An effect of the catalogue with its parameters by name."""

    slug: str
    parameters: Mapping[str, Value]

    def values(self) -> dict[str, float]:
        """The parameters in SI."""
        return {name: each.value for name, each in self.parameters.items()}


@dataclass(frozen=True)
class RepairedModel:
    """Content of `model.toml`.

    Attributes
    ----------
    name : str
        What messages call it: the path as given.
    tissue, model : str
        The base: tissue and "wave" or "fem".
    large_press : str
        Elastic law of the wave that the effects were found on top of: "linear" or "corrected".
    effects : tuple of AddedEffect
        In the order in which they were found.
    evidence : mapping
        Session, its fingerprint, verdict, gap: for people.
    own_effects : Path or None
        Where effects that are not of the catalogue come from.
    """

    name: str
    tissue: str
    model: str
    effects: tuple[AddedEffect, ...]
    evidence: Mapping[str, Any]
    large_press: str = "linear"
    own_effects: Path | None = None

    @property
    def slugs(self) -> tuple[str, ...]:
        """The names of the effects."""
        return tuple(effect.slug for effect in self.effects)
