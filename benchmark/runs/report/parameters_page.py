"""The page of a fit of parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np

from benchmark.experiments.parameters_answer import ParametersAnswer
from benchmark.files import Session
from benchmark.identification.parameters.held_out import prediction_bands
from benchmark.identification.parameters.identifiability import KNOWN, LARGEST_ERROR, Direction, correlation_words
from benchmark.identification.parameters.identified import Identified
from benchmark.identification.parameters.layer_fit import LayerFit
from benchmark.identification.parameters.posterior import Posterior
from benchmark.identification.pooling import counted_trials
from benchmark.models import Array
from benchmark.runs.report.values import MM, sentence
from reports import Block, Bullets, Column, Download, Fact, Notice, Page, Paragraph, Section, Table, Verdict
from reports.figures.parameter_fit import BandedTrial, ProfileCurve, corner, fitted_bands, profile_curves


def parameters_page(
    session: Session, whole: ParametersAnswer, warnings: Sequence[str], environment: Mapping[str, Any]
) -> Page:
    """Return the page of a fit of parameters."""
    answer, notices = whole.identified, []
    if any(press.session.synthetic for press in answer.found.problem.presses):
        notices.append(Notice("synthetic", "These trials were computed, not measured."))
    if warnings:
        notices.append(Notice("warning", "Read these before you quote a figure.", warnings))
    trials = counted_trials(len(answer.found.problem.trials))
    return Page(
        title=f"{session.name}: parameters",
        subtitle=f"{trials} of {', '.join(answer.specimens)}",
        verdict=Verdict("finding", sentence(whole.headline)),
        facts=(
            Fact("Made", str(environment["made"])),
            Fact("Session", session.fingerprint[:16]),
            Fact("Model", answer.found.problem.forward),
            Fact("Law", answer.found.problem.law or "the specimen's own"),
        ),
        notices=notices,
        sections=(_values(answer), _told_apart(answer, whole.posterior), _fit(answer), _held_out(whole), _next(whole)),
        downloads=(
            Download("identified.toml", "the specimen as identified, for run and sweep"),
            Download("next_experiment.toml", "the D-optimal next experiment as a protocol"),
            Download("fitted_parameters.csv", "parameters with intervals"),
            Download("fit.json", "the fit for programs", media_type="application/json"),
        ),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _values(answer: Identified) -> Section:
    columns = ("parameter", Column("value"), "unit", Column("95 % low"), Column("95 % high"), "determined", "rests on")
    rows = [
        (
            one.key,
            one.value if one.low is not None else None,
            one.unit,
            one.low,
            one.high,
            one.standing,
            one.prior or "the trials alone",
        )
        for one in answer.estimates
    ]
    meant = (
        f"Determined: the 95 % interval ends within a factor of {math.exp(KNOWN):.2g} of the value, and at no point of "
        f"the confidence region the trials alone, without priors, leave a standard error above "
        f"{100 * LARGEST_ERROR:.0f} %."
    )
    blocks: list[Block] = [Table("Free parameters", columns, rows, folded=False), Paragraph(meant)]
    told = [(row.name, row.value, row.unit, row.ci95_low, row.ci95_high, row.source) for row in _told(answer)]
    if told:
        said = ("value", Column("after the fit"), "unit", Column("95 % low"), Column("95 % high"), "told")
        text = (
            "What was told of the set-up is taken with its uncertainty, stated or usual; the intervals above include "
            "it. --exact all takes it away."
        )
        blocks += [Paragraph(text), Table("Told of the set-up, moved along", said, told)]
    return Section("Parameters", blocks)


def _told(answer: Identified) -> list[Any]:
    return [row for row in answer.rows if row.name not in answer.names]


def _told_apart(answer: Identified, drawn: Posterior | None) -> Section:
    found = answer.found
    curves = [
        ProfileCurve(
            name,
            parameter.unit,
            np.array([parameter.scale * parameter.value(float(x)) for x in own.coordinate]),
            own.rise,
            one.value,
            own.quantile**2,
            one.low is not None,
        )
        for name, parameter, own, one in zip(answer.names, answer.free, answer.profiles, answer.estimates, strict=True)
    ]
    blocks: list[Block] = [
        Paragraph("Before the fit, with usual noise, these trials could tell:"),
        Bullets([one.text for one in answer.before]),
        Paragraph("After the fit they tell, the least known first:"),
        Bullets([_with_information(one) for one in answer.directions]),
    ]
    words = correlation_words(found)
    if words:
        blocks.append(Bullets(words))
    blocks.append(profile_curves(curves))
    free = [k for k, one in zip(found.problem.free, answer.estimates, strict=True) if one.low is not None]
    if len(free) > 1:
        parameters = [found.problem.parameters[k] for k in free]
        names = [f"{one.key} ({one.unit})" if one.unit else one.key for one in parameters]
        at = np.log([one.scale * found.value(k) for k, one in zip(free, parameters, strict=True)])
        samples = None if drawn is None else _scaled_draws(answer, drawn, free)
        blocks.append(corner(names, at, found.fit.covariance[np.ix_(free, free)], samples))
    if drawn is not None:
        blocks.append(_draws(answer, drawn))
    return Section("What the trials tell apart", blocks)


def _scaled_draws(answer: Identified, drawn: Posterior, free: Sequence[int]) -> Array:
    """(s, f) logarithms of drawn values in the parameters' units, of those that are shown."""
    parameters, places = answer.found.problem.parameters, [answer.found.problem.free.index(k) for k in free]
    columns = [
        np.log([parameters[k].scale * parameters[k].value(float(x)) for x in drawn.draws[::10, place]])
        for k, place in zip(free, places, strict=True)
    ]
    return np.column_stack(columns)


