"""One synthetic press, written in the format of each instrument with that format's traps; all of it is synthetic.

The press comes from 0.5 mm above the surface, goes in at 1 mm/s, is held, and goes out: F = 3 d^1.5 N (d in mm), which
falls to 70 % in the hold, with 2 mN of noise. Each writer returns the file; `depth` and `force` are what a reader must
find, press positive and from the first touch.
"""

import json
import struct
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

GRAM = 9.80665e-3


@dataclass(frozen=True)
class Press:
    """A press: s, mm from the surface, N, all (n,)."""

    time: np.ndarray
    depth: np.ndarray
    force: np.ndarray


def press(rate: float = 50.0, peak: float = 2.0, hold: float = 2.0, seed: int = 1, cycles: int = 1) -> Press:
    """The press, `cycles` times."""
    lead, out = 0.5, peak + 0.5
    knots_t, knots_d = [0.0, 0.4], [-lead, -lead]
    for _ in range(cycles):
        for duration, depth in ((out, peak), (hold, peak), (out, -lead), (0.4, -lead)):
            knots_t.append(knots_t[-1] + max(duration, 1e-6))
            knots_d.append(depth)
    time = np.arange(0.0, knots_t[-1], 1.0 / rate)
    depth = np.interp(time, knots_t, knots_d)
    within = np.clip((time - knots_t[2]) % (knots_t[-1] / cycles), 0.0, None)
    relaxed = np.where(depth >= peak - 1e-9, 0.7 + 0.3 * np.exp(-within / 0.8), 1.0)
    force = 3.0 * np.clip(depth, 0.0, None) ** 1.5 * relaxed
    return Press(time, depth, force + np.random.default_rng(seed).normal(0.0, 2e-3, time.size))


def rows(
    *columns: np.ndarray, digits: tuple[int, ...], sign: str = ".", between: str = ",", quote: str = ""
) -> list[str]:
    """Lines of numbers."""
    lines = []
    for cells in zip(*columns, strict=True):
        texts = (f"{cell:.{d}f}".replace(".", sign) for cell, d in zip(cells, digits, strict=True))
        lines.append(between.join(f"{quote}{text}{quote}" for text in texts))
    return lines


