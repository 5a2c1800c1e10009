"""Speeds of the command line, in their units."""

import pytest

from ident.speeds import parse_speed, parse_speeds
from models.quantity import InvalidInput


@pytest.mark.parametrize(
    ("text", "speed"),
    [
        ("6 kn", 3.0866667),
        ("6kn", 3.0866667),
        (" 1.5 KNOTS ", 0.7716667),
        ("1 knot", 0.5144444),
        ("3 m/s", 3.0),
        ("3m/s", 3.0),
        ("3", 3.0),
        (".5", 0.5),
        ("2e-1 m/s", 0.2),
    ],
)
def test_speeds_in_every_unit(text: str, speed: float) -> None:
    assert parse_speed(text) == pytest.approx(speed, rel=1e-7)


def test_a_list_mixes_units() -> None:
    assert parse_speeds("2 kn, 4 kn,3") == pytest.approx((1.0288889, 2.0577778, 3.0))


@pytest.mark.parametrize("text", ["", "kn", "6 km/h", "-1", "0", "nan", "inf", "1.2.3", "6 kn 4", "1e999", "6 k n"])
def test_what_is_no_speed_is_refused(text: str) -> None:
    with pytest.raises(InvalidInput, match=r"such as '6 kn'"):
        parse_speed(text)


def test_an_empty_place_in_a_list_is_refused() -> None:
    with pytest.raises(InvalidInput, match="but it is ''"):
        parse_speeds("2 kn,,4 kn")
