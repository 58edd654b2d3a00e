"""The figures of docs/theory.md: `python examples/theory_figures.py [FOLDER]`."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import fem
from wavemodel import DiscTool, LayeredWave, WaveDiscretisation, WaveLayer

LAYERS = (("epidermis", 0.1e-3, 1110.0, 1e6), ("dermis", 1.5e-3, 1116.0, 1e5), ("fat", 10e-3, 971.0, 2e4))
"""Name, thickness m, density kg/m3 and Young's modulus Pa of a skin; Poisson's ratio is 0.48."""
RADIUS = 5e-3
SKIN = [WaveLayer(*layer, 0.48) for layer in LAYERS]


def modes() -> plt.Figure:
    """What more modes add to the surface under a press of 0.5 N."""
    figure, axes = plt.subplots(figsize=(6, 3.4))
    x = np.linspace(0.0, 25e-3, 301)
    for count in (4, 6, 8, 48):
        settings = WaveDiscretisation(window=60e-3, modes=count)
        wave = LayeredWave(SKIN, DiscTool(RADIUS), discretisation=settings, large_press="linear")
        profile = wave.run("force", np.array([1.0]), np.array([0.5])).profile(0, x)
        axes.plot(1e3 * x, 1e3 * profile[0], label=f"{count} x {count} modes")
    axes.axvspan(0.0, 1e3 * RADIUS, color="0.93", label="tool")
    axes.set(xlabel="distance from the axis (mm)", ylabel="deflection of the surface (mm)", xlim=(0, 25))
    axes.invert_yaxis()
    axes.legend()
    return figure


def layers() -> plt.Figure:
    """Each layer's top face under 2 N, at finite strain."""
    figure, axes = plt.subplots(figsize=(6, 3.4))
    x = np.linspace(-25e-3, 25e-3, 401)
    profile = LayeredWave(SKIN, DiscTool(RADIUS)).run("force", np.array([1.0]), np.array([2.0])).profile(0, abs(x))
    above = 0.0
    for layer, down in zip(SKIN, profile, strict=True):
        axes.plot(1e3 * x, 1e3 * (above + down), label=f"top of the {layer.name}")
        above += layer.thickness
    axes.axhline(1e3 * above, color="0.3", lw=3, label="base")
    axes.set(xlabel="distance from the axis (mm)", ylabel="height below the surface at rest (mm)")
    axes.invert_yaxis()
    axes.legend(loc="lower right")
    return figure


def finite_strain() -> plt.Figure:
    """Force over depth: small strain, finite strain in the modes, and finite elements, which neither has seen."""
    figure, axes = plt.subplots(figsize=(6, 3.4))
    force = np.linspace(0.1, 2.0, 20)
    for press, style in (("linear", "k:"), ("auto", "C0-")):
        depth = LayeredWave(SKIN, DiscTool(RADIUS), large_press=press).run("force", force, force).depth
        name = "small strain" if press == "linear" else "finite strain of the layers"
        axes.plot(1e3 * depth, force, style, label=f"layered wave, {name}")
    stack = tuple(fem.Layer(name, h, rho, fem.NeoHookean(E, 0.48)) for name, h, rho, E in LAYERS)
    problem = fem.Problem(stack, fem.Tool(RADIUS, "uniform_pressure"), fem.Support("bonded"))
    solution = fem.prepare(problem).run(fem.Load("force", force[3::4], force[3::4]))
    axes.plot(1e3 * solution.depth, solution.force, "C1o", label="finite elements")
    axes.set(xlabel="depth (mm)", ylabel="force (N)")
    axes.legend()
    return figure


FIGURES = {"modes": modes, "layers": layers, "finite-strain": finite_strain}

if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    for name, draw in FIGURES.items():
        draw().savefig(folder / f"theory-{name}.png", dpi=90, bbox_inches="tight")
