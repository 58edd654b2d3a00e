"""Evidence as `reproduce` gathers it, from two trials without a film and from coarse meshes."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import replace

import pytest

from benchmark.cli.console import Console
from benchmark.files import load_scenario, load_session
from benchmark.reproduce.evidence import Chain, Evidence, follow_chain
from benchmark.runs.options import RunOptions
from benchmark.runs.scenario_run import run_scenario
from benchmark.sessions import SHIPPED

QUIET = Console(quiet=True)


@pytest.fixture(scope="package")
def chain() -> Chain:
    session = load_session(SHIPPED / "phantom")
    few = tuple(trial for trial in session.trials if trial.name in ("press_02", "press_03", "rich_02"))
    return follow_chain(replace(session, trials=few), QUIET)


@pytest.fixture(scope="package")
def evidence(chain: Chain, threads: Callable[[], AbstractContextManager[None]]) -> Evidence:
    with threads():
        table_2, press = (
            run_scenario(load_scenario(name, {"fem.mesh": "coarse", **more}), RunOptions(repeats=0), QUIET)
            for name, more in (
                ("paper", {"load.observations": "20"}),
                ("skin-5N", {"load.observations": "8", "load.peak": "1 N"}),
            )
        )
    return Evidence(chain, table_2, press)
