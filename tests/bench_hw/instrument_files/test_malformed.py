# ruff: noqa: E501 - a case a line
"""Sixty files that cannot be read: each is refused in one paragraph with its place, what is allowed and the way out."""

import gzip
import zipfile

import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.instrument_files import Told, read_instrument_file
from tests.instruments import samples

PRESS = samples.press(rate=20.0, hold=0.5)
T, D, F = PRESS.time, PRESS.depth + 0.5, PRESS.force
HEAD = "Time (s),Distance (mm),Force (N)"


def lines(digits=(3, 5, 6), **style):
    return samples.rows(T, D, F, digits=digits, **style)


def table(head=HEAD, body=None):
    return "\n".join([*([head] if head is not None else []), *(lines() if body is None else body)]) + "\n"


def with_row(number, text):
    body = lines()
    body[number] = text
    return table(body=body)


def cut(text, share=0.5):
    return text[: int(share * len(text))]


def columns(*parts, head, digits):
    return table(head, samples.rows(*parts, digits=digits))


TEXTS = {
    "empty": ("", "the file is empty"),
    "blank lines": ("\n\n \n", "the file is empty"),
    "words alone": ("gel\nfrom Tuesday\n", "no rows of numbers"),
    "one column": ("Force (N)\n" + "\n".join(map(str, range(50))), "no rows of numbers"),
    "few rows": (table(body=lines()[:7]), "at least 20 rows"),
    "header alone": (HEAD + "\n", "no rows of numbers"),
    "no header": (table(None), r"have no names.*import\.time=\"#1:s\" --set import\.depth=\"#2:mm\" --set import\.force"),
    "no force": (columns(T, D, head="Time (s),Distance (mm)", digits=(3, 5)), "no column is the force.*import.force"),
    "no depth": (columns(T, F, head="Time (s),Force (N)", digits=(3, 5)), "no column is the depth.*import.depth"),
    "no time": (columns(D, F, head="Distance (mm),Force (N)", digits=(5, 5)), "no column is the time.*import.rate"),
    "no unit of force": (table("Time (s),Distance (mm),Force"), r"unit of the force.*import\.force=\"Force:N\""),
    "no unit of depth": (
        table("Time (s),Distance,Force (N)"),
        r"unit of the displacement.*import\.depth=\"Distance:mm\"",
    ),
    "no unit of time": (table("Time,Distance (mm),Force (N)"), r"unit of the time.*import\.time=\"Time:s\""),
    "no units at all": (table("Time,Distance,Force"), r"the unit of the time stands neither.*row 1|row 1.*unit of the time"),
    "force in two units": (
        table("Time [s],Weg [mm],Kraft [N]\ns,mm,kN"),
        r"row 2, column 'Kraft \[N\]'.*force is told as N and as kN.*import\.force=\"#3:N\".*import\.force=\"#3:kN\"",
    ),
    "time in two units": (table("Time [ms],Weg [mm],Kraft [N]\n[s],[mm],[N]"), r"time is told as ms and as s.*\"#1:ms\""),
    "volts": (table("Time (s),Distance (mm),Force (V)"), "no column is the force"),
    "depth in newtons": (table("Time (s),Distance (N),Force (N)"), "no column is the depth"),
    "strange names": (table("a,b,c"), "no column is the force.*'a', #2 'b', #3 'c'"),
    "two forces": (
        columns(T, D, F, F**2, head="Time (s),Distance (mm),Force (N),Force (N)", digits=(3, 5, 6, 6)),
        r"two columns could be the force.*import\.force=\"#3:N\"",
    ),
    "two depths": (
        columns(T, D, D**2, F, head="Time (s),Distance (mm),Travel (mm),Force (N)", digits=(3, 5, 6, 6)),
        r"two columns could be the depth.*import\.depth",
    ),
    "a word in the force": (with_row(9, f"{T[9]:.3f},{D[9]:.4f},ovr"), "row 11, column 'Force', value 'ovr'.*drop_empty"),
    "an empty cell": (with_row(9, f"{T[9]:.3f},{D[9]:.4f},"), "row 11, column 'Force'.*the cell is empty.*drop_empty"),
    "a dash": (with_row(9, f"{T[9]:.3f},{D[9]:.4f},---"), "row 11, column 'Force', value '---'"),
    "nan": (with_row(9, f"{T[9]:.3f},{D[9]:.4f},nan"), "row 11, column 'Force', value 'nan'"),
    "meganewtons": (table("Time (s),Distance (mm),Force (MN)", [*lines()[:40], f"{T[40]:.3f},1,4000", *lines()[41:]]), "row 42, column 'Force', value '4e.09 N'.*up to 1e.09 N.*Force:UNIT"),
    "a row of nan": (with_row(30, "NaN,NaN,NaN"), "row 32, column 'Time', value 'NaN'.*drop_empty"),
    "inf": (with_row(9, f"{T[9]:.3f},inf,{F[9]:.4f}"), "row 11, column 'Distance', value 'inf'"),
    "a short row": (with_row(9, f"{T[9]:.3f},{D[9]:.4f}"), "row 11, column 'Force'"),
    "beyond a double": (with_row(9, f"{T[9]:.3f},{D[9]:.4f},1e999"), "row 11.*beyond what a double holds"),
    "an open quote": (with_row(9, f'{T[9]:.3f},{D[9]:.4f},"3'), "row 11.*cannot be split"),
    "text amid numbers": (with_row(20, "operator stopped the test"), "row 22.*amid rows of numbers"),
    "time stands": (columns(0 * T, D, F, head=HEAD, digits=(3, 5, 6)), "row 3.*time does not increase"),
    "time goes back": (with_row(30, f"0.1,{D[30]:.4f},{F[30]:.4f}"), "row 32.*time does not increase"),
    "time falls": (columns(T[::-1], D, F, head=HEAD, digits=(3, 5, 6)), "row 3.*time does not increase"),
    "nothing moves": (columns(T, 0 * D, F, head=HEAD, digits=(3, 5, 6)), r"column 'Distance'.*never changes.*import\.depth"),
    "pulls as hard as it presses": (
        columns(T, D, F * np.sign(T - T.mean()), head=HEAD, digits=(3, 5, 6)), r"as far down.*import\.force=\"-Force\"",
    ),
    "peak where it began": (
        columns(T, np.minimum(T, T[-1] - T), T, head=HEAD, digits=(3, 5, 6)),
        r"is where it began.*import\.depth=\"-Distance\"",
    ),
    "thousands or decimals": (
        "Time (s);Distance (mm);Force (N)\n" + "\n".join(f"{1000 + k};{2000 + k};1,{100 + k}" for k in range(60)),
        r"thousands or decimals.*import\.decimal",
    ),
    "comma for both": (table(body=[line.replace(".", ",") for line in lines()]), "comma seems to stand between cells and in numbers"),
    "told column missing": (table(), "import.force: no column is called so", {"columns": {"force": "Kraft:N"}}),
    "told place missing": (table(), "import.force: no column is called so", {"columns": {"force": "#9:N"}}),
    "told unit wrong": (table(), r"'mm' is no unit of the force.*import\.force", {"columns": {"force": "Force:mm"}}),
    "told unit nonsense": (table(), "'blub' is no unit of the depth", {"columns": {"depth": "Distance:blub"}}),
    "told name empty": (table(), r"import\.force = '-'; allowed: \"COLUMN\"", {"columns": {"force": "-"}}),
    "told sheet missing": (table(), "no sheet 'Probe 7'", {"sheets": ("Probe 7",)}),
    "told encoding wrong": ("Zeit (s);Weg (mm);Kraft (N) ü\n", "no ascii text.*import.encoding", {"encoding": "ascii"}),
    "told encoding unknown": (table(), "no utf-9 text.*import.encoding", {"encoding": "utf-9"}),
    "names and units exchanged": (
        table("Time (s),Depth (N),Force (mm)"),
        r"names and units contradict.*units are right, --set import\.force=\"#2:N\".*import\.depth=\"#3:mm\".*names are, .*\"#3:N\"",
    ),
    "days in words": (
        "Time;Distance (mm);Force (N)\n" + "\n".join(f"1 Mar {t:05.2f};{d:.4f};{f:.5f}" for t, d, f in zip(T, D, F, strict=True)),
        r"row 2, column 'Time'.*no cell of the column is a number.*12:00:01.50.*import\.rate",
    ),
    "mostly no numbers": (
        table(body=[line if k < 30 else "no" + line[line.index(","):] for k, line in enumerate(lines())]),
        r"cells of the time are no numbers.*import\.rate",
    ),
    "two decimal signs": (
        "Time (s);Distance (mm);Force (N)\n" + "\n".join(f"{t:.3f};{d:.4f};{f:.5f}".replace(".", ",", 1) for t, d, f in zip(T, D, F, strict=True)),
        r"column 'Time'.*the number has the decimal sign ',', others have '\.'",
    ),
    "totals in the last row": (
        table(body=[*lines(), f"{T.sum():.3f},{D.sum():.4f},{F.sum():.5f}"]),
        r"the last row holds the sums of the columns Distance and Force|the last row holds the sums of the columns Force and Distance",
    ),
    "units in columns of their own": (
        "Time,,Distance,,Force,\n" + "\n".join(f"{t:.3f},s,{d:.4f},mm,{f:.5f},N" for t, d, f in zip(T, D, F, strict=True)),
        r"row 2.*no columns of units beside the numbers: take them out",
    ),
    "stress without area": (
        columns(T, D, F, head="Time (s),Strain (%),Stress (kPa)", digits=(3, 5, 6)), r"height and area.*import\.height",
    ),
    "strain without height": (
        columns(T, D, F, head="Time (s),Strain (%),Force (N)", digits=(3, 5, 6)),
        r"strain needs the specimen's height and area.*import\.height",
    ),
    "stress over displacement without area": (
        columns(T, D, F, head="Time (s),Distance (mm),Stress (kPa)", digits=(3, 5, 6)),
        r"stress needs the specimen's area.*import\.area",
    ),
    "stress with height alone": (
        columns(T, D, F, head="Time (s),Strain (%),Stress (kPa)", digits=(3, 5, 6)), r"area.*import\.area", {"height": 0.01},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", TEXTS)
def test_a_text_is_refused_with_the_way_out(tmp_path, name):
    text, reason, *told = TEXTS[name]
    path = tmp_path / "export.csv"
    path.write_text(text, encoding="utf-8")
    refused(path, reason, Told(**told[0]) if told else None)


def refused(path, reason, told=None):
    before = sorted(path.parent.iterdir())
    with pytest.raises(InputError, match=f"(?s){reason}") as caught:
        read_instrument_file(path, told)
    text = str(caught.value)
    assert "\n" not in text
    assert "allowed" in text
    assert sorted(path.parent.iterdir()) == before
    if "import." not in text.partition(":")[0]:
        assert path.name in text or "import." in text


def broken(path, data):
    path.write_bytes(data)
    return path


BINARIES = {
    "a pipe of zeros": ("a.csv", b"\0\1\2\3" * 50, "no text and no format"),
    "a NanoScope file without a curve": (
        "a.spm",
        b"\\*File list\r\n\\Version: 0x09300201\r\n\\*File list end\r\n\x1a".ljust(8000, b"\0"),
        "holds no force curve",
    ),
    "a NanoScope file under another name": (
        "a.dat",
        b"\\*Force file list\r\n\\Version: 0x09300201\r\n\x1a".ljust(8000, b"\0"),
        "Bruker NanoScope.*ending '.dat'.*NAME.spm",
    ),
    "noughts that are no letters": ("a.dat", b"log\r\n" + b"\0" * 5000, "no text and no format"),
    "utf-16 cut in a letter": ("a.csv", table().encode("utf-16")[:201], "breaks off"),
    "a workbook that is text": ("a.xlsx", table().encode(), "no whole Excel workbook"),
    "an empty workbook": ("a.xlsx", b"", "no whole Excel workbook"),
    "a zs2 that is no gzip": ("a.zs2", b"abc", "no whole testXpert file"),
    "a zs2 without its mark": ("a.zs2", gzip.compress(b"nothing of the kind"), "no whole testXpert file"),
    "a TDMS file that is text": ("a.tdms", table().encode(), "no whole TDMS file"),
    "a curve that is no zip": ("a.jpk-force", b"abc", "no whole atomic-force curve"),
    "a MATLAB file that is text": ("a.mat", table().encode(), "no whole MATLAB file"),
    "a MATLAB file of version 7.3 that is cut": ("a.mat", b"MATLAB 7.3 MAT-file".ljust(128), "no whole MATLAB file"),
    "a Parquet file cut": ("a.parquet", b"PAR1abc", "no whole Parquet file"),
}


@pytest.mark.parametrize("name", BINARIES)
def test_a_damaged_container_is_refused(tmp_path, name):
    file, data, reason = BINARIES[name]
    refused(broken(tmp_path / file, data), f"{reason}|is not installed")


def test_a_workbook_cut_in_half_is_refused(tmp_path):
    whole = samples.exponent_xlsx(tmp_path).read_bytes()
    refused(broken(tmp_path / "cut.xlsx", whole[: len(whole) // 2]), "no whole Excel workbook|is not installed")


@pytest.mark.parametrize("share", [0.5, 0.9])
def test_a_tdms_file_that_breaks_off_is_refused(tmp_path, share):
    pytest.importorskip("nptdms", reason="needs npTDMS to write the file")
    whole = samples.tdms(tmp_path).read_bytes()
    refused(broken(tmp_path / "cut.tdms", whole[: int(share * len(whole))]), "no whole TDMS file: it breaks off")


CURVES = {
    "breaks off": (lambda raw: raw[:4200], "in a file of 4200 bytes"),
    "has a map": (
        lambda raw: raw.replace(b"\\*Ciao force list", b"\\*Ciao image list\r\n\\*Ciao force list"),
        "a map of force",
    ),
    "has no spring constant": (lambda raw: raw.replace(b"Spring Constant", b"Spring Konstante"), "spring constant"),
    "has no deflection": (lambda raw: raw.replace(b"Deflection", b"Friction"), "no channel is the deflection"),
    "has no scale": (lambda raw: raw.replace(b" (0.0003750000 V/LSB)", b""), "'@Z scale' says"),
    "has a scale of other counts": (lambda raw: raw.replace(b"0.0003750000", b"37.500000000"), "more than 100 V"),
    "has no sensitivity": (lambda raw: raw.replace(b"@Sens. DeflSens", b"@Sens. Other"), "'@Sens. DeflSens' says ''"),
    "has strange units": (lambda raw: raw.replace(b"50.00000 nm/V", b"50.00000 kg/V"), "has the unit 'kg/V'"),
}


@pytest.mark.parametrize("name", CURVES)
def test_a_force_curve_that_cannot_be_read_says_why(tmp_path, name):
    change, reason = CURVES[name]
    raw = samples.nanoscope(tmp_path).read_bytes()
    head, data = raw[:4096].rstrip(b"\0"), raw[4096:]
    whole = (change(head) if name != "breaks off" else head).ljust(4096, b"\0") + data
    refused(broken(tmp_path / "bad.000", change(whole) if name == "breaks off" else whole), reason)


def test_a_workbook_without_a_record_lists_what_it_has(tmp_path):
    pytest.importorskip("python_calamine")
    sheets = {"Results": [["Probe", "h0"], ["", "mm"], ["A", 12.0], ["B", 12.5]]}
    refused(samples.workbook(tmp_path / "a.xlsx", sheets), "rows of numbers")


def test_a_word_in_a_workbook_is_named_with_row_and_column(tmp_path):
    pytest.importorskip("python_calamine")
    rows = [[t, d, f] for t, d, f in zip(T, D, F, strict=True)]
    rows[7][2] = "ovl"
    sheets = {"Data": [["Time (s)", "Distance (mm)", "Force (N)"], *rows]}
    refused(samples.workbook(tmp_path / "a.xlsx", sheets), "row 9, column 'Force', value 'ovl'")


def test_a_zip_of_something_else_is_no_workbook(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.xlsx", "w") as archive:
        archive.writestr("hello.txt", "hello")
    refused(tmp_path / "a.xlsx", "no whole Excel workbook|is not installed")


def test_a_folder_a_missing_file_and_a_pipe_are_refused(tmp_path):
    (tmp_path / "a.csv").mkdir()
    refused(tmp_path / "a.csv", "cannot be read")
    refused(tmp_path / "b.csv", "cannot be read")


def test_there_are_sixty_of_them():
    assert len(TEXTS) + len(BINARIES) + 6 >= 60
