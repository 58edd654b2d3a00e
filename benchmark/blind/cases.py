"""The blind cases: which effect is hidden in which session, drawn from a seed and from nothing else."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from benchmark.blind.body.specimens import SPECIMENS
from benchmark.blind.body.true_body import TrueBody, TrueShape
from benchmark.blind.hidden import CATALOGUE, OUTSIDE, Hidden
from benchmark.blind.labs import AS_TOLD, LABS, LabConditions
from benchmark.blind.motion import PressPlan
from benchmark.blind.scene import Noise, Scene
from benchmark.blind.second_forms import SECOND_CATALOGUE, SECOND_OUTSIDE
from benchmark.blind.simulate import FaceMarkers
from benchmark.blind.strength import Base, TrueCells, base_of, scaled_to, strength, true_cells

CaseKind = Literal["effect", "null", "pair", "outside"]
CaseLayout = Literal["two_conditions", "one_condition", "force_only"]

FULL_SEED_CYCLE = 5
"""Of each five seeds three have two conditions and markers, one has no markers, and one has a single condition."""
FORMS = {"first": CATALOGUE | OUTSIDE, "second": SECOND_CATALOGUE | SECOND_OUTSIDE}
"""The hidden effects of each family by slug."""
FAMILIES = ("first", "second")
NEEDS_UNLOADING = frozenset({"adhesion", "backlash", "dry_friction", "permanent_set", "stress_softening"})
"""Effects that a press without unloading does not show."""
FEW_TRIALS = 6
"""With fewer there is one condition: two of each kind test nothing."""
ATTEMPTS = 8
"""How often the conditions are drawn in which an effect is to be as strong as wanted."""


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
        Standard deviation by which each marker is printed off its grid, along x and along y, m; 0 for the lab's.
    family : str
        Of `FAMILIES`.
    lab : str
        Of `LABS`.
    """

    kind: CaseKind
    slug: str
    seed: int
    strength: float = 20.0
    wrong_layers: bool = False
    print_scatter: float = 0.0
    family: str = "first"
    lab: str = AS_TOLD

    @property
    def text(self) -> str:
        """Unique among the cases."""
        printed = f":print{1e3 * self.print_scatter:g}mm" if self.print_scatter else ""
        return self.truth + (":wrong-layers" if self.wrong_layers else "") + printed

    @property
    def truth(self) -> str:
        """What the true world is drawn from, whatever the session tells of it and however its markers are printed."""
        family = "" if self.family == "first" else f":{self.family}"
        lab = "" if self.lab == AS_TOLD else f":{self.lab}"
        return f"{self.kind}:{self.slug or '-'}:{self.seed}:D{self.strength:g}{family}{lab}"

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

    @cached_property
    def unexplained(self) -> float | None:
        """D of the hidden effect that is weakest beside what the session does not state of the layers; None on a null.

        A discovery must let the base explain as much, since nobody told it more; `strength` counts what is off.
        """
        if not self.effects:
            return None
        scene = replace(self.scene, lab=self.scene.lab.unsure)
        base = base_of(scene)
        return min(strength(scene, base, [effect]) for effect in self.effects)


def make_case(name: CaseName) -> BlindCase:
    """Draw a case; the same name gives the same case.

    Raises
    ------
    ValueError
        When an effect cannot be as strong as wanted.
    """
    for attempt in range(ATTEMPTS):
        again = f" {attempt}" if attempt else ""
        try:
            return _drawn(name, generator(name, f"case{again}"), _conditions(name, generator(name, f"lab{again}")))
        except ValueError:
            if attempt == ATTEMPTS - 1:
                raise
    raise AssertionError


def _drawn(name: CaseName, rng: np.random.Generator, lab: LabConditions) -> BlindCase:
    scene = draw_scene(name, rng, lab)
    base = base_of(scene)
    effects = tuple(_hide(scene, base, slug, name, rng) for slug in name.slugs)
    together = strength(scene, base, effects) if effects else 0.0
    bad = str(rng.choice(["", "", "", "", "spike", "dropout", "shaky"]))
    gain_scatter = lab.stiffness_spread or float(rng.choice([0.02, 0.03, 0.05, 0.1]))
    return BlindCase(name, scene, effects, true_cells(scene, base, effects), together, gain_scatter, bad)


def _conditions(name: CaseName, rng: np.random.Generator) -> LabConditions:
    """The lab's conditions, as far as they can be told from the effect's absence."""
    lab = replace(LABS[name.lab](rng), name=name.lab)
    if not lab.unloading and NEEDS_UNLOADING & set(name.slugs):
        lab = replace(lab, unloading=True)
    return replace(lab, print_scatter=name.print_scatter) if name.print_scatter else lab


def generator(name: CaseName, purpose: str) -> np.random.Generator:
    """A random generator of one case and one purpose."""
    digest = hashlib.sha256(f"{name.truth} {purpose}".encode()).digest()
    return np.random.default_rng(int.from_bytes(digest[:8], "big"))


