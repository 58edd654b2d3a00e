"""The section on the markers: what the camera saw, how far they moved, and what the fit with them is worth."""

from __future__ import annotations

import math

import numpy as np

from benchmark.fitting import SheetFit
from benchmark.runs.film_tables import Motion
from benchmark.runs.filming import Tracked
from benchmark.runs.measured import FilmedSession, MeasuredComparison
from benchmark.runs.report.measured_section import fit_headline
from benchmark.runs.report.values import MM
from reports import Block, Column, Download, Figure, Paragraph, Section, Table
from reports.figures.markers import circle_radius, marker_motion

SHOWN = 2
"""Films that are shown; the tables have all."""


def film_section(comparison: MeasuredComparison, filmed: FilmedSession) -> Section:
    """Return the section on the markers of a session."""
    synthetic = comparison.session.synthetic
    blocks: list[Block] = [Paragraph(_what(filmed))]
    for tracked in filmed.tracked[:SHOWN]:
        blocks += _still(tracked, synthetic)
    names = [tracked.trial for tracked in filmed.tracked] or [motion.trial for motion in filmed.motions]
    for motion in [each for each in filmed.motions if each.trial in names][:SHOWN]:
        blocks += _motion(motion, comparison)
    if filmed.sheet is not None:
        blocks += [_trials(filmed.sheet)]
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


def _what(filmed: FilmedSession) -> str:
    tracked = ", ".join(f"{each.trial} ({each.frames} pictures)" for each in filmed.tracked)
    text = f"{len(filmed.motions)} trials have markers."
    if tracked:
        text += f" Tracked in this run, from the pictures in the trial's file: {tracked}."
    return text


def _still(tracked: Tracked, synthetic: bool) -> list[Block]:
    if tracked.still is None:
        return []
    caption = (
        f"{tracked.trial} at its farthest motion: what was found is drawn in, a line from where each marker rested. "
        f"{tracked.missing_percent:.2g} % of all sightings are missing."
    )
    caption += " Synthetic picture." if synthetic else ""
    alt = "The picture of the markers with circles around each."
    return [Figure.of_picture(tracked.still, caption, alt, "Tracked markers")]


def _motion(motion: Motion, comparison: MeasuredComparison) -> list[Block]:
    name = f"{motion.trial} (synthetic)" if comparison.session.synthetic else motion.trial
    blocks: list[Block] = [marker_motion(name, motion.time, MM * motion.moved)]
    if motion.block is not None:
        table = next(trial.table for trial in comparison.session.trials if trial.name == motion.trial)
        depth = MM * np.interp(motion.time, table.time, table.depth)
        radii = (MM * motion.radius_nine, MM * motion.radius_ring)
        blocks.append(circle_radius(name, motion.time, *radii, depth))
    return blocks


def _trials(sheet: SheetFit) -> Table:
    held_out = {(each.condition, each.name): each for each in sheet.held_out}
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
    rows = []
    for trial in sheet.trials:
        out = held_out.get((trial.condition, trial.name))
        state = trial.state
        rows.append(
            (
                trial.name,
                trial.condition,
                math.exp(state.log_stiffness),
                MM * state.onset,
                *(MM * each for each in state.axis),
                None if out is None else out.force_percent,
                None if out is None else out.marker_mm,
            )
        )
    return Table(
        "Each trial fitted by force and markers; the last two columns: root mean square error when it is held out, "
        "predicted with the stiffness of the other trials and its own contact, zero and axis",
        columns,
        rows,
        download=Download("tables/held_out.csv", "the last two columns"),
        folded=False,
    )
