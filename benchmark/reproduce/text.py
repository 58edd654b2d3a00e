"""Numbers of the article's text that the same evidence gives."""

from __future__ import annotations

import numpy as np

from benchmark.reproduce import printed
from benchmark.reproduce.evidence import Evidence
from benchmark.reproduce.item import RUN, SESSION, Item, compare


def text_items(evidence: Evidence) -> tuple[Item, ...]:
    """Return r^2 of the parabolas and the average percent error."""
    r2, trials = evidence.chain.r2, evidence.chain.trials
    whose = "synthetic " if evidence.chain.synthetic else ""
    reason = (
        f"over {r2.size} parabolas of {trials} {whose}trials, after the same moving average: another specimen, with "
        "markers that hardly move along one axis; an agreement would be chance"
    )
    each = [comparison.percent.mean for comparison in evidence.press.comparisons if comparison.percent is not None]
    how = (
        "mean over the layers of skin, the layered wave against the FEM under 5 N; the article's wave was fed the "
        "FEM's maximum, so its error is one of reading off, ours one of prediction"
    )
    return (
        compare(
            "Section 3.2.5: r² of the parabolas, average", printed.R2_MEAN, float(np.nanmean(r2)), reason, "", SESSION
        ),
        compare("Section 3.2.5: r², largest", printed.R2_LARGEST, float(np.nanmax(r2)), reason, "", SESSION),
        compare("Section 3.2.5: r², smallest", printed.R2_SMALLEST, float(np.nanmin(r2)), reason, "", SESSION),
        compare("Section 3.5: average percent error", printed.PERCENT_ERROR, float(np.mean(each)), how, "%", RUN),
    )
