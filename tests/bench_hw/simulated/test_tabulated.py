from dataclasses import replace

import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.simulated.tabulated import Scatter, SheetTable, TabulatedSpecimen, read_sheet, write_sheet

DEPTH, RADIUS = np.linspace(0.0, 5e-3, 11), np.linspace(0.0, 30e-3, 16)
TABLE = SheetTable(
    depth=DEPTH,
    force=200.0 * DEPTH,
    radius=RADIUS,
    outward=DEPTH[:, None] * RADIUS,
    sunk=DEPTH[:, None] * (1.0 - (RADIUS / 30e-3) ** 2),
    hole_radius=30e-3,
    tool_radius=5e-3,
    source="made up for this test, synthetic",
)
TIME = np.arange(3000) * 1e-3
PRESSED = np.clip(TIME, 0.0, 1.0) * 2e-3 - 0.2e-3


def test_force_is_the_tables_below_contact_and_nothing_above() -> None:
    force = TabulatedSpecimen(TABLE, gain=1.5)(TIME, PRESSED, 0).force
    np.testing.assert_allclose(force[:, 2], 300.0 * np.maximum(PRESSED, 0.0), atol=1e-12)
    assert not force[:, :2].any()


def test_relaxation_asked_for_piece_by_piece_is_that_of_the_whole_history() -> None:
    relaxing = ((0.3, 0.5), (0.1, 2.0))
    whole = TabulatedSpecimen(TABLE, relaxing)(TIME, PRESSED, 0).force
    specimen = TabulatedSpecimen(TABLE, relaxing)
    parts = [specimen(TIME[:end], PRESSED[:end], end - 250).force for end in range(250, 3001, 250)]
    np.testing.assert_allclose(np.concatenate(parts), whole, atol=1e-12)
    again = specimen(TIME[:1700], PRESSED[:1700], 1699)
    np.testing.assert_allclose(again.force, whole[1699:1700], atol=1e-12)
    assert whole[-1, 2] < 0.8 * whole[1000, 2]


def test_markers_move_with_the_face_around_the_tool_axis() -> None:
    specimen = TabulatedSpecimen(TABLE, axis=(1e-3, 0.5e-3))
    markers = specimen(TIME, PRESSED, 2999).markers[0]
    rest = specimen.grid.positions()
    arm = rest - [1e-3, 0.5e-3]
    np.testing.assert_allclose(markers[:, :2] - rest, 1.8e-3 * arm, atol=1e-9)
    radius = np.hypot(*arm.T)
    np.testing.assert_allclose(markers[:, 2], 1.8e-3 * (1.0 - (radius / 30e-3) ** 2), atol=1e-9)


def test_force_follows_the_curve_between_the_tables_depths() -> None:
    curved = replace(TABLE, force=200.0 * DEPTH + 4e4 * DEPTH**2)
    force = TabulatedSpecimen(curved)(TIME, PRESSED, 0).force[:, 2]
    pressed = np.maximum(PRESSED, 0.0)
    np.testing.assert_allclose(force, 200.0 * pressed + 4e4 * pressed**2, atol=1e-12)


def test_a_sheet_that_scatters_is_laid_anew_and_another_is_not() -> None:
    plain = TabulatedSpecimen(TABLE, gain=1.5)
    assert plain.laid_anew(np.random.default_rng(1)) == (plain, 0.0)
    rng, sheet = np.random.default_rng(1), replace(plain, scatter=Scatter(0.02, 5e-5, 3e-4))
    laid = [sheet.laid_anew(rng) for _ in range(400)]
    assert np.std([np.log(each.gain / 1.5) for each, _ in laid]) == pytest.approx(0.02, rel=0.1)
    assert np.std([off for _, off in laid]) == pytest.approx(5e-5, rel=0.1)
    assert np.std([each.axis for each, _ in laid], axis=0) == pytest.approx(3e-4, rel=0.1)
    assert np.mean([off for _, off in laid]) == pytest.approx(0.0, abs=1e-5)


def test_a_depth_beyond_the_table_is_refused() -> None:
    with pytest.raises(ValueError, match="ends at 5 mm"):
        TabulatedSpecimen(TABLE)(TIME, PRESSED + 4e-3, 0)


def test_a_table_is_written_and_read(tmp_path) -> None:
    found = read_sheet(write_sheet(tmp_path / "sheet.json", TABLE))
    np.testing.assert_array_equal(found.sunk, TABLE.sunk)
    assert found.source == TABLE.source


def test_the_shipped_sheet_says_that_it_is_synthetic() -> None:
    table = read_sheet("phantom")
    assert "synthetic" in table.source
    assert table.force[-1] > table.force[10] > 0.0


def test_what_is_no_table_is_refused(tmp_path) -> None:
    with pytest.raises(InputError, match="none of that name is shipped; allowed: a path, or phantom"):
        read_sheet("nobody")
    (tmp_path / "bad.json").write_text('{"depth": [1]}')
    with pytest.raises(InputError, match="no table of a sheet"):
        read_sheet(tmp_path / "bad.json")
