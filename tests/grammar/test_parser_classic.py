"""Classic files, as the paper prints them and the original tool wrote them: accepted for ever, language.md §1, §3."""

from __future__ import annotations

from pathlib import Path

import pytest
from syntax_asserts import assert_parse, assert_same, dump

from btq_lang.parser import parse
from btq_lang.syntax.tree import Node, Requirement, Satisfices, Satisfies


def test_the_authors_own_example_byte_for_byte(shared: Path) -> None:
    text = (shared / "original" / "paper_example.qualitybtcpp").read_bytes().decode("utf-8")
    parsed = assert_parse(text)
    tree = """
root mainTree
  tree mainTree
    ?
      -> (name="BatteryCheck")
        ScriptCondition (name="BatteryLow?")
        ScriptAction (name="MoveBase")
          satisfices performance [{classic "rq1" "SuccessIf the moving to charging station shall take at most 30 sec. FailureIf the charging took longer than 30 sec"}]
        ScriptAction (name="Charge")
      -> (name="SolidStation")
        ScriptAction (name="MoveBase")
          satisfies {classic "rq2" "The robot should have at least a battery capacity of 3% left."}
        SubTree (ID=PickPlace)
        Retry (num_attempts="6")
          Inverter
            -> (name="MoveTubes")
              ScriptCondition (name="MicroplateNotEmpty?")
              SubTree (ID=PickPlace)
                satisfies {classic "rq3" "The information on the tube label shall be processed locally on the robot."}
  tree PickPlace
    ->
      ScriptAction (name="Pick")
      ScriptAction (name="Place")
"""  # noqa: E501  # as long as what the authors wrote
    found = dump(parsed).replace("\\r", "").replace("\\n", " ")
    assert_same(" ".join(found.split()), " ".join(tree.split()))
    assert [line for line in found.split("\n") if "classic" not in line] == [
        line for line in tree.strip().split("\n") if "classic" not in line
    ]


def test_its_requirements_are_found(shared: Path) -> None:
    parsed = parse((shared / "original" / "paper_example.qualitybtcpp").read_bytes().decode("utf-8"))
    assert [
        (node.head.text, *requirement) for tree in parsed.trees for node in tree.walk() for requirement in of(node)
    ] == [
        ("ScriptAction", "performance", "rq1", "SuccessIf the moving"),
        ("ScriptAction", None, "rq2", "The robot should hav"),
        ("PickPlace", None, "rq3", "The information on t"),
    ]


def of(node: Node) -> list[tuple[str | None, str, str]]:
    """The requirements at a node: the quality around it, its ID and how its text begins."""
    found: list[tuple[str | None, str, str]] = []
    for clause in node.clauses:
        if isinstance(clause, Satisfices):
            for quality in clause.qualities:
                name = quality.path.names[0].text
                found += [(name, *said(requirement)) for requirement in quality.requirements]
        elif isinstance(clause, Satisfies):
            found += [(None, *said(use)) for use in clause.uses if isinstance(use, Requirement)]
    return found


def said(requirement: Requirement) -> tuple[str, str]:
    assert requirement.classic
    assert requirement.name is not None
    assert requirement.text is not None
    return requirement.name.text, requirement.text.text[:20]


# ---- the forms, one by one ------------------------------------------------------------------------------------------


def in_brackets(attributes: str, shown: str, *problems: str) -> None:
    """A script action with these attributes, followed by a node."""
    text = f"BehaviorTree ID = t\n\t->\n\t\tScriptAction ({attributes})\n\t\tZ\n"
    assert_parse(text, f"tree t\n  ->\n    ScriptAction{shown}\n    Z", *problems)


