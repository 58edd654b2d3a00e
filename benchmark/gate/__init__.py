"""The regression gate: has accuracy or speed got worse, and only then red.

Names are loaded when first used: a measured process takes this package over another revision's `benchmark`, which need
not have what the rest of the gate imports (see `measuring.child`).
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from benchmark.gate.accepting import Accepted, accept
    from benchmark.gate.checking import CheckOutcome, check
    from benchmark.gate.plan import CheckRequest

__all__ = ["Accepted", "CheckOutcome", "CheckRequest", "accept", "check"]

_HOMES = {
    "Accepted": "benchmark.gate.accepting",
    "CheckOutcome": "benchmark.gate.checking",
    "CheckRequest": "benchmark.gate.plan",
    "accept": "benchmark.gate.accepting",
    "check": "benchmark.gate.checking",
}


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module 'benchmark.gate' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
