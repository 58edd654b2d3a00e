"""What finite strain adds to the linear wave, as a function of the elastic force: read off a few fields."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import j0, j1

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.integrators.equilibrium_path import RisingCurve
from wavemodel.layered.finite_strain.equilibrium import PressPath

NEGLECTED = 1e-4
"""Fields that add less than this share of the largest are left out."""
LEAST = 0.02
"""The law ends at the level from which on its depth per force rises by less than this share of the initial one."""
CLOSE = 1e-14
SLACK = 1.0 + 1e-12
"""Rounding at the end of the range is let through."""


@dataclass(frozen=True)
class FiniteStrainLaw:
    """Nonlinear less linear answer of a stack to a tool, from no load to the last level of a path, or on from there.

    Without load or under a pull it adds nothing. Nothing in it is calibrated (`calibrated_on` is empty); under a tool
    that slides the springs of the contact were set on one press (`sliding_contact.SHORTER`).

    Attributes
    ----------
    wavenumber
        (N,) of the modes, rad/m.
    force, depth
        (M,) levels of the path, in N and m; the depth with the linear wave's compliance.
    compliance
        Initial depth per force of the linear wave, m/N.
    fields
        (B, L, N) amplitudes of the layers' top faces, m.
    depths
        (B,) what each field adds to the depth, m.
    rigid_radius
        Of a rigid face under which the surface has the tool's depth, m; zero under a pressure.
    deepest
        End of the range, m: the last level, or beyond it, where the law goes on straight along its tangent.
    sharp
        Radius, m, to the surface's linear deflection per force, m/N, that the modes do not have and finite strain takes
        away, as under a tool whose touched face grows; its weight is the last, the force. None: it stays.
    """

    wavenumber: FloatArray
    force: FloatArray
    depth: FloatArray
    compliance: float
    fields: FloatArray
    depths: FloatArray
    rigid_radius: float
    deepest: float
    _weights: CubicSpline
    _sideways: CubicSpline
    sharp: CubicSpline | None = None

    calibrated_on = ()

    @property
    def followed(self) -> float:
        """Depth of the last level of the path, m."""
        return float(self.depth[-1])

    @cached_property
    def _tangent(self) -> FloatArray:
        """(B,) change of the weights per force at the last level, 1/N.

        Near a largest force the levels crowd, and the spline may turn back at its end: then that of the last two.
        """
        along = np.asarray(self._weights(self.force[-1], 1))
        if self.compliance + float(along @ self.depths) > 0.0:
            return along
        before, after = self._weights(self.force[-2:])
        return np.asarray((after - before) / (self.force[-1] - self.force[-2]))

    @cached_property
    def _last_compliance(self) -> float:
        """Of the last level, m/N."""
        return self.compliance + float(self._tangent @ self.depths)

    @cached_property
    def strongest(self) -> float:
        """Elastic force at the end of the range, N."""
        return float(self.force[-1]) + max(self.deepest - self.followed, 0.0) / self._last_compliance

    def weights_at(self, force: float) -> FloatArray:
        """(B,) of the fields at one elastic force, N: the same as `weights`, in a few microseconds.

        Raises
        ------
        WaveError
            If the force is beyond the range.
        """
        levels, table = self._levels, self._weights.c
        if not force <= levels[-1]:
            return self.weights(np.array(force))
        level = min(max(bisect_right(levels, force) - 1, 0), len(levels) - 2)
        ahead = max(force, 0.0) - levels[level]
        third, second, first, here = table[:, level]
        return np.asarray(((third * ahead + second) * ahead + first) * ahead + here)

    @cached_property
    def _levels(self) -> list[float]:
        return list(self.force.tolist())

    def weights(self, force: FloatArray) -> FloatArray:
        """(..., B) of the fields at elastic forces (...), N.

        Raises
        ------
        WaveError
            If a force is beyond the range.
        """
        force = np.asarray(force, dtype=np.float64)
        self._require_within(force)
        beyond = np.maximum(force - self.force[-1], 0.0)
        return np.asarray(self._weights(np.clip(force, 0.0, self.force[-1])) + beyond[..., None] * self._tangent)

    def _require_within(self, force: FloatArray) -> None:
        if np.any(force > self.strongest * SLACK):
            raise WaveError(
                f"large press: an elastic force of {force.max():g} N is beyond the range of this tool and stack, "
                f"{self.strongest:.4g} N ({1e3 * self.deepest:.4g} mm)"
            )

    def depth_at(self, force: FloatArray) -> FloatArray:
        """(...) depth of the elastic body under forces (...), m."""
        return np.asarray(self.compliance * np.asarray(force) + self.weights(force) @ self.depths)

    def force_at(self, depth: FloatArray) -> FloatArray:
        """(...) elastic force at depths (...), N: the inverse of `depth_at`.

        Raises
        ------
        WaveError
            If a depth is beyond the range.
        """
        depth = np.asarray(depth, dtype=np.float64)
        if np.any(depth > self.deepest * SLACK):
            raise WaveError(
                f"large press: a depth of {1e3 * depth.max():.4g} mm is beyond the range of this tool and stack, "
                f"{1e3 * self.deepest:.4g} mm"
            )
        force = self._rising.inverse(np.clip(depth, 0.0, self.followed), CLOSE * self.deepest)
        force = force + np.maximum(depth - self.followed, 0.0) / self._last_compliance
        return np.where(depth < 0.0, depth / self.compliance, force)

    @cached_property
    def _rising(self) -> RisingCurve:
        return RisingCurve(
            self.force,
            self.depth,
            self.depth_at,
            lambda force: np.asarray(self.compliance + self._weights(force, 1) @ self.depths),
        )

    def outward(self, force: float, face: int, radius: FloatArray) -> FloatArray:
        """(R,) what it adds to the motion away from the axis at radii (R,) of a layer's top face, m.

        Raises
        ------
        WaveError
            If the force, N, is beyond the range.
        """
        self._require_within(np.array(force))
        last = float(self.force[-1])
        amplitude = self._sideways(min(max(force, 0.0), last)) + max(force - last, 0.0) * self._sideways(last, 1)
        return np.asarray(-(amplitude[face] @ j1(np.outer(self.wavenumber, radius))))

    @cached_property
    def axis(self) -> FloatArray:
        """(B, L) what each field adds on the axis, m."""
        return self.at_radius(np.zeros(1))[..., 0]

    def at_radius(self, radius: FloatArray) -> FloatArray:
        """(B, L, R) what each field adds at radii (R,), m."""
        out: FloatArray = self.fields @ j0(np.outer(self.wavenumber, radius))
        if self.rigid_radius:
            out[:, 0, radius <= self.rigid_radius] = self.depths[:, None]
        if self.sharp is not None:
            near = radius <= self.sharp.x[-1]
            out[-1, 0, near] -= self.sharp(radius[near])
        return out


def _rising_levels(path: PressPath, compliance: float) -> int:
    """How many levels, from the first, go deeper with the force."""
    depth = path.depth + path.force * (compliance - path.linear_depth)
    stuck = np.diff(depth) < LEAST * compliance * np.diff(path.force)
    return int(np.argmax(stuck)) + 1 if stuck.any() else path.force.size


def finite_strain_law(
    path: PressPath,
    wavenumber: FloatArray,
    compliance: float,
    rigid_radius: float,
    deepest: float = 0.0,
    sharp: CubicSpline | None = None,
    *,
    grips: bool = False,
) -> FiniteStrainLaw:
    """Fields and their weights from a path.

    Parameters
    ----------
    path
        The levels.
    wavenumber
        (N,) of its modes, rad/m.
    compliance
        Depth per force of the linear wave, m/N.
    rigid_radius
        Of a rigid face, m; zero under a pressure.
    deepest
        How deep the law goes on along its tangent, m; no deeper than the path unless it is more.
    sharp
        What the linear surface has per force, m/N, over the radius, m, that the path's modes do not have and the body
        at finite strain has no more.
    grips
        Small presses are not those of the linear body either, as under friction.
    """
    path = path.first(_rising_levels(path, compliance))
    added = path.deflection - path.force[:, None, None] * path.linear_deflection
    deeper = path.depth - path.force * path.linear_depth
    table = np.concatenate([added.reshape(path.force.size, -1), deeper[:, None]], axis=1)
    left, sizes, right = np.linalg.svd(table, full_matrices=False)
    kept = max(1, int(np.count_nonzero(sizes > NEGLECTED * max(sizes[0], 1e-300))))
    histories = left[:, :kept] * sizes[:kept]
    histories[0] = 0.0
    start, modes = np.zeros(kept), right[:kept]
    if sharp is not None:
        histories, start = np.column_stack([histories, path.force]), np.append(start, 1.0)
        modes = np.append(modes, np.zeros((1, modes.shape[1])), axis=0)
    spline = CubicSpline(path.force, histories, bc_type=("not-a-knot" if grips else (1, start), "not-a-knot"))
    fields = modes[:, :-1].reshape(start.size, *path.linear_deflection.shape)
    depths = np.ascontiguousarray(modes[:, -1])
    depth = compliance * path.force + histories @ depths
    deepest = max(deepest, float(depth[-1]))
    sideways = path.outward - path.force[:, None, None] * path.linear_outward
    rest = (1, np.zeros(path.linear_outward.shape))
    return FiniteStrainLaw(
        wavenumber, path.force, depth, compliance, fields, depths, rigid_radius, deepest, spline,
        CubicSpline(path.force, sideways, bc_type=(rest, "not-a-knot")), sharp,
    )  # fmt: skip
