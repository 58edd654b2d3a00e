"""The discovery on one screen: where, which effect, what it does to the model, how the gap shrinks, what to do next."""

from __future__ import annotations

import numpy as np

from benchmark.discovery.discovery_result import Candidate, ChannelGap, Place, Trace, channel_unit
from benchmark.discovery.report.disagreement_sections import representative, traced
from benchmark.discovery.report.discovery_record import DiscoveryRecord
from benchmark.discovery.report.effect_sections import ADVICE, OF_A_RUN, shown_by, trials_in_words
from benchmark.discovery.report.words import (
    added_words,
    channel_name,
    compared,
    depths,
    largest_place,
    phase_name,
    probability,
    sized,
)
from benchmark.physics.setup_entry import effect_name
from reports import Story, StoryStep
from reports.figures import repaired
from reports.formatting import format_number

PROTOCOL = "The protocol: next_experiment.toml."
WIDTH = 500.0
"""Of the picture, px: narrower than other pictures, since it must be read on a telephone too."""


def story(record: DiscoveryRecord) -> Story | None:
    """Return the story; None where no trial could be simulated."""
    trace = telling(record)
    if trace is None:
        return None
    measured = record.labels.get("measured", "Measured")
    steps = [_where(record), _which(record), *_does(record, trace), *_gap(record), _next(record)]
    return Story(repaired([traced(trace, record)], record.named, measured, WIDTH), steps)


def telling(record: DiscoveryRecord) -> Trace | None:
    """The trial that shows most: of those that stand for their group, the one whose misfit stands out most.

    Where the gap of a channel shrinks, of those channels, else of those in which they disagree. The misfit is over the
    scatter of replicates where all tell it, else over the channel's largest value: a channel in which nothing but noise
    happens would be all misfit.
    """
    shown = representative(record.found.traces)
    told = {gap.channel for gap in _closing(record)} or {place.channel for place in record.found.where}
    shown = [trace for trace in shown if trace.channel in told] or shown
    over_noise = all(rms(trace.noise) > 0.0 for trace in shown)
    return max(shown, key=lambda trace: _misfit(trace, over_noise), default=None)


def _misfit(trace: Trace, over_noise: bool) -> float:
    """Of the model before, over replicates' scatter or over the channel's largest value."""
    size = rms(trace.noise) if over_noise else float(np.nanmax(np.abs(trace.measured), initial=0.0))
    return rms(trace.measured - trace.before) / size if size > 0.0 else 0.0


def rms(residual: np.ndarray) -> float:
    """Root mean square of what was measured; 0 of nothing."""
    present = residual[np.isfinite(residual)]
    return float(np.sqrt(np.mean(present**2))) if present.size else 0.0


def _where(record: DiscoveryRecord) -> StoryStep:
    found = record.found
    if not found.where:
        text = "Not tested" if found.p is None else "Nowhere beyond chance"
        return StoryStep("Where", text, "" if found.p is None else f"{probability(found.p)} over all places.")
    place = largest_place(found.where)
    answer = f"{channel_name(place.channel)}, {phase_name(place.phase)}: {_signed(place)}, {compared(place)}"
    more = len(found.where) - 1
    others = f"; {more} more place{'s' * (more != 1)} below" if more else ""
    return StoryStep("Where", answer, f"{_range(place)}, {probability(place.p)}{added_words(place)}{others}.")


def _signed(place: Place) -> str:
    """Measured minus simulated, with its share of the signal: +0.61 N (16 %)."""
    sign = "±" if place.either_way else "+" if place.missed > 0 else "−"
    return f"{sign}{sized(place.channel, abs(place.missed))} ({format_number(abs(place.percent_of_signal), 2)} %)"


def _range(place: Place) -> str:
    condition = f"{place.condition}, " if place.condition else ""
    return f"{condition}{depths(place)} deep"


def _which(record: DiscoveryRecord) -> StoryStep:
    found = record.found
    if not record.named:
        nearest = ", ".join(effect_name(effect.slug) for effect in found.effects)
        return StoryStep("Which effect", "None is named", f"Nearest: {nearest}." if nearest else "")
    answer = " and ".join(effect_name(effect.slug) for effect in found.effects)
    alike = sorted({name for effect in found.effects for name in effect.lookalikes})
    if alike:
        return StoryStep(
            "Which effect", f"{answer}, or {' or '.join(map(effect_name, alike))}", "These data do not separate them."
        )
    return StoryStep("Which effect", answer, _rival(record))


