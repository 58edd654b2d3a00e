"""A press as an input file for FEBio 4: a quarter of the specimen in 8-node bricks, axis along z.

Each of our biquadratic quadrilaterals becomes four, swept round the axis; FEBio takes bricks of its uncoupled laws with
a pressure of their own (FEBio user's manual, 4.1.3). What is asked for comes in FEBio's data records, whose names say
what they are: `AXIS_k: ...` the node on the axis of layer k's top face, `TOOL_QUARTER: ...` the force on the quarter.

Written after FEBio's documentation and source; nobody has run such a file yet.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import pairwise
from types import MappingProxyType
from xml.sax.saxutils import escape

import numpy as np

import fem
from benchmark.exchange.exported_press import ExportedPress, Laws, Nodes, law_text, refuse_linear
from benchmark.files.tissue import LARGEST_EXPONENT
from fem.materials.material import LARGEST_POISSON_RATIO
from fem.materials.neo_hookean import CoupledNeoHookean

SECTORS = 18
"""Bricks round a quarter: the chords lose 0.13 % of the circle's area, which the loads make up for."""
QUARTERS = 4
MOST_TERMS = 6
NODE_DATA = "x;y;z;ux;uy;uz"


def _constants(kind: str, values: dict[str, float], bulk: float) -> str:
    said = "".join(f"<{name}>{value:.12g}</{name}>" for name, value in {**values, "k": bulk}.items())
    return f'type="{kind}">{said}<pressure_model>Abaqus</pressure_model>'


def _neo_hookean(material: fem.NeoHookean) -> str:
    return _constants("Mooney-Rivlin", {"c1": 0.5 * material.shear_modulus, "c2": 0.0}, material.bulk_modulus)


def _mooney_rivlin(material: fem.MooneyRivlin) -> str:
    return _constants("Mooney-Rivlin", {"c1": material.c10, "c2": material.c01}, material.bulk_modulus)


def _yeoh(material: fem.Yeoh) -> str:
    return _constants("Yeoh", {"c1": material.c10, "c2": material.c20, "c3": material.c30}, material.bulk_modulus)


def _gent(material: fem.Gent) -> str:
    return _constants("Gent", {"G": material.shear_modulus, "Jm": material.jm}, material.bulk_modulus)


def _ogden(material: fem.Ogden) -> str:
    """W of FEBio has c / m^2 where ours has mu / alpha."""
    terms: dict[str, float] = {}
    for number, (mu, alpha) in enumerate(material.terms, start=1):
        terms |= {f"c{number}": mu * alpha, f"m{number}": alpha}
    return _constants("Ogden", terms, material.bulk_modulus)


LAWS: Laws = {
    fem.NeoHookean: _neo_hookean,
    fem.MooneyRivlin: _mooney_rivlin,
    fem.Yeoh: _yeoh,
    fem.Gent: _gent,
    fem.Ogden: _ogden,
}


def febio_file(press: ExportedPress) -> str:
    """The text of the `.feb` file.

    Raises
    ------
    InputError
        A law that FEBio does not have, or small strain.
    """
    refuse_linear(press, "FEBio")
    swept = _Swept(press)
    parts = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f"<!-- {escape(press.scenario.name).replace('--', '- -')}: SI units, a quarter, surface z = 0 -->",
        '<febio_spec version="4.0">',
        '<Module type="solid"/>',
        *_control(press),
        *_materials(press),
        *swept.mesh(),
        *_conditions(press),
        *_output(press, swept),
        "</febio_spec>",
    ]
    return "\n".join(parts) + "\n"


def _control(press: ExportedPress) -> Iterator[str]:
    steps = [b - a for a, b in pairwise([0.0, *press.drive.time.tolist()]) if b > a]
    end, size = float(press.drive.time[-1]), min(steps)
    yield "<Control><analysis>STATIC</analysis>"
    yield f"<time_steps>{math.ceil(end / size - 1e-9)}</time_steps><step_size>{size:.12g}</step_size>"
    yield '<solver type="solid"><symmetric_stiffness>symmetric</symmetric_stiffness></solver>'
    yield f'<time_stepper type="default"><max_retries>10</max_retries><dtmin>{1e-4 * size:.6g}</dtmin>'
    yield f"<dtmax>{size:.12g}</dtmax></time_stepper></Control>"


