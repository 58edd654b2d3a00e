"""A recorded attempt: each tool's motion and force and the targets shown, from one CSV file, and its measures.

Columns `time_s, tool, x_mm, y_mm, depth_mm, force_N`, a row for each tool and instant; of a task also `target`,
`target_x_mm, target_y_mm, target_depth_mm` and, where a force was asked for, `target_force_N`. A target is known by its
name, a number or text; rows before the first and after the last that names one are no part of the task.

Each measure of motion names its source: arrays in, one number out, SI units. Mean jerk is not among them: it does not
part levels of skill (F. Aghazadeh, B. Zheng, M. Tavakoli and H. Rouhani 2023, Sensors 23:3146), which the log
dimensionless jerk and the 95 % motion frequency do.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline
from scipy.signal import butter, sosfiltfilt

from bench_hw.storage.regular_file import TABLE, open_regular
from benchmark.errors import InputError
from reports.formatting import counted

Array = NDArray[np.float64]
NEEDED = ("time_s", "tool", "x_mm", "y_mm", "depth_mm", "force_N")
TARGET = ("target", "target_x_mm", "target_y_mm", "target_depth_mm")
FEWEST_ROWS = 20
SHORTEST, LONGEST = 0.5, 86_400.0
"""s of a record: the filters below need half a second, and a day is no attempt."""
LARGEST = 1e9
"""Of any number in a record."""
RATE = 100.0
"""Hz to which an attempt is brought: place, depth and force linear between its rows, which adds no depth and no way."""
DEGREE, MIRRORED, CLOSEST = 7, 12, 2.5e-3
"""Of the spline through the rows from which what a spectrum tells is taken, with so many rows mirrored at each end so
that it does not swing there. Rows closer than so many s are one: at 100 Hz they tell no more, and a spline swings."""
HIGHEST, ROWS = 12.0, 2.4
"""Hz up to which the rows must carry motion, and rows a period: of rows at 30 Hz the spline keeps 96 % of an amplitude
at 12 Hz and 99.7 % at 9.5 Hz, where straight lines keep 57 % and 71 %."""
MOSTLY, HOLE = 0.95, 0.1
"""Share of the time in which rows lie that close, and s without a row from which on no one knows what moved."""
SMOOTHED = 10.0
"""Hz below which speed is taken for jerk and arc length (fourth-order Butterworth, both ways): hands stay below it."""
SHAKING = (4.0, 20.0)
"""Hz, round the band of tremor: what is left of an attempt before tremor is read off (the same filter)."""
NEAR = 3e-3
"""m from a target within which a press counts as one of it."""
CUTOFF, THRESHOLD, PADDING = 10.0, 0.05, 4
"""Of the spectral arc length, as its authors have them: Hz, share of the largest amplitude, doublings of padding."""
SPECTRAL = ("log_dimensionless_jerk", "spectral_arc_length", "motion_frequency_hz", "tremor_um")
"""Measures that depend on what lies between the rows."""
TREMOR_BAND = (8.0, 12.0)
"""Hz: physiological tremor of the hand (R. J. Elble and W. C. Koller 1990, Tremor)."""


def path_length(position: Array) -> float:
    """Sum of the distances between positions (n, 3), m.

    S. Cotin, N. Stylopoulos, M. Ottensmeyer et al. 2002, MICCAI, LNCS 2488:35.
    """
    return float(np.linalg.norm(np.diff(position, axis=0), axis=1).sum())


def economy_of_motion(position: Array, waypoints: Array) -> float:
    """Straight way from the first position (n, 3) through waypoints (k, 3), over the path length.

    At most 1 for a path that goes through all of them in their order; of any other it says nothing.

    A. G. Gallagher and R. M. Satava 2002, Surg Endosc 16:1746 ("economy of movement"). NaN where nothing moved.
    """
    taken = path_length(position)
    return path_length(np.vstack([position[:1], waypoints])) / taken if taken > 0.0 else float("nan")


def speed_of(position: Array, rate: float) -> Array:
    """(n - 1,) speed between positions (n, 3) taken at an even rate (Hz), m/s."""
    return np.asarray(np.linalg.norm(np.diff(position, axis=0), axis=1) * rate)


def log_dimensionless_jerk(speed: Array, rate: float) -> float:
    """-ln(T^3 / v_max^2 integral of (d2v/dt2)^2 dt) of a speed profile (n,), m/s; nearer to nought is smoother.

    S. Balasubramanian, A. Melendez-Calderon, A. Roby-Brami and E. Burdet 2015, J NeuroEng Rehabil 12:112, eq. (5), with
    the differences of their own program. NaN where nothing moved.
    """
    peak, duration = float(np.max(np.abs(speed))), speed.size / rate
    jerk = np.diff(speed, 2) * rate**2
    whole = duration**3 * float(jerk @ jerk) / rate
    return float(-np.log(whole / peak**2)) if peak > 0.0 and whole > 0.0 else float("nan")


def spectral_arc_length(speed: Array, rate: float) -> float:
    """Less the length of the normalised amplitude spectrum of a speed profile (n,); nearer to nought is smoother.

    S. Balasubramanian et al. 2015 (see `log_dimensionless_jerk`), eqs. (1) and (2): up to the last frequency within
    10 Hz whose amplitude is 5 % of the largest or more. NaN where nothing moved.
    """
    size = 2 ** (int(np.ceil(np.log2(speed.size))) + PADDING)
    frequency, amplitude = np.arange(size) * rate / size, np.abs(np.fft.fft(speed, size))
    if not amplitude.max() > 0.0:
        return float("nan")
    inside = frequency <= CUTOFF
    frequency, amplitude = frequency[inside], amplitude[inside] / amplitude.max()
    strong = np.flatnonzero(amplitude >= THRESHOLD)
    kept = slice(strong[0], strong[-1] + 1)
    across, along = np.diff(frequency[kept]), np.diff(amplitude[kept])
    return float(-np.hypot(across / across.sum(), along).sum()) if across.size else float("nan")


def motion_frequency(position: Array, rate: float, share: float = 0.95) -> float:
    """Frequency below which a share of the power of the velocity lies, Hz; lower is smoother.

    Aghazadeh et al. 2023 (see above), who propose it for being less hurt by noise than jerk. Here it is the
    spectral edge of the periodogram of the three velocities of positions (n, 3), their means left out, summed. NaN
    where nothing moved.
    """
    velocity = np.diff(position, axis=0) * rate
    power = (np.abs(np.fft.rfft(velocity - velocity.mean(axis=0), axis=0)) ** 2).sum(axis=1)
    whole = np.cumsum(power)
    if not whole[-1] > 0.0:
        return float("nan")
    return float(np.searchsorted(whole, share * whole[-1]) * rate / velocity.shape[0])


def tremor(position: Array, rate: float, band: tuple[float, float] = TREMOR_BAND) -> float:
    """Root mean square of the motion within a band of frequencies (Hz) of positions (n, 3), m.

    Physiological tremor has its peak there (R. J. Elble and W. C. Koller 1990, Tremor). A record that does not end
    where it began leaks into every band: take slow motion out of it first.
    """
    count = position.shape[0]
    amplitude = np.abs(np.fft.rfft(position - position.mean(axis=0), axis=0)) ** 2
    frequency = np.fft.rfftfreq(count, 1.0 / rate)
    inside = (frequency >= band[0]) & (frequency <= band[1])
    twice = np.where((frequency > 0.0) & (frequency < 0.5 * rate), 2.0, 1.0)
    return float(np.sqrt((twice[inside, None] * amplitude[inside]).sum()) / count)


def bimanual_correlation(first: Array, second: Array) -> float:
    """Pearson's correlation of the speeds (n,) of two tools: how far both hands work at once.

    E. F. Hofstad, C. Våpenstad, M. K. Chmarra et al. 2013, Surg Endosc 27:854 ("bimanual dexterity"). NaN where one
    rests.
    """
    one, other = first - first.mean(), second - second.mean()
    scale = float(np.sqrt((one @ one) * (other @ other)))
    return float(one @ other) / scale if scale > 0.0 else float("nan")


def root_mean_square(errors: Array) -> float:
    """Of errors (k,): accuracy of depth or of force at the targets; NaN without any."""
    return float(np.sqrt(np.mean(errors**2))) if errors.size else float("nan")


@dataclass(frozen=True, eq=False)
class Attempt:
    """One attempt.

    Attributes
    ----------
    name, group
        Its file, and the folder that it came from where groups are compared.
    time
        (n,) s, even.
    position
        By tool: (n, 3) x, y and depth in m.
    force
        By tool: (n,) N.
    target
        (k, 3) x, y and depth of the targets in order, m; of none (0, 3).
    target_force
        (k,) N; NaN where none was asked for.
    motion
        By tool: `position` by a spline; without a tool whose rows are too far apart for one. None: `position`.
    notes
        What was found in reading it.
    """

    name: str
    group: str
    time: Array
    position: Mapping[int, Array]
    force: Mapping[int, Array]
    target: Array = field(default_factory=lambda: np.empty((0, 3)))
    target_force: Array = field(default_factory=lambda: np.empty(0))
    motion: Mapping[int, Array] | None = None
    notes: tuple[str, ...] = ()

    @property
    def warnings(self) -> tuple[str, ...]:
        """What its measures leave out, or are not to be compared for."""
        missed = int(np.count_nonzero(~self.reached))
        if missed:
            left = f"{missed} of {counted(len(self.target), 'target')} not pressed: time and path are of a shorter task"
            return (*self.notes, left)
        if len(self.position) == 1 and not self._in_order:
            return (*self.notes, "targets pressed in another order than shown: no economy of motion")
        return self.notes

    @cached_property
    def reached(self) -> NDArray[np.bool_]:
        """(k,) whether a tool came to each target, whenever."""
        return np.array([any(at.any() for at in each.values()) for each in self._visits], dtype=bool)

    @cached_property
    def _visits(self) -> list[dict[int, NDArray[np.bool_]]]:
        """For each target, by tool: (n,) whether it presses within `NEAR`; of a target in the air, is as near to it."""
        return [{tool: _visited(position, one) for tool, position in self.position.items()} for one in self.target]

    @cached_property
    def _in_order(self) -> bool:
        """Whether the first tool came to all targets one after the other, as they were shown."""
        at = 0
        for each in self._visits:
            later = np.flatnonzero(next(iter(each.values()))[at:])
            if not later.size:
                return False
            at += int(later[0])
        return True

    def measures(self) -> dict[str, float]:
        """Every measure by its column's name; those of several tools are their mean, path lengths their sum."""
        each = [self._of_tool(tool) for tool in self.position]
        means = {name: float(np.mean([one[name] for one in each])) for name in each[0]}
        means["path_length_mm"] *= len(each)
        depth, force = self._accuracy()
        return {
            "time_s": float(self.time[-1] - self.time[0]),
            **means,
            "targets_reached": float(np.mean(self.reached)) if self.target.size else float("nan"),
            "depth_error_mm": 1e3 * root_mean_square(depth),
            "force_error_N": root_mean_square(force),
            "bimanual_correlation": self._together(),
        }

    def _of_tool(self, tool: int) -> dict[str, float]:
        position = self.position[tool]
        alone = len(self.position) == 1 and self.target.size and self._in_order
        return {
            "path_length_mm": 1e3 * path_length(position),
            "economy_of_motion": economy_of_motion(position, self.target) if alone else float("nan"),
            **_smoothness(self.position.get(tool) if self.motion is None else self.motion.get(tool)),
        }

    def _accuracy(self) -> tuple[Array, Array]:
        """Deepest press within `NEAR` of each target less its depth (m), and largest force less its force (N)."""
        depth, force = [], []
        for target, wanted, each in zip(self.target, self.target_force, self._visits, strict=True):
            pressed = [
                (float(self.position[tool][at, 2].max()), float(self.force[tool][at].max()))
                for tool, at in each.items()
                if at.any()
            ]
            if pressed:
                deepest, strongest = max(pressed)
                depth.append(deepest - float(target[2]))
                force.append(strongest - float(wanted))
        forces = np.array(force)
        return np.array(depth), forces[np.isfinite(forces)]

    def _together(self) -> float:
        """Correlation of two tools' speeds; NaN with another number of tools."""
        if len(self.position) != 2:
            return float("nan")
        moved = {**self.position, **(self.motion or {})}
        first, second = (_smooth(speed_of(position, RATE)) for position in moved.values())
        return bimanual_correlation(first, second)


