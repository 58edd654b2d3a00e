"""Short protocols, simulated rigs with changes, and captures of them. Everything recorded here is synthetic."""

from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from bench_hw.capture.order import CaptureOrder
from bench_hw.capture.progress import CaptureState
from bench_hw.capture.session import SessionOutcome, capture
from bench_hw.motion.protocol_file import LoadedProtocol, load_protocol
from bench_hw.rig.rig_file import simulated_rig

PRESS = """
schema = 1
name = "quick"
[[segments]]
kind = "rest"
duration = "0.1 s"
[[segments]]
kind = "approach"
touch_force = "0.05 N"
speed = "5 mm/s"
max_depth = "15 mm"
[[segments]]
kind = "move"
depth = "2 mm"
speed = "5 mm/s"
[[segments]]
kind = "hold"
duration = "0.2 s"
[[segments]]
kind = "retract"
depth = "-2 mm"
speed = "10 mm/s"
"""


@dataclass
class Watcher:
    """A progress that remembers what is said and can act at each turn."""

    act: Callable[[CaptureState], None] = lambda snapshot: None
    said: list[str] = field(default_factory=list)
    turns: int = 0

    def update(self, snapshot):
        self.turns += 1
        self.act(snapshot)

    def say(self, text):
        self.said.append(text)

    def showing(self):
        return nullcontext()


@pytest.fixture
def quick(tmp_path) -> LoadedProtocol:
    path = tmp_path / "quick.toml"
    path.write_text(PRESS)
    return load_protocol(path)


@pytest.fixture
def order(quick, tmp_path) -> Callable[..., CaptureOrder]:
    """An order for the simulated rig without a camera; `rig` changes sections, other keywords the order."""

    def make(rig=None, camera=False, **options) -> CaptureOrder:
        changes = dict(rig or {})
        if not camera:
            changes["camera"] = None
        return CaptureOrder(
            **{"protocol": quick, "out": tmp_path / "session", "fast": True, **options}, rig=simulated_rig(changes)
        )

    return make


@pytest.fixture
def record(order) -> Callable[..., SessionOutcome]:
    """Capture the order that these keywords make."""

    def run(progress=None, specimen=None, **options) -> SessionOutcome:
        return capture(order(**options), progress or Watcher(), specimen=specimen)

    return run


@pytest.fixture
def session(tmp_path) -> Path:
    return tmp_path / "session"


@pytest.fixture
def watcher() -> type[Watcher]:
    return Watcher
