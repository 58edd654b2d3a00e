"""What a real body does beyond elasticity, an option a file: each off by default, all composable, SI units.

Names are loaded when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from wavemodel.physics.adhesion import Adhesion
    from wavemodel.physics.anisotropy import AnisotropicTension
    from wavemodel.physics.body import Physics
    from wavemodel.physics.damping import ViscousDamping
    from wavemodel.physics.drainage import PoroelasticDrainage
    from wavemodel.physics.floor import Floor
    from wavemodel.physics.friction import DryFriction
    from wavemodel.physics.in_plane_stress import InPlaneStress
    from wavemodel.physics.permanent_set import PermanentSet
    from wavemodel.physics.pretension import Pretension
    from wavemodel.physics.quasi_static_press import QuasiStaticPress
    from wavemodel.physics.slip import InterfaceSlip
    from wavemodel.physics.softening import StressSoftening
    from wavemodel.physics.stiffening import StrainStiffening

__all__ = [
    "Adhesion",
    "AnisotropicTension",
    "DryFriction",
    "Floor",
    "InPlaneStress",
    "InterfaceSlip",
    "PermanentSet",
    "Physics",
    "PoroelasticDrainage",
    "Pretension",
    "QuasiStaticPress",
    "StrainStiffening",
    "StressSoftening",
    "ViscousDamping",
]

_HOMES = {
    "Adhesion": "adhesion",
    "AnisotropicTension": "anisotropy",
    "DryFriction": "friction",
    "Floor": "floor",
    "InPlaneStress": "in_plane_stress",
    "InterfaceSlip": "slip",
    "PermanentSet": "permanent_set",
    "Physics": "body",
    "PoroelasticDrainage": "drainage",
    "Pretension": "pretension",
    "QuasiStaticPress": "quasi_static_press",
    "StrainStiffening": "stiffening",
    "StressSoftening": "softening",
    "ViscousDamping": "damping",
}


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module 'wavemodel.physics' has no attribute {name!r}")
    return getattr(import_module(f"wavemodel.physics.{_HOMES[name]}"), name)
