"""Discovery: where simulation and measured trials disagree, which effect is missing, how much of the gap it closes.

Names are loaded when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from benchmark.discovery.expectation import Rival, expected, rivals
    from benchmark.discovery.result import Discovery
    from benchmark.discovery.settings import Settings
    from benchmark.discovery.workflow import Findings, discover, findings

__all__ = ["Discovery", "Findings", "Rival", "Settings", "discover", "expected", "findings", "rivals"]

_HOMES = {
    "Discovery": "result",
    "Findings": "workflow",
    "Rival": "expectation",
    "Settings": "settings",
    "discover": "workflow",
    "expected": "expectation",
    "findings": "workflow",
    "rivals": "expectation",
}


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module 'benchmark.discovery' has no attribute {name!r}")
    return getattr(import_module(f"benchmark.discovery.{_HOMES[name]}"), name)
