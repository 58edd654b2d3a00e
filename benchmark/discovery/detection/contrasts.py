"""One contrast a physical question, put to the base's residuals, trial by trial."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.cells import CellTable, flip_test
from benchmark.discovery.detection.disagreement import Detection
from benchmark.discovery.discovery_result import PHASES, Contrast

Pick = Callable[[CellTable, int], bool]


def contrasts(fitted: Fit, detection: Detection, settings: Settings) -> tuple[Contrast, ...]:
    """Load less unload, late less early hold, second less first cycle, after lift-off; and the trend over trials."""
    table, study = detection.table, fitted.model.problem.study
    found: list[tuple[str, str, np.ndarray]] = []
    for signal, channel in enumerate(study.channels):
        if channel in study.channels[:signal]:
            continue
        for question, one, other in QUESTIONS:
            row = _mean(table, signal, one)
            if other is not None:
                row = row - _mean(table, signal, other)
            found.append((question, channel, row))
    found = [(question, channel, row) for question, channel, row in found if np.isfinite(row).all()]
    if not found:
        return ()
    out = []
    for question, channel, row in found:
        small = CellTable(table.cells[:1], row[None], table.groups)
        test = flip_test(small, settings.flips, settings.seed)
        out.append(Contrast(question, channel, float(row.mean()), min(1.0, float(test.p[0]) * len(found))))
    return tuple(sorted(out, key=lambda each: each.p))


def _phase(*names: str) -> Pick:
    wanted = [PHASES.index(name) for name in names]
    return lambda table, k: table.cells[k].phase in wanted


def _half(part: int) -> Pick:
    hold = PHASES.index("hold")
    return lambda table, k: table.cells[k].phase == hold and table.cells[k].part == part


def _cycle(number: int) -> Pick:
    load = PHASES.index("load")
    return lambda table, k: table.cells[k].phase == load and table.cells[k].cycle == number


QUESTIONS: tuple[tuple[str, Pick, Pick | None], ...] = (
    ("load less unload", _phase("load"), _phase("unload_high", "unload_low")),
    ("late less early in the hold", _half(1), _half(0)),
    ("second less first loading", _cycle(2), _cycle(1)),
    ("after lift-off", _phase("after_lift_off"), None),
)


def _mean(table: CellTable, signal: int, pick: Pick) -> np.ndarray:
    """(R,) mean of each trial over the cells of a signal that are picked; NaN where there are none."""
    rows = [k for k, cell in enumerate(table.cells) if cell.signal == signal and pick(table, k)]
    out = np.full(table.means.shape[1], np.nan)
    if not rows:
        return out
    means = table.means[rows]
    known = np.isfinite(means)
    some = known.any(axis=0)
    out[some] = np.nansum(means[:, some], axis=0) / known[:, some].sum(axis=0)
    return out
