"""`benchmark run` with a user's own model, own FEA, and several tissues."""

import json
from pathlib import Path

import pandas as pd
import pytest

from benchmark.sessions import SHIPPED

SMALL = ("--set", "fem.mesh=coarse", "--set", "load.observations=8", "--set", "wave.large_press=linear", "--quiet")
EXAMPLE = Path(__file__).parents[3] / "examples" / "own_model.py"
NAME = "layer-by-layer squeeze"


@pytest.mark.usefixtures("as_told")
def test_the_example_stands_in_the_waves_place(benchmark_cli, tmp_path: Path) -> None:
    out = tmp_path / "r"
    called = benchmark_cli("run", "skin-5N", *SMALL, "--wave", EXAMPLE, "--out", out, "--json")
    assert called.code == 0, called.err
    document = json.loads(called.out)
    assert document["models"]["wave"]["name"] == NAME
    assert document["speedup"]["repeats"] == 3
    timing = pd.read_csv(out / "tables/timing.csv")
    assert timing.groupby("model").size().to_dict() == {"fem": 3, NAME: 3}
    assert set(pd.read_csv(out / "tables/normal_fits.csv").model) == {"fem", NAME}
    deformation = pd.read_csv(out / "tables/max_deformation.csv")
    assert (deformation[deformation.force_N > 0].wave_mm > 0).all()
    page = (out / "report.html").read_text()
    assert NAME in page
    assert "wave model" not in page.lower()


@pytest.mark.slow
def test_measured_trials_drive_it_through_its_press(benchmark_cli, tmp_path: Path) -> None:
    model = tmp_path / "springs.py"
    model.write_text(
        "import numpy as np\n"
        "def deform(layers, tool, support, time, force):\n    return 1e-3 * np.outer(force, np.ones(len(layers)))\n"
        "def press(layers, tool, support, time, depth):\n    return 1e3 * depth\n"
    )
    out = tmp_path / "r"
    called = benchmark_cli("run", "--trials", SHIPPED / "phantom", *SMALL[:2], "--wave", model, "--out", out, "--quiet")
    assert called.code == 0, called.err
    measured = pd.read_csv(out / "tables/measured.csv")
    assert measured.wave_force_N.notna().all()
    assert "springs residual, rms" in (out / "report.html").read_text()


@pytest.mark.slow
def test_a_press_that_declines_leaves_the_measured_column_empty(benchmark_cli, tmp_path: Path) -> None:
    out = tmp_path / "r"
    trials = ("--trials", SHIPPED / "phantom", *SMALL[:2])
    called = benchmark_cli("run", *trials, "--wave", EXAMPLE, "--out", out)
    assert called.code == 0, called.err
    assert pd.read_csv(out / "tables/measured.csv").wave_force_N.isna().all()
    assert "has no force for 13 of the trials: it knows a bonded base only" in called.err


@pytest.mark.usefixtures("undrawn")
def test_a_users_fea_stands_in_the_fems_place(benchmark_cli, tmp_path: Path) -> None:
    first, second = tmp_path / "a", tmp_path / "b"
    assert benchmark_cli("run", "skin-5N", *SMALL, "--out", first).code == 0
    table = first / "tables/max_deformation.csv"
    called = benchmark_cli("run", "skin-5N", *SMALL, "--reference", table, "--out", second, "--json")
    assert called.code == 0, called.err
    document = json.loads(called.out)
    assert document["models"]["fem"]["name"] == "FEA of max_deformation.csv"
    assert document["models"]["fem"]["unknowns"] is None
    assert document["speedup"]["median"] is None
    assert any("a table has no profile" in warning for warning in document["warnings"])
    for name in ("max_deformation", "statistics"):
        frames = [pd.read_csv(folder / f"tables/{name}.csv") for folder in (first, second)]
        pd.testing.assert_frame_equal(*frames, rtol=1e-9)
    assert pd.read_csv(second / "tables/profile.csv").fem_mm.isna().all()
    assert set(pd.read_csv(second / "tables/timing.csv").model) == {"wave"}
    assert not (second / "fields").exists()


