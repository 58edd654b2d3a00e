"""An FEA's own output in the place of the scenario's steps: interpolated as far as it reaches, else refused."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.models import read_reference, scenario_drive
from benchmark.models.own_models import write_template

SCENARIO = load_scenario("skin-5N", {"load.observations": "40", "load.peak": "2 N"})
LAYERS = SCENARIO.tissue.layer_names
DRIVE = scenario_drive(SCENARIO)


def law(force, number):
    """Deflection in mm of a layer: it stiffens."""
    return (1.0 - np.exp(-np.asarray(force))) / (number + 1.0)


def by_time(count=201, **columns) -> pd.DataFrame:
    """An FEA that wrote its own `count` instants of the scenario's history."""
    time = np.linspace(0.0, DRIVE.time[-1], count)
    force = np.interp(time, np.concatenate([[0.0], DRIVE.time]), np.concatenate([[0.0], DRIVE.value]))
    frames = [
        pd.DataFrame({"time_s": time, "force_N": force, "layer": layer, "fem_mm": law(force, number)})
        for number, layer in enumerate(LAYERS)
    ]
    return pd.concat(frames).assign(**columns)


def read(frame: pd.DataFrame, folder: Path, scenario=SCENARIO):
    path = folder / "fea.csv"
    frame.to_csv(path, index=False)
    return read_reference(path, scenario).result


EXPECTED = 1e-3 * np.column_stack([law(DRIVE.value, number) for number in range(len(LAYERS))])


def test_other_instants_are_interpolated_to_the_steps(tmp_path: Path) -> None:
    found = read(by_time(), tmp_path)
    np.testing.assert_allclose(found.top_deflection, EXPECTED, atol=2e-6)
    np.testing.assert_allclose(found.force, DRIVE.value)
    assert found.notes["its steps"] == "201 rows a layer, interpolated over time_s"


def test_more_rows_come_closer(tmp_path: Path) -> None:
    errors = [np.abs(read(by_time(n), tmp_path).top_deflection - EXPECTED).max() for n in (23, 91, 363)]
    assert errors[0] > 4.0 * errors[1] > 16.0 * errors[2]


def test_a_curve_over_force_alone_will_do(tmp_path: Path) -> None:
    force = np.linspace(0.1, 2.0, 60)
    frames = [
        pd.DataFrame({"force_N": force, "layer": layer, "fem_mm": law(force, n)}) for n, layer in enumerate(LAYERS)
    ]
    found = read(pd.concat(frames), tmp_path)
    np.testing.assert_allclose(found.top_deflection, EXPECTED, atol=1e-6)
    assert "nothing that depends on time" in found.notes["its steps"]


def peak_alone(**columns) -> pd.DataFrame:
    return pd.DataFrame({"layer": LAYERS, "fem_mm": [law(2.0, number) for number in range(len(LAYERS))], **columns})


@pytest.mark.parametrize(
    "columns",
    [{}, {"force_N": 2.0}, {"force_N": 2.0, "time_s": 1.0}, {"step": 20}, {"step": 20, "time_s": 5.0, "force_N": 2.0}],
)
def test_one_row_a_layer_is_the_peak_load_and_nothing_else(columns, tmp_path: Path) -> None:
    found = read(peak_alone(**columns), tmp_path)
    peak = int(DRIVE.value.argmax())
    np.testing.assert_allclose(found.top_deflection[peak], EXPECTED[peak])
    assert np.isnan(np.delete(found.top_deflection, peak, axis=0)).all()
    np.testing.assert_allclose(found.max_deformation(), EXPECTED[peak])
    assert "the peak load alone" in found.notes["its steps"]


@pytest.mark.parametrize(
    ("columns", "word"),
    [
        ({"force_N": 1.0}, "force_N: 1, with one row"),
        ({"force_N": 0.0}, "force_N: 0, with one row"),
        ({"step": 3}, "step: 3"),
        ({"time_s": 2.5}, "time_s: 2.5"),
    ],
)
def test_one_row_of_another_load_is_refused(columns, word, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=word):
        read(peak_alone(**columns), tmp_path)


def test_the_peak_alone_under_depth_control_has_its_force(tmp_path: Path) -> None:
    scenario = load_scenario("skin-5N", {"load.observations": "10", "load.control": "depth", "load.peak": "2 mm"})
    peak = int(scenario_drive(scenario).value.argmax())
    found = read(peak_alone(depth_mm=2.0, force_N=1.5), tmp_path, scenario)
    assert found.force[peak] == 1.5
    assert np.isnan(np.delete(found.force, peak)).all()
    with pytest.raises(InputError, match="force_N is missing"):
        read(peak_alone(depth_mm=2.0), tmp_path, scenario)


def test_a_depth_history_takes_the_forces_from_the_table(tmp_path: Path) -> None:
    scenario = load_scenario("skin-5N", {"load.observations": "9", "load.control": "depth", "load.peak": "2 mm"})
    depth = np.linspace(0.0, 2.0, 80)
    frames = [
        pd.DataFrame({"depth_mm": depth, "force_N": depth**2, "layer": layer, "fem_mm": depth / (n + 1.0)})
        for n, layer in enumerate(LAYERS)
    ]
    found = read(pd.concat(frames), tmp_path, scenario)
    drive = scenario_drive(scenario)
    np.testing.assert_allclose(found.force, (1e3 * drive.value) ** 2, atol=2e-3)
    np.testing.assert_allclose(found.depth, drive.value)


