"""FEBio's input files (`.feb`, format 3.0 and 4.0) as bodies for our finite elements, as far as our laws go.

Read are linear elements (hex8, tet4), neo-Hookean (coupled, as FEBio has it), Mooney-Rivlin and Ogden parts, held and
prescribed displacements, nodal forces, linear constraints, rigid surfaces that touch (see
:mod:`benchmark.exchange.febio_contact`), and load curves at the end of the one step: everything grows with the share of
the load, but for penalties, which are those at the end. Between their points curves are linear, outside them constant
or extrapolated. What else acts in a file (other contact, pressure, materials, curves, inertia, any parameter that is
not known here) is refused by its name, so that no case is solved by half; what only steers a solver's convergence does
not act. Units are the file's own. Written after FEBio's documentation, and its source where that is silent.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from xml.etree import ElementTree

import numpy as np

from benchmark.errors import InputError
from benchmark.exchange.febio_contact import ContactReader, rigid_materials
from benchmark.exchange.febio_file import READ_LAWS
from fem import FemError, Material
from fem.assembly.solid import SOLID_ELEMENTS
from fem.verification.constrained_body import ConstrainedBody, Constraint

AXES = "xyz"
OPTIONS = (
    "analysis time_steps step_size title solver time_stepper optimize_bw plot_level plot_range plot_stride "
    "plot_zero_state output_level output_stride print_level adaptor_re_solve"
)
SECTIONS: Mapping[str, str | None] = MappingProxyType(
    {
        "Control": OPTIONS,
        "Globals": "Constants",
        "Material": "material",
        "Mesh": "Nodes Elements NodeSet Surface SurfacePair ElementSet Edge DiscreteSet PartList",
        "MeshDomains": "SolidDomain",
        "MeshData": "",
        "Boundary": "bc",
        "LoadData": "load_controller",
        **dict.fromkeys(("Module", "Output", "Loads", "Contact", "Rigid", "Constraints")),
    }
)
"""What each section may have; None: anything, since it does not act, or is refused where it is read."""
PARTS: Mapping[str, str] = MappingProxyType(
    {
        "fix": "dofs",
        "zero displacement": "x_dof y_dof z_dof",
        "prescribe": "dof scale relative",
        "prescribed displacement": "dof value relative",
    }
)
"""What each kind of boundary condition may have. From rest a relative displacement is the absolute one."""
CURVED = frozenset({"value", "scale", "offset", "penalty", "dtmax"})
"""Numbers of which a load curve is read, or, for the longest time step, does not act."""
COUPLED = frozenset({"neo-Hookean"})
DEFAULT_MODEL = ("default", "0")
SUPPORTED_ELEMENTS = ("hex8", "tet4")
USUAL_RULES = frozenset({None, "HEX8G8", "TET4G1", "TET4G4"})
AT_POINT = 1e-9
"""Of a load curve's duration, by which a time may be off one of its ends."""


@dataclass(frozen=True)
class FebioCase:
    """One case.

    Attributes
    ----------
    name
        The file's name without its ending.
    body
        The body under the load at the end.
    steps
        Load steps that the file asks for.
    materials
        Names of FEBio's laws in it.
    """

    name: str
    body: ConstrainedBody
    steps: int
    materials: tuple[str, ...]

    def solved(self) -> np.ndarray:
        """Displacements (3, N) at the end.

        Raises
        ------
        ArithmeticError
            If no equilibrium is found.
        """
        return self.body.press(self.steps)

    def norm(self) -> float:
        """Norm of all displacements that are solved for, which FEBio's test suite compares."""
        return float(np.linalg.norm(self.solved()[self.body.free]))


def read_febio_case(path: Path) -> FebioCase:
    """Read a file.

    Raises
    ------
    InputError
        What the file has that is damaged, or not covered.
    """
    reader = _Reader(path, _root(path))
    with np.errstate(invalid="ignore"):
        return reader.case()


