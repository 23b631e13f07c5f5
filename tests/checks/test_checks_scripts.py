"""Scripts in a file: which values are scripts, the rules for each, and where in the source a problem is."""

from __future__ import annotations

import pytest
from check_asserts import after, findings, fixes, problems

from btq_lang.workspace.config import Project

RULES = ("script-error", "empty-script", "script-version")


def tree(node: str) -> str:
    return f"BehaviorTree Main\n    {node}\n"


@pytest.mark.parametrize(
    "node",
    [
        'AlwaysSuccess (_skipIf = "battery < 20.0" _onSuccess = "tubes += 1; done := true")',
        "AlwaysSuccess (_skipIf = flag)",
        "ScriptCondition (code = {script})",
        'Script (code = "{script}")',
        'ScriptAction (name = "MoveBase")',
        'Action MoveBase (code = "not ours", if = "1 +")',
        'AlwaysSuccess (_description = "and so on")',
        "SubTree Main (_autoremap = true)",
        'SetBlackboard (value = "a and b" output_key = "k")',
        "AlwaysSuccess (_skipIf = )",
        "xml \"<Script code='1 +'/>\"",
    ],
)
def test_nothing_to_complain_of(node: str) -> None:
    assert findings(tree(node), *RULES) == []


def test_every_place_of_a_script_is_looked_at() -> None:
    attributes = ("_failureIf", "_successIf", "_skipIf", "_while", "_onHalted", "_onSuccess", "_onFailure", "_post")
    pairs = (f'{name} = "1 +"' for name in attributes)
    text = tree(f"SubTree X ({', '.join(pairs)})")
    assert len(findings(text, "script-error")) == len(attributes)
    for node in ('Script (code = "1 +")', 'ScriptCondition (code = "1 +")', 'Precondition (if = "1 +")'):
        assert findings(tree(node), "script-error") == ["2 error «+» missing operand after `+`"]


def test_a_condition_has_to_give_a_value_and_other_scripts_have_not() -> None:
    message = "this condition ends in an assignment: `=` changes the entry; to compare, write `==`"
    assert findings(tree('AlwaysSuccess (_skipIf = "x = 1")'), "script-error") == [f"2 warning «=» {message}"]
    assert findings(tree('ScriptCondition (code = "x = 1")'), "script-error") == [f"2 warning «=» {message}"]
    assert findings(tree('AlwaysSuccess (_post = "x = 1")'), "script-error") == []
    assert findings(tree('Script (code = "x = 1")'), "script-error") == []


@pytest.mark.parametrize(
    ("value", "place", "mended"),
    [
        ('"a and b"', "and", '"a && b"'),
        ("'a and b'", "and", "'a && b'"),
        ('"\\"a\\" == k"', '\\"a\\"', "\"'a' == k\""),
        ("'\"a\" == k'", '"a"', "'\\'a\\' == k'"),
        ("\"k == '\\t\\n' and b\"", "and", "\"k == '\\t\\n' && b\""),
        ('"a\n        and b"', "and", '"a\n        && b"'),
        ('"a\r\n\r\n        and b"', "and", '"a\r\n\r\n        && b"'),
        ('"a\r\rand b"', "and", '"a\r\r&& b"'),
        ("{flag}", "{flag}", '"flag"'),
        ('"{flag} == 1"', "{flag}", '"flag == 1"'),
    ],
)
def test_a_place_in_a_script_is_a_place_in_the_source(value: str, place: str, mended: str) -> None:
    text = tree(f"AlwaysSuccess (_skipIf = {value})")
    (found,) = problems(text, "script-error")
    assert text[found.span.start : found.span.end] == place
    assert [(safe, after) for _, safe, after in fixes(text, "script-error")] == [(True, text.replace(value, mended))]


def test_places_count_from_the_file_and_not_from_the_tree() -> None:
    text = 'BehaviorTree Other\n    Pick\n\nBehaviorTree Main\n    Script (code = "x := a and b")\n'
    assert findings(text, "script-error") == ["5 error «and» `and` is written `&&` in a script"]


@pytest.mark.parametrize(
    ("node", "expected"),
    [
        ('Script (code = "")', 'warning «""» empty script'),
        ('Script (code = "  ")', 'error «"  "»'),
        ('ScriptCondition (code = "")', 'error «""»'),
        ('AlwaysSuccess (_skipIf = "")', 'error «""»'),
        ('Script (code = "x := 1" _onSuccess = "")', 'error «""»'),
    ],
)
def test_the_engine_runs_no_empty_script_but_that_of_a_script(node: str, expected: str) -> None:
    (found,) = findings(tree(node), "empty-script")
    assert found.startswith(f"2 {expected}")


def test_only_the_versions_of_the_project_count() -> None:
    text = tree('AlwaysSuccess (_skipIf = "a + b == c")')
    message = "2 warning «a + b == c» 4.6 refuses `+` beside `==` without brackets"
    assert findings(text, "script-version") == [message]
    assert findings(text, "script-version", project=Project(engines=("4.6", "4.10"))) == [message]
    assert findings(text, "script-version", project=Project(engines=("4.10",))) == []


def test_a_project_that_names_no_version_is_told_how() -> None:
    text = tree('AlwaysSuccess (_skipIf = "a + b == c")')
    pin = 'if you run 4.10, set `engine = "4.10"` in btq.toml'
    (found,) = problems(text, "script-version")
    assert pin in found.notes
    (found,) = problems(text, "script-version", project=Project(engines=("4.6", "4.8")))
    assert pin not in found.notes


@pytest.mark.parametrize(("script", "created"), [("tries = 0", "tries := 0"), ("a := 1; b = a + 1", "b := a + 1")])
def test_an_assignment_that_creates(script: str, created: str) -> None:
    text = f'BehaviorTree Main\n    Script (code = "{script}")\n'
    (found,) = problems(text, "uncreated-entry")
    assert found.notes == (f"the engine throws when it runs the script; write `{created}`",)
    assert after(text, found.fixes[0]) == text.replace(created.replace(":", ""), created)


@pytest.mark.parametrize(
    ("script", "names"),
    [
        ("msg := hello", ["hello"]),
        ("a := 1; a == idle", ["idle"]),
        ("a := 1; a != (idle)", ["idle"]),
        ("msg := HELLO", []),  # a name of an enumeration
        ("msg := @hello", []),
        ("msg := hello; b := hello", []),
        ("hello := 1; msg := hello", []),
        ("msg := hello + 1", []),
        ("a := 1; a < limit", []),
    ],
)
def test_texts_without_quotes(script: str, names: list[str]) -> None:
    text = f'BehaviorTree Main\n    Script (code = "{script}")\n'
    found = problems(text, "misspelt-entry")
    assert [each.message for each in found] == [
        f"a script reads `{name}` as an entry, which nothing here sets" for name in names
    ]
    assert [after(text, each.fixes[0]) for each in found] == [text.replace(name, f"'{name}'") for name in names]