def _smooth(speed: Array) -> Array:
    return np.asarray(sosfiltfilt(butter(4, SMOOTHED, fs=RATE, output="sos"), speed))


def _shaking(position: Array) -> Array:
    sections = butter(4, SHAKING, btype="bandpass", fs=RATE, output="sos")
    return np.asarray(sosfiltfilt(sections, position, axis=0))


def _smoothness(motion: Array | None) -> dict[str, float]:
    """What a spectrum tells of positions (n, 3) at `RATE`; NaN of none."""
    if motion is None:
        return dict.fromkeys(SPECTRAL, float("nan"))
    speed = _smooth(speed_of(motion, RATE))
    found = (
        log_dimensionless_jerk(speed, RATE),
        spectral_arc_length(speed, RATE),
        motion_frequency(motion, RATE),
        1e6 * tremor(_shaking(motion), RATE),
    )
    return dict(zip(SPECTRAL, found, strict=True))


def _visited(position: Array, target: Array) -> NDArray[np.bool_]:
    """(n,) whether positions (n, 3) are at a target (3,); see `Attempt`."""
    beside, depth = np.linalg.norm(position[:, :2] - target[:2], axis=1) <= NEAR, position[:, 2]
    return np.asarray(beside & (depth > 0.0 if target[2] > 0.0 else np.abs(depth - target[2]) <= NEAR))