def _root(path: Path) -> ElementTree.Element:
    try:
        text = path.read_text(encoding="latin-1")
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError(f"{path}: a document type or entities are not read in a FEBio file")
    try:
        root = ElementTree.fromstring(text.split("?>", 1)[-1] if text.lstrip().startswith("<?") else text)
    except ElementTree.ParseError as error:
        raise InputError(f"{path}: no XML: {error}") from error
    if root.tag != "febio_spec" or root.get("version", "") not in ("3.0", "4.0"):
        raise InputError(f"{path}: {root.tag} {root.get('version', '')}: must be febio_spec of version 3.0 or 4.0")
    return root


@dataclass(frozen=True)
class _Reader:
    """The sections of one file."""

    path: Path
    root: ElementTree.Element

    def refuse(self, what: str) -> InputError:
        return InputError(f"{self.path}: {what}")

    def case(self) -> FebioCase:
        self._require_known()
        points, rigid = self._nodes(), self._rigid
        numbers = [number for number in points if number not in rigid]
        nodes = np.array([points[number] for number in numbers]).reshape(-1, 3)
        place = {number: k for k, number in enumerate(numbers)}
        kind, elements, part, names = self._elements(place)
        laws = [self._law(name) for name in names]
        held, moved = np.zeros((3, len(nodes)), dtype=np.bool_), np.full((3, len(nodes)), np.nan)
        for boundary in self._each("Boundary", "bc"):
            self._support(boundary, place, held, moved)
        force = np.zeros((3, len(nodes)))
        for load in self._each("Loads", "*"):
            self._force(load, place, force)
        ties = tuple(self._constraints(place))
        alone = np.setdiff1d(np.arange(len(nodes)), [*elements.flat, *(node for tie in ties for node in tie.nodes)])
        held[:, alone] = True  # as FEBio has it, nothing acts on a node of no element
        kinds = {name for name, _ in laws}
        if kinds & COUPLED and kinds - COUPLED:
            raise self.refuse("coupled and uncoupled materials in one body are not read")
        body = ConstrainedBody(
            nodes, elements, kind, part, tuple(law for _, law in laws), held, moved, force,
            ties, logarithmic=not kinds & COUPLED,
        )  # fmt: skip
        body = replace(body, contacts=ContactReader(self, place, rigid, points).contacts(body))
        return FebioCase(self.path.stem, body, self._steps(), tuple(sorted(kinds)))

    def _require_known(self) -> None:
        """Refuse sections, options of the analysis, and load curves that act and are not read."""
        seen = set()
        for section in self.root:
            name, words = section.tag, (section.text or "").strip()
            if name not in SECTIONS and (len(section) or words or section.attrib):
                raise self.refuse(f"{name}: this section is not read, so the case would not be the same")
            if name in seen or "from" in section.attrib:
                raise self.refuse(f"{name}: a section must be there once, and whole in this file")
            seen.add(name)
            if (known := SECTIONS.get(name)) is not None:
                self.only(section, known, name)
            for one in () if name == "Output" else section.iter():
                if "lc" in one.attrib and one.tag not in CURVED:
                    raise self.refuse(f"{name}: {one.tag}: a load curve of it is not read")
        self._require_static()

    def _require_static(self) -> None:
        for place in ("Module", "Control/solver"):
            found = self.root.find(place)
            if found is not None and found.get("type", "solid") != "solid":
                raise self.refuse(f"{place}: type {found.get('type')!r} is not read, only 'solid'")
        analysis = self.root.find("Control/analysis")
        kind = "static" if analysis is None else (analysis.get("type") or analysis.text or "").strip()
        if kind.lower() not in ("static", "0"):
            raise self.refuse(f"Control: analysis {kind!r} is not read, only STATIC")
        if self.number(self.root.findtext("Control/solver/arc_length") or "0", "Control: arc_length") != 0.0:
            raise self.refuse("Control: solver: arc_length is not read")

    def only(self, one: ElementTree.Element, known: str, what: str) -> None:
        for part in one:
            if part.tag not in known.split():
                raise self.refuse(f"{what}: {part.tag} is not read, so the case would not be the same")

    def _each(self, section: str, tag: str) -> Iterator[ElementTree.Element]:
        found = self.root.find(section)
        yield from () if found is None else found.findall(tag)

    def number(self, text: str | None, what: str) -> float:
        try:
            value = float((text or "").strip())
        except ValueError:
            raise self.refuse(f"{what} = {text!r}: must be a number") from None
        if not np.isfinite(value):
            raise self.refuse(f"{what} = {text!r}: must be finite")
        return value

    def row(self, text: str | None, what: str) -> list[float]:
        return [self.number(word, what) for word in (text or "").split(",")]

    def _place(self, number: float, place: dict[int, int], what: str) -> int:
        if int(number) in self._rigid:
            raise self.refuse(f"{what}: node {number:g} is of a rigid body: one that is glued to others is not read")
        if int(number) not in place:
            raise self.refuse(f"{what}: there is no node {number:g}")
        return place[int(number)]

    def _nodes(self) -> dict[int, np.ndarray]:
        """Where each node is, by number."""
        numbers, rows = [], []
        for node in self.root.findall("Mesh/Nodes/node"):
            numbers.append(int(self.number(node.get("id"), "node: id")))
            rows.append(self.row(node.text, f"node {numbers[-1]}"))
        if not rows or any(len(row) != 3 for row in rows) or len(set(numbers)) != len(numbers):
            raise self.refuse("Mesh/Nodes: must list nodes with three coordinates, each once")
        return dict(zip(numbers, np.array(rows), strict=True))

    def _domains(self) -> dict[str | None, str]:
        """Material of each group of elements."""
        return {one.get("name"): one.get("mat") or "" for one in self.root.findall("MeshDomains/SolidDomain")}

    @cached_property
    def _rigid(self) -> dict[int, str]:
        """Rigid body of each node that has one."""
        out, material, rigid = {}, self._domains(), rigid_materials(self)
        for one in self.root.findall("Mesh/Elements"):
            name = material.get(one.get("name"), "")
            if name in rigid:
                for elem in one.findall("elem"):
                    numbers = self.row(elem.text, f"elem {elem.get('id')}")
                    out.update(dict.fromkeys((int(number) for number in numbers), name))
        return out

    def _elements(self, place: dict[int, int]) -> tuple[str, np.ndarray, np.ndarray, list[str]]:
        """Kind, nodes (n, E) in scikit-fem's order, part (E,), and the material's name of each part."""
        material, rigid = self._domains(), rigid_materials(self)
        kinds: set[str] = set()
        names: list[str] = []
        rows, part = [], []
        for group in self.root.findall("Mesh/Elements"):
            kind, name = group.get("type", ""), group.get("name")
            if material.get(name) in rigid:
                continue
            if kind not in SUPPORTED_ELEMENTS or name not in material:
                raise self.refuse(
                    f"Elements {name}: {kind} without a SolidDomain, or none of {', '.join(SUPPORTED_ELEMENTS)}"
                )
            self._require_usual(name, kind, material[name])
            kinds.add(kind)
            for one in group.findall("elem"):
                what = f"elem {one.get('id')}"
                rows.append([self._place(number, place, what) for number in self.row(one.text, what)])
                part.append(len(names))
            names.append(material[name])
        if len(kinds) != 1 or {len(row) for row in rows} != {len(SOLID_ELEMENTS[min(kinds)].vtk_order)}:
            raise self.refuse("Mesh/Elements: must be elements of one kind, with as many nodes as it has")
        kind, table = kinds.pop(), np.array(rows)
        elements = np.empty_like(table.T)
        elements[SOLID_ELEMENTS[kind].vtk_order] = table.T
        return kind, elements, np.array(part), names

    def _require_usual(self, name: str | None, element: str, material: str) -> None:
        """Refuse a domain whose elements are not those that its material has by default."""
        types = ["elastic-solid"] if self._law(material)[0] in COUPLED else ["three-field-solid"]
        types += ["elastic-solid", "three-field-solid"] if element == "tet4" else []  # of one strain each
        usual: dict[str, Collection[str | None]] = {"type": [None, *types], "elem_type": USUAL_RULES}
        for one in self.root.findall("MeshDomains/SolidDomain"):
            if one.get("name") == name:
                self.only(one, "", f"SolidDomain {name}")
                for word, known in usual.items():
                    if one.get(word) not in known:
                        raise self.refuse(f"SolidDomain {name}: {word} {one.get(word)!r} is not read")

    def _law(self, name: str) -> tuple[str, Material]:
        found = [one for one in self.root.findall("Material/material") if one.get("name") == name]
        if not found or found[0].get("type") not in READ_LAWS:
            kind = found[0].get("type") if found else "none"
            raise self.refuse(f"material {name}: {kind} is not read; read are {', '.join(sorted(READ_LAWS))}")
        kind = str(found[0].get("type"))
        what = f"material {name} (id {found[0].get('id')})"
        law, constants = READ_LAWS[kind]
        self.only(found[0], f"{constants} density pressure_model", what)
        told = {one.tag: one.text for one in found[0]}
        model = (told.pop("pressure_model", None) or DEFAULT_MODEL[0]).strip()
        values = {tag: self.number(text, f"{what}: {tag}") for tag, text in told.items()}
        if model not in DEFAULT_MODEL:
            raise self.refuse(f"{what}: another pressure_model than FEBio's default is not read")
        try:
            return kind, law(values)
        except KeyError as error:
            raise self.refuse(f"{what}: {error.args[0]} is missing") from None
        except FemError as error:
            raise self.refuse(f"{what}: {error}") from error

    def _set(self, name: str | None, place: dict[int, int]) -> list[int]:
        """Places of the nodes of a set, those of rigid bodies apart: `<n id=.../>` each, or numbers between commas."""
        for one in self.root.findall("Mesh/NodeSet"):
            if one.get("name") == name:
                numbers = [self.number(n.get("id"), f"NodeSet {name}") for n in one.findall("n")]
                listed = self.row(one.text, f"NodeSet {name}") if (one.text or "").strip() else []
                soft = [number for number in (*numbers, *listed) if int(number) not in self._rigid]
                return [self._place(number, place, f"NodeSet {name}") for number in soft]
        raise self.refuse(f"there is no NodeSet {name}")

    def _axes(self, text: str | None, what: str) -> list[int]:
        words = [word.strip() for word in (text or "").split(",")]
        if not set(words) <= set(AXES):
            raise self.refuse(f"{what}: {text!r}: must be displacements, of {', '.join(AXES)}")
        return [AXES.index(word) for word in words]

    def _support(self, one: ElementTree.Element, place: dict[int, int], held: np.ndarray, moved: np.ndarray) -> None:
        kind, what = one.get("type", ""), f"bc {one.get('name')}"
        if kind == "linear constraint":
            return
        if kind not in ("fix", "zero displacement", "prescribe", "prescribed displacement"):
            raise self.refuse(f"{what}: type {kind!r} is not read")
        self.only(one, PARTS[kind], what)
        nodes = self._set(one.get("node_set"), place)
        if kind == "fix":
            held[np.ix_(self._axes(one.findtext("dofs"), what), nodes)] = True
        elif kind == "zero displacement":
            axes = [n for n, axis in enumerate(AXES) if self.number(one.findtext(f"{axis}_dof") or "0", what) != 0.0]
            held[np.ix_(axes, nodes)] = True
        else:
            amount = self.scaled(one.find("scale" if kind == "prescribe" else "value"), what)
            moved[np.ix_(self._axes(one.findtext("dof"), what), nodes)] = amount

    def _force(self, one: ElementTree.Element, place: dict[int, int], force: np.ndarray) -> None:
        what = f"{one.tag} {one.get('name')}"
        if one.tag != "nodal_load" or one.get("type") not in ("nodal_load", None):
            raise self.refuse(f"{what}: type {one.get('type')!r} is not read")
        self.only(one, "dof scale relative", what)
        if self.number(one.findtext("relative") or "0", what) != 0.0:
            raise self.refuse(f"{what}: relative = {one.findtext('relative')}: only 0 is read")
        nodes = self._set(one.get("node_set"), place)
        force[np.ix_(self._axes(one.findtext("dof"), what), nodes)] += self.scaled(one.find("scale"), what)

    def scaled(self, one: ElementTree.Element | None, what: str) -> float:
        """A value times its load curve at the end."""
        if one is None:
            raise self.refuse(f"{what}: no value")
        value, curve = self.number(one.text, what), one.get("lc")
        return value if curve is None else value * self._curve(curve)

    def _curve(self, number: str) -> float:
        """Value of a load curve at the end."""
        what = f"load_controller {number}"
        for one in self.root.findall("LoadData/load_controller"):
            if one.get("id") == number:
                if one.get("type", "loadcurve") != "loadcurve":
                    raise self.refuse(f"{what}: type {one.get('type')!r} is not read")
                self.only(one, "interpolate extend points point pt", what)
                points = [self.row(p.text, what) for p in one.iter() if p.tag in ("point", "pt")]
                if not points or any(len(point) != 2 for point in points):
                    raise self.refuse(f"{what}: must have points of time and value")
                time, value = np.array(sorted(points)).T
                if (np.diff(time) <= 0.0).any():
                    raise self.refuse(f"{what}: two points at one time are not read")
                return self._value(one, what, time, value)
        raise self.refuse(f"there is no {what}")

    def _value(self, one: ElementTree.Element, what: str, time: np.ndarray, value: np.ndarray) -> float:
        """A curve's value at the end: its point's there, or between and outside its points as the file says."""
        inside, outside = (
            (one.findtext(word) or one.get(word) or usual).strip().upper()
            for word, usual in (("interpolate", "LINEAR"), ("extend", "CONSTANT"))
        )
        end, near = self._end(), AT_POINT * np.ptp(time)
        if len(time) == 1 or abs(end - time[0]) <= near or abs(end - time[-1]) <= near:
            return float(np.interp(end, time, value))
        within = time[0] < end < time[-1]
        if inside != "LINEAR" and (within or outside != "CONSTANT"):
            raise self.refuse(f"{what}: interpolate {inside} is not read, only LINEAR")
        if within or outside == "CONSTANT":
            return float(np.interp(end, time, value))
        if outside != "EXTRAPOLATE":
            raise self.refuse(f"{what}: extend {outside} is not read, only CONSTANT and EXTRAPOLATE")
        last = slice(0, 2) if end < time[0] else slice(-2, None)
        (before, after), (low, high) = time[last], value[last]
        return float(low + (high - low) * (end - before) / (after - before))

    def _end(self) -> float:
        return self._steps() * self.number(self.root.findtext("Control/step_size"), "Control: step_size")

    def _steps(self) -> int:
        steps = self.number(self.root.findtext("Control/time_steps"), "Control: time_steps")
        if steps < 1.0 or steps != round(steps):
            raise self.refuse(f"Control: time_steps = {steps:g}: must be a whole number from 1 on")
        return round(steps)

    def _constraints(self, place: dict[int, int]) -> Iterator[Constraint]:
        for one in self._each("Boundary", "bc"):
            if one.get("type") == "linear constraint":
                self.only(one, "node dof child_dof offset", "linear constraint")
                if self.number(one.findtext("offset") or "0", "linear constraint: offset") != 0.0:
                    raise self.refuse(f"linear constraint: offset = {one.findtext('offset')}: only 0 is read")
                component, node, _ = self._term(one, place)
                yield Constraint(component, node, tuple(self._term(child, place) for child in one.findall("child_dof")))

    def _term(self, one: ElementTree.Element, place: dict[int, int]) -> tuple[int, int, float]:
        what = "linear constraint"
        if one.tag == "child_dof":
            self.only(one, "node dof value", f"{what}: child_dof")
        if any("lc" in part.attrib for part in one):
            raise self.refuse(f"{what}: a load curve of it is not read")
        axis = self._axes(one.findtext("dof"), what)[0]
        node = self._place(self.number(one.findtext("node"), what), place, what)
        return axis, node, self.number(one.findtext("value") or "1", what)
