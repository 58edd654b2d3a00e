"""Blind cases as session folders: trials with the bench's noise and now and then a bad one, labelled synthetic."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.signal import lfilter

from benchmark.blind.body.presses import ALL_THICKNESSES
from benchmark.blind.body.specimens import HOLE_RADIUS, MODULUS_ERROR, THICKNESS_ERROR, ToldSpecimen, misjudged
from benchmark.blind.body.true_body import TrueBody
from benchmark.blind.cases import BlindCase, CaseName, generator, make_case
from benchmark.blind.motion import Array, Integers, ReportedMotion, motion
from benchmark.blind.scene import Noise, Scene
from benchmark.blind.simulate import Signals, simulate
from reports import write_text

TAILS = 4.0
ZERO_SCATTER = 0.005
DELAY_SCATTER = 8e-3
DEPTH_SCATTER = 0.01
MOST_HIGHER = 0.1
"""A specimen is at most so much higher or lower than told, as a share."""
LATEST_TOUCH = 0.3
"""Share of the shallow press by which a rig has found the surface in any case."""
MAKER = "computed by the blind trials' generator, not measured"


def remembered(noise: Noise, shape: tuple[int, ...], rng: np.random.Generator) -> Array:
    """First-order autoregressive noise along the first axis, of Student-t shocks with 4 degrees of freedom."""
    shocks = rng.standard_t(TAILS, shape) / np.sqrt(TAILS / (TAILS - 2.0))
    shocks *= np.sqrt(1.0 - noise.memory**2)
    shocks[0] /= np.sqrt(1.0 - noise.memory**2)
    out: Array = noise.std * lfilter([1.0], [1.0, -noise.memory], shocks, axis=0)
    return out


def spike(time: Array, size: float, rng: np.random.Generator) -> Array:
    """A knock against the bench: (n,) N, a decaying ring of a tenth of a second."""
    since = time - rng.uniform(0.2, 0.8) * time[-1]
    ring = np.exp(-since / 0.1) * np.cos(2 * np.pi * 15.0 * since)
    return size * np.where(since >= 0.0, ring, 0.0)


def dropout(time: Array, rng: np.random.Generator) -> Integers:
    """Indices of the samples that are kept when a plug is loose for 0.3 s."""
    begin = rng.uniform(0.2, 0.8) * time[-1]
    return np.flatnonzero((time < begin) | (time > begin + 0.3))


def case(name: CaseName, parent: Path) -> tuple[Path, BlindCase]:
    """Make a case and write its session.

    Parameters
    ----------
    name : CaseName
    parent : Path
        Where the session's folder goes; its name gives nothing away.

    Returns
    -------
    (Path, Case)
        The folder, and the truth, which is in no file of it.
    """
    made = make_case(name)
    return write_case(made, parent / name.alias), made


def write_case(made: BlindCase, folder: Path) -> Path:
    """Write a case's session into `folder`."""
    rng = generator(made.name, "trials")
    folder.mkdir(parents=True, exist_ok=True)
    plans = [plan for plan in made.scene.plans for _ in range(made.scene.repeats)]
    bad = int(rng.integers(len(plans)))
    text = _head(made)
    for number, plan in enumerate(plans, start=1):
        moved = motion(
            plan, made.scene.rate, made.scene.frame_rate, depth_factor=1.0 + DEPTH_SCATTER * rng.uniform(-1.0, 1.0)
        )
        text += f'\n[[trials]]\nfile = "trial_{number:03d}.csv"\ncondition = "{plan.name}"\n'
        fault = made.bad_trial if number - 1 == bad else ""
        text += write_trial(made, moved, folder, number, fault, rng)
    write_text(folder / "session.toml", text)
    write_text(folder / "specimen.toml", _specimen(made))
    return folder


def _specimen(made: BlindCase) -> str:
    """What the lab tells of the specimen."""
    told, lab = made.scene.body.specimen, made.scene.lab
    modulus, thickness = lab.modulus_error, lab.thickness_error
    if made.name.wrong_layers:
        modulus, thickness = MODULUS_ERROR, THICKNESS_ERROR
    if not modulus and not thickness:
        return specimen_text(told)
    wrong = misjudged(told, generator(made.name, "layers"), modulus, thickness)
    return specimen_text(wrong, (modulus, thickness) if made.name.wrong_layers or lab.stated else None)


