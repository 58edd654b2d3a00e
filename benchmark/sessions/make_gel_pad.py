"""Makes the shipped session gel_pad: synthetic presses of a two-layer pad in which an effect is hidden.

    python -m benchmark.sessions.make_gel_pad FOLDER [--truth FILE]

Nothing in it is measured, and every file says so. What lies under the tool is not what `pad.toml` in the folder says:
its stiffness is another, and it has an effect that no model of the session knows. `discover gel_pad` should name that
effect; the truth is in `gel_pad_truth.toml` beside this module, which nothing that fits reads.

The route differs from the discovery's own: a fine mesh in the place of the default one, and the effect in the equations
of the solid, by a law with other constants in each layer, instead of a factor on the force. Stiffness, touch, zero,
clock and noise differ from trial to trial, drawn from one seed. The depths, and which tool, were chosen so that the
effect can be told from its rivals; it is still this product's own finite-element code: this tests the workflow, not
the physics.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np
from scipy.signal import lfilter

from bench_hw.tables import TrialTable, write_trial_csv
from benchmark.errors import SolverError
from benchmark.files import Load, Scenario, Support, Tool, load_tissue
from benchmark.files.scenario import FemOptions
from benchmark.files.tissue import Layer, Tissue, Yeoh
from benchmark.models import Drive, prepare
from benchmark.models.model_result import Array
from reports import write_text

SEED: Final = 41
TRIALS: Final = 3
"""Of each condition."""
RATE: Final = 50.0
AIR: Final = 0.4e-3
"""How far above the pad a trial begins, m."""
STIFFNESS: Final = 0.92
"""Of the pad over its file."""
STIFFENING: Final = {"skin": (0.5, 0.0), "gel": (1.5, 0.1)}
"""The hidden effect: Yeoh's c20 and c30 over c10 in each layer, zero in the file's neo-Hookean law."""
GAIN_SCATTER: Final = 0.015
TOUCH_SCATTER: Final = 0.02e-3
ZERO_SCATTER: Final = 5e-3
CLOCK_SCATTER: Final = 2e-3
NOISE: Final = 4e-3
MEMORY: Final = 0.3
"""Standard deviation of the force's noise, N, and its correlation from sample to sample."""


@dataclass(frozen=True)
class Press:
    """A condition: tool radius m, depth m, speed m/s, hold s."""

    name: str
    radius: float
    depth: float
    speed: float
    hold: float

    def corners(self) -> tuple[Array, Array]:
        """Times s and depths m between which the tool moves evenly: in air, down, held, up, in air."""
        ramp = (self.depth + AIR) / self.speed
        return np.cumsum([0.0, 0.5, ramp, self.hold, ramp, 1.0]), np.array(
            [-AIR, -AIR, self.depth, self.depth, -AIR, -AIR]
        )


PRESSES: Final = (
    Press("shallow", 5e-3, 2.5e-3, 0.5e-3, 1.0),
    Press("deep", 5e-3, 3.5e-3, 2e-3, 2.0),
    Press("wide", 8e-3, 2.8e-3, 1e-3, 1.0),
)
"""Two depths and speeds with one tool, and a wider tool."""

SESSION: Final = """\
schema = 1
name = "gel_pad"
specimen = "pad.toml"
synthetic = true            # computed by benchmark/sessions/make_gel_pad.py, not measured

[tool]
radius = "5 mm"
contact = "rigid_bonded"

[support]
kind = "bonded"

[drive]
channel = "depth"
"""


def main(arguments: list[str] | None = None) -> int:
    """Write the session into the folder that the command line names, and the truth beside it where asked for."""
    parser = argparse.ArgumentParser(description="Make the synthetic session gel_pad.")
    parser.add_argument("folder", type=Path, help="with pad.toml in it")
    parser.add_argument("--truth", type=Path, help="also write the truth here")
    options = parser.parse_args(arguments)
    pad = hidden_pad(load_tissue(options.folder / "pad.toml"))
    generator, text = np.random.default_rng(SEED), SESSION
    for press in PRESSES:
        if press.radius != PRESSES[0].radius:
            text += f'\n[conditions.{press.name}.tool]\nradius = "{1e3 * press.radius:g} mm"\n'
    for press in PRESSES:
        curve = pressed(pad, press)
        for number, table in enumerate(trials(press, curve, generator), 1):
            write_trial_csv(options.folder / f"{press.name}_{number}.csv", table)
            text += f'\n[[trials]]\nfile = "{press.name}_{number}.csv"\ncondition = "{press.name}"\n'
        print(f"{press.name} made", flush=True)
    write_text(options.folder / "session.toml", text)
    if options.truth is not None:
        write_text(options.truth, truth_text())
    return 0


