"""`results.json`, the run in one object for programs, and `environment.json`, where it was made."""

from __future__ import annotations

import os
import platform
import sys
from dataclasses import asdict
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

from benchmark.comparison import comparison_summary
from benchmark.models import LastState
from benchmark.runs.fields import LAST
from benchmark.runs.record import RunRecord
from benchmark.runs.report.values import measured_headline
from benchmark.runs.validation import mesh_error_entry
from benchmark.side_by_side import ModelRun

SCHEMA = 1
FITTED = "circular"
"""Of both models beside the trials that their stiffness was fitted to; `protocol` is that of FEM beside wave model."""


def results_document(record: RunRecord) -> dict[str, Any]:
    """Return the content of `results.json`; None stands where a model has no value."""
    scenario, ratio = record.scenario, record.pair.speedup
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "name": record.name,
        "scenario": scenario.name,
        "tissue": scenario.tissue.name,
        "protocol": "prediction",
        "complete": record.complete,
        "warnings": list(record.warnings),
        "models": {run.model: _model(run, record) for run in (record.pair.fem, record.pair.wave)},
        "comparison": comparison_summary(record.comparisons),
        **({} if record.force_comparison is None else {"force": record.force_comparison.summary()}),
        "equivalence_margin": scenario.comparison.equivalence_margin,
        "speedup": {
            "median": ratio.median if ratio else None,
            "ci95": list(ratio.ci95) if ratio else None,
            "interval": ratio.spread if ratio else None,
            "coverage": ratio.coverage if ratio else None,
            "with_setup": ratio.with_setup if ratio else None,
            "pays_from_histories": ratio.pays_from if ratio else None,
            "repeats": ratio.repeats if ratio else 0,
        },
    }
    if record.bands is not None:
        document["parameter_bands"] = {
            one.layer: {**vars(one), "matters": one.matters, "text": one.text} for one in record.beside
        }
    if record.effects:
        document["effects"] = list(record.effects)
    if record.measured is not None:
        document["trials"] = {
            "session": record.measured.session.name,
            "synthetic": record.measured.session.synthetic,
            "fingerprint": record.measured.session.fingerprint,
            "count": len(record.measured.trials),
            "protocol": FITTED,
            "headline": measured_headline(record.measured),
            "notes": list(record.measured.fit.notes),
        }
    return document


def _model(run: ModelRun, record: RunRecord) -> dict[str, Any]:
    """One model's entry."""
    result, seconds = run.result, run.seconds
    largest = None if result is None else 1e3 * result.max_deformation()
    return {
        "name": run.name,
        "covers_scenario": result is not None,
        "reason": run.declined,
        "unknowns": None if result is None else result.unknowns,
        "seconds": {part: None if seconds is None else getattr(seconds, part) for part in ("setup", "wall", "cpu")},
        "max_deformation_mm": {
            name: None if largest is None else float(largest[column]) for column, name in enumerate(record.layers)
        },
        "peak_memory_MB": None if run.peak_memory is None else run.peak_memory / 1e6,
        "picture_us": None if run.frame is None else 1e6 * run.frame,
        "choices": None if result is None or result.choices is None else asdict(result.choices),
        "notes": {} if result is None else dict(result.notes),
        "mesh_error": None if result is None or result.mesh_error is None else mesh_error_entry(result.mesh_error),
        "resumed": None if result is None or result.resumed is None else asdict(result.resumed),
        "failure": None if result is None or result.failure is None else str(result.failure),
        "last_state": None if result is None or result.last is None else _last_state(result.last, record.layers),
    }


def _last_state(last: LastState, layers: tuple[str, ...]) -> dict[str, Any]:
    """The last state of equilibrium of a run that stopped early."""
    return {
        "time_s": last.time,
        "force_N": last.force,
        "depth_mm": 1e3 * last.depth,
        "deflection_mm": dict(zip(layers, (1e3 * last.top_deflection).tolist(), strict=True)),
        "fields": f"fields/{LAST}",
    }


PACKAGES = (
    "tissuebench", "numpy", "scipy", "scikit-fem", "pypardiso", "statsmodels", "pandas", "pydantic", "pint",
    "matplotlib", "pyvista",
)  # fmt: skip


def describe_environment(*, seed: int) -> dict[str, Any]:
    """Return the content of `environment.json`."""
    return {
        "schema": 1,
        "made": datetime.now(UTC).isoformat(timespec="seconds"),
        "python": sys.version.split()[0],
        "platform": platform.platform(),
        "processor": _processor(),
        "logical_cores": os.cpu_count(),
        "usable_cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count(),
        "threads_per_model": 1,
        "seed": seed,
        "packages": {name: _version(name) for name in PACKAGES},
    }


def _version(name: str) -> str | None:
    """Installed version of a distribution, None where it is missing."""
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _processor() -> str:
    """Name of the processor, as far as the system tells."""
    try:
        with Path("/proc/cpuinfo").open(encoding="utf-8") as lines:
            names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    except OSError:
        names = []
    return names[0] if names else platform.processor() or platform.machine()
