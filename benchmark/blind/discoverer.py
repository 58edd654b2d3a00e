"""Which discovery is put on trial: a function of a session and a seed, named `module:function`."""

from __future__ import annotations

import importlib
from typing import Any, Protocol, cast

from benchmark.discovery.discovery_result import Discovery
from benchmark.errors import InputError
from benchmark.files.sessions.trials import Session

PRODUCT = "benchmark.discovery:discover"


class Discoverer(Protocol):
    """Answers for a session."""

    def __call__(self, session: Session, *, seed: int) -> Discovery:
        """Find where and why the model and the session disagree."""
        ...


def load_discoverer(name: str) -> Discoverer:
    """The function of that name; the product's own gets its usual settings, the seed, and one process.

    Raises
    ------
    InputError
        It is not of the form `module:function`, or there is no such function.
    """
    found = _function(name)
    if name != PRODUCT:
        return cast(Discoverer, found)
    settings = _function("benchmark.discovery:Settings")

    def product(session: Session, *, seed: int) -> Discovery:
        return cast(Discovery, found(session, settings=settings(seed=seed, workers=1)))

    return product


def _function(name: str) -> Any:
    """What a module has under a name, if it can be called; raises InputError."""
    module, _, function = name.partition(":")
    try:
        found = getattr(importlib.import_module(module), function)
    except (ImportError, ValueError, AttributeError):
        found = None
    if not callable(found):
        raise InputError(
            f"--discoverer {name!r}: there is no such function; allowed: module:function, as in {PRODUCT}, called with "
            "a session and a seed"
        )
    return found
