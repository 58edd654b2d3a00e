"""`python -m bench_hw`, and the command `tissuebench-bench`."""

import os
import sys

from bench_hw.starting import end, leave_current_folder, open_streams, speak_utf8, tell


def start() -> None:
    """Run the command line with modules from the installation alone; see `bench_hw.starting`."""
    open_streams()
    speak_utf8()
    tell(leave_current_folder(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), sys.argv)
    from bench_hw.cli import main

    sys.exit(end(main()))


if __name__ == "__main__":
    start()
