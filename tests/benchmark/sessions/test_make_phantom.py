import tomllib
from pathlib import Path

import numpy as np

from bench_hw.vision.camera.camera_file import read_camera
from benchmark.files import load_session
from benchmark.sessions import SHIPPED
from benchmark.sessions.make_phantom import DISTORTION, PRESSES, SEED, drawn_trials
from benchmark.sessions.phantom_sheet import truth_text

PHANTOM = Path(SHIPPED) / "phantom"
LARGEST, TOTAL = 5_000_000, 20_000_000


def test_the_shipped_session_is_whole_and_says_that_it_is_synthetic() -> None:
    session = load_session(PHANTOM)
    assert session.synthetic
    assert [len([t for t in session.trials if t.condition == name]) for name, _, _ in PRESSES] == [10, 3]
    assert session.support.kind == "hole"
    filmed = [trial for trial in session.trials if trial.path.suffix == ".mcap"]
    assert [trial.name for trial in filmed] == ["press_01", "rich_01"]
    assert all(trial.markers is not None for trial in session.trials if trial not in filmed)
    assert max(trial.table.depth.max() for trial in session.trials) < 4.7e-3


def test_it_is_small_and_made_with_the_published_lens() -> None:
    sizes = [file.stat().st_size for file in PHANTOM.iterdir()]
    assert max(sizes) < LARGEST
    assert sum(sizes) < TOTAL
    assert read_camera(PHANTOM / "camera.toml").distortion == DISTORTION


def test_the_truth_that_ships_is_the_one_that_is_drawn_and_no_fit_reads_it() -> None:
    trials = tuple(drawn_trials(np.random.default_rng(SEED)))
    text = (PHANTOM / "truth.toml").read_text()
    assert text == truth_text(trials)
    assert len(tomllib.loads(text)["trials"]) == len(trials) == 13
    assert "truth" not in (PHANTOM / "session.toml").read_text()