def _draws(answer: Identified, drawn: Posterior) -> Table:
    columns = ("parameter", Column("95 % low"), Column("95 % high"), Column("R-hat", "", 4), Column("effective draws"))
    told = drawn.to_dict(answer.names, answer.found)["parameters"]
    rows = [(name, *one["ci95"], one["r_hat"], one["effective_samples"]) for name, one in told.items()]
    return Table("Posterior by an ensemble of walkers", columns, rows)


def _with_information(one: Direction) -> str:
    return f"{one.text}; information {one.relative_information:.2g} of the best direction's"


def _fit(answer: Identified) -> Section:
    found, trials = answer.found, []
    bands = prediction_bands(found)
    for one, force, (low, high) in zip(found.problem.trials, found.predicted, bands, strict=True):
        press = found.problem.presses[one.press]
        group = f"{press.session.name}, {MM * press.setup[1].radius:.3g} mm tool"
        trials.append(BandedTrial(one.data.name, group, MM * one.data.depth, one.data.force, force, low, high))
    text = (
        f"Gains of the trials scatter by {100 * found.model.gain_deviation:.2g} %; the model is trusted to "
        f"{_shares(found, 'size')} of the force in each set-up, and to {_shares(found, 'bend')} in bend over depth. "
        f"{found.rounds} rounds of the model; in the "
        f"last one it differed from its surrogate by {100 * found.disagreement:.1g} % of the force."
    )
    if answer.markers is not None:
        own = answer.markers
        text += (
            f" The markers of {own['trials']:.0f} trials are fitted along, in {own['rings']:.0f} rings, of whose mean "
            f"motion {own['residual_um']:.2g} um (rms) are left; each is trusted to {own['trust_percent']:.2g} %."
        )
    synthetic = any(press.session.synthetic for press in found.problem.presses)
    return Section("Fitted against measured", [Paragraph(text), fitted_bands(trials, synthetic)])


def _shares(found: LayerFit, name: Literal["size", "bend"]) -> str:
    """How far the model is trusted in the presses, in words."""
    shares = sorted(100.0 * float(getattr(one, name)) for one in found.problem.errors)
    return f"{shares[0]:.2g} %" if shares[-1] < 1.05 * shares[0] else f"{shares[0]:.2g} to {shares[-1]:.2g} %"


def _held_out(whole: ParametersAnswer) -> Section:
    answer = whole.identified
    if not answer.held_out:
        return Section("Held out", [Paragraph("One condition only: nothing can be held out.")])
    columns = (
        "condition held out",
        Column("trials"),
        Column("residual, rms", "% of peak", 3),
        Column("peaks within the band", "%", 3),
    )
    rows = [(one.condition, one.trials, one.rms_percent, 100.0 * one.covered) for one in answer.held_out]
    text = "Each condition predicted by a fit to the others; its trials keep their own touch and zero."
    blocks: list[Block] = [Paragraph(text), Table("Predictions of what was held out", columns, rows)]
    if whole.laws:
        blocks.append(Paragraph("Laws by what they predict of held-out conditions:"))
        blocks.append(Bullets([one.text for one in whole.laws]))
    return Section("Held out", blocks)


def _next(whole: ParametersAnswer) -> Section:
    """What to measure next, the menu with what each experiment would tell."""
    design, names = whole.design, whole.identified.names
    if design is None:
        return Section("What to measure next", [Paragraph("No experiment of the menu could be worked out.")])
    words = [
        f"D-optimal per minute (next_experiment.toml): {design.best_d.experiment.words}",
        f"A-optimal per minute (next_experiment_a.toml): {design.best_a.experiment.words}",
    ]
    columns: tuple[Column | str, ...] = (
        "experiment",
        Column("minutes", "", 3),
        "determines",
        *(Column(f"{name} after", "% s.e.", 3) for name in names),
    )
    first = ("now", 0.0, f"{int((design.errors_now <= LARGEST_ERROR).sum())} of {len(names)}")
    rows: list[tuple[object, ...]] = [(*first, *(100.0 * design.errors_now))]
    rows += [
        (one.experiment.name, one.minutes, f"{one.determines} of {len(names)}", *(100.0 * one.errors))
        for one in design.proposals
    ]
    return Section("What to measure next", [Bullets(words), Table("The menu, five trials each", columns, rows)])
