"""What the verbs answer in a script calls models by what stands there."""

from dataclasses import replace

import pytest

from benchmark.cli.console import Console
from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.results import RunResult
from benchmark.runs.options import RunOptions
from benchmark.runs.output.pressed import Drawn
from benchmark.runs.scenario_run import run_scenario
from benchmark.scripting import compare, run

QUICK = {"fem.mesh": "coarse", "load.observations": "10", "wave.large_press": "linear"}


@pytest.fixture(scope="module")
def record(in_threads):
    return run_scenario(load_scenario("skin-5N", QUICK), RunOptions(repeats=1), Console(quiet=True))


@pytest.mark.parametrize(("given", "says"), [({"fields": "some"}, "'peak' and 'all'"), ({"repeats": 0}, "1 or more")])
def test_what_cannot_be_is_refused_in_a_script(given, says):
    """The first was taken for 'peak' and the second left the timing out, without a word."""
    with pytest.raises(InputError, match=says):
        run("skin-5N", set=QUICK, **given)


def labels(result):
    return result.plot().axes[0].get_legend_handles_labels()[1]


def test_a_run_has_the_harness_s_own_models_by_their_names(record):
    result = RunResult(record)
    assert labels(result) == ["FEM", "wave model"]
    assert "largest deflection, FEM and wave model" in result.summary()


def test_a_user_s_own_fea_and_model_are_called_so(record):
    pair = replace(
        record.pair,
        fem=replace(record.pair.fem, own="FEA of mine.csv"),
        wave=replace(record.pair.wave, own="springs"),
    )
    result = RunResult(replace(record, pair=pair))
    assert labels(result) == ["FEA of mine.csv", "springs"]
    assert "largest deflection, FEA of mine.csv and springs" in result.summary()


@pytest.mark.usefixtures("undrawn")
def test_runs_side_by_side_are_drawn_by_layer(record, tmp_path, monkeypatch):
    monkeypatch.setattr("benchmark.runs.output.pressed.draw_pressed", lambda *_: Drawn(b"", "left out of this test"))
    own = replace(record, pair=replace(record.pair, fem=replace(record.pair.fem, own="FEA of mine.csv")))
    for name, each in (("first", record), ("second", own)):
        RunResult(each).report(tmp_path / name)
    axes = compare(tmp_path / "first", tmp_path / "second").plot().axes
    labels = axes[0].get_legend_handles_labels()[1]
    assert [each.get_title() for each in axes[: len(record.layers)]] == list(record.layers)
    assert labels == ["FEM, FEA of mine.csv", "wave model"]
    assert axes[0].lines[0].get_ydata() == pytest.approx(2 * [1e3 * record.pair.fem.result.max_deformation()[0]])
