"""Results of CalculiX: the `.dat` of an exported file, and the `.frd` of any model of the scenario whose axis is y.

A `.dat` tells what was printed by the names of sets (`benchmark.exchange.calculix_deck`); a `.frd` has nodes and their
displacements, of which those on the axis (y, the surface at its top) at each layer's top face are taken, and those on
these faces as the profile at peak load.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.models.fea_results.solver_history import (
    SolverHistory,
    layer_at,
    layer_number,
    number,
    text_of,
)
from benchmark.models.model_result import Array
from benchmark.models.prepare import scenario_drive
from benchmark.models.reference_table import ReferenceRows

BLOCK = re.compile(r"^\s*(displacements|total force|forces).* for set (\S+) and time\s+(\S+)\s*$", re.IGNORECASE)
AXIS = "AXIS_"
SHARES = {"TOOL": 1.0, "TOOL_SLICE": 180.0, "TOOL_QUARTER": 4.0}
"""How many of the part whose force is printed make the whole tool; an axisymmetric model is a slice of 2 degrees."""
VERTICAL = 1


def read_dat(path: Path, scenario: Scenario) -> ReferenceRows:
    """Rows from a `.dat`.

    Raises
    ------
    InputError
        File and line of what cannot be read, or what is missing.
    """
    lines, found = text_of(path), SolverHistory(path, scenario.tissue.layer_names)
    for at, line in enumerate(lines):
        block = BLOCK.match(line)
        if block is None:
            continue
        kind, name, when = block[1].lower(), block[2].upper(), number(path, at, block[3])
        row, words = _next_row(path, lines, at)
        if kind == "displacements" and name.startswith(AXIS):
            layer = layer_number(path, at, name.removeprefix(AXIS), found.layers)
            found.add(when, layer, -number(path, row, _word(path, row, words, 1 + VERTICAL)), row + 1)
        elif kind == "total force" and name in SHARES:
            found.force[when] = -SHARES[name] * number(path, row, _word(path, row, words, VERTICAL))
    return found.rows()


def _next_row(path: Path, lines: list[str], at: int) -> tuple[int, list[str]]:
    """The first line with words after a heading."""
    for row in range(at + 1, min(at + 4, len(lines))):
        if lines[row].strip():
            return row, lines[row].split()
    raise InputError(f"{path}, line {at + 1}: the heading has no values; the file is damaged or cut off")


def _word(path: Path, row: int, words: list[str], place: int) -> str:
    if place >= len(words):
        raise InputError(
            f"{path}, line {row + 1}: {len(words)} values where {place + 1} are needed; the file is cut off"
        )
    return words[place]


@dataclass(frozen=True, eq=False)
class _Table:
    """A block of a `.frd`: node numbers (n,), values (n, 3), and the line where it begins."""

    node: Array
    values: Array
    line: int


def read_frd(path: Path, scenario: Scenario) -> ReferenceRows:
    """Rows from a `.frd`, under force control: it does not tell which part of the circumference its forces are of.

    Raises
    ------
    InputError
        File and line of what cannot be read, depth control, or a model without nodes on the axis.
    """
    if scenario.load.control != "force":
        raise InputError(
            f"{path}: under depth control the force is the answer, which a .frd does not tell whole; give the .dat"
        )
    lines, names = text_of(path), scenario.tissue.layer_names
    nodes = _nodes(path, lines)
    found = SolverHistory(path, names)
    thickness = {one.name: one.thickness for one in scenario.tissue.layers}
    layer = layer_at(nodes.values[:, VERTICAL].max() - nodes.values[:, VERTICAL], thickness)
    radius = np.hypot(nodes.values[:, 0], nodes.values[:, 2])
    size = max(float(radius.max()), 1e-12)
    on_axis = radius <= 1e-6 * size
    instants = list(_displacements(path, lines))
    for when, moved in instants:
        down = _by_node(path, nodes, moved)
        for k in np.flatnonzero(on_axis & (layer >= 0)):
            found.add(when, int(layer[k]), -float(down[k]), moved.line)
    _profile(found, scenario, instants, nodes, layer, np.where(on_axis, 0.0, radius))
    return found.rows()


def _profile(
    found: SolverHistory,
    scenario: Scenario,
    instants: list[tuple[float, _Table]],
    nodes: _Table,
    layer: Array,
    radius: Array,
) -> None:
    """The faces' deflections at the instant of peak load, where that was printed."""
    drive = scenario_drive(scenario)
    peak = float(drive.time[int(np.abs(drive.value).argmax())])
    close = [moved for when, moved in instants if abs(when - peak) <= 1e-6 * peak]
    if close:
        down = _by_node(found.path, nodes, close[-1])
        for k in np.flatnonzero((layer >= 0) & (radius > 0.0)):
            found.profile[int(layer[k]), round(float(radius[k]), 12)] = -float(down[k])


def _by_node(path: Path, nodes: _Table, moved: _Table) -> Array:
    """(n,) vertical displacements in the order of the nodes."""
    order = np.argsort(moved.node)
    place = np.searchsorted(moved.node[order], nodes.node)
    place = np.minimum(place, moved.node.size - 1)
    if not np.array_equal(moved.node[order][place], nodes.node):
        raise InputError(
            f"{path}, line {moved.line}: displacements of other nodes than the mesh has; the file is damaged"
        )
    return np.asarray(moved.values[order][place, VERTICAL])


def _nodes(path: Path, lines: list[str]) -> _Table:
    start = next((k for k, line in enumerate(lines) if line.startswith("    2C")), None)
    if start is None:
        raise InputError(f"{path}: no nodes (2C); needed is an ASCII .frd of CalculiX")
    return _table(path, lines, start + 1)


def _displacements(path: Path, lines: list[str]) -> Iterator[tuple[float, _Table]]:
    """Instants with their displacements."""
    heads = [k for k, line in enumerate(lines) if line.startswith("  100C")]
    for head, end in pairwise([*heads, len(lines)]):
        kind = next((k for k in range(head + 1, min(head + 3, end)) if lines[k].startswith(" -4  DISP")), None)
        if kind is not None:
            yield number(path, head, lines[head][12:24]), _table(path, lines, kind + 1)


def _table(path: Path, lines: list[str], start: int) -> _Table:
    """Rows of ` -1`, node and three values of 12 characters, up to ` -3`."""
    node, values = [], []
    for at in range(start, len(lines)):
        line = lines[at]
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):
            node.append(number(path, at, line[3:13]))
            values.append([number(path, at, line[13 + 12 * k : 25 + 12 * k]) for k in range(3)])
    else:
        raise InputError(f"{path}, line {len(lines)}: a block without its end; the file is cut off")
    if not node:
        raise InputError(f"{path}, line {start}: a block without nodes; the file is damaged")
    return _Table(np.array(node), np.array(values), start)
