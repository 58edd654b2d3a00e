"""Material laws, one a file."""

from fem.materials.law import IsochoricLaw, Material
from fem.materials.linear_elastic import LinearElastic
from fem.materials.neo_hookean import NeoHookean

__all__ = ["IsochoricLaw", "LinearElastic", "Material", "NeoHookean"]
