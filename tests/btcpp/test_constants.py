"""Constants for the ports of subtrees, spelt so that every version of the engine accepts them."""

from __future__ import annotations

import pytest

from btq_lang.btcpp.constants import fitting

OTHER_NUMBERS = (
    *("float", "unsigned int", "unsigned", "long", "unsigned long", "short", "unsigned short", "size_t"),
    *("int8_t", "int16_t", "int32_t", "int64_t", "uint8_t", "uint16_t", "uint32_t", "uint64_t"),
    *("std::int8_t", "std::int16_t", "std::int32_t", "std::int64_t"),
    *("std::uint8_t", "std::uint16_t", "std::uint32_t", "std::uint64_t"),
)


@pytest.mark.parametrize(
    ("types", "raw", "spelt"),
    [
        (("double",), "3", "3.0"),
        (("double",), "-3", "-3.0"),
        (("double",), "3.5", "3.5"),
        (("int",), "3", "3"),
        (("int",), "2147483647", "2147483647"),
        (("int",), "2147483648", "2147483648 "),
        (("int",), "-2147483648", "-2147483648"),
        (("int",), "-2147483649", "-2147483649 "),
        (("int",), "2.5", "2.5 "),
        (("bool",), "0", "false"),
        (("bool",), "1", "true"),
        (("bool",), "2", "2"),
        (("int", "double"), "3", "3 "),
        (("double", "std::string"), "3", "3"),
        (("double", "Pose"), "3", "3"),
        (("double",), "fast", "fast"),
        ((), "3", "3"),
        *(((type_,), "3", "3 ") for type_ in OTHER_NUMBERS),
    ],
)
def test_a_constant_as_the_nodes_below_take_it(types: tuple[str, ...], raw: str, spelt: str) -> None:
    assert fitting(types, raw) == spelt
