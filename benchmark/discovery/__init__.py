"""Discovery: where simulation and measured trials disagree, which effect is missing, how much of the gap it closes.

Names are loaded when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from benchmark.discovery.criteria import Settings
    from benchmark.discovery.discovery_result import Discovery
    from benchmark.discovery.planning.rivals import Rival, expected, rivals
    from benchmark.discovery.workflow import Findings, discover, findings

__all__ = ["Discovery", "Findings", "Rival", "Settings", "discover", "expected", "findings", "rivals"]

_HOMES = {
    "Discovery": "discovery_result",
    "Findings": "workflow",
    "Rival": "planning.rivals",
    "Settings": "criteria",
    "discover": "workflow",
    "expected": "planning.rivals",
    "findings": "workflow",
    "rivals": "planning.rivals",
}


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module 'benchmark.discovery' has no attribute {name!r}")
    return getattr(import_module(f"benchmark.discovery.{_HOMES[name]}"), name)
