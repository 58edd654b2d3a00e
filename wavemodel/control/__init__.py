"""Interactive control: tools that press a tissue's vertices where the user puts them, and the force they feel."""

from wavemodel.control.interactive_tissue import Grid, InteractiveTissue
from wavemodel.control.pressed_body import Body
from wavemodel.control.published_body import PublishedBody
from wavemodel.control.wave_bodies import layered_body, sheet_body

__all__ = ["Body", "Grid", "InteractiveTissue", "PublishedBody", "layered_body", "sheet_body"]
