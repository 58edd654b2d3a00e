"""What the stated uncertainties of a set-up leave of FEM and wave, and whether their difference matters beside it.

Linear propagation (JCGM 100:2008, 5.2) from the file's standard uncertainties and correlations, by the finite
elements' own derivatives and central differences of the explicit wave: one differentiated press and two waves a
parameter, no hundred runs. Values are taken as log-normal, so that bands are factors. The mesh stands still in the
derivatives: an automatic `fem.radius`, which runs of other values would have another of, is the scenario's own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from benchmark.comparison.uncertainty import NORMAL_95
from benchmark.errors import InputError, SolverError
from benchmark.files import Scenario
from benchmark.models import Array, Drive, UncoveredError, prepare
from benchmark.models.fem_derivatives import ScenarioChange, differentiated_press
from benchmark.response.setup_change import STIFFNESS, changed_setup, is_absolute, natural_change
from fem.errors import NotDifferentiableError

SMALL, DIFFERENCE = 3e-5, 0.01
"""Steps of the solver's derivatives and of central differences, in natural changes."""
MODULUS = "youngs_modulus"


@dataclass(frozen=True, eq=False)
class ParameterBands:
    """Standard deviations of deflections that uncertain parameters cause.

    Attributes
    ----------
    keys : tuple of str
        Parameters with a stated uncertainty.
    shares : (p,) array
        Their standard uncertainties, as shares.
    fem, wave, difference : (n, L) array
        Of the logarithm of each model's deflection, and of their ratio; NaN where a model has none.
    by : str
        How the finite elements were differentiated.
    """

    keys: tuple[str, ...]
    shares: Array
    fem: Array
    wave: Array
    difference: Array
    by: str

    def factor(self, deviation: Array) -> Array:
        """Upper end of the 95 % band over the value."""
        return np.asarray(np.exp(NORMAL_95 * deviation))


@dataclass(frozen=True)
class DifferenceBeside:
    """A layer at peak load: wave against FEM beside what the parameters leave, all in per cent.

    Attributes
    ----------
    layer : str
    difference : float
        Wave against FEM.
    fem, wave : float
        Upper half of the 95 % band of each.
    of_difference : float
        95 % half width of the difference itself: both models move together.
    """

    layer: str
    difference: float
    fem: float
    wave: float
    of_difference: float

    @property
    def matters(self) -> bool:
        """Whether the difference is larger than what the parameters leave of the FEM."""
        return abs(self.difference) > self.fem

    @property
    def text(self) -> str:
        """In words."""
        share = abs(self.difference) / max(self.fem, 1e-12)
        beside = "matters" if self.matters else "does not matter"
        return (
            f"{self.layer}: wave against FEM {self.difference:+.2f} %, uncertain parameters leave the FEM up to "
            f"{self.fem:.3g} % (95 %): the difference {beside} beside them ({share:.2g} of it)"
        )


def parameter_bands(scenario: Scenario, drive: Drive) -> ParameterBands | None:
    """The bands of a scenario; None where it states no uncertainty.

    Raises
    ------
    InputError, SolverError
        A model does not cover the scenario with a value a little changed.
    """
    stated = {key: share for key, share in scenario.uncertainties.items() if share > 0.0}
    if not stated:
        return None
    keys = tuple(stated)
    fem, by = _fem(scenario, drive, keys)
    wave = _differences(lambda other: _deflection("wave", other, drive), scenario, keys)
    spread = np.array([stated[key] for key in keys])
    covariance = np.outer(spread, spread) * _correlation(scenario, keys)
    of_fem, of_wave, apart = (_deviation(each, covariance) for each in (fem, wave, wave - fem))
    return ParameterBands(keys, spread, of_fem, of_wave, apart, by)


def beside(bands: ParameterBands, names: Sequence[str], fem: Array, wave: Array, row: int) -> list[DifferenceBeside]:
    """Each layer at one step, from deflections (n, L) m."""
    out = []
    for k, name in enumerate(names):
        parts = [100.0 * float(bands.factor(each[row, k]) - 1.0) for each in (bands.fem, bands.wave, bands.difference)]
        apart = 100.0 * float(wave[row, k] / fem[row, k] - 1.0)
        if np.isfinite([*parts, apart]).all():
            out.append(DifferenceBeside(name, apart, *parts))
    return out


