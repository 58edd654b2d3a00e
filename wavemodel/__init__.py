"""Wave models of layered soft tissue: real-time answers to a disc pressed on a stack of layers.

`LayeredWave` predicts from thickness, density, E and nu alone; `PublishedWave` is the membrane of the paper. Names are
loaded when first used, so that importing the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from wavemodel.errors import NotCoveredError, WaveError
    from wavemodel.integrators.damping import Damping
    from wavemodel.integrators.prony import Prony
    from wavemodel.layered import LayeredWave
    from wavemodel.markers import marker_motion
    from wavemodel.physics.body import Physics
    from wavemodel.physics.in_plane_stress import InPlaneStress
    from wavemodel.physics.quasi_static_press import QuasiStaticPress
    from wavemodel.plate.model import PlateWave
    from wavemodel.plate.solution import PlateSolution
    from wavemodel.published.membrane import PublishedWave
    from wavemodel.shear_limit import ShearLimit
    from wavemodel.solution import WaveSolution
    from wavemodel.specimen import DiscTool, WaveLayer

__all__ = [
    "Damping",
    "DiscTool",
    "InPlaneStress",
    "LayeredWave",
    "NotCoveredError",
    "Physics",
    "PlateSolution",
    "PlateWave",
    "Prony",
    "PublishedWave",
    "QuasiStaticPress",
    "ShearLimit",
    "WaveError",
    "WaveLayer",
    "WaveSolution",
    "marker_motion",
]

_HOMES = {
    "Damping": "wavemodel.integrators.damping",
    "DiscTool": "wavemodel.specimen",
    "LayeredWave": "wavemodel.layered",
    "NotCoveredError": "wavemodel.errors",
    "PlateSolution": "wavemodel.plate.solution",
    "PlateWave": "wavemodel.plate.model",
    "Prony": "wavemodel.integrators.prony",
    "PublishedWave": "wavemodel.published.membrane",
    "InPlaneStress": "wavemodel.physics.in_plane_stress",
    "Physics": "wavemodel.physics.body",
    "QuasiStaticPress": "wavemodel.physics.quasi_static_press",
    "ShearLimit": "wavemodel.shear_limit",
    "WaveError": "wavemodel.errors",
    "WaveLayer": "wavemodel.specimen",
    "WaveSolution": "wavemodel.solution",
    "marker_motion": "wavemodel.markers",
}


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module 'wavemodel' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
