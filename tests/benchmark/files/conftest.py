"""Small files to read: tissues, scenarios and trial sessions, written into the test's own folder."""

from pathlib import Path

import pytest

from bench_hw.trial_file import EventRecord, ForceRecord, PositionRecord, TrialHeader, open_trial

TISSUE = """\
schema = 1
name = "slab"
citation = "made for a test"

[[layers]]
name = "skin"
thickness = "1.5 mm"
density = "1100 kg/m^3"
youngs_modulus = "120 kPa"
poisson_ratio = 0.48

[[layers]]
name = "fat"
thickness = "10 mm"
density = "971 kg/m^3"
youngs_modulus = "20 kPa"
poisson_ratio = 0.48
"""

SCENARIO = """\
schema = 1
name = "press"
tissue = "slab.toml"

[tool]
radius = "5 mm"

[load]
peak = "5 N"
"""


@pytest.fixture
def tissue_file(tmp_path: Path) -> Path:
    """A two-layer tissue, `slab.toml`."""
    path = tmp_path / "slab.toml"
    path.write_text(TISSUE)
    return path


@pytest.fixture
def scenario_file(tmp_path: Path, tissue_file: Path) -> Path:
    """A press of that tissue with as few keys as there can be."""
    path = tmp_path / "press.toml"
    path.write_text(SCENARIO)
    return path


@pytest.fixture
def change(tmp_path: Path):
    """Replace text in a file, which must be there, and return the file."""

    def change(path: Path, old: str, new: str) -> Path:
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new, 1))
        return path

    return change


@pytest.fixture
def write_trial():
    """Write a trial of `rows` rows: a press of 0.05 mm and 0.01 N a row on 8 mm of tissue."""

    def write(path: Path, rows: int = 30, gap: float | None = 8.0) -> Path:
        path.parent.mkdir(parents=True, exist_ok=True)
        head = "time_s,depth_mm,force_N" + (",gap_mm" if gap is not None else "")
        lines = [f"{0.1 * row:.1f},{0.05 * row:.2f},{0.01 * row:.2f}" for row in range(rows)]
        if gap is not None:
            lines = [f"{line},{gap - 0.05 * row:.2f}" for row, line in enumerate(lines)]
        path.write_text("\n".join([head, *lines]) + "\n")
        return path

    return write


@pytest.fixture
def write_native_trial():
    """Write a native trial as simulated devices or real ones would: the same press, force and depth at 10 Hz."""

    def write(path: Path, synthetic: bool, fault: str = "") -> Path:
        header = TrialHeader("trial", "2024-05-06T07:08:09+00:00", 50.0, "-z", synthetic=synthetic)
        with open_trial(path, header, background=False) as writer:
            for row in range(30):
                time = 50.0 + 0.1 * row
                writer.write_position(PositionRecord(time, 0.05e-3 * row))
                writer.write_force(ForceRecord(time, row + 1, row + 1, 0, (0.0, 0.0, -0.01 * row), (0.0, 0.0, 0.0)))
            if fault:
                writer.write_event(EventRecord(52.95, "force_limit", fault, "fault"))
        return path

    return write


@pytest.fixture
def session_folder(tmp_path: Path, write_trial) -> Path:
    """A session of two trials, with a session.toml that says the least."""
    folder = tmp_path / "session"
    write_trial(folder / "one.csv")
    write_trial(folder / "two.csv")
    (folder / "session.toml").write_text(
        'schema = 1\nname = "two presses"\nspecimen = "skin_forearm"\n\n'
        '[[trials]]\nfile = "one.csv"\ncondition = "slow"\n\n[[trials]]\nfile = "two.csv"\ncondition = "fast"\n'
    )
    return folder
