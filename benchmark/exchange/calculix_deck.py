"""A press as an input file for CalculiX, in Abaqus' keywords: CAX8R, and CAX6 where our quadrilaterals are collapsed.

SI units, axis along y. Prestrained layers, memory and contact are left to `exported_press` to refuse. CalculiX prints
the reaction of a slice of 2 degrees of an axisymmetric model (user's manual of version 2.20, 6.2.29 and 7.81): the set
TOOL_SLICE says so by its name. AXIS_k is the node on the axis of layer k's top face, k from 1 at the surface.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

import numpy as np

import fem
from benchmark.exchange.exported_press import Element, ExportedPress, Laws, law_text
from benchmark.models.model_result import Array

KINDS = {4: "CAX8R", 3: "CAX6"}
MOST_FIELDS = 20
"""Instants at which whole fields are written beside the axis' history."""
EVEN = 1e-9
ONLY_FIRST = "1.e10"
"""D2 and D3 of a law, 1/Pa: so large that their terms vanish; CalculiX puts values of its own in the place of zeros."""


def _compressibility(material: fem.Material) -> str:
    """D1 of U = (J - 1)^2 / D1."""
    return f"{2.0 / material.bulk_modulus:.12g}"


def _neo_hookean(material: fem.NeoHookean) -> str:
    return f"*HYPERELASTIC, NEO HOOKE\n{0.5 * material.shear_modulus:.12g}, {_compressibility(material)}"


def _mooney_rivlin(material: fem.MooneyRivlin) -> str:
    return f"*HYPERELASTIC, MOONEY-RIVLIN\n{material.c10:.12g}, {material.c01:.12g}, {_compressibility(material)}"


def _yeoh(material: fem.Yeoh) -> str:
    constants = ", ".join(f"{each:.12g}" for each in (material.c10, material.c20, material.c30))
    return f"*HYPERELASTIC, YEOH\n{constants}, {_compressibility(material)}, {ONLY_FIRST}, {ONLY_FIRST}"


def _linear(material: fem.LinearElastic) -> str:
    return f"*ELASTIC\n{material.youngs_modulus:.12g}, {material.poisson_ratio:.12g}"


LAWS: Laws = {
    fem.NeoHookean: _neo_hookean,
    fem.MooneyRivlin: _mooney_rivlin,
    fem.Yeoh: _yeoh,
    fem.LinearElastic: _linear,
}
"""Not Ogden's: CalculiX 2.20 has the law, and did not converge with it in presses that we tried."""


def calculix_deck(press: ExportedPress) -> str:
    """The text of the `.inp` file.

    Raises
    ------
    InputError
        A law that CalculiX does not have.
    """
    return "\n".join([*_heading(press), *_mesh(press), *_materials(press), *_conditions(press), *_step(press)]) + "\n"


def _heading(press: ExportedPress) -> Iterator[str]:
    yield "*HEADING"
    yield "".join(each if each.isprintable() else " " for each in press.scenario.name)[:80]
    for layer, given in enumerate(press.problem.layers, start=1):
        yield f"** layer {layer}: {given.name}, {1e3 * given.thickness:.6g} mm"
    yield "** SI units: m, N, Pa, s; axis of symmetry y, surface y = 0, press towards -y"


def _mesh(press: ExportedPress) -> Iterator[str]:
    nodes = press.mesh.nodes
    yield "*NODE, NSET=ALL"
    for node in _used(press):
        yield f"{node + 1}, {nodes[node, 0]:.12g}, {nodes[node, 1]:.12g}"
    for layer in range(len(press.problem.layers)):
        elements = press.elements(layer)
        for corners, kind in KINDS.items():
            yield from _elements([one for one in elements if one.corners == corners], kind, layer)
    for layer, node in enumerate(press.axis_nodes, start=1):
        yield from _set(f"AXIS_{layer}", [node])
    yield from _set("TOOL_SLICE", np.flatnonzero(press.tied if press.tied.any() else press.load != 0.0))


def _used(press: ExportedPress) -> list[int]:
    """Nodes of elements; the middle of ours is not among them."""
    layers = range(len(press.problem.layers))
    return sorted({node for layer in layers for one in press.elements(layer) for node in one.nodes})


