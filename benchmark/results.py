"""What the verbs answer in a script: one result object each, all with the same four ways out.

`to_frame()` gives the main table, `summary()` a few lines of text, `plot()` a matplotlib figure, and `report(path)`
writes the result folder that the command line writes and returns its page. All numbers of a result are its fields.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmark.comparison import LayerComparison
from benchmark.discovery.discovery_request import put_down
from benchmark.discovery.discovery_result import Discovery
from benchmark.discovery.report.discovery_record import DiscoveryRecord
from benchmark.identification import SessionFit, parameter_columns
from benchmark.identification.parameters.identified import Identified
from benchmark.runs.finished.carrying_out import RunsSideBySide, write_side_by_side
from benchmark.runs.fit_run import FitRecord, write_fit
from benchmark.runs.output.destination import destination
from benchmark.runs.output.run_folder import write_run
from benchmark.runs.record import RunRecord
from benchmark.runs.tables import run_tables

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM = 1e3
StrPath = str | Path


@dataclass(frozen=True)
class RunResult:
    """FEM and wave model side by side.

    Attributes
    ----------
    record : RunRecord
        Everything that was found, SI.
    """

    record: RunRecord

    @property
    def comparisons(self) -> dict[str, LayerComparison]:
        """Comparison of wave and FEM by layer; empty where one of them has no answer."""
        return {each.layer: each for each in self.record.comparisons}

    @property
    def complete(self) -> bool:
        """False where a solver stopped early."""
        return self.record.complete

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the reader must know."""
        return self.record.warnings

    def tables(self) -> dict[str, pd.DataFrame]:
        """Every table of the result folder by its file's name without `.csv`."""
        return {name.removesuffix(".csv"): _frame(columns) for name, columns in run_tables(self.record).items()}

    def to_frame(self) -> pd.DataFrame:
        """Deflection of each layer's top face: a row a step and layer, as in `max_deformation.csv`."""
        return self.tables()["max_deformation"]

    def summary(self) -> str:
        """Largest deflection by layer and model, and the error between them."""
        peaks = self.to_frame().groupby("layer", sort=False)[["fem_mm", "wave_mm"]].max()
        fem, wave = self.record.pair.fem.name, self.record.pair.wave.name
        lines = [f"{self.record.name}: largest deflection, {fem} and {wave}"]
        for layer, (first, second) in peaks.iterrows():
            compared = np.isfinite([first, second]).all() and first
            error = f"{100.0 * (second / first - 1.0):+.2f} %" if compared else "no comparison"
            lines.append(f"  {layer}: {first:.4g} mm, {second:.4g} mm ({error})")
        compared = self.record.force_comparison
        lines += [] if compared is None else [f"  force at the peak depth: {compared.percent.at_peak:+.2f} %"]
        return "\n".join([*lines, *(f"  warning: {each}" for each in self.warnings)])

    def plot(self) -> Figure:
        """Deflection over force, FEM and wave model or what stands in their places, a panel a layer."""
        frame = self.to_frame()
        layers = list(dict.fromkeys(frame["layer"]))

        def panel(axes: Axes, k: int) -> None:
            rows = frame[frame["layer"] == layers[k]]
            axes.plot(rows["force_N"], rows["fem_mm"], label=self.record.pair.fem.name)
            axes.plot(rows["force_N"], rows["wave_mm"], "--", label=self.record.pair.wave.name)
            axes.set(title=layers[k], xlabel="force (N)", ylabel="deflection (mm)")

        return _panels(len(layers), panel)

    def report(self, path: StrPath | None = None) -> Path:
        """Write the result folder, by default results/NAME-DATE-TIME, and return its page.

        Raises
        ------
        InputError
            `path` holds what is not an unchanged earlier result.
        """
        return write_run(self.record, _place(path, self.record.name)).report


