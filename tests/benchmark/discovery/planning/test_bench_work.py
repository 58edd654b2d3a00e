import tomllib
from dataclasses import replace

import pytest

from bench_hw.capture.session import capture
from bench_hw.capture.trial import Fault
from benchmark.discovery.planning import bench_work
from benchmark.discovery.planning.bench_work import kept_experiments, load_bench, session_copy
from benchmark.errors import DeviceError, InputError
from benchmark.experiments.menu import Usual, second_tools
from benchmark.files import load_session

USUAL = Usual(depth=1e-3, speed=2e-3, hold=0.5, thickness=20e-3)


def test_an_experiment_with_another_tool_joins_the_copy_with_that_tool_alone(bench, folder, proposal) -> None:
    (other,) = second_tools(USUAL, 5e-3, bench.allowed(set()).radii)  # the rig has tools of 5 and 8 mm
    wider = proposal(other)
    files = bench.record(wider, 2, 1)
    bench.add(wider, files)
    grown = load_session(bench.folder)
    assert [trial.condition for trial in grown.trials] == ["usual", "tool of 8 mm", "tool of 8 mm"]
    assert (
        tomllib.loads((bench.folder / "session.toml").read_text())["conditions"]["tool of 8 mm"]["tool"]["radius"]
        == "8 mm"
    )
    assert max(float(trial.table.force.max()) for trial in grown.trials[1:]) > 0.5
    assert [trial.condition for trial in load_session(folder / "session").trials] == ["usual"]


def test_what_lies_under_the_tool_is_read_with_the_rig(folder) -> None:
    """Not at the first experiment, minutes later."""
    specimen = folder / "specimen.toml"
    specimen.write_text(specimen.read_text().replace("compliance_mm_per_N", "compliance_um"))
    with pytest.raises(InputError, match=r"--bench: .*specimen\.toml.*compliance_um"):
        load_bench(str(folder / "rig.toml"))


def test_what_was_recorded_before_a_fault_stays(bench, proposal, monkeypatch) -> None:
    def faulty(order, *told, **more):
        made = capture(replace(order, trials=1), *told, **more)
        return replace(made, fault=Fault("silent", "the force sensor is silent", retracted=True))

    monkeypatch.setattr(bench_work, "capture", faulty)
    (other,) = second_tools(USUAL, 5e-3, bench.allowed(set()).radii)
    with pytest.raises(DeviceError, match="--bench: the force sensor is silent"):
        bench.record(proposal(other), 2, 1)
    assert [each.name for each in (bench.folder / "experiment_1").glob("*.mcap")] == ["trial_001.mcap"]
    assert len(load_session(bench.folder).trials) == 1


def test_the_copy_of_an_interrupted_loop_is_kept_and_one_without_recordings_is_not(folder, tmp_path) -> None:
    store = tmp_path / "results" / ".found-wave.unfinished"
    store.mkdir(parents=True)
    for number in (1, 2):
        copy = session_copy(folder / "session", store / "session")
        assert kept_experiments(folder / "session", copy) is None
        assert copy.is_dir()
        (copy / "experiment_1_1.mcap").write_bytes(b"measured")
        kept = kept_experiments(folder / "session", copy)
        assert kept == tmp_path / "results" / f"found-wave-experiments-{number}"
        assert (kept / "experiment_1_1.mcap").read_bytes() == b"measured"
        assert not copy.exists()
    assert kept_experiments(folder / "session", copy) is None


def test_a_loop_goes_on_from_the_grown_session_of_another_without_touching_its_recordings(bench, proposal) -> None:
    (other,) = second_tools(USUAL, 5e-3, bench.allowed(set()).radii)
    bench.add(proposal(other), bench.record(proposal(other), 2, 1))
    (bench.folder / "experiment_2").mkdir()  # of a bench that failed
    (bench.folder / "experiment_2" / "trial_001.mcap.part").write_bytes(b"measured")
    grown = bench.folder
    first = {each.name: each.read_bytes() for each in grown.glob("*.mcap")}
    again = replace(bench, folder=session_copy(grown, grown.with_name("again")))
    again.add(proposal(other), again.record(proposal(other), 2, 1))
    assert {name: (again.folder / name).read_bytes() for name in first} == first
    listed = [trial["file"] for trial in tomllib.loads((again.folder / "session.toml").read_text())["trials"]]
    assert listed == ["a.csv", *(f"experiment_{n}_{k}.mcap" for n in (1, 3) for k in (1, 2))]
    assert len({(again.folder / name).read_bytes() for name in listed}) == 5  # and no simulated noise comes twice
    assert (again.folder / "experiment_2" / "trial_001.mcap.part").read_bytes() == b"measured"


def test_a_recording_is_kept_though_the_session_has_another_of_its_name(folder, tmp_path) -> None:
    store = tmp_path / ".found-wave.unfinished"
    store.mkdir()
    (folder / "session" / "experiment_1_1.mcap").write_bytes(b"measured before")
    copy = session_copy(folder / "session", store / "session")
    (folder / "session" / "session.toml").write_text("name = 'said otherwise since'")
    assert kept_experiments(folder / "session", copy) is None
    (copy / "experiment_1_1.mcap").write_bytes(b"measured")
    kept = kept_experiments(folder / "session", copy)
    assert (kept / "experiment_1_1.mcap").read_bytes() == b"measured"


def test_what_a_failed_experiment_left_in_its_folder_is_kept(folder, tmp_path) -> None:
    """Though the session has such a folder, too."""
    store = tmp_path / ".found-wave.unfinished"
    store.mkdir()
    (folder / "session" / "experiment_1").mkdir()
    copy = session_copy(folder / "session", store / "session")
    (copy / "experiment_1" / "trial_001.mcap.part").write_bytes(b"measured")
    kept = kept_experiments(folder / "session", copy)
    assert (kept / "experiment_1" / "trial_001.mcap.part").read_bytes() == b"measured"


def test_a_folder_without_a_session_file_is_refused(tmp_path) -> None:
    with pytest.raises(InputError, match=r"--bench needs a session\.toml"):
        session_copy(tmp_path, tmp_path / "copy")
