"""The scenario file: a tissue, a tool, a support, a load, and how both models are to take it."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import Field, field_validator, model_validator
from pydantic_core.core_schema import ValidationInfo

from benchmark.files.load import Load, LoadHistory, load_history
from benchmark.files.physics import Physics
from benchmark.files.quantities import AutoLength, Bounds, Margin, Number, problem
from benchmark.files.schema import FileModel, Name, Schema
from benchmark.files.sources import folder_of, is_file
from benchmark.files.tissue import Layer, Tissue
from benchmark.files.tool import TOUCHING, Support, Tool, check_hole, implausible, setup_uncertainties

Modes = Annotated[
    int | None,
    Number('1 to 4096 modes each way (a whole number), or "auto"', Bounds(1, 4096), whole=True, automatic=True),
]


class Comparison(FileModel):
    """How models are compared: the margin of the equivalence test, a fraction of the FEM's mean."""

    equivalence_margin: Margin = 0.02


class FemOptions(FileModel):
    """What the finite-element solver is told.

    Attributes
    ----------
    kinematics : str
        finite | linear.
    geometry : str
        axisymmetric | block | surface.
    mesh : str
        coarse | default | fine.
    radius : float or None
        Radius of the modelled specimen, m; None follows tool and stack.
    surface : str or None
        Absolute path of the surface file of `geometry = "surface"`; the tissue's layers count inwards from it.
    surface_unit : str or None
        The unit of its coordinates.
    """

    kinematics: Literal["finite", "linear"] = "finite"
    geometry: Literal["axisymmetric", "block", "surface"] = "axisymmetric"
    mesh: Literal["coarse", "default", "fine"] = "default"
    radius: AutoLength = None
    surface: str | None = None
    surface_unit: Literal["um", "mm", "cm", "m", "inch"] | None = None

    @field_validator("surface", mode="after")
    @classmethod
    def _surface_exists(cls, value: str | None, info: ValidationInfo) -> str | None:
        if value is None:
            return None
        path = folder_of(info) / value
        if not is_file(path):
            raise problem(f"there is no file {str(path)!r}; give a surface file (STL, OBJ, PLY or VTK)")
        return str(path.resolve())

    @model_validator(mode="after")
    def _surface_is_complete(self) -> Self:
        for key, example in (("surface", '"liver.stl"'), ("surface_unit", '"mm"')):
            if self.geometry == "surface" and getattr(self, key) is None:
                raise problem(f'the geometry "surface" needs it; give one such as {example}', key=key)
            if self.geometry != "surface" and getattr(self, key) is not None:
                raise problem('only the geometry "surface" has it; set fem.geometry, or leave it out', key=key)
        if self.geometry == "surface" and self.radius is not None:
            raise problem('the geometry "surface" ends at the surface; leave it out, or "auto"', key="radius")
        return self


class WaveOptions(FileModel):
    """What the wave model is told.

    Attributes
    ----------
    model : str
        layered | published | plate (the plate theory of a sheet over a hole).
    modes : int or None
        N for m, n = 1..N; None follows the window.
    window : float or None
        Side of the square window, m; None follows tool and stack.
    large_press : str
        linear (small strain at any depth) | corrected (the layers' finite strain in the same modes) | auto (corrected
        where the finite elements are in finite strain, however deep, and linear with a warning where that has no
        answer).
    """

    model: Literal["layered", "published", "plate"] = "layered"
    modes: Modes = None
    window: AutoLength = None
    large_press: Literal["auto", "linear", "corrected"] = "auto"