@pytest.mark.parametrize(
    ("attributes", "shown"),
    [
        (
            'name = "a" satisfices Quality = performance (QualityReq ID = "r" description = "d")',
            ' (name="a")\n      satisfices performance [{classic "r" "d"}]',
        ),
        (
            'name = "a" satisfices Quality = performance <time-behavior> (QualityReq ID = "r")',
            ' (name="a")\n      satisfices performance.time-behavior [{classic "r"}]',
        ),
        ("satisfices Quality = a Quality = b", "\n      satisfices a, b"),
        (
            'satisfices Quality = a (QualityReq ID = "r") Quality = b (QualityReq ID = "q"), Quality = c',
            '\n      satisfices a [{classic "r"}], b [{classic "q"}], c',
        ),
        (
            'satisfices Quality = a (QualityReq ID = "r" description = "d" QualityReq ID = "q", QualityReq ID = "p")',
            '\n      satisfices a [{classic "r" "d"}] [{classic "q"}] [{classic "p"}]',
        ),
        ('satisfies QualityReq ID = "r" description = "d"', '\n      satisfies {classic "r" "d"}'),
        ('satisfies QualityReq ID = "r", description = "d"', '\n      satisfies {classic "r" "d"}'),
        (
            'satisfies QualityReq ID = "r" QualityReq ID = "q" description = "d", QualityReq ID = "p"',
            '\n      satisfies {classic "r"}, {classic "q" "d"}, {classic "p"}',
        ),
        (
            'satisfies QualityReq ID = "r" description = "d", name = "a"',
            ' (name="a")\n      satisfies {classic "r" "d"}',
        ),
        ('satisfies QualityReq ID = "r", ID = "a"', ' (ID="a")\n      satisfies {classic "r"}'),
        (
            'satisfies QualityReq ID = "r" description = "d" description = "e"',
            ' (description="e")\n      satisfies {classic "r" "d"}',
        ),
        ("Quality = a", " (Quality=a)"),
        ("satisfices Quality = a, name = b", " (name=b)\n      satisfices a"),
        ("satisfices Quality = a, satisfies QualityReq ID = r", "\n      satisfices a\n      satisfies {classic r}"),
        ("name = a parameters x = 1, y = {z}", " (name=a x=1 y={z})"),
        ("parameters x = 1 y = 2 satisfies QualityReq ID = r", " (x=1 y=2)\n      satisfies {classic r}"),
    ],
)
def test_attributes_of_the_paper(attributes: str, shown: str) -> None:
    in_brackets(attributes, shown)
    in_brackets(attributes.replace(" = ", "\n\t\t\t=\n\t\t"), shown)


@pytest.mark.parametrize(
    ("attributes", "shown", "problem"),
    [
        (
            "satisfices Quality = a (QualityReq)",
            "\n      satisfices a [{MISSING}]",
            "3:51 syntax-error «)» expected the requirement's ID, found `)`",
        ),
        (
            'satisfices Quality = a (QualityReq ID = "r" descripton = "d") name = b',
            ' (name=b)\n      satisfices a [{classic "r"}]',
            "3:61 syntax-error «descripton» expected QualityReq or `)`, found `descripton`",
        ),
        ('satisfies QualityReq ID "r" name = b', ' (name=b)\n      satisfies {ID "r"}', None),
        (
            'satisfies QualityReq ID = description = "d"',
            "\n      satisfies {classic description}",
            "3:55 syntax-error «=» expected an attribute: key = value, found `=`",
        ),
        (
            "satisfies ID = r name = b",
            " (name=b)\n      satisfies ID",
            "3:30 syntax-error «=» expected an attribute: key = value, found `=`",
        ),
    ],
)
def test_broken_attributes_of_the_paper(attributes: str, shown: str, problem: str | None) -> None:
    in_brackets(attributes, shown, *([problem] if problem else []))


def test_a_tree_and_a_subtree_of_the_paper() -> None:
    text = """
        Root mainTree
        \tBehaviorTree ID = x
        \t\tSubTree (ID = x satisfies QualityReq ID = "rq3" description = "…")
        \tBehaviorTree ID  =  "x y"
        \t\tSubTree (
        \t\tID = x
        \t\tsatisfies QualityReq
        \t\tID = "rq3"
        \t\tdescription = "…")
    """
    tree = """
        root mainTree
          tree x
            SubTree (ID=x)
              satisfies {classic "rq3" "…"}
          tree "x y"
            SubTree (ID=x)
              satisfies {classic "rq3" "…"}
    """
    assert_parse(text, tree)
