"""Presses of a toy specimen whose force is a product of powers of its layers' moduli, other powers at other depths."""

from pathlib import Path

import numpy as np
import pytest

from benchmark.files import Support, Tool, load_tissue
from benchmark.identification import TrialData
from benchmark.identification.parameters.fit_problem import FitProblem
from benchmark.identification.parameters.free_parameters import parameters_of, with_values
from benchmark.identification.parameters.law_shapes import shear_modulus
from benchmark.identification.parameters.layer_fit import begun, fit_layers
from benchmark.identification.parameters.layer_model import FitTrial
from benchmark.identification.parameters.presses import press_surrogate
from benchmark.identification.parameters.presses.press_surrogate import Press
from benchmark.identification.trial_features import contact_range
from benchmark.response import ForceCurve
from benchmark.response.differentiated_ramp import DifferentiatedRamp, RampDerivative

TISSUE = load_tissue("skin_forearm")
SUPPORT = Support(kind="bonded")
TOOLS = (Tool(radius=5e-3, contact="rigid_bonded"), Tool(radius=2e-3, contact="rigid_bonded"))
LAYERS = ("epidermis", "dermis", "subcutaneous_fat")
MODULI = tuple(f"{name}.youngs_modulus" for name in LAYERS)
TRUTH = dict(zip(MODULI, (1.8e6, 0.6e6, 70e3), strict=True))
DEPTH = 2e-3
PLAIN = ForceCurve(np.array([1e-3, 2e-3]), np.array([1.0, 2.0]))


class ToySession:
    """What is asked of a session."""

    name, folder, synthetic, fingerprint, specimen = "toy", Path(), True, "0" * 64, TISSUE

    settings, trials = {}, ()

    def uncertainties(self, setup):
        return {}

    def setup(self, trial):
        return TISSUE, trial.tool, trial.support

    @property
    def setups(self):
        return tuple(dict.fromkeys(self.setup(trial) for trial in self.trials))

    def by_height(self):
        return [self]


def powers(radius, depth):
    """(3, k): which power of each layer's modulus the force follows; their sum is one, as dimensions demand."""
    deep = depth / radius
    top, middle = 0.05 + 0.2 * np.exp(-6e2 * radius) + 0.0 * deep, 0.3 - 0.25 * deep + 60.0 * (5e-3 - radius)
    return np.stack([top, middle, 1.0 - top - middle])


def toy_force(tissue, tool, depth):
    moduli = np.array([3.0 * shear_modulus(one) for one in tissue.layers])
    return 4.0 * tool.radius * depth * np.exp(np.log(moduli) @ powers(tool.radius, depth))


def toy_ramp(session, tissue, tool, support, depth, keys, model="fem", steps=24, *, judge_mesh=False):
    levels = np.linspace(0.0, depth, steps + 1)
    force, shares = toy_force(tissue, tool, levels), powers(tool.radius, levels)
    by = {f"{name}.stiffness": RampDerivative(share * force) for name, share in zip(LAYERS, shares, strict=True)}
    by |= {  # at a fixed Young's modulus: the force goes with the shear moduli alone
        f"{one.name}.poisson_ratio": RampDerivative(-share * force / (1.0 + one.poisson_ratio))
        for one, share in zip(tissue.layers, shares, strict=True)
    }
    return DifferentiatedRamp(
        levels, force, None, {key: by[key] for key in keys}, mesh_error=0.0 if judge_mesh else None
    )


def toy_trial(seed, tool=0, name="a", noise=0.005, gain=0.015, truth=TRUTH, fade=None):
    """Rest, press, hold and back; noise as a share of the peak, gain and touch of its own."""
    generator = np.random.default_rng([seed, tool])
    time = np.linspace(0.0, 20.0, 240)
    depth = np.interp(time, [0, 1, 5, 15, 19, 20], [-2e-4, 0.0, DEPTH, DEPTH, 0.0, -2e-4])
    below = np.maximum(depth - 3e-5 * generator.normal(), 0.0)
    tissue = with_values((TISSUE, TOOLS[tool], SUPPORT), truth)[0]
    force = toy_force(tissue, TOOLS[tool], below)
    force = force if fade is None else fade(time, force, powers(TOOLS[tool].radius, below))
    force = np.where(below > 0.0, np.maximum(force, 0.0), 0.0)
    force = np.exp(gain * generator.normal()) * force + 0.01 * generator.normal()
    force = force + noise * force.max() * generator.normal(size=time.size)
    return TrialData(f"{name}{tool}", f"tool {tool}", time, depth, force, PLAIN)


def toy_problem(keys=MODULI, tools=(0, 1), trials=5, seed=1, **more):
    data = [
        (k, toy_trial(100 * seed + n, tool, f"t{n}", **more)) for k, tool in enumerate(tools) for n in range(trials)
    ]
    presses = tuple(Press(0, ToySession(), (TISSUE, TOOLS[tool], SUPPORT), 1.15 * DEPTH) for tool in tools)
    fitted = tuple(FitTrial.of(one, k, contact_range(one.depth, one.force)) for k, one in data)
    free = tuple(each for key in keys for each in parameters_of(key, presses[0].setup, None))
    return FitProblem(presses, fitted, free)


def zeros_of(problem):
    return np.array([np.median(one.data.force[one.data.depth < -1e-4]) for one in problem.trials])


@pytest.fixture
def toy(monkeypatch):
    """The model replaced by the toy; gives a factory of problems."""
    monkeypatch.setattr(press_surrogate, "differentiated_ramp", toy_ramp)
    return toy_problem


@pytest.fixture
def toy_fit(toy):
    """Factory of fits to toy trials."""

    def fit(**options):
        problem = toy(**options)
        return fit_layers(begun(problem, np.zeros(len(problem.trials)), zeros_of(problem)))

    return fit
