"""Section: what is pressed, with what, and how."""

from __future__ import annotations

import numpy as np

from benchmark.files import Scenario
from benchmark.runs.record import RunRecord
from benchmark.runs.report.values import MM, padded, pair_names
from reports import Block, Column, Fact, Facts, Section, Table
from reports.figures.layer_stack import StackLayer, layer_stack
from reports.figures.load_history import load_history

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
    return Facts(
        (
            Fact("Tissue", scenario.tissue.name),
            Fact("Source", scenario.tissue.citation or "not stated in the file"),
            Fact("Tool", f"flat, radius {MM * tool.radius:g} mm, {CONTACTS[tool.contact]}"),
            Fact("Support", support),
            Fact(
                "Load",
                f"{load.control} control, {load.shape.replace('_', ' ')} to {peak} in {load.duration:g} s",
            ),
            Fact("FEM kinematics", "finite strain" if scenario.fem.kinematics == "finite" else "small strain"),
        )
    )


def layer_stack_of(scenario: Scenario) -> Block:
    """Return the picture of the layers."""
    layers = [
        StackLayer(
            layer.name,
            MM * layer.thickness if np.isfinite(layer.thickness) else None,
            layer.youngs_modulus / 1e3,
        )
        for layer in scenario.tissue.layers
    ]
    return layer_stack(layers, MM * scenario.tool.radius)


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
            "linear elastic" if scenario.fem.kinematics == "linear" else layer.hyperelastic.law.replace("_", "-"),
        )
        for layer in scenario.tissue.layers
    ]
    return Table("Layers from the surface down, as the models take them", columns, rows)


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
