import numpy as np

from wavemodel.elastic_law import ElasticLaw


def test_without_a_correction_it_is_linear_both_ways():
    law = ElasticLaw(2e-3)
    np.testing.assert_allclose(law(np.array([-1e-3, 0.0, 4e-3])), [-0.5, 0.0, 2.0])
    np.testing.assert_allclose(law.depth_at(np.array([2.0])), [4e-3])
