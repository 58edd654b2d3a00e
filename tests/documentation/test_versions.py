"""Files of another schema end as docs/files.md says of them."""

from pathlib import Path

import pytest

from bench_hw.errors import InputError as BenchError
from bench_hw.motion.protocol_file import load_protocol
from bench_hw.rig.rig_file import load_rig
from bench_hw.vision.camera.camera_file import read_camera
from benchmark.errors import InputError, NotComparableError
from benchmark.files import load_scenario, load_session
from benchmark.gate.baseline import read_baseline
from benchmark.gate.history.history_file import read_history

ROOT = Path(__file__).resolve().parents[2]
WRITTEN = {
    "tissue skin": ("benchmark/tissues/skin_forearm.toml", None),
    "scenario": ("benchmark/scenarios/skin-5N.toml", load_scenario),
    "camera": ("benchmark/sessions/phantom/camera.toml", read_camera),
    "protocol": ("bench_hw/motion/library/paper_press.toml", load_protocol),
    "rig": ("bench_hw/rig/library/simulated.toml", load_rig),
}


@pytest.mark.parametrize("kind", WRITTEN)
def test_what_a_person_writes_is_refused_with_the_number_that_is_read(kind: str, tmp_path: Path) -> None:
    shipped, read = WRITTEN[kind]
    text = (ROOT / shipped).read_text(encoding="utf-8")
    assert "schema = 1" in text
    path = tmp_path / Path(shipped).name
    path.write_text(text.replace("schema = 1", "schema = 2\nno_such_key = 1", 1), encoding="utf-8")
    with pytest.raises((InputError, BenchError), match=r"schema.*2.*1|2 is not a schema.*allowed: 1"):
        read(path) if read is not None else load_scenario("skin-5N", {"tissue": str(path)})


def test_a_session_of_another_schema_is_refused(tmp_path: Path) -> None:
    (tmp_path / "session.toml").write_text('schema = 2\nname = "s"\n')
    with pytest.raises(InputError, match="schema"):
        load_session(tmp_path)


def test_a_baseline_is_not_comparable_and_a_line_of_a_history_is_passed_over(tmp_path: Path) -> None:
    (tmp_path / "b.json").write_text('{"schema": 2}')
    with pytest.raises(NotComparableError, match="schema"):
        read_baseline(tmp_path / "b.json")
    (tmp_path / "h.jsonl").write_text('{"schema": 2}\n')
    assert read_history(tmp_path / "h.jsonl") == ([], 1)
