"""Interactive control: tools that press a tissue's vertices where the user puts them, and the force they feel."""

from wavemodel.control.haptic_loop import EnergyBound, HapticDevice, HapticLoop, RecordedDevice, SimulatedDevice
from wavemodel.control.interactive_tissue import Grid, InteractiveTissue
from wavemodel.control.pressed_body import Body
from wavemodel.control.published_body import PublishedBody
from wavemodel.control.wave_bodies import layered_body, sheet_body, with_quick_law

__all__ = [
    "Body",
    "EnergyBound",
    "Grid",
    "HapticDevice",
    "HapticLoop",
    "InteractiveTissue",
    "PublishedBody",
    "RecordedDevice",
    "SimulatedDevice",
    "layered_body",
    "sheet_body",
    "with_quick_law",
]
