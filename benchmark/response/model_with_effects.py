"""A model with effects of a model file switched on: in the model itself where it carries them, else on top of it.

On top, the model is ramped once; its force over depth is the elastic law of the quasi-static press, and the layers
follow the elastic force. Effects of the drive and of the observation belong to rig and sensors, not to a press in a
scenario.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmark.files import Scenario
from benchmark.model_file import RepairedModel, read_model
from benchmark.models import Drive, Keeping, ModelResult, PreparedModel, UncoveredError, UserFile, prepare, silent
from benchmark.models.model_result import OnStep
from benchmark.models.scenario_effects import given_in_wave, scenario_context
from benchmark.physics import Effect, TrialContext, catalogue, load_effects
from benchmark.response.force_curve import Array
from benchmark.response.pipeline import Added, physics_of
from benchmark.response.ramp import depth_ramp
from wavemodel import WaveError
from wavemodel.physics import Physics, QuasiStaticPress, drive_by_force

STEPS = 40
ENOUGH = 1.02
"""The ramp goes this much deeper than the press."""
WIDENINGS = 4
IN_THE_FEM = ("strain_stiffening",)
"""What finite strain holds by itself."""


@dataclass(frozen=True)
class SwitchedOn:
    """The effects of a model file that take part in a press, and what must be said of the others.

    Attributes
    ----------
    effects : tuple of (Effect, values)
        Which take part.
    context : TrialContext
        What they may know of the scenario.
    warnings : tuple of str
        Which do not, and why.
    inside : tuple of str
        Slugs of those that are in the model itself; the others act on top of its elastic answer.
    """

    effects: tuple[Added, ...]
    context: TrialContext
    warnings: tuple[str, ...] = ()
    inside: tuple[str, ...] = ()

    @property
    def on(self) -> tuple[str, ...]:
        """Slugs that take part."""
        return tuple(effect.slug for effect, _ in self.effects)

    @property
    def on_top(self) -> tuple[Added, ...]:
        """The effects on top of the elastic answer."""
        return tuple(each for each in self.effects if each[0].slug not in self.inside)

    @property
    def physics(self) -> Physics:
        """The options of the body on top."""
        return physics_of(self.on_top, self.context)


def load_repair(path: Path, own_effects: Path | None = None) -> RepairedModel:
    """Read a model file, with the effects of a user's own file known beside the catalogue; raises InputError."""
    own = () if own_effects is None else load_effects(own_effects)
    cards = {effect.slug: effect.forms[-1].description for effect in (*catalogue(), *own)}
    return replace(read_model(path, cards), own_effects=own_effects)


def switched_on(repair: RepairedModel, scenario: Scenario, model: str) -> SwitchedOn:
    """What a model file switches on in a press of a scenario by `model` ("wave" or "fem")."""
    on: list[Added] = []
    warnings = []
    for effect, values in effects_of(repair):
        reason = _left_out(effect, repair, scenario, model)
        if reason is not None:
            warnings.append(f"the effect {effect.slug} is not switched on here: {reason}")
            continue
        on.append((effect, values))
    return SwitchedOn(tuple(on), scenario_context(scenario), tuple(warnings))


def prepare_with_effects(
    model: str,
    scenario: Scenario,
    *,
    every_field: bool = False,
    own: UserFile | RepairedModel | None = None,
    keeping: Keeping | None = None,
    judge_mesh: bool = False,
) -> PreparedModel:
    """Set a model up as `benchmark.models.prepare`, or with the effects of a model file switched on.

    Raises
    ------
    UncoveredError
        The model has no answer to this scenario, or its own options cannot act beside the effects.
    InputError
        The scenario is at fault.
    """
    if not isinstance(own, RepairedModel):
        return prepare(model, scenario, every_field=every_field, own=own, keeping=keeping, judge_mesh=judge_mesh)
    refuse_options_twice(own, scenario)
    scenario, switched = on_its_base(own, scenario), switched_on(own, scenario, model)
    if model == "fem":
        return _in_fem(scenario, switched, every_field)
    return RepairedPress(*_in_wave(scenario, switched))


def _in_fem(scenario: Scenario, switched: SwitchedOn, every_field: bool) -> PreparedModel:
    """The FEM with the effects that it carries by itself, the others on top."""
    from benchmark.models.fem_model import FemModel

    base = FemModel(scenario, every_field=every_field, added=switched.effects)
    carried = base.carried
    reasons = tuple(
        f"the effect {effect.slug} acts on top of the FEM's elastic answer (quasi-linear): {reason}"
        for (effect, _), reason in carried.on_top
    )
    inside = tuple(slug for slug in switched.on if slug in carried.carried)
    return RepairedPress(base, replace(switched, inside=inside, warnings=(*switched.warnings, *reasons)))


def _in_wave(scenario: Scenario, switched: SwitchedOn) -> tuple[PreparedModel, SwitchedOn]:
    """The wave, of a sheet with the effects that it has in its own equations, the others on top.

    On a base its own pretension would take its finite strain away, so that all effects are on top.
    """
    inside = [each for each in switched.effects if each[0].native_in_wave and scenario.support.kind == "hole"]
    stated = {
        key: values[parameter.name]
        for effect, values in inside
        for key, parameter in effect.description.keys.items()
        if parameter.name in effect.native_in_wave and parameter.name in values
    }
    physics = scenario.physics.model_copy(update=stated)
    slugs = tuple(effect.slug for effect, _ in inside if stated.keys() & effect.description.keys.keys())
    return prepare("wave", scenario.model_copy(update={"physics": physics})), replace(switched, inside=slugs)


