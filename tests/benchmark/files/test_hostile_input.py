"""What a person can put into a file or an option by mistake, and no one expects: refused by name, at once."""

import os
import struct
import zlib

import pytest

from benchmark.errors import InputError
from benchmark.files import load_scenario, load_session, load_tissue
from benchmark.models.user_file import read_user_file
from benchmark.physics.registry import load_effects

HEADER = "time_s,depth_mm,force_N\n"
ROWS = [f"{0.1 * k:.1f},{0.01 * k:.2f},{0.02 * k:.2f}\n" for k in range(40)]


@pytest.fixture
def pipe(tmp_path):
    os.mkfifo(tmp_path / "pipe.toml")
    return tmp_path / "pipe.toml"


@pytest.mark.parametrize("read", [load_scenario, load_tissue, read_user_file])
def test_pipes_and_devices_are_not_read(read, pipe):
    with pytest.raises(InputError, match="it is a pipe; allowed is a regular file"):
        read(pipe)
    with pytest.raises(InputError, match="it is a device; allowed is a regular file"):
        read(pipe.parent.joinpath("/dev/zero"))


@pytest.mark.parametrize("key", ["load.observations", "load.peak", "tool.radius", "dermis.poisson_ratio", "schema"])
def test_a_hundred_thousand_digits_are_refused_in_one_short_paragraph(key):
    with pytest.raises(InputError) as caught:
        load_scenario("skin-5N", {key: "9" * 100_000})
    assert key in str(caught.value)
    assert len(str(caught.value)) < 500


@pytest.mark.parametrize("peak", ["1e-160 N", "-1e-10 N", "0 N"])
def test_a_press_too_small_to_compute_with_is_none(peak):
    with pytest.raises(InputError, match=r"is no press; allowed: any force but zero, of 1e-06 mN or more in magnitude"):
        load_scenario("skin-5N", {"load.peak": peak})
    assert load_scenario("skin-5N", {"load.peak": "2e-9 N"}).load.peak == 2e-9


@pytest.mark.parametrize(
    ("row", "says"),
    [
        ("0.7,0.1,1e308", "column 'force_N', value '1e.308'.*from -1e.09 to 1e.09"),
        ("0.7,-1e308,0.1", "column 'depth_mm'.*from -1e.06 to 1e.06"),
        ("0.7,0.1," + "9" * 100_000, "beyond what a double holds"),
        ("0.7,1e9999,0.1", "beyond what a double holds"),
    ],
)
def test_cells_that_no_bench_measures_are_refused(tmp_path, row, says):
    (tmp_path / "press.csv").write_text(HEADER + "".join([*ROWS[:7], row + "\n", *ROWS[8:]]))
    with pytest.raises(InputError, match=says) as caught:
        load_session(tmp_path)
    assert "row 9" in str(caught.value)


def test_a_byte_order_mark_stands_before_any_file(tmp_path):
    mark = b"\xef\xbb\xbf"
    (tmp_path / "press.csv").write_bytes(mark + (HEADER + "".join(ROWS)).encode())
    (tmp_path / "session.toml").write_bytes(
        mark + b'schema = 1\nname = "a"\n[[trials]]\nfile = "press.csv"\ncondition = "press"\n'
    )
    (tmp_path / "model.py").write_bytes(mark + b"NAME = 'mine'\n")
    assert load_session(tmp_path).name == "a"
    assert read_user_file(tmp_path / "model.py").name == "mine"


def test_a_folder_whose_name_is_no_text_still_is_a_session(tmp_path):
    folder = tmp_path / os.fsdecode(b"M\xfcller\n1")
    folder.mkdir()
    (folder / "press.csv").write_text(HEADER + "".join(ROWS))
    assert load_session(folder).name == "M_ller_1"


@pytest.mark.parametrize("leave", ["sys.exit(0)", "raise SystemExit", "exit()"])
def test_an_effects_file_that_leaves_is_refused(tmp_path, leave):
    (tmp_path / "effects.py").write_text(f"import sys\n{leave}\n")
    with pytest.raises(InputError, match="this effects file does not run"):
        load_effects(tmp_path / "effects.py")


def test_a_picture_of_fifty_thousand_pixels_a_side_is_refused_unread(tmp_path):
    from bench_hw.errors import InputError as BenchInputError
    from bench_hw.vision.calibration.board import read_picture
    from bench_hw.vision.frames.source import decode_grey

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", 50_000, 50_000, 8, 0, 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(bytes(99))) + chunk(b"IEND", b"")
    (tmp_path / "a.png").write_bytes(data)
    with pytest.raises(BenchInputError, match="at most 268 million pixels"):
        read_picture(tmp_path / "a.png")
    assert decode_grey(data, "png") is None
