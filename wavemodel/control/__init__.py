"""Interactive control: tools that press a tissue's vertices where the user puts them, and the force they feel."""

from wavemodel.control.body import Body
from wavemodel.control.grid import Grid
from wavemodel.control.interactive import InteractiveTissue
from wavemodel.control.layered import layered_body
from wavemodel.control.published import PublishedBody
from wavemodel.control.sheet import sheet_body

__all__ = ["Body", "Grid", "InteractiveTissue", "PublishedBody", "layered_body", "sheet_body"]
