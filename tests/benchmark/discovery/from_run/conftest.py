"""A finished run made by hand: a linear wave, and a reference that stiffens."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from benchmark.files import load_scenario

COMPLIANCE = np.array([1.0e-3, 0.98e-3, 0.8e-3])
THICKNESS = 11.6e-3


@pytest.fixture
def make_run(tmp_path: Path) -> Callable[..., Path]:
    """Return the function that writes a run whose reference follows F = K d (1 + growth x^2), x = d / thickness."""

    def make(growth: float = 4.0, name: str = "run", peak: float = 5.0) -> Path:
        scenario = load_scenario("skin-5N", {"load.peak": f"{peak} N"})
        history = scenario.load_history()
        depth = np.linspace(0.0, 2e-3 * peak, 4001)
        law = depth / COMPLIANCE[0] * (1.0 + growth * (depth / THICKNESS) ** 2)
        pressed = np.interp(history.value, law, depth)
        layers = scenario.tissue.layer_names
        fem = np.outer(pressed, COMPLIANCE / COMPLIANCE[0])
        wave = np.outer(history.value, COMPLIANCE)
        steps = history.time.size
        table = pd.DataFrame(
            {
                "step": np.repeat(np.arange(1, steps + 1), 3),
                "time_s": np.repeat(history.time, 3),
                "force_N": np.repeat(history.value, 3),
                "layer": list(layers) * steps,
                "fem_mm": 1e3 * fem.ravel(),
                "wave_mm": 1e3 * wave.ravel(),
            }
        )
        folder = tmp_path / name
        (folder / "tables").mkdir(parents=True)
        table.to_csv(folder / "tables/max_deformation.csv", index=False)
        (folder / "scenario.toml").write_text(scenario.to_toml())
        (folder / "results.json").write_text(json.dumps({"schema": 1, "name": name}))
        return folder

    return make
