"""Section: compute time of both models."""

from __future__ import annotations

from benchmark.models.wave_parts import REACH, VERTICES
from benchmark.runs.record import RunRecord
from benchmark.runs.report.values import pair_names, setup_words, speedup_words
from benchmark.side_by_side import NAMES, ModelRun
from reports import Block, Column, Download, Paragraph, Section, Table
from reports.figures.timing import timing

PRINTED = {"FEA, printed in the article": 240.0, "wave equation, printed in the article": 10.0}


def timing_section(record: RunRecord) -> Section:
    """Return the section on timing."""
    runs = [run for run in (record.pair.fem, record.pair.wave) if run.repeats]
    if not runs:
        text = "Nothing was timed: a load history that stops early, or a single model, is not the job to be timed."
        return Section("Compute time", (Paragraph(text),))
    blocks: list[Block] = [Paragraph(_words(record)), _table(runs)]
    walls = {run.model: [seconds.wall for seconds in run.repeats] for run in runs}
    setups = {run.model: seconds.setup for run in runs if (seconds := run.seconds) is not None}
    blocks.append(timing(walls, setups, PRINTED, pair_names(record)))
    return Section("Compute time", blocks)


def _words(record: RunRecord) -> str:
    ratio = record.pair.speedup
    text = (
        "Wall and CPU seconds of the whole load history, each model alone in a process with one thread, repeats "
        "interleaved; set-up (mesh, tables, factorisations) and the reading of profiles and fields apart. A frame is a "
        f"load step and a picture of every layer's deflected face: for the wave on {VERTICES} x {VERTICES} vertices, "
        f"{REACH:g} tool radii to each side, for the finite elements their nodes, which the step gives. "
    )
    if ratio is None:
        return text + "No speed-up: only one model was timed."
    fem, wave = record.pair.fem.name, record.pair.wave.name
    return text + (
        f"Speed-up of the load history alone, {fem} wall over {wave} wall: median {speedup_words(ratio)}; "
        f"{setup_words(ratio, wave)}. The article printed 4 minutes against 10 seconds."
    )


def _table(runs: list[ModelRun]) -> Table:
    columns = (
        "model",
        Column("unknowns"),
        Column("repeats"),
        Column("set-up", "s"),
        Column("wall", "s"),
        Column("CPU", "s"),
        Column("wall per load step", "ms"),
        Column("wall per frame", "ms"),
        Column("peak memory", "MB"),
    )
    rows: list[tuple[object, ...]] = []
    for run in runs:
        seconds, result = run.seconds, run.result
        if seconds is None or result is None:
            continue
        per_step = 1e3 * seconds.wall / max(result.time.size, 1)
        memory = None if run.peak_memory is None else run.peak_memory / 1e6
        times = (seconds.setup, seconds.wall, seconds.cpu, per_step, _per_frame(run, per_step))
        rows.append((run.name, result.unknowns, len(run.repeats), *times, memory))
    rows.extend((label, None, None, None, wall, None, None, None, None) for label, wall in PRINTED.items())
    return Table(
        "Medians over the repeats; memory is that of the process with its libraries; the last lines are printed claims",
        columns,
        rows,
        download=Download("tables/timing.csv", "every repeat"),
        folded=False,
    )


def _per_frame(run: ModelRun, per_step: float) -> float | None:
    """Wall ms of a frame; None of a model without pictures, such as a user's own."""
    if run.frame is not None:
        return per_step + 1e3 * run.frame
    return per_step if run.name == NAMES["fem"] else None
