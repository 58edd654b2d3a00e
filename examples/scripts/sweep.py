"""How the press depends on the dermis, at three points."""

import benchmark

swept = benchmark.sweep("skin-5N", vary={"dermis.youngs_modulus": "50 kPa:500 kPa:3:log"}, out="sweep")
print(swept.summary())
print(swept.to_frame().T)
swept.plot().savefig("sweep.svg")