def workbook(path: Path, sheets: dict[str, list[list[object]]]) -> Path:
    """A minimal .xlsx: texts inline, numbers as numbers."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as book:
        types = "".join(
            f'<Override PartName="/xl/worksheets/sheet{k}.xml" ContentType="application/'
            f'vnd.openxmlformats-officedocument.spreadsheetml.worksheet+xml"/>'
            for k in range(1, len(sheets) + 1)
        )
        main = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"
        rels = "application/vnd.openxmlformats-package.relationships+xml"
        head = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>'
        book.writestr(
            "[Content_Types].xml",
            f'{head}<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
            f'<Default Extension="rels" ContentType="{rels}"/>'
            f'<Override PartName="/xl/workbook.xml" ContentType="{main}"/>{types}</Types>',
        )
        office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
        package = "http://schemas.openxmlformats.org/package/2006/relationships"
        book.writestr(
            "_rels/.rels",
            f'{head}<Relationships xmlns="{package}"><Relationship Id="rId1" Type="{office}/officeDocument" '
            f'Target="xl/workbook.xml"/></Relationships>',
        )
        listed = "".join(
            f'<sheet name="{name}" sheetId="{k}" r:id="rId{k}"/>' for k, name in enumerate(sheets, start=1)
        )
        space = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
        book.writestr(
            "xl/workbook.xml",
            f'{head}<workbook xmlns="{space}" xmlns:r="{office}"><sheets>{listed}</sheets></workbook>',
        )
        related = "".join(
            f'<Relationship Id="rId{k}" Type="{office}/worksheet" Target="worksheets/sheet{k}.xml"/>'
            for k in range(1, len(sheets) + 1)
        )
        book.writestr("xl/_rels/workbook.xml.rels", f'{head}<Relationships xmlns="{package}">{related}</Relationships>')
        for k, table in enumerate(sheets.values(), start=1):
            body = "".join(
                f'<row r="{r}">{"".join(_cell(r, c, v) for c, v in enumerate(row))}</row>'
                for r, row in enumerate(table, 1)
            )
            book.writestr(
                f"xl/worksheets/sheet{k}.xml",
                f'{head}<worksheet xmlns="{space}"><sheetData>{body}</sheetData></worksheet>',
            )
    return path


def _cell(row: int, column: int, value: object) -> str:
    place = f"{chr(65 + column) if column < 26 else 'A' + chr(39 + column)}{row}"
    if value is None or value == "":
        return ""
    if isinstance(value, str):
        return f'<c r="{place}" t="inlineStr"><is><t>{value}</t></is></c>'
    return f'<c r="{place}"><v>{float(value)!r}</v></c>'


def zwick_xlsx(folder: Path) -> Path:
    """testXpert's workbook: parameters, results, then a sheet a specimen, name in row 1, columns, units."""
    sheets: dict[str, list[list[object]]] = {
        "Parameter": [["Prüfer", "n.n."], ["Stempeldurchmesser", 10.0, "mm"], ["Vorkraft", 0.01, "N"]],
        "Ergebnisse": [["Probe", "h0", "Fmax"], ["", "mm", "N"], ["Probe 1", 12.0, 8.4], ["Probe 2", 12.0, 8.5]],
    }
    for number in (1, 2):
        one = press(seed=number)
        table: list[list[object]] = [
            [f"Probe {number}"],
            ["Prüfzeit", "Standardweg", "Standardkraft"],
            ["s", "mm", "N"],
        ]
        table += [[t, d + 0.5, f] for t, d, f in zip(one.time, one.depth, one.force, strict=True)]
        sheets[f"Probe {number}"] = table
    return workbook(folder / "zwick.xlsx", sheets)


def zwick_text(folder: Path) -> Path:
    """testXpert's text export of a German machine: latin-1, semicolons, decimal commas, units in their own line."""
    one = press()
    head = [
        "Prüfer;n.n.",
        "Stempeldurchmesser;10,0;mm",
        "",
        "Prüfzeit;Standardweg;Standardkraft;Traverse abs.",
        "s;mm;N;mm",
    ]
    lines = rows(one.time, one.depth + 0.5, one.force, one.depth + 80.0, digits=(3, 5, 6, 4), sign=",", between=";")
    path = folder / "zwick.txt"
    path.write_bytes("\r\n".join([*head, *lines]).encode("latin-1"))
    return path


def zwick_zs2(folder: Path) -> Path:
    """testXpert's archive: gzip of chunks, channels by number, their names in a table apart, all in SI units."""
    from zs2decode import encoder

    one = press()
    chunks: list[list[object]] = [[None, "Document", "DD", ""], [None, "Body", "DD", ""], [None, "batch", "DD", ""]]

    def opened(name: str) -> None:
        chunks.append([None, name, "DD", ""])

    def closed(times: int = 1) -> None:
        chunks.extend([None, "", "end", []] for _ in range(times))

    for name in ("SeriesDef", "TestTaskDefs", "Elem0", "ChannelManager", "ChannelManager"):
        opened(name)
    for number, name in enumerate(("Prüfzeit", "Standardweg", "Standardkraft")):
        opened(f"Elem{number}")
        chunks.append([None, "ID", "44", 48000 + number])
        opened("Name")
        chunks.append([None, "Text", "AA", name])
        closed(2)
    closed(5)
    for name in (
        "Series",
        "SeriesElements",
        "Elem0",
        "SeriesElements",
        "Elem0",
        "RealTimeCapture",
        "Trs",
        "SingleGroupDataBlock",
    ):
        opened(name)
    chunks.append([None, "IndexTimeChannel", "11", 0])
    opened("DataChannels")
    for number, values in enumerate((one.time, 1e-3 * (one.depth + 0.5), one.force)):
        opened(f"Elem{number}")
        chunks.append([None, "TrsChannelId", "44", 48000 + number])
        chunks.append([None, "DataArray", "EE05", [float(value) for value in values]])
        closed()
    closed(9 + 3)
    encoder.save_zs2(str(folder / "zwick.zs2"), encoder.make_datastream(encoder.make_raw_chunks(chunks)))
    return folder / "zwick.zs2"


