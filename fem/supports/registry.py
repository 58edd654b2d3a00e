"""The supports by their words."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from fem.supports.bonded import Bonded
from fem.supports.extent import SupportModel
from fem.supports.half_space import HalfSpace
from fem.supports.hole import Hole

SUPPORT_MODELS: Mapping[str, SupportModel] = MappingProxyType(
    {"bonded": Bonded(), "hole": Hole(), "half_space": HalfSpace()}
)