class Scenario(FileModel):
    """One press of one tissue, all values in SI units.

    Attributes
    ----------
    name : str
        Any printable text; escape it where it is shown.
    tissue : Tissue
        What is pressed: a table of a tissue file's keys, or in its place text: a shipped name, or the path of a tissue
        file from this one.
    tool, support, load, physics, comparison, fem, wave
        The sections; all but tool and load have defaults.
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

    @property
    def uncertainties(self) -> dict[str, float]:
        """Standard uncertainties that are stated of the set-up, as shares of the values, by keys as in `--set`."""
        return setup_uncertainties(self.tissue, self.tool, self.support)

    def load_history(self) -> LoadHistory:
        """Time (n,) in s and value (n,) in N or m of the load, see `benchmark.files.load`."""
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
        if self.support.cylinder:
            return
        if tool.contact in TOUCHING and self.fem.kinematics == "finite" and tool.edge_radius is None:
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
        if self.support.cylinder and (radius is not None or self.fem.geometry != "axisymmetric"):
            raise problem(
                "a cylinder between plates is axisymmetric and ends at support.specimen_radius; leave fem.radius and "
                "fem.geometry out",
                key="fem",
            )
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


_ALIKE = 0.02


def scenario_notes(scenario: Scenario) -> tuple[str, ...]:
    """Say what of a scenario has no effect, not the one that its file suggests, or no bench's size; a sentence each."""
    found: list[str | None] = [*implausible(scenario.tissue, scenario.tool, scenario.support)]
    found += [_law_apart(layer) for layer in scenario.tissue.layers]
    found += [_undetermined(key, scenario.tissue.name) for key in scenario.tissue.not_determined or ()]
    found += [_stepped_over(scenario.load), _unused_hold(scenario.load), _unused_position(scenario)]
    if scenario.support.hole_radius is not None and scenario.support.kind != "hole":
        found.append(f"support.hole_radius has no effect: the support is {scenario.support.kind}")
    if scenario.physics.friction_coefficient is not None and scenario.tool.contact != "rigid_frictional":
        found.append(f"physics.friction_coefficient has no effect: the contact is {scenario.tool.contact}")
    return tuple(note for note in found if note)


def _undetermined(key: str, tissue: str) -> str:
    return (
        f"{key} is quoted but not determined: the trials behind {tissue} do not tell it, any result rests on it, and "
        "no band includes it"
    )


def _law_apart(layer: Layer) -> str | None:
    """A layer whose law starts with another stiffness than its moduli say: models with and without the law differ."""
    law = layer.hyperelastic.shear_modulus
    if law is None or abs(law / layer.shear_modulus - 1) <= _ALIKE:
        return None
    return (
        f"layer {layer.name}: its {layer.hyperelastic.law} law begins with a shear modulus of {law / 1e3:.4g} kPa, "
        f"its moduli say {layer.shear_modulus / 1e3:.4g} kPa; finite strain follows the law, small strain the moduli"
        f"{_other_form(layer)}"
    )


def _other_form(layer: Layer) -> str:
    """That Ogden's constants fit the moduli in another program's form of the energy; nothing where they do not.

    The initial shear modulus of the form 2 mu / alpha^2 is the sum of mu, that of c / m^2 half the sum of c.
    """
    if layer.hyperelastic.law != "ogden":
        return ""
    whole = sum(term.mu for term in layer.hyperelastic.terms)
    forms = ((whole, "2 mu / alpha^2 (Abaqus)", "2 mu / alpha"), (whole / 2, "c / m^2 (FEBio)", "c / m"))
    return "".join(
        f"; its constants fit the moduli in the form {form}: mu is {ours} here"
        for shear, form, ours in forms
        if abs(shear / layer.shear_modulus - 1) <= _ALIKE
    )


def _stepped_over(load: Load) -> str | None:
    if load.shape != "triangle" or load.observations is None or load.observations % 2 == 0:
        return None
    return f"{load.observations} observations, an odd number, step over the triangle's peak, which is never reached"


def _unused_hold(load: Load) -> str | None:
    if load.hold is None or load.shape == "ramp_hold":
        return None
    return f"load.hold has no effect: the shape is {load.shape}"


def _unused_position(scenario: Scenario) -> str | None:
    if scenario.tool.position == (0.0, 0.0) or scenario.support.kind == "hole":
        return None
    if scenario.fem.geometry != "axisymmetric":
        return None
    return "tool.position has no effect: the specimen is laterally endless, and the same everywhere"
