"""What a run with the published membrane shows."""

import numpy as np
import pytest

from benchmark.runs.report.published_section import published_frames, published_section
from reports import Figure, Table


@pytest.mark.parametrize(("variant", "deepest"), [("as_printed", 39.20117), ("corrected", 31.7788)])
def test_the_wave_goes_down_from_rest_and_comes_back(variant, deepest):
    side, frames = published_frames(variant)
    assert side[-1] == pytest.approx(23.6053)
    depths = [-float(frame[12, 12]) for frame in frames]
    assert depths[0] == pytest.approx(0.0, abs=1e-9)
    assert depths[8] == pytest.approx(deepest, abs=5e-5)
    np.testing.assert_allclose(depths[1:8], depths[:8:-1])


def test_both_variants_move_and_table_1_is_there():
    blocks = published_section().blocks
    animations = [block for block in blocks if isinstance(block, Figure)]
    assert ["as printed" in animations[0].title, "corrected" in animations[1].title] == [True, True]
    assert sum(len(animation.panels[0].data) for animation in animations) < 1_000_000
    assert [len(block.rows) for block in blocks if isinstance(block, Table)] == [4]
