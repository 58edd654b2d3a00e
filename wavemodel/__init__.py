"""Wave models of layered soft tissue: real-time answers to a disc pressed on a stack of layers.

`LayeredWave` and `PlateWave` (a sheet over a hole) predict from thickness, density, E and nu; `PublishedWave` is the
membrane of the paper. SI units, deflections downwards. Names are loaded when first used.

>>> import numpy as np
>>> from wavemodel import DiscTool, LayeredWave, Prony, WaveLayer, marker_motion
>>> skin = [
...     WaveLayer("dermis", thickness=1.5e-3, density=1116.0, youngs_modulus=1e5, poisson_ratio=0.48),
...     WaveLayer("fat", thickness=10e-3, density=971.0, youngs_modulus=2e4, poisson_ratio=0.48),
... ]
>>> wave = LayeredWave(skin, DiscTool(radius=5e-3), relaxation=Prony((0.3,), (0.5,)))
>>> time = np.linspace(0.1, 2.0, 20)  # s
>>> solution = wave.run("force", time, 0.5 * np.minimum(time, 1.0))  # N: a ramp to 0.5 N, held
>>> [f"{1e3 * depth:.2f} mm" for depth in solution.depth[[9, 19]]]
['1.70 mm', '1.95 mm']
>>> solution.profile(-1, np.array([0.0, 5e-3, 10e-3])).shape  # each layer's top face at three radii
(2, 3)
>>> marker_motion(solution, np.array([[6e-3, 0.0]]), face=1).shape  # x and y of one marker under the dermis
(1, 2)
"""

from typing import TYPE_CHECKING

from wavemodel.lazy import loader

if TYPE_CHECKING:
    from wavemodel.errors import NotCoveredError, WaveError
    from wavemodel.integrators.viscoelastic import Damping, Prony
    from wavemodel.layered.layered_wave import LayeredWave
    from wavemodel.layered.shear_limit import ShearLimit
    from wavemodel.layered.window import WaveDiscretisation
    from wavemodel.physics.in_plane_stress import InPlaneStress
    from wavemodel.physics.quasi_static_press import Physics, QuasiStaticPress
    from wavemodel.published.membrane import PublishedWave
    from wavemodel.sheet.plate_wave import PlateSettings, PlateWave
    from wavemodel.solution import WaveSolution, marker_motion
    from wavemodel.specimen import DiscTool, StrainEnergy, WaveLayer

__all__ = [
    "Damping",
    "DiscTool",
    "InPlaneStress",
    "LayeredWave",
    "NotCoveredError",
    "Physics",
    "PlateSettings",
    "PlateWave",
    "Prony",
    "PublishedWave",
    "QuasiStaticPress",
    "ShearLimit",
    "StrainEnergy",
    "WaveDiscretisation",
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
        "layered.window": "WaveDiscretisation",
        "physics": "InPlaneStress Physics QuasiStaticPress",
        "published": "PublishedWave",
        "sheet.plate_wave": "PlateSettings PlateWave",
        "solution": "WaveSolution marker_motion",
        "specimen": "DiscTool StrainEnergy WaveLayer",
    },
)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
