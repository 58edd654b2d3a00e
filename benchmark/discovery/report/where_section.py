"""Where measurement and model disagree, as a map, and the contrasts in words."""

from __future__ import annotations

from benchmark.discovery.record import DiscoveryRecord
from benchmark.discovery.report.words import channel_name, phase_name, probability, sized
from benchmark.discovery.result import PHASES, Contrast, Place
from benchmark.discovery.units import channel_unit
from reports import Block, Bullets, Column, Download, Paragraph, Section, Subsection, Table
from reports.figures import Disagreement, where_map

MOST_ROWS = 8


def where_section(record: DiscoveryRecord) -> Section:
    """Return the map of significant cells, their table, and the contrasts."""
    found = record.found
    if not found.where:
        nothing = f"No place in which the disagreement is more than chance ({probability(found.p)} over all places)."
        text = record.labels.get("where", nothing)
        return Section("Where", [Paragraph(text), *_contrasts(found.contrasts)])
    cells = [_cell(place, record) for place in found.where]
    rows = list(dict.fromkeys(cell.row for cell in sorted(cells, key=lambda cell: not cell.row.startswith("press"))))
    text = (
        f"Family-wise {probability(found.p)} for any disagreement, by sign flips of whole trials. "
        f"{len(found.where)} place{'s are' if len(found.where) > 1 else ' is'} significant on their own."
    )
    blocks: list[Block] = [Paragraph(record.labels.get("where", text))]
    blocks += [where_map(cells, rows[:MOST_ROWS], list(map(phase_name, PHASES)))] if len(rows) <= MOST_ROWS else []
    return Section("Where", [*blocks, _table(record), *_contrasts(found.contrasts)])


def _cell(place: Place, record: DiscoveryRecord) -> Disagreement:
    several = len(record.found.conditions) > 1
    row = channel_name(place.channel) + (f", {place.condition}" if several and place.condition else "")
    return Disagreement(
        row,
        phase_name(place.phase),
        place.cycle,
        (1e3 * place.depth[0], 1e3 * place.depth[1]),
        abs(place.percent_of_signal) * (1.0 if place.size >= 0 else -1.0),
        sized(place.channel, place.size),
        place.p,
    )


def _table(record: DiscoveryRecord) -> Table:
    columns = (
        "channel", "phase", "condition", "cycle", Column("from", "mm", 3), Column("to", "mm", 3),
        Column("measured minus simulated", "", 3), "unit", Column("of the signal", "%", 3), Column("p", "", 2),
    )  # fmt: skip
    rows = [
        (
            channel_name(place.channel),
            phase_name(place.phase),
            place.condition,
            place.cycle or None,
            *(1e3 * end for end in place.depth),
            channel_unit(place.channel)[1] * place.size,
            channel_unit(place.channel)[0],
            place.percent_of_signal,
            place.p,
        )
        for place in record.found.where
    ]
    return Table(
        "Places that are significant, largest first", columns, rows, Download("tables/where.csv", "the same"), True
    )


def _contrasts(contrasts: tuple[Contrast, ...]) -> list[Block]:
    """The contrasts as sentences."""
    if not contrasts:
        return []
    items = [
        f"{contrast.question} ({channel_name(contrast.channel)}): {sized(contrast.channel, contrast.size)}, "
        f"{probability(contrast.p)}"
        for contrast in contrasts
    ]
    return [Subsection("One question at a time", [Bullets(items)])]
