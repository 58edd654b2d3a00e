"""An organ from a surface file: a closed surface (made here, nobody's liver) pressed in three dimensions."""

from pathlib import Path

import numpy as np
import pyvista

import benchmark

body = pyvista.ParametricEllipsoid(0.06, 0.045, 0.03, u_res=40, v_res=20, w_res=20).triangulate().clean()
body.points = np.asarray(body.points) * (1.0 + 0.1 * np.cos(40.0 * body.points[:, :1]))
body.scale(1e3).save("organ.stl")
Path("organ.toml").write_text("""schema = 1
name = "organ"
citation = "made up for this example"
[[layers]]
name = "capsule"
thickness = "2 mm"
density = "1060 kg/m^3"
youngs_modulus = "40 kPa"
poisson_ratio = 0.45
[[layers]]
name = "parenchyma"
thickness = "20 mm"
density = "1060 kg/m^3"
youngs_modulus = "8 kPa"
poisson_ratio = 0.45
""")
geometry = {"fem.geometry": "surface", "fem.surface": "organ.stl", "fem.surface_unit": "mm", "fem.mesh": "coarse"}
press = {"load.peak": "0.3 N", "load.observations": "6", "tool.radius": "8 mm"}
run = benchmark.run("skin-5N", tissue="organ.toml", set={**geometry, **press}, repeats=1)
print(run.summary())
print(run.report("organ"))
run.plot().savefig("liver_from_stl.png", dpi=100)
