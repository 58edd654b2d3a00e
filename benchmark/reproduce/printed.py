"""What the article prints beside its wave: Table 2, and numbers of its text that are recomputed here.

The numbers of Table 1 and of eqs. (5) to (8) are in `wavemodel.published.printed`.
"""

MEAN_FEM, MEAN_WAVE = -0.05508, -0.05509
"""Mean of the maximum deformations; no unit is printed, mm elsewhere. Down is negative."""
VARIANCE_FEM, VARIANCE_WAVE = 0.001022, 0.001023
OBSERVATIONS = 100.0
HYPOTHESISED_DIFFERENCE = 0.0
P_VALUE, T, T_CRITICAL = 0.997171, 0.00355, 1.972017
"""P(T<=t) two-tail, t Stat and t Critical two-tail."""
PRESS_MM = 2.0
"""Section 3.3.3: the tool is "approximately 0.002m below the starting point"."""
R2_MEAN, R2_LARGEST, R2_SMALLEST = 0.89, 0.956, 0.555
"""Section 3.2.5, of the parabolas (printed in mm, though r^2 has no unit)."""
PERCENT_ERROR = 0.089
"""Section 3.5, the average percent error between the two models."""
