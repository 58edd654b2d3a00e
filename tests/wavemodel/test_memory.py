import pytest

from wavemodel import NotCoveredError, Prony, WaveError
from wavemodel.memory import one_series, series_of, shared

SERIES = Prony((0.3,), (1.0,))


def test_one_series_is_for_all_layers():
    assert series_of(SERIES, 3) == (SERIES,) * 3
    assert shared(series_of(SERIES, 3)) == SERIES
    assert series_of(None, 2) == (Prony(),) * 2


def test_layers_may_differ_and_some_be_elastic():
    series = series_of([None, SERIES], 2)
    assert series == (Prony(), SERIES)
    assert shared(series) is None
    with pytest.raises(NotCoveredError, match="inertia"):
        one_series(series)


def test_as_many_series_as_layers():
    with pytest.raises(WaveError, match="1 series for 2 layers"):
        series_of([SERIES], 2)
