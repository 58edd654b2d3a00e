"""This version beside another revision: of a user's own model, in a repository made for the test."""

import json
import subprocess
from pathlib import Path

import pytest

from benchmark.errors import InputError, NotComparableError
from benchmark.gate.accepting import accept
from benchmark.gate.checking import check
from benchmark.gate.measuring.jobs import SilentListener
from benchmark.gate.plan import CheckRequest, load_plan
from benchmark.gate.versions import PRODUCT, gated_values, rival, subject

AUTHOR = ("-c", "user.name=test", "-c", "user.email=test@localhost")


def git(folder: Path, *arguments: str) -> str:
    done = subprocess.run(["git", "-C", str(folder), *arguments], check=True, capture_output=True, text=True)
    return done.stdout.strip()


@pytest.fixture
def repository(tiny_gate):
    """The tiny gate, committed."""
    gate = tiny_gate(timed=True)
    git(gate.folder, "init", "--quiet")
    git(gate.folder, "add", ".")
    git(gate.folder, *AUTHOR, "commit", "--quiet", "-m", "first")
    return gate


def run(gate, tmp_path: Path, revision: str = "HEAD", **options: object):
    return check(CheckRequest(against=revision, gate=gate.path, out=tmp_path / "out", **options), SilentListener())


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The default baseline and history belong to the current folder."""
    monkeypatch.chdir(tmp_path)


def test_a_change_of_the_users_model_is_found_without_a_baseline_and_its_history_told_apart(
    repository, tmp_path: Path
) -> None:
    repository.change("my_model.py", "[1e-3", "[1.01e-3")
    verdict = run(repository, tmp_path).verdict
    failed = [row for row in verdict.accuracy if not row.passed]
    assert [(row.baseline, row.now) for row in failed] == [(pytest.approx(5.0), pytest.approx(5.05))]
    assert verdict.against == git(repository.folder, "rev-parse", "HEAD")
    assert "measured in the same minutes" in verdict.timing_source
    assert len(git(repository.folder, "worktree", "list").splitlines()) == 1
    entry = json.loads((tmp_path / "tissuebench-baseline.history.jsonl").read_text())
    assert entry["against"] == verdict.against


def test_a_change_that_is_far_slower_is_found(repository, tmp_path: Path) -> None:
    repository.change("my_model.py", "    return", "    sum(range(3_000_000))\n    return")
    outcome = run(repository, tmp_path)
    row = outcome.document["timing"][0]
    assert not row["passed"]
    assert row["now_ratio"] > 2.0 * row["baseline_ratio"]
    table = (tmp_path / "out" / "tables" / "rounds.csv").read_text()
    assert "now,1,springs.history," in table
    assert "against,1,springs.history," in table


@pytest.mark.slow
def test_an_accepted_baseline_goes_before_the_revision_for_values(repository, tmp_path: Path) -> None:
    repository.change("my_model.py", "[1e-3", "[1.01e-3")
    accept(CheckRequest(gate=repository.path), SilentListener())
    verdict = run(repository, tmp_path).verdict
    assert all(row.passed for row in verdict.accuracy)
    assert "baseline" in verdict.accuracy_source
    assert "revision" in verdict.timing_source


def test_a_baseline_that_is_asked_for_must_be_there(repository, tmp_path: Path) -> None:
    with pytest.raises(NotComparableError, match=r"b\.json"):
        run(repository, tmp_path, baseline=tmp_path / "b.json")


def test_a_revision_without_the_model_cannot_be_compared(repository, tmp_path: Path) -> None:
    git(repository.folder, "mv", "my_model.py", "new_model.py")
    repository.change("gate.toml", "my_model.py", "new_model.py")
    with pytest.raises(NotComparableError, match="HEAD"):
        run(repository, tmp_path)
    assert len(git(repository.folder, "worktree", "list").splitlines()) == 1


def test_unknown_revisions_are_bad_input(repository, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no-such-branch"):
        run(repository, tmp_path, "no-such-branch")


def test_outside_a_repository_there_are_no_revisions(
    tiny_gate, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    with pytest.raises(InputError, match="not in a git repository"):
        run(tiny_gate(), tmp_path)


def test_a_revision_is_the_products_unless_the_gate_has_own_models(tiny_gate) -> None:
    gate = tiny_gate()
    assert subject(load_plan(None)) == PRODUCT
    assert subject(load_plan(gate.path)) == gate.folder
    gate.change("gate.toml", '\nown = "my_model.py"', "")
    assert subject(load_plan(gate.path)) == PRODUCT


def test_a_package_of_the_users_repository_comes_from_the_revision_too(
    repository, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with_package(repository)
    monkeypatch.setenv("PYTHONPATH", str(repository.folder / "src"))
    outcome = run(repository, tmp_path)
    assert [row.baseline for row in outcome.verdict.accuracy] == pytest.approx([5.0, 4.0])
    assert [row.now for row in outcome.verdict.accuracy] == pytest.approx([5.7, 4.56])


def test_a_module_that_only_this_version_can_give_cannot_be_compared(
    repository, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = with_package(repository)
    finder = f'import sys\nsys.path.insert(0, "{package.parent}")\n'
    repository.model.write_text(finder + repository.model.read_text())
    git(repository.folder, *AUTHOR, "commit", "--quiet", "--all", "-m", "finder")
    with pytest.raises(NotComparableError, match=r"imports springs_own from .*gate/src/springs_own\.py"):
        run(repository, tmp_path)


def test_data_by_a_relative_path_are_those_of_each_side(
    repository, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both sides read the working copy, so that 14 % in every value were green."""
    with_data(repository, "data/weights.json")
    monkeypatch.chdir(repository.folder)
    failed = run(repository, tmp_path).verdict.accuracy
    assert [row.baseline for row in failed] == pytest.approx([5.0, 4.0])
    assert [row.now for row in failed] == pytest.approx([5.7, 4.56])
    assert (repository.folder / "tissuebench-baseline.history.jsonl").is_file()  # the user's, beside no baseline


