"""Numbers that SubTrees of XML give to ports of other types: what 4.10.0 refuses, and what it takes."""

from __future__ import annotations

from pathlib import Path

import pytest
from check_asserts import apply, workspace_of
from in_process import run_btq

from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

XML = (
    '<root BTCPP_format="4"><BehaviorTree ID="M"><SubTree ID="S" v="{}"/></BehaviorTree>'
    '<BehaviorTree ID="S"><Read v="{{v}}"/></BehaviorTree>'
    '<TreeNodesModel><Action ID="Read"><input_port name="v" type="{}"/></Action></TreeNodesModel></root>'
)


def refused(text: str, engine: str = "4.10") -> list[Diagnostic]:
    files = workspace_of({"main.xml": text}).files
    found = check(Workspace(files, Project(engines=(engine,))), "main.xml")
    return [each for each in found if each.rule == "entry-with-two-types"]


@pytest.mark.parametrize(
    ("type_", "refuses", "takes"),
    [
        ("bool", ("1", "1.0", "99999999999", "1e0"), ("true", "1 ")),
        ("double", ("1", "99999999999"), ("1.0", "1e0", "1 ")),
        ("float", ("1", "1.0", "1e0"), ("1 ",)),
        ("int", ("1.0", "99999999999", "1e0"), ("1", "1 ")),
        ("int64_t", ("1", "1.0", "1e0"), ("99999999999", "1 ")),
        ("uint8_t", ("1", "1.0", "99999999999", "1e0"), ("1 ",)),
        ("unsigned int", ("10", "010"), ("+10", " 10", "{m}")),
        ("Pose", (), ("1",)),
        ("std::string", (), ("1",)),  # which number-for-text reports
    ],
)
def test_as_the_engine(type_: str, refuses: tuple[str, ...], takes: tuple[str, ...]) -> None:
    for number in refuses:
        (found,) = refused(XML.format(number, type_))
        assert found.effective_severity is Severity.ERROR
        for fix in found.fixes:
            text = apply({"main.xml": XML.format(number, type_)}, "main.xml", fix)["main.xml"]
            assert refused(text) == []
    assert [number for number in takes if refused(XML.format(number, type_))] == []


def test_what_is_told() -> None:
    text = XML.format("10", "unsigned int")
    (found,) = refused(text)
    assert found.message == (
        "BehaviorTree.CPP 4.9.1 and later refuse to load this tree: "
        "`10` is of the type int, `v` of `Read` of unsigned int"
    )
    assert found.notes == ("write `10 `: with a blank at its end it stays a text, which the node reads as the number",)
    assert [each.message for each in found.related] == ["read here as unsigned int"]


@pytest.mark.parametrize("engine", ["4.6", "4.8", "4.9"])
def test_earlier_versions_give_texts(engine: str) -> None:
    assert refused(XML.format("10", "unsigned int"), engine) == []


def test_it_is_a_hint_where_no_engine_is_named() -> None:
    found = check(workspace_of({"main.xml": XML.format("10", "unsigned int")}), "main.xml")
    assert [each.effective_severity for each in found if each.rule == "entry-with-two-types"] == [Severity.HINT]


def test_a_double_is_written_with_a_point() -> None:
    (found,) = refused(XML.format("10", "double"))
    assert [fix.title for fix in found.fixes] == ["Write `10.0`"]


DEFAULT = (
    '<root BTCPP_format="4"><BehaviorTree ID="M"><SubTree ID="S"{}/></BehaviorTree>'
    '<BehaviorTree ID="S"><Sleep msec="{{v}}"/></BehaviorTree>'
    '<TreeNodesModel><SubTree ID="S"><input_port name="v" default="{}"/></SubTree></TreeNodesModel></root>'
)


@pytest.mark.parametrize(
    ("attributes", "default", "is_refused"),
    [
        ("", "10", True),
        (' _autoremap="false"', "10", True),
        ("", "10 ", False),
        ("", "{ms}", False),
        (' v="{ms}"', "10", False),
        (' _autoremap="true"', "10", False),
    ],
)
def test_a_default_counts_where_a_subtree_gives_no_value(attributes: str, default: str, is_refused: bool) -> None:
    text = DEFAULT.format(attributes, default)
    assert [(each.message, each.effective_severity) for each in refused(text)] == [
        (
            "BehaviorTree.CPP 4.9.1 and later refuse to load this tree: "
            "`10` is of the type int, `msec` of `Sleep` of unsigned int",
            Severity.ERROR,
        )
    ] * is_refused
    for fix in (fix for each in refused(text) for fix in each.fixes):
        assert apply({"main.xml": text}, "main.xml", fix)["main.xml"] == DEFAULT.format(attributes, "10 ")
    assert refused(text, "4.9") == []


def test_a_default_is_reported_in_a_project(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(DEFAULT.format("", "10"))
    (tmp_path / "btq.toml").write_text('engine = "4.10"\n')
    column = DEFAULT.format("", "10").index('10"') + 1
    place = f"a.xml:1:{column}: error[entry-with-two-types] BehaviorTree.CPP 4.9.1 and later refuse to load this tree: "
    code, out, _ = run_btq("check", "--output-format", "concise", cwd=tmp_path)
    assert (code, out.splitlines()[0]) == (1, f"{place}`10` is of the type int, `msec` of `Sleep` of unsigned int")