def _materials(press: ExportedPress) -> Iterator[str]:
    yield "<Material>"
    for number, layer in enumerate(press.problem.layers, start=1):
        head = f'id="{number}" name="MATERIAL_{number}"'
        law = law_text(layer, LAWS, "FEBio")
        if not layer.relaxation:
            yield f"<material {head} {law}</material>"
            continue
        left = 1.0 - sum(term.g for term in layer.relaxation)
        terms = "".join(
            f"<g{k}>{term.g:.12g}</g{k}><t{k}>{term.tau:.12g}</t{k}>"
            for k, term in enumerate(layer.relaxation, start=1)
        )
        yield f'<material {head} type="uncoupled viscoelastic"><g0>{left:.12g}</g0>{terms}'
        yield f"<elastic {law}</elastic></material>"
    if press.tied.any():
        number = len(press.problem.layers) + 1
        yield f'<material id="{number}" name="TOOL" type="rigid body"><density>1</density>'
        yield "<center_of_mass>0,0,0</center_of_mass></material>"
    yield "</Material>"


class _Swept:
    """Our mesh swept round a quarter: numbers of its nodes, bricks, wedges at the axis, and the loaded disc."""

    def __init__(self, press: ExportedPress):
        self._press = press
        self._plane, quads = _quarters(press)
        self.layer_quads = quads
        self.on_axis = press.mesh.nodes[self._plane, 0] == 0.0
        self.numbers = self._numbered()

    def _numbered(self) -> Nodes:
        """(planes, P) number, from 1, of each node of the plane in each plane; those on the axis are in all."""
        count = self._plane.size
        numbers = np.zeros((SECTORS + 1, count), dtype=np.int64)
        numbers[:, self.on_axis] = 1 + np.arange(int(self.on_axis.sum()))
        off = int(count - self.on_axis.sum())
        for plane in range(SECTORS + 1):
            numbers[plane, ~self.on_axis] = 1 + int(self.on_axis.sum()) + plane * off + np.arange(off)
        return numbers

    def of(self, mask: np.ndarray) -> Nodes:
        """Numbers of nodes of ours (mask (N,)) in all planes."""
        return np.unique(self.numbers[:, mask[self._plane]])

    def mesh(self) -> Iterator[str]:
        """Mesh and domains."""
        yield '<Mesh><Nodes name="SPECIMEN">'
        yield from self._nodes()
        yield "</Nodes>"
        number = 1
        for layer, quads in enumerate(self.layer_quads, start=1):
            solids = list(self._solids(quads))
            for kind, corners in (("hex8", 8), ("penta6", 6)):
                chosen = [one for one in solids if len(one) == corners]
                if chosen:
                    yield f'<Elements type="{kind}" name="LAYER_{layer}_{kind}">'
                    yield from (f'<elem id="{number + k}">{_joined(one)}</elem>' for k, one in enumerate(chosen))
                    yield "</Elements>"
                    number += len(chosen)
        yield from self._sets()
        yield "</Mesh><MeshDomains>"
        for layer, quads in enumerate(self.layer_quads, start=1):
            for kind in sorted({"hex8" if len(one) == 8 else "penta6" for one in self._solids(quads)}):
                yield f'<SolidDomain name="LAYER_{layer}_{kind}" mat="MATERIAL_{layer}"/>'
        yield "</MeshDomains>"

    def _nodes(self) -> Iterator[str]:
        places = self._press.mesh.nodes[self._plane]
        for plane in range(SECTORS + 1):
            angle = 0.5 * math.pi * plane / SECTORS
            cosine, sine = (0.0 if plane == SECTORS else math.cos(angle)), math.sin(angle)
            for k, (r, z) in enumerate(places):
                if plane == 0 or not self.on_axis[k]:
                    yield f'<node id="{self.numbers[plane, k]}">{r * cosine:.12g},{r * sine:.12g},{z:.12g}</node>'

    def _solids(self, quads: Iterable[tuple[int, ...]]) -> Iterator[tuple[int, ...]]:
        """Bricks and wedges of quadrilaterals (places in the plane, counter-clockwise in r and z)."""
        for corners in quads:
            for plane in range(SECTORS):
                before, after = (self.numbers[at, list(corners)].tolist() for at in (plane, plane + 1))
                yield _solid(before, after)

    def _sets(self) -> Iterator[str]:
        press, nodes = self._press, self._press.mesh.nodes
        sides = {"PLANE_Y": self.numbers[0], "PLANE_X": self.numbers[SECTORS]}
        for name, numbers in sides.items():
            yield f'<NodeSet name="{name}">{_joined(np.unique(numbers))}</NodeSet>'
        yield f'<NodeSet name="HELD">{_joined(self.of(press.held))}</NodeSet>'
        if press.tied.any():
            yield f'<NodeSet name="TOOL">{_joined(self.of(press.tied))}</NodeSet>'
            return
        yield '<Surface name="DISC">'
        rows = np.flatnonzero((nodes[self._plane, 1] == 0.0) & (nodes[self._plane, 0] <= self._disc))
        row = rows[np.argsort(nodes[self._plane[rows], 0])]
        facets = [f for inner, outer in pairwise(row.tolist()) for f in self._facets(inner, outer)]
        for number, one in enumerate(facets, start=1):
            kind = "quad4" if len(one) == 4 else "tri3"
            yield f'<{kind} id="{number}">{_joined(one)}</{kind}>'
        yield "</Surface>"

    @property
    def _disc(self) -> float:
        return self._press.problem.tool.radius * (1.0 + 1e-9)

    def _facets(self, inner: int, outer: int) -> Iterator[tuple[int, ...]]:
        """Facets of the top face between two radii, seen counter-clockwise from above."""
        for plane in range(SECTORS):
            a, b = self.numbers[plane, [inner, outer]]
            c, d = self.numbers[plane + 1, [outer, inner]]
            yield (int(a), int(b), int(c)) if self.on_axis[inner] else (int(a), int(b), int(c), int(d))

    def node(self, ours: int) -> int:
        """Number of a node of ours on the axis."""
        return int(self.numbers[0, int(np.flatnonzero(self._plane == ours)[0])])


