import pytest

from wavemodel.published import table_one


def test_what_agrees_and_what_does_not():
    rows = table_one()
    assert [row.agrees for row in rows] == [False, True, False, True]
    assert [row.value for row in rows] == pytest.approx([9.24986, 1.74092, 31.7788, 39.20117], rel=1e-5)
    assert all(row.reason for row in rows)
