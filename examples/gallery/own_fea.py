"""An FEA of one's own in the FEM's place: here this package's own elements on one layer, told as a table."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import benchmark
import fem

settings = {"load.peak": "1 N", "dermis.youngs_modulus": "200 kPa"}
ours = benchmark.run("skin-5N", set=settings, repeats=1).record.scenario
layers = tuple(
    fem.Layer(each.name, each.thickness, each.density, fem.NeoHookean(each.youngs_modulus, each.poisson_ratio))
    for each in ours.tissue.layers
)
problem = fem.Problem(layers, fem.Tool(ours.tool.radius, ours.tool.contact), fem.Support("bonded"))
force = np.linspace(0.05, 1.0, 20)
solution = fem.prepare(problem).run(fem.Load("force", np.arange(1, 21) / 10.0, force))
table = {"force_N": np.repeat(force, len(layers)), "layer": [each.name for each in layers] * force.size}
pd.DataFrame({**table, "fem_mm": 1e3 * solution.top_deflection.ravel()}).to_csv("my_fea.csv", index=False)

run = benchmark.run("skin-5N", set=settings, reference="my_fea.csv", repeats=1)
print(run.summary())
run.plot().savefig("own_fea.png", dpi=100)
plt.close("all")