@pytest.mark.parametrize(
    ("here", "read"), [("data", "weights.json"), ("data/new", "../weights.json"), ("elsewhere", None)]
)
def test_the_revision_runs_in_the_same_folder_of_its_own(
    repository, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, here: str, read: str | None
) -> None:
    """A folder that the revision lacks is made there; outside of the repository both run where the user is."""
    folder = (repository.folder if read else tmp_path) / here
    with_data(repository, read or "../gate/data/weights.json")
    folder.mkdir(exist_ok=True)
    monkeypatch.chdir(folder)
    first = [each.value for each in revision_values(repository).values()]
    assert first == pytest.approx([5.0, 4.0] if read else [5.7, 4.56])
    assert Path.cwd() == folder


def test_data_that_the_revision_lacks_are_told(repository, monkeypatch: pytest.MonkeyPatch) -> None:
    data = with_data(repository, "data/weights.json")
    git(repository.folder, "rm", "--quiet", "--cached", str(data))
    git(repository.folder, *AUTHOR, "commit", "--quiet", "-m", "left out")
    monkeypatch.chdir(repository.folder)
    with pytest.raises(NotComparableError, match=r"FileNotFoundError: .*; a relative path means the revision's own"):
        revision_values(repository)


@pytest.mark.parametrize("kind", ["file", "link", "ring"])
def test_a_current_folder_that_is_none_in_the_revision_is_told(
    repository, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    new = repository.folder / "new"
    if kind == "file":
        new.write_text("a folder only now")
    else:
        (tmp_path / "outside").mkdir()
        new.symlink_to(tmp_path / "outside" if kind == "link" else "new")
    git(repository.folder, "add", "new")
    git(repository.folder, *AUTHOR, "commit", "--quiet", "-m", kind)
    new.unlink()
    (new / "sub").mkdir(parents=True)
    monkeypatch.chdir(new / "sub")
    with pytest.raises(NotComparableError, match=r"the current folder, .*gate/new/sub, is no folder there"):
        revision_values(repository)
    assert not (tmp_path / "outside" / "sub").exists()


def test_a_relative_folder_of_modules_outside_of_the_repository_stays(
    repository, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared" / "springs_shared.py").write_text("FACTOR = 2.0\n")
    repository.change("my_model.py", "import numpy as np", "import numpy as np\nfrom springs_shared import FACTOR")
    repository.change("my_model.py", "np.outer(force,", "np.outer(FACTOR * force,")
    git(repository.folder, *AUTHOR, "commit", "--quiet", "--all", "-m", "shared")
    monkeypatch.setenv("PYTHONPATH", "../shared")
    monkeypatch.chdir(repository.folder)
    assert [each.value for each in revision_values(repository).values()] == pytest.approx([10.0, 8.0])


def revision_values(repository):
    with rival(load_plan(repository.path), "HEAD") as other:
        return gated_values(other.party)


def with_data(repository, read: str) -> Path:
    """Give the model a factor that it reads from a file of the repository, committed, and 14 % off since."""
    data = repository.folder / "data" / "weights.json"
    data.parent.mkdir()
    data.write_text("1.0")
    repository.change("my_model.py", "    return", f'    factor = float(open("{read}").read())\n    return')
    repository.change("my_model.py", "np.outer(force,", "np.outer(factor * force,")
    git(repository.folder, "add", ".")
    git(repository.folder, *AUTHOR, "commit", "--quiet", "-m", "data")
    data.write_text("1.14")
    return data


def with_package(repository) -> Path:
    """Give the model a module of its own repository, committed, and 14 % off since."""
    package = repository.folder / "src" / "springs_own.py"
    package.parent.mkdir()
    package.write_text("FACTOR = 1.0\n")
    repository.change("my_model.py", "import numpy as np", "import numpy as np\nfrom springs_own import FACTOR")
    repository.change("my_model.py", "np.outer(force,", "np.outer(FACTOR * force,")
    git(repository.folder, "add", ".")
    git(repository.folder, *AUTHOR, "commit", "--quiet", "-m", "package")
    package.write_text("FACTOR = 1.14\n")
    return package
