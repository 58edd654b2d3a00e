"""`import`: files of any rig or testing machine as trial or marker tables."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench_hw.cli._report import Debug, Json, Quiet, print_json, reporting
from bench_hw.errors import InputError

if TYPE_CHECKING:
    from bench_hw.instrument_files.importing import ForeignFormat, Imported, ImportPlan

SCHEMA = 1
_DELIMITERS = {"tab": "\t", "comma": ",", "semicolon": ";"}

_HELP = """Turn files of any rig or testing machine into trial tables that the whole product reads.

Without --map the file is read as its instrument wrote it: text of any layout, Excel workbooks, testXpert, TDMS,
atomic-force curves, MATLAB, Parquet. --preview shows what was recognised and writes nothing. `python -m benchmark
run --trials FILE` reads the same files without this step.

Each --map takes one column: TARGET is its name here and ends in the unit it gets, SOURCE its header there (or
#3 for the third column), UNIT the unit it is in there (any that pint knows: um, inch, gf, lbf, ms...; the part
after the last colon; without one it is TARGET's own). A trial needs time_s, depth_mm (positive into the
tissue) and force_N (positive when pressing); one that has no --map is taken under that name. Further columns:
gap_mm, force_x_N, cycle... With a target `marker` the result is a marker table: time_s, marker, x_mm, y_mm.

Example, files of a testing machine with decimal commas, extension in micrometres, pull positive in grams-force:

\b
  python -m bench_hw import run1.txt run2.txt --out trials
      --delimiter tab --decimal ,
      --map "time_s=Time (ms):ms" --map "depth_mm=Position [um]:um"
      --map "force_N=Load:gf" --negate force_N --zero depth_mm

Everything is checked as when a trial is read: a cell that is no finite number, time that does not increase,
fewer than 20 rows are refused with file, row and column (exit 2), and nothing is written then.
"""

Files = Annotated[list[Path], typer.Argument(help="Files of one layout.")]
Out = Annotated[Path | None, typer.Option(help="A folder (FILE becomes OUT/FILE.csv), or NAME.csv for one FILE.")]
Preview = Annotated[bool, typer.Option("--preview", help="Show what is recognised; write nothing.")]
Maps = Annotated[list[str] | None, typer.Option("--map", help="TARGET=SOURCE:UNIT; may be repeated.")]
Negate = Annotated[list[str] | None, typer.Option(help="A target whose sign is turned; may be repeated.")]
Zero = Annotated[list[str] | None, typer.Option(help="A target counted from its first row; may be repeated.")]
Rate = Annotated[str, typer.Option(help='Rows per second, "100 Hz", for files without times.')]
DropEmpty = Annotated[bool, typer.Option("--drop-empty", help="Leave out rows with an empty cell.")]
Delimiter = Annotated[str, typer.Option(help="comma, semicolon, tab or a character; else found out.")]
Decimal = Annotated[str, typer.Option(help="The decimal sign, . or , ; else found out.")]
Encoding = Annotated[str, typer.Option(help="Of the text: utf-8, latin-1, utf-16, gbk...; else found out.")]
SkipLines = Annotated[int, typer.Option(min=0, help="Lines above the header (blank ones count).")]
SkipRows = Annotated[int, typer.Option(min=0, help="Lines between header and first row, for instance units.")]
NoHeader = Annotated[bool, typer.Option("--no-header", help="There is no header: sources are #1, #2...")]
Comment = Annotated[str, typer.Option(help="Lines that begin with this are passed over.")]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace files that exist.")]


def register(app: typer.Typer) -> None:
    """Add the verb."""
    app.command("import", help=_HELP)(import_)


def import_(
    files: Files,
    out: Out = None,
    column_map: Maps = None,
    negate: Negate = None,
    zero: Zero = None,
    rate: Rate = "",
    drop_empty: DropEmpty = False,
    delimiter: Delimiter = "",
    decimal: Decimal = "",
    encoding: Encoding = "",
    skip_lines: SkipLines = 0,
    skip_rows: SkipRows = 0,
    no_header: NoHeader = False,
    comment: Comment = "",
    overwrite: Overwrite = False,
    show: Preview = False,
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Turn files of any rig into trial tables; the help text is `_HELP`."""
    with reporting(debug):
        from bench_hw.instrument_files.importing import ForeignFormat, ImportPlan
        from bench_hw.tables.units import parse_map, parse_rate

        sign = _DELIMITERS.get(delimiter, delimiter)
        layout = ForeignFormat(sign, _decimal(decimal), encoding, skip_lines, not no_header, skip_rows, comment)
        plan = ImportPlan(
            maps=tuple(parse_map(text) for text in column_map or ()),
            negate=frozenset(negate or ()),
            zero=frozenset(zero or ()),
            rate=parse_rate(rate) if rate else None,
            drop_empty=drop_empty,
        )
        if show:
            print("\n".join(_previews(files, layout, plan)))
            return
        if out is None:
            raise InputError("--out is missing; allowed: a folder, or NAME.csv for one file; or --preview")
        imported = _import_all(files, out, overwrite, layout, plan)
        if as_json:
            print_json({"schema": SCHEMA, "files": [_entry(*pair) for pair in imported]})
        elif not quiet:
            print("\n".join(_line(*pair) for pair in imported))


