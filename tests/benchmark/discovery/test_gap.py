import pytest

from benchmark.discovery.gap import share_closed


@pytest.mark.parametrize(
    ("before", "after", "floor", "expected"),
    [
        (4.0, 2.0, 1.0, 2.0 / 3.0),
        (4.0, 0.5, 1.0, 1.0),  # below the floor: all that can be closed
        (4.0, 5.0, 1.0, -1.0 / 3.0),
        (1.0, 0.25, 0.0, 0.75),
    ],
)
def test_share_of_what_lies_above_the_floor(before, after, floor, expected) -> None:
    assert share_closed(before, after, floor) == pytest.approx(expected, abs=1e-6)


def test_nothing_to_close_where_the_base_reaches_the_floor() -> None:
    assert share_closed(1.04, 1.0, 1.0) is None
    assert share_closed(0.9, 0.8, 1.0) is None


def test_round_off_is_not_a_share() -> None:
    assert str(share_closed(2.0, 2.0 * (1.0 + 1e-13), 1.0)) == "0.0"
