"""CalculiX as the judge of tools that slide: `python -m tests.performance.peers.calculix_sliding [SIZE]`.

The shipped skin under a tool over whose rounded edge it slides, 2 mm deep, by CalculiX (`ccx`, CAX8R, contact from face
to face by a stiff linear spring) on a mesh of its own, SIZE mm wide at the edge (0.1), beside the wave and the finite
elements as the harness runs them. CalculiX gives forces of a wedge of two degrees.
"""

from __future__ import annotations

import os

for _name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_name] = "1"  # before NumPy is loaded

import sys  # noqa: E402
import tempfile  # noqa: E402
from collections.abc import Iterable, Sequence  # noqa: E402
from dataclasses import dataclass, field  # noqa: E402
from pathlib import Path  # noqa: E402

import numpy as np  # noqa: E402

from benchmark.files import Layer, Scenario, load_scenario  # noqa: E402
from benchmark.models import Drive, prepare  # noqa: E402
from tests.performance.peers.calculix import run  # noqa: E402

MM = 1e3
DEPTH, STEPS, BORDER = 2.0, 20, 60.0
"""mm, load steps of ours, and mm."""
WEDGES, SPRING = 180.0, 400.0
"""Of two degrees; MPa/mm."""
BESIDE, UP = 0.5, 1.0
"""mm of fine mesh on both sides of the edge, and mm of the tool's wall."""
TOOLS = ((1.0, 0.0), (0.5, 0.0), (1.0, 0.3))
"""Edge, mm, and Coulomb's coefficient."""


@dataclass
class Mesh:
    """Nodes (x, y) in mm and quadratic elements, numbered from one as CalculiX has them."""

    nodes: list[tuple[float, float]] = field(default_factory=list)
    elements: dict[str, list[list[int]]] = field(default_factory=dict)

    def add(self, x: float, y: float) -> int:
        """The number of a new node."""
        self.nodes.append((x, y))
        return len(self.nodes)

    def numbered(self) -> dict[str, list[tuple[int, list[int]]]]:
        """Elements of each set with their numbers."""
        count, out = 0, {}
        for name, elements in self.elements.items():
            out[name] = [(count + k, nodes) for k, nodes in enumerate(elements, 1)]
            count += len(elements)
        return out


def growing(length: float, first: float, largest: float, growth: float = 1.25) -> np.ndarray:
    """Places from 0 to a length whose distances grow from about the first."""
    steps = [first]
    while sum(steps) < length:
        steps.append(min(growth * steps[-1], largest))
    places = np.cumsum([0.0, *steps])
    return places * (length / places[-1])


def tissue(mesh: Mesh, layers: Sequence[Layer], radius: float, edge: float, size: float) -> dict[str, list[int]]:
    """Mesh the layers; node sets by name."""
    start, end = radius - edge - BESIDE, radius + BESIDE
    left, right = start - growing(start, size, 0.4)[::-1], end + growing(BORDER - end, size, 3.0)
    across = np.concatenate([left[:-1], np.linspace(start, end, int((end - start) / size) + 1), right[1:]])
    across[0] = 0.0
    down, tops, first = [0.0], [], size
    for layer in layers:
        tops.append(2 * (len(down) - 1))
        down += list(down[-1] + growing(layer.thickness * MM, first, 0.6, 1.2)[1:])
        first = max(size, down[-1] - down[-2])
    x, y = (np.sort(np.concatenate([one, 0.5 * (one[1:] + one[:-1])])) for one in (across, np.array(down)))
    number = {
        (i, j): mesh.add(x[i], -y[j]) for j in range(y.size) for i in range(x.size) if not (i % 2 == 1 and j % 2 == 1)
    }
    for j in range(0, y.size - 1, 2):
        into = mesh.elements.setdefault(f"L{sum(top <= j for top in tops) - 1}", [])
        for i in range(0, x.size - 1, 2):
            corners = [(0, 2), (2, 2), (2, 0), (0, 0), (1, 2), (2, 1), (1, 0), (0, 1)]
            into.append([number[i + a, j + b] for a, b in corners])
    last, low = x.size - 1, y.size - 1
    sets = {
        "AXIS": [n for (i, _), n in number.items() if i == 0],
        "OUTER": [n for (i, _), n in number.items() if i == last],
        "BOTTOM": [n for (_, j), n in number.items() if j == low],
        "TOPS": [number[0, top] for top in tops],
    }
    return sets | {"REACH": [k for k in range(1, across.size) if across[k] < end]}


def tool(mesh: Mesh, radius: float, edge: float, size: float) -> None:
    """Mesh the tool's face, edge and wall as a strip half an edge thick."""
    face = radius - edge
    turns = np.linspace(0.0, 0.5 * np.pi, 2 * int(np.ceil(0.5 * np.pi * edge / size)) + 1)[1:]
    profile = [(x, 0.0, 0.0, -1.0) for x in np.linspace(0.0, face, 2 * int(np.ceil(face / 0.25)) + 1)]
    profile += [(face + edge * np.sin(t), edge - edge * np.cos(t), np.sin(t), -np.cos(t)) for t in turns]
    profile += [(radius, edge + up, 1.0, 0.0) for up in np.linspace(0.0, UP, 9)[1:]]
    rows = [[mesh.add(x - 0.25 * k * edge * n, y - 0.25 * k * edge * m) for k in range(3)] for x, y, n, m in profile]
    mesh.elements["TOOL"] = [
        [one[0], two[0], two[2], one[2], middle[0], two[1], middle[2], one[1]]
        for one, middle, two in zip(rows[:-2:2], rows[1:-1:2], rows[2::2], strict=True)
    ]


