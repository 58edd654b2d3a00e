"""The trials of a lab (here a shipped session, synthetic): the stiffness they tell, and both models against them."""

import benchmark
from benchmark.sessions import SHIPPED

fit = benchmark.fit(SHIPPED / "gel_pad")
print(fit.summary())
run = benchmark.run(trials=SHIPPED / "gel_pad", repeats=1)
print(run.tables()["validation"].to_string(index=False))
fit.plot().savefig("lab_trials.png", dpi=100)
