"""A tilted tool by real contact in three dimensions: how much force the same depth takes."""

import matplotlib.pyplot as plt

import benchmark

block = {
    "fem.geometry": "block",
    "fem.mesh": "coarse",
    "tool.contact": "rigid_frictionless",
    "tool.edge_radius": "1 mm",
}
load = {"load.control": "depth", "load.peak": "0.8 mm", "load.observations": "8"}
figure, axes = plt.subplots(figsize=(6, 3.6))
for tilt in ("0 deg", "4 deg"):
    run = benchmark.run("skin-5N", set={**block, **load, "tool.tilt": tilt}, repeats=1)
    rows = run.tables()["force_depth"]
    axes.plot(rows["fem_depth_mm"], rows["fem_force_N"], "o-", label=f"tilted by {tilt}")
    print(f"{tilt}: {rows['fem_force_N'].max():.3f} N")
axes.set(xlabel="depth (mm)", ylabel="force (N)")
axes.legend()
figure.savefig("tilted_tool.png", dpi=100, bbox_inches="tight")
