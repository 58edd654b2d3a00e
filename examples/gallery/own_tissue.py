"""A tissue of one's own, from a file that says where each value comes from, beside a shipped one."""

from pathlib import Path

import matplotlib.pyplot as plt

import benchmark

Path("cheek.toml").write_text("""schema = 1
name = "cheek"
citation = "made up for this example"
[[layers]]
name = "mucosa"
thickness = "0.5 mm"
density = "1100 kg/m^3"
youngs_modulus = "400 kPa"
poisson_ratio = 0.48
[[layers]]
name = "muscle"
thickness = "8 mm"
density = "1060 kg/m^3"
youngs_modulus = "60 kPa"
poisson_ratio = 0.49
""")
figure, axes = plt.subplots(figsize=(6, 3.6))
for tissue in ("cheek.toml", "skin_forearm"):
    run = benchmark.run("skin-5N", tissue=tissue, set={"load.peak": "2 N"}, repeats=1)
    print(run.summary())
    table = run.to_frame()
    surface = table[table["layer"] == table["layer"].iloc[0]]
    axes.plot(surface["fem_mm"], surface["force_N"], label=f"{tissue.removesuffix('.toml')}, FEM")
    axes.plot(surface["wave_mm"], surface["force_N"], "k:", lw=1)
axes.set(xlabel="deflection of the surface (mm)", ylabel="force (N)", title="dotted: wave model")
axes.legend()
figure.savefig("own_tissue.png", dpi=100, bbox_inches="tight")
