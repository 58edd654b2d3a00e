"""The options of the body in a scenario: what it does beyond the laws of its layers."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import model_validator

from benchmark.files.quantities import (
    Bounds,
    Diffusivity,
    Duration,
    Length,
    Number,
    Pressure,
    PullOff,
    SlipForce,
    Stiffness,
    Travel,
    problem,
)
from benchmark.files.schema import FileModel

FrictionCoefficient = Annotated[float, Number("0 to 10", Bounds(0.0, 10.0))]
LostShare = Annotated[float, Number("0 to 0.99", Bounds(0.0, 0.99))]
SetShare = Annotated[float, Number("0 to 0.95", Bounds(0.0, 0.95))]
Share = Annotated[float, Number("0 to 1", Bounds(0.0, 1.0))]
Width = Annotated[float, Number("0.01 to 100", Bounds(0.01, 100.0))]
Growth = Annotated[float, Number("0 to 1e4", Bounds(0.0, 1e4))]

TOGETHER = (
    ("friction_force", "friction_length"),
    ("slip_force", "slip_share"),
    ("drainage_share", "drainage_diffusivity"),
)
"""Options that mean nothing without each other."""
GOES_WITH = (
    ("floor_stiffness", "floor_depth", "6 mm"),
    ("softening_width", "softening", "0.2"),
    ("permanent_set_onset", "permanent_set", "0.05"),
)
"""Option, the one that it belongs to, and an example of that."""


class Physics(FileModel):
    """Options of the body, each off where it is not given.

    Attributes
    ----------
    pretension : float or None
        In-plane tensile stress before the press, Pa.
    interface_shear_limit : float or None
        Shear stress at which layers begin to slide on each other, Pa: every interface, where it comes to it, in the
        finite elements in axial symmetry; the interface that comes to it first, as a whole, in the wave.
    clamp_shear_limit : float or None
        Shear stress at which a sheet over a hole begins to slide on the plate round it, Pa; part of the finite
        elements in finite strain and axial symmetry.
    friction_coefficient : float or None
        Between tool and tissue; needed by a `rigid_frictional` tool.
    adhesion_force : float or None
        Pull with which the tissue holds the tool before it lets go, N.
    floor_depth : float or None
        Depth of the press at which a stiff floor is met, m; over a hole the lower face is taken to be as deep.
    floor_stiffness : float or None
        Of the floor, N/m; without it 1000 N/mm.
    friction_force : float or None
        Dry friction in the tissue that does not depend on the rate, N; with friction_length.
    friction_length : float or None
        Travel over which it builds up, m.
    damping_time : float or None
        Kelvin-Voigt time of a force with the speed of the press, s.
    softening : float or None
        Largest share of the force that is lost below the deepest depth so far (Mullins).
    softening_width : float or None
        Share of the energy that is given back when softening is nearly full; without it 0.5.
    permanent_set : float or None
        Share of the deepest depth at which the surface stays.
    permanent_set_onset : float or None
        Depth that leaves no set, m; without it none.
    stiffening_linear, stiffening_quadratic : float or None
        b1 and b2 of F = f(d) (1 + b1 x + b2 x2), x = d over the thickness of the stack.
    drainage_share : float or None
        Share of the force that drains away with the pore fluid; with drainage_diffusivity.
    drainage_diffusivity : float or None
        Of the pore fluid, m2/s.
    slip_force : float or None
        Force on the tool at which an interface begins to slide, N; with slip_share.
    slip_share : float or None
        Share of the stiffness that goes through that interface.
    """

    pretension: Pressure | None = None
    interface_shear_limit: Pressure | None = None
    clamp_shear_limit: Pressure | None = None
    friction_coefficient: FrictionCoefficient | None = None
    adhesion_force: PullOff | None = None
    floor_depth: Length | None = None
    floor_stiffness: Stiffness | None = None
    friction_force: PullOff | None = None
    friction_length: Travel | None = None
    damping_time: Duration | None = None
    softening: LostShare | None = None
    softening_width: Width | None = None
    permanent_set: SetShare | None = None
    permanent_set_onset: Travel | None = None
    stiffening_linear: Growth | None = None
    stiffening_quadratic: Growth | None = None
    drainage_share: LostShare | None = None
    drainage_diffusivity: Diffusivity | None = None
    slip_force: SlipForce | None = None
    slip_share: Share | None = None

    @model_validator(mode="after")
    def _options_are_complete(self) -> Self:
        for pair in TOGETHER:
            for key, other in (pair, pair[::-1]):
                if getattr(self, key) is None and getattr(self, other) is not None:
                    raise problem(f"{other} needs it; give both or neither", key=key)
        for key, owner, example in GOES_WITH:
            if getattr(self, key) is not None and getattr(self, owner) is None:
                raise problem(f"it has no meaning without {owner}; give {owner}, such as {example}, too", key=key)
        return self
