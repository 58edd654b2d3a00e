"""Binary files of instruments to blocks: workbooks, testXpert archives, TDMS, force curves, MATLAB, Parquet.

Each format is a function from a path to blocks, registered by the endings it has. What a library does is not written
again; one that is not installed is named.
"""

from __future__ import annotations

import importlib
import logging
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from datetime import datetime, time, timedelta
from pathlib import Path
from typing import Any, Final

import numpy as np

from bench_hw.errors import TableError
from bench_hw.instrument_files.blocks import Block, block_of_arrays, blocks_of, header_facts
from bench_hw.instrument_files.text_sheet import Cell, Sheet, sheet_of_cells
from bench_hw.instrument_files.vocabulary import HeaderFact, label_and_unit, unit_of
from bench_hw.storage.regular_file import DOCUMENT, open_regular

Opener = Callable[[Path], list[Block]]
OPENERS: Final[dict[str, tuple[str, Opener]]] = {}
"""What a file with an ending is, and what reads it."""


def _opens(what: str, *endings: str) -> Callable[[Opener], Opener]:
    def register(opener: Opener) -> Opener:
        OPENERS.update(dict.fromkeys(endings, (what, opener)))
        return opener

    return register


def ending_of(path: Path) -> str:
    """The ending that `OPENERS` knows a file by (`.jpk-force`), in lower case; its suffix otherwise.

    NanoScope numbers its curves in the place of an ending (`gel.000`).
    """
    ending = path.suffix.lower()
    return ".spm" if re.fullmatch(r"\.\d{3}", ending) else ending


