"""The catalogue in its order, and own effects from a user's file."""

from __future__ import annotations

import importlib
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

from bench_hw.storage.regular_file import read_regular
from benchmark.child_processes import forbid_ending
from benchmark.errors import InputError
from benchmark.physics.effect import Effect

BY_PLACE = {
    "body": (
        "strain_stiffening",
        "viscoelastic_relaxation",
        "viscous_damping",
        "stress_softening",
        "permanent_set",
        "poroelastic_drainage",
        "anisotropy",
        "pretension",
        "interface_slip",
        "bottoming_out",
        "dry_friction",
        "adhesion",
    ),
    "drive": ("contact_gap", "off_centre_load", "machine_compliance", "backlash"),
    "observation": (
        "tool_inertia",
        "force_drift",
        "force_saturation",
        "camera_latency",
        "perspective",
        "marker_scale_error",
    ),
}
"""Files of the effects by the place where they act, in the order of the catalogue."""
SLUGS = tuple(slug for slugs in BY_PLACE.values() for slug in slugs)


@cache
def catalogue() -> tuple[Effect, ...]:
    """All effects that ship."""
    return tuple(
        importlib.import_module(f"benchmark.physics.{place}.{slug}").EFFECT
        for place, slugs in BY_PLACE.items()
        for slug in slugs
    )


@cache
def option_effects() -> tuple[Effect, ...]:
    """The effects that a scenario's `[physics]` can state, in the order of the catalogue."""
    return tuple(effect for effect in catalogue() if effect.description.keys)


def load_effects(path: str | Path) -> tuple[Effect, ...]:
    """Own effects of a Python file: every `Effect` at its top level, in their order.

    Raises
    ------
    InputError
        The file cannot be read or run, or has no effect, or one with a slug of the catalogue or twice the same.
    """
    file = Path(path)
    if not file.is_file():
        raise InputError(f"{file}: there is no such effects file; give a Python file with an Effect at its top level.")
    name = f"own_effects_{file.stem}"
    if file.suffix != ".py":
        raise InputError(f"{file}: this is no Python file; its name must end in .py.")
    module = ModuleType(name)
    module.__file__ = str(file)
    sys.modules[name] = module
    forbid_ending(str(file))
    try:  # no loader of Python's, which would leave compiled code beside the file
        exec(compile(read_regular(file), str(file), "exec"), vars(module))
    except (Exception, SystemExit) as error:
        raise InputError(f"{file}: this effects file does not run ({type(error).__name__}: {error}).") from error
    found = [value for value in vars(module).values() if isinstance(value, Effect)]
    shared = {form for each in found for form in each.forms[1:]}
    own = [each for each in found if each not in shared]
    _check(own, file)
    return tuple(each.from_origin(str(file.resolve())) for each in own)


def _check(own: list[Effect], file: Path) -> None:
    if not own:
        raise InputError(f"{file}: there is no Effect at the top level of this file; one at least is needed.")
    slugs = [each.slug for each in own]
    for slug in slugs:
        if slug in SLUGS or slugs.count(slug) > 1:
            raise InputError(f"{file}: the slug {slug!r} is taken; each effect needs one of its own.")