def bluehill_report(folder: Path) -> Path:
    """Bluehill's report as csv: UTF-16, a results table first, quotes, decimal commas, compression negative."""
    one = press()
    head = ["Results Table 1", '"","Maximum Load","Specimen label"', '"","(N)",""', '"1","-8,40","A"', ""]
    head += ['General : Specimen height,"12,0","mm"', "", "Raw Data", '"Time","Extension","Load"', '"(s)","(mm)","(N)"']
    lines = rows(one.time, -one.depth - 0.5, -one.force, digits=(3, 5, 6), sign=",", quote='"')
    path = folder / "bluehill.csv"
    path.write_text("\r\n".join([*head, *lines, ""]), encoding="utf-16")
    return path


def bluehill_raw(folder: Path) -> Path:
    """Bluehill's Specimen_RawData_1.csv: units below, kilonewtons, compression positive."""
    one = press()
    head = ['"Time","Compressive extension","Compressive load"', '"(s)","(mm)","(kN)"']
    lines = rows(one.time, one.depth + 0.5, 1e-3 * one.force, digits=(3, 5, 9), quote='"')
    path = folder / "Specimen_RawData_1.csv"
    path.write_text("\n".join([*head, *lines]) + "\n")
    return path


def exponent_text(folder: Path) -> Path:
    """Exponent's text: two tests side by side, grams-force, the probe's line, the second test shorter."""
    one, two = press(seed=1), press(seed=2, hold=1.0)
    head = ["Probe:\tP/10 10mm DIA CYLINDER ALUMINIUM", "Test 1\t\t\tTest 2"]
    head += ["\t".join(["Force", "Distance", "Time"] * 2), "\t".join(["g", "mm", "sec"] * 2)]
    left = rows(one.force / GRAM, one.depth + 0.5, one.time, digits=(3, 4, 3), between="\t")
    right = rows(two.force / GRAM, two.depth + 0.5, two.time, digits=(3, 4, 3), between="\t")
    right += ["\t\t"] * (len(left) - len(right))
    path = folder / "exponent.txt"
    path.write_text(
        "\n".join([*head, *(f"{a}\t{b}" for a, b in zip(left, right, strict=True))]) + "\n", encoding="latin-1"
    )
    return path


def exponent_xlsx(folder: Path) -> Path:
    """Exponent's workbook: one sheet, the units in brackets in the names, kilograms."""
    one = press()
    table: list[list[object]] = [["Force (kg)", "Distance (mm)", "Time (sec)"]]
    table += [[f / (1e3 * GRAM), d + 0.5, t] for t, d, f in zip(one.time, one.depth, one.force, strict=True)]
    return workbook(folder / "exponent.xlsx", {"Data": table})


def cellscale(folder: Path) -> Path:
    """CellScale's csv: units in the names, millinewtons, the gap as Size, times written to a tenth of a second."""
    one = press()
    head = "SetName,Cycle,Time_S,Size_mm,Displacement_mm,Force_mN"
    numbers = rows(one.time, 12.0 - one.depth, one.depth + 0.5, 1e3 * one.force, digits=(1, 5, 5, 3))
    path = folder / "cellscale.csv"
    path.write_text("\n".join([head, *(f"Set1,1-Compress,{line}" for line in numbers)]) + "\n")
    return path


