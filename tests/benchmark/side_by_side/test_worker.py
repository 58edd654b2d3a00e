import subprocess
import sys

import numpy as np
import pytest

HELD = 400e6
ASK = "from benchmark.side_by_side.worker import peak_memory; print(peak_memory())"


@pytest.mark.skipif(sys.platform != "linux", reason="a process of another system does not take over its parent's peak")
def test_the_peak_memory_is_the_processs_own_not_its_parents():
    held = np.ones(int(HELD / 8))
    told = subprocess.run([sys.executable, "-c", ASK], capture_output=True, text=True, check=True, timeout=60)
    assert held.nbytes == pytest.approx(HELD)
    assert 10e6 < int(told.stdout) < 0.8 * HELD
