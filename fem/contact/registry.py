"""The contacts by their words."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from fem.contact.conditions import ContactModel
from fem.contact.rigid import RigidBonded
from fem.contact.rounded import FrictionlessPunch, RoundedPunch
from fem.contact.uniform_pressure import UniformPressure

CONTACT_MODELS: Mapping[str, ContactModel] = MappingProxyType(
    {
        "uniform_pressure": UniformPressure(),
        "rigid_bonded": RigidBonded(),
        "rigid_frictionless": FrictionlessPunch(),
        "rigid_frictional": RoundedPunch("rigid_frictional"),
    }
)