def electroforce(folder: Path) -> Path:
    """WinTest's csv: a header block, padded columns, units below, names again at each scan, press negative."""
    one = press()
    head = ["WinTest 7.2", "Specimen, gel", "File, run.csv", ""]
    names, units = "Points ,Elapsed Time ,Scan Time ,Disp ,Load ", " ,Sec ,Sec ,mm ,N "
    numbers = np.arange(one.time.size, dtype=float)
    lines = rows(numbers, one.time, one.time % 1.0, -one.depth - 0.5, -one.force, digits=(0, 4, 4, 5, 6), between=" ,")
    parts = [lines[k : k + 100] for k in range(0, len(lines), 100)]
    body = [line for part in parts for line in (names, units, *part, "")]
    path = folder / "electroforce.csv"
    path.write_text("\r\n".join([*head, *body]))
    return path


def chiaro(folder: Path) -> Path:
    """Optics11's text: tabs, latin-1, tip radius in the header, micronewtons and nanometres, a press of micrometres."""
    one = press()
    head = [
        "Date\t01/02/2023\tTime\t10:00:00",
        "Device:\tChiaro",
        "Tip radius (um)\t25.0",
        "k (N/m)\t0.5",
        "Max load (µN)\t1.0",
        "",
    ]
    names = "Time (s)\tLoad (uN)\tIndentation (nm)\tCantilever (nm)\tPiezo (nm)\tAuxiliary"
    lines = rows(
        one.time, 0.1 * one.force, 1e3 * one.depth, 200 * one.force, 1e3 * one.depth + 200 * one.force, 0 * one.time,
        digits=(3, 5, 2, 2, 2, 1), between="\t",
    )  # fmt: skip
    path = folder / "chiaro.txt"
    path.write_bytes("\r\n".join([*head, names, *lines]).encode("latin-1"))
    return path


def jpk(folder: Path) -> Path:
    """JPK's zip of properties and big-endian counts: sensor height falls towards the sample, force through volts."""
    one = press(hold=0.0)
    force, stiffness = 1e-9 * one.force, 0.05
    height = 20e-6 - 1e-6 * one.depth - force / stiffness  # the stage goes on by what the cantilever bends
    half = int(np.argmax(one.depth)) + 1
    path = folder / "curve.jpk-force"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("segments/", "")
        archive.writestr("header.properties", "force-scan-series.header.position-index=0\n")
        for number, (part, style) in enumerate(((slice(0, half), "extend"), (slice(half, None), "retract"))):
            where = f"segments/{number}/"
            archive.writestr(where, "")
            duration = one.time[part].size / 50.0
            archive.writestr(
                where + "segment-header.properties", _jpk_segment(one.time[part].size, duration, style, stiffness)
            )
            archive.writestr(
                where + "channels/vDeflection.dat", np.round(force[part] / stiffness / 1e-13).astype(">i4").tobytes()
            )
            for name in ("measuredHeight", "height"):
                archive.writestr(where + f"channels/{name}.dat", np.round(height[part] / 1e-12).astype(">i4").tobytes())
    return path


