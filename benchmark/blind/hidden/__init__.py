"""The hidden effects by their slugs: those of the catalogue in other forms, and some that are in no catalogue."""

from __future__ import annotations

from benchmark.blind.hidden.body_history import (
    HiddenDryFriction,
    HiddenPermanentSet,
    HiddenPoroelasticDrainage,
    HiddenStressSoftening,
    HiddenViscoelasticRelaxation,
    HiddenViscousDamping,
)
from benchmark.blind.hidden.body_shape import (
    HiddenAdhesion,
    HiddenAnisotropy,
    HiddenBottomingOut,
    HiddenInterfaceSlip,
    HiddenPretension,
    HiddenStrainStiffening,
)
from benchmark.blind.hidden.drive import HiddenBacklash, HiddenContactGap, HiddenMachineCompliance, HiddenOffCentreLoad
from benchmark.blind.hidden.hidden_effect import Hidden, SessionScale
from benchmark.blind.hidden.observation import (
    HiddenCameraLatency,
    HiddenForceDrift,
    HiddenForceSaturation,
    HiddenMarkerScaleError,
    HiddenPerspective,
    HiddenToolInertia,
)
from benchmark.blind.hidden.outside import (
    HiddenFrameResonance,
    HiddenLampHeat,
    HiddenLeadScrewError,
    HiddenMotorPickUp,
    HiddenSwayingCamera,
)

_OF_CATALOGUE: tuple[type[Hidden], ...] = (
    HiddenStrainStiffening,
    HiddenViscoelasticRelaxation,
    HiddenViscousDamping,
    HiddenStressSoftening,
    HiddenPermanentSet,
    HiddenPoroelasticDrainage,
    HiddenAnisotropy,
    HiddenPretension,
    HiddenInterfaceSlip,
    HiddenBottomingOut,
    HiddenDryFriction,
    HiddenAdhesion,
    HiddenContactGap,
    HiddenOffCentreLoad,
    HiddenMachineCompliance,
    HiddenBacklash,
    HiddenToolInertia,
    HiddenForceDrift,
    HiddenForceSaturation,
    HiddenCameraLatency,
    HiddenPerspective,
    HiddenMarkerScaleError,
)
_OUTSIDE: tuple[type[Hidden], ...] = (
    HiddenFrameResonance,
    HiddenMotorPickUp,
    HiddenLeadScrewError,
    HiddenLampHeat,
    HiddenSwayingCamera,
)

CATALOGUE: dict[str, type[Hidden]] = {each.slug: each for each in _OF_CATALOGUE}
OUTSIDE: dict[str, type[Hidden]] = {each.slug: each for each in _OUTSIDE}

__all__ = ["CATALOGUE", "OUTSIDE", "Hidden", "SessionScale"]
