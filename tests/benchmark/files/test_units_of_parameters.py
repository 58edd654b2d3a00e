import pytest

from benchmark.files.units import dimension_of, format_quantity, parse_quantity, shown
from benchmark.physics import catalogue

UNITS = sorted({p.unit for effect in catalogue() for p in effect.forms[-1].description.parameters})


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("value", [0.0, 1.2345e-5, 0.31, 250.0])
def test_every_unit_of_the_catalogue_is_written_and_read(unit: str, value: float) -> None:
    dimension = dimension_of(unit)
    assert parse_quantity(format_quantity(value, dimension), dimension) == value


@pytest.mark.parametrize(
    ("value", "unit", "number", "name"),
    [(2e-3, "m", 2.0, "mm"), (0.3, "", 0.3, ""), (1e-4, "m/N", 0.1, "mm/N"), (1.5, "s", 1.5, "s")],
)
def test_readers_get_units_they_know(value: float, unit: str, number: float, name: str) -> None:
    assert shown(value, unit) == (pytest.approx(number), name)