def test_a_table_in_metres_is_said_to_be_far_from_the_model(benchmark_cli, tmp_path: Path) -> None:
    model, table = tmp_path / "springs.py", tmp_path / "fea.csv"
    model.write_text(
        "import numpy as np\n"
        "def deform(layers, tool, support, time, force):\n    return 1e-3 * np.outer(force, np.ones(len(layers)))\n"
    )
    rows = (f"{layer},{{}}\n" for layer in ("epidermis", "dermis", "subcutaneous_fat"))
    table.write_text("layer,fem_mm\n" + "".join(row.format(5e-3) for row in rows))
    called = benchmark_cli(
        "run", "skin-5N", *SMALL, "--wave", model, "--reference", table, "--out", tmp_path / "r", "--json"
    )
    assert called.code == 0, called.err
    said = "two models, 0.005 mm and 5 mm, are 1000 times apart: see whether one is in another unit"
    warnings = json.loads(called.out)["warnings"]
    assert any(said in warning for warning in warnings)
    expected = f"{table}, column fem_mm: the largest value is 0.005, expected is about 5 mm"
    assert any(warning.endswith(expected) for warning in warnings)
    idle = [warning.partition(":")[0] for warning in warnings if "no effect" in warning]
    assert idle == ["--set wave.large_press has no effect", "--set fem.mesh has no effect"]


def test_one_layer_in_metres_and_a_force_in_kilonewtons_are_said(benchmark_cli, tmp_path: Path) -> None:
    model, table = tmp_path / "springs.py", tmp_path / "fea.csv"
    model.write_text(
        "import numpy as np\n"
        "def deform(layers, tool, support, time, force):\n    return 1e-3 * np.outer(force, np.ones(len(layers)))\n"
        "def press(layers, tool, support, time, depth):\n    return 1e3 * depth\n"
    )
    values = {"epidermis": 2.0, "dermis": 2e-3, "subcutaneous_fat": 2.0}
    table.write_text("layer,fem_mm,force_N\n" + "".join(f"{name},{value},0.002\n" for name, value in values.items()))
    depth = ("--set", "load.control=depth", "--set", "load.peak=2 mm", "--set", "tool.contact=rigid_bonded")
    called = benchmark_cli(
        "run", "skin-5N", *SMALL, *depth, "--wave", model, "--reference", table, "--out", tmp_path / "r", "--json"
    )
    assert called.code == 0, called.err
    warnings = json.loads(called.out)["warnings"]
    deep = "the largest deflections of dermis of the two models, 0.002 mm and 2 mm, are 1000 times apart"
    assert any(deep in warning and f"{table}, column fem_mm" in warning for warning in warnings)
    forces = "the largest forces of the two models, 0.002 N and 2 N, are 1000 times apart"
    assert any(forces in warning and f"{table}, column force_N" in warning for warning in warnings)


@pytest.mark.slow
def test_own_model_against_own_fea_needs_none_of_ours(benchmark_cli, tmp_path: Path) -> None:
    first = tmp_path / "a"
    assert benchmark_cli("run", "skin-5N", *SMALL, "--wave", EXAMPLE, "--out", first).code == 0
    frame = pd.read_csv(first / "tables/max_deformation.csv")
    frame.assign(fem_mm=frame.wave_mm).to_csv(tmp_path / "mine.csv", index=False)
    own = ("--wave", EXAMPLE, "--reference", tmp_path / "mine.csv")
    called = benchmark_cli("run", "skin-5N", *SMALL, *own, "--out", tmp_path / "b", "--json")
    assert called.code == 0, called.err
    assert all(layer["percent_error_max"] < 1e-9 for layer in json.loads(called.out)["comparison"].values())


