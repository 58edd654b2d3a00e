"""A figure for a paper: one column wide, both models and the error between them, as a vector file."""

import matplotlib.pyplot as plt

import benchmark

run = benchmark.run("skin-5N", repeats=1)
table = run.to_frame()
plt.rcParams.update({"font.size": 8, "font.family": "serif", "axes.spines.top": False, "axes.spines.right": False})
figure, (above, below) = plt.subplots(2, 1, figsize=(3.4, 3.2), sharex=True, height_ratios=(3, 1), layout="constrained")
for layer, rows in table[table["step"] <= 50].groupby("layer", sort=False):
    (line,) = above.plot(rows["force_N"], rows["fem_mm"], label=layer.replace("_", " "))
    above.plot(rows["force_N"], rows["wave_mm"], "--", color="k", lw=0.6)
    below.plot(rows["force_N"], 100 * (rows["wave_mm"] / rows["fem_mm"] - 1), color=line.get_color())
above.set_ylabel("deflection (mm)")
above.legend(frameon=False, title="FEM (dashed: wave)")
below.set(xlabel="force (N)", ylabel="error (%)")
figure.savefig("publication_figure.pdf")
figure.savefig("publication_figure.png", dpi=200)
print(run.summary())
