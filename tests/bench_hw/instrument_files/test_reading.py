"""Each instrument's file is read as it is: the press that was written is found, and what was decided is told."""

import importlib.util

import numpy as np
import pytest

from bench_hw.errors import TableError
from bench_hw.instrument_files import Told, preview, read_instrument_file
from bench_hw.instrument_files.press_record import first_touch, phases
from bench_hw.instrument_files.text_sheet import number_text
from bench_hw.instrument_files.told import asking_key
from bench_hw.instrument_files.vocabulary import clock_seconds, label_and_unit, role_of
from bench_hw.tables import TrialTable
from tests.instruments import samples
from tests.instruments.samples import SAMPLES, press


@pytest.fixture(params=SAMPLES)
def sample(request):
    found = SAMPLES[request.param]
    if found.library and importlib.util.find_spec(found.library) is None:
        pytest.skip(f"{found.library} is not installed")
    return found


def test_the_press_that_was_written_is_found(sample, tmp_path):
    read = read_instrument_file(sample.write(tmp_path))
    assert len(read.records) == sample.trials
    for record in read.records:
        table = record.table
        assert table.depth.max() == pytest.approx(sample.depth, rel=0.02)
        assert table.force.max() == pytest.approx(sample.force, rel=0.01)
        within = table.depth > 0.1 * sample.depth
        rising = within & (np.arange(table.depth.size) < np.argmax(table.force))
        law = sample.force * (table.depth[rising] / sample.depth) ** 1.5
        np.testing.assert_allclose(table.force[rising], law, atol=0.04 * sample.force)
        assert abs(float(np.median(table.force[table.depth < -0.1 * sample.depth]))) < 1e-3 * sample.force


def test_headers_tell_of_tool_and_specimen(sample, tmp_path):
    header = read_instrument_file(sample.write(tmp_path)).header
    assert header.tool_radius == (None if sample.radius is None else pytest.approx(sample.radius))
    assert header.height == (None if sample.height is None else pytest.approx(sample.height))


@pytest.mark.parametrize(
    "line",
    [
        "Specimen height: 18 mm",
        "height=18 mm",
        "Height = 18 mm",
        "Sample height; 18 mm",
        "# thickness = 1.8 cm",
        "Thickness (mm) = 18",
        "Specimen height,18,mm",
    ],
)
def test_a_header_tells_the_height_however_key_and_value_are_parted(line, tmp_path):
    one = press()
    rows = samples.rows(one.time, one.depth, one.force, digits=(3, 5, 6))
    (tmp_path / "a.csv").write_text("\n".join([line, "Time (s),Displacement (mm),Load (N)", *rows]))
    assert read_instrument_file(tmp_path / "a.csv").header.height == pytest.approx(18e-3)


def test_everything_that_was_decided_is_shown(sample, tmp_path):
    read = read_instrument_file(sample.write(tmp_path))
    text = "\n".join(preview(read))
    for record in read.records:
        assert {"force", "depth"} <= set(record.columns)
        assert all(shown in text for shown in record.columns.values())
        assert all(note in text for note in record.notes)
    assert all(source in text for source in read.header.sources)


def test_a_hold_and_cycles_are_recognised(tmp_path):
    many = press(cycles=4, rate=25.0)
    path = tmp_path / "cycles.csv"
    lines = (f"{t:.3f},{d:.5f},{f:.5f}" for t, d, f in zip(many.time, many.depth, many.force, strict=True))
    path.write_text("\n".join(["Time (s),Displacement (mm),Force (N)", *lines]))
    (record,) = read_instrument_file(path).records
    presses, dwell = phases(record.table)
    assert (presses, dwell) == (4, pytest.approx(2.0, abs=0.1))


@pytest.mark.parametrize("noise", [0.0, 1e-4, 1e-3, 5e-3, 0.01])
@pytest.mark.parametrize(("hold", "rate"), [(400.0, 1.0), (10.0, 20.0), (10.0, 500.0), (1.0, 200.0)])
def test_a_hold_is_seen_through_the_depths_noise(hold, rate, noise):
    """0.5 um of noise in a press of 0.4 mm had left 37 of 397 s, and `session new` made a condition of each trial."""
    time = np.arange(0.0, 8.0 + hold, 1.0 / rate)
    depth = 4e-4 * np.interp(time, [0.0, 4.0, 4.0 + hold, 8.0 + hold], [0.0, 1.0, 1.0, 0.0])
    depth += 4e-4 * noise * np.random.default_rng(3).normal(size=time.size)
    _, dwell = phases(TrialTable(time, depth, np.zeros_like(time), {}, "", {}))
    assert dwell == pytest.approx(hold, rel=0.05, abs=4.0 / rate + 40.0 * noise)


@pytest.mark.parametrize("noise", [0.0, 1e-3, 0.015])
@pytest.mark.parametrize("seed", range(5))
def test_a_press_without_a_hold_has_none(noise, seed):
    """A turn of the tool is none, either: presses of one protocol would be of two."""
    time = np.linspace(0.0, 4.0, 400)
    depth = 1e-3 * np.interp(time, [0.0, 2.0, 4.0], [0.0, 1.0, 0.0])
    depth += 1e-3 * noise * np.random.default_rng(seed).normal(size=time.size)
    assert phases(TrialTable(time, depth, np.zeros_like(time), {}, "", {}))[1] <= 0.05