@dataclass(frozen=True)
class FitResult:
    """The parameters of a specimen from its trials.

    Attributes
    ----------
    record : FitRecord
        Session, fit and what was found beside it.
    """

    record: FitRecord

    @property
    def fit(self) -> SessionFit:
        """The fit to the force of all trials."""
        return self.record.found.fit

    @property
    def stiffness_factor(self) -> float:
        """Of force and markers together where there are markers, else of the force alone."""
        return self.record.found.stiffness_factor

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the reader must know."""
        return self.record.warnings

    @property
    def identified(self) -> Identified | None:
        """The fit of parameters: estimates, profiles, directions; None where none were free."""
        return self.record.identified

    def to_frame(self) -> pd.DataFrame:
        """The parameters with intervals: the rows of `fitted_parameters.csv`."""
        return _frame(parameter_columns(self.record.rows))

    def summary(self) -> str:
        """The parameters, a line each."""
        lines = [f"  {row.text}" for row in self.record.rows]
        name = self.record.found.session.name
        return "\n".join([f"{name}: {self.record.headline}", *lines, *(f"  warning: {each}" for each in self.warnings)])

    def plot(self) -> Figure:
        """Measured force over depth, a line a trial."""

        def panel(axes: Axes, _: int) -> None:
            for trial in self.record.found.trials:
                axes.plot(MM * trial.depth, trial.force, linewidth=0.8, label=trial.label)
            axes.set(title=self.record.found.session.name, xlabel="depth (mm)", ylabel="force (N)")

        return _panels(1, panel)

    def report(self, path: StrPath | None = None) -> Path:
        """Write fit.json, fitted_parameters.csv and report.html, and return the page; see `RunResult.report`."""
        return write_fit(self.record, _place(path, f"{self.record.found.session.name}-fit")).folder / "report.html"


@dataclass(frozen=True)
class DiscoveryResult:
    """What the model lacks.

    Attributes
    ----------
    record : DiscoveryRecord
        The answer with where it came from.
    """

    record: DiscoveryRecord

    @property
    def found(self) -> Discovery:
        """The answer: verdict, effects, places, gap, candidates."""
        return self.record.found

    @property
    def verdict(self) -> str:
        """The verdict in one word."""
        return self.found.verdict

    @property
    def effects(self) -> tuple[str, ...]:
        """Slugs of the effects of the answer, best first; under `outside_catalogue` the nearest entries."""
        return tuple(effect.slug for effect in self.found.effects)

    def to_frame(self) -> pd.DataFrame:
        """The effects' parameters: effect, name, value, unit, ci95_low, ci95_high, in SI units."""
        return _frame(
            [
                {"effect": effect.slug, "name": each.name, "value": each.value, "unit": each.unit,
                 "ci95_low": each.ci95[0], "ci95_high": each.ci95[1]}
                for effect in self.found.effects
                for each in effect.parameters
            ]
        )  # fmt: skip

    def summary(self) -> str:
        """The answer in a sentence, and the gap by channel."""
        gaps = [
            f"  {gap.channel}: {_percent(gap.closed)} of the gap closed on a held-out {gap.held_out}"
            for gap in self.found.gap
        ]
        return "\n".join([f"{self.record.name}: {self.verdict}: {self.found.statement}", *gaps])

    def plot(self) -> Figure:
        """The first trial of each condition and channel: measured, before, after."""
        firsts = list({(trace.condition, trace.channel): trace for trace in reversed(self.found.traces)}.values())[::-1]

        def panel(axes: Axes, k: int) -> None:
            trace = firsts[k]
            scale, unit = (1.0, "N") if trace.channel == "force_z" else (MM, "mm")
            axes.plot(trace.time, scale * trace.measured, ".", markersize=3, label="measured")
            axes.plot(trace.time, scale * trace.before, label="before")
            axes.plot(trace.time, scale * trace.after, "--", label="after")
            axes.set(title=f"{trace.condition}, {trace.trial}", xlabel="time (s)", ylabel=f"{trace.channel} ({unit})")

        return _panels(len(firsts), panel)

    def report(self, path: StrPath | None = None) -> Path:
        """Write the result folder of `discover` and return its page; see `RunResult.report`."""
        return put_down(self.record, None if path is None else Path(path)).folder / "report.html"


