"""What finished results show: each result folder read for the questions that it answers.

One reader a kind of result, known by its document. Nothing is computed anew; every figure is in a file of the folder.
"""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import pandas as pd

from bench_hw.storage.regular_file import DOCUMENT, read_regular
from benchmark.comparison.percent_error import plain_percent
from benchmark.errors import InputError
from reports.manifest import foreign_files, read_manifest

SYNTHETIC, CIRCULAR, PARTIAL = "synthetic data", "circular: fitted to these trials", "partial"
AGAINST = "speaks against"


@dataclass(frozen=True)
class Evidence:
    """One answer to one question.

    Attributes
    ----------
    question
        Its slug, see `benchmark.dossier.factors`.
    says
        One sentence with its figures.
    source
        The file that has them.
    limits
        Why it shows less than it seems to: synthetic, circular, a part only, or a result that speaks against the model.
    """

    question: str
    says: str
    source: str
    limits: tuple[str, ...] = ()


@dataclass(frozen=True)
class ResultFolder:
    """A finished result: its folder, the name of its document and what is in it."""

    folder: Path
    name: str
    document: Mapping[str, Any]

    def table(self, name: str) -> pd.DataFrame | None:
        """A table of the folder; None where it has none of this name.

        Raises
        ------
        InputError
            It cannot be read.
        """
        path = self.folder / name
        if not path.is_file():
            return None
        try:
            return pd.read_csv(path)
        except (OSError, ValueError) as error:
            raise InputError(f"{path} cannot be read ({error}); needed: the table as it was written") from None

    def file(self, name: str) -> str:
        """What the page calls a file of this folder."""
        return f"{self.folder.name}/{name}"


def read_result(folder: Path) -> ResultFolder:
    """Read a result folder of `run`, `fit`, `discover`, `verify`, `check` or `sweep`.

    Raises
    ------
    InputError
        It is none of them, or its document cannot be used.
    """
    name = next((each for each in READERS if (folder / each).is_file()), None)
    if name is None:
        raise InputError(
            f"{folder} is no result that a dossier can hold; needed: a folder with one of {', '.join(READERS)}"
        )
    try:
        document = json.loads(read_regular(folder / name, DOCUMENT).decode("utf-8-sig"))
    except (OSError, ValueError, RecursionError) as error:
        raise InputError(f"{folder / name} cannot be read ({error})") from None
    if not isinstance(document, dict) or document.get("schema") != 1:
        found = document.get("schema") if isinstance(document, dict) else None
        raise InputError(f"{folder / name}: schema is {found!r}; allowed: 1")
    return ResultFolder(folder, name, document)


def evidence_of(result: ResultFolder) -> tuple[Evidence, ...]:
    """All that one result shows.

    Raises
    ------
    InputError
        Its document lacks what results of this kind have.
    """
    try:
        return (*_kept(result), *READERS[result.name](result))
    except (KeyError, TypeError, AttributeError, IndexError, ValueError) as error:
        raise InputError(
            f"{result.folder / result.name} is not as this version writes it ({type(error).__name__}: {error}); "
            "make the result again"
        ) from None


def _kept(result: ResultFolder) -> Iterator[Evidence]:
    """Versions, and whether the files are those that were written."""
    path = result.folder / "environment.json"
    if path.is_file():
        made = json.loads(path.read_text(encoding="utf-8"))
        packages = made["packages"]
        told = ", ".join(f"{name} {packages[name]}" for name in ("tissuebench", "scikit-fem", "scipy", "numpy"))
        yield Evidence("versions", f"{result.folder.name}: {told}, Python {made['python']}.", result.file(path.name))
    if read_manifest(result.folder) is not None and (changed := foreign_files(result.folder)):
        says = f"{result.folder.name}: {len(changed)} files are not as they were written: {', '.join(changed[:3])}."
        yield Evidence("versions", says, result.file("manifest.json"), (AGAINST,))


