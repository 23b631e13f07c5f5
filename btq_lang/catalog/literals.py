"""The engine's reading of the text of a port: refused, read whole, or read in part with the rest dropped silently.

One invariant: a type that is not known here is never refused: its converter is in the user's C++ program.  It does not
know ports, scripts or blackboards; `{key}` is a pointer to an entry for every type.

Source: convertFromString in src/basic_types.cpp and src/xml_parsing.cpp of 4.6.2, 4.8.4 and 4.10.0.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Final, Literal

from btq_lang.catalog.kinds import RESULT
from btq_lang.catalog.versions import BOOL_LISTS, DEFAULT_VERSION, JSON_LISTS, STRICT_NUMBERS
from btq_lang.util.record import Record


class LiteralProblem(Record):
    """A problem with a literal.

    Attributes:
        kind: refused: an error of the engine, at load or at the latest when it reads the port; trailing-text: the
            engine drops the text after the number.
        expected: what the type accepts, in words that follow "expected".
        reads: what the engine reads instead; None if it refuses.
        found: the part of the literal that is wrong, in words that follow "found"; None: all of it.
    """

    kind: Literal["refused", "trailing-text"]
    expected: str
    reads: str | None = None
    found: str | None = None


@lru_cache(1_000)  # the same values occur again and again
def check_literal(port_type: str, text: str, version: str = DEFAULT_VERSION) -> LiteralProblem | None:
    """The problem with a literal for a port of that type, in that version of the engine; None if it has none.

    Args:
        port_type: as the engine prints it or as a model declares it: `unsigned int`, `std::vector<double>`, `bool` …
    """
    if is_pointer(text):
        return None
    item = _list_item(port_type)
    if item is not None:
        return _check_list(port_type, item, text, version)
    return _check_one(_plain(port_type), text, version)


# Another form of it, which version 3 of the engine has.
OLD_ENTRY: Final = re.compile(r"\$\{[^{}\n]+\}")


def is_pointer(text: str) -> bool:
    """Whether the text of a port is `{key}`, a pointer to a blackboard entry, whatever the port's type."""
    return len(text) >= 3 and text[0] == "{" and text[-1] == "}"


@lru_cache(1000)
def plain_type(port_type: str) -> str:
    """One name for a type that has several: `int32_t` is `int`, `std::vector<double, …>` is `std::vector<double>`."""
    item = _list_item(port_type)
    if item is not None and "deque" not in port_type:
        return f"std::vector<{item}>"
    plain = _plain(port_type)
    return "std::string" if plain == "string" else plain


def values_of(port_type: str) -> tuple[str, ...]:
    """All literals that a type accepts, the usual spellings first; empty if they cannot be listed."""
    return _CLOSED.get(_plain(port_type), ())


def is_own_value(word: str) -> bool:
    """Whether a word is the literal of some type, in whatever case: `true`, `NaN`, `SUCCESS`."""
    return word.casefold() in _OWN_VALUES


def is_known_type(plain: str) -> bool:
    """Whether it is a type of the engine or of C++ itself, by the name that `plain_type` gives it.  Any other is the
    user's, and may be an alias for one of these."""
    return plain in _INTEGERS or plain in _OTHER_TYPES or _list_item(plain) is not None


def _check_one(plain: str, text: str, version: str) -> LiteralProblem | None:
    if plain in _INTEGERS:
        return _check_integer(plain, text)
    if plain in ("double", "float"):
        return _check_real(plain, text, version)
    values = _CLOSED.get(plain)
    if values is not None and text not in values:
        *others, last = values if plain != "bool" else _SHOWN_OF_BOOL
        return LiteralProblem("refused", f"{', '.join(others)} or {last}")
    return None


def _check_integer(plain: str, text: str) -> LiteralProblem | None:
    """std::from_chars: digits from the first character on, perhaps a `-`; a number out of range is refused."""
    low, high = _INTEGERS[plain]
    end = start = 1 if text[:1] == "-" and plain != "unsigned long" else 0
    while end < len(text) and text[end] in "0123456789":
        end += 1
    if end == start:
        return LiteralProblem("refused", _bare("an integer" if low else "an integer of 0 or more", text))
    # More digits than any type has are not worth converting, and beyond some thousands int() raises.
    digits = text[start:end].lstrip("0") or "0"
    value = int(digits) if len(digits) <= 20 else high + 2  # out of range, with a `-` too
    if not low <= (-value if start else value) <= high:
        return LiteralProblem("refused", f"an integer from {low} to {high}")
    return _rest(text, end, "an integer")


