"""The specimens of a session: how high each is, and the one that is assumed where nobody says what was pressed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from bench_hw.tables import TrialTable
from benchmark.files.sessions.description import SessionFile
from benchmark.files.sessions.recordings import Recording
from benchmark.files.tissue import Layer, Tissue

SPECIMEN_THICKNESS: Final = "specimen.thickness"
ASSUMED_THICKNESS: Final = 10e-3
ASSUMED_YOUNGS_MODULUS: Final = 20e3
ASSUMED_POISSON_RATIO: Final = 0.49
ASSUMED_DENSITY: Final = 1000.0

SAME_HEIGHT = 1.02
"""Ratio of heights up to which trials count as made on one height: gap and touch tell it no better, and each takes a
press of the finite elements."""
ONE_HEIGHT = 1.1
"""Ratio of heights up to which they may be of one specimen: what a lab calls equal specimens."""


def told_heights(file: SessionFile, trials: Sequence[Recording]) -> tuple[list[float], str]:
    """Heights of specimens (m) that the session tells of, or else the files' headers, and where they stand."""
    if file.import_.height is not None:
        return [file.import_.height], "import.height"
    listed = [each.entry.height for each in trials if each.entry.height is not None]
    if listed:
        return listed, "median height of the trials"
    heights = [each.header.height for each in trials if each.header.height is not None]
    return heights, "median height in the files' headers"


def heights_under(
    file: SessionFile, trials: Sequence[Recording], tissue: Tissue, keys: Iterable[str] = (), *, assumed: bool
) -> tuple[list[float | None], list[str]]:
    """How high the specimen under each trial is where specimens differ, m, and what must be said of it.

    A trial's own `height` counts; else its file's header, and of an assumed specimen the gap at zero depth. Several
    layers are stretched alike only where the session says so itself. Heights within `SAME_HEIGHT` count as one.

    Parameters
    ----------
    file, trials
        The session and its recordings.
    tissue
        The session's specimen.
    keys : iterable of str
        What the command line sets of it: a thickness is then that under all trials.
    assumed : bool
        Whether nobody said what it is.

    Returns
    -------
    (list, list)
        Heights, None where a trial's is the session's; sentences.
    """
    if math.isinf(tissue.thickness) or file.support.get("kind") == "half_space":
        return [None] * len(trials), []
    own = [each.entry.height for each in trials]
    others: list[float | None] = [None] * len(trials)
    of_all = file.import_.height is not None or any(key.endswith(".thickness") for key in keys)
    if not of_all and len(tissue.layers) == 1:
        others = [each.header.height for each in trials]
        if assumed and not any(others) and not any(own):
            others = [_usable_gap(each.table) for each in trials]
    found = [mine or other for mine, other in zip(own, others, strict=True)]
    known = [each for each in found if each is not None]
    if not any(own) and (not known or max(known) <= SAME_HEIGHT * min(known)):
        return [None] * len(trials), other_heights(file, trials, tissue.thickness)
    classes = _classes(known)
    heights = [None if each is None else classes[each] for each in found]
    return heights, [_said(heights, tissue.thickness)]


def _classes(heights: Sequence[float]) -> dict[float, float]:
    """Each height with the middle of those that count as the same."""
    groups: list[list[float]] = []
    for height in sorted(heights):
        if groups and height <= SAME_HEIGHT * groups[-1][0]:
            groups[-1].append(height)
        else:
            groups.append([height])
    return {height: float(np.median(group)) for group in groups for height in group}


def _said(heights: Sequence[float | None], thickness: float) -> str:
    known = sorted({each for each in heights if each is not None})
    listed = ", ".join(f"{1e3 * each:.4g}" for each in known)
    span = listed if len(known) <= 5 else f"{1e3 * known[0]:.4g} to {1e3 * known[-1]:.4g}"
    rest = heights.count(None)
    others = f"; {rest} without a height of their own count with {1e3 * thickness:.4g} mm" if rest else ""
    return f"specimens of {span} mm height: each trial counts with its own{others}"


