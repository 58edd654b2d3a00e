"""Answers and cases for the blind trials' tests."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from benchmark.blind.body import presses
from benchmark.blind.cases import BlindCase, CaseName, make_case
from benchmark.discovery.discovery_result import ChannelGap, Discovery, NamedEffect, Place


def an_answer(
    verdict: str,
    effects: dict[str, tuple[str, ...]],
    where: tuple[tuple[str, str], ...] = (),
    gap: tuple[tuple[str, str, float | None], ...] = (),
) -> Discovery:
    return Discovery(
        verdict=verdict,
        statement="",
        p=0.01,
        effects=tuple(NamedEffect(slug, 0.9, alike, ()) for slug, alike in effects.items()),
        where=tuple(Place(channel, phase, "slow", 1, (0.0, 1e-3), 0.1, 1.0, 0.01) for channel, phase in where),
        contrasts=(),
        gap=tuple(ChannelGap(channel, 2.0, 1.0, 0.5, closed, None, held) for channel, held, closed in gap),
        smallest_visible={},
        candidates=(),
        base=(),
        remains=(),
        warnings=(),
        traces=(),
        conditions=("slow", "fast"),
        channels=("force_z",),
        trials=(),
        seconds=1.0,
    )


@pytest.fixture(scope="module", autouse=True)
def quick_presses() -> Iterator[None]:
    """Presses on coarse meshes in few steps: the blind trials' logic needs no converged bodies.

    For a module's time, so that tests of other folders do not find them.
    """
    with pytest.MonkeyPatch.context() as patch:
        for name, value in (("SHEET_MESH", "coarse"), ("SKIN_MESH", "coarse"), ("COARSE_STEPS", 5)):
            patch.setattr(presses, name, value)
        presses.press_table.cache_clear()
        presses.changed_press.cache_clear()
        yield
    presses.press_table.cache_clear()
    presses.changed_press.cache_clear()


@pytest.fixture
def answer() -> Callable[..., Discovery]:
    return an_answer


@pytest.fixture(scope="module")
def saturation() -> BlindCase:
    return make_case(CaseName("effect", "force_saturation", 0))
