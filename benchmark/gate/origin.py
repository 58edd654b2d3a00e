"""What this check is of, and where it runs: for baselines and histories."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from benchmark.gate.measurement import subject
from benchmark.gate.plan import Plan
from benchmark.gate.revision import describe_revision
from benchmark.gate.stored import Machine
from benchmark.runs.document import describe_environment

DECISIVE = ("numpy", "scipy", "pypardiso")
"""Packages whose version can change a ratio of times."""


@dataclass(frozen=True)
class Origin:
    """Environment (content of `environment.json`) and revision of what is measured (None outside a repository)."""

    environment: Mapping[str, Any]
    revision: str | None

    @property
    def machine(self) -> Machine:
        """The part of the environment that decides whether ratios carry over."""
        packages = {name: self.environment["packages"][name] for name in DECISIVE}
        return Machine(processor=self.environment["processor"], python=self.environment["python"], packages=packages)

    @property
    def made(self) -> str:
        """Date and time, UTC."""
        return str(self.environment["made"])


def origin_of(plan: Plan, seed: int) -> Origin:
    """Where and of what a plan is measured now."""
    return Origin(describe_environment(seed=seed), describe_revision(subject(plan)))