def _solid(before: list[int], after: list[int]) -> tuple[int, ...]:
    """A brick between two planes, or a wedge: of a triangle, or of a quadrilateral with an edge on the axis."""
    free = [k for k in range(len(before)) if before[k] != after[k]]
    if len(free) == len(before):
        return (*after, *before)
    low, high = free if free[1] - free[0] == 1 else free[::-1]
    axis_low, axis_high = before[(low - 1) % 4], before[(high + 1) % 4]
    return (axis_low, before[low], after[low], axis_high, before[high], after[high])


def _quarters(press: ExportedPress) -> tuple[Nodes, list[list[tuple[int, ...]]]]:
    """Nodes of ours that are used, and by layer the quadrilaterals (places among them) that ours are parted into."""
    table = press.mesh.elements
    parts = [(0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)]
    used = np.unique(table)
    place = {int(node): k for k, node in enumerate(used)}
    out = []
    for layer in range(len(press.problem.layers)):
        numbers = np.flatnonzero(press.mesh.layer == layer)
        whole = [[int(table[k, e]) for k in part] for e in numbers for part in parts]
        out.append([tuple(place[node] for node in _unlike(press, part)) for part in whole])
    return used, out


def _unlike(press: ExportedPress, corners: list[int]) -> list[int]:
    """The corners but those that stand where the one before them stands: a triangle at a tool's sharp edge."""
    at = press.mesh.nodes
    return [node for k, node in enumerate(corners) if not np.array_equal(at[node], at[corners[k - 1]])]


def _joined(numbers: Iterable[int]) -> str:
    return ",".join(str(int(each)) for each in numbers)


def _conditions(press: ExportedPress) -> Iterator[str]:
    yield "<Boundary>"
    for name, axes in (("HELD", "xyz"), ("PLANE_X", "x"), ("PLANE_Y", "y")):
        held = "".join(f"<{axis}_dof>{int(axis in axes)}</{axis}_dof>" for axis in "xyz")
        yield f'<bc name="{name}" type="zero displacement" node_set="{name}">{held}</bc>'
    if press.tied.any():
        yield '<bc name="TOOL" type="rigid" node_set="TOOL"><rb>TOOL</rb></bc>'
    yield "</Boundary>"
    yield from _rigid(press) if press.tied.any() else _traction(press)
    yield '<LoadData><load_controller id="1" type="loadcurve"><interpolate>LINEAR</interpolate><points>'
    yield "<pt>0,0</pt>" if press.drive.time[0] > 0.0 else ""
    yield from (f"<pt>{t:.12g},{v:.12g}</pt>" for t, v in zip(press.drive.time, press.drive.value, strict=True))
    yield "</points></load_controller></LoadData>"


def _rigid(press: ExportedPress) -> Iterator[str]:
    """The tool: it moves along z alone, by the prescribed depth or under a quarter of the force."""
    fixed = "".join(f"<R{name}_dof>{int(name != 'z')}</R{name}_dof>" for name in "xyzuvw")
    yield f'<Rigid><rigid_bc name="upright" type="rigid_fixed"><rb>TOOL</rb>{fixed}</rigid_bc>'
    if press.drive.control == "depth":
        yield '<rigid_bc name="press" type="rigid_displacement"><rb>TOOL</rb><dof>z</dof>'
        yield '<value lc="1">-1</value><relative>0</relative></rigid_bc></Rigid>'
        return
    yield '<rigid_load name="press" type="rigid_force"><rb>TOOL</rb><dof>Rz</dof>'
    yield f'<value lc="1">{-1.0 / QUARTERS:.12g}</value><load_type>0</load_type></rigid_load></Rigid>'


