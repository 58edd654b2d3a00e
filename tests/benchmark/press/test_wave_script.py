"""The page's script against `wavemodel.control`, frame by frame, by node."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from benchmark.assessment.attempt_measures import read_attempt
from benchmark.press.press_page import document
from benchmark.press.radial_table import table_of_body
from wavemodel import Prony, PublishedWave
from wavemodel.control import Grid, InteractiveTissue, PublishedBody, layered_body

NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(NODE is None, reason="needs the program node to run the page's script")
HERE = Path(__file__).parent
SCRIPT = Path(__file__).parents[3] / "benchmark" / "press" / "page" / "wave.js"
GRID = (49e-3, 41e-3, 1e-3)
CLOSE = 1e-6


def frames(seed, deepest, apart):
    """Two tools that press, move, hold, and are let go in steps and in physical time."""
    rng = np.random.default_rng(seed)
    out = []
    for k in range(60):
        dt = float(rng.uniform(2e-3, 30e-3))
        frame = {"dt": dt, "touch": [], "release": []}
        if k < 40:
            x, y = rng.uniform(10e-3, 20e-3, 2)
            frame["touch"].append([0, float(x), float(y), float(min(k / 25, 1.0) * deepest)])
        if 10 <= k < 50:
            frame["touch"].append([1, float(x0 := 20e-3 + apart), 25e-3, 0.6 * deepest])
            assert x0 < GRID[0]
        if k == 40:
            frame["release"].append([0, 7])
        if k == 50:
            frame["release"].append([1, None])
        out.append(frame)
    return out


def presses_on_dents(deepest):
    """A tool that goes up fast, meets the tissue again, lets go, and presses near its dent, far off, and on its way."""
    depths = [0.5, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.2, 0.2, 0.8]
    out = [{"dt": 0.02, "touch": [[0, 20e-3, 20e-3, share * deepest]], "release": []} for share in depths]
    for x, steps, wait in ((20.5e-3, None, 2), (35e-3, None, 3), (35e-3, 6, 3)):
        out[-1]["release"].append([0, steps])
        out += [{"dt": 0.02, "touch": [], "release": []} for _ in range(wait)]
        out += [{"dt": 0.02, "touch": [[0, x, 20e-3, share * deepest]], "release": []} for share in (0.1, 0.1, 0.9)]
    return out


def followed(body, run, series, retardation):
    tissue = InteractiveTissue(body, Grid(*GRID), 4, series=series, retardation=retardation)
    answers = []
    for frame in run:
        for touch in frame["touch"]:
            tissue.touch(*touch)
        for release in frame["release"]:
            tissue.release(*release)
        faces = tissue.frame(frame["dt"]).copy()
        answers.append((faces, tissue.force.copy()))
    return answers


def by_node(bodies, runs):
    question = json.dumps({"bodies": bodies, "runs": runs})
    done = subprocess.run(
        [NODE, HERE / "follow.js", SCRIPT], input=question, capture_output=True, text=True, check=True, timeout=60
    )
    return json.loads(done.stdout)


def memory_of(series, retardation):
    return {"strength": series.strength, "time_s": series.time, "retardation_s": retardation}


@pytest.fixture(scope="module")
def compared(wave, series):
    """Each run by both, with the deepest deflection and the largest force."""
    cases = {
        "linear": (wave(), 1.2e-3, Prony(), 0.0),
        "linear with memory": (wave(), 1.2e-3, series, 0.02),
        "finite strain": (wave(large_press="corrected"), 3e-3, Prony(), 0.0),
        "finite strain with memory": (wave(large_press="corrected"), 3e-3, series, 0.0),
    }
    bodies, runs, expected = {}, [], {}
    for seed, (name, (one, deepest, prony, retardation)) in enumerate(cases.items()):
        body = layered_body(one, Grid(*GRID))
        bodies[name] = table_of_body(body, min(body.deepest, 3.5e-3)).to_dict()
        run = presses_on_dents(deepest) + frames(seed, deepest, 15e-3)
        runs.append({"body": name, "grid": GRID, "memory": memory_of(prony, retardation), "frames": run})
        expected[name] = followed(body, run, prony, retardation)
    return expected, dict(zip(cases, by_node(bodies, runs), strict=True))


@pytest.mark.parametrize("case", ["linear", "linear with memory", "finite strain", "finite strain with memory"])
def test_the_script_answers_as_the_model_does(compared, case):
    expected, found = (each[case] for each in compared)
    deepest = max(faces.max() for faces, _ in expected)
    strongest = max(force.max() for _, force in expected)
    assert deepest > 1e-3
    for (faces, force), answer in zip(expected, found, strict=True):
        assert not any(answer["refused"])
        if answer["faces"] is not None:
            np.testing.assert_allclose(np.reshape(answer["faces"], faces.shape), faces, rtol=0.0, atol=CLOSE * deepest)
        np.testing.assert_allclose(answer["force"], force, rtol=0.0, atol=CLOSE * strongest)


def test_what_is_let_go_returns(compared):
    _, found = compared
    for case in ("linear", "finite strain"):
        assert not np.any(found[case][-1]["faces"])
        assert not np.any(found[case][-1]["force"])
    creeping = [np.max(found["linear with memory"][k]["faces"]) for k in (-6, -1)]
    assert creeping[0] > creeping[1] > 0.0


def test_a_tool_that_cannot_be_there_is_refused(wave):
    body = layered_body(wave(), Grid(*GRID))
    touches = [[0, 20e-3, 20e-3, 1e-3], [1, 22e-3, 20e-3, 1e-3], [2, 60e-3, 20e-3, 1e-3], [3, 5e-3, 5e-3, 1.0]]
    run = {"body": "a", "grid": GRID, "memory": {}, "frames": [{"dt": 0.01, "touch": touches}]}
    [[answer]] = by_node({"a": table_of_body(body, 3e-3).to_dict()}, [run])
    assert answer["refused"][0] is None
    assert [
        word in text for word, text in zip(("closer", "outside", "deeper"), answer["refused"][1:], strict=True)
    ] == [True] * 3


def test_tools_side_by_side_may_touch_whatever_their_places_round_to(wave):
    body = layered_body(wave(), Grid(*GRID))
    width = 2.0 * body.tool_radius
    at = np.nextafter(20e-3 + width, 0.0)
    assert at - 20e-3 < width
    touches = [[0, 20e-3, 20e-3, 1e-3], [1, at, 20e-3, 1e-3], [2, 20e-3, 20e-3 + width * (1.0 - 1e-6), 1e-3]]
    run = {"body": "a", "grid": GRID, "memory": {}, "frames": [{"dt": 0.01, "touch": touches}]}
    [[answer]] = by_node({"a": table_of_body(body, 3e-3).to_dict()}, [run])
    assert answer["refused"][:2] == [None, None]
    assert "closer" in answer["refused"][2]


@pytest.mark.parametrize(
    ("variant", "name", "depth"), [("as_printed", "printed", 1e-3), ("corrected", "corrected", 4e-3)]
)
def test_the_published_membrane_is_the_library_s(variant, name, depth):
    body = PublishedBody(PublishedWave(variant))
    run = frames(5, depth, 15e-3)
    expected = followed(body, run, Prony(), 0.0)
    table = document([])["published"][name]
    [found] = by_node({"a": table}, [{"body": "a", "grid": GRID, "memory": {}, "frames": run}])
    for (faces, _), answer in zip(expected, found, strict=True):
        if answer["faces"] is not None:
            np.testing.assert_allclose(np.reshape(answer["faces"], faces.shape), faces, rtol=0.0, atol=1e-9)


def six_presses(wave, **options):
    """How six presses with one mouse went."""
    body = table_of_body(layered_body(wave(), Grid(*GRID)), 3e-3).to_dict()
    question = {"body": body, "grid": [49e-3, 49e-3, 1e-3], "kind": "touch", "dt": 1 / 60, "wait": 0.2, "memory": {}}
    done = subprocess.run(
        [NODE, HERE / "hands_follow.js", SCRIPT, SCRIPT.with_name("hands.js")],
        input=json.dumps(question | options), capture_output=True, text=True, check=True, timeout=60,
    )  # fmt: skip
    return json.loads(done.stdout)


def test_the_record_of_a_task_ends_with_it(wave):
    """However long after it is saved: at once, after a while, and after what else is kept is forgotten."""
    saved, *later = (six_presses(wave, after=seconds) for seconds in (0.0, 20.0, 650.0))
    assert saved["csv"].splitlines()[-1].split(",")[6] == "5"
    for answer in later:
        assert answer["csv"] == saved["csv"]


def test_a_task_that_takes_longer_than_what_is_kept_has_its_beginning(wave):
    """Ten minutes are kept, of a task all, up to an hour."""
    answer = six_presses(wave, wait=150.0, dt=0.1, limit=1200.0)
    times = [float(line.split(",")[0]) for line in answer["csv"].splitlines()[1:]]
    assert answer["done"]
    assert times[-1] > 800.0
    assert times[0] < 151.0


def test_one_mouse_is_one_hand_on_a_tissue_that_is_slow_to_return(wave, tmp_path):
    """Six presses with a memory that outlasts them all take as long as without, and the record has one tool."""
    answers = [
        six_presses(wave, memory=memory)
        for memory in ({}, {"strength": [0.3], "time_s": [700.0], "retardation_s": 0.0})
    ]
    for answer in answers:
        (tmp_path / "record.csv").write_text(answer["csv"])
        attempt = read_attempt(tmp_path / "record.csv")
        assert (answer["done"], answer["refused"], set(attempt.position)) == (True, 0, {0})
        assert np.isfinite(attempt.measures()["economy_of_motion"])
    assert answers[1]["seconds"] == pytest.approx(answers[0]["seconds"], abs=1e-9)
