"""A trial CSV that is right, to be spoilt in one place at a time."""

from collections.abc import Callable
from pathlib import Path

import pytest

Write = Callable[..., Path]


@pytest.fixture
def good_lines() -> list[str]:
    return ["time_s,depth_mm,force_N,gap_mm", *(f"{i / 10},{i / 4},{i / 8},{12 - i / 4}" for i in range(24))]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def write_lines(lines: list[str], end: str = "\n", encoding: str = "utf-8") -> Path:
        path = tmp_path / "trial.csv"
        path.write_bytes((end.join(lines) + end).encode(encoding))
        return path

    return write_lines
