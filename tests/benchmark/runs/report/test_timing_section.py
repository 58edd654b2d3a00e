"""The timing table: cost of a load step and of a frame, and where there is none."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.runs.report.timing_section import timing_section
from benchmark.runs.report.values import speedup_words
from benchmark.side_by_side import ModelRun, Seconds, Speedup
from reports import Table

RESULT = SimpleNamespace(time=np.arange(100.0), unknowns=7)


def table_of(wave: ModelRun) -> dict[str, dict[str, object]]:
    """Rows of the section's table by model, cells by heading."""
    fem = ModelRun("fem", RESULT, None, (Seconds(0.1, 1.0, 0.9),))
    section = timing_section(SimpleNamespace(pair=SimpleNamespace(fem=fem, wave=wave, speedup=None)))
    table = next(block for block in section.blocks if isinstance(block, Table))
    names = [column if isinstance(column, str) else column.name for column in table.columns]
    return {str(row[0]): dict(zip(names, row, strict=True)) for row in table.rows}


def test_a_frame_is_a_load_step_and_its_picture() -> None:
    rows = table_of(ModelRun("wave", RESULT, None, (Seconds(0.2, 0.01, 0.01),), frame=50e-6))
    assert rows["wave model"]["wall per load step"] == pytest.approx(0.1)
    assert rows["wave model"]["wall per frame"] == pytest.approx(0.15)
    assert rows["FEM"]["wall per frame"] == rows["FEM"]["wall per load step"] == pytest.approx(10.0)


def test_a_users_model_has_no_frame() -> None:
    rows = table_of(ModelRun("wave", RESULT, None, (Seconds(0.2, 0.01, 0.01),), own="mine"))
    assert rows["mine"]["wall per frame"] is None
    assert rows["mine"]["wall per load step"] == pytest.approx(0.1)


@pytest.mark.parametrize(("ratio", "words"), [(1702.3, "1702"), (258.14, "258"), (4.203, "4.2")])
def test_a_speed_up_is_told_in_one_form_without_an_exponent(ratio: float, words: str) -> None:
    found = Speedup(ratio, (ratio, ratio), 0.75, 2.0, 1, 3)
    assert speedup_words(found) == f"{words} (range {words} to {words}, 3 interleaved pairs)"