def _jpk_segment(count: int, duration: float, style: str, stiffness: float) -> str:
    header = "force-segment-header"
    lines = [
        f"{header}.num-points={count}", f"{header}.duration={duration}", f"{header}.settings.style={style}",
        f"{header}.settings.segment-settings.duration={duration}", f"{header}.settings.segment-settings.z-start=2e-5",
        f"{header}.settings.segment-settings.z-end=0", f"{header}.approach-id=1",
        f"{header}.time-stamp=2023-01-02 10\\:00\\:00.000 +0100", f"{header}.settings.feedback-mode.name=contact",
    ]  # fmt: skip
    for name, counts in (("vDeflection", 1e-13), ("measuredHeight", 1e-12), ("height", 1e-12)):
        channel = f"channel.{name}"
        lines += [
            f"{channel}.data.encoder.type=signedinteger", f"{channel}.data.encoder.scaling.offset=0.0",
            f"{channel}.data.encoder.scaling.multiplier={counts}", f"{channel}.conversion-set.conversions.base=volts",
        ]  # fmt: skip
        steps = {"vDeflection": (("distance", "volts", 1.0, "m"), ("force", "distance", stiffness, "N"))}
        for slot, base, factor, unit in steps.get(
            name, (("nominal", "volts", 1.0, "m"), ("calibrated", "nominal", 1.0, "m"))
        ):
            conversion = f"{channel}.conversion-set.conversion.{slot}"
            lines += [
                f"{conversion}.defined=true", f"{conversion}.name={slot}", f"{conversion}.base-calibration-slot={base}",
                f"{conversion}.scaling.offset=0.0", f"{conversion}.scaling.multiplier={factor}",
                f"{conversion}.scaling.unit.unit={unit}",
            ]  # fmt: skip
    return "\n".join(lines) + "\n"


def nanoscope(folder: Path) -> Path:
    """NanoScope's curve: counts behind a header, both ways from where the tip touches, a ramp in volts, no times."""
    one = press(hold=0.0)
    force, stiffness, bend, stage = 1e-9 * one.force, 0.05, 50e-9, 20e-9
    half = int(np.argmax(one.depth)) + 1
    grid = np.linspace(-5e-7, 2e-6, half)
    ways = [
        np.interp(grid, 1e-6 * one.depth[part][::step], force[part][::step])
        for part, step in ((slice(0, half), 1), (slice(half - 1, None), -1))
    ]
    ramp = grid + ways[0] / stiffness  # the stage goes on by what the cantilever bends
    even = ramp[0] + np.arange(half) * (ramp[-1] - ramp[0]) / (half - 1)
    counts = [
        np.round(np.interp(even, grid + way / stiffness, way)[::-1] / stiffness / bend / 0.000375) for way in ways
    ]
    volts = (ramp[-1] - ramp[0]) * half / (half - 1) / stage
    lines = [
        "*Force file list", "Version: 0x08150300", "*Scanner list", "@Sens. Zsens: V 20.00000 nm/V", "*Ciao scan list",
        "@Sens. DeflSens: V 50.00000 nm/V", "Samps/line: 256", "*Ciao force list", "Scan rate: 0.2",
        f"Samps/line: {half} {half}", f"@4:Ramp size Zsweep: V [Sens. Zsens] (0.006713 V/LSB) {volts:.6f} V",
        "*Ciao force image list", "Data offset: 4096", f"Data length: {4 * half}", "Bytes/pixel: 2",
        f"Samps/line: {half} {half}", f"Spring Constant: {stiffness}",
        '@4:Image Data: S [DeflectionError] "Deflection Error"',
        "@4:Z scale: V [Sens. DeflSens] (0.0003750000 V/LSB) 2.5 V", "*File list end",
    ]  # fmt: skip
    head = "".join(f"\\{line}\r\n" for line in lines).encode("latin-1") + b"\x1a"
    path = folder / "gel.003"
    path.write_bytes(head.ljust(4096, b"\0") + np.concatenate(counts).astype("<i2").tobytes())
    return path


def tdms(folder: Path) -> Path:
    """A TDMS group: units as properties, no column of times but the waveform's step."""
    from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

    one = press()
    track = {"wf_increment": 0.02, "wf_start_offset": 0.0}
    path = folder / "indentation.tdms"
    with TdmsWriter(str(path)) as writer:
        writer.write_segment(
            [
                RootObject({"Tip radius (um)": 25.0}),
                GroupObject("Indent 1"),
                ChannelObject("Indent 1", "Load", 0.1 * one.force, {"unit_string": "uN", **track}),
                ChannelObject("Indent 1", "Indentation", 1e3 * one.depth, {"unit_string": "nm", **track}),
            ]
        )
    return path


