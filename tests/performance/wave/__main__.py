"""Print the speed of the waves and of what else a user would pick: `make bench-wave`."""

from __future__ import annotations

import os

for _name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_name] = "1"  # before NumPy is loaded

from tests.performance.wave.frames import WINDOW, rows  # noqa: E402
from tests.performance.wave.job import FORCE, RADIUS, REACH, reference  # noqa: E402
from tests.performance.wave.triangle import PEAKS, STEPS, triangle  # noqa: E402

SEVERAL_LAYERS = 3


def main() -> None:
    """Measure and print, Markdown."""
    load = ", ".join(f"{value:.1f}" for value in os.getloadavg())
    print(f"One thread, {os.cpu_count()} cores, load average {load} at the start.\n")
    print(
        f"Frames: {2e3 * REACH:g} mm square of vertices, tool radius {1e3 * RADIUS:g} mm, {FORCE:g} N, wave window "
        f"{1e3 * WINDOW:g} mm. Errors: largest at any vertex against the linear FEM, % of the layer's peak.\n"
    )
    print(
        "| vertices | way | median us | p99 us | CPU median us | CPU p99 us | frames "
        "| error epidermis / dermis / fat, % | set-up s |"
    )
    print("|---|---|---|---|---|---|---|---|---|")
    for row in rows(reference()):
        times = row.times
        error = " / ".join(f"{value:.2f}" for value in row.error)
        error += "" if len(row.error) == SEVERAL_LAYERS else " (one layer)"
        print(
            f"| {row.vertices} x {row.vertices} | {row.way} | {times.median:.1f} | {times.p99:.1f} "
            f"| {times.cpu_median:.1f} | {times.cpu_p99:.1f} | {times.frames} "
            f"| {error} | {row.setup:.2f} |",
            flush=True,
        )
    print(f"\nTriangle of {STEPS} steps, set-up apart, FEM on its default mesh.\n")
    print("| kinematics | peak N | FEM ms | wave ms | wave p99 ms | ratio | error % of peak | set-up FEM s, wave s |")
    print("|---|---|---|---|---|---|---|---|")
    for kinematics, peak in PEAKS.items():
        found = triangle(kinematics)
        print(
            f"| {kinematics} | {peak:g} | {1e3 * found.fem:.1f} | {1e3 * found.wave:.3f} | {1e3 * found.wave_p99:.3f} "
            f"| {found.ratio:.0f} | {found.error:.2f} | {found.fem_setup:.2f}, {found.wave_setup:.2f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
