"""Misspelt entries: those that are reported, and all that only looks like one."""

from __future__ import annotations

from pathlib import Path

import pytest
from check_asserts import findings, fixes, problems, show
from in_process import run_btq

RULE = "misspelt-entry"

MODELS = """Action Take
    output image
Action Store
    input image
Action Any
    inout image
"""


def told(lines: str, head: str = "") -> list[str]:
    """The diagnostics of a tree of these lines, without the line and the severity."""
    body = "".join(f"        {line}\n" for line in lines.strip("\n").split("\n"))
    text = f"{MODELS}{head}BehaviorTree Main\n    ->\n{body}"
    return [found.split(" ", 2)[2] for found in findings(text, RULE)]


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("traget", "target"),
        ("tarrget", "target"),
        ("taget", "target"),
        ("batteryLevel", "battery_level"),
        ("battery__level", "battery_level"),
        ("Picture", "picture"),
        ("imgg", "img"),
        ("taxget", "target"),
        ("cnt", "count"),
    ],
)
def test_slips(word: str, meant: str) -> None:
    assert told(f"Take (image = {{{meant}}})\nStore (image = {{{meant}}})\nStore (image = {{{word}}})") == [
        f"«{word}» nothing writes `{word}`, which is read here; did you mean `{meant}`?"
    ]


@pytest.mark.parametrize(
    ("word", "other"),
    [
        ("goal1", "goal2"),
        ("goal", "goal2"),
        ("goals", "goal"),
        ("boxes", "box"),
        ("goal_x", "goal_y"),
        ("pose", "post"),
        ("pos", "pose"),
        ("path", "paths"),
        ("left_hand", "lift_hand"),
        ("_target", "target"),
        ("in", "inn"),
        ("start_pose", "goal_pose"),
    ],
)
def test_two_names(word: str, other: str) -> None:
    assert told(f"Take (image = {{{other}}})\nStore (image = {{{other}}})\nStore (image = {{{word}}})") == []


def test_what_is_written_and_never_read() -> None:
    lines = 'Script (code = "count := 1.0")\nScript (code = "cuont := (count + 1.0)")\nStore (image = {count})'
    assert told(lines) == ["«cuont» nothing reads `cuont`, which is written here; did you mean `count`?"]


def test_without_models_two_places_that_are_alone_are_told_once_and_either_may_be_meant() -> None:
    text = "BehaviorTree Main\n    ->\n        A (x = {picture})\n        B (x = {pictuer})\n"
    assert findings(text, RULE) == ["3 warning «picture» `picture` appears only here; did you mean `pictuer`?"]
    assert fixes(text, RULE) == [
        ("Replace `picture` with `pictuer`", False, text.replace("picture", "pictuer")),
        ("Replace `pictuer` with `picture`", False, text.replace("pictuer", "picture")),
    ]


@pytest.mark.parametrize(("own", "renamed"), [("{picture}", "{pictuer}"), ("{=}", "{pictuer}")])
def test_braces_stay_around_an_entry_with_the_name_of_its_port(own: str, renamed: str) -> None:
    text = f"BehaviorTree Main\n    ->\n        A (picture = {own})\n        B (x = {{pictuer}})\n"
    assert ("Replace `picture` with `pictuer`", False, text.replace(own, renamed)) in fixes(text, RULE)


@pytest.mark.parametrize(
    "lines",
    [
        "Take (image = {picture})\nStore (image = {picture})\nStore (image = {pictuer})\nTake (image = {pictuer})",
        "Store (image = {pictuer})\nStore (image = {picture})",  # the robot's program may write both
        # Two entries at one node are both meant.
        "Take (image = {picture})\nStore (image = {picture})\nB (x = {pictuer} y = {picture})",
        "Take (image = {picture})\nStore (image = {picture})\nxml '<A x=\"{pictuer}\"/>'",
    ],
)
def test_what_is_used_is_right(lines: str) -> None:
    assert told(lines) == []