def other_heights(file: SessionFile, trials: Sequence[Recording], thickness: float) -> list[str]:
    """A warning where files' headers tell of specimens that are other than the session's one is thick, m.

    None of a half-space, nor where the session tells the height.
    """
    if file.support.get("kind") == "half_space" or file.import_.height is not None:
        return []
    told = [(height, Path(each.table.source).name) for each in trials if (height := each.header.height) is not None]
    by_height: dict[float, list[str]] = {}
    for height, name in sorted(told):
        by_height.setdefault(height, []).append(name)
    if all(1.0 / ONE_HEIGHT <= each / thickness <= ONE_HEIGHT for each in by_height):
        return []
    more = {height: f" and {len(names) - 1} more" if len(names) > 1 else "" for height, names in by_height.items()}
    groups = [f"{1e3 * height:.4g} mm ({names[0]}{more[height]})" for height, names in by_height.items()]
    cure = (
        'stiffness goes with the height: give each trial its own, height = "..." in [[trials]], which stretches the '
        "layers alike, or fit sessions of one height each together by fit FOLDER FOLDER --free KEY"
        if len(by_height) > 1
        else "state the layers' thickness as it is, or leave the specimen out for that of the headers"
    )
    said = f"the files' headers tell heights of {', '.join(groups)}, the specimen is {1e3 * thickness:.4g} mm thick"
    return [f"{said}: {cure}"]


def assumed_specimen(tables: Sequence[TrialTable], told: Sequence[float] = (), told_by: str = "") -> tuple[Tissue, str]:
    """One layer of soft tissue as thick as the gap between tool and base at zero depth.

    Parameters
    ----------
    tables : sequence of TrialTable
        The session's trials; those with a `gap` column give the thickness, its median over trials.
    told : sequence of float
        Heights (m) that the session or the files' headers tell of; they count before the gaps.
    told_by : str
        Where they stand.

    Returns
    -------
    (Tissue, str)
        The layer, and the warning that says what was assumed. The modulus is a start value for the fit (soft
        tissue lies at 1 to 100 kPa); the Poisson ratio is that of a nearly incompressible tissue.
    """
    measured = (gap for gap in map(gap_at_zero_depth, tables) if gap is not None)
    gaps = [gap for gap in (told or measured) if _usable(gap)]
    thickness = float(f"{np.median(gaps):.9g}") if gaps else ASSUMED_THICKNESS
    layer = Layer(
        name="specimen",
        thickness=thickness,
        density=ASSUMED_DENSITY,
        youngs_modulus=ASSUMED_YOUNGS_MODULUS,
        poisson_ratio=ASSUMED_POISSON_RATIO,
    )
    how = (
        told_by
        if told
        else "median gap_mm at zero depth"
        if gaps
        else "no file tells its height, and no trial has a usable gap_mm"
    )
    if len(gaps) > 1 or (gaps and not told):
        how += f", trials: {len(gaps)}, {1e3 * min(gaps):.3g} to {1e3 * max(gaps):.3g} mm"
    warning = (
        f"the specimen is not given: assumed one layer of {1e3 * thickness:.4g} mm ({how}), "
        f"Poisson ratio {ASSUMED_POISSON_RATIO:g}, density {ASSUMED_DENSITY:g} kg/m^3, "
        f"Young's modulus {ASSUMED_YOUNGS_MODULUS / 1e3:g} kPa before any fit (--specimen FILE, or "
        f"--set {SPECIMEN_THICKNESS}=...)"
    )
    return Tissue(name="assumed specimen", citation="assumed, see warnings", layers=(layer,)), warning


def gap_at_zero_depth(table: TrialTable) -> float | None:
    """Thickness of the specimen (m) at the row nearest to zero depth, the first of them; None without a gap."""
    gap = table.extra.get("gap")
    if gap is None:
        return None
    row = int(np.argmin(np.abs(table.depth)))
    return float(gap[row] + table.depth[row])


def _usable_gap(table: TrialTable) -> float | None:
    gap = gap_at_zero_depth(table)
    return gap if gap is not None and _usable(gap) else None


def _usable(gap: float) -> bool:
    return 1e-7 <= gap <= 1e5
