"""A gate so small that a process answers at once: a user's own model, and no finite elements."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from benchmark.gate.accuracy import AccuracyRow
from benchmark.gate.baseline import Baseline, Machine, StoredTiming, StoredValue
from benchmark.gate.timing import TimingRow
from benchmark.gate.verdict import CheckVerdict

MODEL = """\
import numpy as np

NAME = "springs"


def deform(layers, tool, support, time, force):
    return np.outer(force, [1e-3, 0.8e-3])
"""

SCENARIO = """\
schema = 1
name = "press"
[tissue]
schema = 1
name = "two layers"
[[tissue.layers]]
name = "skin"
thickness = "1.5 mm"
density = "1100 kg/m^3"
youngs_modulus = "120 kPa"
poisson_ratio = 0.48
[[tissue.layers]]
name = "fat"
thickness = "10 mm"
density = "971 kg/m^3"
youngs_modulus = "20 kPa"
poisson_ratio = 0.48
[tool]
radius = "5 mm"
[load]
peak = "5 N"
observations = 10
"""

GATE = """\
schema = 1
name = "tiny"
[timing]
rounds = [1, 1]
blocks = 2
[[tolerances]]
quantity = "*"
rtol = "0.1 %"
atol = "1 nm"
[[cases]]
name = "springs"
model = "wave"
scenario = "press.toml"
own = "my_model.py"
"""

TIMED = """\
[[timed]]
name = "springs.history"
workload = "history"
scenario = "press.toml"
own = "my_model.py"
references = ["dense"]
"""


@dataclass(frozen=True)
class TinyGate:
    """Files of a gate in a folder of their own."""

    folder: Path

    @property
    def path(self) -> Path:
        return self.folder / "gate.toml"

    @property
    def model(self) -> Path:
        return self.folder / "my_model.py"

    def change(self, file: str, old: str, new: str) -> None:
        path = self.folder / file
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new))


@pytest.fixture
def tiny_gate(tmp_path: Path) -> Callable[..., TinyGate]:
    def make(*, timed: bool = False) -> TinyGate:
        folder = tmp_path / "gate"
        folder.mkdir()
        files = {"gate.toml": GATE + (TIMED if timed else ""), "press.toml": SCENARIO, "my_model.py": MODEL}
        for name, text in files.items():
            (folder / name).write_text(text)
        return TinyGate(folder)

    return make


@pytest.fixture
def baseline() -> Baseline:
    return Baseline(
        gate="tiny",
        fingerprint="f" * 64,
        made="2026-01-02T03:04:05+00:00",
        revision="abc",
        machine=Machine(processor="any", python="3.11.7", packages={"numpy": "2.4.6"}),
        accuracy={"press.max_deformation_mm.skin": StoredValue(value=5.0, unit="mm")},
        timing={"frame": StoredTiming(ratios=[2.0, 2.1])},
    )


@pytest.fixture
def verdict() -> Callable[..., CheckVerdict]:
    def make(*, slow: bool = False, off: bool = False) -> CheckVerdict:
        now = 2.6 if slow else 2.0
        return CheckVerdict(
            gate="tiny",
            accuracy=[AccuracyRow("skin_mm", "mm", 5.0, 5.05 if off else 5.0, 0.005, not off)],
            timing=[TimingRow("frame", 2.0, now, 2.24, (0.99 * now, 1.01 * now), 0.13, 0.01, not slow)],
            accuracy_source="the baseline b.json",
            timing_source="the baseline b.json",
            rounds=4,
            against=None,
            warnings=(),
        )

    return make
