"""Supports, one a file."""

from fem.supports.extent import Extent, SupportModel
from fem.supports.registry import SUPPORT_MODELS

__all__ = ["SUPPORT_MODELS", "Extent", "SupportModel"]
