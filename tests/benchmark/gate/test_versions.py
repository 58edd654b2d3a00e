"""Revisions of a repository, on one made for the test."""

import subprocess
from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.gate.plan import load_plan
from benchmark.gate.versions import checked_out, commit_of, describe_revision, repository_of, rival

AUTHOR = ("-c", "user.name=test", "-c", "user.email=test@localhost")


def git(folder: Path, *arguments: str) -> str:
    done = subprocess.run(["git", "-C", str(folder), *arguments], check=True, capture_output=True, text=True)
    return done.stdout.strip()


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    folder = tmp_path / "repository"
    folder.mkdir()
    git(folder, "init", "--quiet")
    for text in ("first", "second"):
        (folder / "model.py").write_text(text)
        git(folder, "add", ".")
        git(folder, *AUTHOR, "commit", "--quiet", "-m", text)
    return folder


def test_a_revision_is_checked_out_beside_the_work_in_progress(repository: Path) -> None:
    (repository / "model.py").write_text("third, not committed")
    git(repository, "status")  # which renews the index
    before = {path: path.read_bytes() for path in (repository / ".git").rglob("*") if path.is_file()}
    commit = commit_of(repository, "HEAD~1")
    with checked_out(repository, commit) as tree:
        assert (tree / "model.py").read_text() == "first"
        assert len(git(repository, "worktree", "list").splitlines()) == 1  # none that a kill could leave behind
    assert not tree.exists()
    assert len(git(repository, "worktree", "list").splitlines()) == 1
    assert (repository / "model.py").read_text() == "third, not committed"
    assert {path: path.read_bytes() for path in (repository / ".git").rglob("*") if path.is_file()} == before


def test_it_is_removed_after_an_error_too(repository: Path) -> None:
    with pytest.raises(RuntimeError), checked_out(repository, "HEAD") as tree:
        raise RuntimeError
    assert not tree.exists()
    assert len(git(repository, "worktree", "list").splitlines()) == 1


def test_hooks_of_the_repository_do_not_run(repository: Path) -> None:
    for name in ("post-checkout", "post-index-change"):
        hook = repository / ".git" / "hooks" / name
        hook.parent.mkdir(exist_ok=True)
        hook.write_text(f"#!/bin/sh\ntouch '{repository}/hooked'\n")
        hook.chmod(0o755)
    with checked_out(repository, "HEAD") as tree:
        assert (tree / "model.py").exists()
        assert not (tree / "hooked").exists()
        assert not (repository / "hooked").exists()


@pytest.mark.parametrize("revision", ["no-such-branch", "--help", "HEAD~7", ""])
def test_a_revision_that_is_not_there_is_named(repository: Path, revision: str) -> None:
    with pytest.raises(InputError, match="--against"):
        commit_of(repository, revision)


def test_a_description_says_whether_files_have_changed(repository: Path) -> None:
    commit = git(repository, "rev-parse", "HEAD")
    (repository / "new.py").write_text("unknown to git")
    assert describe_revision(repository) == commit
    (repository / "model.py").write_text("changed")
    assert describe_revision(repository) == f"{commit}+"


def test_outside_a_repository_there_is_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    assert repository_of(tmp_path) is None
    assert describe_revision(tmp_path) is None


def test_a_repository_that_git_does_not_trust_is_told_in_its_words(tiny_gate, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a container the files are another user's; the refusal said that there is no repository."""
    gate = tiny_gate()
    git(gate.folder, "init", "--quiet")
    monkeypatch.setenv("GIT_TEST_ASSUME_DIFFERENT_OWNER", "1")
    with pytest.raises(InputError, match=r"--against HEAD: git tells no repository of .*dubious ownership"):
        rival(load_plan(gate.path), "HEAD").__enter__()
    monkeypatch.setenv("PATH", str(gate.folder))
    with pytest.raises(InputError, match=r"git cannot be run \(No such file"):
        rival(load_plan(gate.path), "HEAD").__enter__()


def test_outside_a_repository_no_revision_can_be_measured(tiny_gate, monkeypatch: pytest.MonkeyPatch) -> None:
    gate = tiny_gate()
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(gate.folder.parent))
    monkeypatch.setenv("LC_ALL", "de_DE.UTF-8")
    with pytest.raises(InputError, match=r"gate is not in a git repository, so there are no revisions of it$"):
        rival(load_plan(gate.path), "HEAD").__enter__()


def test_without_git_there_is_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert repository_of(tmp_path) is None
