"""A small scenario, and a user's files written for a test."""

from collections.abc import Callable
from pathlib import Path

import pytest

from benchmark.files import Scenario, load_scenario
from benchmark.models import UserFile, read_user_file

SMALL = {"fem.mesh": "coarse", "load.observations": "6", "load.peak": "0.5 N"}


@pytest.fixture
def scenario() -> Scenario:
    return load_scenario("skin-5N", SMALL)


@pytest.fixture
def user_file(tmp_path: Path) -> Callable[..., UserFile]:
    def write(text: str, name: str = "my_model.py") -> UserFile:
        path = tmp_path / name
        path.write_text(text)
        return read_user_file(path)

    return write
