"""Read numbers as people write them: plain ones, and others that can be read in one way only."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from ..echoes import QUOTED, shortened

__all__ = ["FARTHEST", "NumberError", "Reading", "plain_number", "read_numbers"]

# [m or rad]: beyond this, sums and squares of distances could overflow, and placements would not be finite.
FARTHEST = 1e12
LONGEST_NUMBER = 400
_LONGEST_TEXT = 10_000  # characters of an attribute: a few numbers, and the white space between them
_MOST_BRACKETS = 3
_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?"
_PLAIN = re.compile(_NUMBER, re.ASCII)
_WITH_SUFFIX = re.compile(rf"({_NUMBER})(\D.*)", re.ASCII)
_NON_FINITE = re.compile(r"[+-]?(nan|inf|infinity)", re.IGNORECASE)
_FORTRAN_EXPONENT = re.compile(r"(?<=[\d.])[dD](?=[+-]?\d)", re.ASCII)
_TIGHT_COMMA = re.compile(r"(?<=\d),(?=\d)", re.ASCII)
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+", re.ASCII)
# Numbers with both a decimal sign and another one between thousands → the latter.
_GROUPED = {
    re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+\.\d*", re.ASCII): ",",
    re.compile(r"[+-]?[1-9]\d{0,2}(?:\.\d{3})+,\d*", re.ASCII): ".",
}
_MINUS = str.maketrans(dict.fromkeys("\u2010\u2011\u2012\u2013\u2212\ufe63\uff0d", "-"))  # hyphens, dashes, minus signs
_INVISIBLE = str.maketrans(dict.fromkeys("\u200b\u200c\u200d\u200e\u200f\u2060\ufeff", ""))
_PAIRS = ("()", "[]", "{}", '""', "''")

_ONE_UNIT, _UNITS_EACH, _BRACKETS = "a unit", "units", "brackets or quotes"
_DEGREE = math.pi / 180.0
# Quantity → unit → how many of the SI unit it is.
_UNITS = {
    "length": {"m": 1.0, "cm": 0.01, "mm": 0.001},
    "angle": {"rad": 1.0, "deg": _DEGREE, "degrees": _DEGREE, "°": _DEGREE},
    "mass": {"kg": 1.0, "g": 0.001},
    "speed": {"m/s": 1.0, "rad/s": 1.0, "deg/s": _DEGREE},
    "effort": {"N": 1.0, "Nm": 1.0, "N*m": 1.0, "N·m": 1.0},
}
# Units that are recognised, so that messages call them so, but are not read.
_OTHER_UNITS = frozenset(
    {"in", "inch", "inches", "ft", "feet", "km", "dm", "um", "µm", "degree", "lb", "lbs", "oz", "kgm"}
)
_ALL_UNITS = _OTHER_UNITS.union(*_UNITS.values())


class NumberError(ValueError):
    """A text is not the numbers that are needed; the message says why."""


@dataclass(frozen=True)
class Reading:
    """Numbers that were read.

    Attributes:
        values: The numbers, in SI units.
        oddity: What is unusual about their notation, such as "commas between the numbers"; empty if it is plain.
        has_units: Whether units stand behind them.
    """

    values: tuple[float, ...]
    oddity: str = ""
    has_units: bool = False

    def __str__(self) -> str:
        return " ".join(f"{value:.12g}" for value in self.values)

    @property
    def manner(self) -> str:
        """How they are read: "as plain numbers", or "in SI units" where others stand behind them."""
        return "in SI units" if self.has_units else "as plain numbers"

    @property
    def exact(self) -> str:
        """The numbers in plain notation, with all of their digits."""
        return " ".join(_shortest(value) for value in self.values)


def _shortest(value: float) -> str:
    short = f"{value:.12g}"
    return short if float(short) == value else repr(value)


def plain_number(text: str) -> float | None:
    """The number, if the text is nothing but a finite one in the notation that all URDF readers accept; else None."""
    value = float(text) if len(text) <= LONGEST_NUMBER and _PLAIN.fullmatch(text) else math.nan
    return value if math.isfinite(value) else None


def read_numbers(text: str, counts: Collection[int], quantity: str = "number", *, infinite: bool = False) -> Reading:
    """Read one or several numbers.

    Args:
        text: The text.
        counts: How many numbers there may be.
        quantity: "length", "angle", "mass", "speed", "effort", or "number" for numbers without a unit.
        infinite: Whether "inf" is a number too.

    Raises:
        NumberError: There are other numbers, more or fewer of them, or two ways to read them.
    """
    if len(text) > _LONGEST_TEXT:
        raise NumberError(f"must be {_numbers(counts)}; {len(text):,} characters given")
    plain = [plain_number(word) for word in text.split()] if text.isascii() else [None]
    if None not in plain and len(plain) in counts:
        return Reading(tuple(value for value in plain if value is not None))
    bare, oddities = _bare(text)
    readings: dict[tuple[float, ...], str] = {}
    faults = []
    for words, separated in _splits(bare):
        try:
            values, notation = _values(words, quantity, infinite=infinite)
            if len(values) not in counts:
                raise NumberError(f"must be {_numbers(counts)}; {len(values)} given{_hint(values, counts, quantity)}")
        except NumberError as fault:
            faults.append(fault)
        else:
            readings.setdefault(values, ", ".join(dict.fromkeys([*oddities, *separated, *notation])))
    if not readings:
        raise NumberError(f"{faults[0]}{_grouped_hint(bare, counts)}")
    if len(readings) > 1 or _mixes_commas(bare, readings):
        shown = [f'"{Reading(values)}"' for values in readings]
        more = [] if len(shown) > 1 else ["one number more, if every comma separates two numbers"]
        raise NumberError(f"can be read in two ways: as {' or as '.join([*shown, *more])}")
    values, oddity = next(iter(readings.items()))
    return Reading(values, oddity, has_units=not {_ONE_UNIT, _UNITS_EACH}.isdisjoint(oddity.split(", ")))


def _bare(text: str) -> tuple[str, list[str]]:
    """The text without brackets, quotes and invisible characters, with plain minus signs; and what it had of them.

    White space is a single space wherever it was, so that no expression searches it again and again.
    """
    oddities = []
    if not text.isascii():
        visible = text.translate(_INVISIBLE)
        dashed = visible.translate(_MINUS)
        if dashed != visible:
            oddities.append("another character than '-' as a minus sign")
        if visible != text or any(character.isspace() and not character.isascii() for character in text):
            oddities.append("unusual white space")
        text = dashed
    text = " ".join(text.split())
    while len(text) >= 2 and text[0] + text[-1] in _PAIRS and oddities.count(_BRACKETS) < _MOST_BRACKETS:
        text = text[1:-1].strip()
        oddities.append(_BRACKETS)
    return text, oddities


def _grouped_hint(text: str, counts: Collection[int]) -> str:
    """What a text may mean whose numbers have commas and points between thousands, as the rest of a sentence.

    Such a text is not read: a comma may as well separate two numbers of which one was forgotten, or is too many.
    """
    likely = []
    for form, thousands in _GROUPED.items():
        words = text.split()
        plain = [word.replace(thousands, "").replace(",", ".") if form.fullmatch(word) else word for word in words]
        if plain != words and len(plain) in counts and all(map(_PLAIN.fullmatch, plain)):
            likely.append(f'"{" ".join(plain)}"')
    return f"; if {' or '.join(likely)} is meant, write it so" if likely else ""


def _splits(text: str) -> Iterator[tuple[list[str], tuple[str, ...]]]:
    """The ways to split a text into words, with a name for each."""
    if "," not in text and ";" not in text:
        yield text.split(), ()
        return
    comma = "semicolons" if "," not in text else "commas"
    yield _separated(text), (f"{comma} between the numbers",)
    if _TIGHT_COMMA.search(text) and "." not in text:
        words = [word for word in re.split(r"\s*;\s*|,\s+|,$|\s+", text) if word]
        yield [word.replace(",", ".", 1) for word in words], ("a decimal comma",)
        if any("," in word for word in words) and all(_THOUSANDS.fullmatch(word) for word in words if "," in word):
            yield [word.replace(",", "") for word in words], ("commas between thousands",)


def _separated(text: str) -> list[str]:
    """The words between commas, semicolons and white space; a comma at the end separates nothing."""
    return re.split(r"\s*[,;]\s*|\s+", re.sub(r"\s*[,;]\s*$", "", text))


def _mixes_commas(text: str, readings: Collection[tuple[float, ...]]) -> bool:
    """Whether commas separate numbers, and other commas were taken as decimal ones."""
    tight = len(_TIGHT_COMMA.findall(text))
    if not tight or not re.search(r",\s", text):
        return False
    return any(len(values) < len(_separated(text)) for values in readings)


def _values(words: Sequence[str], quantity: str, *, infinite: bool) -> tuple[tuple[float, ...], list[str]]:
    """The numbers, and what is unusual about them. A unit stands behind its number, or behind all of them."""
    units = _UNITS.get(quantity, {})
    values: list[float] = []
    given: list[str] = []
    oddities = []
    for word in words:
        if word in units and values and not given[-1]:
            given[-1] = f" {word}"
            continue
        value, unit, oddity = _value(word, units, infinite=infinite)
        values.append(value)
        given.append(unit)
        oddities.extend(oddity)
    if not any(given):
        return tuple(values), oddities
    last = given[-1]
    factors = [units[unit.strip()] if unit else 1.0 for unit in given]
    if len(given) > 1 and last and not any(given[:-1]):
        alone = tuple(value * factor for value, factor in zip(values, factors, strict=True))
        together = tuple(value * factors[-1] for value in values)
        if not last.startswith(" ") and alone != together:
            raise NumberError(f'can be read in two ways: as "{Reading(alone)}" or as "{Reading(together)}"')
        return together, [*oddities, _ONE_UNIT]
    # Zero is the same in all units, and needs none.
    if not all(unit or not value for value, unit in zip(values, given, strict=True)) and len(set(factors)) > 1:
        raise NumberError("must have one unit for all of its numbers, or a unit behind each")
    return tuple(value * factor for value, factor in zip(values, factors, strict=True)), [*oddities, _UNITS_EACH]


def _value(word: str, units: Collection[str], *, infinite: bool) -> tuple[float, str, list[str]]:
    """A number, its unit (empty if it has none), and what is unusual about its notation."""
    if len(word) <= LONGEST_NUMBER:
        fortran = _FORTRAN_EXPONENT.sub("e", word)
        if _PLAIN.fullmatch(fortran):
            value = float(fortran)
            if not math.isfinite(value) and not infinite:
                raise NumberError(f"{shortened(word, QUOTED)!r} is not finite")
            return value, "", ["the exponent of Fortran"] if fortran != word else []
        if _NON_FINITE.fullmatch(word):
            if not infinite or math.isnan(float(word)):
                raise NumberError(f"{word!r} is not finite")
            return float(word), "", []
        split = _WITH_SUFFIX.fullmatch(word)
        if split and (split[2] in units or split[2] in ("f", "F")):
            value, _, _ = _value(split[1], (), infinite=infinite)
            return (value, "", ["the suffix 'f'"]) if split[2] in ("f", "F") else (value, split[2], [])
    if not word:
        raise NumberError("a number is missing between two commas")
    raise NumberError(_misfit(word, units) or f"{shortened(word, QUOTED)!r} is not a number")


def _misfit(word: str, units: Collection[str]) -> str:
    """That the unit of a number, or a unit alone, does not fit; empty if the word has none."""
    split = _WITH_SUFFIX.fullmatch(word) if len(word) <= LONGEST_NUMBER else None
    unit = split[2] if split else word
    if unit not in _ALL_UNITS or unit in units:
        return ""
    fitting = f"write the number in {next(iter(units))}" if units else "write the number alone"
    return f"the unit of {word!r} does not fit here; {fitting}"


def _numbers(counts: Collection[int]) -> str:
    few = ["one number" if count == 1 else f"{count} numbers" for count in sorted(counts)]
    return " or ".join(few)


def _hint(values: Sequence[float], counts: Collection[int], quantity: str) -> str:
    if quantity == "angle" and set(counts) == {3} and len(values) == 4:
        return ", which may be a quaternion, or roll, pitch and yaw with one number too many"
    return ""
