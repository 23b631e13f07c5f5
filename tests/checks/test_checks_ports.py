"""unknown-port, missing-port, unknown-attribute, duplicate-attribute: what their pages do not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems, fixes, problems, workspace_of

from btq_lang.checks import check
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

PICK = """\
BehaviorTree Pick
    input object : string
    input speed : double = 0.5
    output grip : double
    X
"""


def tree(node: str) -> str:
    return f"BehaviorTree Main\n    ->\n        {node}\n"


# ---- unknown-port and missing-port -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("Retry (num_attmpts = 3)", "Retry (num_attempts = 3)"),
        ("Timeout (timeout_ms = 3)", "Timeout (msec = 3)"),  # not near, but the only one it can be
        ("|| (success_threshold = 1)", "|| (success_count = 1)"),  # version 3's name
    ],
)
def test_a_port_of_another_name_is_one_mistake(wrong: str, right: str) -> None:
    key, meant = (text[text.index("(") + 1 :].partition(" ")[0] for text in (wrong, right))
    kind = wrong.partition(" ")[0]
    text = tree(f"{wrong}\n            X")
    column = 9 + wrong.index(key)
    assert_problems(
        text, f"3:{column} error unknown-port «{key}» `{kind}` has no port `{key}`; did you mean `{meant}`?"
    )
    assert_fix(text, f"Replace `{key}` with `{meant}`", tree(f"{right}\n            X"))


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("Timeout (seconds = 30)", "Timeout (msec = 30 s)"),
        ("Timeout (timeout_s = 0.5)", "Timeout (msec = 0.5 s)"),
        ("Timeout (limitMinutes = 2)", "Timeout (msec = 2 min)"),
        ("Timeout (hours = 1)", "Timeout (msec = 1 h)"),
        ("Timeout (timeout_sec = 2 s)", "Timeout (msec = 2 s)"),
        ("Delay (seconds = 30)", "Delay (delay_msec = 30 s)"),
    ],
)
def test_a_key_with_a_unit_is_replaced_with_its_unit(wrong: str, right: str) -> None:
    text, after = (tree(f"{node}\n            X") for node in (wrong, right))
    (found,) = problems(text, "unknown-port")
    assert [(fix.title.startswith(("Write", "Replace")), fix.safe) for fix in found.fixes] == [(True, False)]
    assert_fix(text, found.fixes[0].title, after)


def test_a_key_with_a_unit_and_an_entry_is_not_replaced() -> None:
    assert fixes(tree("Timeout (seconds = {s})\n            X"), "unknown-port") == []


def test_a_port_of_another_node() -> None:
    text = tree("Loop (num_cycles = 3)\n            X")
    assert_problems(
        text, "3:15 error unknown-port «num_cycles» `Loop` has no port `num_cycles`; did you mean `Repeat`?"
    )
    assert_fix(text, "Replace `Loop` with `Repeat`", tree("Repeat (num_cycles = 3)\n            X"))
    renamed = fixes(tree("Retry (num_cycles = 3)\n            X"), "unknown-port")
    assert [title for title, _, _ in renamed] == ["Replace `num_cycles` with `num_attempts`"]


@pytest.mark.parametrize(
    ("key", "meant"),
    [
        ("skipIf", "_skipIf"),
        ("skip_if", "_skipIf"),
        ("successIf", "_successIf"),
        ("failure_if", "_failureIf"),
        ("onSuccess", "_onSuccess"),
        ("on_halted", "_onHalted"),
    ],
)
def test_an_attribute_without_its_underscore(key: str, meant: str) -> None:
    text = tree(f'Action Dock ({key} = "a == 1")')
    warning = f"the engine takes `{key}` for a port; did you mean `{meant}`?"
    assert_problems(text, f"3:22 warning unknown-attribute «{key}» {warning}")
    assert_fix(text, f"Replace `{key}` with `{meant}`", text.replace(key, meant))
    refused = f"`->` has no port `{key}`; did you mean `{meant}`?"
    assert_problems(
        f'BehaviorTree Main\n    -> ({key} = "a == 1")\n        X\n', f"2:9 error unknown-port «{key}» {refused}"
    )
    xml = f'<root BTCPP_format="4"><BehaviorTree ID="Main"><Dock {key}="a == 1"/></BehaviorTree></root>'
    assert [each.message for each in check(workspace_of({"main.xml": xml}), "main.xml")] == [warning]
    assert_clean(f"Action Dock\n    input {key}\n{text}")


def test_an_attribute_of_a_subtree_without_its_underscore() -> None:
    text = tree("SubTree Pick (autoremap = true)") + "BehaviorTree Pick\n    X\n"
    warning = "the engine takes `autoremap` for a port; did you mean `_autoremap`?"
    assert_problems(text, f"3:23 warning unknown-attribute «autoremap» {warning}")


@pytest.mark.parametrize("key", ["while", "post", "description"])
def test_a_port_named_like_an_attribute(key: str) -> None:
    assert_clean(tree(f'Dock ({key} = "x")'))


def test_a_port_that_has_a_value_is_not_meant() -> None:
    text = "Action Move\n    input place\n" + tree("Move (place = a plase = b)")
    assert_problems(text, "5:25 error unknown-port «plase» `Move` has no port `plase`")
    assert_clean("Action Move\n    input place\n" + tree("Move (place = a)"))


def test_ports_of_a_model() -> None:
    model = "Action Move\n    input place\n    input speed = 1\n    output error\n    inout trace\n"
    assert_problems(
        model + tree("Move"), "8:9 warning missing-port «Move» `Move` requires a value for its port `place`"
    )
    assert_clean(model + tree("Move (place = p)"))
    assert_clean(model + tree('Move (place = "" name = "m" _skipIf = "true")'))


def test_all_that_is_missing_is_told_at_once() -> None:
    text = "Action Move\n    input x\n    input y\n    input z\n" + tree("Move Home (y = 1)")
    assert_problems(text, "7:9 warning missing-port «Move» `Move` requires values for its ports `x` and `z`")
    assert_fix(
        text, "Pass on the entries of the same name: `x = {=} z = {=}`", text.replace("y = 1", "y = 1 x = {=} z = {=}")
    )
    bare = "Action Move\n    input x\n" + tree("Move Home")
    assert_fix(bare, "Pass on the entry of the same name: `x = {=}`", bare.replace("Home", "Home (x = {=})"))


def test_a_port_is_not_missed_where_a_declaration_cannot_be_read() -> None:
    model = "Action Move\n    inptu place : string\n    input speed\n"
    damaged = "2:5 error syntax-error «inptu» expected a port (input, output or inout), metadata or xml, found `inptu`"
    use = tree("Move (place = a speed = b)")
    assert_problems(model + use, damaged)
    assert_clean(model.replace("inptu", "input") + use)
    subtree = PICK.replace("= 0.5", "= = 0.5") + tree("SubTree Pick (object = a sped = 2)")
    assert [each.rule for each in check(Workspace.of({"a.btq": subtree}), "a.btq")] == ["syntax-error"]
    models = "TreeNodesModel\n    Action Stop\n        inptu place\n    Action Move\n        input speed\n"
    found = check(Workspace.of({"a.btq": models + use}), "a.btq")
    assert [each.rule for each in found] == ["syntax-error", "unknown-port"]  # the other node's can be read


def test_a_model_without_ports_is_one_mistake_at_a_node() -> None:
    """Public palettes are full of them: somebody wrote `<Action ID="Move"/>` and nothing more."""
    assert_problems(
        "Action Move\n" + tree("Move (x = 1 y = 2)"),
        "4:15 warning unknown-port «x» `Move` has no port `x`",
    )


def test_ports_of_a_tree() -> None:
    assert_problems(
        tree("SubTree Pick") + PICK,
        "3:17 error missing-port «Pick» `Pick` requires values for its ports `object` and `grip`",
    )
    assert_problems(
        tree("SubTree Pick (object = a grip = {g} spede = 3)") + PICK,
        "3:45 warning unknown-port «spede» `Pick` has no port `spede`; did you mean `speed`?",
    )
    # The engine says nothing of `objekt`, but misses `object`.
    assert_problems(
        tree("SubTree Pick (objekt = a grip = {g})") + PICK,
        "3:23 error unknown-port «objekt» `Pick` has no port `objekt`; did you mean `object`?",
    )
    assert_clean(tree("SubTree Pick (anything = 1)") + "BehaviorTree Pick\n    X\n")  # a tree that declares none


@pytest.mark.parametrize("attribute", ["_autoremap = true", "_autoremap = 1"])
def test_a_subtree_that_gets_every_entry_misses_none(attribute: str) -> None:
    assert_clean(tree(f"SubTree Pick ({attribute})") + PICK)


def test_autoremap_may_be_off() -> None:
    assert_problems(
        tree("SubTree Pick (object = a _autoremap = false)") + PICK,
        "3:17 error missing-port «Pick» `Pick` requires a value for its port `grip`",
    )


def test_an_empty_default_is_none_to_the_engine() -> None:
    assert_problems(
        tree("SubTree Pick") + 'BehaviorTree Pick\n    input object = ""\n    X\n',
        "3:17 error missing-port «Pick» `Pick` requires a value for its port `object`",
    )


def test_a_port_whose_name_stands_in_brackets() -> None:
    model = "Action Move\n    input (name = place)\n"
    assert_clean(model + tree("Move (place = a)"))
    assert_problems(
        model + tree("Move"), "5:9 warning missing-port «Move» `Move` requires a value for its port `place`"
    )


def test_the_model_of_a_subtree_counts_where_its_tree_declares_nothing() -> None:
    model = "SubTree Pick\n    input object\n"
    assert_problems(
        model + tree("SubTree Pick") + "BehaviorTree Pick\n    X\n",
        "5:17 error missing-port «Pick» `Pick` requires a value for its port `object`",
    )


def test_an_id_where_the_engine_takes_none() -> None:
    assert_problems(
        tree("-> (ID = a)\n            X"), "3:13 error unknown-port «ID» the engine refuses the attribute `ID` on `->`"
    )
    assert_fix(tree("-> (ID = a)\n            X"), "Replace `ID` with `name`", tree("-> (name = a)\n            X"))
    assert_clean(tree("Action (ID = Move)"))


def test_a_script_without_code_is_a_placeholder_unless_code_is_misspelt() -> None:
    assert_problems(
        tree("ScriptAction Move (speed = 1)"),
        "3:9 hint classic-placeholder «ScriptAction» "
        "`ScriptAction` without code is a placeholder for the action `Move`",
    )
    assert_problems(
        tree('Script Reset (cod = "a := 1")'),
        "3:23 error unknown-port «cod» `Script` has no port `cod`; did you mean `code`?",
    )
    assert_problems(tree("Script"), "3:9 error missing-port «Script» `Script` requires a value for its port `code`")


# ---- unknown-attribute -----------------------------------------------------------------------------------------------


def test_attributes_that_mean_something_to_somebody() -> None:
    assert_clean(tree('X (_description = "a" _uid = 3 _onHalted = "a := 1")'))
    assert_clean('BehaviorTree Main (_favorite = true owner = "me")\n    X\n')


def test_a_shared_blackboard_of_version_3() -> None:
    text = tree("SubTree Pick (__shared_blackboard = true)") + PICK
    assert_problems(
        text,
        "3:23 warning unknown-attribute «__shared_blackboard» "
        "the engine silently ignores `__shared_blackboard`; did you mean `_autoremap`?",
    )
    assert_fix(
        text, "Replace `__shared_blackboard` with `_autoremap`", text.replace("__shared_blackboard", "_autoremap")
    )
    off = tree("SubTree Pick (object = a grip = {g} __shared_blackboard = false)") + PICK
    assert_clean(off)  # ignoring it is what was wanted


def test_a_name_that_is_no_port_name() -> None:
    text = tree('X ("a.b" = 1)')
    assert_problems(text, '3:12 hint unknown-attribute «"a.b"» the engine does not read `a.b`')
    told = '3:12 warning unknown-attribute «"a.b"» the engine does not read `a.b`'
    assert_problems(text, told, project=Project(engines=("4.6",)))  # which refuses it


@pytest.mark.parametrize(
    ("key", "engine", "reason"),
    [
        ("wall.id", "4.6", ""),
        ("wall.id", "4.8", "it contains `.`"),
        ("wall.id", "4.10", "it contains `.`"),
        ("wall/id", "4.10", "it contains `/`"),
        ("é", "4.6", "it does not begin with a letter"),
        ("é", "4.10", "it does not begin with a letter"),
    ],
)
@pytest.mark.parametrize("rest", ["", "_autoremap = true"])
def test_an_argument_that_no_tree_gets(key: str, engine: str, reason: str, rest: str) -> None:
    text = f'{tree(f"""SubTree Go ("{key}" = {{wall}} {rest})""")}BehaviorTree Go\n    X\n'
    told = (
        f'3:21 warning unknown-attribute «"{key}"» the engine drops the argument `{key}` because of its name: {reason}'
    )
    assert_problems(text, *[told] * bool(reason), project=Project(engines=(engine,)))
    (found, *_) = check(workspace_of({"main.btq": text}), "main.btq")
    renamed = "rename it here and in its tree"
    assert found.notes == ((renamed, "releases before 4.8.4 pass it on") if key != "é" else (renamed,))


def test_an_argument_that_a_tree_gets_without_it() -> None:
    text = tree('SubTree Go ("wall.id" = {wall.id} _autoremap = true)') + "BehaviorTree Go\n    X\n"
    assert_clean(text)


# ---- duplicate-attribute ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "key"),
    [
        (tree("Action Move (ID = Go)"), "ID"),
        ("BehaviorTree Main (ID = Other)\n    X\n", "ID"),
        ("Root Main (main_tree_to_execute = Main)\nBehaviorTree Main\n    X\n", "main_tree_to_execute"),
        ("Action Move (ID = Go)\n", "ID"),
        ("Action Move\n    input place (name = other)\n", "name"),
        ("Action Move\n    input place : a (type = b)\n", "type"),
        ("Action Move\n    metadata (a = 1 a = 2)\n", "a"),
        ("TreeNodesModel\n    Action Move\n        input place = 1 (default = 2)\n", "default"),
    ],
)
def test_what_stands_before_the_brackets_counts(text: str, key: str) -> None:
    at = text.rindex(f"{key} =")
    line, column = text.count("\n", 0, at) + 1, at - text.rfind("\n", 0, at)
    assert_problems(text, f"{line}:{column} error duplicate-attribute «{key}» duplicate value for `{key}`")


def test_three_values_are_two_too_many() -> None:
    assert_problems(
        tree("X (a = 1 a = 2 a = 3)"),
        "3:18 error duplicate-attribute «a» duplicate value for `a`",
        "3:24 error duplicate-attribute «a» duplicate value for `a`",
    )


@pytest.mark.parametrize("line", ["Retry 3", "Retry (num_attempts 3)", "Retry (num_attempts: 3)", "Retry (3)"])
def test_a_port_whose_value_could_not_be_read_is_not_missing(line: str) -> None:
    found = check(Workspace.of({"main.btq": f"BehaviorTree Main\n    {line}\n        X\n"}), "main.btq")
    assert [problem.rule for problem in found] == ["syntax-error"]


@pytest.mark.parametrize(("entry", "rules"), [("limit", []), ("other", ["unknown-port"])])
def test_a_tree_gets_an_entry_that_its_model_lacks(entry: str, rules: list[str]) -> None:
    text = (
        '<root BTCPP_format="4"><BehaviorTree ID="Main"><SubTree ID="Below" limit="5"/></BehaviorTree>'
        f'<BehaviorTree ID="Below"><Go x="{{{entry}}}"/></BehaviorTree>'
        '<TreeNodesModel><SubTree ID="Below"><input_port name="speed"/></SubTree></TreeNodesModel></root>'
    )
    found = check(workspace_of({"main.xml": text}), "main.xml")
    assert [each.rule for each in found if each.rule == "unknown-port"] == rules


def test_a_script_that_assigns_to_several_entries_as_to_ports() -> None:
    text = tree('Script (tries = 0 place = "shelf" last = {best})')
    (found,) = problems(text, "missing-port", "unknown-port")
    assert found.message == "`Script` requires a value for its port `code`"
    assert found.notes[-1] == "write `code=\"tries := 0; place := 'shelf'; last := best\"`"
