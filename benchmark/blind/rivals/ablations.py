"""The discovery without one of its parts: what each part is worth on the same cases."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, replace
from types import MappingProxyType
from typing import Any

from benchmark.discovery import Settings, criteria, discover
from benchmark.discovery.discovery_result import Discovery
from benchmark.errors import InputError
from benchmark.files import Session, Setup

EXACT = 1e-9
"""Print scatter of a grid that is trusted, m."""
STIFF = 1e-3
"""Of the prior of a base's nuisance that may not move."""
NONE: Mapping[str, Any] = MappingProxyType({})


class _Unsaid(Session):
    """A session that states no uncertainty."""

    def uncertainties(self, setup: Setup) -> dict[str, float]:  # noqa: ARG002
        """None."""
        return {}


def _without_uncertainties(session: Session) -> Session:
    return _Unsaid(**{each.name: getattr(session, each.name) for each in fields(Session)})


def _printed_exactly(session: Session) -> Session:
    if session.camera is None:
        return session
    return replace(session, camera=session.camera.model_copy(update={"print_scatter": EXACT}))


def _without_markers(session: Session) -> Session:
    trials = tuple(replace(trial, markers=None, markers_path=None) for trial in session.trials)
    return replace(session, camera=None, trials=trials)


@dataclass(frozen=True)
class Ablation:
    """What is taken away.

    Attributes
    ----------
    what : str
        In words.
    session : callable or None
        Changes the session that the discovery gets.
    settings : mapping
        Of `Settings`.
    criteria : mapping
        Thresholds of `benchmark.discovery.criteria` while it runs.
    """

    what: str
    session: Callable[[Session], Session] | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    criteria: Mapping[str, Any] = field(default_factory=dict)


def _stiff_shape() -> dict[str, float]:
    return {name: size if name == "modulus" else STIFF * size for name, size in criteria.SHAPE_PRIOR.items()}


ABLATIONS: Mapping[str, Ablation] = MappingProxyType(
    {
        "stated_uncertainties": Ablation("what the files say of their own errors", _without_uncertainties),
        "print_offsets": Ablation("markers that are not where the grid has them", _printed_exactly),
        "markers": Ablation("the camera", _without_markers),
        "shape_nuisances": Ablation("a base whose shape may be wrong", criteria={"SHAPE_PRIOR": _stiff_shape()}),
        "lookalikes": Ablation(
            "equals of the best",
            settings={"lookalike_z": 0.0},
            criteria={"CLOSE": 0.0, "CLOSE_TISSUE": 0.0, "TIE": 0.0},
        ),
        "held_out_gain": Ablation("acceptance by what is predicted of unseen trials", settings={"accept_z": 0.0}),
        "several_effects": Ablation("second and third effects", settings={"most_effects": 1}),
    }
)
"""What can be taken away, by its name on the command line."""


def discoverer_without(name: str) -> str:
    """The discovery without a part, as `--discoverer` takes it.

    Raises
    ------
    InputError
        There is no such part.
    """
    if name not in ABLATIONS:
        raise InputError(f"--without {name!r}: there is no such part; allowed: {', '.join(ABLATIONS)}")
    return f"{__name__}:without_{name}"


def _without(name: str, session: Session, seed: int) -> Discovery:
    left_out = ABLATIONS[name]
    settings = Settings(seed=seed, workers=1, **left_out.settings)
    with _thresholds(left_out.criteria):
        return discover(session if left_out.session is None else left_out.session(session), settings=settings)


@contextmanager
def _thresholds(values: Mapping[str, Any]) -> Iterator[None]:
    """Other thresholds for a while; those that this version does not have are passed over."""
    before = {name: getattr(criteria, name) for name in values if hasattr(criteria, name)}
    try:
        for name in before:
            setattr(criteria, name, values[name])
        yield
    finally:
        for name, value in before.items():
            setattr(criteria, name, value)


def without_stated_uncertainties(session: Session, *, seed: int) -> Discovery:
    """See `ABLATIONS`."""
    return _without("stated_uncertainties", session, seed)


def without_print_offsets(session: Session, *, seed: int) -> Discovery:
    """See `ABLATIONS`."""
    return _without("print_offsets", session, seed)


def without_markers(session: Session, *, seed: int) -> Discovery:
    """See `ABLATIONS`."""
    return _without("markers", session, seed)


def without_shape_nuisances(session: Session, *, seed: int) -> Discovery:
    """See `ABLATIONS`."""
    return _without("shape_nuisances", session, seed)


def without_lookalikes(session: Session, *, seed: int) -> Discovery:
    """See `ABLATIONS`."""
    return _without("lookalikes", session, seed)


def without_held_out_gain(session: Session, *, seed: int) -> Discovery:
    """See `ABLATIONS`."""
    return _without("held_out_gain", session, seed)


def without_several_effects(session: Session, *, seed: int) -> Discovery:
    """See `ABLATIONS`."""
    return _without("several_effects", session, seed)
