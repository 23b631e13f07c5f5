"""The engine's rules for names, and what is made of a name that breaks them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.catalog.names import (
    instance_name_problem,
    is_port_name,
    legal_name,
    model_name_problem,
    port_name_problem,
)
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.versions import VERSIONS


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("MoveBase", None),
        ("3Waypoints", None),
        ("-_#@(),;=+~%![]{}", None),
        ("größe", None),
        ("机器人", None),
        ("", "it is empty"),
        ("Root", "`Root` is a reserved name"),
        ("root", "`Root` is a reserved name"),
        ("ROOT", None),
        ("a b", "it contains a space"),
        ("BatteryLow?", "it contains `?`"),
        ("a\tb", "it contains the control character U+0009"),
        ("a\x7f", "it contains the control character U+007F"),
        *((f"a{character}b", f"it contains `{character}`") for character in "<>&\"'/\\:*?|."),
    ],
)
def test_model_names(name: str, expected: str | None) -> None:
    assert model_name_problem(name) == expected
    assert model_name_problem(name, "4.8") == expected
    assert model_name_problem(name, "4.6") is None


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("goal", None),
        ("_goal", None),
        ("größe", None),
        ("", "it is empty"),
        ("1st", "it begins with a digit"),
        ("a b", "it contains a space"),
        ("a.b", "it contains `.`"),
        *(
            (name, "it is the name of a reserved attribute")
            for name in ("name", "ID", "_autoremap", "_skipIf", "_post")
        ),
        ("_description", None),
    ],
)
def test_port_names_of_subtree_models(name: str, expected: str | None) -> None:
    assert port_name_problem(name) == expected
    assert port_name_problem(name, "4.8") == expected
    assert port_name_problem(name, "4.6") is None


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("", None),
        ('3 Waypoints: "Pick" & Place?', None),
        ("two\nlines\t\r", None),
        ("a\x01", "it contains the control character U+0001"),
        ("\x7f", "it contains the control character U+007F"),
    ],
)
def test_instance_names(name: str, expected: str | None) -> None:
    assert instance_name_problem(name) == expected
    assert instance_name_problem(name, "4.6") is None


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        *((name, True) for name in ("goal", "a-b", "größe", "x1")),
        *((name, False) for name in ("", "_x", "1st", "name", "ID", "über")),
    ],
)
def test_what_is_taken_for_a_port(name: str, expected: bool) -> None:
    assert [is_port_name(name, version) for version in VERSIONS] == [expected] * 3


def test_older_engines_take_more_for_ports() -> None:
    assert [is_port_name("zz.z", version) for version in VERSIONS] == [True, False, False]


def test_every_port_of_a_built_in_is_one() -> None:
    ports = {port.name for kind in BUILTINS.values() for port in kind.ports}
    assert {name for name in ports if not is_port_name(name)} == {"_autoremap"}


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("BatteryLow?", "BatteryLow"),
        ("MicroplateNotEmpty?", "MicroplateNotEmpty"),
        ("Move Base", "Move_Base"),
        ("Move  (fast): now!", "Move_fast_now"),
        ("3 Tubes", "_3_Tubes"),
        ("go-home-", "go-home"),
        ("größe", "größe"),
        ("Root", "Root_"),
        ("???", "_"),
        ("", "_"),
    ],
)
def test_legal_name(name: str, expected: str) -> None:
    assert legal_name(name) == expected


@given(st.text())
def test_a_legal_name_is_legal_and_stays(name: str) -> None:
    legal = legal_name(name)
    assert model_name_problem(legal) is None
    assert legal_name(legal) == legal