def test_a_profile_at_peak_load_comes_with_its_radii(tmp_path: Path) -> None:
    radius, peak = np.linspace(0.5, 12.0, 40), law(2.0, 0)
    off = pd.DataFrame({"radius_mm": radius, "layer": LAYERS[0], "fem_mm": peak * np.exp(-((radius / 5.0) ** 2))})
    off = off.assign(time_s=DRIVE.time[-1], force_N=0.0)
    found = read(pd.concat([by_time(radius_mm=np.nan), off]), tmp_path)
    inside = found.profile_radii <= 12e-3
    expected = 1e-3 * peak * np.exp(-((found.profile_radii[inside] / 5e-3) ** 2))
    np.testing.assert_allclose(found.profile[0, inside], expected, atol=1e-5)
    assert np.isnan(found.profile[0, ~inside]).all()
    assert np.isnan(found.profile[1:]).all()


def test_rows_of_a_profile_may_leave_time_and_load_empty(tmp_path: Path) -> None:
    off = pd.DataFrame({"radius_mm": [1.0, 30.0], "layer": LAYERS[0], "fem_mm": [0.5, 0.0]})
    found = read(pd.concat([by_time(radius_mm=np.nan), off]), tmp_path)
    assert found.profile[0, found.profile_radii == 1e-3] == pytest.approx(5e-4)
    with pytest.raises(InputError, match=r"row 2, column 'time_s'.*empty"):
        read(by_time(time_s=np.nan), tmp_path)


@pytest.mark.parametrize("columns", [{"step": 10}, {"force_N": 1.0}])
def test_a_profile_of_another_step_is_refused(columns, tmp_path: Path) -> None:
    off = pd.DataFrame({"radius_mm": [1.0, 30.0], "layer": LAYERS[0], "fem_mm": [0.5, 0.0], **columns})
    steps = pd.concat([by_step(SCENARIO), off])
    with pytest.raises(InputError, match=r"line 122.*that is the profile at the peak load"):
        read(steps, tmp_path)


def by_step(scenario, **columns) -> pd.DataFrame:
    """A table of the scenario's own steps."""
    drive = scenario_drive(scenario)
    load = {"force_N": drive.value} if drive.control == "force" else {"depth_mm": 1e3 * drive.value, "force_N": 1.0}
    rest = {"step": np.arange(drive.time.size) + 1, "time_s": drive.time, **load, "fem_mm": drive.value}
    return pd.concat([pd.DataFrame({**rest, "layer": layer}) for layer in LAYERS], ignore_index=True).assign(**columns)


DEPTH = load_scenario("skin-5N", {"load.observations": "9", "load.control": "depth", "load.peak": "2 mm"})


def test_steps_of_other_depths_are_refused_under_depth_control(tmp_path: Path) -> None:
    assert read(by_step(DEPTH), tmp_path, DEPTH).force[0] == 1.0
    with pytest.raises(InputError, match=r"depth_mm: step 1 is at 9 mm, in the scenario at 0\.444444 mm"):
        read(by_step(DEPTH, depth_mm=9.0), tmp_path, DEPTH)


def test_layers_told_of_different_forces_in_a_step_are_refused(tmp_path: Path) -> None:
    table = by_step(DEPTH)
    table.loc[table["layer"] == "dermis", "force_N"] = 2.0
    with pytest.raises(InputError, match=r"line 11, column force_N: 2 N in step 1, where epidermis has 1 N"):
        read(table, tmp_path, DEPTH)


def test_each_layer_must_be_under_the_scenarios_load(tmp_path: Path) -> None:
    table = by_time()
    table.loc[table["layer"] == "dermis", "force_N"] *= 2.0
    with pytest.raises(InputError, match="force_N: at 5 s dermis is at 4, the scenario at 2"):
        read(table, tmp_path)


def test_the_way_back_is_not_taken_for_the_way_in(tmp_path: Path) -> None:
    force = np.array([0.5, 1.0, 2.0, 1.7, 0.2])
    frames = [pd.DataFrame({"force_N": force, "layer": layer, "fem_mm": law(force, 0)}) for layer in LAYERS]
    with pytest.raises(InputError, match=r"line 5, column force_N: the load of epidermis falls here"):
        read(pd.concat(frames), tmp_path)


@given(st.permutations(range(3 * 11)))
def test_the_order_of_rows_does_not_matter(tmp_path_factory, order: list[int]) -> None:
    frame, folder = by_time(11), tmp_path_factory.mktemp("order")
    np.testing.assert_array_equal(read(frame.iloc[order], folder).top_deflection, read(frame, folder).top_deflection)


BAD = {
    "it ends before the scenario": (by_time().query("time_s < 8"), ["time_s", "must reach as far"]),
    "an instant twice": (pd.concat([by_time(), by_time().iloc[5:6]]), ["line 605", "twice", "epidermis"]),
    "another history": (by_time().assign(force_N=1.0), ["force_N", "press alike"]),
    "neither step, time nor load": (by_time().drop(columns=["time_s", "force_N"]), ["step", "time_s", "force_N"]),
    "a layer too few": (by_time().query("layer != 'dermis'"), ["dermis", "must be the same"]),
}


@pytest.mark.parametrize("case", BAD)
def test_what_cannot_be_interpolated_is_refused(tmp_path: Path, case: str) -> None:
    frame, words = BAD[case]
    with pytest.raises(InputError) as caught:
        read(frame, tmp_path)
    for word in ["fea.csv", *words]:
        assert word in str(caught.value)


def test_the_template_filled_in_is_read(tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    write_template(path, SCENARIO)
    frame = pd.read_csv(path)
    assert frame["fem_mm"].isna().all()
    found = read(frame.assign(fem_mm=law(frame["force_N"], 0)), tmp_path)
    np.testing.assert_allclose(found.top_deflection[:, 0], EXPECTED[:, 0], rtol=1e-12)
    with pytest.raises(InputError, match="is there already"):
        write_template(path, SCENARIO)