def test_stress_and_strain_are_labelled_as_of_a_block(tmp_path):
    one = press()
    lines = (f"{t:.3f},{-d:.5f},{-f:.6f}" for t, d, f in zip(one.time, one.depth + 0.5, one.force, strict=True))
    path = tmp_path / "block.csv"
    path.write_text("\n".join(["Time (s),Compressive strain (%),Compressive stress (kPa)", *lines]))
    (record,) = read_instrument_file(path, Told(height=0.01, area=1e-4)).records
    assert record.kind == "compression"
    assert any("compression of a cylinder or block" in note for note in record.notes)
    assert record.table.force.max() == pytest.approx(1e3 * one.force.max() * 1e-4, rel=0.01)
    assert np.ptp(record.table.depth) == pytest.approx(np.ptp(one.depth) * 1e-2 * 0.01, rel=1e-3)


def test_what_is_told_comes_before_what_is_found(tmp_path):
    one = press()
    path = tmp_path / "two.csv"
    cells = zip(one.time, one.depth, one.depth * 25.4, -one.force, one.force * 2, strict=True)
    lines = (",".join(f"{cell:.6f}" for cell in row) for row in cells)
    path.write_text("\n".join(["t [s],Displacement 1 [mm],Other,Cell A [N],Cell B [N]", *lines]))
    told = Told({"depth": "Other:thou", "force": "-Cell A"}, touch="none")
    (record,) = read_instrument_file(path, told).records
    np.testing.assert_allclose(record.table.depth, one.depth * 25.4 * 25.4e-6, atol=1e-9)
    np.testing.assert_allclose(record.table.force, one.force, atol=1e-6)


def labview(path, heading="X_Value\tForce\tDisplacement\tComment", sign="."):
    """LabVIEW's measurement file: two blocks of header, units apart from the names, a column for remarks."""
    one = press()
    head = ["LabVIEW Measurement\t", "Writer_Version\t2", "Separator\tTab", f"Decimal_Separator\t{sign}",
            "Multi_Headings\tNo", "X_Columns\tOne", "Date\t2024/05/06", "***End_of_Header***\t", "\t",
            "Channels\t2\t\t", f"Samples\t{one.time.size}\t{one.time.size}\t", "Time\t10:11:12.1\t10:11:12.1\t",
            "Y_Unit_Label\tN\tmm\t", "Delta_X\t0.02\t0.02\t", "***End_of_Header***\t\t\t", heading]  # fmt: skip
    cells = zip(one.time, one.force, one.depth, strict=True)
    lines = ("\t".join(f"{cell:.6f}".replace(".", sign) for cell in row) + "\t" for row in cells)
    path.write_text("\n".join([*head, *lines]))
    return path


@pytest.mark.parametrize("sign", [".", ","])
def test_a_measurement_of_labview_is_read_as_text_once_its_columns_are_told(tmp_path, sign):
    path = labview(tmp_path / "a.lvm", sign=sign)
    with pytest.raises(TableError, match=r"unit of the force stands neither .* --set import\.force=\"Force:N\""):
        read_instrument_file(path)
    told = Told({"time": "X_Value:s", "depth": "Displacement:mm", "force": "Force:N"}, touch="none")
    (record,) = read_instrument_file(path, told).records
    one = press()
    np.testing.assert_allclose(record.table.force, one.force, atol=1e-6)
    np.testing.assert_allclose(record.table.depth, 1e-3 * one.depth, atol=1e-9)


def test_a_measurement_of_labview_with_units_in_its_names_needs_nothing_told_but_the_time(tmp_path):
    path = labview(tmp_path / "a.lvm", "X_Value\tForce (N)\tDisplacement (mm)\tComment")
    (record,) = read_instrument_file(path, Told({"time": "X_Value:s"})).records
    assert record.table.force.max() == pytest.approx(press().force.max(), rel=0.01)


def cylinder_text(head, units, unit_row="(s){0}(mm){0}(N){0}(%){0}(kPa)", between=",", sign="."):
    """A cylinder, 10 mm high and 100 mm2 wide, with the stress and strain that the instrument wrote beside."""
    one = press()
    depth, force = one.depth - one.depth[0], one.force - one.force.min()
    columns = (one.time, depth, force, 10.0 * depth, 10.0 * force)
    lines = samples.rows(*columns, digits=(3, 6, 6, 6, 6), sign=sign, between=between)
    return "\n".join([head, unit_row.format(between) if units else "", *lines]) + "\n"


def test_height_and_section_are_told_by_what_columns_were_divided_by(tmp_path):
    path = tmp_path / "cylinder.csv"
    path.write_bytes(cylinder_text("时间,位移,载荷,压缩应变 (位移),压缩应力", units=True).encode("gbk"))
    read = read_instrument_file(path)
    assert read.header.height == pytest.approx(10e-3, rel=1e-3)
    assert read.header.area == pytest.approx(100e-6, rel=1e-3)
    assert read.records[0].kind == "compression"
    assert any("载荷 over 压缩应力: 100 mm2" in source for source in read.header.sources)


