"""`python -m bench_hw`, and the command `tissuebench-bench`."""

import os
import sys

from bench_hw.safe_path import leave_current_folder, speak_utf8, tell


def start() -> None:
    """Run the command line with modules from the installation alone; see `bench_hw.safe_path`."""
    speak_utf8()
    tell(leave_current_folder(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), sys.argv)
    from bench_hw.cli import main

    main()


if __name__ == "__main__":
    start()
