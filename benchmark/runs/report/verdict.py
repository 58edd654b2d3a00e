"""The verdict of a run: what the reader must know first, in the words the statistics allow."""

from __future__ import annotations

from benchmark.runs.record import RunRecord
from benchmark.runs.report.measured_section import sentence
from benchmark.runs.report.values import peak_errors
from benchmark.runs.small_strain import NOTE
from reports import Verdict


def run_verdict(record: RunRecord, fit: str | None = None) -> Verdict:
    """Return the verdict of a run; `fit` is what its trials told, in one sentence."""
    if not record.complete:
        stops = [str(result.failure) for result in record.results if result.failure is not None]
        return Verdict("incomplete", "A solver stopped before the end of the load history.", stops)
    if record.pair.fem.result is None or record.pair.wave.result is None:
        return _one_sided(record, fit)
    return _agreement(record, fit)


def _one_sided(record: RunRecord, fit: str | None) -> Verdict:
    """A model has no values: nothing to compare it with, but the trials may still have told something."""
    missing = [run for run in (record.pair.fem, record.pair.wave) if run.result is None]
    names = " and ".join(run.name for run in missing)
    nothing = f"Nothing to compare the models by: {names} without values here"
    points = [f"{nothing}, because {run.declined}" for run in missing]
    if fit is None:
        return Verdict("finding", f"{nothing}.", [str(run.declined) for run in missing])
    return Verdict("finding", sentence(fit), points)


def _agreement(record: RunRecord, fit: str | None) -> Verdict:
    """Whether equivalence is shown, where both models have values."""
    margin = f"{100 * record.scenario.comparison.equivalence_margin:g} % of the FEM's mean"
    shown = [c for c in record.comparisons if c.statistics is not None and c.statistics.equivalence.equivalent]
    errors = peak_errors(record)
    wave, fem = record.pair.wave.name, record.pair.fem.name
    points = [f"{name}: {wave} against {fem} {error:+.2f} % at peak load" for name, error in errors.items()]
    if record.pair.speedup is not None:
        ratio = record.pair.speedup
        points.append(
            f"the {wave} follows the load history {ratio.median:,.0f} times as fast "
            f"(95 % {ratio.ci95[0]:.3g} to {ratio.ci95[1]:.3g}, {ratio.repeats} interleaved repeats, one thread each)"
        )
    result = record.pair.wave.result
    points.extend([result.notes[NOTE]] if result is not None and NOTE in result.notes else [])
    points.extend([] if fit is None else [fit])
    worst = max(errors.values(), key=abs, default=float("nan"))
    if len(shown) == len(record.comparisons):
        headline = f"{wave} and {fem} are equivalent within {margin} in every layer's maximum deformation"
        if abs(worst) > 100 * record.scenario.comparison.equivalence_margin:
            at_peak = f"at peak load the {wave} is off by up to {worst:+.1f} %"
            return Verdict("finding", sentence(f"{headline} on average over the load history, but {at_peak}"), points)
        return Verdict("good", sentence(headline), points)
    headline = (
        f"Equivalence within {margin} is not shown in {len(record.comparisons) - len(shown)} of "
        f"{len(record.comparisons)} layers; the {wave} is off by up to {worst:+.1f} % at peak load."
    )
    return Verdict("finding", headline, points)
