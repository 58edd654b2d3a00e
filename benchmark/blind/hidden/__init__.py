"""The hidden effects by their slugs: those of the catalogue in other forms, and some that are in no catalogue."""

from __future__ import annotations

from benchmark.blind.hidden.adhesion import Adhesion
from benchmark.blind.hidden.anisotropy import Anisotropy
from benchmark.blind.hidden.backlash import Backlash
from benchmark.blind.hidden.bottoming_out import BottomingOut
from benchmark.blind.hidden.camera_latency import CameraLatency
from benchmark.blind.hidden.contact_gap import ContactGap
from benchmark.blind.hidden.dry_friction import DryFriction
from benchmark.blind.hidden.force_drift import ForceDrift
from benchmark.blind.hidden.force_saturation import ForceSaturation
from benchmark.blind.hidden.hidden import Hidden, Scale
from benchmark.blind.hidden.interface_slip import InterfaceSlip
from benchmark.blind.hidden.machine_compliance import MachineCompliance
from benchmark.blind.hidden.marker_scale_error import MarkerScaleError
from benchmark.blind.hidden.off_centre_load import OffCentreLoad
from benchmark.blind.hidden.outside import FrameResonance, LampHeat, LeadScrewError, MotorPickUp, SwayingCamera
from benchmark.blind.hidden.permanent_set import PermanentSet
from benchmark.blind.hidden.perspective import Perspective
from benchmark.blind.hidden.poroelastic_drainage import PoroelasticDrainage
from benchmark.blind.hidden.pretension import Pretension
from benchmark.blind.hidden.strain_stiffening import StrainStiffening
from benchmark.blind.hidden.stress_softening import StressSoftening
from benchmark.blind.hidden.tool_inertia import ToolInertia
from benchmark.blind.hidden.viscoelastic_relaxation import ViscoelasticRelaxation
from benchmark.blind.hidden.viscous_damping import ViscousDamping

_OF_CATALOGUE: tuple[type[Hidden], ...] = (
    StrainStiffening,
    ViscoelasticRelaxation,
    ViscousDamping,
    StressSoftening,
    PermanentSet,
    PoroelasticDrainage,
    Anisotropy,
    Pretension,
    InterfaceSlip,
    BottomingOut,
    DryFriction,
    Adhesion,
    ContactGap,
    OffCentreLoad,
    MachineCompliance,
    Backlash,
    ToolInertia,
    ForceDrift,
    ForceSaturation,
    CameraLatency,
    Perspective,
    MarkerScaleError,
)
_OUTSIDE: tuple[type[Hidden], ...] = (FrameResonance, MotorPickUp, LeadScrewError, LampHeat, SwayingCamera)

CATALOGUE: dict[str, type[Hidden]] = {each.slug: each for each in _OF_CATALOGUE}
OUTSIDE: dict[str, type[Hidden]] = {each.slug: each for each in _OUTSIDE}

__all__ = ["CATALOGUE", "OUTSIDE", "Hidden", "Scale"]
