"""The verbs for a script: the same work as the command line's, with result objects instead of folders.

Nothing is written until a result's `report` is called; a sweep alone writes its points as they finish. Progress goes to
a listener (`benchmark.runs.options`), none by default. Errors are those of the command line (`benchmark.errors`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import Literal

from benchmark.discovery.discovery_request import DiscoverRequest, answer
from benchmark.errors import InputError
from benchmark.results import ComparisonResult, DiscoveryResult, FitResult, RunResult, SweepResult
from benchmark.runs.finished.carrying_out import set_side_by_side
from benchmark.runs.fit_run import FitRequest, carry_out_fit
from benchmark.runs.options import Advance, Listener, RunOptions
from benchmark.runs.parameters_run import ParameterWish
from benchmark.runs.requests import RunRequest, computed
from benchmark.sweeps.sweep_run import SweepRequest, run_sweep

StrPath = str | PathLike[str]
Settings = Mapping[str, str]


class Unheard:
    """A listener that shows nothing."""

    def say(self, text: str) -> None:
        """Pass over a remark."""

    @contextmanager
    def progress(self, title: str) -> Iterator[Advance]:  # noqa: ARG002 - the signature of a listener
        """Pass over the progress of a task."""
        yield lambda task, done, total, remark: None  # noqa: ARG005


def run(
    scenario: str | None = None,
    *,
    trials: StrPath | None = None,
    specimen: str | None = None,
    tissue: str | None = None,
    set: Settings | None = None,
    wave: StrPath | None = None,
    reference: StrPath | None = None,
    model: StrPath | None = None,
    effects: StrPath | None = None,
    fields: Literal["peak", "all"] = "peak",
    repeats: int = 3,
    refine: bool = False,
    seed: int = 0,
    listener: Listener | None = None,
) -> RunResult:
    """Run FEM and wave model side by side on a scenario, or on a trial session whose specimen is fitted first.

    Parameters
    ----------
    scenario, trials
        A shipped scenario's name or a TOML file; or the folder of a trial session. One of them.
    specimen, tissue
        Tissue of the trials; another tissue for the scenario: a name or a TOML file.
    set
        Values to change, KEY to value with unit, as `--set` takes them.
    wave, reference
        A Python file with your own fast model; a CSV file with your own FEA.
    model, effects
        A model file of `discover` to switch on; a Python file with effects of your own that it names.
    fields, repeats, refine, seed
        Steps whose fields are kept, timed repeats of each model, coarser and finer runs too, seed of random draws.

    Raises
    ------
    InputError
        Options that do not go together, or unusable input.
    SolverError
        A model's process failed.
    """
    request = RunRequest(
        scenario,
        _path(trials, "trials"),
        specimen,
        set or {},
        None,
        _path(wave, "wave"),
        _path(reference, "reference"),
        () if tissue is None else (tissue,),
        _path(model, "model"),
        _path(effects, "effects"),
    )
    if fields not in ("peak", "all"):
        raise InputError(f"fields = {fields!r}: allowed are 'peak' and 'all'")
    if repeats < 1:
        raise InputError(f"repeats = {repeats!r}: allowed are 1 or more")
    options = RunOptions(every_field=fields == "all", repeats=repeats, refine=refine, seed=seed)
    return RunResult(computed(request, options, listener or Unheard()))


def fit(
    session: StrPath,
    *others: StrPath,
    free: Sequence[str] | None = None,
    exact: Sequence[str] | None = None,
    law: str | Sequence[str] | None = None,
    posterior: bool = False,
    forward: Literal["fem", "wave"] | None = None,
    fit_file: StrPath | None = None,
    specimen: str | None = None,
    set: Settings | None = None,
    model: StrPath | None = None,
    effects: StrPath | None = None,
    seed: int = 0,
    listener: Listener | None = None,
) -> FitResult:
    """Fit the specimen of a trial session; see `run` for the other arguments.

    Parameters
    ----------
    session, *others
        A trial session; with `free` several ones that are fitted together.
    free
        Keys of the parameters to fit (`dermis.youngs_modulus`, `fat.relaxation`...); by default one common stiffness.
    exact
        Told values to take without uncertainty, or ("all",).
    law
        Law of all layers: neo_hookean, mooney_rivlin, yeoh, gent or ogden; of several, held-out conditions choose.
    posterior
        Whether to draw from the posterior, with emcee.
    forward
        The model that is fitted.
    fit_file
        A TOML file with a `[fit]` table in the place of the session's.

    Raises
    ------
    InputError, SolverError
        Trials that cannot be used; a finite-element curve that cannot be computed deep enough.
    """
    keys = [None if each is None else tuple(each) for each in (free, exact)]
    laws = (law,) if isinstance(law, str) else None if law is None else tuple(law)
    files = tuple(map(Path, others)), _path(fit_file, "fit_file")
    wish = ParameterWish(keys[0], keys[1], laws, forward, *files, posterior=posterior, seed=seed)
    request = FitRequest(
        Path(session), specimen, set or {}, _path(model, "model"), _path(effects, "effects"), seed, wish
    )
    return FitResult(carry_out_fit(request, listener or Unheard()))


def discover(
    *paths: StrPath,
    model: Literal["wave", "fem"] = "wave",
    effects: StrPath | None = None,
    specimen: str | None = None,
    set: Settings | None = None,
    seed: int = 0,
    listener: Listener | None = None,
) -> DiscoveryResult:
    """Find where simulation and measurement disagree and name the effect that is missing.

    Parameters
    ----------
    *paths
        A trial session; or a result folder of `run`, and a second one to hold out.
    model
        The model under repair.
    effects
        A Python file with effects of your own beside the catalogue.
    specimen, set, seed
        As in `run`.

    Raises
    ------
    InputError
        Input that cannot be used.
    """
    request = DiscoverRequest(
        tuple(map(Path, paths)), model, _path(effects, "effects"), specimen, set or {}, None, seed
    )
    return DiscoveryResult(answer(request, listener or Unheard()))


def sweep(
    scenario: str,
    *,
    vary: Mapping[str, str],
    set: Settings | None = None,
    sample: Literal["lhs", "sobol"] | None = None,
    points: int | None = None,
    sensitivity: bool = False,
    workers: int | None = None,
    scheduler: str | None = None,
    seed: int = 0,
    out: StrPath | None = None,
    listener: Listener | None = None,
) -> SweepResult:
    """Run FEM and wave model at many points of a scenario's parameters; the same call goes on where it was stopped.

    Parameters
    ----------
    scenario, set, seed
        As in `run`.
    vary
        KEY to a list of values ("2 mm,5 mm") or a range ("50 kPa:500 kPa:10:log").
    sample, points, sensitivity
        Draw that many points by a Latin hypercube or a Sobol sequence; Sobol indices by a design of their own.
    workers, scheduler
        Processes here, or the address of a Dask cluster.
    out
        Folder of the points; by default results/NAME-DATE-TIME.

    Raises
    ------
    InputError
        A request that cannot be carried out.
    """
    request = SweepRequest(
        scenario=scenario,
        vary=tuple(f"{key}={values}" for key, values in vary.items()),
        settings=set or {},
        sample=sample,
        points=points,
        sensitivity=sensitivity,
        out=_path(out, "out"),
        seed=seed,
        workers=workers,
        scheduler=scheduler,
    )
    outcome = run_sweep(request, listener or Unheard())
    return SweepResult(outcome.folder, outcome.headline, outcome.document)


def compare(*runs: StrPath) -> ComparisonResult:
    """Set finished runs side by side; the first one is what the others are compared with.

    Parameters
    ----------
    *runs
        Result folders of `run`, two or more.

    Raises
    ------
    InputError
        A folder that is no result of `run`, or one that is given twice.
    """
    return ComparisonResult(set_side_by_side(_folders(runs)))


def _folders(runs: Sequence[StrPath]) -> list[Path]:
    if len(runs) < 2:
        raise InputError(f"compare takes two result folders of run or more; {len(runs)} given")
    return [Path(each) for each in runs]


def _path(path: object, name: str) -> Path | None:
    """A path, None where there is none; refuses what is none, such as a function in the place of its file."""
    if path is None or isinstance(path, str | PathLike):
        return None if path is None else Path(path)
    kind = getattr(path, "__name__", None)
    given = f"the {type(path).__name__} {kind}" if kind else f"a {type(path).__name__}"
    raise InputError(f"{name} is {given}; allowed: the path of a file or folder, as text or as a Path")
