"""What was identified as input files of other codes: one of each set-up that was pressed, under depth control."""

from __future__ import annotations

from collections.abc import Sequence

from benchmark.errors import InputError
from benchmark.exchange.export_files import FORMATS, export_text
from benchmark.files import Load, Scenario, Session, Support, Tissue, Tool
from benchmark.identification.parameters.identified import Identified
from benchmark.identification.parameters.identified_tissue import identified_tissue

ROWS, SECONDS = 20, 10.0
"""Steps and duration of an exported press; without relaxation the duration is of no account."""


def check_exports(session: Session, endings: Sequence[str], *, free: bool) -> None:
    """Refuse, before a fit, formats and set-ups that cannot be written.

    Raises
    ------
    InputError
        By name, as `benchmark.exchange.export_text`; or nothing is free, so that nothing will be identified.
    """
    if endings and not free:
        raise InputError("--export writes what was identified: give --free KEY,KEY with it")
    unknown = [ending for ending in endings if ending not in FORMATS]
    if unknown:
        raise InputError(f"--export {unknown[0]}: no such format; allowed: {', '.join(FORMATS)}")
    for tool, support in dict.fromkeys((trial.tool, trial.support) for trial in session.trials):
        for ending in endings:
            export_text(
                _press(session, session.specimen, tool, support, 0.1 * session.specimen.layers[0].thickness), ending
            )


def exports(answer: Identified, endings: Sequence[str]) -> tuple[tuple[tuple[str, str], ...], tuple[str, ...]]:
    """Names and texts of the files, one a set-up and format; and what could not be written, in words."""
    out, said = [], []
    for number, press in enumerate(answer.found.problem.presses, start=1):
        tissue = identified_tissue(answer, press.specimen)
        scenario = _press(press.session, tissue, *press.setup[1:], press.depth)
        for ending in endings:
            try:
                out.append((f"identified_press_{number}.{ending}", export_text(scenario, ending)))
            except InputError as error:
                said.append(f"press {number} was not written: {error}")
    return tuple(out), tuple(said)


def _press(session: Session, tissue: Tissue, tool: Tool, support: Support, depth: float) -> Scenario:
    load = Load(control="depth", peak=depth, shape="ramp", duration=SECONDS, observations=ROWS)
    return session.scenario(tissue, tool, support, load)
