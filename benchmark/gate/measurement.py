"""Measuring this version, alone or beside another revision."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from benchmark.errors import InputError
from benchmark.gate.plan import Plan
from benchmark.gate.revision import checked_out, commit_of, repository_of
from benchmark.gate.rounds import Party
from benchmark.gate.side import Side
from benchmark.gate.stored import StoredValue

PRODUCT = Path(__file__).resolve().parents[2]
"""The folder with the packages of the version that runs."""


@dataclass(frozen=True)
class Rival:
    """Another revision, checked out: its commit, and how it is measured."""

    commit: str
    party: Party


def this_version(plan: Plan) -> Party:
    """The version that runs this check."""
    return Party(partial(Side, PRODUCT), plan)


def subject(plan: Plan) -> Path:
    """The folder that a revision is of: the product's for its own gate, else that of a user's gate and model."""
    return PRODUCT if plan.shipped or not _has_own(plan) else plan.path.parent


@contextmanager
def rival(plan: Plan, revision: str) -> Iterator[Rival]:
    """Check another revision out: of the product, or of a user's own models where the gate file has any.

    Raises
    ------
    InputError
        No repository, or no such revision in it.
    """
    folder = subject(plan)
    repository = repository_of(folder)
    if repository is None:
        raise InputError(f"--against {revision}: {folder} is not in a git repository, so there are no revisions of it")
    commit = commit_of(repository, revision)
    with checked_out(repository, commit) as tree:
        if subject(plan) == PRODUCT:
            packages = tree / PRODUCT.relative_to(repository.resolve())
            yield Rival(commit, Party(partial(Side, packages, revision), plan))
        else:
            yield Rival(commit, Party(partial(Side, PRODUCT, revision), plan.moved(repository.resolve(), tree)))


def gated_values(party: Party) -> dict[str, StoredValue]:
    """The gated values of a party, from a process of its own; raises as `side.Side`."""
    with party.start() as side:
        found = side.values(party.plan)
    return {each["name"]: StoredValue(value=each["value"], unit=each["unit"], reason=each["reason"]) for each in found}


def _has_own(plan: Plan) -> bool:
    return any(table["own"] is not None for table in (*plan.cases, *plan.jobs))