def _check_real(plain: str, text: str, version: str) -> LiteralProblem | None:
    """std::from_chars since 4.9; before, std::stod, which takes blanks and a `+` in front, and hexadecimal digits."""
    if len(text) < 16 and text.isascii() and text.replace(".", "", 1).isdecimal():
        return None  # as nearly all are
    number = (_REAL if STRICT_NUMBERS.holds(version) else _OLD_REAL).match(text)
    if number is None:
        return LiteralProblem("refused", _bare("a number", text))
    value = _value(number[0])
    smallest, largest = _MAGNITUDES[plain]
    vanishes = abs(value) <= smallest and _mantissa(number[0]).strip("+-.0 \t\n\v\f\r") != ""
    if not _is_named(number[0]) and (abs(value) > largest or vanishes):
        return LiteralProblem("refused", f"a number in the range of {plain}")
    return _rest(text, number.end(), "a number")


def _bare(number: str, text: str) -> str:
    """The values that the type accepts; mentions a leading `+` or space if nothing else is wrong."""
    digit = text.strip().removeprefix("+")[:1]
    return f"{number} without a leading `+` or space" if "0" <= digit <= "9" else number


def _rest(text: str, end: int, expected: str) -> LiteralProblem | None:
    """Spaces after a number are dropped too, without harm."""
    if text[end:].isspace() or end == len(text):
        return None
    return LiteralProblem("trailing-text", expected, text[:end].strip())


def _check_list(port_type: str, item: str, text: str, version: str) -> LiteralProblem | None:
    """Items between semicolons, the last one perhaps followed by one; since 4.9 also `json:[1, 2]`."""
    is_queue = "deque" in port_type
    if item == "bool" and not is_queue and not BOOL_LISTS.holds(version):
        return LiteralProblem("refused", "a blackboard entry (4.6 reads no list of bool from text)")
    if text.startswith("json:") and not is_queue and JSON_LISTS.holds(version):
        return _check_json(item, text[len("json:") :])
    items = text.split(";")
    if items[-1] == "":
        items.pop()
    reads = []
    for literal in items:
        problem = _check_one(item, literal, version)
        if problem is not None and problem.kind == "refused":
            return LiteralProblem("refused", f"{problem.expected} as each item", found=_item(literal))
        reads.append(literal if problem is None else problem.reads or "")
    if reads == items:
        return None
    expected = "an integer as each item" if item == "int" else "a number as each item"
    return LiteralProblem("trailing-text", expected, ";".join(reads))


def _check_json(item: str, text: str) -> LiteralProblem | None:
    """nlohmann::json's conversions: a number becomes an int by truncation, true an int but not a double."""
    import json  # only here: it costs as much as reading a small file

    try:
        values = json.loads(text, parse_constant=_refuse_constant)
    except (ValueError, RecursionError):
        return LiteralProblem("refused", "well-formed JSON after `json:`")
    if not isinstance(values, list):
        return LiteralProblem("refused", "a JSON list after `json:`")
    types, expected = _JSON_ITEMS[item]
    for value in values:
        if type(value) not in types:
            return LiteralProblem("refused", f"{expected} as each item", found=_item(json.dumps(value)))
    return None


def _item(text: str) -> str:
    return f"the item `{text}`" if text else "an empty item"


def _refuse_constant(word: str) -> None:
    """Refuse NaN and Infinity, which Python reads and JSON does not have."""
    raise ValueError(word)


@lru_cache(500)
def _plain(port_type: str) -> str:
    """One name for a type that has several: `std::int32_t` and `int`, `unsigned` and `unsigned int`."""
    name = " ".join(port_type.split())
    name = "BT::NodeStatus" if name == "NodeStatus" else name
    short = name.removeprefix("std::")
    return _SYNONYMS.get(short, short if short in _INTEGERS else name)


