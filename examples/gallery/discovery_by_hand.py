"""Discovery by hand: an effect is switched on, and its strength turned, to see what is left (shipped, synthetic)."""

import matplotlib.pyplot as plt
import numpy as np

import benchmark
from benchmark.sessions import SHIPPED

strengths, left = [0.0, 1.5, 3.0], []
for strength in strengths:
    effect = {"physics.stiffening_linear": f"{strength}"} if strength else {}
    run = benchmark.run(trials=SHIPPED / "gel_pad", set=effect, repeats=1)
    table = run.tables()["measured"]
    left.append(float(np.sqrt(((table["wave_force_N"] - table["force_N"]) ** 2).mean())))
    print(f"stiffening_linear {strength}: {1e3 * left[-1]:.1f} mN left by the wave model, stiffness fitted anew")
figure, axes = plt.subplots(figsize=(6, 3.6))
axes.plot(strengths, 1e3 * np.array(left), "o-")
axes.set(xlabel="physics.stiffening_linear", ylabel="rms of measured minus wave (mN)")
figure.savefig("discovery_by_hand.png", dpi=100, bbox_inches="tight")
