"""Sections: what is pressed, with what, and how; and how the numbers were made."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from benchmark.files import Layer, Scenario, Tool
from benchmark.runs.record import RunRecord
from benchmark.runs.report.values import MM, padded, pair_names
from reports import Block, Column, Fact, Facts, Listing, Paragraph, Section, Table
from reports.figures.layer_stack import StackLayer, layer_stack
from reports.figures.load_curves import load_history
from reports.figures.tool_outline import ToolShape

CONTACTS = {
    "uniform_pressure": "uniform pressure",
    "rigid_bonded": "rigid, bonded",
    "rigid_frictionless": "rigid, frictionless",
    "rigid_frictional": "rigid, frictional",
}


def scenario_section(record: RunRecord) -> Section:
    """Return the section on tissue, tool, support and load."""
    scenario = record.scenario
    blocks: list[Block] = [_facts(scenario), layer_stack_of(scenario), layer_table(scenario), _history(record)]
    return Section("Scenario", blocks)


def _facts(scenario: Scenario) -> Facts:
    tool, load = scenario.tool, scenario.load
    peak = f"{load.peak:g} N" if load.control == "force" else f"{MM * load.peak:g} mm"
    support = scenario.support.kind.replace("_", " ")
    if scenario.support.kind == "hole" and scenario.support.hole_radius is not None:
        support += f" of radius {MM * scenario.support.hole_radius:g} mm"
    if scenario.support.specimen_radius is not None:
        support += f", a cylinder of radius {MM * scenario.support.specimen_radius:g} mm with a free side"
    return Facts(
        (
            Fact("Tissue", scenario.tissue.name),
            Fact("Source", scenario.tissue.citation or "not stated in the file"),
            Fact("Tool", f"{tool_shape(tool).words}, radius {MM * tool.radius:g} mm, {CONTACTS[tool.contact]}"),
            Fact("Support", support),
            Fact(
                "Load",
                f"{load.control} control, {load.shape.replace('_', ' ')} to {peak} in {load.duration:g} s",
            ),
            Fact("FEM kinematics", "finite strain" if scenario.fem.kinematics == "finite" else "small strain"),
        )
    )


def layer_stack_of(scenario: Scenario) -> Block:
    """Return the picture of the layers, of what stands on them, and of what holds them."""
    layers = [
        StackLayer(
            layer.name,
            MM * layer.thickness if np.isfinite(layer.thickness) else None,
            layer.youngs_modulus / 1e3,
        )
        for layer in scenario.tissue.layers
    ]
    support = scenario.support
    hole = None if support.hole_radius is None else MM * support.hole_radius
    side = None if support.specimen_radius is None else MM * support.specimen_radius
    return layer_stack(layers, tool_shape(scenario.tool), support.kind, hole, side)


def tool_shape(tool: Tool) -> ToolShape:
    """The tool as it is drawn and called."""
    return ToolShape(MM * tool.radius, MM * (tool.edge_radius or 0.0), tool.tilt)


def layer_table(scenario: Scenario) -> Table:
    """Return the layers' properties."""
    columns = (
        "layer",
        Column("thickness", "mm"),
        Column("density", "kg/m³"),
        Column("Young's modulus", "kPa"),
        Column("Poisson's ratio"),
        "law",
    )
    rows = [
        (
            layer.name,
            MM * layer.thickness if np.isfinite(layer.thickness) else "endless",
            layer.density,
            layer.youngs_modulus / 1e3,
            layer.poisson_ratio,
            _law(scenario, layer),
        )
        for layer in scenario.tissue.layers
    ]
    return Table("Layers from the surface down, as the models take them", columns, rows)


def _law(scenario: Scenario, layer: Layer) -> str:
    """A layer's law in words, with its Prony series."""
    law = "linear elastic" if scenario.fem.kinematics == "linear" else layer.hyperelastic.law.replace("_", "-")
    terms = ", ".join(f"{term.g:g} in {term.tau:g} s" for term in layer.relaxation)
    return f"{law}; of its shear relax {terms}" if terms else law


def _history(record: RunRecord) -> Block:
    force = record.scenario.load.control == "force"
    answers = []
    for run in (record.pair.fem, record.pair.wave):
        result = run.result
        values = None if result is None else (MM * result.depth if force else result.force)
        answers.append(padded(result, values, record.time.size))
    load = record.load if force else MM * record.load
    fem, wave = answers
    return load_history(record.time, load, record.scenario.load.control, fem, wave, pair_names(record))


PROTOCOL = (
    "Protocol: prediction. Both models get the same layers, tool, support and load; no value of the {fem} is fed into "
    "the {wave}."
)


def method_section(record: RunRecord, environment: Mapping[str, Any]) -> Section:
    """Return the section on models, versions and the resolved scenario."""
    blocks: list[Block] = [Paragraph(PROTOCOL.format(fem=record.pair.fem.name, wave=record.pair.wave.name))]
    for run in (record.pair.fem, record.pair.wave):
        label = f"{run.name[0].upper()}{run.name[1:]}"
        if run.result is None:
            blocks.append(Paragraph(f"{label}: no values; {run.declined}."))
            continue
        notes = [Fact(f"{label}: {name}", text) for name, text in run.result.notes.items()]
        unknowns = "not stated" if run.result.unknowns is None else str(run.result.unknowns)
        blocks.append(Facts((Fact(f"{label}: unknowns", unknowns), *notes)))
    versions = "\n".join(f"{name} {version}" for name, version in environment["packages"].items())
    blocks.append(Listing(versions, "Versions"))
    blocks.append(Listing(record.scenario.to_toml(), "The resolved scenario (scenario.toml)"))
    return Section("Method", blocks)