def _rival(record: DiscoveryRecord) -> str:
    """How sure, against the best candidate that is not part of the answer."""
    answer = {effect.slug for effect in record.found.effects}
    share = format_number(100.0 * record.found.effects[0].confidence, 3, trim=True)
    if record.source == "run":
        return f"{share} % {OF_A_RUN}."
    first = next((each for each in record.found.candidates if set(each.slugs) <= answer), None)
    second = next((each for each in record.found.candidates if not set(each.slugs) <= answer), None)
    if first is None or second is None or not first.gain > 0.0:
        return f"Confidence {share} %."
    return f"Confidence {share} %. Best rival: {_named(second)}, which gains {_share(second, first)} % as much."


def _named(candidate: Candidate) -> str:
    return " + ".join(map(effect_name, candidate.slugs))


def _share(candidate: Candidate, best: Candidate) -> str:
    return format_number(max(100.0 * candidate.gain / best.gain, 0.0), 2)


def _does(record: DiscoveryRecord, trace: Trace) -> list[StoryStep]:
    """What the effect does to the model in the trial of the picture."""
    if not record.named:
        return []
    unit, scale = channel_unit(trace.channel)
    before, after = (format_number(scale * rms(trace.measured - each), 2) for each in (trace.before, trace.after))
    held = ", which the fit has not seen" if trace.held_out else ""
    noise = rms(trace.noise)
    spread = f"; replicates scatter by {format_number(scale * noise, 2)} {unit}" if noise > 0.0 else ""
    detail = f"Root mean square in {trace.trial}{held}{spread}."
    return [StoryStep("What it does to the model", f"Misfit {before} → {after} {unit}", detail)]


def _gap(record: DiscoveryRecord) -> list[StoryStep]:
    """The gap on data that the fit has not seen, in the channel where most was to be closed."""
    closed = _closing(record)
    if not closed:
        return []
    gap = max(closed, key=lambda each: each.rmse_before / max(each.noise_floor or 0.0, 1e-3 * each.rmse_before))
    unit, scale = channel_unit(gap.channel)
    before, after = (format_number(scale * each, 2) for each in (gap.rmse_before, gap.rmse_after))
    held = record.labels.get("held_out", f"a {gap.held_out} that the fit has not seen")
    detail = f"{channel_name(gap.channel)} {before} → {after} {unit} on {held}{_floor(gap)}."
    return [StoryStep("How the gap shrinks", _closed(gap), detail[0].upper() + detail[1:])]


def _closing(record: DiscoveryRecord) -> list[ChannelGap]:
    """The gaps of which it is known how far the named effects close them: where model and trials disagree, if there."""
    known = [gap for gap in record.found.gap if gap.closed is not None] if record.named else []
    told = {place.channel for place in record.found.where}
    return [gap for gap in known if gap.channel in told] or known


def _closed(gap: ChannelGap) -> str:
    low, high = gap.ci95 or (None, None)
    share = format_number(100.0 * (gap.closed or 0.0), 3, trim=True)
    if low is None or high is None:
        return f"{share} % of it is closed"
    ends = " to ".join(format_number(100.0 * end, 3, trim=True) for end in (low, high))
    return f"{share} % of it is closed (95 % {ends})"


def _floor(gap: ChannelGap) -> str:
    if gap.noise_floor is None:
        return "; how far replicates part is unknown"
    unit, scale = channel_unit(gap.channel)
    return f"; replicates part by {format_number(scale * gap.noise_floor, 2)} {unit}" if gap.noise_floor > 0.0 else ""


def _next(record: DiscoveryRecord) -> StoryStep:
    proposal = record.proposal
    if proposal is None and record.rounds:
        done = "; ".join(each.choice for each in record.rounds)
        return StoryStep("What was measured", f"{len(record.rounds)} more experiments: {done}", "See the rounds below.")
    if proposal is None:
        return StoryStep("What to measure next", record.labels.get("next", ADVICE[record.found.verdict]))
    first, second = map(effect_name, proposal.rivals)
    if proposal.opens:
        return StoryStep("What to measure next", proposal.words, f"{shown_by(proposal)} {PROTOCOL}")
    detail = (
        f"Expected to set {first} and {second} {proposal.separation:.0f} standard deviations apart, now "
        f"{proposal.separation_now:.0f}; {trials_in_words(proposal.trials)}, {proposal.minutes:.0f} min at the bench. "
        f"{PROTOCOL}"
    )
    return StoryStep("What to measure next", proposal.words, detail)
