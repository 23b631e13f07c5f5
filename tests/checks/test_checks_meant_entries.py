"""Values that are meant as entries: the spellings of newcomers, in each language and version; and mere texts."""

from __future__ import annotations

from typing import Final

import pytest
from check_asserts import MAIN, after, apply, findings, show, workspace_of

from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic, Fix

XML: Final = "main.xml"
RULE: Final = "misspelt-entry"
MODEL: Final = '<TreeNodesModel><Action ID="MoveTo"><input_port name="place" type="{}"/></Action></TreeNodesModel>'
ROOTS: Final = ('<root BTCPP_format="4">', "<root>")
TEXTS: Final = (
    ("{goal", "{goal}"),
    ("goal}", "{goal}"),
    ("{@goal", "{@goal}"),
    ("$goal", "{goal}"),
    ("$(goal)", "{goal}"),
    ("@{goal}", "{@goal}"),
    ("@goal", "{@goal}"),
    ("[goal]", "{goal}"),
    ("%goal%", "{goal}"),
)
MEMBERS: Final = ("{goal.name}", "{goal.pose.x}", "{goal->x}", "{goal::x}", "{goal[0]}", "{goal[0].x}")


def text_of(value: str) -> str:
    return f"`{value}` is a text here, not the entry; did you mean "


def in_xml(text: str) -> list[Diagnostic]:
    return [each for each in check(workspace_of({XML: text}), XML) if each.rule == RULE]


def after_in_xml(text: str, fix: Fix) -> str:
    return apply({XML: text}, XML, fix)[XML]


@pytest.mark.parametrize("root", ROOTS)
@pytest.mark.parametrize("model", ["", MODEL.format(""), MODEL.format("Pose"), MODEL.format("std::string")])
@pytest.mark.parametrize(("value", "meant"), [*TEXTS, ("goal", "{goal}")])
def test_texts_of_xml(root: str, model: str, value: str, meant: str) -> None:
    text = (
        f'{root}<BehaviorTree ID="T"><Sequence><FindPlace place="{{goal}}"/><MoveTo place="{value}"/></Sequence>'
        f"</BehaviorTree>{model}</root>"
    )
    (found,) = in_xml(text)
    assert found.message == f"{text_of(value)}`{meant}`?"
    assert after_in_xml(text, found.fixes[0]) == text.replace(f'"{value}"', f'"{meant}"')


@pytest.mark.parametrize(("value", "meant"), [*TEXTS, ("goal", "{goal}"), ("<goal>", "{goal}")])
def test_texts_of_btq(value: str, meant: str) -> None:
    text = f'BehaviorTree Main\n    ->\n        FindPlace (place = {{goal}})\n        MoveTo (place = "{value}")\n'
    assert findings(text, RULE) == [f'4 warning «"{value}"» {text_of(value)}`{meant}`?']


@pytest.mark.parametrize(
    ("value", "what", "meant"),
    [
        ("{ goal }", "blanks", "{goal}"),
        ("{goal }", "blanks", "{goal}"),
        ("{@ goal}", "blanks", "{@goal}"),
        ("{{goal}}", "braces", "{goal}"),
    ],
)
def test_signs_in_names(value: str, what: str, meant: str) -> None:
    text = f'<root><BehaviorTree ID="T"><Sequence><A b="{{goal}}"/><C d="{value}"/></Sequence></BehaviorTree></root>'
    (found,) = in_xml(text)
    assert found.message == f"the {what} inside `{value}` belong to the name of the entry; did you mean `{meant}`?"
    assert after_in_xml(text, found.fixes[0]) == text.replace(value, meant)


@pytest.mark.parametrize("value", MEMBERS)
def test_members(value: str) -> None:
    text = f"BehaviorTree T\n    ->\n        A (b = {{goal}})\n        C (d = {value})\n"
    message = f"`{value}` is an entry of that name, not a member of `{{goal}}`"
    assert findings(text, RULE) == [f"4 warning «{value}» {message}"]
    written = "Action W\n    output d\n" + text.replace("C (", f"W (d = {value})\n        C (")
    assert findings(written, RULE) == []
    assert findings(text.replace("{goal}", "{place}"), RULE) == []


SUBTREE: Final = (
    "{}<BehaviorTree ID='A'><Sequence><Find cup='{{cup_pose}}'/><Use it='{{cup_pose}}'/>"
    "<SubTree ID='B' object='cup_pose'/></Sequence></BehaviorTree>"
    "<BehaviorTree ID='B'><Give object='{{object}}'/></BehaviorTree></root>"
)