@dataclass(frozen=True)
class SweepResult:
    """Many points of a scenario, in their folder.

    Attributes
    ----------
    folder : Path
        With points.parquet and report.html.
    headline : str
    document : mapping
        What varied, how many points succeeded, and Sobol indices where they were asked for.
    """

    folder: Path
    headline: str
    document: Mapping[str, Any]

    def to_frame(self) -> pd.DataFrame:
        """A row a point: what varied, the results with units in their names, status and reason."""
        import pandas as pd

        return pd.read_parquet(self.folder / "points.parquet")

    def summary(self) -> str:
        """What was found in a sentence, and how many points failed."""
        return f"{self.document['name']}: {self.headline} ({self.document['ok']} of {self.document['points']} points)"

    def plot(self) -> Figure:
        """The first result over each parameter that varied, a point a run."""
        frame, result = self.to_frame(), self.document["results"][0]
        keys = [key for key in self.document["vary"] if key in frame]

        def panel(axes: Axes, k: int) -> None:
            axes.plot(frame[keys[k]], frame[result], "o", markersize=3, label=result)
            axes.set(xlabel=keys[k], ylabel=result)

        return _panels(len(keys), panel)

    def report(self) -> Path:
        """The page, which was written with the last point."""
        return self.folder / "report.html"


@dataclass(frozen=True)
class ComparisonResult:
    """Finished runs side by side.

    Attributes
    ----------
    record : RunsSideBySide
        The runs by name, parameters that differ, and the table of results.
    """

    record: RunsSideBySide

    def to_frame(self) -> pd.DataFrame:
        """Results: a row a run and layer."""
        return _frame(self.record.results)

    def parameters(self) -> pd.DataFrame:
        """Parameters that are not the same in all runs."""
        return _frame(self.record.changed)

    def summary(self) -> str:
        """What differs between the runs, a line a parameter."""
        lines = self.parameters().to_string(index=False) if len(self.parameters()) else "no parameter differs"
        return f"{', '.join(self.record.runs)}\n{lines}"

    def plot(self) -> Figure:
        """Largest deflection of each layer by run, FEM and wave model or what stands in their places."""
        frame, pairs = self.to_frame(), [run.record.pair for run in self.record.runs.values()]

        def names(place: str) -> dict[str, None]:
            return dict.fromkeys(getattr(pair, place).name for pair in pairs)

        layers = list(dict.fromkeys(frame["layer"]))

        def panel(axes: Axes, k: int) -> None:
            rows = frame[frame["layer"] == layers[k]]
            axes.plot(rows["run"], rows["fem_max_mm"], "o", label=", ".join(names("fem")))
            axes.plot(rows["run"], rows["wave_max_mm"], "s", label=", ".join(names("wave")))
            axes.set(title=layers[k], ylabel="largest deflection (mm)")

        return _panels(len(layers), panel)

    def report(self, path: StrPath | None = None) -> Path:
        """Write the page that sets the runs side by side and return it; see `RunResult.report`."""
        place = None if path is None else Path(path)
        return write_side_by_side(self.record, place).folder / "report.html"


def _frame(columns: Any) -> pd.DataFrame:
    import pandas as pd

    return pd.DataFrame(columns)


def _place(path: StrPath | None, name: str) -> Path:
    return destination(None if path is None else Path(path), name)


def _percent(share: float | None) -> str:
    return "an unknown share" if share is None else f"{100.0 * share:.0f} %"


def _panels(count: int, draw: Callable[[Axes, int], None]) -> Figure:
    """A figure of panels in a row, each drawn by its number, with a legend where it has labels."""
    from matplotlib.figure import Figure as Drawing

    figure = Drawing(figsize=(4.0 * max(count, 1), 3.2), layout="constrained")
    for k in range(count):
        axes = figure.add_subplot(1, count, k + 1)
        draw(axes, k)
        if axes.get_legend_handles_labels()[0]:
            axes.legend(fontsize="small")
    return figure
