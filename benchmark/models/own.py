"""What a user puts in the place of the models of the harness."""

from __future__ import annotations

from dataclasses import dataclass

from benchmark.model_file import RepairedModel
from benchmark.models.reference import Reference
from benchmark.models.user_file import UserFile


@dataclass(frozen=True)
class Own:
    """A user's own fast model in the wave's place and own FEA in the FEM's; None keeps the model of the harness.

    `repair` switches the effects of a model file on, in both models of the harness.
    """

    wave: UserFile | None = None
    reference: Reference | None = None
    repair: RepairedModel | None = None

    def place(self, model: str) -> UserFile | RepairedModel | None:
        """What a process of `"fem"` or `"wave"` needs to know of it."""
        return self.wave if model == "wave" and self.wave is not None else self.repair

    def name(self, model: str) -> str | None:
        """What the user calls the model in the place of `"fem"` or `"wave"`; None where there is none."""
        if model == "fem":
            return None if self.reference is None else self.reference.name
        return None if self.wave is None else self.wave.name


NOTHING = Own()
