import numpy as np

from fem import LinearElastic, NeoHookean
from fem.materials.components import AXISYMMETRIC
from fem.materials.deformation import Deformation
from fem.materials.element_laws import element_laws


def test_mixed_laws_equal_each_law_on_its_elements():
    materials = (NeoHookean(1.0, 0.3), LinearElastic(3.0, 0.2), NeoHookean(7.0, 0.4))
    layer = np.array([0, 1, 2, 1, 0])
    laws = element_laws(materials, layer)
    assert len(laws.groups) == 2
    d = Deformation(AXISYMMETRIC, np.random.default_rng(8).normal(scale=0.05, size=(5, 4, 5)))
    for e, material in enumerate(materials[n] for n in layer):
        one = Deformation(AXISYMMETRIC, d.H[..., e])
        parameters = np.array(material.parameters)
        np.testing.assert_allclose(laws.stress(d)[..., e], material.law.stress(one, parameters), atol=1e-14)
        np.testing.assert_allclose(laws.tangent(d)[..., e], material.law.tangent(one, parameters), atol=1e-14)
        assert laws.bulk_modulus[e] == material.bulk_modulus
        assert laws.shear_modulus[e] == material.shear_modulus
