"""Commands in, answers out: what the parent may ask of a measured process."""

from __future__ import annotations

import traceback
from collections.abc import Mapping
from typing import Any

from benchmark.errors import InputError, TissuebenchError
from benchmark.gate.measuring.costs import CostClock, Slice, measure_block, warm_up
from benchmark.gate.measuring.jobs import CASES, WORKLOADS
from benchmark.gate.measuring.references import CALLS, REFERENCES
from benchmark.models import UncoveredError


class Service:
    """A process's answers; a command is a table with `do` and what it needs.

    - `values`: `cases` -> `values`, a table (name, value, unit, reason) each
    - `prepare`: `references` (names), `timed` (jobs with name, workload and calls) -> `sees_waiting`
    - `block`: -> `seconds` of one call by name, references among them; after `prepare`
    """

    def __init__(self, clock: CostClock):
        self._clock = clock
        self._slices: dict[str, Slice] = {}

    def answer(self, command: Mapping[str, Any]) -> dict[str, Any]:
        """Carry a command out; whatever goes wrong is an answer too (`error`, `fault`, `trace`)."""
        try:
            return dict(getattr(self, f"_{command['do']}")(command))
        except TissuebenchError as error:
            return {"error": str(error), "fault": False, "trace": ""}
        except Exception as error:
            return {"error": f"{type(error).__name__}: {error}", "fault": True, "trace": traceback.format_exc()}

    def _values(self, command: Mapping[str, Any]) -> dict[str, Any]:
        found = []
        for case in command["cases"]:
            try:
                values = CASES[case["model"]](case)
            except UncoveredError as error:
                model = case.get("own") or case["model"]
                raise InputError(f"case {case['name']}: {model} does not cover its scenario: {error}") from None
            found += [{**each.to_dict(), "name": f"{case['name']}.{each.name}"} for each in values]
        return {"values": found}

    def _prepare(self, command: Mapping[str, Any]) -> dict[str, Any]:
        references = {name: Slice(REFERENCES[name](), CALLS) for name in command["references"]}
        jobs = {job["name"]: Slice(WORKLOADS[job["workload"]](job), job["calls"]) for job in command["timed"]}
        self._slices = references | jobs
        warm_up(self._slices)
        return {"sees_waiting": self._clock.sees_waiting}

    def _block(self, command: Mapping[str, Any]) -> dict[str, Any]:
        del command
        return {"seconds": measure_block(self._slices, self._clock)}