def matlab(folder: Path) -> Path:
    """A MATLAB structure of vectors with the units in their names, and scalars beside."""
    from scipy.io import savemat

    one = press()
    fields = {"time_s": one.time, "gap_mm": 12.0 - one.depth, "force_N": one.force, "tool_diameter_mm": 10.0}
    savemat(folder / "run.mat", {"run1": fields})
    return folder / "run.mat"


def matlab_73(folder: Path) -> Path:
    """Version 7.3, HDF5 behind a block of text: two structures by references, axes turned, texts as numbers."""
    import h5py

    one, path = press(), folder / "run73.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        hidden, runs = file.create_group("#refs#"), file.create_group("runs")
        runs.attrs["MATLAB_class"] = np.bytes_("struct")
        fields = {"time_s": one.time, "position_um": 3e3 + 1e3 * one.depth, "load_mN": 1e3 * one.force}
        for key, values in fields.items():
            references = []
            for number in range(2):
                inner = hidden.create_dataset(f"{key}{number}", data=values[None, :])
                inner.attrs["MATLAB_class"] = np.bytes_("double")
                references.append([inner.ref])
            runs.create_dataset(key, data=references, dtype=h5py.ref_dtype)
        radius = file.create_dataset("tool_radius_mm", data=[[5.0]])
        radius.attrs["MATLAB_class"] = np.bytes_("double")
        note = file.create_dataset("note", data=np.array([[ord(letter)] for letter in "second batch"], np.uint16))
        note.attrs["MATLAB_class"] = np.bytes_("char")
    content = bytearray(path.read_bytes())
    content[:19] = b"MATLAB 7.3 MAT-file"
    path.write_bytes(content)
    return path


def parquet(folder: Path) -> Path:
    """Columns with units in the fields' metadata; position instead of depth."""
    import pyarrow as pa
    from pyarrow import parquet as pq

    one = press()
    fields = [
        pa.field(n, pa.float64(), metadata={"unit": u})
        for n, u in (("Time", "ms"), ("Position", "um"), ("Force", "mN"))
    ]
    arrays = [pa.array(v) for v in (1e3 * one.time, 5e4 - 1e3 * one.depth, 1e3 * one.force)]
    pq.write_table(pa.table(arrays, schema=pa.schema(fields)), folder / "run.parquet")
    return folder / "run.parquet"


def chinese(folder: Path) -> Path:
    """A machine's csv in GBK with Chinese names."""
    one = press()
    lines = rows(one.time, one.depth + 0.5, one.force, digits=(2, 4, 5))
    path = folder / "machine.csv"
    path.write_bytes("\r\n".join(["时间(s),位移(mm),试验力(N)", *lines]).encode("gbk"))
    return path


def recording(
    path: Path, topics: dict[str, tuple[str, dict, list[tuple[float, dict]]]], encoding: str = "json"
) -> Path:
    """A recording by the `mcap` library's writer: by topic its schema's name and contents, times in s and messages."""
    written = {
        topic: (name, json.dumps(schema).encode(), [(t, json.dumps(each).encode()) for t, each in messages])
        for topic, (name, schema, messages) in topics.items()
    }
    return encoded(path, written, encoding, "jsonschema" if any(schema for _, schema, _ in topics.values()) else "")


def encoded(
    path: Path, topics: dict[str, tuple[str, bytes, list[tuple[float, bytes]]]], encoding: str, schema_encoding: str
) -> Path:
    """A recording of messages as they stand in the file: by topic its schema's name and text, times in s and bytes."""
    from mcap.writer import Writer

    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start(profile="", library="another program")
        for topic, (name, schema, messages) in topics.items():
            kind = writer.register_schema(name, schema_encoding, schema)
            channel = writer.register_channel(topic, encoding, kind)
            for time, message in messages:
                instant = round(1e9 * time)
                writer.add_message(channel, instant, message, instant)
        writer.finish()
    return path


