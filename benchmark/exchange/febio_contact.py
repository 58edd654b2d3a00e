"""Contact with rigid surfaces in FEBio's input files, as :mod:`fem.verification.rigid_contact` solves it.

Read are `rigid_wall` (a plane) and `sliding-node-on-facet` of a body on flat facets of a rigid body that is held or
moves without turning, both without friction, by the file's own penalty, automatic or not, and its augmentation. The
rest is refused by its name. Written after FEBio's manuals, and its source where they are silent.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Protocol
from xml.etree import ElementTree

import numpy as np

from benchmark.errors import InputError
from fem import Material
from fem.arrays import FloatArray, IntArray
from fem.materials.neo_hookean import CoupledNeoHookean
from fem.verification.constrained_body import ConstrainedBody, Contact
from fem.verification.rigid_contact import (
    Augmentation,
    RigidContact,
    RigidFacets,
    RigidPlane,
    RigidSurface,
    facet_normal,
    nodal_area,
)

RIGID = "rigid body"
TURNS, SHIFTS = ("Ru_dof", "Rv_dof", "Rw_dof"), ("Rx_dof", "Ry_dof", "Rz_dof")
MUST_BE_ZERO = ("fric_coeff", "two_pass", "node_reloc", "seg_up", "search_radius", "update_penalty", "gaptol")
WALL = "laugon tolerance penalty auto_penalty plane offset"
PAIR = " ".join(
    (*MUST_BE_ZERO, "laugon tolerance penalty auto_penalty search_tol minaug maxaug knmult ktmult fric_penalty")
)
"""What a wall and a pair of surfaces may have; the last three do not act without friction, at equilibrium."""
PENALTY_ALONE, AUGMENTED = ("PENALTY", "0"), ("AUGLAG", "1")
SEARCH_TOLERANCE, MOST_AUGMENTATIONS = 0.01, 10
FLAT = 1e-6
"""A facet's corners may be off its plane by this part of its size."""


class Source(Protocol):
    """What of the file's reader the contact needs."""

    @property
    def root(self) -> ElementTree.Element:
        """The file's root."""

    def refuse(self, what: str) -> InputError:
        """The error to raise."""

    def number(self, text: str | None, what: str) -> float:
        """A finite number."""

    def row(self, text: str | None, what: str) -> list[float]:
        """Numbers between commas."""

    def only(self, one: ElementTree.Element, known: str, what: str) -> None:
        """Refuse what an element has beside what is known, words between blanks."""

    def scaled(self, one: ElementTree.Element | None, what: str) -> float:
        """A value times its load curve at the end."""


def rigid_materials(source: Source) -> frozenset[str]:
    """Names of the materials that are rigid bodies."""
    found = source.root.findall("Material/material")
    return frozenset(one.get("name") or "" for one in found if one.get("type") == RIGID)


def rigid_motions(source: Source) -> Mapping[str, FloatArray]:
    """Displacements (3,) of each rigid body under the full load.

    Raises
    ------
    InputError
        A rigid body that is free to move or turns, or another condition on one.
    """
    motions = {name: np.full(3, np.nan) for name in rigid_materials(source)}
    turning = dict.fromkeys(motions, True)
    for one in source.root.findall("Rigid/*"):
        what, body = f"{one.tag} {one.get('name')}", (one.findtext("rb") or "").strip()
        if one.tag != "rigid_bc" or one.get("type") not in ("rigid_fixed", "rigid_displacement"):
            raise source.refuse(f"{what}: type {one.get('type')!r} is not read")
        if body not in motions:
            raise source.refuse(f"{what}: {body} is no material of type {RIGID}")
        if one.get("type") == "rigid_fixed":
            source.only(one, " ".join(("rb", *SHIFTS, *TURNS)), what)
            still = [source.number(one.findtext(name) or "0", what) != 0.0 for name in (*SHIFTS, *TURNS)]
            motions[body][still[:3]] = 0.0
            turning[body] = turning[body] and not all(still[3:])
            continue
        source.only(one, "rb dof value relative", what)
        axis = (one.findtext("dof") or "").strip()
        if axis not in ("x", "y", "z") or source.number(one.findtext("relative") or "0", what) != 0.0:
            raise source.refuse(f"{what}: must move absolutely along x, y or z")
        motions[body]["xyz".index(axis)] = source.scaled(one.find("value"), what)
    for body, motion in motions.items():
        if turning[body] or np.isnan(motion).any():
            raise source.refuse(f"rigid body {body}: must be held or moved along x, y and z, and not turn")
    return motions


