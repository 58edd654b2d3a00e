"""Quick synthetic sessions for the tests: a layer on a base, pressed at two speeds, with memory in the noise.

The body comes from the wave model, as the discovery's base does, so a name found in such a session is circular; the
blind trials are what says something of the method.
"""

from functools import cache

import numpy as np

PEAK = 3e-3

TISSUE = """\
schema = 1
name = "layer"

[[layers]]
name = "layer"
thickness = "12 mm"
density = "1100 kg/m^3"
youngs_modulus = "30 kPa"
poisson_ratio = 0.47
"""


def motion(speed, peak=PEAK, hold=2.0, cycles=2, rate=25.0):
    """Time (n,) s and depth (n,) m of presses with a hold, from 0.5 mm above the surface."""
    knots = [(0.0, -0.5e-3), (0.8, -0.5e-3)]
    for _ in range(cycles):
        t, d = knots[-1]
        knots.append((t + (peak - d) / speed, peak))
        knots.append((knots[-1][0] + hold, peak))
        knots.append((knots[-1][0] + (peak + 0.5e-3) / speed, -0.5e-3))
        knots.append((knots[-1][0] + 0.8, -0.5e-3))
    time = np.arange(0.0, knots[-1][0], 1.0 / rate)
    return time, np.interp(time, *np.array(knots).T)


def law(depth):
    """The wave model's force over depth of the layer; solved once for all trials that move alike."""
    return _solved(np.maximum(depth, 0.0).tobytes()).copy()


@cache
def _solved(depths):
    from wavemodel import DiscTool, LayeredWave, WaveLayer

    layers = [WaveLayer("layer", 12e-3, 1100.0, 30e3, 0.47)]
    wave = LayeredWave(layers, DiscTool(5e-3, "rigid_bonded"), large_press="corrected")
    return wave.law(np.frombuffer(depths))


def memory_noise(rng, size, scale, memory=0.6):
    shocks = rng.normal(0.0, scale * np.sqrt(1 - memory**2), size)
    noise = np.zeros(size)
    for k in range(1, size):
        noise[k] = memory * noise[k - 1] + shocks[k]
    return noise


def heights(trials, touch, seed=0):
    """Depths (trials,) m at which the tool touches in each trial."""
    return touch * np.random.default_rng([seed, 1]).normal(size=trials)


def write_session(folder, *, force=None, trials=4, speeds=(1.5e-3, 6e-3), noise=0.005, seed=0, hold=2.0, touch=0.0):
    """A session folder; `force(time, depth, elastic)` adds the effect; `touch` m by which `heights` scatter."""
    rng = np.random.default_rng(seed)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "layer.toml").write_text(TISSUE)
    lines = ['schema = 1\nname = "quick"\nspecimen = "layer.toml"\nsynthetic = true\n']
    lines.append('[tool]\nradius = "5 mm"\ncontact = "rigid_bonded"\n[support]\nkind = "bonded"\n')
    number = 0
    touched = heights(trials * len(speeds), touch, seed)
    for speed in speeds:
        time, depth = motion(speed, hold=hold)
        for _ in range(trials):
            elastic = law(depth - touched[number])
            clean = elastic if force is None else force(time, depth - touched[number], elastic)
            number += 1
            measured = np.exp(rng.normal(0.0, 0.02)) * clean + rng.normal(0.0, 0.01)
            measured = measured + memory_noise(rng, time.size, noise * elastic.max())
            name = f"trial_{number:02d}.csv"
            table = np.column_stack([time, 1e3 * depth, measured])
            np.savetxt(folder / name, table, delimiter=",", header="time_s,depth_mm,force_N", comments="", fmt="%.7f")
            lines.append(f'[[trials]]\nfile = "{name}"\ncondition = "speed {1e3 * speed:g}"\n')
    (folder / "session.toml").write_text("\n".join(lines))
    return folder