def read_attempt(path: Path, group: str = "") -> Attempt:
    """Read a record.

    Raises
    ------
    InputError
        File, column or row, and what is allowed.
    """
    table, notes = _of_task(_table(path))
    tools = {tool: table[table["tool"] == tool] for tool in sorted(set(table["tool"].astype(int)))}
    for tool, rows in tools.items():
        _check_tool(path, tool, rows, " while targets are shown" * bool(notes))
    start, end = float(table["time_s"].min()), float(table["time_s"].max())
    if not SHORTEST <= end - start <= LONGEST:
        raise InputError(f"{path}: time_s spans {end - start:.6g} s; allowed are {SHORTEST:g} s to {LONGEST:,.0f} s")
    time = start + np.arange(int((end - start) * RATE + 1e-9) + 1) / RATE
    position, force, motion = {}, {}, {}
    for tool, rows in tools.items():
        at, place = rows["time_s"].to_numpy(), 1e-3 * rows[["x_mm", "y_mm", "depth_mm"]].to_numpy()
        position[tool] = np.column_stack([np.interp(time, at, along) for along in place.T])
        force[tool] = np.interp(time, at, rows["force_N"].to_numpy())
        apart = _apart(at, start, end)
        if apart:
            notes += (f"tool {tool}: rows are {apart} apart: no jerk, arc length, motion frequency and tremor",)
        else:
            motion[tool] = _between(at, place, time)
    target, wanted = _targets(table)
    return Attempt(path.stem, group, time, position, force, target, wanted, motion, notes)


