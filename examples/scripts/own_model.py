"""A fast model of one's own in the wave's place, by the file that has it (see docs/own-model.md)."""

from pathlib import Path

import benchmark

model = Path(__file__).parents[1] / "own_model.py"
run = benchmark.run("skin-5N", wave=model, set={"load.peak": "1 N"})
print(run.summary())
run.plot().savefig("own_model.svg")
