"""Numbers in other notations than the plain one: read where there is one way to, refused where there are two."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pinik.description.numbers import NumberError, read_numbers

# The text, the quantity, the numbers that it means, and what is unusual about it.
LOOSE = [
    ("0.1, 0, 0.3", "length", (0.1, 0.0, 0.3), "commas between the numbers"),
    ("1,2,3", "length", (1.0, 2.0, 3.0), "commas between the numbers"),
    ("1, 2,3,", "length", (1.0, 2.0, 3.0), "commas between the numbers"),
    ("0.1; 0; 0.3", "length", (0.1, 0.0, 0.3), "semicolons between the numbers"),
    ("0,5 0 0", "length", (0.5, 0.0, 0.0), "a decimal comma"),
    ("-0,5; 1,25; 0", "length", (-0.5, 1.25, 0.0), "a decimal comma"),
    ("[0.1 0 0.3]", "length", (0.1, 0.0, 0.3), "brackets or quotes"),
    ("[[0.1\n  0\t 0.3]]", "length", (0.1, 0.0, 0.3), "brackets or quotes"),
    ("(0.1, 0, 0.3)", "length", (0.1, 0.0, 0.3), "brackets or quotes, commas between the numbers"),
    ("'0.1 0 0.3'", "length", (0.1, 0.0, 0.3), "brackets or quotes"),
    ("0.1\u00a00\u00a00.3", "length", (0.1, 0.0, 0.3), "unusual white space"),
    ("\ufeff0.1 0 0.3\u200b", "length", (0.1, 0.0, 0.3), "unusual white space"),
    ("\u22120.1 0 \u20131e\u22123", "length", (-0.1, 0.0, -0.001), "another character than '-' as a minus sign"),
    ("1.0f 2F 3.f", "length", (1.0, 2.0, 3.0), "the suffix 'f'"),
    ("1.0d0 2.5D-1 3", "length", (1.0, 0.25, 3.0), "the exponent of Fortran"),
    ("0.1m 0m 0.3m", "length", (0.1, 0.0, 0.3), "units"),
    ("0.1 m 0 m 0.3 m", "length", (0.1, 0.0, 0.3), "units"),
    ("100 0 300 mm", "length", (0.1, 0.0, 0.3), "a unit"),
    ("0 0 300mm", "length", (0.0, 0.0, 0.3), "a unit"),
    ("0 0 90deg", "angle", (0.0, 0.0, math.pi / 2), "a unit"),
    ("90° 0° -90°", "angle", (math.pi / 2, 0.0, -math.pi / 2), "units"),
    ("200mm 0 100mm", "length", (0.2, 0.0, 0.1), "units"),
    ("0 20 cm 0.0", "length", (0.0, 0.2, 0.0), "units"),
    ("0, 0, 90 deg", "angle", (0.0, 0.0, math.pi / 2), "commas between the numbers, a unit"),
    ("90deg, 0, 0", "angle", (math.pi / 2, 0.0, 0.0), "commas between the numbers, units"),
    ("1.57rad", "angle", (1.57,), "units"),
    ("1rad 2 3rad", "angle", (1.0, 2.0, 3.0), "units"),
    ("2.5 kg", "mass", (2.5,), "units"),
    ("250g", "mass", (0.25,), "units"),
    ("3 m/s", "speed", (3.0,), "units"),
    ("12Nm", "effort", (12.0,), "units"),
]


@pytest.mark.parametrize(("text", "quantity", "values", "oddity"), LOOSE)
def test_what_can_be_read_in_one_way_is_read_so_and_named(text, quantity, values, oddity):
    reading = read_numbers(text, (len(values),), quantity)
    assert reading.values == pytest.approx(values, abs=1e-15)
    assert reading.oddity == oddity


# The text, how many numbers are needed, and words of the error.
REFUSED = [
    ("0,5, 0, 0", 3, 'can be read in two ways: as "0.5 0 0" or as one number more'),
    ("1,000 0 0", 3, 'can be read in two ways: as "1 0 0" or as "1000 0 0"'),
    ("-12,345", 1, 'can be read in two ways: as "-12.345" or as "-12345"'),
    ("100 200 300mm", 3, 'can be read in two ways: as "100 200 0.3" or as "0.1 0.2 0.3"'),
    ("200mm 0 100", 3, "must have one unit for all of its numbers, or a unit behind each"),
    ("0mm 1 2", 3, "must have one unit for all of its numbers, or a unit behind each"),
    ("1mm 2 3mm", 3, "must have one unit for all of its numbers, or a unit behind each"),
    ("1,234.5", 1, "must be one number; 2 given"),
    ("0,,1", 3, "a number is missing between two commas"),
    ("1 2", 3, "must be 3 numbers; 2 given"),
    ("", 1, "must be one number; 0 given"),
    ("[]", 1, "must be one number; 0 given"),
    ("[1 2 3)", 3, "'[1' is not a number"),
    ("1_0", 1, "'1_0' is not a number"),
    ("0x10", 1, "'0x10' is not a number"),
    ("--1", 1, "'--1' is not a number"),
    ("1.2.3", 1, "'1.2.3' is not a number"),
    ("half", 1, "'half' is not a number"),
    ("1rad", 1, "the unit of '1rad' does not fit here"),
    ("m 1", 1, "'m' is not a number"),
    ("\u0663", 1, "is not a number"),
    ("nan", 1, "'nan' is not finite"),
    ("1e999", 1, "'1e999' is not finite"),
    ("-inf", 1, "'-inf' is not finite"),
    ("1" * 1000, 1, "is not a number"),
    ("[[[[1]]]]", 1, "'[1]' is not a number"),
    ("1 " * 10_000, 3, "must be 3 numbers; 20,000 characters given"),
]


@pytest.mark.parametrize(("text", "count", "words"), REFUSED)
def test_what_can_be_read_in_two_ways_or_in_none_is_refused_with_them(text, count, words):
    with pytest.raises(NumberError) as caught:
        read_numbers(text, (count,), "length")
    assert words in str(caught.value)
    assert len(str(caught.value)) < 200


def test_of_two_ways_to_read_a_text_no_third_is_named():
    with pytest.raises(NumberError) as caught:
        read_numbers("1,000 0 0", (3,), "length")
    assert str(caught.value) == 'can be read in two ways: as "1 0 0" or as "1000 0 0"'


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=4))
def test_plain_numbers_are_read_exactly_and_without_a_word(values):
    reading = read_numbers(" ".join(map(repr, values)), (len(values),), "length")
    assert (reading.values, reading.oddity) == (tuple(values), "")


@given(st.text(max_size=30), st.sampled_from(["length", "angle", "number"]), st.integers(1, 4))
def test_any_text_is_read_as_finite_numbers_or_refused_in_words(text, quantity, count):
    try:
        values = read_numbers(text, (count,), quantity).values
    except NumberError:
        return
    assert len(values) == count
    assert all(map(math.isfinite, values))


@given(
    st.lists(st.integers(-999, 999).map(lambda n: n / 8), min_size=3, max_size=3), st.sampled_from([", ", "; ", " ,"])
)
def test_separators_change_no_number(values, separator):
    assert read_numbers(separator.join(map(repr, values)), (3,), "length").values == tuple(values)


def test_a_long_number_is_quoted_by_its_beginning_and_its_end():
    with pytest.raises(NumberError, match=r"'9{40,}…9+' is not finite") as caught:
        read_numbers("9" * 310, (1,), "angle")
    assert len(str(caught.value)) < 100


def test_only_limits_may_be_infinite():
    assert read_numbers("-inf", (1,), "angle", infinite=True).values == (-math.inf,)
    assert read_numbers("1e400", (1,), "angle", infinite=True).values == (math.inf,)
    with pytest.raises(NumberError):
        read_numbers("nan", (1,), "angle", infinite=True)
