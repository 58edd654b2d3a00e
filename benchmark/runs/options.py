"""How a run is carried out, as opposed to what is run."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class RunOptions:
    """Options of `run`.

    Attributes
    ----------
    every_field
        Write the fields of each step instead of the peak's and the last one's.
    repeats
        Timed repeats of each model, at least 3.
    seed
        Of every random draw.
    """

    every_field: bool = False
    repeats: int = 3
    seed: int = 0
