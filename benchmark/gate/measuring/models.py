"""The model that a job names: the product's own FEM or wave, or a user's file in the wave's place."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from benchmark.files import Scenario
from benchmark.models import PreparedModel, prepare


def model_of(job: Mapping[str, Any], scenario: Scenario) -> PreparedModel:
    """Set up the job's `model` ("fem" or "wave") for a scenario; `own` is a user's file or None."""
    if job["own"] is None:
        return prepare(job["model"], scenario)
    from benchmark.models import read_user_file

    return prepare(job["model"], scenario, own=read_user_file(Path(job["own"])))