def _apart(at: Array, start: float, end: float) -> str:
    """How far apart rows at times (n,) are, where that is too far for `HIGHEST` from start to end (s); else nothing."""
    gaps = np.sort(np.diff(at, prepend=start, append=end))
    widest = float(gaps[-1])
    if widest > HOLE * (1.0 + 1e-9):
        return f"up to {widest:.3g} s"
    mostly = float(gaps[np.searchsorted(np.cumsum(gaps), MOSTLY * (end - start))])
    return f"{1e3 * mostly:.3g} ms" if mostly * ROWS * HIGHEST > 1.0 else ""


def _between(at: Array, place: Array, time: Array) -> Array:
    """(m, 3) at times (m,), by a spline through rows at times (n,) and places (n, 3)."""
    if np.diff(at).min() < CLOSEST:
        kept = [0]
        while (ahead := int(np.searchsorted(at, at[kept[-1]] + CLOSEST))) < at.size:
            kept.append(ahead)
        at, place = at[kept], place[kept]
    count = min(MIRRORED, at.size - 1)
    mirrored = np.vstack([_mirrored(at[:, None], count).T, _mirrored(place, count).T])
    return np.asarray(make_interp_spline(mirrored[0], mirrored[1:].T, DEGREE)(np.clip(time, at[0], at[-1])))