@pytest.mark.parametrize(("root", "expected"), [(ROOTS[0], [f"{text_of('cup_pose')}`{{cup_pose}}`?"]), (ROOTS[1], [])])
def test_names_at_subtrees_are_of_version_3(root: str, expected: list[str]) -> None:
    assert [each.message for each in in_xml(SUBTREE.format(root))] == expected


def test_entries_of_callers() -> None:
    text = (
        "BehaviorTree A\n    ->\n        Find (cup = {cup_pose})\n        SubTree B (object = {cup_pose})\n"
        "        SubTree C (_autoremap = true)\n"
        "BehaviorTree B\n    Give (object = object)\n"
        "BehaviorTree C\n    Give (pose = cup_pose)\n"
    )
    assert findings(text, RULE) == [
        f"7 warning «object» {text_of('object')}`{{object}}`?",
        f"9 warning «cup_pose» {text_of('cup_pose')}`{{cup_pose}}`?",
    ]


@pytest.mark.parametrize(
    ("nodes", "count"),
    [
        ("Take (image = {photo}); Store (image = photo)", 1),  # at a port of the same name
        ("Take (image = {photo}); Show (what = photo)", 1),  # which nothing reads
        ("Take (image = {photo}); Show (photo = photo)", 1),
        ("Take (image = {photo}); Show (frame = {photo}); Show (what = photo)", 0),  # a text may be called so
        ("Take (image = {photo}); Store (key = photo)", 0),
        ("Take (image = {photo}); Show (image_name = photo)", 0),
        ('SetBlackboard (output_key = home, value = "home"); Go (place = home)', 0),
        ('SetBlackboard (output_key = home, value = "1;2"); Go (place = home)', 1),
        ("Take (image = {photo}); Show (what = {image})", 0),
        ("Take (image = {photo}); Script (code = 'photo := 1'); Show (what = 'photo')", 1),
    ],
)
def test_bare_words(nodes: str, count: int) -> None:
    lines = "".join(f"        {node}\n" for node in nodes.split("; "))
    text = "Action Take\n    output image\n" + f"BehaviorTree Main\n    ->\n{lines}"
    assert len(findings(text, RULE)) == count


GO: Final = (
    "Action Find\n    output bed : string\nAction Look\n    input at : string\n"
    "Action Go\n    input place : string\n"
    "BehaviorTree Main\n    ->\n        Find (bed = {{bed}})\n        Look (at = {{bed}})\n"
    "        Go (place = {})\n        Go (place = {})\n"
)


def test_a_bare_word_where_all_texts_have_quotes() -> None:
    text = GO.format("bed", '"dock"')
    (found,) = check(workspace_of({MAIN: text}), MAIN)
    assert show(text, [found]) == ["11:21 hint misspelt-entry «bed» `bed` is a text here, not the entry `{bed}`"]
    assert found.notes == ('write `{bed}` for the entry, `"bed"` for the text',)
    mended = [after(text, fix) for fix in found.fixes]
    assert mended == [text.replace("place = bed", f"place = {meant}") for meant in ("{bed}", '"bed"')]
    assert [check(workspace_of({MAIN: each}), MAIN) for each in mended] == [(), ()]


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        (GO.format("bed", "bed"), ["11", "12"]),
        (GO.format("bed", "dock"), []),  # texts without quotes
        (GO.format("bed", '"bed"'), []),  # the same text
        (GO.format("bath", '"dock"'), []),
        (GO.format("bed", '"dock"').replace("string\nB", "string = bed\nB"), []),
        (GO.format("bed", '"dock"').replace("place", "name"), []),
        (GO.format("bed", '"dock"').replace("        Find (bed = {bed})\n", "") + "        Find (bed = {bed})\n", []),
        ("Action Go\n    input place : string\nBehaviorTree A\n    input bed\n    Go (place = bed)\n", ["5"]),
    ],
)
def test_bare_words_that_are_rather_texts(text: str, lines: list[str]) -> None:
    assert [found.split()[0] for found in findings(text, RULE)] == lines


@pytest.mark.parametrize("value", ["true", "False", "NaN", "inf", "SUCCESS", "running", "1"])
@pytest.mark.parametrize("type_", ["", " : Pose", " : string"])
def test_words_that_are_values_are_never_meant_as_entries(value: str, type_: str) -> None:
    model = f"Action Find\n    output seen\nAction Go\n    input seen{type_}\n"
    text = f"{model}BehaviorTree Main\n    ->\n        Find (seen = {{{value}}})\n        Go (seen = {value})\n"
    assert findings(text, RULE) == []
    assert findings(text.replace("Main\n", "Main\n    output seen\n").replace(value, "place"), RULE) != []