@lru_cache(500)
def _list_item(port_type: str) -> str | None:
    """The type of a list's items; None if the engine cannot read it as a list."""
    match = _LIST.match(" ".join(port_type.split())) if "<" in port_type else None
    if match is None:
        return None
    if "basic_string" in match[1] or match[1] in ("string", "std::string"):
        return "std::string"
    item = _plain(match[1].strip())
    # The engine has converters for lists of these; any other is the user's own.
    return item if item in ("int", "double", "bool") else None


def _mantissa(number: str) -> str:
    return number.lower().partition("p" if "x" in number.lower() else "e")[0].replace("0x", "")


def _value(number: str) -> float:
    number = number.strip()
    if "x" in number.lower():
        try:
            return float.fromhex(number)
        except OverflowError:
            return float("inf")
    return 0.0 if _is_named(number) else float(number)


def _is_named(number: str) -> bool:
    """inf, infinity, nan, nan(…)"""
    return number.strip().lstrip("+-")[:1] in ("i", "I", "n", "N")


def _range(bits: int, signed: bool) -> tuple[int, int]:
    return (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) if signed else (0, 2**bits - 1)


_INTEGERS: Final = {
    "int": _range(32, True),
    "unsigned int": _range(32, False),
    "long": _range(64, True),
    "unsigned long": _range(64, False),
    "short": _range(16, True),
    "unsigned short": _range(16, False),
    "signed char": _range(8, True),
    "unsigned char": _range(8, False),
}
_SYNONYMS: Final = {
    **dict.fromkeys(("int32_t", "int32"), "int"),
    **dict.fromkeys(("unsigned", "uint", "uint32_t", "uint32"), "unsigned int"),
    **dict.fromkeys(("long int", "int64_t", "long long"), "long"),
    **dict.fromkeys(("unsigned long int", "uint64_t", "unsigned long long", "size_t"), "unsigned long"),
    **{"int16_t": "short", "uint16_t": "unsigned short", "int8_t": "signed char", "uint8_t": "unsigned char"},
}
_JSON_ITEMS: Final[dict[str, tuple[tuple[type, ...], str]]] = {
    "int": ((int, float, bool), "a number, true or false"),
    "double": ((int, float), "a number"),
    "bool": ((bool,), "true or false"),
    "std::string": ((str,), "a string"),
}
_SHOWN_OF_BOOL: Final = ("true", "false", "1", "0")
_RESULTS: Final = ("SUCCESS", "FAILURE", "RUNNING", "SKIPPED")
_CLOSED: Final = {
    "bool": (*_SHOWN_OF_BOOL, "True", "TRUE", "False", "FALSE"),
    RESULT: _RESULTS,
    "BT::NodeStatus": (*_RESULTS, "IDLE"),
}
_OWN_VALUES: Final = frozenset(
    (*(value.casefold() for values in _CLOSED.values() for value in values), "nan", "inf", "infinity")
)
_OTHER_TYPES: Final = frozenset(("double", "float", "bool", "std::string", "BT::NodeStatus"))
# Numbers other than 0 become 0 below the first limit and infinite above the second: the engine refuses both.
_MAGNITUDES: Final = {"double": (0.0, 1.7976931348623157e308), "float": (7.006492321624085e-46, 3.4028235677973366e38)}

# Compiled when first used: that costs more than all the rest of this module, and few files have a real or a list.
_NAMED: Final = r"(?i:inf(?:inity)?|nan(?:\([0-9A-Za-z_]*\))?)"
_DECIMAL: Final = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_HEXADECIMAL: Final = r"0[xX](?:[0-9a-fA-F]+\.?[0-9a-fA-F]*|\.[0-9a-fA-F]+)(?:[pP][+-]?[0-9]+)?"
_REAL: Final = re.compile(rf"-?(?:{_NAMED}|{_DECIMAL})")
_OLD_REAL: Final = re.compile(rf"[ \t\n\v\f\r]*[+-]?(?:{_NAMED}|{_HEXADECIMAL}|{_DECIMAL})")
_LIST: Final = re.compile(r"(?:std::shared_ptr<\s*)?(?:std::)?(?:vector|deque)<\s*([^,>]+?(?:<.*?>)?)\s*[,>]")
