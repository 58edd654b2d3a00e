"""A user's FEA as a table: its values come through, and every mismatch with the scenario is named."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.models import read_reference, scenario_drive

SCENARIO = load_scenario("skin-5N", {"load.observations": "4", "load.peak": "2 N"})
LAYERS = SCENARIO.tissue.layer_names


def table(**changes: object) -> pd.DataFrame:
    drive = scenario_drive(SCENARIO)
    rows = [
        {"step": step + 1, "time_s": drive.time[step], "force_N": drive.value[step], "layer": layer,
         "fem_mm": drive.value[step] / (column + 1)}
        for step in range(4) for column, layer in enumerate(LAYERS)
    ]  # fmt: skip
    return pd.DataFrame(rows).assign(**changes)


def written(frame: pd.DataFrame, tmp_path: Path) -> Path:
    path = tmp_path / "bench.csv"
    frame.to_csv(path, index=False)
    return path


def test_values_come_through_in_si(tmp_path: Path) -> None:
    found = read_reference(written(table(), tmp_path), SCENARIO)
    assert found.name == "FEA of bench.csv"
    expected = 1e-3 * np.outer(scenario_drive(SCENARIO).value, [1, 1 / 2, 1 / 3])
    np.testing.assert_allclose(found.result.top_deflection, expected)
    np.testing.assert_allclose(found.result.force, scenario_drive(SCENARIO).value)
    assert np.isnan(found.result.profile).all()
    assert any("profile" in warning and "timing" in warning for warning in found.result.warnings)


def test_slips_of_sign_and_unit_are_pointed_out(tmp_path: Path) -> None:
    """Of a model file they were, of a table not."""
    for factor, said in (
        (-1.0, "out of the tissue"),
        (1e3, "more than the thickness of the tissue, 11.6 mm; fem_mm is"),
    ):
        frame = table()
        found = read_reference(written(frame.assign(fem_mm=factor * frame.fem_mm), tmp_path), SCENARIO)
        assert any(said in warning for warning in found.result.warnings)
    assert len(read_reference(written(table(), tmp_path), SCENARIO).result.warnings) == 1


@pytest.mark.parametrize(("size", "said"), [(1.0, 0), (1e-3, 1)])
def test_a_table_in_metres_is_pointed_out_by_the_depth_of_the_press(tmp_path: Path, size: float, said: int) -> None:
    """No other model is needed to see it."""
    scenario = load_scenario("skin-5N", {"load.control": "depth", "load.peak": "2 mm", "load.observations": "4"})
    frame = table().assign(fem_mm=size * table().fem_mm)
    warnings = read_reference(written(frame.drop(columns="step"), tmp_path), scenario).result.warnings
    place = f"{tmp_path / 'bench.csv'}, column fem_mm: the largest deflection of epidermis is 0.002 mm"
    assert sum(warning.startswith(place) and "presses it 2 mm deep" in warning for warning in warnings) == said


def test_order_of_rows_and_more_columns_do_not_matter(tmp_path: Path) -> None:
    shuffled = table(wave_mm=[None] * 12, remark="mine").sample(frac=1.0, random_state=1)
    found = read_reference(written(shuffled, tmp_path), SCENARIO)
    plain = read_reference(written(table(), tmp_path), SCENARIO)
    np.testing.assert_array_equal(found.result.top_deflection, plain.result.top_deflection)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.floats(-50, 50), min_size=12, max_size=12))
def test_any_numbers_read_back(tmp_path_factory, values: list[float]) -> None:
    path = written(table(fem_mm=values), tmp_path_factory.mktemp("reference"))
    found = 1e3 * read_reference(path, SCENARIO).result.top_deflection
    np.testing.assert_allclose(found.ravel(), values, rtol=1e-12, atol=1e-300)


def as_a_spreadsheet_writes(frame: pd.DataFrame, path: Path, sign: str, decimal: str, encoding: str = "utf-8") -> Path:
    path.write_text(frame.to_csv(index=False, sep=sign, decimal=decimal), encoding=encoding)
    return path


@pytest.mark.parametrize(
    ("sign", "decimal", "encoding"),
    [(";", ",", "utf-8"), (";", ",", "utf-8-sig"), (";", ".", "utf-8"), ("\t", ",", "utf-16"), ("\t", ".", "utf-8")],
)
def test_tables_of_other_countries_spreadsheets_are_read(tmp_path: Path, sign, decimal, encoding) -> None:
    plain = read_reference(written(table(), tmp_path), SCENARIO).result
    path = as_a_spreadsheet_writes(table(), tmp_path / "excel.csv", sign, decimal, encoding)
    np.testing.assert_array_equal(read_reference(path, SCENARIO).result.top_deflection, plain.top_deflection)


def test_the_line_in_which_a_spreadsheet_tells_its_sign_is_passed_over(tmp_path: Path) -> None:
    path = as_a_spreadsheet_writes(table(fem_mm=["1"] * 11 + ["x"]), tmp_path / "excel.csv", ";", ",")
    path.write_text("sep=;\n" + path.read_text())
    with pytest.raises(InputError, match=r"excel\.csv \(row 14, column 'fem_mm', value 'x'\)"):
        read_reference(path, SCENARIO)
    path.write_text(path.read_text().replace(";x\n", ";1,5\n"))
    assert read_reference(path, SCENARIO).result.top_deflection[-1, -1] == pytest.approx(1.5e-3)


def test_the_peak_alone_of_a_spreadsheet_is_read(tmp_path: Path) -> None:
    frame = pd.DataFrame({"layer": LAYERS, "fem_mm": [1.5, 1.25, 0.5]})
    path = as_a_spreadsheet_writes(frame, tmp_path / "excel.csv", ";", ",")
    path.write_text(path.read_text() + ";\n;\n")
    np.testing.assert_allclose(read_reference(path, SCENARIO).result.max_deformation(), [1.5e-3, 1.25e-3, 0.5e-3])


def test_a_spreadsheet_with_both_decimal_signs_is_refused(tmp_path: Path) -> None:
    """One of them would be taken for a mark between thousands."""
    path = as_a_spreadsheet_writes(table(), tmp_path / "excel.csv", ";", ",")
    path.write_text(path.read_text().replace("2,5;", "2.5;", 1))
    with pytest.raises(
        InputError, match=r"row \d+, value '\d,\d+'\): the comma in numbers, where line 2 has a point in '2.5'"
    ):
        read_reference(path, SCENARIO)


def test_a_row_of_a_spreadsheet_that_is_cut_is_refused_by_its_line(tmp_path: Path) -> None:
    path = as_a_spreadsheet_writes(table(), tmp_path / "excel.csv", ";", ",")
    lines = path.read_text().splitlines()
    path.write_text("\n".join([*lines[:5], lines[5].rpartition(";")[0], *lines[6:]]))
    with pytest.raises(InputError, match=r"row 6.*the row has 4 cells.*5 cells"):
        read_reference(path, SCENARIO)


@pytest.mark.parametrize("ending", [".txt", ".log", ".dat", ".frd", ".TXT"])
def test_a_table_is_known_by_its_header_not_by_its_ending(tmp_path: Path, ending: str) -> None:
    """A .txt was taken for a log of FEBio."""
    path = written(table(), tmp_path).rename(tmp_path / f"mine{ending}")
    assert np.isfinite(read_reference(path, SCENARIO).result.top_deflection).all()


@pytest.mark.parametrize(("factor", "unit"), [(1e-3, "m"), (1e3, "um")])
def test_a_profile_of_another_size_than_the_tools_is_refused(tmp_path: Path, factor: float, unit: str) -> None:
    """Radii in metres under radius_mm gave a profile that ended within the tool, without a word."""
    radii = np.array([1.0, 5.0, 20.0])
    edge = pd.concat([pd.DataFrame({"radius_mm": radii, "layer": layer, "fem_mm": 0.1}) for layer in LAYERS])
    whole = pd.concat([table(radius_mm=0.0), edge])
    assert np.isfinite(read_reference(written(whole, tmp_path), SCENARIO).result.profile[:, 10]).all()
    with pytest.raises(
        InputError, match=rf"column radius_mm: the profile ends at .* radius of 5 mm.*Is it in {unit}\?"
    ):
        read_reference(written(whole.assign(radius_mm=factor * whole.radius_mm), tmp_path), SCENARIO)


BAD = {
    "a column is missing": (table().drop(columns="fem_mm"), ["fem_mm", "missing"]),
    "text in a number": (table(fem_mm=["x"] * 12), ["fem_mm", "'x'"]),
    "an empty cell": (table(fem_mm=[None] * 12), ["fem_mm", "empty"]),
    "no rows": (table().iloc[:0], ["no rows"]),
    "other layers": (table(layer=["skin", "dermis", "fat"] * 4), ["skin", "epidermis"]),
    "a layer too few": (table().query("layer != 'dermis'"), ["epidermis, subcutaneous_fat", "dermis"]),
    "a step too few": (table().query("step < 4"), ["step 4 of epidermis is missing", "1 to 4"]),
    "a row too few": (table().drop(index=4), ["step 2 of dermis is missing"]),
    "a row twice": (pd.concat([table(), table().iloc[:1]]), ["line 14", "twice"]),
    "a step that is none": (table(step=[1.5] * 12), ["line 2", "1.5", "1 to 4"]),
    "a step too many": (table(step=np.repeat([1, 2, 3, 5], 3)), ["line 11", "5"]),
    "other times": (table(time_s=np.repeat([1, 2, 3, 4], 3)), ["line 2", "time_s", "1 s", "2.5 s"]),
    "other forces": (table(force_N=np.repeat([1, 2, 1, 0.5], 3)), ["line 11", "force_N", "0.5 N", "0 N"]),
}


@pytest.mark.parametrize("case", BAD)
def test_a_table_that_does_not_fit_is_refused(tmp_path: Path, case: str) -> None:
    frame, words = BAD[case]
    with pytest.raises(InputError) as caught:
        read_reference(written(frame, tmp_path), SCENARIO)
    for word in ["bench.csv", *words]:
        assert word in str(caught.value)


def test_forces_of_a_depth_history_are_the_tables_own(tmp_path: Path) -> None:
    scenario = load_scenario("skin-5N", {"load.observations": "4", "load.control": "depth", "load.peak": "2 mm"})
    found = read_reference(written(table(force_N=np.repeat([3, 6, 2, 0], 3)), tmp_path), scenario)
    np.testing.assert_allclose(found.result.force, [3, 6, 2, 0])
    np.testing.assert_allclose(found.result.depth, scenario_drive(scenario).value)
