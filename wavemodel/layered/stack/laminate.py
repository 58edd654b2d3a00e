"""The stack of layers as it is cut into sub-layers: plain arrays, from the surface down."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.errors import WaveError
from wavemodel.specimen import StrainEnergy, WaveLayer

BASES = ("bonded", "free")


@dataclass(frozen=True)
class Laminate:
    """S sub-layers of L layers.

    Attributes
    ----------
    thickness, shear_modulus, lame_modulus, density
        (S,) in m, Pa, Pa and kg/m3.
    top_of_layer
        (L,) index of the sub-layer whose upper face is the layer's top face.
    base
        "bonded" (no motion of the lowest face) or "free".
    tension
        In-plane tensile stress before the press, Pa: None, (S,), or (n, S) for n wavenumbers whose directions see
        different stresses.
    laws
        (L,) of each layer at finite strain; None: neo-Hookean. Empty: all are.
    """

    thickness: FloatArray
    shear_modulus: FloatArray
    lame_modulus: FloatArray
    density: FloatArray
    top_of_layer: IntArray
    base: str
    tension: FloatArray | None = None
    laws: tuple[StrainEnergy | None, ...] = ()

    def at(self, wavenumbers: IntArray) -> "Laminate":
        """The stack as some of the wavenumbers see it."""
        if self.tension is None or self.tension.ndim == 1:
            return self
        return replace(self, tension=self.tension[wavenumbers])

    @property
    def sublayers(self) -> int:
        """S."""
        return int(self.thickness.size)

    @property
    def unknowns_per_mode(self) -> int:
        """Four a sub-layer (upper face and mid-plane, U and W), two more with a free lower face."""
        return 4 * self.sublayers + (2 if self.base == "free" else 0)

    @property
    def height(self) -> float:
        """Of the whole stack, m."""
        return float(self.thickness.sum())


def laminate(
    layers: Sequence[WaveLayer],
    fractions: Sequence[Sequence[float]],
    base: str,
    tension: FloatArray | None = None,
) -> Laminate:
    """Cut the layers into sub-layers.

    Parameters
    ----------
    layers
        L layers from the surface down.
    fractions
        For each layer the parts of its thickness, from its top down; each list sums to one.
    base
        "bonded" or "free".
    tension
        (L,) in-plane tensile stress before the press, Pa.

    Raises
    ------
    WaveError
        If there is no layer, or the base is neither word.
    """
    if not layers:
        raise WaveError("layers: none given, at least one is needed")
    if base not in BASES:
        raise WaveError(f"base = {base!r} is not allowed: one of {', '.join(BASES)}")
    counts = [len(parts) for parts in fractions]
    return Laminate(
        thickness=np.concatenate(
            [layer.thickness * np.asarray(parts) for layer, parts in zip(layers, fractions, strict=True)]
        ),
        shear_modulus=np.repeat([layer.shear_modulus for layer in layers], counts),
        lame_modulus=np.repeat([layer.lame_modulus for layer in layers], counts),
        density=np.repeat([layer.density for layer in layers], counts),
        top_of_layer=np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(np.intp),
        base=base,
        tension=None if tension is None else np.repeat(tension, counts),
        laws=tuple(layer.law for layer in layers),
    )
