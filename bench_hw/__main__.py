"""`python -m bench_hw`, and the command `tissuebench-bench`."""

import os
import sys

from bench_hw.starting import (
    end,
    interrupted,
    keep_caches,
    keep_interruptions,
    leave_current_folder,
    not_installed,
    open_streams,
    speak_utf8,
    tell,
)


def start() -> int:
    """Run the command line with modules from the installation alone; see `bench_hw.starting`."""
    try:
        keep_interruptions()
        open_streams()
        speak_utf8()
        keep_caches()
        tell(leave_current_folder(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), sys.argv)
        try:
            from bench_hw.cli import main
        except ModuleNotFoundError as error:
            return not_installed(error)
        return end(main())
    except KeyboardInterrupt:  # while modules are imported, before the verbs or after them
        return interrupted()


if __name__ == "__main__":
    sys.exit(start())
