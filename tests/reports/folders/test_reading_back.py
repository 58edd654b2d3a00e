"""What cannot be read is not put in place."""

import pytest

from reports import whole_folder
from reports.folders.reading_back import UnreadableResultError


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a.json", '{"x": NaN}', "NaN is no JSON"),
        ("a.json", "{", "a.json was written but cannot be read back"),
        ("model.toml", 'x = "1\n', "model.toml was written"),
        ("tables/a.csv", "a,b\n1,2\n3\n", r"tables/a.csv .*row 3 has 1 cells and the header 2"),
        ("a.csv", "a,a\n1,2\n", "its header is"),
        ("a.csv", "", "its header is"),
    ],
)
def test_a_file_that_its_readers_would_refuse_stops_everything(tmp_path, name, text, says):
    def write():
        with whole_folder(tmp_path / "result") as new:
            (new / name).parent.mkdir(exist_ok=True)
            (new / name).write_text(text)

    with pytest.raises(UnreadableResultError, match=says):
        write()
    assert list(tmp_path.iterdir()) == []


def test_what_can_be_read_passes(tmp_path):
    with whole_folder(tmp_path / "result") as new:
        (new / "a.json").write_text('{"x": null}')
        (new / "b.toml").write_text("x = 1\n")
        (new / "c.csv").write_text('a,b\n"1,5",2\n')
        (new / "d.vtu").write_bytes(b"\0")
    assert (tmp_path / "result" / "manifest.json").is_file()
