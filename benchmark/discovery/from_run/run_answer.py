"""The wave model of a finished run, repaired against the run's finite elements.

A run is no experiment: one press, no replicates, no noise. So nothing is tested; candidates that gain by BIC where they
are fitted are ranked by what they leave on the loads that were held out, and the verdict is `conditional` at best.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import (
    Array,
    Candidate,
    ChannelGap,
    Discovery,
    Estimate,
    NamedEffect,
    Trace,
)
from benchmark.discovery.from_run.body_effects import BodyEffectFit, fit_body_effect
from benchmark.discovery.from_run.finished_run import FinishedRun
from benchmark.discovery.from_run.run_case import RunCase, contrasts, layer_gaps, places, split
from benchmark.discovery.report.discovery_record import DiscoveryRecord, LayerGap
from benchmark.physics import Effect
from benchmark.response.pipeline import physics_of
from benchmark.runs.options import Listener
from wavemodel.physics import Physics


def repair_run(
    run: FinishedRun, other: FinishedRun | None, effects: Sequence[Effect], seed: int, listener: Listener
) -> DiscoveryRecord:
    """Find the effect of the body that brings a run's wave model to its finite elements.

    Parameters
    ----------
    run
        Its lower loads are fitted, its upper half held out.
    other
        A second run: then all loads of the first are fitted, and all of the second held out.
    effects
        Candidates; those that do not act on the body are left out.
    seed
        Noted; nothing here is drawn.
    listener
        Told of progress.

    Raises
    ------
    InputError
        Too few loads to fit.
    """
    began = time.perf_counter()
    fitted, judged = split(run, other)
    fits = _fits(
        [effect for effect in effects if effect.body is not None and not effect.needs_markers], fitted, listener
    )
    answer = _Answer(fitted, judged, fits)
    found = answer.discovery(time.perf_counter() - began)
    changed = tuple(one.changed for one in (run, other) if one is not None and one.changed)
    return DiscoveryRecord(
        name=run.name,
        source="run",
        fingerprint=run.fingerprint,
        synthetic=True,
        tissue=run.scenario.tissue.name,
        model="wave",
        found=replace(found, warnings=(*changed, *found.warnings)),
        cards={effect.slug: effect.description for effect in effects},
        seed=seed,
        layers=answer.layers,
        labels=_labels(answer),
        large_press=run.large_press,
    )


def _fits(effects: Sequence[Effect], case: RunCase, listener: Listener) -> tuple[BodyEffectFit, ...]:
    """The candidates that have an answer."""
    fits: list[BodyEffectFit] = []
    with listener.progress(f"{case.run.name}: effects of the body against the finite elements") as advance:
        for number, effect in enumerate(effects, start=1):
            fit = fit_body_effect(effect, case)
            fits += [] if fit is None else [fit]
            best = min(fits, key=lambda each: each.delta_bic, default=None)
            advance("candidates", number, len(effects), "" if best is None else f"best fit so far {best.effect.slug}")
    return tuple(fits)


def _gains(fit: BodyEffectFit) -> bool:
    """Whether a fit is better than the base where it was made."""
    return fit.delta_bic <= criteria.RUN_BIC


class _Answer:
    """The pieces of the answer, each from the fits and the two cases."""

    def __init__(self, fitted: RunCase, judged: RunCase, fits: Sequence[BodyEffectFit]):
        self.fitted, self.judged = fitted, judged
        self.margin = fitted.run.scenario.comparison.equivalence_margin
        self.gaps = {fit.effect.slug: self._gap(fit) for fit in fits}
        self.fits = sorted(fits, key=lambda fit: (not _gains(fit), self.gaps[fit.effect.slug]))
        self.best = self.fits[0] if fits else None
        before = layer_gaps(judged)
        self.verdict = self._verdict(before)
        repaired = self.best if self.verdict == "conditional" else None
        self.layers = before if repaired is None else layer_gaps(judged, _physics(repaired, judged))

    def force_after(self, case: RunCase) -> Array:
        """(n,) N with the best candidate at the reference's depths; the base's where there is none."""
        if self.best is None or self.verdict == "no_discrepancy":
            return case.force()
        return case.force(_physics(self.best, case))

    def _gap(self, fit: BodyEffectFit) -> float:
        """Root mean square left on the held-out rows, N."""
        case = self.judged
        return _rms((case.force(_physics(fit, case)) - case.run.force)[case.held])

    @property
    def before(self) -> float:
        """Root mean square of the base on the held-out rows, N."""
        return _rms((self.judged.force() - self.judged.run.force)[self.judged.held])

    def closed(self, fit: BodyEffectFit) -> float | None:
        """Share of the held-out mean square that is gone."""
        return None if self.before == 0.0 else 1.0 - (self.gaps[fit.effect.slug] / self.before) ** 2

    def _verdict(self, layers: Sequence[LayerGap]) -> str:
        if max(abs(layer.peak_before) for layer in layers) < 100.0 * self.margin:
            return "no_discrepancy"
        if self.best is None or not _gains(self.best) or (self.closed(self.best) or 0.0) < criteria.RUN_ENOUGH:
            return "outside_catalogue"
        return "conditional"

    def discovery(self, seconds: float) -> Discovery:
        """The answer in the terms of every discovery."""
        return Discovery(
            verdict=self.verdict,
            statement=self.statement(),
            p=None,
            effects=self.effects(),
            where=places(self.fitted, self.smallest),
            contrasts=contrasts(self.fitted),
            gap=(self.channel_gap(),),
            smallest_visible={"force_z": self.smallest},
            candidates=tuple(self.candidate(fit) for fit in self.fits),
            base=(),
            remains=self.remains(),
            warnings=self.warnings(),
            traces=self.traces(),
            conditions=self.names,
            channels=("force_z",),
            trials=self.names,
            seconds=seconds,
        )

    @property
    def names(self) -> tuple[str, ...]:
        """The runs."""
        return tuple(dict.fromkeys((self.fitted.run.name, self.judged.run.name)))

    @property
    def smallest(self) -> float:
        """What counts as a difference, N: the scenario's margin of the peak force."""
        return float(self.margin * self.fitted.run.force.max())

    def statement(self) -> str:
        """The answer in one sentence."""
        worst = max((layer.peak_before for layer in self.layers), key=abs)
        if self.verdict == "no_discrepancy":
            return f"Wave model and FEM agree within {100 * self.margin:g} % in every layer: nothing is missing."
        if self.verdict == "outside_catalogue" or self.best is None:
            return f"The wave model is off by up to {worst:+.1f} % at peak load, and no effect explains it."
        after = max((layer.peak_after for layer in self.layers), key=abs)
        slug = self.best.effect.slug.replace("_", " ")
        return (
            f"The wave model lacks {slug}: with it the worst layer's error at peak load goes from {worst:+.1f} % to "
            f"{after:+.1f} %, on loads that the fit has not seen."
        )

    def effects(self) -> tuple[NamedEffect, ...]:
        """The best candidate; nothing where nothing is missing."""
        if self.best is None or self.verdict == "no_discrepancy":
            return ()
        left = self.gaps[self.best.effect.slug]
        alike = [
            slug
            for slug, gap in self.gaps.items()
            if gap <= criteria.RUN_ALIKE * left and slug != self.best.effect.slug
        ]
        units = {parameter.name: parameter.unit for parameter in self.best.effect.description.parameters}
        estimates = tuple(
            Estimate(name, value, units[name], self.best.ci95[name]) for name, value in self.best.values.items()
        )
        return (NamedEffect(self.best.effect.slug, self._weight(), tuple(alike), estimates),)

    def _weight(self) -> float:
        """The best candidate's share of the likelihood of the held-out loads, one observation a load level."""
        levels = np.unique(np.round(self.judged.run.force[self.judged.held], 9)).size
        in_question = [fit for fit in self.fits if _gains(fit) == _gains(self.fits[0])]
        left = np.maximum([self.gaps[fit.effect.slug] for fit in in_question], criteria.RUN_EXACT * self.before)
        return float(1.0 / np.sum((left[0] / left) ** levels))

    def candidate(self, fit: BodyEffectFit) -> Candidate:
        """A fit as evidence; there is no z without replicates."""
        return Candidate((fit.effect.slug,), math.nan, math.nan, math.nan, fit.delta_bic, self.closed(fit), None)

    def channel_gap(self) -> ChannelGap:
        """The force at the reference's depth, on held-out loads."""
        used = self.best if self.verdict != "no_discrepancy" else None
        after = self.before if used is None else self.gaps[used.effect.slug]
        closed = None if used is None else self.closed(used)
        held = "trial" if self.fitted is self.judged else "condition"
        return ChannelGap("force_z", self.before, after, 0.0, closed, None, held)

    def remains(self) -> tuple[str, ...]:
        """What each layer is still off by."""
        over = [layer for layer in self.layers if abs(layer.peak_after) > 100.0 * self.margin]
        return tuple(
            f"{layer.layer}: {layer.peak_after:+.1f} % at peak load, beyond the margin of {100 * self.margin:g} %"
            for layer in over
        )

    def warnings(self) -> tuple[str, ...]:
        """What a reader must know."""
        said = [
            "the measurement is a finished run: one press without replicates or noise, so nothing is tested; "
            "the intervals are those of the fit's curvature, and the verdict is conditional at best"
        ]
        if self.fitted.run.effects:
            had = ", ".join(self.fitted.run.effects)
            said.append(f"the run's wave model already had {had}: what is found comes on top of it")
        if self.fitted.run.restarted:
            said.append(
                "the run's wave model follows finite strain by itself (wave.large_press = auto); the repair begins "
                "with the wave of small strain, and 'before' is that one"
            )
        return tuple(said)

    def traces(self) -> tuple[Trace, ...]:
        """Force over depth of each run."""
        cases = [self.fitted] if self.fitted is self.judged else [self.fitted, self.judged]
        return tuple(self._trace(case) for case in cases)

    def _trace(self, case: RunCase) -> Trace:
        return Trace(
            trial=case.run.name,
            condition=case.run.name,
            channel="force_z",
            held_out=case is self.judged and case is not self.fitted,
            time=case.run.time,
            depth=case.depth,
            measured=case.run.force,
            before=case.force(),
            after=self.force_after(case),
            noise=np.zeros(case.run.time.size),
        )