def deck(scenario: Scenario, size: float) -> str:
    """CalculiX's input of a scenario's tool on its layers, in mm, N and MPa."""
    edge, friction = (scenario.tool.edge_radius or 0.0) * MM, scenario.physics.friction_coefficient or 0.0
    mesh, layers, radius = Mesh(), scenario.tissue.layers, scenario.tool.radius * MM
    sets = tissue(mesh, layers, radius, edge, size)
    below = len(mesh.nodes)
    tool(mesh, radius, edge, size)
    used = {node for elements in mesh.elements.values() for nodes in elements for node in nodes}
    sets["TOOL"] = [node for node in range(below + 1, len(mesh.nodes) + 1) if node in used]
    numbered, reach = mesh.numbered(), sets.pop("REACH")
    lines = ["*NODE", *(f"{k},{x:.9g},{y:.9g},0." for k, (x, y) in enumerate(mesh.nodes, 1) if k in used)]
    for name, elements in numbered.items():
        lines += [f"*ELEMENT, TYPE=CAX8R, ELSET={name}", *(f"{k}," + ",".join(map(str, n)) for k, n in elements)]
    for name, nodes in sets.items():
        lines += [f"*NSET, NSET={name}", *(f"{node}," for node in nodes)]
    for k, layer in enumerate(layers):
        shear, bulk = layer.shear_modulus / MM**2, layer.youngs_modulus / (3.0 - 6.0 * layer.poisson_ratio) / MM**2
        lines += [f"*MATERIAL, NAME=L{k}", "*HYPERELASTIC, NEO HOOKE", f"{0.5 * shear:.12g},{2.0 / bulk:.12g}"]
    lines += ["*MATERIAL, NAME=TOOL", "*ELASTIC", "1e3,0.3"]
    lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL={name}" for name in numbered]
    lines += ["*SURFACE, NAME=SKIN, TYPE=ELEMENT", *(f"{numbered['L0'][k - 1][0]},S3" for k in reach)]
    lines += ["*SURFACE, NAME=PROFILE, TYPE=ELEMENT", *(f"{k},S1" for k, _ in numbered["TOOL"])]
    return "\n".join([*lines, *_contact(friction), *_step()]) + "\n"


def _contact(friction: float) -> Iterable[str]:
    yield from ("*CONTACT PAIR, INTERACTION=SLIDES, TYPE=SURFACE TO SURFACE", "SKIN,PROFILE")
    yield from ("*SURFACE INTERACTION, NAME=SLIDES", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{SPRING}")
    if friction:
        yield from ("*FRICTION", f"{friction},{0.1 * SPRING}")


def _step() -> Iterable[str]:
    yield from ("*BOUNDARY", "AXIS,1,1", "OUTER,1,2", "BOTTOM,1,2", "TOOL,1,1", "*STEP, NLGEOM, INC=400", "*STATIC")
    yield from ("0.05,1.,1e-4,0.1", "*BOUNDARY", f"TOOL,2,2,{-DEPTH}")
    yield from ("*NODE PRINT, NSET=TOOL, TOTALS=ONLY", "RF", "*NODE PRINT, NSET=TOPS", "U", "*END STEP")


def judged(scenario: Scenario, size: float) -> np.ndarray:
    """CalculiX's force in N and the deflection of each layer's top on the axis in mm, at the end."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "slides"
        path.with_suffix(".inp").write_text(deck(scenario, size))
        run(path, {**os.environ})
        lines = path.with_suffix(".dat").read_text().splitlines()
    force = max(k for k, line in enumerate(lines) if "total force" in line)
    moved = max(k for k, line in enumerate(lines) if "displacements" in line)
    if not lines[moved].rstrip().endswith("0.1000000E+01"):
        raise ArithmeticError(f"CalculiX stopped early: {lines[moved].strip()}")
    tops = [-float(line.split()[2]) for line in lines[moved + 2 : moved + 2 + len(scenario.tissue.layers)]]
    return np.array([-WEDGES * float(lines[force + 2].split()[1]), *tops])


def ours(model: str, scenario: Scenario) -> np.ndarray:
    """The same of one of the harness's models."""
    steps = np.arange(1.0, STEPS + 1.0)
    found = prepare(model, scenario).run(Drive("depth", steps, DEPTH / MM * steps / STEPS))
    return np.array([found.force[-1], *(MM * found.top_deflection[-1])])


def pressed(edge: float, friction: float) -> Scenario:
    """The skin, elastic, under a tool that slides, on the fine mesh."""
    contact = {"tool.contact": "rigid_frictionless"}
    if friction:
        contact = {"tool.contact": "rigid_frictional", "physics.friction_coefficient": f"{friction:g}"}
    scenario = load_scenario("skin-5N", {**contact, "tool.edge_radius": f"{edge:g} mm", "fem.mesh": "fine"})
    layers = tuple(layer.model_copy(update={"relaxation": ()}) for layer in scenario.tissue.layers)
    return scenario.model_copy(update={"tissue": scenario.tissue.model_copy(update={"layers": layers})})


def main() -> None:
    """Measure and print, Markdown."""
    size = float(sys.argv[1]) if len(sys.argv) > 1 else 0.1
    print("| edge mm, friction | | force N | tops of the layers on the axis, mm |\n|---|---|---|---|")
    for edge, friction in TOOLS:
        scenario = pressed(edge, friction)
        for name, found in (
            ("CalculiX", judged(scenario, size)),
            ("wave", ours("wave", scenario)),
            ("finite elements", ours("fem", scenario)),
        ):
            cells = ", ".join(f"{value:.4f}" for value in found[1:])
            print(f"| {edge:g}, {friction:g} | {name} | {found[0]:.4f} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
