"""Newton, prediction and step cutting."""

from fem.solving.equilibrium import Equilibrium
from fem.solving.newton import NewtonSettings
from fem.solving.settling import at_rest, settle, settle_linear
from fem.solving.state import State
from fem.solving.stepping import Advance, Stepper

__all__ = ["Advance", "Equilibrium", "NewtonSettings", "State", "Stepper", "at_rest", "settle", "settle_linear"]
