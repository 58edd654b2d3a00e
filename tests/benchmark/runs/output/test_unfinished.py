"""The folder beside a result in which a run keeps what it has so far."""

import errno
from pathlib import Path

import pytest

from benchmark.errors import InputError, InterruptedRunError, SolverError
from benchmark.runs.output.unfinished import unfinished
from reports.result_folder import KeptElsewhereError


def begin(keep: Path) -> None:
    keep.mkdir()
    (keep / "fem_steps.kept").write_bytes(b"steps")


def ended_by(error: BaseException, folder: Path) -> None:
    with unfinished(folder) as keep:
        begin(keep)
        raise error


def test_it_goes_when_the_run_is_finished(tmp_path: Path) -> None:
    with unfinished(tmp_path / "press") as keep:
        assert not keep.exists()
        begin(keep)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("kind", "told"), [(KeyboardInterrupt, InterruptedRunError), (SolverError, SolverError)])
def test_it_stays_after_an_interruption_which_says_how_to_go_on(
    tmp_path: Path, kind: type[BaseException], told: type[Exception]
) -> None:
    with pytest.raises(told, match=r"the same command with --out .*press goes on from there"):
        ended_by(kind("it broke"), tmp_path / "press")
    assert [each.name for each in tmp_path.iterdir()] == [".press.unfinished"]


def test_it_goes_where_the_result_is_kept_elsewhere(tmp_path: Path) -> None:
    with pytest.raises(KeptElsewhereError, match="in /elsewhere"):
        ended_by(KeptElsewhereError("the result is in /elsewhere"), tmp_path / "press")
    assert list(tmp_path.iterdir()) == []


def test_it_stays_where_a_full_disk_takes_no_result_which_says_how_to_go_on(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"No space.*; .*the same command"):
        ended_by(OSError(errno.ENOSPC, "No space left on device"), tmp_path / "press")
    assert [each.name for each in tmp_path.iterdir()] == [".press.unfinished"]


def test_an_early_interruption_promises_nothing(tmp_path: Path) -> None:
    with pytest.raises(SolverError, match=r"^it broke$"), unfinished(tmp_path / "press"):
        raise SolverError("it broke")


def test_something_else_of_that_name_is_refused_and_kept(tmp_path: Path) -> None:
    taken = tmp_path / ".press.unfinished"
    taken.mkdir()
    (taken / "thesis.tex").write_text("years of work")
    with pytest.raises(InputError, match="holds something else"), unfinished(tmp_path / "press"):
        pass
    assert (taken / "thesis.tex").read_text() == "years of work"


def ended_with_nothing_kept(error: BaseException, folder: Path) -> None:
    with unfinished(folder) as keep:
        (keep / "ecoflex").mkdir(parents=True)
        raise error


@pytest.mark.parametrize("kind", [InputError, SolverError, OSError, KeyboardInterrupt])
def test_an_empty_one_goes_and_promises_nothing(tmp_path: Path, kind: type[BaseException]) -> None:
    with pytest.raises(kind) as caught:
        ended_with_nothing_kept(kind("it broke"), tmp_path / "press")
    assert list(tmp_path.iterdir()) == []
    assert "goes on from there" not in str(caught.value)