@pytest.mark.parametrize(
    ("head", "encoding", "between", "sign", "kind"),
    [
        ("Zeit;Traversenweg;Last;Dehnung 1;Zugspannung", "cp1252", ";", ",", "tension"),
        ("Godzina;Przemieszczenie;Obciążenie;Odkształcenie 1;Naprężenie", "cp1250", ";", ",", "press"),
    ],
)
def test_german_and_polish_words_are_known(head, encoding, between, sign, kind, tmp_path):
    path = tmp_path / "machine.csv"
    path.write_bytes(cylinder_text(head, units=True, between=between, sign=sign).encode(encoding))
    (record,) = read_instrument_file(path).records
    assert record.kind == kind
    assert record.columns["force"] in ("Last [N]", "Obciążenie [N]")
    if kind == "tension":
        assert record.table.depth[0] == 0.0
        assert not any("first touch" in note for note in record.notes)


def test_h0_is_a_height_and_d0_a_diameter(tmp_path):
    one = press()
    columns = zip(one.time, one.depth, one.force, strict=True)
    sheets = {
        "Results": [["", "Fmax", "h0", "d0"], ["", "N", "mm", "mm"], ["Specimen 1", 8.4, 12.0, 20.0]],
        "Specimen 1": [["Test time", "Deformation", "Standard force"], ["s", "mm", "N"], *map(list, columns)],
    }
    header = read_instrument_file(samples.workbook(tmp_path / "results.xlsx", sheets)).header
    assert header.height == pytest.approx(12e-3)
    assert header.area == pytest.approx(np.pi * 10e-3**2)


def test_a_gap_that_falls_is_a_depth(tmp_path):
    one = press()
    lines = samples.rows(one.time, 12.0 - one.depth, -1e3 * one.force, digits=(3, 5, 3), sign=",", between=";")
    path = tmp_path / "gap.csv"
    path.write_bytes("\r\n".join(["Zeit [s];Spaltmaß [mm];Kraft [mN]", *lines]).encode("utf-16-le"))
    (record,) = read_instrument_file(path).records
    assert record.table.depth.max() == pytest.approx(2e-3, rel=0.02)
    assert record.table.force.max() == pytest.approx(one.force.max(), rel=1e-3)


def test_the_number_of_a_column_is_no_unit():
    assert label_and_unit("Dehnung 1") == ("Dehnung 1", "")
    assert label_and_unit("Strain (1)") == ("Strain", "1")


@pytest.mark.parametrize(
    ("header", "role"),
    [
        ("Compressive strain (Extension)", "strain"),
        ("Tensile strain (Strain 1)", "strain"),
        ("Engineering stress (MPa)", "stress"),
        ("Nominelle Stauchung [%]", "strain"),
        ("Stauchung [%]", "strain"),
        ("Stauchung [mm]", "displacement"),
        ("Standardweg [%]", "strain"),
        ("Traversenweg absolut [mm]", "displacement"),
        ("Grip to grip separation [mm]", "displacement"),
        ("Elongation (mm)", "displacement"),
        ("Kuvvet (N)", "force"),
        ("Uzama (mm)", "displacement"),
        ("Gerilme (N/mm2)", "stress"),
        ("経過時間", "time"),
        ("つかみ具間変位", "displacement"),
        ("応力", "stress"),
        ("Spostamento [mm]", "displacement"),
        ("Weg/mm", "displacement"),
        ("Kraft/mN", "force"),
        ("Spannung/N/mm2", "stress"),
        ("Allongement", "displacement"),
        ("Enfoncement (mm)", "depth"),
        ("Profondeur d'indentation [mm]", "depth"),
        ("Pénétration (mm)", "depth"),
    ],
)
def test_names_that_makers_write_are_known(header, role):
    meaning = role_of(*label_and_unit(header))
    assert meaning is not None
    assert meaning[0] == role


FACES = "h0;12;mm\nd0;20;mm\n\n"


@pytest.mark.parametrize(
    ("head", "units", "kind", "depth", "force"),
    [
        ("Prüfzeit;Dehnung;Standardkraft", "s;%;N", "tension", 0.12 * 2.5e-3, 8.485),
        ("Prüfzeit;Stauchung;Druckspannung", "s;%;kPa", "compression", 0.12 * 2.0e-3, 8.485e3 * np.pi * 1e-4),
        ("Test time;Displacement;Compressive stress", "s;mm;kPa", "compression", 2e-3, 8.485e3 * np.pi * 1e-4),
    ],
)
def test_force_over_strain_and_stress_over_displacement_are_of_a_block(head, units, kind, depth, force, tmp_path):
    one = press()
    lines = samples.rows(one.time, one.depth + 0.5, one.force, digits=(3, 5, 6), between=";")
    path = tmp_path / "block.csv"
    path.write_text("\n".join([FACES + head, units, *lines]))
    (record,) = read_instrument_file(path).records
    assert record.kind == kind
    assert record.table.depth.max() == pytest.approx(depth, rel=0.02)
    assert record.table.force.max() == pytest.approx(force, rel=0.01)