def _correlation(scenario: Scenario, keys: Sequence[str]) -> Array:
    """(p, p) of the parameters, as the tissue states it; not correlated otherwise."""
    out, place = np.eye(len(keys)), {key: k for k, key in enumerate(keys)}
    for one in scenario.tissue.correlations or ():
        first, second = (place.get(key) for key in one.between)
        if first is not None and second is not None and first != second:
            out[first, second] = out[second, first] = one.value
    sizes, vectors = np.linalg.eigh(out)
    return np.asarray((vectors * np.maximum(sizes, 0.0)) @ vectors.T)


def _deviation(gradient: Array, covariance: Array) -> Array:
    """(n, L) standard deviation from derivatives (p, n, L)."""
    variance = np.einsum("pnl,pq,qnl->nl", gradient, covariance, gradient)
    return np.asarray(np.sqrt(np.maximum(variance, 0.0)))


def _fem(scenario: Scenario, drive: Drive, keys: Sequence[str]) -> tuple[Array, str]:
    """(p, n, L) derivatives of the logarithm of the FEM's deflections by shares of the parameters."""
    try:
        changes = {key: _change(scenario, key) for key in keys}
        found = differentiated_press(scenario, drive, changes)
    except NotDifferentiableError:
        return _differences(lambda other: _deflection("fem", other, drive), scenario, keys), "central differences"
    if found.failure is not None:
        raise SolverError(f"the finite elements stopped at {found.failure}")
    told = _deflection("fem", scenario, drive)
    tops = [found.by[key].top for key in keys]
    rows = np.array(
        [
            np.full_like(told, np.nan) if top is None else top * _per_share(scenario, key)
            for key, top in zip(keys, tops, strict=True)
        ]
    )
    return _logarithmic(rows, told), "the solver's own derivatives on one mesh"


def _logarithmic(rows: Array, told: Array) -> Array:
    """Derivatives over the deflection itself; zero where nothing is pressed."""
    pressed = np.abs(told) > 1e-9 * np.nanmax(np.abs(told), initial=1e-300)
    return np.asarray(np.where(pressed, rows / np.where(pressed, told, 1.0), 0.0))


def _change(scenario: Scenario, key: str) -> ScenarioChange:
    step = SMALL * natural_change(scenario.tissue, _moved(key))
    return ScenarioChange(_with(scenario, key, -step), _with(scenario, key, step), step, step)


def _differences(answer: Callable[[Scenario], Array], scenario: Scenario, keys: Sequence[str]) -> Array:
    """(p, n, L) derivatives of a logarithm by shares of the parameters."""
    told, rows = answer(scenario), []
    for key in keys:
        step = DIFFERENCE * natural_change(scenario.tissue, _moved(key))
        more, less = (answer(_with(scenario, key, sign * step)) for sign in (1.0, -1.0))
        rows.append((more - less) / (2.0 * step) * _per_share(scenario, key))
    return _logarithmic(np.array(rows), told)


def _deflection(model: str, scenario: Scenario, drive: Drive) -> Array:
    """(n, L) m; NaN where the model does not cover the scenario or stops early."""
    empty = np.full((drive.time.size, len(scenario.tissue.layers)), np.nan)
    try:
        found = prepare(model, scenario).run(drive).top_deflection
    except UncoveredError:
        return empty
    return found if found.shape == empty.shape else empty


def _moved(key: str) -> str:
    """A modulus takes all stresses of its layer along."""
    return f"{key.removesuffix(MODULUS)}{STIFFNESS}" if key.endswith(f".{MODULUS}") else key


def _with(scenario: Scenario, key: str, change: float) -> Scenario:
    tissue, tool, support = changed_setup(scenario.tissue, scenario.tool, scenario.support, _moved(key), change)
    return scenario.model_copy(update={"tissue": tissue, "tool": tool, "support": support})


def _per_share(scenario: Scenario, key: str) -> float:
    """By what a derivative is multiplied to be by a share of the value."""
    if not is_absolute(_moved(key)):
        return 1.0
    node: object = scenario.tissue.layer(key.partition(".")[0])
    for part in key.split(".")[1:]:
        node = getattr(node, part)
    if not isinstance(node, float):
        raise InputError(f"{key}: no number to be uncertain of")
    return node
