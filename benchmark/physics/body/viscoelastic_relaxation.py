"""Viscoelastic relaxation: fading memory."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.physics.description import EffectDescription, linear, logarithmic
from benchmark.physics.effect import Effect, TrialContext, Values


def _description(terms: int) -> EffectDescription:
    parameters = []
    for term in range(1, terms + 1):
        of = "the stiffness" if term == 1 else "what the first leaves"
        parameters.append(linear(f"g_{term}", "", 0.0, 0.95, f"share of {of} that fades with tau_{term}"))
        parameters.append(logarithmic(f"tau_{term}", "s", 0.01, 1e3, f"relaxation time {term}"))
    return EffectDescription(
        slug="viscoelastic_relaxation",
        acts_on="body",
        sentence="The tissue's stiffness fades with time: the force decays in a hold, and fast presses are stiffer.",
        equation="F(t) = int G(t - t') df(t'), G = 1 - g_1 (1 - exp(-t / tau_1)) - (1 - g_1) g_2 (1 - exp(-t / tau_2))"
        if terms > 1
        else "F(t) = int G(t - t') df(t'), G = 1 - g_1 (1 - exp(-t / tau_1))",
        source="Y. C. Fung, Biomechanics: Mechanical Properties of Living Tissues, section 7.6",
        parameters=tuple(parameters),
    )


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel import Prony

    shares: dict[float, float] = {}
    left = 1.0
    for term in range(1, len(values) // 2 + 1):
        share, tau = left * values[f"g_{term}"], values[f"tau_{term}"]
        left -= share
        if share > 0.0:
            shares[tau] = shares.get(tau, 0.0) + share
    return {"relaxation": Prony(tuple(shares.values()), tuple(shares))} if shares else {}


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    return tuple({"g_1": 0.2, "tau_1": max(share * context.duration, 0.02)} for share in (0.01, 0.05, 0.2))


def _two_starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    slow = 0.2 * context.duration
    return tuple({"g_1": 0.15, "tau_1": max(share * slow, 0.02), "g_2": 0.15, "tau_2": slow} for share in (0.02, 0.1))


TWO = Effect(_description(2), "g_1", body=_body, starts=_two_starts)
EFFECT = Effect(_description(1), "g_1", body=_body, starts=_starts, richer=TWO)