def _labels(answer: _Answer) -> dict[str, str]:
    """What the page says where a run is not a session."""
    same = answer.fitted is answer.judged
    held = "the upper half of the loads" if same else f"all loads of {answer.judged.run.name}"
    return {
        "measured": "FEM",
        "held_out": f"{held}, which the fit has not seen",
        "comparison": f"Force over depth: the finite elements of the run, and the wave model at the same depths. "
        f"Fitted: {'its lower loads' if same else 'all loads of ' + answer.fitted.run.name}; held out: {held}.",
        "where": "Where the wave model's force at the reference's depth differs by more than the scenario's margin of "
        "the peak force. Nothing here is random, so no place has a p value.",
        "candidates": "Each effect of the body was fitted to the force over depth of the loads that are not held out, "
        "and ranked by what it leaves on the held-out loads, those that gain by BIC where they were fitted first. The "
        "share of the gap is that on the held-out loads, which so have a part in the choice.",
        "notice": "A run was taken as the measurement: both sides are computed. What is found is what the wave model "
        "lacks against the finite elements, not against tissue.",
        "next": "Give a second run of another load or tissue, discover RUN RUN, to see whether the effect and its "
        "parameters hold there; then measured trials.",
    }


def _physics(fit: BodyEffectFit, case: RunCase) -> Physics:
    return physics_of([(fit.effect, fit.values)], case.context)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
