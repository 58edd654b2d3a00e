"""The blind cases: which effect is hidden in which session, drawn from a seed and from nothing else, and the suites."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from benchmark.blind.hidden import CATALOGUE, OUTSIDE, Hidden
from benchmark.blind.motion import PressPlan
from benchmark.blind.scene import Noise, Scene
from benchmark.blind.simulate import FaceMarkers
from benchmark.blind.specimens import SHEETS, SKINS, TrueBody, TrueShape
from benchmark.blind.strength import Base, TrueCells, base_of, scaled_to, strength, true_cells
from benchmark.errors import InputError

CaseKind = Literal["effect", "null", "pair", "outside"]
CaseLayout = Literal["two_conditions", "one_condition", "force_only"]

FULL_SEED_CYCLE = 5
"""Of each five seeds three have two conditions and markers, one has no markers, and one has a single condition."""
STRONG, STRONGER = 20.0, 40.0
PAIRS = (
    "viscoelastic_relaxation+machine_compliance",
    "strain_stiffening+viscoelastic_relaxation",
    "dry_friction+force_drift",
    "stress_softening+camera_latency",
    "permanent_set+perspective",
    "backlash+viscous_damping",
    "adhesion+anisotropy",
    "tool_inertia+interface_slip",
    "contact_gap+off_centre_load",
    "poroelastic_drainage+marker_scale_error",
)
"""Pairs of effects that act in different ways; each has both at full strength."""
SUITES = ("small", "first", "medium", "full")


@dataclass(frozen=True)
class CaseName:
    """What makes a case.

    Attributes
    ----------
    kind : str
        "effect", "null", "pair" or "outside".
    slug : str
        Of the effect; two with a + between for a pair; "" for a null.
    seed : int
    strength : float
        D of each effect, in standard deviations of the trial mean.
    wrong_layers : bool
        Whether the session tells each layer's modulus and thickness as a laboratory knows them, not as they are.
    print_scatter : float
        Standard deviation by which each marker is printed off its grid, along x and along y, m.
    """

    kind: CaseKind
    slug: str
    seed: int
    strength: float = 20.0
    wrong_layers: bool = False
    print_scatter: float = 0.0

    @property
    def text(self) -> str:
        """Unique among the cases."""
        printed = f":print{1e3 * self.print_scatter:g}mm" if self.print_scatter else ""
        return self.truth + (":wrong-layers" if self.wrong_layers else "") + printed

    @property
    def truth(self) -> str:
        """What the true world is drawn from, whatever the session tells of it and however its markers are printed."""
        return f"{self.kind}:{self.slug or '-'}:{self.seed}:D{self.strength:g}"

    @property
    def slugs(self) -> tuple[str, ...]:
        """Of the hidden effects."""
        return tuple(self.slug.split("+")) if self.slug else ()

    @property
    def alias(self) -> str:
        """What a session may be called without giving anything away."""
        return "blind-" + hashlib.sha256(self.text.encode()).hexdigest()[:12]


@dataclass(frozen=True)
class BlindCase:
    """A case ready to be written: scene, hidden effects at their strength, and where they show."""

    name: CaseName
    scene: Scene
    effects: tuple[Hidden, ...]
    cells: TrueCells
    strength: float
    gain_scatter: float
    bad_trial: str


def make_case(name: CaseName) -> BlindCase:
    """Draw a case; the same name gives the same case.

    Raises
    ------
    ValueError
        When an effect cannot be as strong as wanted.
    """
    rng = generator(name, "case")
    scene = draw_scene(name, rng)
    base = base_of(scene)
    effects = tuple(_hide(scene, base, slug, name, rng) for slug in name.slugs)
    together = strength(scene, base, effects) if effects else 0.0
    bad = str(rng.choice(["", "", "", "", "spike", "dropout", "shaky"]))
    gain_scatter = float(rng.choice([0.02, 0.03, 0.05, 0.1]))
    return BlindCase(name, scene, effects, true_cells(scene, base, effects), together, gain_scatter, bad)


def generator(name: CaseName, purpose: str) -> np.random.Generator:
    """A random generator of one case and one purpose."""
    digest = hashlib.sha256(f"{name.truth} {purpose}".encode()).digest()
    return np.random.default_rng(int.from_bytes(digest[:8], "big"))


def layout(name: CaseName) -> CaseLayout:
    """Conditions and channels of a case; effects that only a camera sees keep it."""
    place = name.seed % FULL_SEED_CYCLE
    if place == 4:
        return "one_condition"
    seen_by_camera = any((CATALOGUE | OUTSIDE)[slug].only_markers for slug in name.slugs)
    return "force_only" if place == 3 and not seen_by_camera else "two_conditions"


def draw_scene(name: CaseName, rng: np.random.Generator) -> Scene:
    """Body, protocol and noise of a case."""
    chosen = layout(name)
    specimens = SKINS if chosen == "force_only" else SHEETS
    specimen = specimens[int(rng.integers(len(specimens)))]
    body = TrueBody(specimen, _shape(rng, wrong=name.kind != "null" or name.seed % 2 == 1))
    plans = _plans(rng, single=chosen == "one_condition")
    peak = float(body.force(np.array([max(plan.depth for plan in plans)]))[0])
    return Scene(
        body=body,
        plans=plans,
        repeats=10 if chosen == "one_condition" else 5,
        grid=_grid(name) if specimen.has_markers else None,
        rate=float(rng.choice([100.0, 125.0, 200.0])),
        frame_rate=30.0,
        force_noise=Noise(peak * float(rng.uniform(0.005, 0.02)), float(rng.uniform(0.5, 0.95))),
        marker_noise=Noise(float(rng.uniform(0.005e-3, 0.02e-3)), float(rng.uniform(0.5, 0.95))),
    )


def _grid(name: CaseName) -> FaceMarkers:
    """The markers as they were printed on the sheet of all trials."""
    grid = FaceMarkers()
    if not name.print_scatter:
        return grid
    off = generator(name, "print").normal(0.0, name.print_scatter, (grid.rows * grid.columns, 2))
    return replace(grid, off=tuple((x, y) for x, y in off.tolist()))


def _shape(rng: np.random.Generator, *, wrong: bool) -> TrueShape:
    """A modulus that nobody knows, and a shape that is not the told one where `wrong`."""
    modulus = float(np.exp(rng.normal(0.0, 0.25)))
    radius, exponent, width = (rng.uniform(-1.0, 1.0, 3) * (0.1, 0.05, 0.05)).tolist()
    return TrueShape(modulus, 1.0 + radius, exponent, 1.0 + width) if wrong else TrueShape(modulus)


def _plans(rng: np.random.Generator, *, single: bool) -> tuple[PressPlan, ...]:
    """A slow shallow and a fast deep condition, or one between them."""
    shallow, deep = float(rng.uniform(1.7e-3, 2.2e-3)), float(rng.uniform(2.8e-3, 3.4e-3))
    slow, fast = float(rng.uniform(0.8e-3, 1.2e-3)), float(rng.uniform(4e-3, 6e-3))
    hold, rest = float(rng.uniform(4.0, 7.0)), float(rng.uniform(4.0, 7.0))
    if single:
        return (PressPlan("press", deep, 2.0 * slow, hold, rest),)
    return PressPlan("slow", shallow, slow, hold, rest), PressPlan("fast", deep, fast, hold, rest)


def _hide(scene: Scene, base: Base, slug: str, name: CaseName, rng: np.random.Generator) -> Hidden:
    effect = (CATALOGUE | OUTSIDE)[slug].draw(scene.scale, rng)
    return scaled_to(scene, base, effect, name.strength)


def suite(name: str, seed: int = 0) -> tuple[CaseName, ...]:
    """The cases of a suite.

    Parameters
    ----------
    name : str
        "small": 4 nulls and each effect once. "first": each effect with 5 seeds and 40 nulls. "medium" adds pairs
        (2 seeds) and effects outside the catalogue (4 seeds, stronger). "full": 10 seeds, 100 nulls, 5 seeds a
        pair, 10 seeds each outside.
    seed : int
        Of the first case of each kind; the others follow it.

    Raises
    ------
    InputError
        There is no such suite.
    """
    if name not in SUITES:
        raise InputError(f"--suite {name!r}: there is no such suite; allowed: {', '.join(SUITES)}")
    effects, nulls, pairs, outside = {
        "small": (1, 4, 0, 0),
        "first": (5, 40, 0, 0),
        "medium": (5, 40, 2, 4),
        "full": (10, 100, 5, 10),
    }[name]
    return (
        *(CaseName("effect", slug, seed + number, STRONG) for number in range(effects) for slug in CATALOGUE),
        *(CaseName("null", "", seed + number, 0.0) for number in range(nulls)),
        *(CaseName("pair", pair, seed + number, STRONG) for number in range(pairs) for pair in PAIRS),
        *(CaseName("outside", slug, seed + number, STRONGER) for number in range(outside) for slug in OUTSIDE),
    )


def chosen(cases: tuple[CaseName, ...], slugs: tuple[str, ...]) -> tuple[CaseName, ...]:
    """The cases of some effects (by slug, pair or "null"); all without any.

    Raises
    ------
    InputError
        A slug is in no case.
    """
    known = {case.slug or "null" for case in cases}
    for slug in slugs:
        if slug not in known:
            raise InputError(f"--cases {slug!r}: no case of this suite; allowed: {', '.join(sorted(known))}")
    return tuple(case for case in cases if not slugs or (case.slug or "null") in slugs)
