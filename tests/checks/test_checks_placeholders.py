"""Classic placeholders: the short form that is offered, all that it keeps, and IDs that are taken."""

from __future__ import annotations

from pathlib import Path

import pytest
from check_asserts import after, findings, fixes, problems

from btq_lang.parser import parse
from btq_lang.syntax.tree import Node, shape


def tree(node: str) -> str:
    return f"BehaviorTree Main\n    {node}\n"


@pytest.mark.parametrize(
    ("classic", "short"),
    [
        ('ScriptAction (name = "MoveBase")', "MoveBase"),
        ("ScriptAction (name = MoveBase)", "MoveBase"),
        ('Script (name = "MoveBase")', "MoveBase"),
        ("ScriptAction MoveBase", "MoveBase"),
        ('ScriptAction "Move Base" (x = 1)', 'Move_Base "Move Base" (x = 1)'),
        ('ScriptAction\t( name = "MoveBase" , )', "MoveBase"),
        ('ScriptAction (name = "MoveBase" station = "solid")', 'MoveBase (station = "solid")'),
        ('ScriptAction (name = "MoveBase", station = "solid",)', 'MoveBase (station = "solid",)'),
        ('ScriptAction (name = "MoveBase" satisfies rq1)', "MoveBase (satisfies rq1)"),
        ('ScriptAction (name = "MoveBase") satisfies rq1  # why', "MoveBase satisfies rq1  # why"),
        ('ScriptAction (name = "MoveBase" # why\n    )', "MoveBase (# why\n    )"),
        ('ScriptAction (\n    name = "M"\n    x = 1\n    )', "M (\n    x = 1\n    )"),
        ('ScriptAction (\r\n    name = "M"\r\n    x = 1)', "M (\r\n    x = 1)"),
        ('ScriptAction (\n    name = "M"  # why\n    x = 1)', "M (\n    # why\n    x = 1)"),
        ('ScriptAction (name = "M"\n    x = 1)', "M (\n    x = 1)"),
        ('ScriptAction (\n    name = "M"\n    )', "M"),
        ('ScriptCondition (name = "Empty?")', 'Condition Empty "Empty?"'),
        ("ScriptCondition (name = Empty? x = 1)", "Condition Empty Empty? (x = 1)"),
        ("ScriptCondition (name = 'Empty')", "Condition Empty"),
        ('ScriptAction (name = "3 Tubes")', '_3_Tubes "3 Tubes"'),
        ("ScriptAction (name = 30 s)", '_30_s "30 s"'),
        # Words that would be read as something else.
        ('ScriptAction (name = "keeps")', '"keeps"'),
        ('ScriptAction (name = "Control")', '"Control"'),
        ('ScriptAction (name = "Retry")', '"Retry"'),
        ('ScriptAction (name = "Test")', '"Test"'),
        ('ScriptCondition (name = "input")', 'Condition "input"'),
        ('ScriptAction (name = "Squence")', "Action Squence"),
        # Other nodes of the tree, and what stands around them, stay as they are.
        ('-> (name = "Plan")\n        ScriptAction (name = "A")', '-> (name = "Plan")\n        A'),
    ],
)
def test_the_short_form(classic: str, short: str) -> None:
    text = tree(classic)
    assert [(safe, mended) for _, safe, mended in fixes(text, "classic-placeholder")] == [(True, tree(short))]
    assert problems(tree(short), "classic-placeholder", "unknown-node", "clause-as-node") == []
    assert parse(tree(short)).diagnostics == ()


@pytest.mark.parametrize(
    "node",
    [
        "ScriptAction (x = 1)",
        'ScriptAction (name = "A" code = "x := 1")',
        '"ScriptAction" (name = "A")',
        'Action ScriptAction (name = "A")',
        'Action A (name = "B")',
        'Sequence (name = "A")',
    ],
)
def test_what_is_no_placeholder(node: str) -> None:
    assert problems(tree(node), "classic-placeholder", "placeholder-clash") == []


@pytest.mark.parametrize(
    "node",
    [
        'ScriptAction (x = 1 name = "A")',
        'ScriptAction (parameters name = "A", x = 1)',
        'ScriptAction (satisfies rq1, name = "A")',
        'ScriptAction (name = "A" name = "B")',
        'ScriptAction A (name = "B")',
        "ScriptAction /* why */ A",
        'ScriptAction /* why */ (name = "A")',
        'ScriptAction (/* why */ name = "A")',
        'ScriptAction (name = "A")\n        Pick',
    ],
)
def test_where_the_name_stands_in_an_unusual_place_no_fix_is_offered(node: str) -> None:
    assert len(problems(tree(node), "classic-placeholder")) == 1
    assert fixes(tree(node), "classic-placeholder") == []


def test_with_models_a_skill_is_held_against_them_so_the_fix_is_not_safe() -> None:
    text = 'Action MoveBase\n    input station : string\n\nBehaviorTree Main\n    ScriptAction (name = "MoveBase")\n'
    ((_, safe, mended),) = fixes(text, "classic-placeholder")
    assert not safe
    assert findings(mended, "missing-port") == [
        "5 warning «MoveBase» `MoveBase` requires a value for its port `station`"
    ]


