"""A bench of simulated devices that speak the real ones' bytes: capture trials, then fit them."""

import subprocess
import sys

import benchmark

capture = ["capture", "paper_press", "--rig", "simulated", "--out", "my_session", "--trials", "4", "--fast"]
subprocess.run([sys.executable, "-m", "bench_hw", *capture], check=True)
fit = benchmark.fit("my_session")
print(fit.summary())
fit.plot().savefig("bench_twin.png", dpi=100)