def test_where_the_tool_touches_is_told_as_the_file_counts_it(tmp_path):
    one = press()
    lines = samples.rows(one.time, 12.0 - one.depth, one.force, digits=(3, 5, 6))
    path = tmp_path / "gap.csv"
    path.write_text("\n".join(["Time (s),Gap (mm),Force (N)", *lines]))
    (record,) = read_instrument_file(path).records
    assert "depth is counted from the first touch, at 12 mm of the file" in record.notes


def test_a_tra_file_is_a_trial_of_its_folder(tmp_path):
    from benchmark.files.sessions.session_folder import TRIAL_SUFFIXES

    path = samples.zwick_text(tmp_path).rename(tmp_path / "Probe1.TRA")
    assert path.suffix.lower() in TRIAL_SUFFIXES
    assert len(read_instrument_file(path).records) == 1


def test_a_force_curve_by_its_height_sensor_and_from_the_far_end(tmp_path):
    raw = samples.nanoscope(tmp_path).read_bytes()
    (one,) = read_instrument_file(tmp_path / "gel.003").records
    head, counts = raw[:4096].rstrip(b"\0"), np.frombuffer(raw[4096:], "<i2")
    half = counts.size // 2
    bend = counts * 0.000375 * 50e-9
    stage = np.tile(np.interp(np.arange(half), [0, half - 1], [2.6e-6, 0.0]), 2)
    turned = [np.concatenate([each[:half][::-1], each[half:][::-1]]) for each in (bend, stage)]
    data = [
        np.round(each / 0.000375 / metres).astype("<i2").tobytes()
        for each, metres in zip(turned, (50e-9, 400e-9), strict=True)
    ]
    image = head[head.index(b"\\*Ciao force image list") : head.index(b"\\*File list end")]
    second = image.replace(b"DeflSens", b"ZsensSens").replace(b"Deflection Error", b"Height Sensor")
    second = second.replace(b"Data offset: 4096", b"Data offset: %d" % (4096 + len(data[0])))
    head = head.replace(b"\\*File list end", second + b"\\*File list end")
    head = head.replace(b"\\*Ciao force list", b"\\@Sens. ZsensSens: V 400.00000 nm/V\r\n\\*Ciao force list")
    path = tmp_path / "sensor.spm"
    path.write_bytes(head.ljust(4096, b"\0") + b"".join(data))
    (other,) = read_instrument_file(path).records
    assert other.table.force.max() == pytest.approx(one.table.force.max(), rel=1e-9)
    assert other.table.time[-1] == pytest.approx(one.table.time[-1])
    assert np.ptp(other.table.depth) == pytest.approx(2.6e-6 - np.ptp(bend), rel=1e-3)


def test_numbered_curves_are_trials_of_their_folder(tmp_path):
    from benchmark.files.sessions.session_folder import _trial_files

    raw = samples.nanoscope(tmp_path).read_bytes()
    (tmp_path / "gel.004").write_bytes(raw)
    assert [each["file"] for each in _trial_files(tmp_path)] == ["gel.003", "gel.004"]


def test_the_one_trial_of_a_report_has_no_number(tmp_path):
    (record,) = read_instrument_file(samples.bluehill_report(tmp_path)).records
    assert record.name == ""


def ramp(path, lead, law=1.0):
    """A press of 2 mm at 1 mm/s with 1 N at its end, from `lead` mm above the surface, and 0.3 mN of noise."""
    depth = np.linspace(-lead, 2.0, 400)
    force = np.clip(depth / 2.0, 0.0, None) ** law + 3e-4 * np.random.default_rng(5).normal(size=400)
    rows = (f"{0.01 * n:.3f};{d:.6f};{f:.6f}" for n, (d, f) in enumerate(zip(depth, force, strict=True)))
    path.write_text("\n".join(["time [s];depth [mm];force [N]", *rows]))
    (record,) = read_instrument_file(path).records
    return record


def test_a_record_that_begins_in_contact_has_no_air(tmp_path):
    """Its rise was taken for noise in air: 0.2 mm of its depth and a fiftieth of its force were taken off."""
    record = ramp(tmp_path / "a.csv", lead=0.0)
    assert record.notes == ()
    assert record.table.depth.max() == pytest.approx(2e-3, abs=1e-9)
    assert record.table.force.max() == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize("rows", [60, 400, 4000])
@pytest.mark.parametrize("law", [1.0, 1.5, 2.0, "exponential"])
def test_a_force_that_begins_flat_where_the_record_does_has_no_air(rows, law):
    """A tool that touches at the first row: Hertz's law lost 4 % of its depth, an exponential one 20 %."""
    share = np.linspace(0.0, 1.0, rows)
    force = np.expm1(4.8 * share) / np.expm1(4.8) if law == "exponential" else share**law
    row, _ = first_touch(TrialTable(0.01 * np.arange(rows), 2e-3 * share, force, {}, "press", {}))
    assert row == 0


