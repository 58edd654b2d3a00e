"""Wave models of layered soft tissue: real-time answers to a disc pressed on a stack of layers.

`LayeredWave` predicts from thickness, density, E and nu alone; `PublishedWave` is the membrane of the paper. Names are
loaded when first used, so that importing the package costs nothing.
"""

from typing import TYPE_CHECKING

from wavemodel.lazy import loader

if TYPE_CHECKING:
    from wavemodel.errors import NotCoveredError, WaveError
    from wavemodel.integrators.viscoelastic import Damping, Prony
    from wavemodel.layered.layered_wave import LayeredWave
    from wavemodel.layered.shear_limit import ShearLimit
    from wavemodel.markers import marker_motion
    from wavemodel.physics.in_plane_stress import InPlaneStress
    from wavemodel.physics.quasi_static_press import Physics, QuasiStaticPress
    from wavemodel.published.membrane import PublishedWave
    from wavemodel.sheet.plate_wave import PlateWave
    from wavemodel.sheet.solution import PlateSolution
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

__getattr__ = loader(
    __name__,
    {
        "errors": "NotCoveredError WaveError",
        "integrators.viscoelastic": "Damping Prony",
        "layered.layered_wave": "LayeredWave",
        "layered.shear_limit": "ShearLimit",
        "markers": "marker_motion",
        "physics": "InPlaneStress Physics QuasiStaticPress",
        "published": "PublishedWave",
        "sheet.plate_wave": "PlateWave",
        "sheet.solution": "PlateSolution",
        "solution": "WaveSolution",
        "specimen": "DiscTool WaveLayer",
    },
)
