"""Processes end when who started them is killed, and have one thread."""

import multiprocessing
import os
import signal
import subprocess
import sys

import psutil
import pytest

from benchmark.child_processes import THREAD_VARIABLES, mapping, single_threaded_children, start_child

PARENT = """
import sys, time
from concurrent.futures import ProcessPoolExecutor
from benchmark.child_processes import PoolContext, begin_in_pool
if __name__ == "__main__":
    with ProcessPoolExecutor(1, PoolContext(), initializer=begin_in_pool) as pool:
        pool.submit(int, 3).result()
        print("ready", flush=True)
        time.sleep(60)
"""


def test_what_is_written_past_python_goes_to_stderr():
    """Of C's own buffer, too, which `PYTHONUNBUFFERED` would take away."""
    script = (
        "import ctypes, os\nfrom benchmark.child_processes import output_on_stderr\nprint('before', flush=True)\n"
        "with output_on_stderr():\n    os.write(1, b'bytes ')\n    os.system('echo program')\n"
        "    ctypes.CDLL(None).puts(b'library')\nprint('after')\n"
    )
    plain = {key: value for key, value in os.environ.items() if key != "PYTHONUNBUFFERED"}
    ran = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, env=plain)
    assert ran.stdout == "before\nafter\n"
    assert set(ran.stderr.split()) == {"bytes", "program", "library"}


def test_children_end_with_a_killed_parent(tmp_path):
    script = tmp_path / "parent.py"
    script.write_text(PARENT)
    parent = subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    assert parent.stdout.readline() == "ready\n"
    children = psutil.Process(parent.pid).children(recursive=True)
    assert children
    parent.kill()
    parent.wait(timeout=10)
    _, alive = psutil.wait_procs(children, timeout=20)
    assert not [child for child in alive if child.status() != psutil.STATUS_ZOMBIE]
    parent.stdout.close()


def test_children_get_one_thread_and_the_parent_keeps_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("MKL_NUM_THREADS", raising=False)
    with single_threaded_children():
        assert {os.environ[name] for name in THREAD_VARIABLES} == {"1"}
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "MKL_NUM_THREADS" not in os.environ


def _where(thing: int) -> tuple[int, int, str]:
    return thing, os.getpid(), os.environ.get("OMP_NUM_THREADS", "")


def test_processes_map_in_order_and_one_does_it_itself() -> None:
    with mapping(1) as mapped:
        assert mapped is map
    with mapping(2) as mapped:
        found = list(mapped(_where, range(5)))
    assert [thing for thing, _, _ in found] == list(range(5))
    assert {(process != os.getpid(), threads) for _, process, threads in found} == {(True, "1")}


IN_A_POOL = """
import os, signal
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from benchmark.child_processes import PoolContext, begin_in_pool
class Early:  # an interruption while the process still imports what it is to do
    def __reduce__(self):
        return os.kill, (0, signal.SIGINT)
def begin(_):
    begin_in_pool()
if __name__ == "__main__":
    signal.signal(signal.SIGINT, lambda *_: None)
    os.setpgid(0, 0)
    for early in (False, True):
        rest = (begin, (Early(),)) if early else (begin_in_pool, ())
        with ProcessPoolExecutor(1, PoolContext(), initializer=rest[0], initargs=rest[1]) as pool:
            try:
                pool.submit(os.kill, 0, signal.SIGINT).result()
            except BrokenProcessPool:
                print("ended")
"""


def test_processes_of_a_pool_end_by_an_interruption_without_a_word(tmp_path) -> None:
    script = tmp_path / "parent.py"
    script.write_text(IN_A_POOL)
    ran = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=60)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "ended\nended\n", "")


FIRST = """
import multiprocessing, os, signal, sys
from benchmark.child_processes import start_child
if __name__ == "__main__":
    child = multiprocessing.get_context("spawn").Process(target=os.kill, args=(0, signal.SIGINT))
    signal.signal(signal.SIGINT, lambda *_: None)
    os.setpgid(0, 0)
    start_child(child)
    child.join()
    sys.exit(child.exitcode)
"""


def test_the_first_child_of_a_program_is_deaf_too() -> None:
    ran = subprocess.run([sys.executable, "-c", FIRST], capture_output=True, text=True, timeout=60)
    assert (ran.returncode, ran.stderr) == (0, "")


def _blocked(answers: "multiprocessing.SimpleQueue[bool]") -> None:
    os.kill(os.getpid(), signal.SIGINT)
    answers.put(signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, ()))


def test_a_child_is_deaf_to_an_interruption_and_its_parent_is_not() -> None:
    context = multiprocessing.get_context("spawn")
    answers = context.SimpleQueue()
    child = context.Process(target=_blocked, args=(answers,))
    start_child(child)
    child.join(60)
    assert child.exitcode == 0
    assert answers.get()
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)


POOL_AT_WORK = """
import os, signal, time
from benchmark.__main__ import _terminated
from benchmark.child_processes import mapping
signal.signal(signal.SIGTERM, _terminated)
try:
    with mapping(2) as mapped:
        mapped(time.sleep, [600.0] * 4)
        os.kill(os.getpid(), signal.SIGTERM)
except KeyboardInterrupt:
    print("interrupted")
"""


def test_sigterm_ends_a_pool_at_work_without_a_warning_of_leaks() -> None:
    """Python warned of leaked semaphore objects between our words."""
    ran = subprocess.run([sys.executable, "-c", POOL_AT_WORK], capture_output=True, text=True, timeout=120)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "interrupted\n", "")


TWICE = """
import os, signal, time
from benchmark.__main__ import _terminated
signal.signal(signal.SIGTERM, _terminated)
try:
    os.kill(os.getpid(), signal.SIGTERM)
except KeyboardInterrupt:
    time.sleep({pause})
    os.kill(os.getpid(), signal.SIGTERM)
    print("interrupted")
"""


@pytest.mark.parametrize(("pause", "code", "said"), [(0.01, 0, "interrupted\n"), (1.1, -signal.SIGTERM, "")])
def test_sigterm_that_comes_twice_at_once_is_one(pause, code, said) -> None:
    """`timeout` sends it to the program and to its group: the program ended by the second, and not with 130."""
    ran = subprocess.run([sys.executable, "-c", TWICE.format(pause=pause)], capture_output=True, text=True, timeout=60)
    assert (ran.returncode, ran.stdout, ran.stderr) == (code, said, "")


OVERFLOW = """
import multiprocessing, numpy as np
from benchmark.child_processes import start_child
from benchmark.cli.app import main
main(["--version", *{debug}])
child = multiprocessing.get_context("spawn").Process(target=np.exp, args=(np.array(1e4),))
start_child(child)
child.join()
"""


@pytest.mark.parametrize("debug", [[], ["--debug"]])
def test_what_numpy_says_of_an_overflow_in_a_process_is_kept_for_debugging(debug) -> None:
    """The model's own process said it on standard error, under --quiet, too."""
    program = OVERFLOW.format(debug=debug)
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert ran.returncode == 0
    assert ("overflow encountered in exp" in ran.stderr) == bool(debug)
