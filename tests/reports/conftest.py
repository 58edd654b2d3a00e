"""A page with every block and every figure, from made-up but lifelike arrays."""

from __future__ import annotations

import numpy as np
import pytest

from reports import (
    Bullets,
    Column,
    Download,
    Fact,
    Facts,
    KeyFigure,
    KeyFigures,
    Listing,
    Notice,
    Page,
    Paragraph,
    Section,
    Subsection,
    Table,
    Verdict,
    figures,
)
from reports.figures.pressed_layers import pressed_layers
from reports.figures.studies import overlay
from reports.figures.timing import growth

LAYERS = ("epidermis", "dermis", "subcutaneous fat")
TOOL_RADIUS = 5.0
RADIUS = np.linspace(0, 20, 40)


def triangle(steps: int = 100, peak: float = 5.0) -> tuple[np.ndarray, np.ndarray]:
    """Return step numbers and forces in N of a triangle load, shape (steps,) each."""
    step = np.arange(1, steps + 1)
    return step, peak * (1 - np.abs(2 * step / steps - 1))


def deflections(force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return deflections in mm of a stiffening FEM and a linear wave model, shape (n, 3) each."""
    share = np.array([1.0, 0.985, 0.82])
    fem = np.outer(2.9 * (1 - np.exp(-force / 4.2)) / (1 - np.exp(-5 / 4.2)), share)
    wave = np.outer(3.65 * force / 5, share * [1.0, 1.002, 1.01])
    return fem, wave


def relative(fem: np.ndarray, wave: np.ndarray) -> np.ndarray:
    """Return the error of `wave` against `fem` in percent, NaN at zero load."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(fem > 0, 100 * (wave / fem - 1), np.nan)


def trial_curves(count: int, conditions: tuple[str, ...] = ("5 mm tool",), rows: int = 150, seed: int = 3):
    """Return trials with noise, hysteresis and a spread of stiffness, round-robin over the conditions."""
    generator = np.random.default_rng(seed)
    curves = []
    for number in range(count):
        phase = np.linspace(0, 2, rows)
        depth = (2.2 + 0.25 * generator.normal()) * (1 - np.abs(phase - 1))
        stiff = (1.0 + 0.1 * generator.normal()) * (1 + 0.25 * (number % len(conditions)))
        model = stiff * (0.9 * depth + 0.35 * depth**2)
        loss = np.where(phase > 1, 0.35 * depth * (depth.max() - depth), 0.0)
        force = model - loss + 0.015 * generator.normal(size=rows)
        condition = conditions[number % len(conditions)]
        curves.append(
            figures.TrialCurve(f"trial_{number:02d}", condition, depth, force, 0.97 * model, 1.45 * depth * stiff)
        )
    return curves


def layer_figures() -> dict[str, object]:
    """Return the figures with a panel a layer."""
    step, force = triangle()
    fem, wave = deflections(force)
    radius = np.linspace(0, 25, 80)
    shape = np.array([1 / (1 + (radius / width) ** 2) ** 1.5 for width in (6.5, 6.8, 8.0)])
    normals = [
        [figures.Normal(float(m), float(s)) for m, s in zip(x.mean(0), x.std(0), strict=True)] for x in (fem, wave)
    ]
    return {
        "max_deformation": figures.max_deformation(LAYERS, step, fem, wave, relative(fem, wave)),
        "profile": figures.profile(
            LAYERS,
            radius,
            fem.max(0)[:, None] * shape,
            np.where(radius < 21, 1.02 * wave.max(0)[:, None] * shape**1.05, np.nan),
            TOOL_RADIUS,
        ),
        "normal_fit": figures.normal_fit(LAYERS, fem, normals[0], wave, normals[1]),
    }


def single_figures() -> dict[str, object]:
    """Return the figures of one panel."""
    step, force = triangle()
    fem, wave = deflections(force)
    generator = np.random.default_rng(1)
    return {
        "pressed_layers": pressed_layers(
            LAYERS,
            [0.0, 0.1, 1.7],
            11.7,
            RADIUS,
            np.outer(fem.max(0), 1 / (1 + (RADIUS / 6.5) ** 2) ** 1.5),
            np.where(RADIUS < 15, np.outer(wave.max(0), 1 / (1 + (RADIUS / 6.5) ** 2) ** 1.5), np.nan),
            TOOL_RADIUS,
        ),
        "force_depth": figures.force_depth(fem[:, 0], force, wave[:, 0], force),
        "load_history": figures.load_history(step / 10, force, "force", fem[:, 0], wave[:, 0]),
        "timing": figures.timing(
            {"fem": 3.1 + 0.2 * generator.random(5), "wave": 0.021 + 0.002 * generator.random(5)},
            {"fem": 0.9, "wave": 0.31},
            {"FEA, as the article prints": 240.0, "wave, as the article prints": 10.0},
        ),
        "layer_stack": figures.layer_stack(
            [
                figures.StackLayer("epidermis", 0.1, 1500.0),
                figures.StackLayer("dermis", 1.6, 300.0),
                figures.StackLayer("subcutaneous fat", 10.0, 3.2),
            ],
            figures.ToolShape(TOOL_RADIUS),
        ),
        "layer_stack_hole": figures.layer_stack(
            [figures.StackLayer("silicone with oil", 4.0, 45.0)], figures.ToolShape(TOOL_RADIUS), "hole", 30.0
        ),
        "layer_stack_half_space": figures.layer_stack(
            [figures.StackLayer("dermis", 1.6, 300.0), figures.StackLayer("muscle", None, 12.0)],
            figures.ToolShape(TOOL_RADIUS),
            "half_space",
        ),
        "growth": growth({"fem": ([510, 1328, 5344], [8.1, 20.4, 91.0]), "wave": ([3696, 14832], [0.034, 0.035])}),
        "overlay": overlay(
            {
                "force over depth": {
                    f"run {k}, {name}": (k * fem[:, 0], force) for k in (1, 2) for name in ("FEM", "wave")
                }
            },
            "depth (mm)",
            "force (N)",
            "Two runs over each other.",
            "Force and depth",
        ),
        "measured": figures.measured(trial_curves(40), synthetic=True),
        "measured_conditions": figures.measured(trial_curves(12, ("5 mm tool", "3 mm tool", "over the hole"))),
        "fitted_parameters": figures.fitted_parameters(
            [
                figures.ParameterRow("youngs_modulus", 45.2, "kPa", 44.1, 46.3),
                figures.ParameterRow("dermis.youngs_modulus", 310.0, "kPa", None, None, identifiable=False),
                figures.ParameterRow("contact_onset", 0.031, "mm", 0.024, 0.038),
                figures.ParameterRow("force_zero", -0.004, "N", -0.009, 0.001),
            ]
        ),
    }


def incomplete_figures() -> dict[str, object]:
    """Return figures of a run whose FEM stopped at 63 % and of one without a wave model."""
    step, force = triangle()
    fem, wave = deflections(force)
    cut = fem.copy()
    cut[32:] = np.nan
    return {
        "max_deformation_stopped": figures.max_deformation(LAYERS, step, cut, wave, relative(cut, wave)),
        "max_deformation_alone": figures.max_deformation(LAYERS, step, fem),
        "force_depth_stopped": figures.force_depth(cut[:32, 0], force[:32], planned_peak_N=5.0),
        "load_history_stopped": figures.load_history(step / 10, force, "force", cut[:, 0]),
    }


@pytest.fixture(scope="session")
def every_figure():
    """Return all figures by name."""
    return layer_figures() | single_figures() | incomplete_figures()


def comparison_blocks(every: dict[str, object], file: Download) -> list[object]:
    """Return figures and tables that compare both models."""
    step, force = triangle()
    fem, wave = deflections(force)
    rows = [
        [int(k), k / 10, f, name, fem[k - 1, i], wave[k - 1, i], relative(fem, wave)[k - 1, i]]
        for k, f in zip(step, force, strict=True)
        for i, name in enumerate(LAYERS)
    ]
    statistics = [
        ["epidermis", "t_pooled", "mean (mm)", 1.8231, 1.8312, None],
        ["epidermis", "t_pooled", "variance (mm²)", 0.00102, 0.0001009, None],
        ["epidermis", "t_pooled", "observations", 100, 100, None],
        ["epidermis", "t_pooled", "t", None, None, -0.0612],
        ["epidermis", "t_pooled", "t critical", None, None, 1.972017],
        ["epidermis", "tost", "p (margin 2 %)", None, None, 3.1e-7],
    ]
    units = [("time", "s"), ("force", "N"), ("layer", ""), ("FEM", "mm"), ("wave", "mm"), ("error", "%")]
    return [
        Notice("finding", "The wave model is linear; past 0.3 N it leaves the range it was derived for."),
        every["max_deformation"],
        every["profile"],
        Table("Deflection of each layer's top face", ["step", *(Column(*unit) for unit in units)], rows, file),
        Subsection(
            "Distribution",
            [
                every["normal_fit"],
                Table(
                    "Statistics", ["layer", "test", "quantity", "FEM", "wave", Column("value", digits=7)], statistics
                ),
                Notice("circular", "In the paper's protocol the FEM's maximum is fed to the wave model."),
            ],
        ),
        every["force_depth"],
        every["pressed_layers"],
    ]


def demo(every: dict[str, object]) -> Page:
    """Return a page with every block type and the given figures."""
    files = [
        Download("results.json", "All results, with their schema", '{"schema": 1}', "application/json"),
        Download("tables/max_deformation.csv", "Deflection of each layer's top face, step by step", "step,force_N\n"),
        Download("tables/timing.csv", "Wall and CPU seconds of every repeat"),
    ]
    further = ("_hole", "_space", "_conditions", "_stopped", "_alone")
    return Page(
        title="Skin pressed to 5 N",
        subtitle="Finite elements against the layered wave model, 5 mm disc on three layers of forearm skin",
        facts=[Fact("Scenario", "skin-5N"), Fact("Made", "14 March 2025, 09:26 UTC"), Fact("Machine", "2 cores")],
        verdict=Verdict(
            "finding",
            "The linear wave model is 25.9 % too soft at 5 N, because it lacks the stiffening of finite strain.",
            [
                "Below 0.3 N both agree within 1 % in every layer, without calibration.",
                "The FEM run is complete: 100 of 100 steps, mesh error of the maximum 0.06 %.",
                "Not equivalent at a margin of 2 % (TOST p = 0.41); the t-test does not see it (p = 0.13).",
            ],
        ),
        key_figures=[
            KeyFigure("Error at peak, epidermis", 25.86, "%", "wave against FEM, prediction"),
            KeyFigure("Maximum deformation", 2.9, "mm", "FEM, epidermis, at 5 N"),
            KeyFigure("Speed-up", 143.2, "×", "median of 5 interleaved repeats, 95 % interval 131 to 152"),
            KeyFigure("Unknowns", 48_302, "", "FEM; the wave model has 13 824"),
        ],
        notices=[
            Notice("synthetic", "The ten phantom trials are computed, not measured."),
            Notice("assumption", "The session does not say. Assumed:", ["tool radius 5 mm", "lower face bonded"]),
        ],
        sections=[
            Section(
                "Setting", [Paragraph("A disc presses three layers."), every["layer_stack"], every["load_history"]]
            ),
            Section("FEM against wave model", comparison_blocks(every, files[1])),
            Section(
                "Measured trials", [Bullets(["40 trials", "synthetic"]), every["measured"], every["fitted_parameters"]]
            ),
            Section(
                "Cost",
                [every["timing"], every["growth"], every["overlay"], KeyFigures([KeyFigure("Set-up, FEM", 0.9, "s")])],
            ),
            Section("Further figures", [figure for name, figure in every.items() if name.endswith(further)]),
            Section(
                "How it was made",
                [
                    Facts([Fact("Python", "3.11.2"), Fact("Seed", "0")]),
                    Notice("warning", "The repeats were timed on a shared machine."),
                    Listing('[load]\npeak = "5 N"\n', "The resolved scenario", folded=True),
                    Listing("python -m benchmark run skin-5N", "Command", folded=False),
                ],
            ),
        ],
        downloads=files,
        footer="tissuebench 0.1.0",
    )


@pytest.fixture(scope="session")
def demo_page(every_figure):
    """Return the page with everything on it."""
    return demo(every_figure)
