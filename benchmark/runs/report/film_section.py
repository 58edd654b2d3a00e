"""The markers on a page: what the camera saw, how far they moved, and what the fit with them is worth.

The page takes plain data, which come from a run at hand or from its result folder.
"""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmark.models import Array
from benchmark.runs.report.values import MM
from benchmark.runs.trials.film_tables import MarkerMotion
from benchmark.runs.trials.measured import FilmedSession, MeasuredComparison
from reports import (
    Block,
    Column,
    Download,
    Figure,
    Paragraph,
    Section,
    Table,
    csv_text,
    write_bytes,
    write_json,
    write_text,
)
from reports.figures.markers import circle_radius, marker_motion

SHOWN = 2
"""Films that are shown; the tables have all."""
_FACTS = "markers.json"
_LEADING = ("time_s", "depth_mm", "radius_nine_mm", "radius_ring_mm")

Row = tuple[str | float | None, ...]


@dataclass(frozen=True)
class StillPart:
    """A film tracked in the run: how many pictures, % of sightings missing, and a still (PNG) where it is shown."""

    trial: str
    frames: int
    missing_percent: float
    still: bytes | None


@dataclass(frozen=True)
class MotionPart:
    """Markers of a trial over frames (f,): s, mm; displacements (f, m, 2); radii all NaN without nine markers."""

    trial: str
    time: Array
    depth: Array
    radius_nine: Array
    radius_ring: Array
    moved: Array


@dataclass(frozen=True)
class FilmPart:
    """What the section on the markers is made of.

    Attributes
    ----------
    count
        Trials with markers.
    synthetic
        Whether the pictures are.
    tracked, motions
        Films of this run, and the motions that are shown.
    rows
        Of the table of trials fitted by force and markers; None without such a fit.
    """

    count: int
    synthetic: bool
    tracked: tuple[StillPart, ...]
    motions: tuple[MotionPart, ...]
    rows: tuple[Row, ...] | None


def film_part(comparison: MeasuredComparison, filmed: FilmedSession) -> FilmPart:
    """Take what is shown from a run at hand."""
    names = [each.trial for each in filmed.tracked] or [each.trial for each in filmed.motions]
    shown = [each for each in filmed.motions if each.trial in names][:SHOWN]
    return FilmPart(
        count=len(filmed.motions),
        synthetic=comparison.session.synthetic,
        tracked=tuple(
            StillPart(each.trial, each.frames, each.missing_percent, each.still if number < SHOWN else None)
            for number, each in enumerate(filmed.tracked)
        ),
        motions=tuple(_motion_part(each, comparison) for each in shown),
        rows=None if filmed.sheet is None else tuple(_rows(filmed)),
    )


def write_film(folder: Path, part: FilmPart) -> None:
    """Write `markers.json`, the stills (PNG) and a table (CSV) for each motion shown, numbered as in the JSON."""
    tracked = [{"trial": t.trial, "frames": t.frames, "missing_percent": t.missing_percent} for t in part.tracked]
    facts = {"count": part.count, "synthetic": part.synthetic, "tracked": tracked}
    rows = None if part.rows is None else [list(row) for row in part.rows]
    write_json(folder / _FACTS, {**facts, "motions": [each.trial for each in part.motions], "trials": rows})
    for number, film in enumerate(part.tracked):
        if film.still is not None:
            write_bytes(folder / f"still_{number}.png", film.still)
    for number, motion in enumerate(part.motions):
        leading = (motion.time, motion.depth, motion.radius_nine, motion.radius_ring)
        columns = dict(zip(_LEADING, leading, strict=True))
        for marker in range(motion.moved.shape[1]):
            columns |= {f"{axis}{marker}_mm": motion.moved[:, marker, k] for k, axis in enumerate("xy")}
        write_text(folder / f"motion_{number}.csv", csv_text(columns, where=f"motion of {motion.trial}"))


