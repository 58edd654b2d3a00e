"""Section: the published membrane, its animation (Fig. 11 of the article) and Table 1 computed anew."""

from __future__ import annotations

import numpy as np

from reports import Column, Figure, Paragraph, Section, Table
from reports.figures import moving_surface
from wavemodel.published import PublishedWave, table_one

VERTICES, FRAMES = 25, 16
LABELS = {"as_printed": "as printed", "corrected": "corrected"}
PROTOCOL = (
    "The published membrane is shown and not compared: it returns the depth that it is fed (corrected) or 39.2 times "
    "that (as printed), so a comparison would be circular. Its columns in the tables are empty."
)


def published_section() -> Section:
    """Return the section of a run whose wave model is `published`."""
    blocks = [Paragraph(PROTOCOL), *(published_animation(variant) for variant in LABELS), _table()]
    return Section("The published membrane", blocks)


def published_frames(variant: str) -> tuple[np.ndarray, list[np.ndarray]]:
    """(P,) positions in mm along each side, and (P, P) heights in mm of eq. (7): down from z = 0 and back to it."""
    wave = PublishedWave(variant)
    side = np.linspace(0.0, wave.side, VERTICES)
    quarter = 0.5 * np.pi / wave.frequency[0, 0]
    times = quarter * np.abs(1.0 - 2.0 * np.arange(FRAMES) / FRAMES)
    return 1e3 * side, [-1e3 * wave.deflection(side, side, time) for time in times.tolist()]


def published_animation(variant: str) -> Figure:
    """Return eq. (7) of a variant as a moving picture (Fig. 11)."""
    side, frames = published_frames(variant)
    peak = -float(min(frame.min() for frame in frames))
    period = 4e3 * 0.5 * np.pi / PublishedWave(variant).frequency[0, 0]
    return Figure.of_picture(
        moving_surface(side, side, frames),
        f"Eq. (7) of the article, {LABELS[variant]}: half an oscillation of {period:.4g} ms, slowed down, from rest to "
        f"{peak:.1f} mm and back. The article prints 39.2012 mm, where eq. (3) gives 31.7788 mm, for 2 mm pressed.",
        f"An animated surface of {side[-1]:.1f} mm a side whose middle sinks by {peak:.1f} mm and comes back.",
        f"The published wave, {LABELS[variant]} (Fig. 11)",
    )


def _table() -> Table:
    rows = [(row.item, row.printed, row.value, "yes" if row.agrees else "no", row.reason) for row in table_one()]
    columns = (Column("item"), Column("printed"), Column("recomputed"), Column("agrees"), Column("why"))
    return Table("Table 1 of the article, computed anew from its other printed numbers.", columns, rows)
