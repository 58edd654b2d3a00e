"""`python -m benchmark`, and the command `tissuebench`."""

import os
import signal
import sys
import time
from types import FrameType

ONE = 1.0
"""Seconds within which SIGTERM is one wish: `timeout` sends it to the program and at once to its group, too."""


def start() -> int:
    """Run the command line with modules from the installation alone; see `bench_hw.starting`."""
    try:
        return _start()
    except KeyboardInterrupt:  # while modules are imported, before the verbs or after them
        from bench_hw.starting import interrupted

        return interrupted()


def _start() -> int:
    if signal.getsignal(signal.SIGTERM) is signal.SIG_DFL:
        signal.signal(signal.SIGTERM, _terminated)
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    sys.path.insert(0, root)
    from bench_hw.starting import (
        end,
        keep_caches,
        keep_interruptions,
        leave_current_folder,
        not_installed,
        open_streams,
        speak_utf8,
        tell,
    )

    sys.path.remove(root)
    keep_interruptions()
    open_streams()
    speak_utf8()
    keep_caches()
    tell(leave_current_folder(root), sys.argv)
    try:
        from benchmark.cli.app import main
    except ModuleNotFoundError as error:
        return not_installed(error)
    return end(main())


def _terminated(_: int, __: FrameType | None) -> None:
    """End as by Ctrl-C where SIGTERM comes, the processes at work first; a later one ends the program at once.

    Ended on the spot, a pool's semaphores stay behind, and Python warns of a leak.
    """
    began = time.monotonic()

    def again(number: int, _: FrameType | None) -> None:
        if time.monotonic() - began > ONE:
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)

    signal.signal(signal.SIGTERM, again)
    if "multiprocessing" in sys.modules:
        for child in sys.modules["multiprocessing"].active_children():
            child.terminate()
    raise KeyboardInterrupt


if __name__ == "__main__":
    sys.exit(start())
