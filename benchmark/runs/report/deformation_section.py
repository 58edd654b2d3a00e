"""Section: deformations of FEM and wave model layer by layer, and both models' layers drawn under the press."""

from __future__ import annotations

import numpy as np

from benchmark.comparison import LayerComparison
from benchmark.runs.record import RunRecord
from benchmark.runs.report.values import MM, fem_mm, pair_names, peak_errors, profile_errors, profile_mm, wave_mm
from benchmark.runs.tables import percent_errors
from benchmark.side_by_side.parameter_bands import ParameterBands
from reports import Block, Column, Download, Figure, Notice, Section, Table
from reports.figures.deflection import deformation_bands, max_deformation, profile
from reports.figures.load_curves import force_depth
from reports.figures.pressed_layers import pressed_layers

BANDS = "parameter_bands.csv"


def deformation_section(record: RunRecord, picture: Block | None = None) -> Section:
    """Return the section on maximum deformations and profiles, with a picture of the pressed tissue."""
    fem, wave = record.pair.fem.result, record.pair.wave.result
    blocks: list[Block] = [_table(record)]
    blocks.append(layer_deformations(record))
    blocks.append(
        Notice(
            "finding",
            f"Percent errors are those of the {record.pair.wave.name} against the {record.pair.fem.name}; no value of "
            f"the {record.pair.fem.name} was fed in.",
        )
    )
    reference = fem if fem is not None else wave
    if reference is not None:
        empty = np.full_like(reference.profile, np.nan)
        blocks.append(
            profile(
                record.layers,
                MM * reference.profile_radii,
                empty if fem is None else profile_mm(fem),
                profile_mm(wave),
                MM * record.scenario.tool.radius,
                pair_names(record),
            )
        )
    if fem is not None and fem.time.size:
        blocks.append(_force_depth(record))
    layers = pressed_block(record)
    if layers is not None:
        blocks.append(layers)
    if picture is not None:
        blocks.append(picture)
    return Section("Deformation", blocks)


def layer_deformations(record: RunRecord) -> Figure:
    """Return each layer's deflection over the load steps, both models, and the error (Fig. 12)."""
    return max_deformation(
        record.layers,
        np.arange(1, record.time.size + 1),
        fem_mm(record),
        wave_mm(record),
        None if record.pair.wave.result is None else percent_errors(record),
        pair=pair_names(record),
    )


def _table(record: RunRecord) -> Table:
    """Maximum per layer and errors."""
    columns = (
        "layer",
        Column(f"{record.pair.fem.name} maximum", "mm"),
        Column(f"{record.pair.wave.name} maximum", "mm"),
        Column("error at peak", "%", 3),
        Column("mean |error|", "%", 3),
        Column("max |error|", "%", 3),
        Column("largest profile error", "% of peak", 3),
    )
    errors = peak_errors(record)
    comparisons = {comparison.layer: comparison for comparison in record.comparisons}
    profiles = profile_errors(record)
    rows = [
        (*_row(record, column, name, errors, comparisons), profiles.get(name))
        for column, name in enumerate(record.layers)
    ]
    return Table(
        "Maximum deformation of each layer's top face on the tool axis",
        columns,
        rows,
        download=Download("tables/max_deformation.csv", "every step and layer"),
    )


def _row(
    record: RunRecord,
    column: int,
    name: str,
    errors: dict[str, float],
    comparisons: dict[str, LayerComparison],
) -> tuple[object, ...]:
    fem, wave = record.pair.fem.result, record.pair.wave.result
    comparison = comparisons.get(name)
    return (
        name,
        None if fem is None else MM * record.max_deformation(fem)[column],
        None if wave is None else MM * record.max_deformation(wave)[column],
        errors.get(name),
        comparison.percent.mean if comparison and wave is not None else None,
        comparison.percent.maximum if comparison and wave is not None else None,
    )


def _force_depth(record: RunRecord) -> Block:
    fem, wave = record.pair.fem.result, record.pair.wave.result
    assert fem is not None
    planned = abs(record.scenario.load.peak) if record.scenario.load.control == "force" else None
    return force_depth(
        MM * fem.depth,
        fem.force,
        None if wave is None else MM * wave.depth,
        None if wave is None else wave.force,
        planned,
        pair_names(record),
    )


REACH = 4.0
"""Tool radii round its axis that are shown."""


def pressed_block(record: RunRecord) -> Block | None:
    """The layers as they lie at peak load; None where they are no body of revolution, or no model has a profile."""
    scenario = record.scenario
    results = (record.pair.fem.result, record.pair.wave.result)
    reference = next((each for each in results if each is not None and each.time.size), None)
    if reference is None or scenario.fem.geometry != "axisymmetric":
        return None
    near = reference.profile_radii <= REACH * scenario.tool.radius * (1.0 + 1e-9)
    fem, wave = (None if each is None else MM * each.profile[:, near] for each in results)
    thickness = [MM * layer.thickness for layer in scenario.tissue.layers]
    depths = np.concatenate([[0.0], np.cumsum(thickness)])
    return pressed_layers(
        record.layers,
        depths[:-1],
        float(depths[-1]) if scenario.support.kind == "bonded" else None,
        MM * reference.profile_radii[near],
        fem,
        wave,
        MM * scenario.tool.radius,
        pair_names(record),
    )


def bands_section(record: RunRecord, bands: ParameterBands) -> Section:
    """Return the section of a run whose scenario states uncertainties."""
    blocks: list[Block] = [_bands_table(record)]
    fem, wave = fem_mm(record), wave_mm(record)
    if np.isfinite(fem).any():
        factors = None if wave is None else bands.factor(bands.wave)
        blocks.append(
            deformation_bands(
                record.layers, record.force(), fem, bands.factor(bands.fem), wave, factors, pair_names(record)
            )
        )
    pairs = zip(bands.keys, bands.shares, strict=True)
    told = ", ".join(f"{key} {100 * share:.3g} %" for key, share in pairs)
    lost = [key for key in record.scenario.tissue.not_determined or () if key not in bands.keys]
    left = f" Left out as not determined, so that the bands are too narrow: {', '.join(lost)}." if lost else ""
    correlated = " and their correlations" if record.scenario.tissue.correlations else ", taken as independent"
    blocks.append(
        Notice(
            "finding",
            f"Standard uncertainties ({told}){correlated}, propagated to first order: finite elements by {bands.by}, "
            f"wave by central differences. Both models move together: their difference is surer than either.{left}",
        )
    )
    return Section("What the parameters leave", blocks)


def _bands_table(record: RunRecord) -> Table:
    columns = (
        "layer",
        Column("wave against FEM", "%", 3),
        Column("FEM up to", "%", 3),
        Column("wave up to", "%", 3),
        Column("difference moves by", "%", 3),
        "beside the parameters the difference",
    )
    rows = [
        (
            one.layer,
            one.difference,
            one.fem,
            one.wave,
            one.of_difference,
            "matters" if one.matters else "does not matter",
        )
        for one in record.beside
    ]
    return Table(
        "Difference of the models at peak load beside the 95 % bands that uncertain parameters leave",
        columns,
        rows,
        download=Download(f"tables/{BANDS}", "bands at every step"),
    )