def _previews(files: list[Path], layout: ForeignFormat, plan: ImportPlan) -> list[str]:
    """What is recognised in each file, or taken from it as told."""
    from bench_hw.instrument_files import Told, is_plain_trial, preview, read_instrument_file
    from bench_hw.instrument_files.importing import import_table

    told = Told(rate=plan.rate, decimal=layout.decimal, delimiter=layout.delimiter, encoding=layout.encoding)
    lines = []
    for file in files:
        if plan.maps or is_plain_trial(file):
            table = import_table(file, layout, plan)
            lines.append(f"{file}: {table.rows} rows; {', '.join(f'{to} from {of}' for to, of in table.taken.items())}")
        else:
            lines += preview(read_instrument_file(file, replace(told, drop_empty=plan.drop_empty)))
    return lines


def _import_all(
    files: list[Path], out: Path, overwrite: bool, layout: ForeignFormat, plan: ImportPlan
) -> list[tuple[Imported, Path]]:
    """Read and check all files before the first table is written."""
    from bench_hw.instrument_files.importing import import_tables, write_imported

    _targets(files, [file.stem for file in files], out, overwrite)
    tables = [table for file in files for table in import_tables(file, layout, plan)]
    stems = [f"{table.source.stem}_{table.name}" if table.name else table.source.stem for table in tables]
    targets = _targets([table.source for table in tables], [_plain_name(stem) for stem in stems], out, overwrite)
    return [(table, write_imported(table, target)) for table, target in zip(tables, targets, strict=True)]


def _plain_name(stem: str) -> str:
    """A name of a sheet as one of a file."""
    return "".join(letter if letter.isalnum() or letter in "-_.() " else "_" for letter in stem).strip()


def _decimal(sign: str) -> str:
    if sign not in ("", ".", ","):
        raise InputError(f"--decimal {sign!r}; allowed: . or ,")
    return sign


def _targets(files: list[Path], stems: list[str], out: Path, overwrite: bool) -> list[Path]:
    if out.suffix.lower() == ".csv":
        if len(files) > 1:
            raise InputError(f"--out {out}: one table for {len(files)} files; allowed: a folder")
        targets = [out]
    else:
        targets = [out / f"{stem}.csv" for stem in stems]
    if len(set(targets)) < len(targets):
        raise InputError(f"--out {out}: two of the files have the same name; allowed: one table for each")
    for file, target in zip(files, targets, strict=True):
        if target.resolve() == file.resolve():
            raise InputError(f"{target}: this is the file to import itself; allowed: another folder")
        if target.exists() and not overwrite:
            raise InputError(f"{target}: the file exists; give another folder, or --overwrite to replace it")
    return targets


def _entry(table: Imported, target: Path) -> dict[str, object]:
    return {
        "source": str(table.source),
        "out": str(target),
        "rows": table.rows,
        "dropped": table.dropped,
        "columns": dict(table.taken),
    }


def _line(table: Imported, target: Path) -> str:
    dropped = f", {table.dropped} with an empty cell left out" if table.dropped else ""
    return f"{target}: {table.rows} rows{dropped}"
