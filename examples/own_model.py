"""A fast model of one's own in one file.

    python -m benchmark run skin-5N --wave examples/own_model.py

Foundation engineering adds up the settlement of a layered ground this way (Steinbrenner 1934): each layer is squeezed
by the strain that a half-space of its own stiffness has between the same two depths. Under the centre of a uniform
pressure p on a disc of radius a, a half-space sinks at the depth z by (Boussinesq)

    w(z) = (1 + nu) p a / E * (1 / s + (1 - 2 nu) (s - z / a)),    s = sqrt(1 + (z / a)^2)

Quick and rough: no layer feels its neighbours. What the functions may get and return is in docs/own-model.md.
"""

import numpy as np

NAME = "layer-by-layer squeeze"


def deform(layers, tool, support, _time, force):
    """Deflection (n, L) in m of each layer's top face on the axis, for the force (n,) in N, whenever it acts."""
    return np.outer(force, compliance(layers, tool, support))


def press(layers, tool, support, _time, depth):
    """Force (n,) in N for the depth (n,) in m of the top face; only needed for depth control and measured trials."""
    return depth / compliance(layers, tool, support)[0]


def compliance(layers, tool, support):
    """Deflection (L,) of each layer's top face under a force of 1 N."""
    if support.kind != "bonded":
        raise NotImplementedError(f"it knows a bonded base only, not a {support.kind}")
    top = np.cumsum([0.0] + [layer.thickness for layer in layers])[:-1]
    squeezed = [
        sinking(layer, tool, z) - sinking(layer, tool, z + layer.thickness)
        for layer, z in zip(layers, top, strict=True)
    ]
    return np.cumsum(squeezed[::-1])[::-1]


def sinking(layer, tool, z):
    """Deflection in m at the depth z under 1 N on a half-space of the layer's stiffness."""
    a, nu = tool.radius, layer.poisson_ratio
    s = np.sqrt(1.0 + (z / a) ** 2)
    pressure = 1.0 / (np.pi * a**2)
    return (1.0 + nu) * pressure * a / layer.youngs_modulus * (1.0 / s + (1.0 - 2.0 * nu) * (s - z / a))