def test_the_example_of_the_paper(shared: Path) -> None:
    """All fixes at once: the same nodes with the same attributes, clauses and children."""
    text = (shared / "original" / "paper_example.qualitybtcpp").read_text("utf-8")
    found = problems(text, "classic-placeholder")
    assert [diagnostic.fixes[0].title for diagnostic in found] == [
        'Write `Condition BatteryLow "BatteryLow?"`',
        "Write `MoveBase`",
        "Write `Charge`",
        "Write `MoveBase`",
        'Write `Condition MicroplateNotEmpty "MicroplateNotEmpty?"`',
        "Write `Pick`",
        "Write `Place`",
    ]
    mended = text
    for diagnostic in reversed(found):
        mended = after(mended, diagnostic.fixes[0])
    assert problems(mended, "classic-placeholder") == []
    assert parse(mended).diagnostics == ()
    assert [without_name(node) for node in nodes(mended)] == [without_name(node) for node in nodes(text)]
    assert [node.name.text for node in nodes(mended) if node.name] == [
        *("BatteryCheck", "BatteryLow?", "SolidStation", "MoveTubes", "MicroplateNotEmpty?")
    ]


def nodes(text: str) -> list[Node]:
    return [node for tree in parse(text).trees for node in tree.walk()]


def without_name(node: Node) -> object:
    pairs = tuple(pair for pair in node.attributes if pair.key.text != "name")
    return shape(pairs), shape(node.clauses), len(node.children)


def test_two_names_that_become_one_id() -> None:
    text = (
        'BehaviorTree Main\n    ->\n        ScriptCondition (name = "Low?")\n        ScriptCondition (name = "Low?")\n'
        '        SubTree Other\n\nBehaviorTree Other\n    ScriptAction (name = "Low!")\n'
    )
    assert findings(text, "placeholder-clash") == ['8 error «"Low!"» `Low?` and `Low!` both become the node ID `Low`']
    (found,) = problems(text, "placeholder-clash")
    (related,) = found.related
    assert text[related.place.span.start : related.place.span.end] == '"Low?"'


def test_a_clash_with_an_included_file_shows_its_place_there() -> None:
    skills = "BehaviorTree Battery\n    ScriptCondition (name = 'Low?')\n"
    text = (
        'include "skills.btq"\n\nBehaviorTree Main\n    ->\n        SubTree Battery\n'
        '        ScriptAction (name = "Low")\n'
    )
    assert findings(text, "placeholder-clash", skills=skills) == [
        '6 error «"Low"» `Low?` and `Low` both become the node ID `Low`'
    ]
    (found,) = problems(text, "placeholder-clash", skills=skills)
    place = found.related[0].place
    assert (place.path, skills[place.span.start : place.span.end]) == ("skills.btq", "'Low?'")


def test_an_id_that_the_engine_or_a_tree_has() -> None:
    text = "BehaviorTree Main\n    ScriptAction Sleep\n\nBehaviorTree Other\n    ScriptAction Main\n"
    assert findings(text, "placeholder-clash", "classic-placeholder") == [
        "2 error «Sleep» `Sleep` becomes the node ID `Sleep`, which is a built-in node",
        "5 error «Main» `Main` becomes the node ID `Main`, which is the name of a tree",
    ]


@pytest.mark.parametrize(
    ("written", "after"),
    [
        ('Script "speed := 0.5"', 'Script (code = "speed := 0.5")'),
        ("Script 'speed = 0.5; n += 1'", "Script (code = 'speed = 0.5; n += 1')"),
        ('ScriptAction "@n := 1 + 2"', 'ScriptAction (code = "@n := 1 + 2")'),
        ('ScriptAction (name = "a := b")', 'ScriptAction (code = "a := b")'),
        ('ScriptCondition "battery > 20"', 'ScriptCondition (code = "battery > 20")'),
        ('ScriptCondition (name = "ok && battery > 20")', 'ScriptCondition (code = "ok && battery > 20")'),
        ("Script \"speed := 'fast'\"", "Script (code = \"speed := 'fast'\")"),
    ],
)
def test_a_script_where_a_name_goes(written: str, after: str) -> None:
    kind, code = written.split(" ")[0], after.split("code = ")[1][1:-2]
    name = written.split("name = ")[1][:-1] if "name =" in written else written.partition(" ")[2]
    message = f"`{code}` is the name of this `{kind}`; a script goes in its port `code`"
    assert findings(tree(written), "classic-placeholder") == [f"2 warning «{name}» {message}"]
    assert [(safe, mended) for _, safe, mended in fixes(tree(written), "classic-placeholder")] == [(False, tree(after))]
    assert problems(tree(after), "classic-placeholder", "script-error") == []


def test_a_script_as_a_name_beside_a_port_is_not_moved() -> None:
    assert fixes(tree('Script "n := 1" (x = 1)'), "classic-placeholder") == []


@pytest.mark.parametrize(
    "name", ["pick-up", "Battery low?", "Dock & charge", "a/b", "=> dock", "<undock>", "3 > 2 > dock!"]
)
def test_names_that_are_no_scripts(name: str) -> None:
    assert problems(tree(f'Script "{name}"'), "classic-placeholder")[0].message.startswith("`Script` without code is")
