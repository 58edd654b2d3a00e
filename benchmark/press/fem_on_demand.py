"""The finite elements asked by a page: one history of depth under one tool, as it was pressed, memory included.

What a page sends is checked as a stranger's: size, kind, range. One request is computed at a time.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

import fem
from benchmark.errors import InputError, TissuebenchError
from benchmark.files import Scenario
from benchmark.models.fem_model import FemModel
from benchmark.press.pressed_specimen import PressedSpecimen

MOST_ROWS = 80
MOST_TERMS = 4
LONGEST = 600.0
"""Seconds of a history."""
RADII = 128
"""Radii at which the last instant's faces are sent."""

Row = tuple[float, float]
Share = Annotated[float, Field(gt=0.0, lt=0.95)]
Seconds = Annotated[float, Field(ge=1e-3, le=1e5)]


class Question(BaseModel):
    """What a page may ask: which press, (t in s, depth in m) rows from rest, and the memory that it chose."""

    model_config = ConfigDict(extra="forbid", strict=False, allow_inf_nan=False)

    press: Annotated[int, Field(ge=0)]
    history: Annotated[list[Row], Field(min_length=2, max_length=MOST_ROWS)]
    strength: Annotated[list[Share], Field(max_length=MOST_TERMS)] = []
    time_s: Annotated[list[Seconds], Field(max_length=MOST_TERMS)] = []


@dataclass(frozen=True, eq=False)
class FemOnDemand:
    """Answers questions about the presses of a page."""

    specimens: Sequence[PressedSpecimen]

    def answer(self, text: str) -> dict[str, Any]:
        """The answer to a message, or {"error": why}; it never raises for what a message says."""
        try:
            question = Question.model_validate(json.loads(text))
            return self._answer(question)
        except (ValueError, RecursionError) as error:
            return {"error": _brief(error)}
        except (TissuebenchError, fem.FemError) as error:
            return {"error": str(error)}

    def _answer(self, question: Question) -> dict[str, Any]:
        if question.press >= len(self.specimens):
            raise InputError(f"press {question.press} is not on this page; it has {len(self.specimens)}")
        specimen = self.specimens[question.press]
        seconds, depth = self._checked(question, specimen)
        start = time.perf_counter()
        model = FemModel(_with_memory(specimen.scenario, question)).prepared
        ready = time.perf_counter()
        solution = model.run(fem.Load("depth", seconds, depth))
        wall = time.perf_counter() - ready
        if solution.failure is not None:
            raise InputError(f"the finite elements stopped: {solution.failure}")
        radii = np.linspace(0.0, specimen.wave.reach, RADII)
        return {
            "press": question.press,
            "time_s": seconds.tolist(),
            "force_N": solution.force.tolist(),
            "radius_m": radii.tolist(),
            "faces_m": np.nan_to_num(solution.profile(-1, radii)).tolist(),
            "setup_s": ready - start,
            "wall_s": wall,
            "unknowns": model.unknowns,
        }

    def _checked(self, question: Question, specimen: PressedSpecimen) -> tuple[Any, Any]:
        """Times and depths (n,), from rest at time zero."""
        seconds, depth = np.array(question.history).T
        if seconds[0] <= 0.0 or np.any(np.diff(seconds) <= 0.0) or seconds[-1] > LONGEST:
            raise InputError(f"history: times must rise from above 0 to at most {LONGEST:g} s")
        deepest = specimen.wave.deepest * (1.0 + 1e-9)
        if depth.min() < 0.0 or depth.max() > deepest:
            raise InputError(f"history: depths must be 0 to {1e3 * specimen.wave.deepest:.4g} mm")
        if len(question.strength) != len(question.time_s) or math.fsum(question.strength) >= 0.95:
            raise InputError("memory: as many times as shares are needed, the shares together below 0.95")
        return seconds, depth


def _with_memory(scenario: Scenario, question: Question) -> Scenario:
    """The scenario whose layers all relax by a page's own series, where they have none."""
    tissue = scenario.tissue
    if not question.strength or any(layer.relaxation for layer in tissue.layers):
        return scenario
    table = tissue.to_table()
    terms = [{"g": g, "tau": f"{tau!r} s"} for g, tau in zip(question.strength, question.time_s, strict=True)]
    for layer in table["layers"]:
        layer["relaxation"] = terms
    return scenario.model_copy(update={"tissue": type(tissue).model_validate(table)})


def _brief(error: Exception) -> str:
    """What is wrong with a message, without repeating it."""
    if isinstance(error, ValidationError):
        first = error.errors(include_url=False, include_input=False)[0]
        return f"{'.'.join(map(str, first['loc'])) or 'message'}: {first['msg']}"
    return "the message is not JSON"