@pytest.mark.parametrize("rows", [60, 400])
def test_the_touch_of_an_exponential_force_is_found_after_some_air(rows):
    """It was put at a quarter of the press, where the force had risen by half a percent of its peak."""
    share = np.linspace(-0.1, 1.0, rows)
    force = np.expm1(4.8 * np.clip(share, 0.0, None)) / np.expm1(4.8)
    row, level = first_touch(TrialTable(0.01 * np.arange(rows), 2e-3 * share, force, {}, "press", {}))
    assert abs(share[row]) < 0.03
    assert level == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize(("lead", "law"), [(0.05, 1.0), (0.2, 1.0), (1.0, 1.0), (0.2, 1.5), (1.0, 1.5)])
def test_the_touch_is_found_after_little_air_as_well(tmp_path, lead, law):
    record = ramp(tmp_path / "a.csv", lead=lead, law=law)
    assert record.table.depth.max() == pytest.approx(2e-3, abs=0.04e-3)
    assert record.table.force.max() == pytest.approx(1.0, abs=4e-3)


@pytest.mark.parametrize(("law", "off"), [(1.0, 0.03e-3), (1.5, 0.1e-3), (2.0, 0.2e-3)])
@pytest.mark.parametrize("lead", [0.3, 1.0])
def test_the_touch_is_found_through_noise(lead, law, off):
    """A hundredth of the peak of noise hid the touch of a force that begins flat by 0.1, 0.3 and 0.5 mm."""
    depth = np.concatenate([np.linspace(-lead, 2.0, 4000), np.linspace(2.0, -lead, 4000)]) * 1e-3
    clean = np.clip(depth / 2e-3, 0.0, None) ** law
    for seed in range(5):
        force = clean + 0.01 * np.random.default_rng(seed).normal(size=depth.size)
        row, level = first_touch(TrialTable(0.01 * np.arange(depth.size), depth, force, {}, "press", {}))
        assert abs(depth[row]) < off
        assert level == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize(
    ("key", "example", "asked"),
    [
        ("rate", "100 Hz", "--set import.rate=\"100 Hz\" (bench_hw import: --rate '100 Hz')"),
        ("drop_empty", "true", '--set import.drop_empty="true" (bench_hw import: --drop-empty)'),
        ("delimiter", "tab", '--set import.delimiter="tab" (bench_hw import: --delimiter tab)'),
        ("height", "10 mm", '--set import.height="10 mm"'),
    ],
)
def test_what_is_asked_for_can_be_typed_as_it_stands(key, example, asked):
    """It named options that `bench_hw import` has not, and values with blanks that a shell takes apart."""
    assert asking_key(key, example) == asked


def test_rows_without_a_number_do_not_end_a_record(tmp_path):
    """A row of NaN amid a press was taken for the names of another table: all behind it was left aside."""
    press = samples.press(rate=20.0, hold=0.5)
    rows = samples.rows(press.time, press.depth, press.force, digits=(3, 5, 6))
    path = tmp_path / "a.csv"
    path.write_text(
        "\n".join(["Time (s),Distance (mm),Force (N)", *rows[:30], "NaN,NaN,NaN", *rows[31:], "NaN,NaN,NaN"])
    )
    (record,) = read_instrument_file(path, Told(drop_empty=True)).records
    assert len(record.table.time) == len(rows) - 1
    assert record.table.force.max() == pytest.approx(press.force.max(), rel=1e-3)


def test_a_glitch_of_one_row_does_not_tell_which_way_is_pressing(tmp_path):
    """A row of 9999.9 N on the way back turned nothing here, but put the touch there: 2 mm of depth were 0.3."""
    press = samples.press(rate=20.0, hold=0.5)
    force = press.force.copy()
    force[int(0.7 * len(force))] = 9999.9
    path = tmp_path / "a.csv"
    rows = samples.rows(press.time, press.depth, force, digits=(3, 5, 6))
    path.write_text("\n".join(["Time (s),Distance (mm),Force (N)", *rows]))
    (record,) = read_instrument_file(path).records
    assert record.table.depth.max() == pytest.approx(press.depth.max() * 1e-3, rel=0.02)


def test_what_is_told_beside_what_the_file_says_is_shown(tmp_path):
    """A rate beside a column of times halved them, a unit beside the header's took its place, without a word."""
    one = press()
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Time (s),Distance (mm),Force (N)",
                               *samples.rows(one.time, one.depth, one.force, digits=(3, 5, 6))]))  # fmt: skip
    (record,) = read_instrument_file(path, Told({"force": "Force:mN", "depth": "Distance:mm"}, rate=100.0)).records
    assert record.notes[:2] == (
        "times are counted at 100 Hz, as told, not read from the file's own column 'Time'",
        "the force is read in mN, as told, where the file says N",
    )


def test_a_minus_sign_of_typesetting_is_a_minus(tmp_path):
    """Programs write it under Scandinavian settings: all rows above the touch were no numbers."""
    one = press()
    rows = samples.rows(one.time, one.depth, one.force, digits=(3, 5, 6), sign=",", between=";")
    path = tmp_path / "a.csv"
    text = "\n".join(["Time (s);Distance (mm);Force (N)", *(row.replace("-", "\N{MINUS SIGN}") for row in rows)])
    path.write_text(text, encoding="utf-8")
    (record,) = read_instrument_file(path).records
    assert len(record.table.time) == one.time.size


