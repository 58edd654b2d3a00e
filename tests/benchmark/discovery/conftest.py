"""A discovery made by hand: two conditions, force and markers, relaxation named, a rival beside it."""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmark.discovery.discovery_result import (
    Candidate,
    ChannelGap,
    Contrast,
    Discovery,
    Estimate,
    NamedEffect,
    Place,
    Trace,
)
from benchmark.discovery.report.discovery_record import DiscoveryRecord
from benchmark.physics.description import EffectDescription, EffectParameter

RELAXATION = EffectDescription(
    slug="viscoelastic_relaxation",
    acts_on="body",
    sentence="The force fades while the depth is held, and rate matters.",
    equation="F(t) = int G(t - t') df(t'), G = 1 - sum g_j (1 - exp(-t / tau_j))",
    source="Y. C. Fung, Biomechanics, section 7.6",
    parameters=(
        EffectParameter("g_1", "", (0.3,), 0.0, 0.95, False, "share that fades"),
        EffectParameter("tau_1", "s", (1.0,), 0.01, 1e3, True, "time over which it fades"),
        EffectParameter("g_2", "", (0.1,), 0.0, 0.95, False, "second share"),
        EffectParameter("tau_2", "s", (10.0,), 0.01, 1e3, True, "second time"),
    ),
    may_lack=(("g_2", "tau_2"),),
)
COMPLIANCE = EffectDescription(
    slug="machine_compliance",
    acts_on="drive",
    sentence="The rig gives way in series with the tissue.",
    equation="d_tissue = d - c F",
    source="series springs",
    parameters=(EffectParameter("compliance", "m/N", (1e-4,), 1e-7, 1e-2, True, "depth lost per force"),),
)


def _trace(trial: str, condition: str, channel: str, speed: float, held_out: bool) -> Trace:
    time = np.linspace(0.0, 20.0, 300)
    depth = np.minimum(speed * time, 2e-3)
    elastic = 1000.0 * depth
    measured = elastic * (1.0 - 0.3 * (1.0 - np.exp(-time / 3.0)))
    wobble = 0.01 * np.sin(7.0 * time)
    scale = 1.0 if channel == "force_z" else 1e-4
    return Trace(
        trial=trial,
        condition=condition,
        channel=channel,
        held_out=held_out,
        time=time,
        depth=depth,
        measured=scale * (measured + wobble),
        before=scale * 0.85 * elastic,
        after=scale * measured,
        noise=np.full(time.size, scale * 0.02),
    )


@pytest.fixture
def found() -> Discovery:
    """A finished discovery."""
    traces = [
        _trace(f"trial_{number:03d}", condition, channel, speed, held)
        for number, (condition, speed, held) in enumerate(
            [("slow", 4e-4, False), ("slow", 4e-4, False), ("fast", 2e-3, True), ("fast", 2e-3, True)], start=1
        )
        for channel in ("force_z", "marker_radial")
    ]
    return Discovery(
        verdict="named",
        statement="The wave model lacks viscoelastic relaxation; with it 97 % of the gap closes on a speed held out.",
        p=0.002,
        effects=(
            NamedEffect(
                "viscoelastic_relaxation",
                0.99,
                ("poroelastic_drainage",),
                (Estimate("g_1", 0.31, "", (0.29, 0.33)), Estimate("tau_1", 2.99, "s", (2.7, 3.3))),
            ),
        ),
        where=(
            Place("force_z", "hold", "slow", 1, (1.5e-3, 2e-3), -0.21, -8.1, 0.002),
            Place("force_z", "hold", "fast", 1, (1.5e-3, 2e-3), -0.31, -12.0, 0.002),
            Place("force_z", "load", "fast", 1, (0.5e-3, 1.5e-3), 0.12, 4.6, 0.01),
            Place("marker_radial", "hold", "slow", 1, (1.5e-3, 2e-3), -2.1e-5, -6.0, 0.004),
        ),
        contrasts=(
            Contrast("Does the force fall in a hold?", "force_z", -0.4, 0.001),
            Contrast("Are fast presses stiffer?", "force_z", 0.2, 0.004),
        ),
        gap=(
            ChannelGap("force_z", 0.21, 0.035, 0.03, 0.99, (0.95, 1.0), "condition"),
            ChannelGap("marker_radial", 2.1e-5, 4e-6, 3e-6, 0.98, None, "condition"),
        ),
        smallest_visible={"force_z": 0.015, "marker_radial": 2e-6},
        candidates=(
            Candidate(("viscoelastic_relaxation",), 8.2, 41.0, 5.0, -120.0, 0.97, True),
            Candidate(("poroelastic_drainage",), 7.1, 38.0, 5.4, -101.0, 0.93, True),
            Candidate(("machine_compliance",), 0.4, 2.0, 5.0, 3.0, 0.05, None),
        ),
        base=(Estimate("stiffness_factor", 1.2, "", (1.1, 1.3)), Estimate("tool_radius", 5e-3, "m", (4.9e-3, 5.1e-3))),
        remains=("Nothing significant remains in force; radial markers differ by 0.004 mm in the hold.",),
        warnings=("5 % cannot be reached with fewer than 6 trials.",),
        traces=tuple(traces),
        conditions=("slow", "fast"),
        channels=("force_z", "marker_radial"),
        trials=("trial_001", "trial_002", "trial_003", "trial_004"),
        seconds=12.5,
    )


@pytest.fixture
def record(found: Discovery) -> DiscoveryRecord:
    """The same with its origin."""
    return DiscoveryRecord(
        name="pig <1>",
        source="session",
        fingerprint="ab" * 32,
        synthetic=True,
        tissue="skin_forearm",
        model="wave",
        found=found,
        cards={card.slug: card for card in (RELAXATION, COMPLIANCE)},
        seed=0,
    )


@pytest.fixture
def empty(record: DiscoveryRecord) -> DiscoveryRecord:
    """Nothing found."""
    nothing = replace(
        record.found,
        verdict="no_discrepancy",
        statement="Model and measurement agree within chance.",
        p=0.4,
        effects=(),
        where=(),
        contrasts=(),
        candidates=(),
        remains=(),
        warnings=(),
    )
    return replace(record, found=nothing, synthetic=False)


_PATH = Path(__file__).with_name("quick_session.py")
_SPEC = importlib.util.spec_from_file_location("discovery_quick_session", _PATH)
quick = importlib.util.module_from_spec(_SPEC)
sys.modules["discovery_quick_session"] = quick
_SPEC.loader.exec_module(quick)


@pytest.fixture(scope="session")
def quick_session():
    """The maker of quick synthetic sessions."""
    return quick


@pytest.fixture
def session_of(tmp_path):
    """A loaded quick session."""
    from benchmark.files import load_session

    def make(**options):
        return load_session(quick.write_session(tmp_path / "session", **options))

    return make
