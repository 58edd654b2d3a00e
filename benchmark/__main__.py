"""`python -m benchmark`, and the command `tissuebench`."""

import os
import sys


def start() -> int:
    """Run the command line with modules from the installation alone; see `bench_hw.safe_path` and `streams`."""
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    sys.path.insert(0, root)
    from bench_hw.safe_path import leave_current_folder, speak_utf8, tell
    from bench_hw.streams import end, open_streams

    sys.path.remove(root)
    open_streams()
    speak_utf8()
    tell(leave_current_folder(root), sys.argv)
    from benchmark.cli.app import main

    return end(main())


if __name__ == "__main__":
    sys.exit(start())
