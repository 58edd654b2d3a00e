"""A discovery with where it came from: what the files and the page are made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from benchmark.discovery.discovery_result import Array, ChannelGap, Discovery, Estimate, channel_unit
from benchmark.discovery.refitting.refit_result import ModelRefit
from benchmark.errors import TissuebenchError
from benchmark.model_file import AddedEffect, RepairedModel, Value
from benchmark.physics.description import EffectDescription
from benchmark.physics.setup_entry import setup_key

NAMING = ("named", "conditional", "lookalikes", "partly_explained", "instrument_first")
"""Verdicts under which the effects of the answer are part of the model; elsewhere they are nearest entries only."""


@dataclass(frozen=True, eq=False)
class LayerGap:
    """A layer's deflection against the reference of a run, m: root mean square over the loads held out.

    Attributes
    ----------
    layer : str
    force : (n,) array
        N.
    reference, before, after : (n,) array
        Deflection of its top face on the tool axis, m.
    rmse_before, rmse_after : float
        Over the loads that the fit has not seen.
    peak_before, peak_after : float
        Error at peak load in % of the reference, signed.
    """

    layer: str
    force: Array
    reference: Array
    before: Array
    after: Array
    rmse_before: float
    rmse_after: float
    peak_before: float
    peak_after: float

    @property
    def closed(self) -> float | None:
        """Share of the mean square that is gone; None where there was nothing."""
        return None if self.rmse_before == 0.0 else 1.0 - (self.rmse_after / self.rmse_before) ** 2


@dataclass(frozen=True)
class NextExperiment:
    """The proposed protocol.

    Attributes
    ----------
    rivals : (str, str)
    choice : str
        Name of the entry of the menu.
    words : str
        What to do, in one sentence.
    separation_now, separation : float
        Expected distance of the rivals in standard deviations by the trials there are, and by the proposed ones.
    minutes : float
        Bench time of its trials.
    menu : mapping
        Entry to (separation, minutes) with as many trials as the session has, all that were weighed.
    toml : str
        The protocol file.
    trials : int
        That are expected to decide.
    opens : tuple of str
        Slugs that were not looked for and that it shows. Then nothing is weighed: the second of `rivals` is they,
        the separations are NaN and the menu is empty.
    """

    rivals: tuple[str, str]
    choice: str
    words: str
    separation_now: float
    separation: float
    minutes: float
    menu: Mapping[str, tuple[float, float]]
    toml: str
    trials: int = 1
    opens: tuple[str, ...] = ()


@dataclass(frozen=True)
class Round:
    """One round of the closed loop: the rivals, the experiment that was done, and what came of it.

    Attributes
    ----------
    rivals : (str, str)
    choice, words : str
        Entry of the menu, and what was done.
    separation_now, expected, found : float
        Standard deviations between the rivals by the trials before, as expected of the experiment, and as it turned out
        (None where a rival was not fitted again; the others are NaN where it showed what was not looked for before).
    trials : int
    minutes : float
        At the bench.
    ruled_out : tuple of str
        Slugs that the experiment ruled out.
    verdict : str
        Of the discovery after it.
    answer : tuple of str
        Slugs of its effects.
    remaining : int
        Rivals that are left, the answer among them.
    """

    rivals: tuple[str, str]
    choice: str
    words: str
    separation_now: float
    expected: float
    found: float | None
    trials: int
    minutes: float
    ruled_out: tuple[str, ...]
    verdict: str
    answer: tuple[str, ...]
    remaining: int


@dataclass(frozen=True, eq=False)
class DiscoveryRecord:
    """Everything a `discover` found, before it becomes files and a page.

    Attributes
    ----------
    name : str
        Of the session or the run.
    source : str
        "session" or "run".
    fingerprint : str
        SHA-256 of what was measured.
    synthetic : bool
        Whether the measurements were computed.
    tissue, model : str
        The base: what the specimen is and "wave" or "fem".
    found : Discovery
    cards : mapping of str to EffectDescription
        What people read of every effect that was a candidate.
    seed : int
    layers : tuple of LayerGap
        With a run only.
    proposal : NextExperiment or None
        Where rivals remain.
    labels : mapping
        What the page says where it is not a session's.
    large_press : str
        Elastic law of the wave under repair.
    store : Path or None
        Where fits are kept until the result is written.
    rounds : tuple of Round
        Of the closed loop; empty without a bench.
    grown : Path or None
        The copy of the session to which the loop added trials.
    stopped : TissuebenchError or None
        With which the bench ended the loop before its time.
    refits : tuple of ModelRefit
        The effects in the FEM and the wave model, where that was asked for.
    """

    name: str
    source: str
    fingerprint: str
    synthetic: bool
    tissue: str
    model: str
    found: Discovery
    cards: Mapping[str, EffectDescription]
    seed: int
    layers: tuple[LayerGap, ...] = ()
    proposal: NextExperiment | None = None
    labels: Mapping[str, str] = field(default_factory=dict)
    large_press: str = "linear"
    store: Path | None = None
    rounds: tuple[Round, ...] = ()
    grown: Path | None = None
    stopped: TissuebenchError | None = None
    refits: tuple[ModelRefit, ...] = ()

    @property
    def named(self) -> bool:
        """Whether the effects of the answer are part of the model."""
        return self.found.verdict in NAMING and bool(self.found.effects)

    def repaired(self) -> RepairedModel:
        """The model to write: base and, where something was named, the effects; what is wrong of a set-up is none."""
        effects = [
            AddedEffect(effect.slug, {each.name: _value(each) for each in effect.parameters})
            for effect in self.found.effects
            if self.named and setup_key(effect.slug) is None
        ]
        return RepairedModel("model.toml", self.tissue, self.model, tuple(effects), self._evidence(), self.large_press)

    def _evidence(self) -> dict[str, object]:
        return {
            "session": self.name,
            "fingerprint": self.fingerprint,
            "synthetic": self.synthetic,
            "verdict": self.found.verdict,
            "statement": self.found.statement,
            "gap": {gap.channel: gap_in_units(gap) for gap in self.found.gap},
        }


def _value(estimate: Estimate) -> Value:
    """Six digits are more than any interval needs."""
    value, low, high = (float(f"{each:.6g}") for each in (estimate.value, *estimate.ci95))
    return Value(value, estimate.unit, (low, high))


def gap_in_units(gap: ChannelGap) -> dict[str, object]:
    """A channel's gap with its unit, N or mm."""
    unit, scale = channel_unit(gap.channel)
    return {
        "unit": unit,
        "rmse_before": scale * gap.rmse_before,
        "rmse_after": scale * gap.rmse_after,
        "noise_floor": None if gap.noise_floor is None else scale * gap.noise_floor,
        "closed": gap.closed,
        "held_out": gap.held_out,
    }