def open_container(path: Path) -> list[Block]:
    """The blocks of a binary file.

    Raises
    ------
    TableError
        It cannot be read, is damaged or another format than its ending says, or the library that reads it is missing.
    """
    what, opener = OPENERS[ending_of(path)]
    try:
        with open_regular(path, DOCUMENT):
            pass
    except OSError as error:
        raise TableError(path, f"the file cannot be read ({error.strerror})", "a readable file") from error
    try:
        return opener(path)
    except (TableError, KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # the libraries raise anything for a damaged file, one of them no Exception
        allowed = f"a whole {what}; or an export of it as text (csv, txt)"
        raise TableError(
            path, f"this is no whole {what} ({type(error).__name__}: {_first_line(error)})", allowed
        ) from error


def _first_line(error: BaseException) -> str:
    return next(iter(str(error).splitlines()), "")[:120]


def _library(path: Path, module: str, package: str, extra: str) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError as error:
        problem = f"reading it needs {package}, which is not installed"
        allowed = f"pip install 'tissuebench[{extra}]', or an export as text (csv, txt)"
        raise TableError(path, problem, allowed) from error


@_opens("Excel workbook", ".xlsx", ".xls", ".xlsm", ".xlsb", ".ods")
def _workbook(path: Path) -> list[Block]:
    """Each sheet's blocks; what other sheets tell of tool and specimen (parameters, results) is a fact of all."""
    calamine = _library(path, "python_calamine", "python-calamine", "instruments")
    book = calamine.CalamineWorkbook.from_path(str(path))
    sheets = [_sheet(path, book, name) for name in book.sheet_names]
    blocks = [(sheet, block) for sheet in sheets for block in blocks_of(path, sheet)]
    beside = [fact for sheet in sheets for fact in header_facts(sheet.rows[:200] if _tells(sheet) else ())]
    return [_with_facts(block, [*block.facts, *beside]) for _, block in blocks]


def _tells(sheet: Sheet) -> bool:
    """Whether a sheet is one of words and single values, not a record."""
    return len(sheet.rows) < 200


def _with_facts(block: Block, facts: Sequence[HeaderFact]) -> Block:
    from dataclasses import replace

    return replace(block, facts=tuple(facts))


def _sheet(path: Path, book: Any, name: str) -> Sheet:
    rows = book.get_sheet_by_name(name).to_python(skip_empty_area=False)
    return sheet_of_cells(path, name, [[_cell(cell) for cell in row] for row in rows])


def _cell(cell: object) -> Cell:
    if isinstance(cell, bool):
        return str(cell)
    if isinstance(cell, int | float):
        return float(cell)
    if isinstance(cell, timedelta):
        return cell.total_seconds()
    if isinstance(cell, datetime):
        return cell.isoformat()
    if isinstance(cell, time):
        return 3600.0 * cell.hour + 60.0 * cell.minute + cell.second + 1e-6 * cell.microsecond
    return str(cell).strip()


@_opens("testXpert file", ".zs2", ".zp2")
def _testxpert(path: Path) -> list[Block]:
    """Each specimen's channels; the archive holds SI units, and its channel table the names."""
    parser = _library(path, "zs2decode.parser", "zs2decode", "instruments")
    chunks = parser.parse_chunks(parser.data_stream_to_chunks(parser.load(str(path))))
    tree = _tree(chunks)
    names = {each.get("ID"): _text_of(each.get("Name")) for each in _named(tree, "ChannelManager", "ID", "Name")}
    facts = [fact for each in _named(tree, "ParameterListe", "QS_ValPar", "Name") for fact in _parameter(each)]
    blocks = []
    for number, group in enumerate(_having(tree, "DataChannels"), start=1):
        channels = [each for each in group["DataChannels"].values() if isinstance(each, dict) and "DataArray" in each]
        columns = {
            names.get(each.get("TrsChannelId"), f"channel {k}") or f"channel {k}": each["DataArray"]
            for k, each in enumerate(channels)
        }
        if columns and len({len(values) for values in columns.values()}) == 1:
            units = {name: unit for name in columns if (unit := _si_unit(name))}
            blocks.append(block_of_arrays(path, f"specimen {number}", columns, units, facts))
    return blocks


def _si_unit(name: str) -> str:
    from bench_hw.instrument_files.vocabulary import DIMENSIONS, role_of

    role = role_of(label_and_unit(name)[0])
    dimension = "" if role is None else DIMENSIONS[role[0]]
    return {"1": "m/m"}.get(dimension, dimension)


def _tree(chunks: Sequence[tuple[Any, str, str, Any]]) -> dict[str, Any]:
    """Nested tables of a list of chunks, in which an opening (DD) has an end."""
    root: dict[str, Any] = {}
    stack = [root]
    for _, name, kind, value in chunks:
        if kind == "end":
            stack.pop()
        elif kind == "DD":
            inner: dict[str, Any] = {}
            stack[-1][_free(stack[-1], name)] = inner
            stack.append(inner)
        else:
            stack[-1][_free(stack[-1], name)] = value
    return root


def _free(table: Mapping[str, Any], name: str) -> str:
    return name if name not in table else f"{name} {len(table)}"


def _having(tree: Mapping[str, Any], key: str) -> Iterator[Mapping[str, Any]]:
    if key in tree:
        yield tree
    for value in tree.values():
        if isinstance(value, dict):
            yield from _having(value, key)


def _named(tree: Mapping[str, Any], room: str, *keys: str) -> Iterator[Mapping[str, Any]]:
    """The tables below a table called `room` that have all keys."""
    for holder in _having(tree, room):
        for table in _having(holder[room] if isinstance(holder[room], dict) else {}, keys[0]):
            if all(key in table for key in keys):
                yield table


def _text_of(name: object) -> str:
    text = name.get("Text", "") if isinstance(name, dict) else name
    return text if isinstance(text, str) else ""


def _parameter(table: Mapping[str, Any]) -> Iterator[HeaderFact]:
    value = table["QS_ValPar"]
    if isinstance(value, list | tuple) and value and isinstance(value[0], float):
        unit = next((each for each in value if isinstance(each, str) and unit_of(each)), "")
        yield HeaderFact(_text_of(table["Name"]), f"{value[0]:g}", unit)


@_opens("TDMS file", ".tdms")
def _tdms(path: Path) -> list[Block]:
    """Each group's channels of its commonest length, with the units and the time track that the channels carry."""
    library = _library(path, "nptdms", "npTDMS", "instruments")
    importlib.import_module("nptdms.log").log_manager.set_level(logging.ERROR)  # it would write beside the refusal
    tdms = library.TdmsFile.read(str(path))
    if tdms.file_status.incomplete_final_segment:
        allowed = "a whole TDMS file; or an export of it as text (csv, txt)"
        raise TableError(path, "this is no whole TDMS file: it breaks off in its last segment", allowed)
    facts = _properties(tdms.properties)
    blocks = []
    for group in tdms.groups():
        channels = [each for each in group.channels() if len(each) and np.issubdtype(each.dtype, np.number)]
        if not channels:
            continue
        length = max(len(each) for each in channels)
        kept = [each for each in channels if len(each) == length]
        columns = {each.name: np.asarray(each[:]) for each in kept}
        units = {each.name: str(each.properties.get("unit_string", "")) for each in kept}
        step = kept[0].properties.get("wf_increment")
        if step and not any(name.casefold().startswith("time") for name in columns):
            columns, units = {"Time": np.arange(length) * float(step), **columns}, {"Time": "s", **units}
        blocks.append(block_of_arrays(path, group.name, columns, units, [*_properties(group.properties), *facts]))
    return blocks


def _properties(properties: Mapping[str, object]) -> list[HeaderFact]:
    split = ((*label_and_unit(str(key)), value) for key, value in properties.items())
    return [HeaderFact(label, str(value), unit) for label, unit, value in split]


@_opens("atomic-force curve", ".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".jpk-qi-series", ".ibw", ".h5")
def _atomic_force(path: Path) -> list[Block]:
    """Each curve of approach, pause and retract: force and the tip's depth, which is the height less the bending."""
    _library(path, "afmformats", "afmformats", "instruments")
    load = importlib.import_module("afmformats").load_data
    logging.getLogger("afmformats").setLevel(logging.CRITICAL)  # it would write a traceback beside the refusal
    blocks = []
    for number, curve in enumerate(load(path), start=1):
        columns = {name: np.asarray(curve[name], dtype=float) for name in curve.columns if name != "segment"}
        facts = _properties(
            {key: curve.metadata[key] for key in ("spring constant", "speed approach") if key in curve.metadata}
        )
        blocks.append(
            block_of_arrays(path, f"curve {number}", _with_tip(path, columns, curve.metadata), _AFM_UNITS, facts)
        )
    return blocks


_AFM_UNITS: Final = {"force": "N", "tip position": "m", "height (measured)": "m", "height (piezo)": "m", "time": "s"}


def _with_tip(path: Path, columns: dict[str, np.ndarray], metadata: Any) -> dict[str, np.ndarray]:
    """The tip's position beside the stage's: height plus force over the cantilever's stiffness."""
    height = columns.get("height (measured)", columns.get("height (piezo)"))
    if "tip position" in columns or height is None or "force" not in columns:
        return columns
    if "spring constant" not in metadata:
        allowed = "a calibrated curve (N/m in its header)"
        raise TableError(path, "the cantilever's spring constant is not in the file", allowed)
    return {**columns, "tip position": height + columns["force"] / float(metadata["spring constant"])}


@_opens("NanoScope force curve", ".spm")
def _nanoscope(path: Path) -> list[Block]:
    """Its approach and retract."""
    from bench_hw.instrument_files.nanoscope import nanoscope_blocks

    return nanoscope_blocks(path)


@_opens("MATLAB file", ".mat")
def _matlab(path: Path) -> list[Block]:
    """Vectors of one length, at the top or in a structure; a matrix with a cell array of names beside it."""
    from scipy.io import loadmat

    with open_regular(path, DOCUMENT) as stream:
        is_hdf5 = b"MATLAB 7.3" in stream.read(64)
    table = _matlab_hdf5(path) if is_hdf5 else loadmat(str(path), simplify_cells=True)
    return list(_matlab_blocks(path, "", {key: value for key, value in table.items() if not key.startswith("__")}))


def _matlab_hdf5(path: Path) -> dict[str, Any]:
    """The variables of a file of version 7.3, which is HDF5 with the axes of arrays turned round."""
    h5py = _library(path, "h5py", "h5py", "instruments")
    with h5py.File(str(path), "r") as file:
        return {key: _hdf5_value(file, item) for key, item in file.items() if not key.startswith("#")}


def _hdf5_value(file: Any, item: Any) -> Any:
    """A structure as a table, an array of structures as tables, a cell array as a list, text, or numbers."""
    if hasattr(item, "items"):
        fields = {key: _hdf5_value(file, inner) for key, inner in item.items()}
        listed = [len(value) for key, value in fields.items() if _is_field_of_many(item[key])]
        if fields and len(listed) == len(fields) and len(set(listed)) == 1:
            return [{key: value[k] for key, value in fields.items()} for k in range(listed[0])]
        return fields
    if item.attrs.get("MATLAB_empty", 0):
        return np.zeros(0)
    values = np.asarray(item[()]).T
    if values.dtype == object:
        return [_hdf5_value(file, file[reference]) for reference in values.ravel(order="F")]
    if item.attrs.get("MATLAB_class", b"") == b"char":
        return "".join(map(chr, values.ravel(order="F")))
    return float(values.ravel()[0]) if values.size == 1 else np.squeeze(values)


def _is_field_of_many(item: Any) -> bool:
    """Whether this is a field of an array of structures: references that are no cell array."""
    return getattr(getattr(item, "dtype", None), "kind", "") == "O" and "MATLAB_class" not in item.attrs


def _matlab_blocks(path: Path, name: str, table: Mapping[str, Any]) -> Iterator[Block]:
    vectors = {key: np.asarray(value) for key, value in table.items() if _is_vector(value)}
    told = table.get("units")
    units = {key: str(each) for key, each in told.items()} if isinstance(told, dict) else {}
    facts = [fact for key, value in table.items() if np.isscalar(value) for fact in _properties({key: value})]
    for length in sorted({len(each) for each in vectors.values()}, reverse=True)[:1]:
        columns = {key: each for key, each in vectors.items() if len(each) == length}
        if len(columns) >= 2:
            yield block_of_arrays(path, name, columns, units, facts)
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _matlab_blocks(path, key, value)
        elif isinstance(value, list):
            for number, each in enumerate(value, start=1):
                if isinstance(each, dict):
                    yield from _matlab_blocks(path, f"{key} {number}", each)
        elif (named := _named_matrix(table, value)) is not None:
            yield block_of_arrays(path, name or key, named, units, facts)


def _is_vector(value: object) -> bool:
    return (
        isinstance(value, np.ndarray) and value.ndim == 1 and value.size > 1 and np.issubdtype(value.dtype, np.number)
    )


def _named_matrix(table: Mapping[str, Any], value: object) -> dict[str, np.ndarray] | None:
    """The columns of a matrix that another variable names, a cell array of as many texts."""
    if not (isinstance(value, np.ndarray) and value.ndim == 2 and np.issubdtype(value.dtype, np.number)):
        return None
    for each in table.values():
        names = (
            [str(item) for item in np.ravel(np.asarray(each, dtype=object))]
            if isinstance(each, list | np.ndarray)
            else []
        )
        if len(names) == value.shape[1] and all(
            isinstance(item, str) for item in np.ravel(np.asarray(each, dtype=object))
        ):
            return {item: value[:, k] for k, item in enumerate(names)}
    return None


@_opens("MCAP recording", ".mcap")
def _recording(path: Path) -> list[Block]:
    """The topics of another program's recording."""
    from bench_hw.instrument_files.mcap_topics import topic_blocks

    return topic_blocks(path)


@_opens("Parquet file", ".parquet", ".pq")
def _parquet(path: Path) -> list[Block]:
    """Its numeric columns, empty cells as gaps; units from the fields' metadata or their names."""
    from pyarrow import parquet, types

    table = parquet.read_table(str(path))
    fields = [field for field in table.schema if types.is_floating(field.type) or types.is_integer(field.type)]
    columns = {field.name: table.column(field.name).to_numpy(zero_copy_only=False) for field in fields}
    units = {field.name: (field.metadata or {}).get(b"unit", b"").decode() for field in fields}
    return [block_of_arrays(path, "", columns, units)] if columns else []
