"""The hidden effects of the second family by their slugs: in other forms than in the first, and others outside."""

from __future__ import annotations

from benchmark.blind.hidden.hidden_effect import Hidden
from benchmark.blind.second_forms.rig_motion import DeadGap, LeaningTool, LooseScrew, SoftBearings
from benchmark.blind.second_forms.sensing import (
    FilteredInertia,
    FlickeringLight,
    HardLimit,
    LogarithmicDrift,
    ObliquePerspective,
    OblongPixels,
    PixelLocking,
    RoomCycle,
    RunningLatency,
    SnapThrough,
    StickSlip,
)
from benchmark.blind.second_forms.tissue_history import (
    EnergySoftening,
    EyringDamping,
    IwanFriction,
    PowerLawRelaxation,
    PunchDrainage,
    YieldSet,
)
from benchmark.blind.second_forms.tissue_shape import (
    LinearFloor,
    LockingStiffening,
    OneWayFibres,
    PatchySlip,
    SnappingBond,
    TautMembrane,
)

_OF_CATALOGUE: tuple[type[Hidden], ...] = (
    LockingStiffening,
    PowerLawRelaxation,
    EyringDamping,
    EnergySoftening,
    YieldSet,
    PunchDrainage,
    OneWayFibres,
    TautMembrane,
    PatchySlip,
    LinearFloor,
    IwanFriction,
    SnappingBond,
    DeadGap,
    LeaningTool,
    SoftBearings,
    LooseScrew,
    FilteredInertia,
    LogarithmicDrift,
    HardLimit,
    RunningLatency,
    ObliquePerspective,
    OblongPixels,
)
_OUTSIDE: tuple[type[Hidden], ...] = (StickSlip, RoomCycle, SnapThrough, PixelLocking, FlickeringLight)

SECOND_CATALOGUE: dict[str, type[Hidden]] = {each.slug: each for each in _OF_CATALOGUE}
SECOND_OUTSIDE: dict[str, type[Hidden]] = {each.slug: each for each in _OUTSIDE}

__all__ = ["SECOND_CATALOGUE", "SECOND_OUTSIDE"]
