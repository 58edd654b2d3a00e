"""Polynomials through the thickness of a sheet: each layer whole or cut near the sheet's faces, which are held.

Each piece has a polynomial of degree 2 to 4 between Lobatto's points and as many Gauss points as its degree: that is
full integration of the slopes and leaves no volumetric locking, as two points do in the quadratic sub-layers.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from wavemodel.arrays import FloatArray
from wavemodel.layered.finite_strain.modal_body import Thickness, law_columns
from wavemodel.specimen import WaveLayer

CUT, LEAST = 0.15, 0.03
"""Of the sheet's thickness: how far from its faces a layer is cut, and the thinnest piece that this may leave."""
THIN, MIDDLING = 0.05, 0.3
"""Of the same: pieces thinner than these have degree 2 and 3, the others 4."""


@dataclass(frozen=True)
class Piece:
    """A polynomial.

    Attributes
    ----------
    nodes, points
        Its nodes and Gauss points among all.
    """

    nodes: slice
    points: slice


@dataclass(frozen=True)
class SheetThickness(Thickness):
    """Functions from the upper to the lower face of a sheet, both free.

    Attributes
    ----------
    pieces
        The polynomials.
    """

    pieces: tuple[Piece, ...]


def sheet_thickness(layers: Sequence[WaveLayer]) -> SheetThickness:
    """Cut the layers, from the surface down."""
    cuts = [_cuts(layers, index) for index in range(len(layers))]
    heights = [(layer, height) for layer, ends in zip(layers, cuts, strict=True) for height in np.diff(ends).tolist()]
    total = sum(layer.thickness for layer in layers)
    degrees = [2 if height < THIN * total else 3 if height < MIDDLING * total else 4 for _, height in heights]
    first = np.concatenate([[0], np.cumsum(degrees)])
    shape, slope = np.zeros((first[-1], first[-1] + 1)), np.zeros((first[-1], first[-1] + 1))
    weight, pieces = np.empty(first[-1]), []
    for start, degree, (_, height) in zip(first[:-1].tolist(), degrees, heights, strict=True):
        piece = Piece(slice(start, start + degree + 1), slice(start, start + degree))
        point, share = legendre.leggauss(degree)
        value, rate = _lagrange(point, degree)
        shape[piece.points, piece.nodes], slope[piece.points, piece.nodes] = value, rate * 2.0 / height
        weight[piece.points] = 0.5 * height * share
        pieces.append(piece)
    shear = np.repeat([layer.shear_modulus for layer, _ in heights], degrees)
    lame = np.repeat([layer.lame_modulus for layer, _ in heights], degrees)
    per_layer = np.cumsum([0, *(ends.size - 1 for ends in cuts)])
    faces = first[per_layer].astype(np.intp)
    laws = law_columns([layer.law for layer in layers], faces.tolist())
    return SheetThickness(shape, slope, weight, shear, lame + 2.0 / 3.0 * shear, faces, laws, tuple(pieces))


def _cuts(layers: Sequence[WaveLayer], index: int) -> FloatArray:
    """Ends of the pieces of one layer below the sheet's upper face, m."""
    heights = [layer.thickness for layer in layers]
    total, top = sum(heights), sum(heights[:index])
    bottom, spare = top + heights[index], LEAST * sum(heights)
    inner = [z for z in (CUT * total, (1.0 - CUT) * total) if top + spare < z < bottom - spare]
    return np.array([top, *inner, bottom])


def _lagrange(point: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """Values and slopes (points, degree + 1) of Lagrange's polynomials on Lobatto's nodes in [-1, 1]."""
    unit = np.eye(degree + 1)
    inner = np.sort(np.real(legendre.legroots(legendre.legder(unit[degree]))))
    inverse = np.linalg.inv(legendre.legvander(np.concatenate([[-1.0], inner, [1.0]]), degree))
    rate = np.stack([legendre.legval(point, legendre.legder(one)) for one in unit], axis=1)
    return np.asarray(legendre.legvander(point, degree) @ inverse), np.asarray(rate @ inverse)