def layout(name: CaseName) -> CaseLayout:
    """Conditions and channels of a case; effects that only a camera sees keep it."""
    place = name.seed % FULL_SEED_CYCLE
    if place == 4:
        return "one_condition"
    seen_by_camera = any(FORMS[name.family][slug].only_markers for slug in name.slugs)
    return "force_only" if place == 3 and not seen_by_camera else "two_conditions"


def draw_scene(name: CaseName, rng: np.random.Generator, lab: LabConditions | None = None) -> Scene:
    """Body, protocol and noise of a case; without a lab all is as told, but for how markers are printed."""
    lab = LabConditions(print_scatter=name.print_scatter) if lab is None else lab
    chosen = layout(name)
    sheets, skins = SPECIMENS[name.family]
    specimens = skins if chosen == "force_only" else sheets
    specimen = specimens[int(rng.integers(len(specimens)))]
    shape = _shape(rng, wrong=name.kind != "null" or name.seed % 2 == 1)
    body = TrueBody(specimen, shape, name.family, lab.clamp if specimen.has_markers else "plate")
    single = chosen == "one_condition" or 0 < lab.trials < FEW_TRIALS
    plans = tuple(replace(plan, unloading=lab.unloading) for plan in _plans(rng, name.family, single=single))
    peak = float(body.force(np.array([max(plan.depth for plan in plans)]))[0])
    return Scene(
        body=body,
        plans=plans,
        repeats=round((lab.trials or 10) / len(plans)),
        grid=_grid(name, lab) if specimen.has_markers else None,
        rate=float(rng.choice([100.0, 125.0, 200.0])),
        frame_rate=lab.frame_rate,
        force_noise=Noise(peak * float(rng.uniform(0.005, 0.02)), float(rng.uniform(0.5, 0.95))),
        marker_noise=Noise(float(rng.uniform(0.005e-3, 0.02e-3)), float(rng.uniform(0.5, 0.95))),
        lab=lab,
    )


def _grid(name: CaseName, lab: LabConditions) -> FaceMarkers:
    """The markers as they were printed on the sheet of all trials, behind the lab's lens."""
    grid = FaceMarkers(lens=lab.lens)
    if not lab.print_scatter:
        return grid
    off = generator(name, "print").normal(0.0, lab.print_scatter, (grid.rows * grid.columns, 2))
    return replace(grid, off=tuple((x, y) for x, y in off.tolist()))


def _shape(rng: np.random.Generator, *, wrong: bool) -> TrueShape:
    """A modulus that nobody knows, and a shape that is not the told one where `wrong`."""
    modulus = float(np.exp(rng.normal(0.0, 0.25)))
    radius, exponent, width = (rng.uniform(-1.0, 1.0, 3) * (0.1, 0.05, 0.05)).tolist()
    return TrueShape(modulus, 1.0 + radius, exponent, 1.0 + width) if wrong else TrueShape(modulus)


def _plans(rng: np.random.Generator, family: str, *, single: bool) -> tuple[PressPlan, ...]:
    """A slow shallow and a fast deep condition, or one between them."""
    if family == "second":
        return _second_plans(rng, single=single)
    shallow, deep = float(rng.uniform(1.7e-3, 2.2e-3)), float(rng.uniform(2.8e-3, 3.4e-3))
    slow, fast = float(rng.uniform(0.8e-3, 1.2e-3)), float(rng.uniform(4e-3, 6e-3))
    hold, rest = float(rng.uniform(4.0, 7.0)), float(rng.uniform(4.0, 7.0))
    if single:
        return (PressPlan("press", deep, 2.0 * slow, hold, rest),)
    return PressPlan("slow", shallow, slow, hold, rest), PressPlan("fast", deep, fast, hold, rest)


def _second_plans(rng: np.random.Generator, *, single: bool) -> tuple[PressPlan, ...]:
    """Depths nearer to each other, speeds farther apart, a second press that is less deep, longer rests."""
    shallow, deep = float(rng.uniform(1.9e-3, 2.4e-3)), float(rng.uniform(2.9e-3, 3.5e-3))
    slow, fast = float(rng.uniform(0.7e-3, 1.0e-3)), float(rng.uniform(5e-3, 9e-3))
    hold, rest, second = float(rng.uniform(3.0, 9.0)), float(rng.uniform(3.0, 6.0)), float(rng.uniform(0.75, 1.0))
    if single:
        return (PressPlan("creep", deep, 2.5 * slow, hold, rest, second=second),)
    return (
        PressPlan("gentle", shallow, slow, hold, rest, second=second),
        PressPlan("brisk", deep, fast, hold, rest, second=second),
    )


def _hide(scene: Scene, base: Base, slug: str, name: CaseName, rng: np.random.Generator) -> Hidden:
    effect = FORMS[name.family][slug].draw(scene.scale, rng)
    return scaled_to(scene, base, effect, name.strength)
