"""`python -m benchmark`, and the command `tissuebench`."""

import os
import sys


def start() -> int:
    """Run the command line with modules from the installation alone; see `bench_hw.starting`."""
    try:
        return _start()
    except KeyboardInterrupt:  # while modules are imported, before the verbs or after them
        from bench_hw.starting import interrupted

        return interrupted()


def _start() -> int:
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    sys.path.insert(0, root)
    from bench_hw.starting import (
        end,
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
    tell(leave_current_folder(root), sys.argv)
    try:
        from benchmark.cli.app import main
    except ModuleNotFoundError as error:
        return not_installed(error)
    return end(main())


if __name__ == "__main__":
    sys.exit(start())
