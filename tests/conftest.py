"""What all tests share: drawn examples are the same on every run and never timed, and nothing is kept for later.

`undrawn` is for tests that read the words or tables beside figures: each figure is still painted, with all that may
fail there, and only its layout and its SVG are left out, which have tests of their own in tests/reports.

`pytest --hypothesis-profile=search` draws new examples on each run; `--hypothesis-seed` draws those of one run again.
"""

import os
import signal
from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile(
    "same_each_run", deadline=None, derandomize=True, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("search", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("same_each_run")
os.environ["TISSUEBENCH_CACHE"] = ""

BLANK = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1"/>'


@pytest.fixture(autouse=True, scope="session")
def ctrl_c_is_heard() -> None:
    """A shell's background jobs ignore Ctrl-C, and so would all that a test starts."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True, scope="session")
def no_waiting_for_the_disk() -> Iterator[None]:
    """Files are written, closed and renamed as ever, and read again from memory: no test cuts the power."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", os.fstat)  # which wants an open file, too
        yield


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures of pages are painted, and blank."""
    place = "matplotlib.backends.backend_svg.FigureCanvasSVG.print_svg"
    monkeypatch.setattr(place, lambda _, stream, **__: stream.write(BLANK))
