"""A dry run to look at: lines of text for the terminal, and a plot as SVG."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bench_hw.motion.plan import ASSUMED_STIFFNESS, Plan

if TYPE_CHECKING:
    from pathlib import Path

_WIDTH, _HEIGHT = 64, 11


def summary(plan: Plan, trials: int = 1) -> list[str]:
    """Say each step and the sum of times, a line each."""
    lines = [f"{plan.name}: {plan.duration:.1f} s a trial, {trials} trial(s): {plan.duration * trials:.1f} s in all"]
    for step in plan.steps:
        speed = abs(step.depth_to - step.depth_from) / step.duration if step.duration else 0.0
        lines.append(
            f"  {step.start:8.1f} s  {step.kind:<9}{step.duration:8.1f} s  "
            f"{step.depth_from * 1e3:+7.2f} to {step.depth_to * 1e3:+7.2f} mm  {speed * 1e3:6.2f} mm/s"
            + ("  (assumed)" if step.assumed else "")
        )
    if plan.assumed:
        lines.append(f"  assumed: contact at depth 0, {ASSUMED_STIFFNESS / 1e3:g} N/mm; the specimen decides")
    return lines


def drawing(plan: Plan) -> list[str]:
    """Draw depth over time with characters, depth downwards."""
    depths = [_depth_at(plan, (column + 0.5) / _WIDTH * plan.duration) for column in range(_WIDTH)]
    low, high = min(depths), max(depths)
    span = (high - low) or 1e-3
    rows = [round((depth - low) / span * (_HEIGHT - 1)) for depth in depths]
    lines = []
    for row in range(_HEIGHT):
        label = f"{(low + span * row / (_HEIGHT - 1)) * 1e3:+7.2f} mm "
        lines.append(label + "|" + "".join("*" if at == row else " " for at in rows).rstrip())
    return [*lines, " " * 11 + "+" + "-" * _WIDTH, f"{'0':>12}{plan.duration:>{_WIDTH}.1f} s"]


def write_plot(plan: Plan, path: Path) -> Path:
    """Write depth over time as an SVG picture, whole or not at all.

    Raises
    ------
    OSError
        The folder cannot be made or written.
    """
    import io

    from matplotlib.figure import Figure

    from bench_hw.atomic import write_bytes

    figure = Figure(figsize=(8.0, 3.0), layout="constrained")
    axes = figure.add_subplot()
    times = [0.0] + [step.start + step.duration for step in plan.steps]
    depths = [plan.steps[0].depth_from] + [step.depth_to for step in plan.steps]
    axes.plot(times, [depth * 1e3 for depth in depths])
    axes.axhline(0.0, linewidth=0.5, color="0.5")
    axes.invert_yaxis()
    axes.set(xlabel="time, s", ylabel="depth, mm", title=f"{plan.name}: {plan.duration:.1f} s (dry run)")
    picture = io.BytesIO()
    figure.savefig(picture, format="svg", metadata={"Date": None})
    return write_bytes(path, picture.getvalue())


def _depth_at(plan: Plan, time: float) -> float:
    for step in plan.steps:
        if time <= step.start + step.duration and step.duration > 0.0:
            share = (time - step.start) / step.duration
            return step.depth_from + share * (step.depth_to - step.depth_from)
    return plan.steps[-1].depth_to