def _traction(press: ExportedPress) -> Iterator[str]:
    """A dead traction that adds up to a quarter of the force over the facets' area."""
    radius = press.problem.tool.radius
    area = 0.5 * SECTORS * radius**2 * math.sin(0.5 * math.pi / SECTORS)
    yield '<Loads><surface_load name="press" type="traction" surface="DISC"><scale lc="1">1</scale>'
    yield f"<traction>0,0,{-1.0 / QUARTERS / area:.12g}</traction><linear>1</linear></surface_load></Loads>"


def _output(press: ExportedPress, swept: _Swept) -> Iterator[str]:
    yield '<Output><plotfile type="febio"><var type="displacement"/><var type="stress"/></plotfile><logfile>'
    for layer, node in enumerate(press.axis_nodes, start=1):
        yield f'<node_data name="AXIS_{layer}: {NODE_DATA}" data="{NODE_DATA}" delim=",">{swept.node(node)}</node_data>'
    if press.tied.any():
        number = len(press.problem.layers) + 1
        yield f'<rigid_body_data name="TOOL_QUARTER: z;Fz" data="z;Fz" delim=",">{number}</rigid_body_data>'
    yield "</logfile></Output>"


def _as_neo_hookean(values: Mapping[str, float]) -> fem.Material:
    youngs_modulus, ratio = values["E"], values["v"]
    if not youngs_modulus > 0.0:
        raise fem.FemError(f"E = {youngs_modulus:g}: Young's modulus must be above 0")
    if not -1.0 < ratio <= LARGEST_POISSON_RATIO:
        raise fem.FemError(f"v = {ratio:g}: Poisson's ratio must be above -1 and at most {LARGEST_POISSON_RATIO}")
    return CoupledNeoHookean(youngs_modulus, ratio)


def _as_mooney_rivlin(values: Mapping[str, float]) -> fem.Material:
    c1, c2, k = values["c1"], values["c2"], values["k"]
    return fem.MooneyRivlin(c1, c2, _ratio(2.0 * (c1 + c2), k, "2 (c1 + c2)"))


def _as_ogden(values: Mapping[str, float]) -> fem.Material:
    """FEBio's c / m^2 is our mu / alpha: mu = c / m."""
    pairs = [(values.get(f"c{n}", 0.0), values.get(f"m{n}", 1.0)) for n in range(1, MOST_TERMS + 1)]
    for n, (c, m) in enumerate(pairs, start=1):
        if c != 0.0 and m == 0.0:
            raise fem.FemError(f"m{n} = 0 with c{n} = {c:g}: must not be zero (c / m^2 is the term's factor)")
        if abs(m) > LARGEST_EXPONENT:
            raise fem.FemError(f"m{n} = {m:g}: must be {-LARGEST_EXPONENT:g} to {LARGEST_EXPONENT:g}")
    ratio = _ratio(0.5 * sum(c for c, _ in pairs), values["k"], "half the sum of c1, c2, ...")
    return fem.Ogden(tuple((c / m, m) for c, m in pairs if c != 0.0), ratio)


def _ratio(shear: float, bulk: float, what: str) -> float:
    """Poisson's ratio at rest of a shear modulus, named by its constants, and the bulk modulus k."""
    if not shear > 0.0:
        raise fem.FemError(f"{what} = {shear:g}: the shear modulus at rest must be above 0")
    ratio = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)) if bulk > 0.0 else -1.0
    if not -1.0 < ratio <= LARGEST_POISSON_RATIO:
        most = 2.0 * shear * (1.0 + LARGEST_POISSON_RATIO) / (3.0 * (1.0 - 2.0 * LARGEST_POISSON_RATIO))
        raise fem.FemError(
            f"k = {bulk:g}: the bulk modulus must be above 0 and at most {most:g} (Poisson's ratio "
            f"{LARGEST_POISSON_RATIO}) with a shear modulus at rest of {shear:g}"
        )
    return ratio


READ_LAWS: Mapping[str, tuple[Callable[[Mapping[str, float]], fem.Material], str]] = MappingProxyType(
    {
        "neo-Hookean": (_as_neo_hookean, "E v"),
        "Mooney-Rivlin": (_as_mooney_rivlin, "c1 c2 k"),
        "Ogden": (_as_ogden, " ".join(["k", *(f"{letter}{n}" for letter in "cm" for n in range(1, MOST_TERMS + 1))])),
    }
)
"""FEBio's laws that are read, and their constants, by their names."""
