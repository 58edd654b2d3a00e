"""Points in processes of this machine, also where processes die."""

import multiprocessing
import os
import signal

import pytest

from benchmark.sweeps.local import usable_cores, work_locally
from benchmark.sweeps.point import OK, Task, evaluate


class Deadly:
    """A scenario that kills whoever unpacks it."""

    def __reduce__(self):
        return os._exit, (13,)


@pytest.fixture
def tasks(plan_of) -> list[Task]:
    plan = plan_of("tool.radius=3 mm:6 mm:5", fem_kinematics="linear")
    return [Task(number, scenario) for number, scenario in enumerate(plan.scenarios, 1)]


def results(row):
    return {name: value for name, value in row.values.items() if not name.endswith("seconds_s")}


def test_processes_give_what_this_one_gives(tasks) -> None:
    rows = {row.point: row for row in work_locally(tasks, 2)}
    assert sorted(rows) == [1, 2, 3, 4, 5]
    for task in tasks:
        assert results(rows[task.point]) == pytest.approx(results(evaluate(task)), rel=1e-9)
    assert multiprocessing.active_children() == []


def test_a_killed_process_loses_no_point(tasks) -> None:
    work = work_locally(tasks, 1)
    rows = [next(work)]
    (child,) = multiprocessing.active_children()
    os.kill(child.pid, signal.SIGKILL)
    rows += list(work)
    assert sorted(row.point for row in rows) == [1, 2, 3, 4, 5]
    assert all(row.status == OK for row in rows)


def test_a_point_that_kills_its_process_twice_fails_with_the_reason(tasks) -> None:
    rows = {row.point: row for row in work_locally([Task(99, Deadly()), *tasks[:2]], 1)}
    assert rows[99].reason is not None
    assert "died 2 times (exit code 13)" in rows[99].reason
    assert [rows[point].status for point in (1, 2)] == [OK, OK]


def test_leaving_early_ends_the_processes(tasks) -> None:
    work = work_locally(tasks, 2)
    next(work)
    assert multiprocessing.active_children()
    work.close()
    assert multiprocessing.active_children() == []


def test_nothing_to_do_starts_nothing() -> None:
    assert list(work_locally([], 4)) == []
    assert usable_cores() >= 1