def _mirrored(rows: Array, count: int) -> Array:
    """Rows (n, d) with so many turned about the first before it, and about the last after it."""
    return np.vstack([2.0 * rows[0] - rows[count:0:-1], rows, 2.0 * rows[-1] - rows[-2 : -count - 2 : -1]])


def _table(path: Path) -> pd.DataFrame:
    """The file's rows, its needed columns finite numbers, those of a target that is named too."""
    try:
        with open_regular(path, TABLE) as stream:
            table = pd.read_csv(stream, dtype={"target": str})
    except (OSError, ValueError) as error:
        raise InputError(f"{path} cannot be read as a record: {' '.join(str(error).split())}") from None
    missing = [name for name in NEEDED if name not in table]
    if missing:
        raise InputError(f"{path}: the column {missing[0]} is missing; a record has {', '.join(NEEDED)}")
    if table.empty:
        raise InputError(f"{path} has no row; at least {FEWEST_ROWS} are needed for each tool")
    for name in NEEDED:
        table[name] = values = pd.to_numeric(table[name], errors="coerce").astype(np.float64)
        wrong = np.flatnonzero(~(values.abs().to_numpy() <= LARGEST))
        if wrong.size:
            raise InputError(f"{path}: {name} in row {wrong[0] + 2} is no number up to {LARGEST:g}")
    odd = np.flatnonzero(table["tool"] % 1.0)
    if odd.size:
        raise InputError(f"{path}: tool in row {odd[0] + 2} is no whole number")
    _check_targets(path, table)
    return table


def _check_targets(path: Path, table: pd.DataFrame) -> None:
    """Names of targets as text, nothing where none is shown; their places and forces as numbers."""
    missing = [name for name in TARGET if name not in table]
    if len(missing) == len(TARGET):
        return
    if missing:
        raise InputError(f"{path}: the column {missing[0]} is missing; a record of a task has {', '.join(TARGET)}")
    name = table["target"].str.strip()
    table["target"] = name = name.where(name != "")
    for column in (*TARGET[1:], "target_force_N"):
        if column not in table:
            continue
        needed = name.notna() & (table[column].notna() | (column in TARGET))
        table[column] = values = pd.to_numeric(table[column], errors="coerce").astype(np.float64)
        wrong = np.flatnonzero(needed & ~(values.abs() <= LARGEST))
        if wrong.size:
            raise InputError(
                f"{path}: {column} in row {wrong[0] + 2} is no number up to {LARGEST:g}, and target "
                f"{name.iloc[wrong[0]]!r} is shown"
            )


def _of_task(table: pd.DataFrame) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Rows from the first to the last that shows a target, and what was left out; of a record without targets all."""
    time = table["time_s"]
    shown = time[table["target"].notna()] if "target" in table else time[:0]
    if shown.empty:
        return table, ()
    kept = table[time.between(shown.min(), shown.max())]
    sides = (
        ("before the first", int((time < shown.min()).sum()), shown.min() - time.min()),
        ("after the last", int((time > shown.max()).sum()), time.max() - shown.max()),
    )
    left = [f"{counted(rows, 'row')} ({long:.3g} s) {side} target left out" for side, rows, long in sides if rows]
    return kept, tuple(left)


def _check_tool(path: Path, tool: int, rows: pd.DataFrame, when: str) -> None:
    if len(rows) < FEWEST_ROWS:
        raise InputError(
            f"{path}: tool {tool} has {counted(len(rows), 'row')}{when}; at least {FEWEST_ROWS} are needed"
        )
    back = np.flatnonzero(np.diff(rows["time_s"].to_numpy()) <= 0.0)
    if back.size:
        raise InputError(f"{path}: time_s of tool {tool} does not rise at its row {back[0] + 2}")


def _targets(table: pd.DataFrame) -> tuple[Array, Array]:
    """(k, 3) targets in the order in which they were shown, m, and (k,) their forces."""
    if "target" not in table:
        return np.empty((0, 3)), np.empty(0)
    shown = table.dropna(subset=["target"]).drop_duplicates("target")
    place = 1e-3 * shown[list(TARGET[1:])].to_numpy(dtype=np.float64)
    if "target_force_N" not in shown:
        return place, np.full(len(shown), np.nan)
    return place, shown["target_force_N"].to_numpy(dtype=np.float64)
