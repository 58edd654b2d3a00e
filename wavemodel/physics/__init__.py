"""What a real body does beyond elasticity: options, each off by default, all composable, SI units.

The elastic law of a specimen is handed in as a function; nothing here knows a wave model.
"""

from typing import TYPE_CHECKING

from wavemodel.lazy import loader

if TYPE_CHECKING:
    from wavemodel.physics.contact import Adhesion, DryFriction, PermanentSet
    from wavemodel.physics.elastic import Floor, InterfaceSlip, Pretension, StrainStiffening, StressSoftening
    from wavemodel.physics.in_plane_stress import AnisotropicTension, InPlaneStress
    from wavemodel.physics.quasi_static_press import Physics, QuasiStaticPress, drive_by_force
    from wavemodel.physics.time_dependent import PoroelasticDrainage, ViscousDamping

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
    "drive_by_force",
]

__getattr__ = loader(
    __name__,
    {
        "contact": "Adhesion DryFriction PermanentSet",
        "elastic": "Floor InterfaceSlip Pretension StrainStiffening StressSoftening",
        "in_plane_stress": "AnisotropicTension InPlaneStress",
        "quasi_static_press": "Physics QuasiStaticPress drive_by_force",
        "time_dependent": "PoroelasticDrainage ViscousDamping",
    },
)