def on_its_base(repair: RepairedModel, scenario: Scenario) -> Scenario:
    """The scenario with the wave's elastic law that the effects were found on top of."""
    if repair.large_press == "corrected" and scenario.wave.large_press == "auto":
        return scenario
    wave = scenario.wave.model_copy(update={"large_press": repair.large_press})
    return scenario.model_copy(update={"wave": wave})


def refuse_options_twice(repair: RepairedModel, scenario: Scenario) -> None:
    """Refuse options of the body in the scenario beside effects of a model file; raises UncoveredError."""
    names = given_in_wave(scenario)
    if names and repair.effects:
        raise UncoveredError(
            f"the scenario's physics.{names[0]} cannot act beside the effects of a model file: its effects act on an "
            "elastic body; leave one of them out"
        )


def effects_of(repair: RepairedModel) -> tuple[Added, ...]:
    """The effects of a model file with their values, the variant with as many terms as the file has."""
    own = () if repair.own_effects is None else load_effects(repair.own_effects)
    known = {effect.slug: effect for effect in (*catalogue(), *own)}
    return tuple((_variant(known[added.slug], added.values()), added.values()) for added in repair.effects)


def _variant(effect: Effect, values: Mapping[str, float]) -> Effect:
    return next((form for form in effect.forms if set(form.names) == set(values)), effect)


def _left_out(effect: Effect, repair: RepairedModel, scenario: Scenario, model: str) -> str | None:
    """Why an effect takes no part in a press of a scenario; None where it does."""
    if effect.description.acts_on != "body":
        return f"it belongs to the {'rig' if effect.description.acts_on == 'drive' else 'sensors'}, not to the specimen"
    if effect.body is None:
        return "it shows in markers alone"
    if model == "fem" and held_by_finite_strain(effect, repair) and scenario.fem.kinematics == "finite":
        return "finite strain holds it already"
    return None


def held_by_finite_strain(effect: Effect, repair: RepairedModel) -> bool:
    """Whether an effect that was found on top of a linear wave is what a finite-strain solver has by itself."""
    return repair.model == "wave" and repair.large_press == "linear" and effect.slug in IN_THE_FEM


class RepairedPress:
    """A prepared model with options of a body on top.

    Parameters
    ----------
    base : PreparedModel
        Its elastic answer is ramped when a history is followed.
    switched : SwitchedOn
        What is on.
    """

    def __init__(self, base: PreparedModel, switched: SwitchedOn):
        self._base, self._switched = base, switched

    def run(self, drive: Drive, on_step: OnStep = silent) -> ModelResult:
        """Follow a load history; raises like `follow`."""
        return self.follow(drive, on_step)()

    def follow(self, drive: Drive, on_step: OnStep = silent) -> Callable[[], ModelResult]:
        """Follow a load history; calling what comes back gives the result.

        Raises
        ------
        UncoveredError
            A history that the options do not cover, or deeper than the model follows.
        """
        if not self._switched.on_top:
            reading = self._base.follow(drive, on_step)
            return lambda: self._said(reading(), {})
        plain = self._base.run(drive, on_step)
        if not plain.complete:
            return lambda: self._said(plain, {})
        try:
            force, depth, top = self._press(drive, plain)
        except WaveError as error:
            raise UncoveredError(str(error)) from None
        changed = {"force": force, "depth": depth, "top_deflection": top, "profile": self._profile(plain, top)}
        return lambda: self._said(plain, changed)

    def _press(self, drive: Drive, plain: ModelResult) -> tuple[Array, Array, Array]:
        """(n,) force, (n,) depth and (n, L) deflections with the options."""
        deepest, physics = ENOUGH * float(np.abs(plain.depth).max()), self._switched.physics
        for _ in range(WIDENINGS):
            ramp = depth_ramp(self._base, deepest, STEPS)
            if ramp.failure is not None:
                raise UncoveredError(f"the elastic model stops before {1e3 * deepest:.4g} mm: {ramp.failure}")
            press = QuasiStaticPress(ramp.force_at, physics)
            if drive.control == "force":
                trace = drive_by_force(press, drive.time, drive.value, 0.1 * deepest)
            else:
                trace = press.trace(drive.time, drive.value)
            reached = float(max(np.abs(trace.surface).max(), np.abs(trace.depth).max()))
            if reached <= deepest:
                return trace.force, trace.depth, ramp.layers_at(trace.surface)
            deepest = ENOUGH * reached
        raise UncoveredError(f"with its effects the press goes beyond {1e3 * deepest:.4g} mm")

    def _profile(self, plain: ModelResult, top: Array) -> Array:
        """(L, m): the elastic profile, scaled to each layer's deflection on the axis."""
        step = plain.peak_step
        factor = np.divide(top[step], plain.top_deflection[step], out=np.ones(top.shape[1]), where=top[step] != 0.0)
        return np.asarray(plain.profile * factor[:, None])

    def _said(self, plain: ModelResult, changed: Mapping[str, Any]) -> ModelResult:
        notes = dict(plain.notes)
        if self._switched.on:
            notes["effects switched on"] = ", ".join(self._switched.on)
        if self._switched.inside:
            notes["effects in the model itself"] = ", ".join(self._switched.inside)
        fields = () if changed else plain.fields
        return replace(
            plain, **changed, notes=notes, warnings=(*plain.warnings, *self._switched.warnings), fields=fields
        )
