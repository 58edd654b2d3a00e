"""Parameters with intervals from presses of two tools (shipped, synthetic), and what the presses cannot tell."""

import benchmark
from benchmark.sessions import SHIPPED

fit = benchmark.fit(SHIPPED / "gel_pad", free=["skin.youngs_modulus", "gel.youngs_modulus"], law="yeoh")
print(fit.summary())
print(fit.to_frame().to_string(index=False))
print(fit.report("identified"))
fit.plot().savefig("identification.png", dpi=100)
