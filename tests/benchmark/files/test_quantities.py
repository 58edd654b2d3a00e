import math
from typing import Annotated

import pytest
from pydantic import BaseModel, ValidationError

from benchmark.files import units
from benchmark.files.quantities import FROM_FILE, AutoLength, Bounds, Length, Margin, Number, quantity

Endless = Annotated[float, quantity(units.LENGTH, 1e-6, 1.0, endless=True)]
Count = Annotated[int | None, Number("1 to 9", Bounds(1, 9), whole=True, automatic=True)]


class Box(BaseModel):
    side: Length = 1.0
    reach: AutoLength = None
    depth: Endless = math.inf
    margin: Margin = 0.02
    count: Count = None


def refusal(**values):
    with pytest.raises(ValidationError) as error:
        Box.model_validate(values, context=FROM_FILE)
    return error.value.errors()[0]["msg"]


def test_a_file_gives_text_with_units_and_gets_si_floats():
    box = Box.model_validate({"side": "5 mm", "reach": "0.1 m", "margin": "5 %", "count": 4}, context=FROM_FILE)
    assert (box.side, box.reach, box.margin, box.count) == (5e-3, 0.1, 0.05, 4)


def test_code_gives_si_floats():
    assert Box(side=5e-3).side == 5e-3
    assert Box(side=2).side == 2.0


def test_a_bare_number_in_a_file_is_refused_with_a_hint():
    assert refusal(side=5) == (
        'the bare number 5 has no unit; write a length as text with its unit, such as "5 mm" '
        "(allowed: 0.001 um to 100000 m)"
    )


def test_a_fraction_needs_no_unit():
    assert Box.model_validate({"margin": 0.05}, context=FROM_FILE).margin == 0.05
    assert Box.model_validate({"margin": "0.05"}, context=FROM_FILE).margin == 0.05


def test_bounds_are_said_with_units():
    assert refusal(side="-5 mm") == "'-5 mm' is outside what is allowed, 0.001 um to 100000 m"
    assert refusal(margin="0 %") == "'0 %' is outside what is allowed, above 0 % and at most 100 %"
    assert refusal(count=10) == "10 is outside what is allowed, 1 to 9"


@pytest.mark.parametrize("value", [True, None, [], {}, ["5 mm"], math.nan, math.inf])
def test_what_is_no_quantity_is_refused(value):
    assert "allowed: 0.001 um to 100000 m" in refusal(side=value)


@pytest.mark.parametrize("value", [math.nan, math.inf, -1.0, 0.0])
def test_code_is_held_to_the_bounds_too(value):
    with pytest.raises(ValidationError, match="outside what is allowed"):
        Box(side=value)


@pytest.mark.parametrize("value", [True, "many", 1.5, "nan", math.nan, math.inf, [], 10**400])
def test_what_is_no_whole_number_is_refused(value):
    assert "is not a whole number; allowed: 1 to 9" in refusal(count=value)


def test_text_from_the_command_line_is_a_number_too():
    assert Box.model_validate({"count": "4"}, context=FROM_FILE).count == 4


def test_auto_is_none_and_none_is_auto():
    box = Box.model_validate({"reach": "auto", "count": "auto"}, context=FROM_FILE)
    assert (box.reach, box.count) == (None, None)
    written = box.model_dump(mode="json")
    assert (written["reach"], written["count"]) == ("auto", "auto")
    assert box.model_dump()["reach"] is None
    assert '"auto"' in refusal(reach="0 mm")


def test_only_an_endless_length_may_be_infinite_and_it_is_left_out_of_files():
    assert Box().model_dump(mode="json")["depth"] is None
    assert Box(depth=math.inf).depth == math.inf
    assert "inf" in refusal(depth="inf m")


def test_files_are_written_with_units():
    written = Box(side=5e-3, margin=0.05, depth=0.5).model_dump(mode="json")
    assert (written["side"], written["margin"], written["depth"]) == ("5 mm", "5 %", "500 mm")
