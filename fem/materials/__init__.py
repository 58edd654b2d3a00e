"""Material laws, one a file."""

from fem.materials.fibres import Fibre, FibreReinforced
from fem.materials.gent import Gent
from fem.materials.linear_elastic import LinearElastic
from fem.materials.material import IsochoricLaw, Material
from fem.materials.mooney_rivlin import MooneyRivlin
from fem.materials.neo_hookean import NeoHookean
from fem.materials.ogden import Ogden
from fem.materials.yeoh import Yeoh

__all__ = [
    "Fibre",
    "FibreReinforced",
    "Gent",
    "IsochoricLaw",
    "LinearElastic",
    "Material",
    "MooneyRivlin",
    "NeoHookean",
    "Ogden",
    "Yeoh",
]