DAYS = {
    "a day": ("Date", "2024-03-01 12:00:{:06.3f}"),
    "as programs write it": ("timestamp", "2024-03-01T12:00:{:06.3f}Z"),
    "German": ("Zeit", "01.03.2024 12:00:{:06.3f}"),
    "American": ("Time", "3/1/2024 12:00:{:06.3f} PM"),
    "a clock": ("Time", "12:00:{:06.3f}"),
}


@pytest.mark.parametrize("name", DAYS)
def test_times_of_the_clock_need_no_unit_and_begin_at_zero(tmp_path, name):
    """A day before the clock was no number: rows without numbers were to be left out, which left none."""
    one, (head, clock) = press(), DAYS[name]
    rows = [f"{clock.format(t)};{d:.5f};{f:.5f}" for t, d, f in zip(one.time, one.depth, one.force, strict=True)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join([f"{head};Distance (mm);Force (N)", *rows]), encoding="utf-8")
    (record,) = read_instrument_file(path).records
    assert record.table.time == pytest.approx(one.time - one.time[0], abs=1e-3)
    assert any(note.startswith("times are counted from its first, ") for note in record.notes)


def test_days_carry_a_clock_over_midnight():
    before, after = clock_seconds("2024-02-29 23:59:59.5"), clock_seconds("2024-03-01 00:00:00.5")
    assert after - before == pytest.approx(1.0)
    assert clock_seconds("29.02.2024 23:59:59,5") == before
    assert clock_seconds("1:00:00 pm") == 13 * 3600.0
    for text in ("2024-13-01 12:00:00", "12", "Mar 1 12:00:00", "12:00"):
        assert clock_seconds(text) in (None, 720.0)


def test_where_no_row_is_one_as_told_what_was_told_is_named(tmp_path):
    one = press()
    rows = samples.rows(one.time, one.depth, one.force, digits=(3, 5, 6), sign=",", between=";")
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Time (s);Distance (mm);Force (N)", *rows]))
    with pytest.raises(TableError, match=r"no rows of numbers were found with the decimal sign '\.', as told"):
        read_instrument_file(path, Told(decimal="."))


@pytest.mark.parametrize(
    "mark", ["'", "\N{RIGHT SINGLE QUOTATION MARK}", "\N{NARROW NO-BREAK SPACE}", "\N{NO-BREAK SPACE}"]
)
def test_marks_between_thousands_are_passed_over(tmp_path, mark):
    """Such numbers were called none, and the way out that was named left out all rows above 1000 mN."""
    one = press()
    rows = [
        f"{t:.2f};{d:.4f};{1e3 * f:,.1f}".replace(",", mark)
        for t, d, f in zip(one.time, one.depth, one.force, strict=True)
    ]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Time (s);Distance (mm);Force (mN)", *rows]), encoding="utf-8")
    (record,) = read_instrument_file(path).records
    assert record.table.force.max() == pytest.approx(one.force.max(), rel=1e-3)