@pytest.mark.usefixtures("as_told")
@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("def deform(:\n", ["mine.py, line 1", "no valid Python"]),
        ("def deform(layers, tool, support, time, force):\n    return 1 / 0\n", ["mine.py, line 2", "ZeroDivision"]),
    ],
)
def test_a_model_at_fault_ends_the_run_and_leaves_nothing(benchmark_cli, tmp_path: Path, text: str, words) -> None:
    model = tmp_path / "mine.py"
    model.write_text(text)
    called = benchmark_cli("run", "skin-5N", *SMALL, "--wave", model, "--out", tmp_path / "r")
    assert called.code == 2
    assert called.out == ""
    assert "Traceback" not in called.err
    assert all(word in " ".join(called.err.split()) for word in words), called.err
    assert list(tmp_path.iterdir()) == [model]


@pytest.mark.usefixtures("undrawn")
def test_a_model_that_declines_leaves_its_columns_empty(benchmark_cli, tmp_path: Path) -> None:
    settings = ("--set", "support.kind=half_space", "--set", "load.peak=0.1 N")
    called = benchmark_cli("run", "skin-5N", *SMALL[:4], *settings, "--wave", EXAMPLE, "--out", tmp_path / "r")
    assert called.code == 0
    assert f"the {NAME} does not cover this scenario" in called.err
    assert pd.read_csv(tmp_path / "r/tables/max_deformation.csv").wave_mm.isna().all()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--wave", "mine.py"), ["--wave", "SCENARIO"]),
        (("--reference", "a.csv"), ["--reference", "SCENARIO"]),
        (("--trials", "s", "--reference", "a.csv"), ["--reference", "SCENARIO"]),
        (("--trials", "s", "--tissue", "skin_forearm"), ["--tissue", "SCENARIO"]),
        (("skin-5N", "--tissue", "skin_forearm", "--set", "tissue=skin_traction"), ["--tissue", "--set"]),
        (("skin-5N", "--reference", "a.csv", "--tissue", "a", "--tissue", "b"), ["--reference", "--tissue"]),
        (("skin-5N", "--tissue", "skin_forearm", "--tissue", "skin_forearm"), ["not different"]),
        (("skin-5N", "--wave", "nowhere.py"), ["nowhere.py"]),
        (("skin-5N", "--reference", "nowhere.csv"), ["nowhere.csv"]),
    ],
)
def test_what_does_not_go_together_is_refused(benchmark_cli, arguments, words) -> None:
    called = benchmark_cli("run", *arguments)
    assert called.code == 2
    assert all(word in called.err for word in words), called.err


@pytest.mark.slow
def test_tissues_are_set_side_by_side(benchmark_cli, tmp_path: Path) -> None:
    tissues = ("skin_forearm", "skin_traction")
    options = [word for tissue in tissues for word in ("--tissue", tissue)]
    out = tmp_path / "r"
    called = benchmark_cli("run", "skin-5N", *SMALL, "--set", "load.peak=1 N", *options, "--out", out, "--json")
    assert called.code == 0, called.err
    whole, *each = json.loads(called.out)["runs"]
    assert whole["tissues"] == list(tissues)
    assert [run["out"] for run in each] == [str(out / tissue) for tissue in tissues]
    table = pd.read_csv(out / "tables/tissues.csv")
    assert list(table.columns) == [
        "tissue", "layer", "thickness_mm", "youngs_modulus_kPa", "poisson_ratio", "fem_max_mm", "wave_max_mm",
        "percent_error",
    ]  # fmt: skip
    for tissue in tissues:
        deformation = pd.read_csv(out / tissue / "tables/max_deformation.csv")
        rows = table[table.tissue == tissue].set_index("layer")
        for layer, values in deformation.groupby("layer"):
            assert rows.fem_max_mm[layer] == values.fem_mm.max()
            assert rows.wave_max_mm[layer] == values.wave_mm.max()
    page = (out / "report.html").read_text()
    assert all(f"{tissue}/report.html" in page for tissue in tissues)
    again = benchmark_cli("run", "skin-5N", *SMALL, *options[:2], "--out", out)
    assert again.code == 0, "an earlier comparison may be replaced"
    assert not (out / "skin_traction").exists()