def robot_mcap(folder: Path) -> Path:
    """A robot's recording: a wrench in ROS's words, and the probe's place, slower, in a schema with units; stamps."""
    one, epoch = press(), 1_700_000_000.0

    def stamp(time: float) -> dict:
        return {"sec": int(epoch + time), "nanosec": round(1e9 * (time % 1.0))}

    wrenches = [
        (
            epoch + t + 0.013,
            {
                "header": {"stamp": stamp(t), "frame_id": "ft"},
                "wrench": {"force": {"x": 0.1, "y": 0.2, "z": -f}, "torque": {"x": 0.0, "y": 0.0, "z": 0.0}},
            },
        )
        for t, f in zip(one.time.tolist(), one.force.tolist(), strict=True)
    ]
    places = [
        (epoch + t + 0.002, {"timestamp": stamp(t), "probe": {"position": 80.0 - d}, "busy": True})
        for t, d in zip(one.time[::2].tolist(), one.depth[::2].tolist(), strict=True)
    ]
    schema = {"type": "object", "properties": {"probe": {"properties": {"position": {"type": "number", "unit": "mm"}}}}}
    topics = {"/ft": ("geometry_msgs/WrenchStamped", {}, wrenches), "/stage": ("stage/Place", schema, places)}
    return recording(folder / "robot.mcap", topics)


WRENCH = """std_msgs/Header header
geometry_msgs/Wrench wrench
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3 force
geometry_msgs/Vector3 torque
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"""
POSE = """std_msgs/Header header
geometry_msgs/Pose pose
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"""


def cdr(time: float, *numbers: float) -> bytes:
    """A stamped message of ROS 2 in CDR, little endian: a head of 4 bytes, stamp, "ft" with its nought, float64."""
    head = struct.pack("<IiI", 0x00000100, int(time), round(1e9 * (time % 1.0))) + struct.pack("<I", 3) + b"ft\0"
    return head + bytes(-(len(head) - 4) % 8) + struct.pack(f"<{len(numbers)}d", *numbers)


def ros2_mcap(folder: Path) -> Path:
    """A bag of ROS 2: wrench in N and pose in m in CDR at different rates, and a topic whose texts cannot be read."""
    one, epoch = press(), 1_700_000_000.0
    time, place = epoch + one.time, 0.3 - 1e-3 * one.depth
    wrenches = [(t + 0.004, cdr(t, 0.1, 0.2, -f, 0.0, 0.0, 0.0)) for t, f in zip(time, one.force, strict=True)]
    poses = [(t + 0.001, cdr(t, 0.4, 0.1, z, 0, 0, 0, 1)) for t, z in zip(time[::2], place[::2], strict=True)]
    topics = {
        "/ft": ("geometry_msgs/msg/WrenchStamped", WRENCH.encode(), wrenches),
        "/tool_pose": ("geometry_msgs/msg/PoseStamped", POSE.encode(), poses),
        "/chatter": ("std_msgs/msg/String", b"wstring data\n", [(epoch, struct.pack("<II", 0x100, 0))]),
    }
    return encoded(folder / "bag_0.mcap", topics, "cdr", "ros2msg")


def protobuf_mcap(folder: Path) -> Path:
    """A stage's recording in protobuf, units in the names; a number that is nought is not in the bytes."""
    from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorSet

    one, epoch = press(), 1_700_000_000.0
    files = FileDescriptorSet()
    file = files.file.add(name="rig.proto", package="rig", syntax="proto3")
    kind = file.message_type.add(name="Sample")
    for number, name in enumerate(("force_N", "depth_mm", "state"), start=1):
        kind.field.add(name=name, number=number, type=FieldDescriptorProto.TYPE_DOUBLE, label=1)

    def sample(force: float, depth: float) -> bytes:
        return b"".join(struct.pack("<Bd", 8 * k + 1, value) for k, value in ((1, force), (2, depth)) if value)

    messages = [
        (epoch + t, sample(f, d)) for t, f, d in zip(one.time, np.clip(one.force, 0.0, None), one.depth, strict=True)
    ]
    topics = {"/rig": ("rig.Sample", files.SerializeToString(), messages)}
    return encoded(folder / "rig.mcap", topics, "protobuf", "protobuf")