def large(
    path, written, *, sign=",", between=";", mark="", head=("Time (s)", "Distance (um)", "Force (mN)"), units=("",) * 3
):
    """The press in um and mN, from 1 mm of the actuator and 1 N of load on, so that most cells have thousands."""
    lines = []
    for cells in zip(written.time, 1e3 * (written.depth + 2.0), 1e3 * (written.force + 2.0), strict=True):
        texts = (f"{cell:,.3f}".translate({44: mark, 46: sign}) for cell in cells)
        lines.append(between.join(text + unit for text, unit in zip(texts, units, strict=True)))
    path.write_text("\n".join([between.join(head), *lines]) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("mark", [" ", "\N{THIN SPACE}", "\N{FIGURE SPACE}", "\N{NO-BREAK SPACE}"])
@pytest.mark.parametrize(("between", "sign"), [(";", ","), ("\t", ","), (",", "."), ("\t", ".")])
def test_blanks_between_thousands_are_passed_over(tmp_path, mark, between, sign):
    """They were no numbers, or between tabs the signs between cells: 1 234,5 was two columns."""
    path = large(tmp_path / "a.csv", press(), sign=sign, between=between, mark=mark)
    (record,) = read_instrument_file(path).records
    assert np.ptp(record.table.force) == pytest.approx(np.ptp(press().force), rel=1e-3)
    assert np.ptp(record.table.depth) == pytest.approx(1e-3 * np.ptp(press().depth), rel=1e-3)


def test_decimal_commas_with_blanks_between_cells_are_no_thousands(tmp_path):
    one = press()
    rows = samples.rows(one.time, 100.0 * one.depth, one.force, digits=(2, 1, 3), sign=",", between=" ")
    path = tmp_path / "a.txt"
    path.write_text("\n".join(["Time_s Distance_um Force_N", *rows]))
    (record,) = read_instrument_file(path).records
    assert np.ptp(record.table.depth) == pytest.approx(1e-4 * np.ptp(one.depth), rel=1e-3)
    assert np.ptp(record.table.force) == pytest.approx(np.ptp(one.force), rel=1e-3)


@pytest.mark.parametrize("peak", [0.9, 1.2])
def test_three_decimals_behind_a_comma_are_no_thousands(tmp_path, peak):
    """A column from 0,001 to 0,999 was taken for thousands: a press of 0.9 mm was 900 mm deep, without a word."""
    one = press(peak=peak, hold=0.2)
    rows = samples.rows(one.time, one.depth, one.force, digits=(3, 3, 3), sign=",", between=";")
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Time (s);Distance (mm);Force (N)", *rows]))
    (record,) = read_instrument_file(path).records
    assert record.table.depth.max() == pytest.approx(1e-3 * peak, rel=0.05)
    assert record.table.time[-1] == pytest.approx(one.time[-1], rel=0.01)


@pytest.mark.parametrize("head", [("Time", "Distance", "Force"), ("Time (s)", "Distance (um)", "Force (mN)")])
@pytest.mark.parametrize("units", [(" s", " um", " mN"), ("s", "um", "mN"), ("", " µm", " mN")])
def test_units_behind_the_numbers_of_cells_are_those_of_the_column(tmp_path, head, units):
    head = ("Time (s)", *head[1:]) if not units[0] else head
    path = large(tmp_path / "a.csv", press(), head=head, units=units, mark=" ")
    read = read_instrument_file(path)
    (record,) = read.records
    assert np.ptp(record.table.force) == pytest.approx(np.ptp(press().force), rel=1e-3)
    assert np.ptp(record.table.depth) == pytest.approx(1e-3 * np.ptp(press().depth), rel=1e-3)
    assert preview(read)[0].endswith("units behind the numbers of cells")


def test_a_unit_in_the_cells_of_one_column_alone_is_read(tmp_path):
    path = large(tmp_path / "a.csv", press(), head=("Time (s)", "Distance", "Force (mN)"), units=("", " um", ""))
    (record,) = read_instrument_file(path).records
    assert np.ptp(record.table.depth) == pytest.approx(1e-3 * np.ptp(press().depth), rel=1e-3)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (
            lambda text: text.replace("um\n", "mm\n"),
            "row 2, value '.* mm'.*column #3 are in mm, its name in row 1 says um",
        ),
        (lambda text: text.replace(" (um)", "").replace("um\n", "mm\n", 1), "row 3, value '.* um'.*row 2 has mm"),
        (lambda text: text.replace(" (um)", "").replace(" um\n", "\n", 1), "row 3, value '.* um'.*row 2 has no unit"),
        (
            lambda text: text.replace("um\n", "ells\n").replace("N;", "stones;"),
            "behind a number nothing but a known unit",
        ),
    ],
)
def test_cells_in_several_units_or_unknown_ones_are_refused_by_their_place(tmp_path, change, says):
    one = press()
    rows = [f"{t:.2f} s;{f:.4f} N;{1e3 * d:.1f} um" for t, d, f in zip(one.time, one.depth, one.force, strict=True)]
    path = tmp_path / "a.csv"
    path.write_text(change("\n".join(["Time;Force (N);Distance (um)", *rows]) + "\n"))
    with pytest.raises(TableError, match=says):
        read_instrument_file(path)


def test_a_needed_column_of_which_few_cells_have_a_unit_is_refused(tmp_path):
    path = large(tmp_path / "a.csv", press())
    text = path.read_text()
    cell = text.splitlines()[9].split(";")[1]
    path.write_text(text.replace(f";{cell};", f";{cell} um;", 1))
    with pytest.raises(TableError, match="has a unit behind its number, and others have none or another"):
        read_instrument_file(path)


@pytest.mark.parametrize(
    ("cell", "decimal", "number"), [("1 234,5", ",", "1234.5"), ("0,123", ".", "0,123"), ("12 34", ".", "12 34")]
)
def test_what_is_no_number_under_a_decimal_sign_stays_text(cell, decimal, number):
    assert number_text(cell, decimal) == number


