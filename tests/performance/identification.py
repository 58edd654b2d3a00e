"""What a fit of five parameters to ten trials costs beside lmfit with differences and an optimisation as FEBio does it.

`python -m tests.performance.identification`. Three moduli and two thicknesses of skin, pressed by tools of 3 and 8 mm,
five trials each; synthetic, by our own finite elements, so that only cost is judged and not accuracy. All three press
with the same finite elements and count presses and processor time:

- ours: presses with their own derivatives, kept and interpolated; then other answers and profiles;
- lmfit (`pip install tissuebench[fit-bench]`), MINPACK with forward differences, one elastic press a tool each time;
- as FEBio's optimisation: Levenberg-Marquardt (SciPy's MINPACK) with forward differences of 0.1 %, whole runs of the
  protocol, loading and unloading, a tool and evaluation.

The two others end after `--evaluations` evaluations of both tools at most, so that the run has an end: a row that says
so has its time for these, and how far its misfit was from what our fit leaves; a whole search takes longer.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares

from benchmark.files import load_session
from benchmark.files.sessions.fit_table import FitTable
from benchmark.identification.parameters.free_parameters import with_values
from benchmark.identification.parameters.identifiability import directions
from benchmark.identification.parameters.identified import identify
from benchmark.identification.parameters.layer_fit import begun, fit_layers
from benchmark.identification.parameters.other_answers import other_answers
from benchmark.identification.parameters.presses import press_surrogate
from benchmark.identification.parameters.session_problem import FittedBase, assembled
from benchmark.models import Drive, prepare
from benchmark.response.differentiated_ramp import differentiated_ramp
from benchmark.response.ramp import setup_scenario
from benchmark.runs.fitted_session import fit_trials

TRUTH = {
    "epidermis.youngs_modulus": 1.1e6,
    "dermis.youngs_modulus": 0.3e6,
    "subcutaneous_fat.youngs_modulus": 40e3,
    "dermis.thickness": 1.6e-3,
    "subcutaneous_fat.thickness": 9.3e-3,
}
RADII, DEPTHS, TRIALS, ROWS = (3e-3, 8e-3), (1.5e-3, 2.5e-3), 5, 200
STEPS, WHOLE, TOLERANCE = 12, 40, 1e-4
GAIN, NOISE = 0.005, 0.005
EVALUATIONS = 40
"""Of lmfit and the other search, at most: seven derivatives by differences and their steps."""


class SpentError(Exception):
    """The evaluations that a search may take are taken."""


class Quiet:
    """Nobody is told."""

    def say(self, text: str) -> None:
        """Nothing."""

    def progress(self, title: str):
        """Nothing."""
        return contextlib.nullcontext(lambda *done: None)


def written(folder: Path, seed: int) -> Path:
    """A session of ten presses: rest, down, back, rest."""
    generator, lines = (
        np.random.default_rng(seed),
        ["schema = 1", 'name = "bench"', 'specimen = "skin_forearm"', "synthetic = true"],
    )
    lines += ["[tool]", 'radius = "3 mm"', 'contact = "rigid_bonded"', "[support]", 'kind = "bonded"']
    for k, radius in enumerate(RADII):
        lines += [f"[conditions.tool{k}.tool]", f'radius = "{1e3 * radius:g} mm"']
    for k, (radius, deep) in enumerate(zip(RADII, DEPTHS, strict=True)):
        session = _told(folder)
        setup = with_values(
            (session.specimen, session.trials[0].tool.model_copy(update={"radius": radius}), session.trials[0].support),
            TRUTH,
        )
        ramp = differentiated_ramp(session, *setup, 1.02 * deep, (), "fem", 24)
        for n in range(TRIALS):
            stamp = np.linspace(0.0, 12.0, ROWS)
            depth = np.interp(stamp, [0, 1, 6, 11, 12], [-1e-4, 0.0, deep, 0.0, -1e-4])
            force = np.interp(np.maximum(depth, 0.0), ramp.depth, ramp.force) * np.exp(GAIN * generator.normal())
            force += NOISE * force.max() * generator.normal(size=force.size)
            table = np.column_stack([stamp, 1e3 * depth, force])
            np.savetxt(folder / f"t{k}{n}.csv", table, delimiter=",", header="time_s,depth_mm,force_N", comments="")
            lines += ["[[trials]]", f'file = "t{k}{n}.csv"', f'condition = "tool{k}"']
    (folder / "session.toml").write_text("\n".join(lines) + "\n")
    return folder


def _told(folder: Path):
    """A session of one trial, for its set-up."""
    with tempfile.TemporaryDirectory(dir=folder.parent) as name:
        one = Path(name)
        rows = "\n".join(f"{0.1 * k},{0.01 * k},{0.001 * k}" for k in range(30))
        (one / "a.csv").write_text(f"time_s,depth_mm,force_N\n{rows}\n")
        (one / "session.toml").write_text(
            'schema = 1\nname = "told"\nspecimen = "skin_forearm"\n[tool]\nradius = "3 mm"\ncontact = "rigid_bonded"\n'
            '[support]\nkind = "bonded"\n[[trials]]\nfile = "a.csv"\ncondition = "a"\n'
        )
        return load_session(one)


class Presses:
    """Both presses of the specimen at logarithms of the five values, counted."""

    def __init__(self, problem, whole: bool, most: int):
        self._problem, self._whole, self._left, self.count = problem, whole, most, 0
        self.best, self.at = np.inf, np.full(len(TRUTH), np.nan)

    def residuals(self, logarithms) -> np.ndarray:
        """(N,) of all trials, in standard deviations of their noise; raises SpentError."""
        if self._left == 0:
            raise SpentError
        self._left -= 1
        found = self._residuals(logarithms)
        if found @ found < self.best:
            self.best, self.at = float(found @ found), np.array(logarithms, dtype=np.float64)
        return found

    def row(self, name: str, seconds: float, ended: bool) -> str:
        """A line of the table, at the best point."""
        said = "" if ended else "; stopped before its end"
        return f"{row(name, seconds, self.count, np.exp(self.at))}   misfit {self.best:.0f}{said}"

    def _residuals(self, logarithms) -> np.ndarray:
        values = dict(zip(TRUTH, np.exp(np.asarray(logarithms)), strict=True))
        curves = [self._curve(press, with_values(press.setup, values)) for press in self._problem.presses]
        out = []
        for trial in self._problem.trials:
            force = np.where(trial.data.depth > 0.0, curves[trial.press](np.maximum(trial.data.depth, 0.0)), 0.0)
            out.append((trial.data.force - force) / (NOISE * np.ptp(trial.data.force)))
        return np.concatenate(out)

    def _curve(self, press, setup) -> Callable[[np.ndarray], np.ndarray]:
        self.count += 1
        if not self._whole:
            ramp = differentiated_ramp(press.session, *setup, press.depth, (), "fem", STEPS)
            return CubicSpline(ramp.depth, ramp.force)
        share = np.arange(1, WHOLE + 1) / WHOLE
        way = press.depth * np.minimum(2.0 * share, 2.0 - 2.0 * share)
        model = prepare("fem", setup_scenario(press.session, setup))
        run = model.run(Drive("depth", share, way))
        return CubicSpline(np.append(0.0, way[: WHOLE // 2]), np.append(0.0, run.force[: WHOLE // 2]))


def ours(session: Path) -> tuple[object, list[str]]:
    """Our fit, and rows of what it cost."""
    calls = [0]
    pressed = press_surrogate.differentiated_ramp

    def counted(*args, **more):
        calls[0] += 1
        return pressed(*args, **more)

    found = fit_trials(session, None, {}, Quiet())
    press_surrogate.differentiated_ramp = counted
    began = time.process_time()
    base = FittedBase(found.session, found.fit, found.trials, found.followed)
    made = assembled([base], FitTable(free=tuple(TRUTH), exact=("all",)))
    start = begun(made.problem, made.touches, made.zeros)
    fit = fit_layers(start)
    alone = time.process_time() - began, calls[0]
    best, others = other_answers(fit, Quiet().say)
    answer = identify(best, others, directions(start), [one.data.condition for one in made.problem.trials], ["bench"])
    whole = time.process_time() - began, calls[0]
    press_surrogate.differentiated_ramp = pressed
    values = [fit.value(k) for k in fit.problem.free]
    said = [row("ours, the fit", *alone, values), row("ours, with other answers and profiles", *whole, values)]
    found_at = np.log(values)
    said[0] += f"   misfit {np.sum(np.square(Presses(made.problem, False, 1).residuals(found_at))):.0f}"
    return made.problem, [*said, *(f"    {one.text}" for one in answer.estimates)]


def row(name: str, seconds: float, presses: int, values) -> str:
    """A line of the table: values over those put in."""
    shares = ", ".join(f"{value / told:.2f}" for value, told in zip(values, TRUTH.values(), strict=True))
    return f"{name:40} {seconds:7.1f} s CPU {presses:5d} presses   found over put in: {shares}"


def by_lmfit(problem, start: np.ndarray, most: int) -> str:
    """lmfit's least squares with MINPACK's forward differences."""
    try:
        import lmfit
    except ImportError:
        return "lmfit is not installed and left out (pip install tissuebench[fit-bench])"
    presses, began = Presses(problem, False, most), time.process_time()
    names = [key.replace(".", "_") for key in TRUTH]
    parameters = lmfit.Parameters()
    for name, value in zip(names, start, strict=True):
        parameters.add(name, value=value, min=value - 3.0, max=value + 3.0)
    options, ended = {"ftol": TOLERANCE, "xtol": TOLERANCE, "epsfcn": 1e-6}, False
    with contextlib.suppress(SpentError):
        lmfit.minimize(
            lambda p: presses.residuals([p[name].value for name in names]), parameters, method="leastsq", **options
        )
        ended = True
    return presses.row("lmfit, differences", time.process_time() - began, ended)


def as_febio(problem, start: np.ndarray, most: int) -> str:
    """Levenberg-Marquardt with forward differences of whole runs."""
    presses, began = Presses(problem, True, most), time.process_time()
    ended = False
    with contextlib.suppress(SpentError):
        least_squares(presses.residuals, start, method="lm", diff_step=1e-3, ftol=TOLERANCE, xtol=TOLERANCE)
        ended = True
    return presses.row("as FEBio, differences of whole runs", time.process_time() - began, ended)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--evaluations", type=int, default=EVALUATIONS)
    asked = parser.parse_args()
    seed, most = asked.seed, asked.evaluations
    print(
        f"five parameters, {len(RADII) * TRIALS} trials, one thread wanted; load {os.getloadavg()[0]:.1f}, seed {seed}"
    )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "session"
        folder.mkdir()
        problem, said = ours(written(folder, seed))
        print("\n".join(said), flush=True)
        start = np.log([one.start for one in problem.parameters if not one.told])
        print(by_lmfit(problem, start, most), flush=True)
        print(as_febio(problem, start, most), flush=True)


if __name__ == "__main__":
    main()
