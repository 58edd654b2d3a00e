"""The scenario file: a tissue, a tool, a support, a load, and how both models are to take it."""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import Field, model_validator

from benchmark.files.base import FileModel, Name, Schema
from benchmark.files.load import Load
from benchmark.files.load_history import LoadHistory, load_history
from benchmark.files.options import Comparison, FemOptions, WaveOptions
from benchmark.files.physics import Physics
from benchmark.files.quantities import problem
from benchmark.files.tissue import Tissue
from benchmark.files.tool import Support, Tool, check_hole


class Scenario(FileModel):
    """One press of one tissue, all values in SI units.

    Attributes
    ----------
    name : str
        Any printable text; escape it where it is shown.
    tissue, tool, support, load, physics, comparison, fem, wave
        The sections; all but tissue, tool and load have defaults.
    """

    schema_: Annotated[Schema, Field(alias="schema")] = 1
    name: Name
    tissue: Tissue
    tool: Tool
    support: Support = Support()
    load: Load
    physics: Physics = Physics()
    comparison: Comparison = Comparison()
    fem: FemOptions = FemOptions()
    wave: WaveOptions = WaveOptions()

    def load_history(self) -> LoadHistory:
        """Time (n,) in s and value (n,) in N or m of the load, see `benchmark.files.load_history`."""
        return load_history(self.load)

    @model_validator(mode="after")
    def _sections_fit(self) -> Self:
        check_hole(self.tool, self.support)
        self._check_tool()
        self._check_domains()
        last = self.tissue.layers[-1]
        if math.isinf(last.thickness) and self.support.kind != "half_space" and self.fem.geometry != "surface":
            raise problem(
                f"the last layer {last.name!r} has no thickness; only a half_space or a body from a surface file may "
                "leave it out",
                key="tissue",
            )
        return self

    def _check_tool(self) -> None:
        tool = self.tool
        touches = tool.contact in ("rigid_frictionless", "rigid_frictional")
        if touches and self.fem.kinematics == "finite" and tool.edge_radius is None:
            other = ', or set fem.kinematics to "linear"' if tool.contact == "rigid_frictionless" else ""
            raise problem(
                f'a {tool.contact} tool in finite strain needs a rounded edge; give a length such as "0.5 mm"{other}',
                key="tool.edge_radius",
            )
        if tool.contact == "rigid_frictional" and self.physics.friction_coefficient is None:
            raise problem(
                "a rigid_frictional tool needs it; give a number from 0 to 10",
                key="physics.friction_coefficient",
            )

    def _check_domains(self) -> None:
        radius, window = self.fem.radius, self.wave.window
        hole = self.support.hole_radius if self.support.kind == "hole" else None
        inner, what = (self.tool.radius, "tool") if hole is None else (hole, "hole")
        if radius is not None and radius <= inner:
            raise problem(
                f'{radius * 1e3:g} mm does not reach past the {what}; allowed: above {inner * 1e3:g} mm, or "auto"',
                key="fem.radius",
            )
        wide = 2 * self.tool.radius
        if window is not None and window <= wide:
            raise problem(
                f'{window * 1e3:g} mm is not wider than the tool; allowed: above {wide * 1e3:g} mm, or "auto"',
                key="wave.window",
            )
