"""Which versions are measured: this one, or another revision checked out beside it; of what commit, and where."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from bench_hw.storage.folder_lock import scratch
from benchmark.errors import InputError
from benchmark.gate.baseline import Machine, StoredValue
from benchmark.gate.plan import GatePlan
from benchmark.gate.processes import Party, Side
from benchmark.runs.output.document import describe_environment

DECISIVE = ("numpy", "scipy", "pypardiso")
"""Packages whose version can change a ratio of times."""


def repository_of(folder: Path) -> Path | None:
    """The top folder of the git repository that a folder is in; None where there is none, or no git."""
    try:
        found = _git(folder, "rev-parse", "--show-toplevel")
    except InputError:
        return None
    return Path(found)


def describe_revision(folder: Path) -> str | None:
    """The commit that a folder is at, with "+" where files that git knows have changed; None outside a repository."""
    try:
        commit = _git(folder, "rev-parse", "HEAD")
        changed = _git(folder, "status", "--porcelain", "--untracked-files=no")
    except InputError:
        return None
    return f"{commit}+" if changed else commit


def commit_of(repository: Path, revision: str) -> str:
    """The full name of the commit that a revision means; raises InputError where there is none."""
    try:
        return _git(repository, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
    except InputError:
        raise InputError(
            f"--against {revision}: the repository {repository} has no such revision; give a commit, tag or branch, "
            "and fetch it first (a shallow clone has only its newest commit)"
        ) from None


@contextmanager
def checked_out(repository: Path, commit: str) -> Iterator[Path]:
    """Yield a temporary folder with the files of a commit, removed on leaving; the repository stays as it is.

    Raises
    ------
    InputError
        Git cannot make it.
    """
    with scratch() as parent:
        tree, index = parent.resolve() / "tree", parent.resolve() / "index"
        tree.mkdir()
        plainly = ("-c", "core.hooksPath=/dev/null", "-c", "core.sparseCheckout=false")
        _git(repository, *plainly, "read-tree", commit, index=index)
        _git(repository, "checkout-index", "--all", f"--prefix={tree}/", index=index)
        yield tree


def _git(folder: Path, *arguments: str, index: Path | None = None) -> str:
    """What a git command prints, with an index of its own where one is given; InputError where it fails."""
    own = {"LC_ALL": "C"} if index is None else {"LC_ALL": "C", "GIT_INDEX_FILE": str(index)}
    command = ["git", "-C", str(folder), *arguments]
    try:
        done = subprocess.run(command, env={**os.environ, **own}, capture_output=True, text=True, check=False)
    except OSError as error:
        raise InputError(f"git cannot be run ({error.strerror or error}); --against needs it") from None
    if done.returncode:
        raise InputError(f"git {arguments[0]}: {done.stderr.strip() or f'exit code {done.returncode}'}")
    return done.stdout.strip()


PRODUCT = Path(__file__).resolve().parents[2]
"""The folder with the packages of the version that runs."""


@dataclass(frozen=True)
class OtherRevision:
    """Another revision, checked out: its commit, and how it is measured."""

    commit: str
    party: Party


def this_version(plan: GatePlan) -> Party:
    """The version that runs this check."""
    return Party(partial(Side, PRODUCT), plan)


def subject(plan: GatePlan) -> Path:
    """The folder that a revision is of: the product's for its own gate, else that of a user's gate and model."""
    return PRODUCT if plan.shipped or not _has_own(plan) else plan.path.parent


@contextmanager
def rival(plan: GatePlan, revision: str) -> Iterator[OtherRevision]:
    """Check another revision out: of the product, or of a user's own models where the gate file has any.

    Raises
    ------
    InputError
        No repository, or no such revision in it.
    """
    folder = subject(plan)
    repository = repository_of(folder)
    if repository is None:
        raise InputError(f"--against {revision}: {_why_no_repository(folder)}")
    commit = commit_of(repository, revision)
    with checked_out(repository, commit) as tree:
        if subject(plan) == PRODUCT:
            packages = tree / PRODUCT.relative_to(repository.resolve())
            yield OtherRevision(commit, Party(partial(Side, packages, revision), plan))
        else:
            moved = (repository.resolve(), tree)
            yield OtherRevision(commit, Party(partial(Side, PRODUCT, revision, moved), plan.moved(*moved)))


def _why_no_repository(folder: Path) -> str:
    """Why git tells no repository of a folder: there is none, git cannot be run, or does not trust another user's."""
    try:
        _git(folder, "rev-parse", "--show-toplevel")
    except InputError as error:
        if "not a git repository" not in str(error):
            return f"git tells no repository of {folder}: {error}"
    return f"{folder} is not in a git repository, so there are no revisions of it"


def gated_values(party: Party) -> dict[str, StoredValue]:
    """The gated values of a party, from a process of its own; raises as `processes.Side`."""
    with party.start() as side:
        found = side.values(party.plan)
    return {
        each["name"]: StoredValue(value=each["value"], unit=each["unit"], reason=each["reason"], curve=each["curve"])
        for each in found
    }


def _has_own(plan: GatePlan) -> bool:
    return any(table["own"] is not None for table in (*plan.cases, *plan.jobs))


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


def origin_of(plan: GatePlan, seed: int) -> Origin:
    """Where and of what a plan is measured now."""
    return Origin(describe_environment(seed=seed), describe_revision(subject(plan)))