def test_a_tree_below_writes_what_is_read_here() -> None:
    below = "BehaviorTree Below\n    Take (image = {picture})\n"
    here = "Take (image = {picture})\nStore (image = {picture})\nStore (image = {pictuer})"
    assert told(f"SubTree Below (picture = {{pictuer}})\n{here}", below) == []
    lines = "Store (image = {picture})\nStore (image = {pictuer})"
    assert told(f"SubTree Below (_autoremap = true)\n{lines}", below) == [
        "«pictuer» nothing writes `pictuer`, which is read here; did you mean `picture`?"
    ]
    assert told(f"SubTree Below\n{lines}", below) == []


def test_the_root_blackboard_is_one_for_all_trees() -> None:
    below = 'BehaviorTree Below\n    ScriptCondition (code = "@cuont > 1")\n'
    text = f'{MODELS}BehaviorTree Main\n    ->\n        Script (code = "@count := 1")\n        SubTree Below\n{below}'
    assert findings(text, RULE) == [
        "12 warning «@cuont» nothing writes `@cuont`, which is read here; did you mean `@count`?"
    ]
    written = text.replace("@count := 1", "@count := 1; @cuont := 2")
    assert findings(written, RULE) == []
    by_the_root = text.replace("@count := 1", "@count := 1; cuont := 2")
    assert findings(by_the_root, RULE) == []


def test_an_entry_of_a_signal_comes_from_outside() -> None:
    signal = "signal battery : % from {battery_leve}\n"
    assert told("Store (image = {battery_leve})\nTake (image = {battery_level})", signal) == []


def test_an_include_that_is_missing_may_hold_anything() -> None:
    lines = "Take (image = {picture})\nStore (image = {pictuer})"
    assert told(lines, 'include "gone.btq"\n') == []
    assert len(told(lines)) == 1


def test_the_words_for_yes_and_no() -> None:
    assert told('Script (code = "a := True; b := FALSE; c := true")') == [
        "«True» a script reads `True` as the name of an entry; did you mean `true`?",
        "«FALSE» a script reads `FALSE` as the name of an entry; did you mean `false`?",
    ]
    assert told('Script (code = "True := 1; a := True")') == []


def test_many_names_are_no_trouble() -> None:
    lines = "\n".join(f"Take (image = {{place_{number:05d}}})" for number in range(3000))
    assert told(lines) == []


@pytest.mark.parametrize(
    ("head", "writes", "note"),
    [
        ("output", "gial", "did you mean `gial`, which a node writes?"),
        ("output", "gol", "did you mean `gol`, which a node writes?"),
        ("input", "goal", "if `Find` writes `goal`, its model declares `place` as an output"),
    ],
)
def test_a_writer_that_is_not_one(head: str, writes: str, note: str) -> None:
    models = f"Action Find\n    {head} place\nAction Lead\n    input place\n"
    nodes = f"        Find (place = {{{writes}}})\n        Lead (place = {{goal}})\n"
    (found,) = problems(f"{models}BehaviorTree Main\n    ->\n{nodes}", "unset-entry")
    assert found.notes == ("ignore this where the robot's program sets the entry", note)


@pytest.mark.parametrize(("entry", "is_told"), [("sign.id", True), ("a.b.c", True), ("a}_{b", False), ("a-b", False)])
def test_only_names_of_other_languages_hide_what_is_unset_and_unread(entry: str, is_told: bool) -> None:
    text = (
        "Action Go\n    input place\n    input id\n"
        "BehaviorTree Main\n    SubTree Stop (speed = 3)\n"
        f"BehaviorTree Stop\n    Go (place = {{spot}} id = {{{entry}}})\n"
    )
    unset = "nothing in `Stop` writes `spot`, which is read here, and no SubTree passes it"
    told = [
        "5:19 warning unread-argument «speed» nothing in `Stop` reads `speed`",
        f"7:18 warning unset-entry «spot» {unset}",
    ]
    found = [*problems(text, "unread-argument"), *problems(text, "unset-entry")]
    assert show(text, found) == told * is_told


def test_the_subtree_to_which_an_entry_is_to_be_added() -> None:
    text = (
        "Action Go\n    input place\nBehaviorTree Main\n    ->\n        SubTree Stop (speed = 3)\n"
        "BehaviorTree Stop\n    Go (place = {spot})\n"
    )
    (found,) = problems(text, "unset-entry")
    (related,) = found.related
    assert (found.span.start, related.message) == (text.index("spot"), "write `spot = {…}` at this SubTree")
    assert text[related.place.span.start : related.place.span.end] == "Stop"