def _elements(elements: list[Element], kind: str, layer: int) -> Iterator[str]:
    if elements:
        yield f"*ELEMENT, TYPE={kind}, ELSET=LAYER_{layer + 1}"
    for one in elements:
        yield ", ".join(str(number + 1) for number in (one.number, *one.nodes))


def _set(name: str, nodes: Iterable[int]) -> Iterator[str]:
    yield f"*NSET, NSET={name}"
    yield from (f"{int(node) + 1}," for node in nodes)


def _materials(press: ExportedPress) -> Iterator[str]:
    for number, layer in enumerate(press.problem.layers, start=1):
        yield f"*MATERIAL, NAME=MATERIAL_{number}"
        yield law_text(layer, LAWS, "CalculiX")
        yield f"*SOLID SECTION, ELSET=LAYER_{number}, MATERIAL=MATERIAL_{number}"


def _conditions(press: ExportedPress) -> Iterator[str]:
    used = np.isin(np.arange(len(press.mesh.nodes)), _used(press))
    yield "*BOUNDARY"
    yield from (f"{node + 1}, 1, 2" for node in np.flatnonzero(press.held & used))
    yield from (f"{node + 1}, 1, 1" for node in np.flatnonzero(press.held_radially & used))
    if press.drive.control == "force" and press.tied.any():
        master = press.axis_nodes[0]
        for node in np.flatnonzero(press.tied & used):
            if node != master:
                yield f"*EQUATION\n2\n{node + 1}, 2, 1., {master + 1}, 2, -1."
    yield "*AMPLITUDE, NAME=HISTORY"
    rows = zip(*_from_rest(press.drive.time, press.drive.value), strict=True)
    yield from (f"{time:.12g}, {value:.12g}" for time, value in rows)


def _from_rest(time: Array, value: Array) -> tuple[Array, Array]:
    """The history with the state of rest at time zero before it."""
    if time[0] <= 0.0:
        return time, value
    return np.concatenate([[0.0], time]), np.concatenate([[0.0], value])


def _step(press: ExportedPress) -> Iterator[str]:
    if press.problem.kinematics == "linear":
        yield from _linear_steps(press)
        return
    time = press.drive.time
    steps = [later - earlier for earlier, later in pairwise([0.0, *time.tolist()]) if later > earlier]
    small, end = min(steps), float(time[-1])
    even = max(steps) - small <= EVEN * end
    yield f"*STEP, INC={100 * len(steps)}, NLGEOM"
    yield "*STATIC"
    yield f"{small:.12g}, {end:.12g}, {1e-6 * end:.12g}, {small if even else max(steps):.12g}"
    yield from _loads(press, None)
    yield from _asked(press, max(1, len(steps) // MOST_FIELDS))


def _linear_steps(press: ExportedPress) -> Iterator[str]:
    """Small strain is one solve a row: CalculiX cuts such a step in no increments."""
    before = 0.0
    for time, value in zip(press.drive.time.tolist(), press.drive.value.tolist(), strict=True):
        if time <= before:
            continue
        yield f"*STEP\n*STATIC\n{time - before:.12g}, {time - before:.12g}"
        yield from _loads(press, value)
        yield from _asked(press, 1)
        before = time


def _asked(press: ExportedPress, every: int) -> Iterator[str]:
    """What is printed, and the end of the step."""
    for layer in range(1, len(press.problem.layers) + 1):
        yield f"*NODE PRINT, NSET=AXIS_{layer}\nU"
    yield "*NODE PRINT, NSET=TOOL_SLICE, TOTALS=ONLY\nRF"
    yield f"*NODE FILE, OUTPUT=2D, FREQUENCY={every}\nU, RF"
    yield "*END STEP"


def _loads(press: ExportedPress, value: float | None) -> Iterator[str]:
    """The tool's prescribed depth, or the nodal forces of the whole circumference: a value, or the history."""
    history, size = (", AMPLITUDE=HISTORY", 1.0) if value is None else ("", value)
    if press.drive.control == "depth":
        yield f"*BOUNDARY{history}"
        yield from (f"{node + 1}, 2, 2, {-size:.12g}" for node in _pushed(press))
        return
    yield f"*CLOAD{history}"
    yield from (f"{node + 1}, 2, {size * press.load[node]:.12g}" for node in np.flatnonzero(press.load))


def _pushed(press: ExportedPress) -> list[int]:
    used = set(_used(press))
    return [int(node) for node in np.flatnonzero(press.tied) if int(node) in used]