def _of_verification(result: ResultFolder) -> Iterator[Evidence]:
    cases = result.document["cases"]
    passed = sum(bool(case["passed"]) for case in cases)
    sources = len({case["source"] for case in cases})
    says = f"{passed} of {len(cases)} values within what is allowed, against {sources} published or closed solutions"
    every, left = _families([str(case["case"]) for case in cases])
    says += f", of {len(every) - len(left)} of {len(every)} families" + (
        f". Not run: {', '.join(left)}." if left else "."
    )
    limits = (*((PARTIAL,) if left else ()), *(() if passed == len(cases) else (AGAINST,)))
    yield Evidence("closed_forms", says, result.file(result.name), limits)


def _families(rows: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Families of cases that `verify` has, and those of which a case is not among `rows`."""
    from benchmark.verification.cases import all_cases, families

    cases = all_cases()
    left = [case for case in cases if not any(f"{row}/".startswith(f"{case.name}/") for row in rows)]
    return families(cases), families(left)


def _of_check(result: ResultFolder) -> Iterator[Evidence]:
    values, times = len(result.document["accuracy"]), len(result.document["timing"])
    good = result.document["passed"]
    says = f"{'Nothing' if good else 'Something'} got worse: {values} values and {times} times against a baseline."
    yield Evidence("gate", says, result.file(result.name), () if good else (AGAINST,))


def _of_sweep(result: ResultFolder) -> Iterator[Evidence]:
    table = result.table("sensitivity.csv")
    if table is None or table.empty:
        return
    first = table[table["result"] == table["result"].iloc[0]].sort_values("total_order", ascending=False)
    parts = [f"{row.parameter} {row.total_order:.2f} +/- {row.total_order_ci95:.2f}" for row in first.itertuples()]
    says = f"Total-order Sobol indices of {first['result'].iloc[0]}: {', '.join(parts[:4])}."
    yield Evidence("sensitivity", says, result.file("sensitivity.csv"))


def _of_fit(result: ResultFolder) -> Iterator[Evidence]:
    found = _of_parameters(result.document["parameters"])
    limits = (SYNTHETIC,) if result.document["session"]["synthetic"] else ()
    told = [f"{key} {_with_interval(entry)}" for key, entry in found.items() if entry["identifiable"]]
    if told:
        says = f"From {len(result.document['trials'])} trials: {'; '.join(told[:4])}."
        yield Evidence("input_uncertainty", says, result.file(result.name), limits)
    if lost := [key for key, entry in found.items() if not entry["identifiable"]]:
        says = f"Not determined by these trials: {', '.join(lost)}."
        yield Evidence("input_uncertainty", says, result.file(result.name), (*limits, AGAINST))


STIFFNESS: Final = ("stiffness_factor", "youngs_modulus")
RELAXATION: Final = ("g_1", "tau_1")
"""Ends of the names that say something of the tissue, where a fit has one factor for all layers."""


def _of_parameters(found: Mapping[str, Any] | list[dict[str, Any]]) -> Mapping[str, Any]:
    """What a fit found of the tissue, by key: of free parameters, or of the one factor with its list of rows.

    The latter looks for a relaxation wherever it can, so one that is not found is no lack.
    """
    if isinstance(found, Mapping):
        return found
    wanted = {True: STIFFNESS + RELAXATION, False: STIFFNESS}
    rows = [row for row in found if row["name"].split(".")[-1] in wanted[row["identifiable"]]]
    ends = [None if row["ci95_low"] is None else [row["ci95_low"], row["ci95_high"]] for row in rows]
    return {row["name"]: row | {"ci95": both} for row, both in zip(rows, ends, strict=True)}


def _with_interval(entry: Mapping[str, Any]) -> str:
    unit = f" {entry['unit']}" if entry["unit"] else ""
    interval = entry["ci95"]
    return f"{entry['value']:.3g}{unit}" + (f" [{interval[0]:.3g}, {interval[1]:.3g}]" if interval else "")


ANSWERED: Final = ("named", "conditional", "no_discrepancy")


def _of_discovery(result: ResultFolder) -> Iterator[Evidence]:
    found = result.document
    limits = (SYNTHETIC,) if found["synthetic"] else ()
    source = result.file(result.name)
    against = () if found["verdict"] in ANSWERED else (AGAINST,)
    yield Evidence("missing_effect", found["statement"], source, (*limits, *against))
    gaps = [each for each in found["gap"].items() if each[1]["closed"] is not None]
    if gaps and found["effects"]:
        parts = [f"{channel} {100 * gap['closed']:.0f} %" for channel, gap in gaps]
        says = f"With the effect, the gap on data it was not fitted to closes by {', '.join(parts)}."
        yield Evidence("unseen", says, source, limits)
    if found["conditions"]:
        names, trials = found["conditions"], found["trials"]
        says = (
            f"{len(trials)} trials of {len(names)} conditions: {', '.join(names[:6])}; {', '.join(found['channels'])}."
        )
        yield Evidence("condition_range", says, source, limits)
    if own := found.get("own"):
        yield Evidence("condition_uncertainty", _own_values(own), source, limits)


def _own_values(own: list[Mapping[str, Any]]) -> str:
    """What was fitted to single trials, as its largest over them."""
    kinds = (("zero_N", "zero of the force", "N"), ("late_ms", "clock", "ms"), ("touch_mm", "touch", "mm"))
    parts = [
        f"{word} up to {max(abs(trial[key]) for trial in own if trial.get(key) is not None):.3g} {unit}"
        for key, word, unit in kinds
        if any(trial.get(key) is not None for trial in own)
    ]
    return f"Fitted to each of {len(own)} trials: {', '.join(parts)}."


def _of_run(result: ResultFolder) -> Iterator[Evidence]:
    found, source = result.document, result.file(result.name)
    yield from _solved(found, source)
    yield from _inputs(result)
    yield from _second_model(found, source)
    yield from _refined(result)
    trials = found.get("trials")
    if trials is not None:
        limits = (SYNTHETIC,) if trials["synthetic"] else ()
        says = f"{trials['count']} trials of the session {trials['session']}, of one specimen."
        yield Evidence("sample_quantity", says, source, limits)
        says = f"Both models follow the measured depth of each of {trials['count']} trials."
        yield Evidence("same_press", says, result.file("tables/measured.csv"), limits)
        yield from _against_trials(result, limits)


def _solved(found: Mapping[str, Any], source: str) -> Iterator[Evidence]:
    if found["complete"]:
        yield Evidence("convergence", f"{found['name']}: every load step reached equilibrium.", source)
    for model in found["models"].values():
        if model["failure"]:
            yield Evidence("convergence", f"{model['name']}: {model['failure']}", source, (AGAINST,))


def _inputs(result: ResultFolder) -> Iterator[Evidence]:
    path = result.folder / "scenario.toml"
    if not path.is_file():
        return
    tissue = tomllib.loads(path.read_text(encoding="utf-8")).get("tissue", {})
    says = f"{result.folder.name}: the whole scenario with units, read back before it was kept."
    yield Evidence("inputs_kept", says, result.file(path.name))
    if isinstance(tissue, dict) and tissue.get("citation"):
        yield Evidence("sources", f"{tissue['name']}: {tissue['citation']}", result.file(path.name))


def _second_model(found: Mapping[str, Any], source: str) -> Iterator[Evidence]:
    entries = {**found["comparison"], **({"force": found["force"]} if "force" in found else {})}
    compared = {what: entry for what, entry in entries.items() if entry["percent_error_max"] is not None}
    if not compared:
        return
    what, worst = max(compared.items(), key=lambda each: each[1]["percent_error_max"])
    margin = 100 * found["equivalence_margin"]
    same = all(entry.get("within_margin", entry["equivalent"]) for entry in compared.values())
    shown = f"{'equivalent' if same else 'equivalence is not shown'} within {plain_percent(margin)} in all of"
    wave, fem = (found["models"][model]["name"] for model in ("wave", "fem"))
    says = (
        f"{found['name']}: {wave} against {fem} within {plain_percent(worst['percent_error_max'])} ({what}); "
        f"{shown} {', '.join(compared)}."
    )
    told, limits = found.get("verdict"), tuple[str, ...]()
    if told is None:
        says, limits = f"{says} The verdict of its page is not in {source}: make the result again.", (PARTIAL,)
    elif told["status"] != "good":
        says, limits = f"{says} {told['headline']}", (AGAINST,)
    yield Evidence("second_model", says, source, limits if same else (AGAINST,))


def _refined(result: ResultFolder) -> Iterator[Evidence]:
    table = result.table("tables/validation.csv")
    if table is None:
        return
    for name, rows in table[table["measure"].str.endswith(": u_num")].groupby("simulation", sort=False):
        row = rows.to_dict("records")[int(pd.to_numeric(rows["value"]).argmax())]
        says = (
            f"{name}: u_num up to {float(row['value']):.2g} {row['unit']} ({row['quantity']}, {row['measure'][:-7]})."
        )
        yield Evidence("refinement", says, result.file("tables/validation.csv"))


CONDITIONS = "tables/validation_conditions.csv"


def _against_trials(result: ResultFolder, limits: tuple[str, ...]) -> Iterator[Evidence]:
    """Error and uncertainty of ASME V&V 20 for each model and protocol."""
    table, source = result.table("tables/validation.csv"), result.file("tables/validation.csv")
    if table is None:
        return
    measured = table[~table["protocol"].isin(("verification", "prediction, code to code"))]
    for (quantity, protocol, model), rows in measured.groupby(["quantity", "protocol", "simulation"], sort=False):
        told = dict(zip(rows["measure"], rows["value"], strict=True))
        error, uncertainty = (float(told.get(key, math.nan)) for key in ("E", "u_val"))
        unit, fitted = rows["unit"].iloc[0], "circular" in str(protocol)
        own = (*limits, CIRCULAR) if fitted else limits
        missing = str(told.get("not assessed", "none"))
        lone = "u_D" in missing.split(", ")
        u_val = "no u_val without u_D, which needs a replicate" if lone else f"u_val {uncertainty:.3g} {unit}"
        says = f"{model}, {quantity}: E {error:.3g} {unit}, {u_val}; not assessed: {missing}."
        yield Evidence("rigour", says, source, (*own, PARTIAL) if lone else own)
        if not lone and math.isfinite(error) and math.isfinite(uncertainty):
            within = abs(error) <= 2 * uncertainty
            says = f"{model}, {quantity} ({protocol}): |E| is {abs(error) / uncertainty:.2g} u_val."
            yield Evidence("agreement", says, source, own if within else (*own, AGAINST))
        if not fitted:
            says = f"{model}, {quantity} of each trial by the stiffness of the others: E {error:.3g} {unit}."
            yield Evidence("unseen", says, source, limits)
    yield from _by_condition(result, limits)


def _by_condition(result: ResultFolder, limits: tuple[str, ...]) -> Iterator[Evidence]:
    """Of several conditions those whose mean peak force a model misses by more than two u_val: the mean hides them."""
    table, source = result.table(CONDITIONS), result.file(CONDITIONS)
    if table is None or table["condition"].nunique() < 2:
        return
    for row in table.to_dict("records"):
        error, uncertainty, data, scatter = (float(row[name]) for name in ("E_N", "u_val_N", "D_N", "u_D_N"))
        if math.isfinite(scatter) and abs(error) > 2 * uncertainty > 0.0:
            who = f"{row['simulation']}, peak force of {row['condition']} ({row['protocol']})"
            off = plain_percent(100.0 * error / data, sign=True)
            says = f"{who}: {off} off, |E| is {abs(error) / uncertainty:.2g} u_val."
            yield Evidence("agreement", says, source, (*limits, AGAINST))


READERS: Final[Mapping[str, Callable[[ResultFolder], Iterator[Evidence]]]] = {
    "discovery.json": _of_discovery,
    "fit.json": _of_fit,
    "verification.json": _of_verification,
    "check.json": _of_check,
    "sweep.json": _of_sweep,
    "results.json": _of_run,
}