def test_the_default_of_a_port_is_a_value() -> None:
    model = "Action Go\n    input mode : Mode = FAST\n"
    text = f"{model}BehaviorTree Main\n    ->\n        Find (m = {{FAST}})\n        Go (mode = {{}})\n"
    assert findings(text.replace("{}", "FAST"), RULE) == []
    other = text.replace("{FAST}", "{SLOW}").replace("{}", "SLOW")
    assert findings(other, RULE) == [f"6 warning «SLOW» {text_of('SLOW')}`{{SLOW}}`?"]


def test_no_literal_that_a_type_refuses_is_meant_as_an_entry_if_it_is_a_value() -> None:
    text = (
        "BehaviorTree Main\n    ->\n        Find (seen = {true})\n        Repeat 3 (num_cycles = true)\n            A\n"
    )
    assert not any("{true}" in each.message for each in check(workspace_of({MAIN: text}), MAIN))


def test_one_diagnostic_where_the_type_refuses_it() -> None:
    model = "Action Go\n    input speed : double\n"
    text = f"{model}BehaviorTree Main\n    ->\n        Read (out = {{v}})\n        Go (speed = v)\n"
    (found,) = check(workspace_of({MAIN: text}), MAIN)
    assert show(text, [found]) == [
        "6:21 error invalid-literal «v» expected a number for `speed`, found `v`; did you mean `{v}`?"
    ]
    assert after(text, found.fixes[0]) == text.replace("= v", "= {v}")


def test_outputs() -> None:
    text = 'Action Read\n    output speed : double\nBehaviorTree Main\n    Read (speed = "@{v}")\n'
    (found,) = check(workspace_of({MAIN: text}), MAIN)
    assert (found.rule, found.fixes[0].title) == ("literal-for-output", "Write the entry `{@v}`")


@pytest.mark.parametrize(
    ("value", "message", "fix"),
    [
        ("@{goal}", "a blackboard entry is written `{@goal}`", "Write `{@goal}`"),
        ("[goal]", "a blackboard entry is written `{goal}`", "Write `{goal}`"),
        ("<goal>", "a blackboard entry is written `{goal}`", "Write `{goal}`"),
        ("[gaol]", "this value needs quotes", "Put quotes around it"),
        ("[1, 2]", "this value needs quotes", "Put quotes around it"),
    ],
)
def test_unquoted(value: str, message: str, fix: str) -> None:
    text = f"BehaviorTree Main\n    ->\n        Find (place = {{goal}})\n        Go (place = {value})\n"
    (found,) = check(workspace_of({MAIN: text}), MAIN)
    assert (found.message, [each.title for each in found.fixes]) == (message, [fix])
    assert not any(each.safe for each in found.fixes)


@pytest.mark.parametrize(
    ("value", "reported"),
    [
        ("$(var planner)", "$(var planner)"),
        ("$(arg planner)", "$(arg planner)"),
        ("$(find-pkg-share my_bot)/maps/a.yaml", "$(find-pkg-share my_bot)"),
        ("file://$(find my_bot)/a.yaml", "$(find my_bot)"),
        ("$(env ROBOT)", "$(env ROBOT)"),
        ("$(optenv ROBOT.NAME)", "$(optenv ROBOT.NAME)"),
        ("echo $(date)", None),  # a command of a shell
        ("$(find . -name a)", None),
        ("$var planner", None),
    ],
)
def test_a_substitution_of_launch_files(value: str, reported: str | None) -> None:
    model = MODEL.format("std::string")
    text = f'{ROOTS[0]}<BehaviorTree ID="A"><MoveTo place="{value}"/></BehaviorTree>{model}</root>'
    message = f"`{reported}` is a text here: only launch files have such substitutions"
    notes = ("write the value itself, or an entry that the robot's program sets: `{key}`",)
    assert [(each.message, each.notes) for each in in_xml(text)] == ([(message, notes)] if reported else [])
    mission = f'Action MoveTo\n    input place : string\nBehaviorTree A\n    MoveTo (place = "{value}")\n'
    shown = f'4:21 warning misspelt-entry «"{value}"» {message}'
    found = check(workspace_of({"main.btq": mission}), "main.btq")
    assert show(mission, found) == ([shown] if reported else [])
