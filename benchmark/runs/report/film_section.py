"""The section on the markers: what the camera saw, how far they moved, and what the fit with them is worth."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.fitting import SheetFit
from benchmark.runs.measured import MeasuredComparison
from benchmark.runs.report.film_part import FilmPart, MotionPart, Row, StillPart
from benchmark.runs.report.measured_section import fit_headline
from reports import Block, Column, Download, Figure, Paragraph, Section, Table
from reports.figures.markers import circle_radius, marker_motion


def film_section(part: FilmPart) -> Section:
    """Return the section on the markers of a session."""
    blocks: list[Block] = [Paragraph(_what(part))]
    for tracked in part.tracked:
        blocks += _still(tracked, part.synthetic)
    for motion in part.motions:
        blocks += _motion(motion, part.synthetic)
    if part.rows is not None:
        blocks += [_trials(part.rows)]
    return Section("Markers", blocks)


def sheet_headline(sheet: SheetFit) -> str:
    """Return the fit of force and markers in one sentence."""
    found = sheet.stiffness
    text = (
        f"force and markers of {found.trials} trials together: the specimen is {found.value:.4g} times as stiff as its "
        f"file says (95 % {found.low:.4g} to {found.high:.4g})"
    )
    if sheet.relaxation.share > 0.0 and sheet.share is not None:
        text += (
            f"; its force relaxes by {100 * sheet.relaxation.share:.3g} % (95 % {100 * sheet.share.low:.3g} to "
            f"{100 * sheet.share.high:.3g}) within some {sheet.relaxation.tau:.3g} s"
        )
    return text


def measured_headline(comparison: MeasuredComparison) -> str:
    """Return the fit behind a run in one sentence: of force and markers where there are markers."""
    sheet = None if comparison.filmed is None else comparison.filmed.sheet
    return fit_headline(comparison.fit) if sheet is None else sheet_headline(sheet)


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


def _motion(motion: MotionPart, synthetic: bool) -> list[Block]:
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