@dataclass(frozen=True)
class ContactReader:
    """Reads the contacts of a file.

    Attributes
    ----------
    source
        The file.
    place
        Place in the body of each of its nodes by number.
    rigid
        Rigid body of each node that has one, by number.
    points
        Where each node is, by number.
    """

    source: Source
    place: Mapping[int, int]
    rigid: Mapping[int, str]
    points: Mapping[int, FloatArray]

    def contacts(self, body: ConstrainedBody) -> tuple[Contact, ...]:
        """All of them.

        Raises
        ------
        InputError
            What is not covered, by its name.
        """
        motions = rigid_motions(self.source)
        walls = (self._wall(one, body) for one in self.source.root.findall("Constraints/*"))
        pairs = (self._pair(one, body, motions) for one in self.source.root.findall("Contact/*"))
        return (*walls, *pairs)

    def _wall(self, one: ElementTree.Element, body: ConstrainedBody) -> Contact:
        what = f"{one.tag} {one.get('name')}"
        if one.get("type") != "rigid_wall":
            raise self.source.refuse(f"{what}: type {one.get('type')!r} is not read")
        self.source.only(one, WALL, what)
        equation = np.array(self.source.row(one.findtext("plane"), f"{what}: plane"))
        if equation.shape != (4,) or not equation[:3].any():
            raise self.source.refuse(f"{what}: plane must be a normal and a distance")
        offset = one.find("offset")
        plane = RigidPlane(equation, 0.0 if offset is None else self.source.scaled(offset, what))
        return self._touching(one, what, one.get("surface"), body, plane)

    def _pair(self, one: ElementTree.Element, body: ConstrainedBody, motions: Mapping[str, FloatArray]) -> Contact:
        what = f"{one.tag} {one.get('name')}"
        if one.get("type") != "sliding-node-on-facet":
            raise self.source.refuse(f"{what}: contact of type {one.get('type')!r} is not read")
        self.source.only(one, PAIR, what)
        for name in MUST_BE_ZERO:
            if self.source.number(one.findtext(name) or "0", f"{what}: {name}") != 0.0:
                raise self.source.refuse(f"{what}: {name} = {one.findtext(name)}: only 0 is read")
        pairs = [p for p in self.source.root.findall("Mesh/SurfacePair") if p.get("name") == one.get("surface_pair")]
        if not pairs:
            raise self.source.refuse(f"{what}: there is no SurfacePair {one.get('surface_pair')}")
        facets = list(self._surface(pairs[0].findtext("secondary")))
        bodies = {self.rigid.get(number, "") for facet in facets for number in facet}
        if len(bodies) != 1 or "" in bodies:
            raise self.source.refuse(f"{what}: the secondary surface must be of one rigid body")
        margin = self.source.number(one.findtext("search_tol") or str(SEARCH_TOLERANCE), f"{what}: search_tol")
        flat = tuple(self._flat(facet, what) for facet in facets)
        rigid = RigidFacets(flat, motions[bodies.pop()], margin)
        return self._touching(one, what, pairs[0].findtext("primary"), body, rigid)

    def _flat(self, facet: list[int], what: str) -> FloatArray:
        corners = np.array([self.points[number] for number in facet])
        off = np.abs((corners - corners[0]) @ facet_normal(corners)).max()
        if off > FLAT * np.ptp(corners, axis=0).max():
            raise self.source.refuse(f"{what}: the rigid facet {facet} is {off:g} off its plane: must be flat")
        return corners

    def _surface(self, name: str | None) -> Iterator[list[int]]:
        """Numbers of the nodes of each facet."""
        found = [one for one in self.source.root.findall("Mesh/Surface") if one.get("name") == (name or "").strip()]
        if not found or not len(found[0]):
            raise self.source.refuse(f"there is no Surface {name}")
        for one in found[0]:
            what = f"Surface {name}: {one.tag} {one.get('id')}"
            facet = [int(number) for number in self.source.row(one.text, what)]
            if {"quad4": 4, "tri3": 3}.get(one.tag) != len(facet) or not self.points.keys() >= set(facet):
                raise self.source.refuse(f"{what}: must be a quad4 or tri3 of nodes that there are")
            yield facet

    def _touching(
        self, one: ElementTree.Element, what: str, name: str | None, body: ConstrainedBody, surface: RigidSurface
    ) -> Contact:
        facets = list(self._surface(name))
        if not self.place.keys() >= {number for facet in facets for number in facet}:
            raise self.source.refuse(f"{what}: the surface {name} must be of the body, not of a rigid one")
        numbers = [np.array([self.place[number] for number in facet]) for facet in facets]
        nodes, area, modulus = np.unique(np.concatenate(numbers)), np.zeros(len(body.nodes)), np.zeros(len(body.nodes))
        times = np.zeros(len(body.nodes))
        stiff = self.source.number(one.findtext("auto_penalty") or "0", f"{what}: auto_penalty") != 0.0
        for facet in numbers:
            area[facet] += nodal_area(body.nodes[facet])
            modulus[facet] += _automatic(body, facet) if stiff else 1.0
            times[facet] += 1.0
        penalty = self.source.scaled(one.find("penalty"), f"{what}: penalty") * modulus[nodes] / times[nodes]
        return RigidContact(nodes, body.nodes[nodes], area[nodes], penalty, surface, self._augmentation(one, what))

    def _augmentation(self, one: ElementTree.Element, what: str) -> Augmentation | None:
        word = (one.findtext("laugon") or PENALTY_ALONE[0]).strip()
        if word in PENALTY_ALONE:
            return None
        if word not in AUGMENTED:
            raise self.source.refuse(f"{what}: laugon {word!r} is not read; read are PENALTY and AUGLAG")
        tolerance = self.source.number(one.findtext("tolerance"), f"{what}: tolerance")
        if one.get("type") == "rigid_wall":
            return Augmentation(tolerance)
        least, most = (
            round(self.source.number(one.findtext(name) or str(default), f"{what}: {name}"))
            for name, default in (("minaug", 0), ("maxaug", MOST_AUGMENTATIONS))
        )
        return Augmentation(tolerance, least, most)


def _automatic(body: ConstrainedBody, facet: IntArray) -> float:
    """Young's modulus times the facet's area over its element's volume (theory manual, 7.1.7)."""
    element = int(np.flatnonzero(np.isin(body.elements, facet).sum(axis=0) == len(facet))[0])
    law = body.materials[int(body.part[element])]
    volume = float(body.system.elements.geometry.weight[:, element].sum())
    return _youngs_modulus(law) * float(nodal_area(body.nodes[facet]).sum()) / volume


def _youngs_modulus(law: Material) -> float:
    """Young's modulus at rest."""
    if isinstance(law, CoupledNeoHookean):
        return law.youngs_modulus
    return 9.0 * law.bulk_modulus * law.shear_modulus / (3.0 * law.bulk_modulus + law.shear_modulus)
