"""`devices`: what is there, what is missing, and the fix."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench_hw.cli._report import Debug, Json, Quiet, print_json, reporting

if TYPE_CHECKING:
    from bench_hw.rig.survey import Finding


def register(app: typer.Typer) -> None:
    """Add the verb."""
    app.command("devices")(devices)


def devices(
    rig: Annotated[str, typer.Option(help="Rig file or shipped rig: look for its devices and check each.")] = "",
    host: Annotated[str, typer.Option(help="Address of a Net F/T box.")] = "",
    http_port: Annotated[int, typer.Option(help="HTTP port of that box.", min=1, max=65_535)] = 80,
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """List devices found and missing, with what to do about those. Sets nothing, moves nothing.

    Without --rig: every kind of device on this machine, exit 0. With --rig: each device of the rig, checked
    to be the one it names; exit 5 if one is not usable.
    """
    with reporting(debug):
        from bench_hw.rig.rig_file import load_rig
        from bench_hw.rig.survey import survey, survey_rig

        findings = survey_rig(load_rig(Path(rig))) if rig else survey(host or None, http_port)
        if as_json:
            print_json({"schema": 1, "devices": [finding.to_dict() for finding in findings]})
        elif not quiet:
            print("\n".join(_lines(findings)))
        if rig and not all(finding.found for finding in findings):
            raise typer.Exit(5)


def _lines(findings: list[Finding]) -> list[str]:
    lines = []
    for finding in findings:
        mark = "found  " if finding.found else "missing"
        lines.append(f"{mark}  {finding.device:<9} {finding.kind:<9} {finding.detail}")
        lines += [f"         fix: {finding.fix}"] if finding.fix else []
    return lines