@dataclass(frozen=True)
class Sample:
    """A format: what writes it, what reads it besides NumPy, the scale of its press (m, N), its number of trials."""

    write: Callable[[Path], Path]
    library: str = ""
    trials: int = 1
    depth: float = 2e-3
    force: float = 8.485
    radius: float | None = None
    height: float | None = None


SAMPLES = {
    "zwick_xlsx": Sample(zwick_xlsx, "python_calamine", 2, radius=5e-3, height=12e-3),
    "zwick_text": Sample(zwick_text, radius=5e-3),
    "zwick_zs2": Sample(zwick_zs2, "zs2decode"),
    "bluehill_report": Sample(bluehill_report, height=12e-3),
    "bluehill_raw": Sample(bluehill_raw),
    "exponent_text": Sample(exponent_text, trials=2, radius=5e-3),
    "exponent_xlsx": Sample(exponent_xlsx, "python_calamine"),
    "cellscale": Sample(cellscale),
    "electroforce": Sample(electroforce),
    "chiaro": Sample(chiaro, depth=2e-6, force=0.8485e-6, radius=25e-6),
    "jpk": Sample(jpk, "afmformats", depth=2e-6, force=8.485e-9),
    "nanoscope": Sample(nanoscope, depth=2e-6, force=8.485e-9),
    "tdms": Sample(tdms, "nptdms", depth=2e-6, force=0.8485e-6, radius=25e-6),
    "matlab": Sample(matlab, radius=5e-3),
    "matlab_73": Sample(matlab_73, "h5py", 2),
    "parquet": Sample(parquet),
    "chinese": Sample(chinese),
    "robot_mcap": Sample(robot_mcap),
    "ros2_mcap": Sample(ros2_mcap, "mcap_ros2"),
    "protobuf_mcap": Sample(protobuf_mcap, "mcap_protobuf"),
}


def cylinder_workbook(folder: Path, word: str, youngs_modulus: float = 50e3) -> Path:
    """testXpert's workbook of three cylinders, 20 mm wide and 12 mm high, faces sliding, pressed or pulled by 25 %.

    Incompressible neo-Hookean in closed form, F = E/3 A |l - 1/l^2| with the stretch l, and 2 mN of noise.
    """
    time = np.arange(0.0, 20.0, 0.05)
    strain = np.interp(time, [0.0, 1.0, 10.0, 12.0, 20.0], [0.0, 0.0, 0.25, 0.25, 0.0])
    stretch = 1.0 + strain * (1.0 if word.startswith("Zug") else -1.0)
    force = youngs_modulus / 3.0 * np.pi * 10e-3**2 * np.abs(stretch - stretch**-2)
    sheets: dict[str, list[list[object]]] = {
        "Parameter": [["Prüfvorschrift", word], ["Probendurchmesser", 20.0, "mm"], ["Vorkraft", 0.01, "N"]],
        "Ergebnisse": [["Probe", "h0", "Fmax"], ["", "mm", "N"], *[[f"Probe {k}", 12.0, 1.0] for k in (1, 2, 3)]],
    }
    for number in (1, 2, 3):
        noisy = force + np.random.default_rng(number).normal(0.0, 2e-3, time.size)
        table: list[list[object]] = [
            [f"Probe {number}"],
            ["Prüfzeit", "Standardweg", "Standardkraft"],
            ["s", "mm", "N"],
        ]
        table += [[t, d, f] for t, d, f in zip(time, 12.0 * strain, noisy, strict=True)]
        sheets[f"Probe {number}"] = table
    return workbook(folder / "cylinders.xlsx", sheets)
