"""The harness: joins fem, wavemodel, bench_hw and reports, on the command line and in a script.

    import benchmark

    run = benchmark.run("skin-5N", set={"dermis.youngs_modulus": "120 kPa"})
    print(run.summary())
    run.to_frame()                # deflection of each layer, a row a step and layer
    run.plot().savefig("press.svg")
    run.report("press")           # the folder that `python -m benchmark run --out press` writes

`fit`, `discover`, `sweep` and `compare` answer in the same way; `benchmark.results` has every result object.
"""

from importlib import import_module

TYPE_CHECKING = False  # not from `typing`: this is imported before files of the current folder are passed over
if TYPE_CHECKING:
    from benchmark.scripting import compare, discover, fit, run, sweep

__all__ = ["compare", "discover", "fit", "run", "sweep"]


def __getattr__(name: str) -> object:
    """Import the verbs when one is used: the command line's `--help` does without."""
    if name not in __all__:
        raise AttributeError(f"module 'benchmark' has no attribute {name!r}")
    return getattr(import_module("benchmark.scripting"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