def read_film(folder: Path) -> FilmPart | None:
    """Read what `write_film` wrote, None where there is nothing; raises KeyError, ValueError, OSError."""
    if not (folder / _FACTS).is_file():
        return None
    facts = json.loads((folder / _FACTS).read_text(encoding="utf-8"))
    tracked = []
    for number, film in enumerate(facts["tracked"]):
        path = folder / f"still_{number}.png"
        tracked.append(StillPart(**film, still=path.read_bytes() if path.is_file() else None))
    motions = (_read_motion(trial, folder / f"motion_{k}.csv") for k, trial in enumerate(facts["motions"]))
    rows = None if facts["trials"] is None else tuple(tuple(row) for row in facts["trials"])
    return FilmPart(facts["count"], facts["synthetic"], tuple(tracked), tuple(motions), rows)


def _read_motion(trial: str, path: Path) -> MotionPart:
    with path.open(encoding="utf-8", newline="") as stream:
        _, *lines = csv.reader(stream)
    table = np.array([[float(cell) if cell else np.nan for cell in line] for line in lines])
    leading = len(_LEADING)
    time, depth, nine, ring = table[:, :leading].T
    return MotionPart(trial, time, depth, nine, ring, table[:, leading:].reshape(len(table), -1, 2))


def _motion_part(motion: MarkerMotion, comparison: MeasuredComparison) -> MotionPart:
    table = next(trial.table for trial in comparison.session.trials if trial.name == motion.trial)
    depth = MM * np.interp(motion.time, table.time, table.depth)
    nine, ring = MM * motion.radius_nine, MM * motion.radius_ring
    return MotionPart(motion.trial, motion.time, depth, nine, ring, MM * motion.moved)


def _rows(filmed: FilmedSession) -> list[Row]:
    """Each trial's stiffness factor, onset and axis (mm), and errors when held out (% of the peak, mm)."""
    sheet = filmed.sheet
    assert sheet is not None
    held_out = {(each.condition, each.name): each for each in sheet.held_out}
    rows: list[Row] = []
    for trial in sheet.trials:
        out, state = held_out.get((trial.condition, trial.name)), trial.state
        places = (MM * state.onset, *(MM * each for each in state.axis))
        errors = (None, None) if out is None else (out.force_percent, out.marker_mm)
        rows.append((trial.name, trial.condition, math.exp(state.log_stiffness), *places, *errors))
    return rows


def film_section(part: FilmPart) -> Section:
    """Return the section on the markers of a session."""
    blocks: list[Block] = [Paragraph(_what(part))]
    for tracked in part.tracked:
        blocks += _still(tracked, part.synthetic)
    for motion in part.motions:
        blocks += _motion_blocks(motion, part.synthetic)
    if part.rows is not None:
        blocks += [_trials(part.rows)]
    return Section("Markers", blocks)


def _what(part: FilmPart) -> str:
    tracked = ", ".join(f"{each.trial} ({each.frames} pictures)" for each in part.tracked)
    text = f"{part.count} trials have markers."
    if tracked:
        text += f" Tracked in this run, from the pictures in the trial's file: {tracked}."
    return text


def _still(tracked: StillPart, synthetic: bool) -> list[Block]:
    if tracked.still is None:
        return []
    caption = (
        f"{tracked.trial} at its farthest motion: what was found is drawn in, a line from where each marker rested. "
        f"{tracked.missing_percent:.2g} % of all sightings are missing."
    )
    caption += " Synthetic picture." if synthetic else ""
    alt = "The picture of the markers with circles around each."
    return [Figure.of_picture(tracked.still, caption, alt, "Tracked markers")]


def _motion_blocks(motion: MotionPart, synthetic: bool) -> list[Block]:
    name = f"{motion.trial} (synthetic)" if synthetic else motion.trial
    blocks: list[Block] = [marker_motion(name, motion.time, motion.moved)]
    if np.isfinite(motion.radius_ring).any():
        blocks.append(circle_radius(name, motion.time, motion.radius_nine, motion.radius_ring, motion.depth))
    return blocks


def _trials(rows: Sequence[Row]) -> Table:
    columns = (
        "trial",
        "condition",
        Column("stiffness factor"),
        Column("contact onset", "mm"),
        Column("tool axis x", "mm", 3),
        Column("tool axis y", "mm", 3),
        Column("force", "% of peak", 3),
        Column("markers", "mm", 3),
    )
    return Table(
        "Each trial fitted by force and markers; the last two columns: root mean square error when it is held out, "
        "predicted with the stiffness of the other trials and its own contact, zero and axis",
        columns,
        rows,
        download=Download("tables/held_out.csv", "the last two columns"),
        folded=False,
    )
