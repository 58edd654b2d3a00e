"""What the wave model of small strain lacks against the finite elements; a session's folder does as well as a run's."""

import benchmark

page = benchmark.run("skin-5N").report("press")
found = benchmark.discover(page.parent)
print(found.summary())
found.plot().savefig("gap.svg")
print(found.report("found"))
