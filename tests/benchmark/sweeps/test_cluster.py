"""Points on a Dask cluster started from the command line, also where a worker or the scheduler is killed."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from benchmark.resumable import read_rows
from benchmark.sweeps import cluster as cluster_module
from benchmark.sweeps.cluster import ClusterError, on_cluster, work_on_cluster
from benchmark.sweeps.local import work_locally
from benchmark.sweeps.point import OK, PointResult, Task

pytestmark = pytest.mark.slow

LIMIT = 900.0
"""Seconds before a test gives up: no machine that does its work is so slow. What has ended is noticed at once."""
NO_PAGE = ("--no-dashboard", "--dashboard-address", "127.0.0.1:0")
"""Without the second a small web server listens on every address."""


def wait_until(condition: Callable[[], bool], process: subprocess.Popen) -> None:
    """Wait until something is so; an error where the process that should make it so has ended."""
    end = time.monotonic() + LIMIT
    while not condition():
        assert process.poll() is None, f"it ended with exit code {process.returncode}"
        assert time.monotonic() < end, f"nothing happened in {LIMIT:g} s"
        time.sleep(0.02)


class Cluster:
    """A scheduler and two workers that it knows, on this machine; every process is ended by its handle."""

    def __init__(self, folder: Path, stack: ExitStack):
        import distributed

        self._folder, self._stack = folder, stack
        self.scheduler = self._start("scheduler", "--port", "0", "--scheduler-file", str(folder / "cluster.json"))
        wait_until(lambda: self._address() is not None, self.scheduler)
        self.address = str(self._address())
        self.workers = [self._start("worker", self.address, "--nthreads", "1", "--no-nanny") for _ in range(2)]
        with distributed.Client(self.address, timeout=LIMIT) as client:
            client.wait_for_workers(2, timeout=LIMIT)

    def _start(self, what: str, *arguments: str) -> subprocess.Popen:
        command = [sys.executable, "-m", "dask", what, *arguments, "--host", "127.0.0.1", *NO_PAGE]
        log = self._stack.enter_context((self._folder / f"{what}.log").open("ab"))
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
        process = subprocess.Popen(command, stderr=log, stdout=log, env=environment)
        self._stack.callback(_end, process)
        return process

    def _address(self) -> str | None:
        """What the scheduler has written, None before it has."""
        try:
            return str(json.loads((self._folder / "cluster.json").read_text())["address"])
        except (OSError, ValueError):
            return None


def _end(process: subprocess.Popen) -> None:
    process.terminate()
    try:
        process.wait(15)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait(5)


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    pytest.importorskip("distributed")
    with ExitStack() as stack:
        yield Cluster(tmp_path, stack)


@pytest.fixture
def tasks(plan_of) -> list[Task]:
    plan = plan_of("tool.radius=3 mm:6 mm:16")
    return [Task(number, scenario) for number, scenario in enumerate(plan.scenarios, 1)]


def silent(_: str) -> None:
    pass


def results(row):
    return {name: value for name, value in row.values.items() if not name.endswith("seconds_s")}


def test_a_cluster_gives_what_this_machine_gives(cluster: Cluster, tasks) -> None:
    said: list[str] = []
    there = {row.point: row for row in work_on_cluster(tasks[:4], cluster.address, said.append)}
    here = {row.point: row for row in work_locally(tasks[:4], 1)}
    assert len(said) == 1
    assert sorted(there) == [1, 2, 3, 4]
    for point, row in here.items():
        assert results(there[point]) == pytest.approx(results(row), rel=1e-9)


def test_a_worker_of_other_code_that_comes_later_ends_the_work(tasks, monkeypatch) -> None:
    """Only the workers that were there at first were asked; its rows were taken."""
    distributed = pytest.importorskip("distributed")
    what, _, arguments = cluster_module.ASKED[1]
    other = (cluster_module.ASKED[0], (what, lambda: "another", arguments))
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as one, distributed.Client(one):  # fmt: skip
        work = on_cluster(abs, [-1, -2], lambda *_: 0, one.scheduler_address, lambda _: seen(monkeypatch, other))
        with pytest.raises(ClusterError, match=r"the worker .* answers 'another' when asked for the code of its"):
            list(work)
        monkeypatch.undo()
        assert sorted(on_cluster(abs, [-1, -2], lambda *_: 0, one.scheduler_address, silent)) == [1, 2]


def seen(monkeypatch, other) -> None:
    """From now on, after the workers at first were asked, they answer otherwise."""
    monkeypatch.setattr(cluster_module, "ASKED", other)


def test_a_killed_worker_loses_nothing(cluster: Cluster, tasks) -> None:
    work = work_on_cluster(tasks, cluster.address, silent)
    rows = [next(work) for _ in range(3)]
    cluster.workers[0].kill()
    rows += list(work)
    assert sorted(row.point for row in rows) == list(range(1, 17))
    assert all(row.status == OK for row in rows)


def test_a_killed_scheduler_stops_the_sweep_and_another_one_goes_on(
    cluster: Cluster, tasks, benchmark_sweep, tmp_path: Path
) -> None:
    out = tmp_path / "sweep"
    sweep = benchmark_sweep(out, cluster.address)
    wait_until(lambda: rows_in(out) >= 4, sweep)
    cluster.scheduler.kill()
    _, said = sweep.communicate(timeout=LIMIT)
    before = rows_in(out)
    assert sweep.returncode == 2, said
    assert "is gone" in said
    assert "Traceback" not in said
    assert 4 <= before < 40
    (tmp_path / "second").mkdir()
    with ExitStack() as stack:
        second = Cluster(tmp_path / "second", stack)
        _, said = benchmark_sweep(out, second.address).communicate(timeout=LIMIT)
    assert f"{before} of 40 points are there already" in said
    assert sorted(points_in(out)) == list(range(1, 41))


@pytest.fixture
def benchmark_sweep():
    """Start the command on a grid of 40 points."""
    with ExitStack() as stack:

        def start(out: Path, address: str) -> subprocess.Popen:
            settings = ("--set", "fem.mesh=coarse", "--set", "load.observations=4", "--set", "load.peak=0.5 N")
            vary = ("--vary", "tool.radius=3 mm:6 mm:40")
            command = [sys.executable, "-m", "benchmark", "sweep", "skin-5N", *settings, *vary]
            command += ["--out", str(out), "--scheduler", address]
            process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            stack.callback(_end, process)
            return process

        yield start


def rows_in(out: Path) -> int:
    return len(points_in(out))


def points_in(out: Path) -> list[int]:
    """Numbers of the points in the journal, a point that was computed twice twice."""
    return [row.point for row in read_rows(out / "journal.jsonl", PointResult)]


def test_where_nobody_answers_the_address_is_named(tasks) -> None:
    with pytest.raises(ClusterError, match=r"127\.0\.0\.1:9: no Dask scheduler"):
        next(work_on_cluster(tasks, "tcp://127.0.0.1:9", silent))


def test_without_a_certificate_tls_is_refused_with_where_it_belongs(tasks) -> None:
    with pytest.raises(ClusterError, match=r"tls://127\.0\.0\.1:9: no Dask .* certificate in DASK_.*TLS__CA_FILE"):
        next(work_on_cluster(tasks, "tls://127.0.0.1:9", silent))
