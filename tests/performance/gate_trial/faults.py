"""What is put into a copy of the product to make it slower or wrong: code at the end of one of its modules.

The gate knows nothing of it: it measures a folder whose code is what it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

HOWS = ("work", "burn", "repeat", "sleep")

SLOWER = """

import time as _clock_of_the_fault


_GOLDEN = 0.6180339887498949


def _slower(function, share={share}, how={how!r}):
    owed, calls = [0.0], [0]

    def repeated(*arguments, **keywords):
        calls[0] += 1
        if calls[0] * _GOLDEN % 1.0 < share:
            function(*arguments, **keywords)
        return function(*arguments, **keywords)

    def delayed(*arguments, **keywords):
        start = _clock_of_the_fault.process_time()
        result = function(*arguments, **keywords)
        end = _clock_of_the_fault.process_time()
        owed[0] += share * (end - start)
        if how == "burn":
            while _clock_of_the_fault.process_time() - end < owed[0]:
                pass
            owed[0] = 0.0
        elif owed[0] >= 1e-3:
            _clock_of_the_fault.sleep(owed[0])
            owed[0] = 0.0
        return result

    return repeated if how == "repeat" else delayed


{assignments}
"""

OFF = """

_run = {model}.run


def _off(self, *arguments, **keywords):
    from dataclasses import replace

    result = _run(self, *arguments, **keywords)
    deflection = result.{field}.copy()
    rows = deflection{layers_first}
    if -len(rows) <= {layer} < len(rows):
        rows[{layer}] *= {factor}
    return replace(result, {field}=deflection)


{model}.run = _off
"""


@dataclass(frozen=True)
class Fault:
    """What is wrong with a copy: its name, the module, and the code that is put at its end."""

    name: str
    module: str
    code: str

    def put_into(self, tree: Path) -> None:
        """Append the code to the module in `tree`."""
        with (tree / self.module).open("a", encoding="utf-8") as stream:
            stream.write(self.code)


def slowdowns(share: float, how: str) -> list[Fault]:
    """One fault for each part of the product whose time is gated: its functions slower by a share of their CPU time.

    Parameters
    ----------
    share
        0.25 is 25 %.
    how
        burn: an empty loop after each call; repeat: that share of the calls is made twice, those whose multiple of the
        golden ratio says so, since every tenth call would be the same one in each block where a block makes twenty;
        sleep: the share is slept away, a millisecond or more at a time; work: repeat for what is called many times in a
        block, burn for the rest. A loop after a call of 40 microseconds adds some 5 % of its own.
    """
    often, once = ("repeat", "burn") if how == "work" else (how, how)
    return [
        _slower("wave.frame", "wavemodel/layered/surface.py", ("Surface.frame",), share, often),
        _slower("fem.assembly", "fem/assembly/system.py", ("System.evaluate", "System.tangent"), share, often),
        _slower("fem.step", "fem/analysis/prepared.py", ("Model.run",), share, once),
        _slower("fit", "benchmark/identification/session_fit.py", ("fit_session",), share, once),
    ]


def deflections(factor: float) -> list[Fault]:
    """One fault for each gated deflection of FEM and wave, times a factor: layers, and the profile of the surface."""
    models = {"FemModel": "benchmark/models/fem_model.py", "WaveModel": "benchmark/models/wave_model.py"}
    places = [(f"layer {layer}", "top_deflection", ".T", layer) for layer in (0, -2, -1)]
    places.append(("surface", "profile", "", 0))
    return [
        Fault(
            f"{model} {name} x {factor:g}",
            module,
            OFF.format(model=model, field=field, layers_first=layers_first, layer=layer, factor=factor),
        )
        for model, module in models.items()
        for name, field, layers_first, layer in places
    ]


def _slower(name: str, module: str, functions: Sequence[str], share: float, how: str) -> Fault:
    assignments = "\n".join(f"{function} = _slower({function})" for function in functions)
    return Fault(name, module, SLOWER.format(share=share, how=how, assignments=assignments))
