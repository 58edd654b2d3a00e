"""FEM and wave model under 5 N on skin whose dermis is softer than told."""

import benchmark

run = benchmark.run("skin-5N", set={"dermis.youngs_modulus": "120 kPa"})
print(run.summary())
run.to_frame().to_csv("deflections.csv", index=False)
run.plot().savefig("press.svg")
print(run.report("press"))
