"""What the engine reads from a literal, by type and version."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.catalog.literals import check_literal, is_pointer
from btq_lang.catalog.nodes import BUILTINS, of_version
from btq_lang.catalog.versions import VERSIONS

INT_RANGE = "expected an integer from -2147483648 to 2147483647"
VECTOR = "std::vector<int, std::allocator<int> >"
STRINGS = (
    "std::vector<std::__cxx11::basic_string<char, std::char_traits<char>, std::allocator<char> >, "
    "std::allocator<std::__cxx11::basic_string<char, std::char_traits<char>, std::allocator<char> > > >"
)


@pytest.mark.parametrize(
    ("port_type", "text"),
    [
        *(("int", text) for text in ("0", "-5", "007", "2147483647", "-2147483648", "5 ", "0" * 6000 + "1")),
        ("unsigned int", "4294967295"),
        ("unsigned", "0"),
        ("std::int64_t", "-9223372036854775808"),
        ("uint8_t", "255"),
        *(("double", text) for text in ("1", "-1.5", ".5", "1.", "1e3", "1E-3", "inf", "-Infinity", "nan", "0e-999")),
        ("float", "3.4e38"),
        *(("bool", text) for text in ("0", "1", "true", "True", "TRUE", "false", "False", "FALSE")),
        *(("BT::NodeStatus", text) for text in ("SUCCESS", "FAILURE", "RUNNING", "SKIPPED", "IDLE")),
        *(("std::string", text) for text in ("", "abc", "5", "json:5")),
        ("BT::Any", "anything"),
        ("BT::AnyTypeAllowed", "anything"),
        ("geometry_msgs::msg::PoseStamped", "anything"),
        ("std::vector<geometry_msgs::msg::Pose>", "anything"),
        ("", "anything"),
        *((VECTOR, text) for text in ("", "1", "1;2;3", "1;2;", "json:[1, 2]", "json:[]", "json:[1.5, true]")),
        ("std::vector<double>", "1.5;2"),
        ("std::vector<bool>", "true;0"),
        ("std::vector<bool>", "json:[true]"),
        *((STRINGS, text) for text in ("a;b;;c", ";", 'json:["a"]')),
        ("std::deque<int>", "1;2;3"),
        ("int", "{cycles}"),
        ("bool", "{@flag}"),
        ("std::vector<int>", "{=}"),
    ],
)
def test_good_literals(port_type: str, text: str) -> None:
    assert check_literal(port_type, text) is None


@pytest.mark.parametrize(
    ("port_type", "text", "message"),
    [
        *(("int", text, "expected an integer") for text in ("", "abc", "-", "{}", " {k} ", "json:5", "٣")),
        *(("int", text, "expected an integer without a leading `+` or space") for text in ("+5", " 5")),
        ("int", "2147483648", INT_RANGE),
        ("int", "9" * 6000, INT_RANGE),
        ("int", "-" + "9" * 6000, INT_RANGE),
        ("int32_t", "-99999999999", INT_RANGE),
        ("unsigned int", "-1", "expected an integer from 0 to 4294967295"),
        ("unsigned long", "-1", "expected an integer of 0 or more"),
        ("long", "9223372036854775808", "expected an integer from -9223372036854775808 to 9223372036854775807"),
        ("uint8_t", "256", "expected an integer from 0 to 255"),
        *(("double", text, "expected a number") for text in ("", "abc", "-.", "e3", ",5")),
        *(("double", text, "expected a number without a leading `+` or space") for text in ("+1.5", " 1.5")),
        *(("double", text, "expected a number in the range of double") for text in ("1e999", "-1e999", "1e-999")),
        *(("float", text, "expected a number in the range of float") for text in ("1e39", "1e-50")),
        *(("bool", text, "expected true, false, 1 or 0") for text in ("", "yes", "tRUE", "2", "true ", "01")),
        ("BT::NodeStatus", "success", "expected SUCCESS, FAILURE, RUNNING, SKIPPED or IDLE"),
        ("std::vector<int>", "1;;3", "expected an integer as each item, found an empty item"),
        (
            "std::vector<int>",
            "1; 2",
            "expected an integer without a leading `+` or space as each item, found the item ` 2`",
        ),
        ("std::vector<double>", "1;x", "expected a number as each item, found the item `x`"),
        ("std::vector<int>", "json:[1", "expected well-formed JSON after `json:`"),
        ("std::vector<double>", "json:[NaN]", "expected well-formed JSON after `json:`"),
        ("std::vector<int>", "json:5", "expected a JSON list after `json:`"),
        ("std::vector<int>", 'json:["1"]', 'expected a number, true or false as each item, found the item `"1"`'),
        ("std::vector<double>", "json:[true]", "expected a number as each item, found the item `true`"),
        ("std::vector<bool>", "json:[1]", "expected true or false as each item, found the item `1`"),
        ("std::vector<std::string>", "json:[1]", "expected a string as each item, found the item `1`"),
        ("std::deque<int>", "json:[1]", "expected an integer as each item, found the item `json:[1]`"),
    ],
)
def test_refused_literals(port_type: str, text: str, message: str) -> None:
    problem = check_literal(port_type, text)
    assert problem is not None
    found = f", found {problem.found}" if problem.found is not None else ""
    assert (problem.kind, f"expected {problem.expected}{found}", problem.reads) == ("refused", message, None)


@pytest.mark.parametrize(
    ("port_type", "text", "reads"),
    [
        ("int", "5abc", "5"),
        ("int", "5.7", "5"),
        ("int", "1e3", "1"),
        ("int", "0x10", "0"),
        ("unsigned int", "30 sec", "30"),
        ("int", "-3,5", "-3"),
        ("double", "1,5", "1"),
        ("double", "1.5m", "1.5"),
        ("double", "1e", "1"),
        ("double", "0x10", "0"),
        ("double", "infinite", "inf"),
        (VECTOR, "1,2", "1"),
        ("std::vector<double>", "1.5;2 m;3", "1.5;2;3"),
    ],
)
def test_trailing_text(port_type: str, text: str, reads: str) -> None:
    problem = check_literal(port_type, text)
    assert problem is not None
    assert (problem.kind, problem.reads) == ("trailing-text", reads)


@pytest.mark.parametrize(
    ("port_type", "text", "expected"),
    [
        # std::stod before 4.9, std::from_chars since.
        ("double", "+1.5", [None, None, "refused"]),
        ("double", " 1.5", [None, None, "refused"]),
        ("double", "0x10", [None, None, "trailing-text"]),
        ("double", "0x1p9999", ["refused", "refused", "trailing-text"]),
        ("double", "abc", ["refused", "refused", "refused"]),
        ("std::vector<double>", "json:[1]", ["refused", "refused", None]),
        ("std::vector<std::string>", "json:[1]", [None, None, "refused"]),
        ("std::vector<bool>", "1;0", ["refused", None, None]),
        ("std::deque<bool>", "1;0", [None, None, None]),
        ("int", "5abc", ["trailing-text"] * 3),
    ],
)
def test_versions_differ(port_type: str, text: str, expected: list[str | None]) -> None:
    problems = [check_literal(port_type, text, version) for version in VERSIONS]
    assert [problem and problem.kind for problem in problems] == expected


def test_a_pointer_has_both_braces_and_something_between() -> None:
    assert [text for text in ("{a}", "{}", "{a", "a}", " {a}", "{a} ", "{{}}") if is_pointer(text)] == ["{a}", "{{}}"]


@pytest.mark.parametrize("version", VERSIONS)
def test_the_engine_reads_its_own_defaults(version: str) -> None:
    for kind in BUILTINS.values():
        for port in kind.ports:
            assert port.default is None or check_literal(of_version(port, version).type, port.default, version) is None


@given(
    st.sampled_from(["int", "unsigned long", "double", "float", "bool", VECTOR, STRINGS, "std::deque<double>"]),
    st.text(alphabet='0123456789.eExX+-;,[]{} naifNjso:p"', max_size=20) | st.text(max_size=6),
    st.sampled_from(VERSIONS),
)
def test_what_is_read_is_read_again(port_type: str, text: str, version: str) -> None:
    problem = check_literal(port_type, text, version)
    if problem is not None and problem.kind == "trailing-text":
        assert problem.reads is not None
        assert check_literal(port_type, problem.reads, version) is None
