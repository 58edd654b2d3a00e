"""The path of a large press: states of equilibrium from no load to a depth."""

from dataclasses import dataclass, replace

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.large_press.equilibrium import Equilibrium

SPACING = 0.025
"""Of depth between levels, in heights of the stack."""
FASTEST = 1.6
"""A step of force is at most so many times the one before."""
SHORTEST = 1.0 / 32.0
"""A step of force below this share of the first ends the path."""
SURPRISE = 0.5
"""A step that goes so much further, or less far, than the one before led to expect is cut: a soft block under pressure
comes to a largest force and then sinks in, and must not be followed to another branch."""


@dataclass(frozen=True)
class PressPath:
    """M levels of load, the first without any.

    Attributes
    ----------
    force, depth
        (M,) in N and m, rising.
    deflection
        (M, L, N) amplitudes of the layers' top faces, m.
    outward
        (M, L, N) amplitudes in plane of the layers' top faces, m.
    linear_depth, linear_deflection, linear_outward
        The same per force by the linear body: m/N, and (L, N) in m/N.
    """

    force: FloatArray
    depth: FloatArray
    deflection: FloatArray
    outward: FloatArray
    linear_depth: float
    linear_deflection: FloatArray
    linear_outward: FloatArray

    def first(self, levels: int) -> "PressPath":
        """Return its first levels."""
        kept = {name: getattr(self, name)[:levels] for name in ("force", "depth", "deflection", "outward")}
        return replace(self, **kept)


def follow(equilibrium: Equilibrium, height: float, reach: float) -> PressPath:
    """Load a body until its depth is `reach`, or until it has no equilibrium near the one before.

    Parameters
    ----------
    equilibrium
        The body and its contact.
    height
        Of the stack, m.
    reach
        Depth to come to, m.
    """
    linear = equilibrium.answer(equilibrium.contact.load)
    compliance = equilibrium.contact.depth(linear, 1.0)
    first = step = SPACING * height / compliance
    forces, depths, states = [0.0], [0.0], [np.zeros_like(linear)]
    while depths[-1] < reach:
        force = forces[-1] + step
        state = equilibrium.solve(force, _start(equilibrium, forces, states, linear, force))
        gained = -np.inf if state is None else equilibrium.contact.depth(state, force) - depths[-1]
        expected = step * (compliance if len(forces) == 1 else (depths[-1] - depths[-2]) / (forces[-1] - forces[-2]))
        if state is None or abs(gained - expected) > SURPRISE * expected:
            step *= 0.5
            if step < SHORTEST * first:
                break
            continue
        depth = depths[-1] + gained
        step = min(FASTEST * step, SPACING * height * step / gained)
        forces.append(force)
        depths.append(depth)
        states.append(state)
    tops, nodes = equilibrium.body.thickness.top, equilibrium.body.nodes
    outward, deflection = (np.stack([state[:, tops + shift].T for state in states]) for shift in (0, nodes))
    return PressPath(
        force=np.array(forces),
        depth=np.array(depths),
        deflection=deflection,
        outward=outward,
        linear_depth=compliance,
        linear_deflection=linear[:, tops + nodes].T,
        linear_outward=linear[:, tops].T,
    )


def _start(
    equilibrium: Equilibrium, forces: list[float], states: list[FloatArray], linear: FloatArray, force: float
) -> FloatArray:
    """Go on straight from the last two states, unless that crushes matter."""
    if len(forces) == 1:
        ahead = force * linear
    else:
        share = (force - forces[-1]) / (forces[-1] - forces[-2])
        ahead = states[-1] + share * (states[-1] - states[-2])
    return states[-1] if equilibrium.body.state(ahead) is None else ahead