def test_the_subtree_of_xml_to_which_an_entry_is_to_be_added(tmp_path: Path) -> None:
    (tmp_path / "t.xml").write_text(
        '<root BTCPP_format="4" main_tree_to_execute="Main">\n  <BehaviorTree ID="Main">\n'
        '    <SubTree ID="Stop" speed="3"/>\n  </BehaviorTree>\n  <BehaviorTree ID="Stop">\n'
        '    <Go place="{spot}" speed="{speed}"/>\n  </BehaviorTree>\n  <TreeNodesModel>\n    <Action ID="Go">\n'
        '      <input_port name="place"/>\n      <input_port name="speed"/>\n    </Action>\n'
        "  </TreeNodesModel>\n</root>\n"
    )
    _, out, _ = run_btq("check", "t.xml", cwd=tmp_path)
    assert out.splitlines()[0].endswith("nothing in `Stop` writes `spot`, which is read here, and no SubTree passes it")
    at = out.splitlines().index('note: write `spot="{…}"` at this SubTree')
    assert out.splitlines()[at + 1] == " --> t.xml:3:18"


@pytest.mark.parametrize(
    ("first", "second", "rest", "is_told"),
    [
        ("SubTree Stop (spot = {a})", "SubTree Stop", "Go (place = {spot})", True),
        (
            "SubTree Stop (spot = 3 other = 1)",
            "SubTree Stop (other = {spot})",
            "Go (place = {spot} id = {other})",
            True,
        ),
        ("SubTree Stop (spot = {a})", "SubTree Stop", "Below", False),
        ("SubTree Stop (spot = {a})", "SubTree Stop", "SubTree Below (spot = {spot})", True),
        ("SubTree Stop (spot = {a})", "SubTree Stop (_autoremap = true)", "Go (place = {spot})", False),
        ("SubTree Stop (spot = {a})", "SubTree Stop (spots = {a})", "Go (place = {spot})", False),
        ("SubTree Stop (spot = {a})", "SubTree Stop", "Go (place = there id = {spot})", True),
        ("SubTree Stop (spot = {a})", "SubTree Stop", "Find (place = {spot})", False),
        ("SubTree Stop (spot = {a})", "SubTree Stop", "Go (place = {@spot})", False),
        ("SubTree Stop (spot = {a})", "SubTree Stop", "Stranger (place = {spot})", False),
    ],
)
def test_an_entry_that_one_of_several_subtrees_does_not_pass(first: str, second: str, rest: str, is_told: bool) -> None:
    models = "Action Go\n    input place\n    input id = 1\nAction Find\n    output place\n"
    text = (
        f"{models}BehaviorTree Main\n    ->\n        Find (place = {{a}})\n        {first}\n        {second}\n"
        f"BehaviorTree Stop\n    {rest}\nBehaviorTree Below\n    Go (place = {{spot}})\n"
    )
    message = "`Stop` reads `spot`, which this SubTree does not pass to it, and another one does"
    found = [each for each in problems(text, "unset-entry") if "another one" in each.message]
    assert show(text, found) == [f"10:17 warning unset-entry «Stop» {message}"] * is_told
    related = [f"{each.message}" for problem in found for each in problem.related]
    assert related == ["passes `spot` to `Stop`"] * is_told


@pytest.mark.parametrize(
    ("before", "is_told"),
    [("Find (place = {spot})", True), ("Find (place = {other})", False), ("Go (place = {spot})", False)],
)
def test_an_entry_that_one_of_several_subtrees_passes_with_all_others(before: str, is_told: bool) -> None:
    text = (
        "Action Go\n    input place\nAction Find\n    output place\n"
        f"BehaviorTree Main\n    ->\n        {before}\n        SubTree Stop (_autoremap = true)\n        SubTree Stop\n"
        "BehaviorTree Stop\n    Go (place = {spot})\n"
    )
    message = "`Stop` reads `spot`, which this SubTree does not pass to it, and another one does"
    diagnostics = [each for each in problems(text, "unset-entry") if "another one" in each.message]
    assert show(text, diagnostics) == [f"9:17 warning unset-entry «Stop» {message}"] * is_told
