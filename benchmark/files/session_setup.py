"""Tool and support of a session: what its file, its conditions and the command line give, the rest assumed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, Final, Self

from pydantic import model_validator

from benchmark.errors import InputError
from benchmark.files.base import FileModel
from benchmark.files.problems import nearest, validated
from benchmark.files.session_file import ConditionKeys, SessionFile
from benchmark.files.sources import Source
from benchmark.files.tool import Support, Tool, check_hole

_ASSUMED: Final[Mapping[str, str]] = {"radius": "5 mm", "contact": "rigid_bonded"}
_WHY: Final[Mapping[str, str]] = {
    "radius": "the tool's radius is not given: assumed 5 mm",
    "contact": "the tool's contact is not given: assumed rigid_bonded (a rigid tool to which the surface sticks)",
}


class Setup(FileModel):
    """What one condition was measured with."""

    tool: Tool
    support: Support

    @model_validator(mode="after")
    def _tool_fits_the_hole(self) -> Self:
        check_hole(self.tool, self.support)
        return self


def base_setup(file: SessionFile, source: Source) -> Setup:
    """Tool and support where no condition says otherwise; raises InputError."""
    return validated(Setup, _tables(file, ConditionKeys()), source)


def setups(file: SessionFile, conditions: Iterable[str], source: Source) -> dict[str, Setup]:
    """Tool and support of each condition.

    Raises
    ------
    InputError
        When a value is not allowed, or keys are given for a condition that no trial has.
    """
    names = list(conditions)
    for name in file.conditions:
        if name not in names:
            place = source.place(("conditions", name), f"conditions.{name}")
            raise InputError(f"{place}: no trial has this condition; {nearest(name, names)}")
    base = base_setup(file, source)
    return {
        name: validated(Setup, _tables(file, keys), replace(source, prefix=("conditions", name)))
        if (keys := file.conditions.get(name))
        else base
        for name in names
    }


def assumptions(file: SessionFile, conditions: Iterable[str]) -> list[str]:
    """One sentence for each key of tool and support that no one gave."""
    tools = [_given(file, file.conditions.get(name, ConditionKeys())) for name in conditions]
    said = [_WHY[key] for key in _ASSUMED if any(key not in tool for tool, _ in tools)]
    if any("kind" not in support for _, support in tools):
        said.append("the support is not given: assumed bonded")
    return said


def _given(file: SessionFile, condition: ConditionKeys) -> tuple[dict[str, Any], dict[str, Any]]:
    return {**file.tool, **condition.tool}, {**file.support, **condition.support}


def _tables(file: SessionFile, condition: ConditionKeys) -> dict[str, Any]:
    tool, support = _given(file, condition)
    return {"tool": {**_ASSUMED, **tool}, "support": support}
