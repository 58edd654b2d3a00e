"""Sub-layers: as many as it takes, where it takes them.

The stack starts with one quadratic sub-layer a layer; those that contribute most to the error against the exact
static stiffness are halved until every layer's deflection is right to the tolerance, on the axis and beside the tool.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.domains.domain import Endless, endless
from wavemodel.layered.stack.compliance import compliance, every_face, exact_faces, quadratic_faces
from wavemodel.layered.stack.laminate import Laminate, laminate
from wavemodel.layered.tractions import Traction
from wavemodel.layered.window import Taper
from wavemodel.specimen import WaveLayer

TOLERANCE = 0.0005
"""Of each layer's peak."""
MOST_SUBLAYERS = 48

Fractions: TypeAlias = tuple[tuple[float, ...], ...]
"""For each layer the parts of its thickness from its top down."""


@dataclass(frozen=True)
class Yardstick:
    """The part of a load that the modes carry, and where its effect is watched.

    Attributes
    ----------
    line
        Quadrature of q wavenumbers, its weights times the share of the modes.
    load
        (q, 2) along U and W.
    radius
        (R,) distances from the axis, m.
    """

    line: Endless
    load: FloatArray
    radius: FloatArray


def yardstick(whole: Laminate, load: Traction, taper: Taper, lowest: float) -> Yardstick:
    """Watch a load on the axis, under the tool and beside it.

    Parameters
    ----------
    whole
        The stack.
    load
        Contact traction.
    taper
        Share of the modes.
    lowest
        Wavenumbers below that of the window's first mode (rad/m) do not count.
    """
    radius = load.basis.radius
    line = endless(max(taper.limit, 1.5 * lowest), 3.0 * radius + min(whole.height, 10.0 * radius))
    kept = line.wavenumber >= lowest
    k = line.wavenumber[kept]
    watched = np.array([0.0, 0.5, 1.0, 2.0]) * radius
    return Yardstick(Endless(k, line.weight[kept] * taper.modes(k)), load.transform(k), watched)


def uniform(counts: Sequence[int]) -> Fractions:
    """Equal parts, so many in each layer."""
    return tuple((1.0 / count,) * count for count in counts)


def automatic(
    layers: Sequence[WaveLayer], base: str, measure: Yardstick, tension: FloatArray | None = None
) -> Fractions:
    """Halve sub-layers until the deflection of every layer is right to `TOLERANCE` of its peak."""
    fractions = uniform([1] * len(layers))
    while sum(map(len, fractions)) < MOST_SUBLAYERS:
        stack = laminate(layers, fractions, base, tension)
        if error(stack, measure) <= TOLERANCE:
            break
        fractions = _halve(fractions, _blame(stack, measure))
    return fractions


def error(stack: Laminate, measure: Yardstick) -> float:
    """Largest error of a layer's deflection over its peak, against the exact static stiffness."""
    ours, exact = (
        measure.line.at_radius(
            compliance(measure.line.wavenumber, stack, stiffness).respond(measure.load)[..., 1].T, measure.radius
        )
        for stiffness in (quadratic_faces, exact_faces)
    )
    return float((np.abs(ours - exact).max(axis=1) / np.abs(exact).max(axis=1)).max())


def _blame(stack: Laminate, measure: Yardstick) -> FloatArray:
    """(S,) what each sub-layer adds, to first order, to the error of the surface at any of the watched points."""
    k = measure.line.wavenumber
    blocks = exact_faces(k, stack)
    face = every_face(stack, blocks)[..., 1]
    both = np.concatenate([face[:, :-1], face[:, 1:]], axis=-1)
    wrong = quadratic_faces(k, stack) - blocks
    work = np.einsum("nsi,nsij,nsj->sn", both, wrong, both, optimize=True)
    return np.asarray(np.abs(measure.line.at_radius(work * measure.load[:, 1], measure.radius)).max(axis=1))


def _halve(fractions: Fractions, blame: FloatArray) -> Fractions:
    """Halve the sub-layers that carry more than half of the largest blame."""
    chosen = iter(blame > blame.max() / 2.0)
    return tuple(
        tuple(part for whole in parts for part in ((whole / 2.0,) * 2 if next(chosen) else (whole,)))
        for parts in fractions
    )