def test_commas_between_thousands_and_cells_alike_are_refused(tmp_path):
    """A press of 2000 um was one of 200, since 1,200.0 is two cells, without a word."""
    one = press()
    rows = [f"{t:.2f},{1e3 * d:,.1f},{1e3 * f:,.1f}" for t, d, f in zip(one.time, one.depth, one.force, strict=True)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Time (s),Distance (um),Force (mN)", *rows]))
    with pytest.raises(TableError, match=r"[45] cells, its header 3: the comma seems to stand between thousands, too"):
        read_instrument_file(path)


@pytest.mark.parametrize(
    ("unit", "factor", "same"), [("N", 1.0, True), ("N", 0.5, False), ("mN", 1e3, True), ("kN", 0.5e-3, False)]
)
def test_columns_that_are_proportional_otherwise_than_their_units_say_are_two(tmp_path, unit, factor, same):
    """The half of the load that the second of two cells bears was taken for the first in other units."""
    one = press()
    rows = samples.rows(one.time, one.depth, one.force, factor * one.force, digits=(3, 5, 6, 8))
    path = tmp_path / "a.csv"
    path.write_text("\n".join([f"Time (s),Distance (mm),Force (N),Force ({unit})", *rows]))
    if same:
        (record,) = read_instrument_file(path).records
        assert record.table.force.max() == pytest.approx(one.force.max(), rel=1e-2)
        return
    with pytest.raises(TableError, match="two columns could be the force"):
        read_instrument_file(path)


TEXTS = {
    "points": lambda value, unit: f"{value:.4f}",
    "commas": lambda value, unit: f"{value:.4f}".replace(".", ","),
    "units": lambda value, unit: f"{value:.4f} {unit}".replace(".", ","),
}


@pytest.mark.parametrize("name", TEXTS)
def test_a_workbook_of_numbers_as_text_is_read(tmp_path, name):
    """Numbers as text with commas, as a German Excel keeps what was pasted, were no rows of numbers."""
    pytest.importorskip("python_calamine")
    one, units = press(), ("s", "mm", "N")
    rows = [
        [TEXTS[name](float(value), unit) for value, unit in zip(row, units, strict=True)]
        for row in zip(one.time, one.depth, one.force, strict=True)
    ]
    head = ["Zeit", "Weg", "Kraft"] if name == "units" else ["Zeit [s]", "Weg [mm]", "Kraft [N]"]
    path = samples.workbook(tmp_path / "a.xlsx", {"Daten": [head, *rows]})
    (record,) = read_instrument_file(path).records
    assert record.table.force.max() == pytest.approx(one.force.max(), rel=1e-3)
    assert np.ptp(record.table.time) == pytest.approx(np.ptp(one.time), rel=1e-3)


def test_a_workbook_whose_commas_may_be_thousands_is_refused(tmp_path):
    pytest.importorskip("python_calamine")
    rows = [[f"1,{n:03d}", f"2,{n:03d}", f"3,{n:03d}"] for n in range(60)]
    path = samples.workbook(tmp_path / "a.xlsx", {"Daten": [["Zeit [s]", "Weg [mm]", "Kraft [N]"], *rows]})
    with pytest.raises(TableError, match="the comma may stand before decimals or thousands"):
        read_instrument_file(path)


@pytest.mark.parametrize(("units", "force"), [("s,mm,kN", "#3:kN"), ("-,-,-", None), ("[s],[mm],[newton]", None)])
def test_two_units_of_a_column_are_one_where_it_is_told_or_both_say_the_same(units, force, tmp_path):
    one = press()
    path = tmp_path / "a.csv"
    lines = ["Time [s],Weg [mm],Kraft [N]", units, *samples.rows(one.time, one.depth, one.force, digits=(3, 5, 6))]
    path.write_text("\n".join(lines) + "\n")
    (record,) = read_instrument_file(path, Told(columns={"force": force} if force else {})).records
    assert record.table.force.max() == pytest.approx(one.force.max() * (1e3 if force else 1.0), rel=0.01)


@pytest.mark.parametrize(("count", "written"), [(650, np.round), (655, np.floor), (647, np.floor)])
def test_times_of_a_tenth_of_a_second_keep_their_pace_at_both_ends(count, written, tmp_path):
    """First and last rows of times that are rounded were 17 and 25 ms apart instead of 10, the end 85 ms late."""
    time = 0.01 * np.arange(count)
    depth = 2.0 - np.abs(time - 3.0)
    rows = samples.rows(written(10.0 * time + 1e-9) / 10.0, depth, np.clip(depth, 0.0, None), digits=(1, 5, 6))
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Time [s],Depth [mm],Force [N]", *rows]) + "\n")
    (record,) = read_instrument_file(path, Told()).records
    np.testing.assert_allclose(record.table.time, time, atol=0.012)
    assert np.diff(record.table.time)[[0, -1]] == pytest.approx(0.01, rel=0.1)


@pytest.mark.parametrize("head", ["Time (s),Distance ({1}),Force ({0})", "time_s,distance_{1},force_{0}"])
@pytest.mark.parametrize(
    ("force", "newton"),
    [("gf", samples.GRAM), ("g", samples.GRAM), ("kg", 1e3 * samples.GRAM), ("kgf", 1e3 * samples.GRAM), ("daN", 10.0)],
)
@pytest.mark.parametrize(("depth", "mm"), [("inch", 25.4), ("mil", 0.0254), ("µm", 1e-3)])
def test_forces_and_lengths_come_out_in_si_and_a_mass_is_told_to_be_a_weight(tmp_path, head, force, newton, depth, mm):
    one, path = press(), tmp_path / "a.csv"
    rows = samples.rows(one.time, one.depth / mm, one.force / newton, digits=(2, 9, 9))
    path.write_text("\n".join([head.format(force, depth), *rows]) + "\n", encoding="utf-8")
    (record,) = read_instrument_file(path).records
    np.testing.assert_allclose(record.table.force, one.force, atol=1e-6)
    assert np.ptp(record.table.depth) == pytest.approx(1e-3 * np.ptp(one.depth), rel=1e-6)
    said = [note for note in record.notes if "the weight of that mass" in note]
    assert len(said) == (force in ("g", "kg"))
    assert all(f"1 {force} is {newton:g} N" in note for note in said)
