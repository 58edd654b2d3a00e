"""Layers that slide past a shear stress: how much deeper the same force goes."""

import matplotlib.pyplot as plt

import benchmark

figure, axes = plt.subplots(figsize=(6, 3.6))
for limit in ("", "500 Pa", "200 Pa"):
    slip = {"physics.interface_shear_limit": limit} if limit else {}
    run = benchmark.run("skin-5N", set={"load.peak": "2 N", "fem.mesh": "coarse", **slip}, repeats=1)
    table = run.to_frame()
    surface = table[table["layer"] == "epidermis"]
    axes.plot(surface["fem_mm"], surface["force_N"], label=f"slides at {limit}" if limit else "bonded")
    print(
        f"{limit or 'bonded'}: {surface['fem_mm'].max():.2f} mm by the FEM, {surface['wave_mm'].max():.2f} by the wave"
    )
axes.set(xlabel="deflection of the surface, FEM (mm)", ylabel="force (N)")
axes.legend()
figure.savefig("layers_that_slip.png", dpi=100, bbox_inches="tight")
