import numpy as np
import pytest


@pytest.fixture
def triangle():
    """The load history behind the paper's Table 2: 100 steps up and down to 0.11016 mm."""
    return 0.11016 * np.r_[1:51, 49:-1:-1] / 50


@pytest.fixture
def peak_flow():
    """Peak expiratory flow of 17 people by two meters, l/min: the data of Bland and Altman, Lancet 327:307 (1986)."""
    large = [494, 395, 516, 434, 476, 557, 413, 442, 650, 433, 417, 656, 267, 478, 178, 423, 427]
    mini = [512, 430, 520, 428, 500, 600, 364, 380, 658, 445, 432, 626, 260, 477, 259, 350, 451]
    return np.array(large, dtype=float), np.array(mini, dtype=float)
