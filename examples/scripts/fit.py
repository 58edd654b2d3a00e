"""The stiffness of the shipped phantom from its trials and films; a folder of CSV files does as well."""

import benchmark
from benchmark.sessions import SHIPPED

fit = benchmark.fit(SHIPPED / "phantom")
print(fit.summary())
fit.plot().savefig("trials.svg")
fit.to_frame().to_csv("parameters.csv", index=False)