def write_trial(
    made: BlindCase, moved: ReportedMotion, folder: Path, number: int, fault: str, rng: np.random.Generator
) -> str:
    """Write one trial's files; returns what the session file says of its markers."""
    scene, peak = made.scene, made.scene.scale.force
    effects = [effect.in_trial(rng) for effect in made.effects]
    late = replace(moved, depth=np.interp(moved.time - rng.normal(0.0, DELAY_SCATTER), moved.time, moved.depth))
    gain = float(np.exp(rng.normal(0.0, made.gain_scatter)))
    body = _specimen_of_trial(scene, rng)
    signals = simulate(body, scene.grid, late, effects, gain)
    touch = _touch(scene, late, signals, rng)
    loudness = 4.0 if fault == "shaky" else 1.0
    force = signals.force + loudness * remembered(scene.force_noise, signals.force.shape, rng)
    force += peak * ZERO_SCATTER * rng.normal()
    if fault == "spike":
        force += spike(moved.time, 0.3 * peak, rng)
    rows = dropout(moved.time, rng) if fault == "dropout" else np.arange(moved.time.size)
    columns = {"time_s": moved.time[rows], "depth_mm": 1e3 * (moved.depth[rows] - touch), "force_N": force[rows]}
    pd.DataFrame(columns).round({"time_s": 5, "depth_mm": 4, "force_N": 6}).to_csv(
        folder / f"trial_{number:03d}.csv", index=False
    )
    if signals.x is None or signals.y is None:
        return ""
    _write_markers(made, moved, signals, folder / f"markers_{number:03d}.csv", rng)
    return f'markers = "markers_{number:03d}.csv"\n'


def _specimen_of_trial(scene: Scene, rng: np.random.Generator) -> TrueBody:
    """The body that this trial presses: the same, or one of another height."""
    if not scene.lab.height_spread:
        return scene.body
    higher = float(np.clip(rng.normal(0.0, scene.lab.height_spread), -MOST_HIGHER, MOST_HIGHER))
    return replace(scene.body, setup=((ALL_THICKNESSES, higher),))


def _touch(scene: Scene, moved: ReportedMotion, signals: Signals, rng: np.random.Generator) -> float:
    """True depth (m) at which this trial's reported depth is 0: where the force crosses a threshold, and scatter."""
    lab, found = scene.lab, 0.0
    if lab.touch_threshold:
        over = np.flatnonzero((signals.force > lab.touch_threshold * scene.scale.force) & (moved.depth > 0.0))
        found = min(float(moved.depth[over[0]]), LATEST_TOUCH * scene.scale.shallow) if over.size else 0.0
    return found + float(rng.normal(0.0, lab.touch_scatter)) if lab.touch_scatter else found


def _write_markers(
    made: BlindCase, moved: ReportedMotion, signals: Signals, path: Path, rng: np.random.Generator
) -> None:
    assert signals.x is not None
    assert signals.y is not None
    frames, markers = signals.x.shape
    x = signals.x + remembered(made.scene.marker_noise, signals.x.shape, rng)
    y = signals.y + remembered(made.scene.marker_noise, signals.y.shape, rng)
    columns = {
        "time_s": np.round(np.repeat(moved.frames, markers), 5),
        "marker": np.tile(np.arange(markers), frames),
        "x_mm": np.round(1e3 * x.ravel(), 5),
        "y_mm": np.round(1e3 * y.ravel(), 5),
    }
    pd.DataFrame(columns).to_csv(path, index=False)


def _head(made: BlindCase) -> str:
    """The session file down to its trials."""
    specimen, grid = made.scene.body.specimen, made.scene.grid
    hole = f'hole_radius = "{1e3 * HOLE_RADIUS:g} mm"\n' if specimen.support == "hole" else ""
    text = (
        f'schema = 1\nname = "{made.name.alias}"\nspecimen = "specimen.toml"\nsynthetic = true  # {MAKER}\n\n'
        f'[tool]\nradius = "{1e3 * specimen.tool_radius:g} mm"\ncontact = "rigid_bonded"\n\n'
        f'[support]\nkind = "{specimen.support}"\n{hole}\n[drive]\nchannel = "depth"\n'
    )
    if grid is None:
        return text
    lab = made.scene.lab
    stated = f'print_scatter = "{1e3 * lab.print_scatter:.3f} mm"\n' if lab.print_stated and lab.print_scatter else ""
    return text + (
        f"\n[camera]\nmarker_rows = {grid.rows}\nmarker_columns = {grid.columns}\n"
        f'marker_spacing = "{1e3 * grid.spacing:g} mm"\n{stated}'
    )


def specimen_text(specimen: ToldSpecimen, errors: tuple[float, float] | None = None) -> str:
    """The tissue file of what is told of a specimen; its moduli are not the true ones.

    `errors` are the shares by which moduli and thicknesses are said to be known, where that is said.
    """
    modulus, thickness = ("", "") if errors is None else (f" +/- {100 * error:.3g} %" for error in errors)
    text = f'schema = 1\nname = "{specimen.name}"\ncitation = "Synthetic: {MAKER}."\n'
    for layer in specimen.layers:
        text += (
            f'\n[[layers]]\nname = "{layer.name}"\nthickness = "{1e3 * layer.thickness:g} mm{thickness}"\n'
            f'density = "{layer.density:g} kg/m^3"\nyoungs_modulus = "{1e-3 * layer.youngs_modulus:g} kPa{modulus}"\n'
            f"poisson_ratio = {layer.poisson_ratio:g}\n"
        )
    return text
