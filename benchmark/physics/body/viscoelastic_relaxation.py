"""Viscoelastic relaxation: fading memory."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from benchmark.physics.description import EffectDescription, linear, logarithmic
from benchmark.physics.effect import Effect, FemTerm, NotInFemError, TrialContext, Values

if TYPE_CHECKING:
    from fem import Problem


def _description(terms: int) -> EffectDescription:
    parameters, fading, left = [], [], ""
    for term in range(1, terms + 1):
        of = "the stiffness" if term == 1 else "what the terms before leave"
        parameters.append(linear(f"g_{term}", "", 0.0, 0.95, f"share of {of} that fades with tau_{term}"))
        parameters.append(logarithmic(f"tau_{term}", "s", 0.01, 1e3, f"relaxation time {term}"))
        fading.append(f"{left}g_{term} (1 - exp(-t / tau_{term}))")
        left += f"(1 - g_{term}) "
    return EffectDescription(
        slug="viscoelastic_relaxation",
        acts_on="body",
        sentence="The tissue's stiffness fades with time: the force decays in a hold, and fast presses are stiffer.",
        equation=f"F(t) = int G(t - t') df(t'), G = 1 - {' - '.join(fading)}",
        needs=(("hold", "second_rate"),),
        source="Y. C. Fung, Biomechanics: Mechanical Properties of Living Tissues, section 7.6",
        parameters=tuple(parameters),
        may_lack=tuple((f"g_{term}", f"tau_{term}") for term in range(2, terms + 1)),
        in_wave="Prony series on top of its elastic law; a scenario's layers have series of their own (`relaxation`)",
        in_fem="a Prony series of every layer's shear, identified so that the force fades as much; else quasi-linear",
    )


def _series(values: Values) -> dict[float, float]:
    """Share of the whole stiffness that fades with each relaxation time in s."""
    shares: dict[float, float] = {}
    left = 1.0
    for term in range(1, len(values) // 2 + 1):
        share, tau = left * values[f"g_{term}"], values[f"tau_{term}"]
        left -= share
        if share > 0.0:
            shares[tau] = shares.get(tau, 0.0) + share
    return shares


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel import Prony

    shares = _series(values)
    return {"relaxation": Prony(tuple(shares.values()), tuple(shares))} if shares else {}


def _in_fem(values: Values, problem: Problem, context: TrialContext) -> tuple[Problem, str]:
    from benchmark.physics.fem_identification import relaxation_factor
    from fem import PronyTerm

    relaxing = [layer.name for layer in problem.layers if layer.relaxation]
    if relaxing:
        raise NotInFemError(f"the layer {relaxing[0]} has a relaxation of its own")
    series = _series(values)
    if not series:
        return problem, ""
    peak = context.peak_force if context.control == "force" else context.peak_depth
    factor = relaxation_factor(problem, sum(series.values()), context.control, peak)
    terms = tuple(PronyTerm(factor * share, tau) for tau, share in series.items())
    remark = (
        f"viscoelastic_relaxation is a Prony series of every layer's shear, its shares {factor:.4g} times the force's"
    )
    return replace(problem, layers=tuple(replace(layer, relaxation=terms) for layer in problem.layers)), remark


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    return tuple({"g_1": 0.2, "tau_1": max(share * context.duration, 0.02)} for share in (0.01, 0.05, 0.2))


def _two_starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    slow = 0.2 * context.duration
    return tuple(_spread(slow, share) for share in ((0.02, 1.0), (0.1, 1.0)))


def _three_starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    slow = 0.3 * context.duration
    return tuple(_spread(slow, share) for share in ((0.01, 0.1, 1.0), (0.03, 0.17, 1.0), (0.003, 0.05, 1.0)))


def _spread(slow: float, shares: tuple[float, ...]) -> dict[str, float]:
    """Terms of like strength whose times are these shares of the slowest one, s."""
    found: dict[str, float] = {}
    for term, share in enumerate(shares, start=1):
        found |= {f"g_{term}": 0.15, f"tau_{term}": max(share * slow, 0.02)}
    return found


def _slowest(values: Values, context: TrialContext) -> float:
    """Time of the slowest term that is there, s; rows that do not resolve it show a damping as well."""
    shares = (name for name, value in values.items() if name.startswith("g_") and value > 0.0)
    return max((values[name.replace("g_", "tau_")] for name in shares), default=0.0)


def _effect(
    terms: int, starts: Callable[[TrialContext], tuple[dict[str, float], ...]], richer: Effect | None
) -> Effect:
    description = _description(terms)
    names = tuple(parameter.name for parameter in description.parameters)
    fem = FemTerm(names, _in_fem, elastic=False)
    return Effect(description, "g_1", body=_body, starts=starts, acts_within=_slowest, richer=richer, fem=fem)


EFFECT = _effect(1, _starts, _effect(2, _two_starts, _effect(3, _three_starts, None)))
