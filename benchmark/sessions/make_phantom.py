"""Makes the shipped phantom session: ten synthetic presses of a silicone sheet over a hole.

    python -m benchmark.sessions.make_phantom FOLDER

The trials are computed, not measured, and say so (`synthetic = true`). The sheet is the tissue `rtv3498_sheet` with
another stiffness, which the fit has to find: `TRUE_FACTOR` times the file's modulus. Its force over depth comes from
the finite-element solver; so a fit with the same solver is circular in the law and tests the chain, not the physics.
On top comes what a bench adds: a stiffness that differs a little from trial to trial, a contact that is not at zero
depth, a force zero that is off, noise with memory on the force, and a depth read in counts of the actuator (0.049 mm).
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmark.errors import SolverError
from benchmark.files import Load, Scenario, Support, Tissue, Tool, load_tissue, scaled_tissue
from benchmark.models import Array, Drive, prepare
from reports import write_csv, write_text

SPECIMEN = "rtv3498_sheet"
TRUE_FACTOR = 0.83
TRIALS = 10
SEED = 20
TOOL = Tool(radius=5e-3, contact="rigid_bonded")
SUPPORT = Support(kind="hole", hole_radius=30e-3)

PRESS = 5e-3
SPEED = 1e-3
REST = 0.5
RATE = 20.0

GAIN_SCATTER = 0.02
ONSET_SCATTER = 0.08e-3
ZERO_SCATTER = 4e-3
NOISE = 1.5e-3
NOISE_MEMORY = 0.6
COUNT = 50e-3 / 1023

SESSION = """\
schema = 1
name = "phantom"
specimen = "{specimen}"
synthetic = true            # computed by benchmark/sessions/make_phantom.py, not measured

[tool]
radius = "5 mm"
contact = "rigid_bonded"

[support]
kind = "hole"
hole_radius = "30 mm"

[drive]
channel = "depth"
"""


@dataclass(frozen=True)
class Press:
    """One trial: s, m as the actuator reports it, N."""

    time: Array
    depth: Array
    force: Array


def main(arguments: list[str] | None = None) -> int:
    """Write the session into the folder that the command line names."""
    parser = argparse.ArgumentParser(description="Make the synthetic phantom session.")
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args(arguments).folder
    curve_depth, curve_force = true_curve()
    generator = np.random.default_rng(SEED)
    text = SESSION.format(specimen=SPECIMEN)
    for number in range(1, TRIALS + 1):
        press = one_press(curve_depth, curve_force, generator)
        columns = {
            "time_s": np.round(press.time, 4),
            "depth_mm": np.round(1e3 * press.depth, 4),
            "force_N": np.round(press.force, 6),
        }
        path = write_csv(folder / f"trial_{number:03d}.csv", columns)
        text += f'\n[[trials]]\nfile = "{path.name}"\ncondition = "press"\n'
    write_text(folder / "session.toml", text)
    print(f"{TRIALS} synthetic trials in {folder}")
    return 0


def true_curve() -> tuple[Array, Array]:
    """Depth (k,) m and force (k,) N of the hidden sheet, a little deeper than the press."""
    tissue: Tissue = scaled_tissue(load_tissue(SPECIMEN), TRUE_FACTOR, "hidden sheet")
    load = Load(control="depth", peak=PRESS, shape="ramp", duration=1.0, observations=1)
    scenario = Scenario(name="hidden sheet", tissue=tissue, tool=TOOL, support=SUPPORT, load=load)
    fractions = np.arange(1, 67) / 60
    result = prepare("fem", scenario).run(Drive("depth", fractions, PRESS * fractions))
    if result.failure is not None:
        raise SolverError(f"the hidden sheet could not be pressed: {result.failure}")
    return np.append(0.0, result.depth), np.append(0.0, result.force)


def one_press(curve_depth: Array, curve_force: Array, generator: np.random.Generator) -> Press:
    """Press and retract once, with everything that a bench adds."""
    time = np.arange(0.0, 2 * REST + 2 * PRESS / SPEED + 0.5 / RATE, 1 / RATE)
    pressing = np.clip(time - REST, 0.0, 2 * PRESS / SPEED)
    depth = PRESS - np.abs(SPEED * pressing - PRESS)
    onset = abs(generator.normal(0.0, ONSET_SCATTER))
    gain = np.exp(generator.normal(0.0, GAIN_SCATTER))
    force = gain * np.interp(depth - onset, curve_depth, curve_force)
    force += generator.normal(0.0, ZERO_SCATTER) + remembered_noise(time.size, generator)
    return Press(time, COUNT * np.round(depth / COUNT), force)


def remembered_noise(size: int, generator: np.random.Generator) -> Array:
    """First-order autoregressive noise (size,) N with standard deviation `NOISE`."""
    shocks = generator.normal(0.0, NOISE * np.sqrt(1 - NOISE_MEMORY**2), size)
    noise = np.empty(size)
    noise[0] = generator.normal(0.0, NOISE)
    for row in range(1, size):
        noise[row] = NOISE_MEMORY * noise[row - 1] + shocks[row]
    return noise


if __name__ == "__main__":
    sys.exit(main())
