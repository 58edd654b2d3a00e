"""The optional sections of a scenario besides `[physics]`: comparison, and what the two solvers are told."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import field_validator, model_validator
from pydantic_core.core_schema import ValidationInfo

from benchmark.files.base import FileModel
from benchmark.files.quantities import (
    AutoLength,
    Bounds,
    Margin,
    Number,
    problem,
)
from benchmark.files.sources import folder_of, is_file

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
        layered (over a hole the plate) | published | plate (a sheet over a hole).
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