def hidden_pad(told: Tissue) -> Tissue:
    """What lies under the tool: the told pad with another stiffness and law, and the hidden effect."""
    return told.model_copy(update={"layers": tuple(map(_hidden_layer, told.layers))})


def _hidden_layer(told: Layer) -> Layer:
    half = 0.5 * STIFFNESS * told.shear_modulus
    second, third = STIFFENING[told.name]
    law = Yeoh(law="yeoh", c10=half, c20=second * half, c30=third * half)
    return told.model_copy(update={"youngs_modulus": STIFFNESS * told.youngs_modulus, "hyperelastic": law})


def pressed(pad: Tissue, press: Press) -> tuple[Array, Array]:
    """Times s, close together after each corner, and the force N of the pad; a tool that lifts off cannot pull.

    Raises
    ------
    SolverError
        It could not be pressed deep enough.
    """
    corners, depths = press.corners()
    time = np.unique(np.concatenate([_between(*pair) for pair in pairwise(corners)]))
    depth = np.maximum(np.interp(time, corners, depths), 0.0)
    load = Load(control="depth", peak=press.depth, shape="ramp", duration=1.0, observations=1)
    scenario = Scenario(
        name=press.name,
        tissue=pad,
        tool=Tool(radius=press.radius, contact="rigid_bonded"),
        support=Support(kind="bonded"),
        load=load,
        fem=FemOptions(mesh="fine"),
    )
    result = prepare("fem", scenario).run(Drive("depth", time[1:], depth[1:]))
    if result.failure is not None:
        raise SolverError(f"the hidden pad could not be pressed: {result.failure}")
    force = np.append(0.0, result.force)
    gone = np.flatnonzero((force < 0.0) & (time > corners[3]))
    force[gone[0] if gone.size else force.size :] = 0.0
    return time, force


def _between(start: float, end: float) -> Array:
    """(25,) instants from one corner to the next, three times as close together at first as on average."""
    share = np.linspace(0.0, 1.0, 25)
    return np.asarray(start + (end - start) * share * (1.0 + 2.0 * share) / 3.0)


def trials(press: Press, curve: tuple[Array, Array], generator: np.random.Generator) -> Iterator[TrialTable]:
    """Trials of one condition as the sensors report them."""
    corners, depths = press.corners()
    time = np.arange(0.0, corners[-1], 1.0 / RATE)
    reported = np.interp(time, corners, depths)
    for _ in range(TRIALS):
        gain = np.exp(generator.normal(0.0, GAIN_SCATTER))
        late = time - generator.normal(0.0, CLOCK_SCATTER)
        force = gain * np.interp(late, *curve) + generator.normal(0.0, ZERO_SCATTER)
        touch = generator.normal(0.0, TOUCH_SCATTER)
        force += lfilter([np.sqrt(1.0 - MEMORY**2)], [1.0, -MEMORY], generator.normal(0.0, NOISE, time.size))
        yield TrialTable(time, np.round(reported + touch, 7), np.round(force, 5))


def truth_text(presses: Sequence[Press] = PRESSES) -> str:
    """What was put in."""
    lines = [
        "# What was put into the session gel_pad. Synthetic. Nothing that fits reads this file.",
        "schema = 1",
        'effect = "strain_stiffening"',
        f"stiffness = {STIFFNESS}        # over pad.toml, at small strain",
        f"force_noise_N = {NOISE}",
        f"gain_scatter = {GAIN_SCATTER}",
        f"conditions = {[press.name for press in presses]}",
        "",
        "[yeoh]        # c20 and c30 of each layer over its c10; pad.toml is neo-Hookean",
        *(f"{name} = {list(shares)}" for name, shares in STIFFENING.items()),
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
