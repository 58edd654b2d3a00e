"""A picture of the pressed tissue, drawn off-screen in a process of its own."""

from benchmark.picture.grid import save_grid
from benchmark.picture.pressed import PACKAGES, Drawn, draw_pressed

__all__ = ["PACKAGES", "Drawn", "draw_pressed", "save_grid"]
