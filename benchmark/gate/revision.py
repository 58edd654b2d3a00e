"""Other revisions of a repository, checked out beside it."""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from benchmark.errors import InputError


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
    """Yield a temporary folder with the files of a commit: a git worktree, removed on leaving.

    Raises
    ------
    InputError
        Git cannot make it.
    """
    with tempfile.TemporaryDirectory(prefix="tissuebench-") as parent:
        tree = Path(parent).resolve() / "tree"
        no_hooks = ("-c", "core.hooksPath=/dev/null")
        _git(repository, *no_hooks, "worktree", "add", "--quiet", "--detach", "--force", str(tree), commit)
        try:
            yield tree
        finally:
            _git(repository, "worktree", "remove", "--force", str(tree))


def _git(folder: Path, *arguments: str) -> str:
    """What a git command prints; InputError where it fails."""
    try:
        done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, check=False)
    except OSError as error:
        raise InputError(f"git cannot be run ({error.strerror or error}); --against needs it") from None
    if done.returncode:
        raise InputError(f"git {arguments[0]}: {done.stderr.strip() or f'exit code {done.returncode}'}")
    return done.stdout.strip()
