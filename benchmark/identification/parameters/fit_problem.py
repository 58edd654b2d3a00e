"""What a fit of parameters is asked: presses, their trials, parameters with priors and bounds, and how far to trust."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from benchmark.identification.model_error import COUNT, ModelError, jumps, model_error, touches
from benchmark.identification.parameters.free_parameters import COMMON, RELAXATION, SHARE, Parameter, start_vector
from benchmark.identification.parameters.layer_model import Fading, FitTrial
from benchmark.identification.parameters.presses.marker_rings import TRUST
from benchmark.identification.parameters.presses.press_surrogate import Forward, Press
from benchmark.response.force_curve import Array

WEAK = 2.0
"""Standard deviation of a free parameter's logarithm round its start (sevenfold; of one of either sign, of its
coordinate round none): it stops what no data hold."""
ERROR_LIMITS = (-0.1, 0.1)
"""Bounds of each coordinate of the model's own error."""
AGREES, AGREES_TOUCHING = 5e-4, 1.5e-3
"""Shares of the force to which surrogate and model are to agree: where nodes come into touch one by one, the model
itself jumps by up to the second from one set-up to the next."""
FARTHEST = 0.7
"""How far a coordinate may go in a round: twofold."""


@dataclass(frozen=True, eq=False)
class FitProblem:
    """What is fitted.

    Attributes
    ----------
    presses : tuple of Press
    trials : tuple of FitTrial
    parameters : tuple of Parameter
        Free ones, and told ones with their uncertainty as prior.
    law : str or None
        Law that all layers get; None keeps the specimen's own.
    forward : "fem" or "wave"
    trust : float
        Least standard deviation of the model's own error in size and slope, a share of the force.
    discrepancy : float
        Standard deviation of a discrepancy over depth that was asked for, a share of the force; 0 for none.
    specimens : tuple of str
        The specimen of each trial, where several were tried repeatedly; empty where that is not told.
    """

    presses: tuple[Press, ...]
    trials: tuple[FitTrial, ...]
    parameters: tuple[Parameter, ...]
    law: str | None = None
    forward: Forward = "fem"
    trust: float = 0.0
    specimens: tuple[str, ...] = ()
    discrepancy: float = 0.0

    @property
    def free(self) -> tuple[int, ...]:
        """Numbers of the free parameters."""
        return tuple(k for k, one in enumerate(self.parameters) if not one.told)

    @cached_property
    def errors(self) -> tuple[ModelError, ...]:
        """How the model may be wrong in each press: what is asked for, and no less than what is known of it."""
        return tuple(
            model_error(one.mesh_error, self.trust, self.discrepancy, jumps(one.setup[1])) for one in self.presses
        )

    @property
    def agrees(self) -> float:
        """Largest difference of surrogate and model, as a share of the force, with which a round is the last."""
        return AGREES_TOUCHING if any(touches(one.setup[1]) for one in self.presses) else AGREES

    @property
    def size(self) -> int:
        """Coordinates of the fit: parameters, and the model's own error in each press."""
        return len(self.parameters) + self.block * len(self.presses)

    @property
    def start(self) -> Array:
        """(size,) coordinates where a fit begins."""
        return np.concatenate([start_vector(self.parameters), np.zeros(self.size - len(self.parameters))])

    @property
    def rings(self) -> int:
        """Rings of markers that are fitted in a press; 0 without markers."""
        return max((0 if one.rings is None else len(one.rings.weights) for one in self.presses), default=0)

    @property
    def block(self) -> int:
        """Coordinates of the model's own error in a press: of the force, and of the size of each ring's motion."""
        return COUNT + self.rings

    @property
    def freedom(self) -> int:
        """Trials beyond those that settle the level of each press: what tells their scatter."""
        used = {trial.press for trial in self.trials}
        return len(self.trials) - min(len(used), len(self.free))


def relaxing_layers(problem: FitProblem, press: Press) -> tuple[str, ...]:
    """Layers of a press that fade by parameters of their own, or by those of all."""
    keys = {one.key for one in problem.parameters if press.has(one)}
    every = f"{RELAXATION}.g" in keys
    return tuple(name for name in press.setup[0].layer_names if every or f"{name}{SHARE}" in keys)


def fading_of(problem: FitProblem) -> tuple[Fading, ...]:
    """Where each press finds shares and times of what fades in it."""
    out = []
    for number, press in enumerate(problem.presses):
        for k, one in enumerate(problem.parameters):
            if one.key.endswith((SHARE, f"{RELAXATION}.g")) and press.has(one):
                layer = one.key.removesuffix(SHARE) if one.key.endswith(SHARE) else ""
                out.append(Fading(number, layer, k, k + 1))
    return tuple(out)


def curved_coordinates(problem: FitProblem, number: int) -> NDArray[np.int64]:
    """Coordinates in which a press' log force is no straight line."""
    press = problem.presses[number]
    chosen = (k for k, one in enumerate(problem.parameters) if press.has(one) and not one.fading and one.key != COMMON)
    return np.array(list(chosen), dtype=np.int64)


def priors(problem: FitProblem) -> tuple[Array, Array]:
    """Mean and precision (p,) of the coordinates' priors."""
    rings = np.full(problem.rings, TRUST)
    own = np.concatenate([np.append(one.deviations, rings) ** -2.0 for one in problem.errors])
    mean, precision = np.zeros(problem.size), np.append(np.zeros(len(problem.parameters)), own)
    for k, one in enumerate(problem.parameters):
        value, deviation = (one.start, WEAK) if one.prior is None else (one.prior.value, one.prior.deviation)
        either = one.signed and one.prior is None
        mean[k], precision[k] = 0.0 if either else one.coordinate(value), deviation**-2
    return mean, precision


def round_limits(problem: FitProblem, vector: Array) -> tuple[Array, Array]:
    """Bounds of the next round round a point."""
    ends = [one.limits for one in problem.parameters]
    ends += [ERROR_LIMITS] * (problem.size - len(ends))
    low, high = np.array(ends).T
    return np.maximum(low, vector - FARTHEST), np.minimum(high, vector + FARTHEST)
