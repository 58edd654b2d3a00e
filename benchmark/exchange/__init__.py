"""Scenarios and identified specimens as input files of other finite-element codes.

`exported_press` is what is exported, `calculix_deck` and `febio_file` write it; what those codes answer is read by
`benchmark.models.fea_results`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from benchmark.errors import InputError
from benchmark.exchange.calculix_deck import calculix_deck
from benchmark.exchange.exported_press import ExportedPress, exported_press
from benchmark.exchange.febio_file import febio_file
from benchmark.files import Scenario

FORMATS: Mapping[str, Callable[[ExportedPress], str]] = MappingProxyType({"inp": calculix_deck, "feb": febio_file})
"""Writers by the ending of their files."""


def export_text(scenario: Scenario, ending: str) -> str:
    """A scenario as the text of another code's input file.

    Parameters
    ----------
    scenario : Scenario
    ending : str
        One of `FORMATS`.

    Raises
    ------
    InputError
        Another ending, or what that code cannot express.
    """
    writer = FORMATS.get(ending)
    if writer is None:
        raise InputError(f"--export {ending}: no such format; allowed: {', '.join(FORMATS)}")
    return writer(exported_press(scenario, memory=ending == "feb"))


__all__ = ["FORMATS", "export_text"]
