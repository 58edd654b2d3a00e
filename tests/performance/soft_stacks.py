"""How deep stacks of any stiffness can be pressed: `python -m tests.performance.soft_stacks [FIRST] [LAST]`.

Random stacks on a base (one to three layers of 1 kPa to 10 MPa in any order, 0.2 to 10 mm thick), each under one of the
four contacts, pressed to 5 N in 50 steps the way a run does it, larger elements at a folding edge among it. A stack
is met where the press goes to 5 N, or to half of the stack's thickness. Stack n is drawn from the seed (19, n).
"""

from __future__ import annotations

import os

for _name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_name] = "1"  # before NumPy is loaded

import sys  # noqa: E402
import time  # noqa: E402

import numpy as np  # noqa: E402

import fem  # noqa: E402
from benchmark.models.fem_steps import follow_deeper  # noqa: E402

SEED, STACKS = 19, 200
FORCE, STEPS, HALF = 5.0, 50, 0.5
RADIUS, EDGE, FRICTION = 5e-3, 0.5e-3, 0.3
CONTACTS = ("uniform_pressure", "rigid_bonded", "rigid_frictionless", "rigid_frictional")


def stack(number: int) -> fem.Problem:
    """One random stack; the contacts take turns."""
    draw = np.random.default_rng((SEED, number))
    count = int(draw.integers(1, 4))
    layers = tuple(
        fem.Layer(
            f"layer {n}",
            float(1e-3 * 10.0 ** draw.uniform(np.log10(0.2), 1.0)),
            1000.0,
            fem.NeoHookean(float(10.0 ** draw.uniform(3.0, 7.0)), float(draw.choice((0.45, 0.48, 0.49, 0.499)))),
        )
        for n in range(count)
    )
    contact = CONTACTS[number % len(CONTACTS)]
    touching = contact in ("rigid_frictionless", "rigid_frictional")
    friction = FRICTION if contact == "rigid_frictional" else None
    tool = fem.Tool(RADIUS, contact, EDGE if touching else None, friction_coefficient=friction)
    return fem.Problem(layers, tool, fem.Support("bonded"))


def press(problem: fem.Problem) -> tuple[float, float, str]:
    """Force in N and depth over thickness that were reached, and why it went no further."""
    instants = np.arange(1, STEPS + 1) / STEPS
    load = fem.Load("force", instants, FORCE * instants)
    _, found = follow_deeper(fem.prepare(problem), lambda model, _: model.run(load))
    height = sum(layer.thickness for layer in problem.layers)
    reached = found if found.last is None else found.last
    force, depth = (float(reached.force[-1]), float(reached.depth[-1])) if len(reached.time) else (0.0, 0.0)
    return force, depth / height, "" if found.failure is None else found.failure.reason


def main(first: int = 0, last: int = STACKS) -> None:
    """Print a row a stack, and how many are met."""
    met = dict.fromkeys(CONTACTS, 0)
    tried = dict.fromkeys(CONTACTS, 0)
    print("| stack | layers, mm of kPa (ratio) | contact | N | of thickness | CPU s | why no further |")
    print("|---|---|---|---|---|---|---|")
    for number in range(first, last):
        problem, began = stack(number), time.process_time()
        force, share, reason = press(problem)
        good = force >= FORCE * (1.0 - 1e-9) or share >= HALF
        contact = problem.tool.contact
        tried[contact] += 1
        met[contact] += good
        layers = ", ".join(
            f"{1e3 * one.thickness:.2g} of {1e-3 * one.material.youngs_modulus:.3g} ({one.material.poisson_ratio:g})"
            for one in problem.layers
        )
        cost = time.process_time() - began
        verdict = reason if good else f"NOT MET: {reason}"
        print(
            f"| {number} | {layers} | {contact} | {force:.3g} | {100 * share:.0f} % | {cost:.1f} | {verdict} |",
            flush=True,
        )
    for contact in CONTACTS:
        print(f"{contact}: {met[contact]} of {tried[contact]} met")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:3]))
