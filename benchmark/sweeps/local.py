"""Points on this machine: a few processes with one thread each, every one with a pipe of its own.

A process that dies takes one point with it, which goes to another process; a point that loses two is failed. The
processes end with their parent, however that ends.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Iterator, Sequence
from multiprocessing.connection import Connection, wait

from benchmark.child_processes import end_with_parent, start_child
from benchmark.sweeps.point import PointResult, Task, evaluate, failed

LIVES = 2


def usable_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def work_locally(tasks: Sequence[Task], workers: int) -> Iterator[PointResult]:
    """Compute points in `workers` processes and yield each as it finishes."""
    waiting = deque(tasks)
    losses: dict[int, int] = {}
    crew: dict[Connection, _Worker] = {}
    try:
        while waiting or crew:
            while waiting and len(crew) < workers:
                worker = _Worker(waiting.popleft())
                crew[worker.connection] = worker
            for connection in wait(list(crew)):
                worker = crew[connection]  # type: ignore[index]
                row = worker.receive()
                if row is not None and waiting:
                    worker.give(waiting.popleft())
                else:
                    worker.end()
                    del crew[connection]  # type: ignore[arg-type]
                if row is None:
                    row = _after_loss(worker, waiting, losses)
                if row is not None:
                    yield row
    finally:
        for worker in crew.values():
            worker.end()


def _after_loss(worker: _Worker, waiting: deque[Task], losses: dict[int, int]) -> PointResult | None:
    """Put the point of a dead process back, or give it up."""
    task = worker.task
    losses[task.point] = losses.get(task.point, 0) + 1
    if losses[task.point] < LIVES:
        waiting.appendleft(task)
        return None
    reason = f"its process died {LIVES} times (exit code {worker.exit_code}); -9 on Linux usually means no memory left"
    return failed(task.point, reason)


class _Worker:
    """A process with a point to compute."""

    def __init__(self, task: Task):
        context = multiprocessing.get_context("spawn")
        self.connection, far_end = context.Pipe()
        self._process = context.Process(target=_serve, args=(far_end,), daemon=True, name="tissuebench-sweep")
        start_child(self._process)
        far_end.close()
        self.give(task)

    @property
    def exit_code(self) -> int | None:
        """Of the dead process."""
        return self._process.exitcode

    def give(self, task: Task) -> None:
        """Hand over the next point."""
        self.task = task
        try:
            self.connection.send(task)
        except (BrokenPipeError, ConnectionResetError):
            return  # it died in between; `receive` will find out

    def receive(self) -> PointResult | None:
        """The finished point; None where the process died."""
        try:
            row: PointResult = self.connection.recv()
        except (EOFError, ConnectionResetError):
            return None
        return row

    def end(self) -> None:
        """End the process, whatever it is doing."""
        self._process.terminate()
        self._process.join(5)
        self.connection.close()


def _serve(connection: Connection) -> None:
    """Compute points until the pipe or the parent ends; an interruption is the parent's business."""
    end_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        while True:
            connection.send(evaluate(connection.recv()))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return
