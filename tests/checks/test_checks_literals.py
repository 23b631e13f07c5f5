"""invalid-literal, trailing-text-in-number, quantity-on-unitless-port: what their pages do not show."""

from __future__ import annotations

import pytest
from check_asserts import after, apply, assert_clean, assert_fix, assert_problems, problems, workspace_of

from btq_lang.checks import check
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace


def timeout(value: str) -> str:
    return f"BehaviorTree Main\n    Timeout (msec = {value})\n        X\n"


@pytest.mark.parametrize(
    "value", ["30000", '"30000"', "{limit}", '"{limit}"', "1", "30 s", "30s", "0.5 min", '"5 "', "1e3 ms"]
)
def test_values_that_the_engine_reads(value: str) -> None:
    assert_clean(timeout(value))


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("fast", "expected an integer of 0 or more for `msec`, found `fast`"),
        ('""', "expected an integer of 0 or more for `msec`, found an empty string"),
        ("-1", "expected an integer from 0 to 4294967295 for `msec`, found `-1`"),
        ("4294967296", "expected an integer from 0 to 4294967295 for `msec`, found `4294967296`"),
        ("0.5 ms", "expected a whole number of ms for `msec`, found `0.5 ms`"),
        ("-3 s", "expected an integer from 0 to 4294967295 for `msec`, found `-3 s` (-3000 ms)"),
        ("100 d", "expected an integer from 0 to 4294967295 for `msec`, found `100 d` (8640000000 ms)"),
        ("1e999 s", "`1e999 s` exceeds the range of numbers"),
    ],
)
def test_values_that_the_engine_refuses(value: str, message: str) -> None:
    assert_problems(timeout(value), f"2:21 error invalid-literal «{value}» {message}")


def test_a_number_of_any_length() -> None:
    digits = "9" * 5_000
    message = f"expected an integer from 0 to 4294967295 for `msec`, found `{digits}`"
    assert_problems(timeout(digits), f"2:21 error invalid-literal «{digits}» {message}")
    assert_problems(
        timeout(f"{digits} s"), f"2:21 error invalid-literal «{digits} s» `{digits} s` exceeds the range of numbers"
    )


@pytest.mark.parametrize(("written", "meant"), [('"+5"', "5"), ('" 5"', "5")])
def test_what_the_engine_is_strict_about_is_offered_right(written: str, meant: str) -> None:
    assert_fix(timeout(written), f"Write `{meant}`", timeout(meant))


@pytest.mark.parametrize(
    ("value", "reads", "fixes"),
    [
        ('"30 sec"', "30", {"Write the quantity `30 sec`": "30 sec"}),
        ('"30 apples"', "30", {"Write what the engine reads: `30`": "30"}),
        ("1.5", "1", {"Write the quantity `1.5 s`": "1.5 s", "Write what the engine reads: `1`": "1"}),
        ("0.5", "0", {"Write the quantity `0.5 s`": "0.5 s"}),
        ('"30 kg"', "30", {}),
        ('"1,5"', "1", {}),
    ],
)
def test_what_is_read_of_a_number_with_a_tail(value: str, reads: str, fixes: dict[str, str]) -> None:
    text = value.strip('"')
    message = f"the engine reads `{text}` as {reads} and silently drops the rest"
    assert_problems(timeout(value), f"2:21 warning trailing-text-in-number «{value}» {message}")
    (found,) = check(workspace_of({"main.btq": timeout(value)}), "main.btq")
    assert [fix.title for fix in found.fixes] == list(fixes)
    for title, fixed in fixes.items():
        assert_fix(timeout(value), title, timeout(fixed))  # none is safe: what was meant is not known


@pytest.mark.parametrize(
    ("type_", "value", "meant", "notes"),
    [
        ("double", "0,2", "0.2", ()),
        ("float", "-1,25", "-1.25", ()),
        ("int", "1,000", None, ()),  # 1 or 1000
        ("double", "0,2,3", "0", ()),
        ("double", "90deg", None, ("write the number in the unit that the node expects",)),
        ("double", "90 %", None, ("write the number in the unit that the node expects",)),
        ("double", "500 ms", None, ("write the number in the unit that the node expects",)),
        ("double", "5s", "5", ("write the number in the unit that the node expects",)),
        ("double", "0.30 m", "0.30", ("write the number in the unit that the node expects",)),
    ],
)
def test_what_a_port_without_a_unit_reads_of_a_number(
    type_: str, value: str, meant: str | None, notes: tuple[str, ...]
) -> None:
    model = f'<TreeNodesModel><Action ID="Go"><input_port name="v" type="{type_}"/></Action></TreeNodesModel>'
    text = f'<root BTCPP_format="4"><BehaviorTree ID="T"><Go v="{value}"/></BehaviorTree>{model}</root>'
    (found,) = check(workspace_of({"main.xml": text}), "main.xml")
    fixed = [apply({"main.xml": text}, "main.xml", fix)["main.xml"] for fix in found.fixes]
    assert (found.rule, found.notes) == ("trailing-text-in-number", notes)
    assert fixed == ([text.replace(value, meant)] if meant is not None else [])


@pytest.mark.parametrize(("value", "meant"), [("100%", "-1"), ("100 %", "-1"), ("50%", None)])
@pytest.mark.parametrize("port", ["success_count", "failure_count"])
def test_a_share_of_the_children(port: str, value: str, meant: str | None) -> None:
    parallel = f'<Parallel {port}="{value}"><A/><B/></Parallel>'
    text = f'<root BTCPP_format="4"><BehaviorTree ID="T">{parallel}</BehaviorTree></root>'
    diagnostics = check(workspace_of({"main.xml": text}), "main.xml")
    (problem,) = [each for each in diagnostics if each.rule == "trailing-text-in-number"]
    assert problem.notes == (f"`{port}` is a number of children, of which -1 means all",)
    fixed = [apply({"main.xml": text}, "main.xml", fix)["main.xml"] for fix in problem.fixes]
    assert fixed == ([text.replace(value, meant)] if meant is not None else [])


@pytest.mark.parametrize(("value", "minutes"), [("5 m", "5 min"), ("0.5m", "0.5 min")])
def test_minutes_that_are_written_as_metres(value: str, minutes: str) -> None:
    text = f"BehaviorTree Main\n    Delay (delay_msec = {value})\n        Action A\n"
    message = f"expected a time for `delay_msec`, found `{value}` (a length); did you mean `{minutes}`?"
    assert_problems(text, f"2:25 error quantity-on-unitless-port «{value}» {message}")
    assert_fix(text, f"Replace `{value}` with `{minutes}`", text.replace(value, minutes))


@pytest.mark.parametrize(("tag", "port"), [("Timeout", "msec"), ("Delay", "delay_msec")])
@pytest.mark.parametrize(("seconds", "ms"), [("0.5", "500"), ("1.5", "1500"), ("10.25", "10250"), (".5", "500")])
def test_seconds_where_milliseconds_go(tag: str, port: str, seconds: str, ms: str) -> None:
    text = f'<root BTCPP_format="4"><BehaviorTree ID="T"><{tag} {port}="{seconds}"><X/></{tag}></BehaviorTree></root>'
    (found,) = check(workspace_of({"main.xml": text}), "main.xml")
    fixes = [fix.title for fix in found.fixes]
    assert fixes[0] == f"Write `{ms}`, which is {float(seconds)} s"
    assert "Write what the engine reads: `0`" not in fixes
    assert found.notes[-1] == f"`{port}` is in ms"
    assert apply({"main.xml": text}, "main.xml", found.fixes[0])["main.xml"] == text.replace(f'"{seconds}"', f'"{ms}"')


@pytest.mark.parametrize(
    "word", ["inf", "INF", "infinite", "infinity", "forever", "unlimited", "endless", '"∞"', '"*"']
)
@pytest.mark.parametrize(("node", "port"), [("RetryUntilSuccessful", "num_attempts"), ("Repeat", "num_cycles")])
def test_endless(word: str, node: str, port: str) -> None:
    text = f"BehaviorTree Main\n    {node} ({port} = {word})\n        X\n"
    found = f"expected an integer for `{port}`, found `{word.strip(chr(34))}`; endless is `-1`"
    assert_problems(text, f"2:{len(node) + len(port) + 10} error invalid-literal «{word}» {found}")
    assert_fix(text, "Write `-1` for endless", text.replace(word, "-1"))


@pytest.mark.parametrize(
    ("value", "reads", "severity"),
    [
        ("1.0", "1", "hint"),
        ("-1.", "-1", "hint"),
        ("1.000", "1", "hint"),
        ("1.05", "1", "warning"),
        ("1.0.1", "1", "warning"),
        ("1.0 s", "1", "warning"),
        ("1e3", "1", "warning"),
        ("1,0", "1", "warning"),
    ],
)
def test_an_integer_that_is_written_as_a_real(value: str, reads: str, severity: str) -> None:
    message = f"the engine reads `{value}` as {reads} and silently drops the rest"
    text = f'BehaviorTree Main\n    Repeat (num_cycles = "{value}")\n        X\n'
    assert_problems(text, f'2:26 {severity} trailing-text-in-number «"{value}"» {message}')


@pytest.mark.parametrize(("queue", "severity"), [("1.0;2", "hint"), ("1;2.00;", "hint"), ("1.0;2.5", "warning")])
def test_a_list_of_integers_that_are_written_as_reals(queue: str, severity: str) -> None:
    text = f'BehaviorTree Main\n    LoopInt (queue = "{queue}" value = {{v}})\n        X\n'
    assert [each.effective_severity.value for each in problems(text, "trailing-text-in-number")] == [severity]


def test_a_list_keeps_its_quotes() -> None:
    loop = 'BehaviorTree Main\n    LoopInt (queue = "1;2x;3" value = {v})\n        X\n'
    assert_fix(loop, "Write what the engine reads: `1;2;3`", loop.replace("2x", "2"))


def test_a_dimension_that_does_not_fit() -> None:
    assert_problems(
        timeout("3 kg"), "2:21 error quantity-on-unitless-port «3 kg» expected a time for `msec`, found `3 kg` (a mass)"
    )


def test_a_unit_that_nobody_knows_is_told_as_such_only() -> None:
    assert_problems(timeout("30sek"), "2:23 error unknown-unit «sek» unknown unit `sek`; did you mean `s`?")


def test_the_unit_of_a_node_of_ones_own_is_not_known() -> None:
    for model in ("", "Action Move\n    input limit : double\n"):
        text = f"{model}BehaviorTree Main\n    Move (limit = 25 s)\n"
        line = text.count("\n")
        assert_problems(text, f"{line}:19 error quantity-on-unitless-port «25 s» unknown unit of the port `limit`")


def test_literals_for_a_model() -> None:
    model = "Action Move\n    input n : int\n    input place : geometry_msgs::msg::Pose\n"
    assert_problems(
        f"{model}BehaviorTree Main\n    Move (n = many place = here)\n",
        "5:15 error invalid-literal «many» expected an integer for `n`, found `many`",
    )


def test_a_tree_keeps_what_it_is_given() -> None:
    """The engine does not convert it to the port's type, so nothing is dropped; but what reads the entry may fail."""
    tree = "BehaviorTree Main\n    SubTree Pick (n = 2.5)\nBehaviorTree Pick\n    input n : int\n    X\n"
    assert_problems(tree, "2:23 warning invalid-literal «2.5» expected an integer for `n`, found `2.5`")


def test_defaults_are_values_too() -> None:
    assert_problems(
        'Action Move\n    input n : int = many\n    input m : int = ""\n    input limit : int = 3 s\n',
        "2:21 warning invalid-literal «many» expected an integer for `n`, found `many`",
        "4:25 error quantity-on-unitless-port «3 s» unknown unit of the port `limit`",
    )


def test_autoremap_is_a_bool() -> None:
    assert_problems(
        "BehaviorTree Main\n    SubTree Pick (_autoremap = maybe)\nBehaviorTree Pick\n    X\n",
        "2:32 error invalid-literal «maybe» expected true, false, 1 or 0 for `_autoremap`, found `maybe`",
    )


def test_versions_read_differently() -> None:
    text = 'BehaviorTree Main\n    LoopDouble (queue = "+1.5;2" value = {v})\n        X\n'
    assert_clean(text, Project(engines=("4.6",)))
    assert_problems(
        text,
        '2:25 error invalid-literal «"+1.5;2"» '
        "expected a number without a leading `+` or space as each item for `queue`, found the item `+1.5`",
        project=Project(engines=("4.10",)),
    )


def test_a_unit_is_never_dropped() -> None:
    expected = "write the number in the unit that the node expects, and state that unit in the port's description"
    quoted = 'if the node reads the unit itself, use quotes: `"3 km/h"`'
    model = "Action Go\n    input speed : {}\n"
    for declared, notes in (
        ("", (expected, quoted)),
        (model.replace("{}", "std::string"), (expected, quoted)),
        (model.replace("{}", "double"), (expected,)),
    ):
        workspace = Workspace.of({"main.btq": f"{declared}BehaviorTree Main\n    Go (speed = 3 km/h)\n"})
        (found,) = check(workspace, "main.btq")
        assert (found.fixes, found.notes) == ((), notes)


def test_what_a_node_cannot_return_and_what_autoremap_cannot_read() -> None:
    """As 4.6.2, 4.8.4 and 4.10.0 have it: tests/engine/test_engine_literals.py."""
    files = {
        "a.btq": """BehaviorTree Main
    ->
        Loop (queue = {q} value = {v} if_empty = {given})
            Go (status = {v})
        Precondition (if = "{q}" else = {given})
            Go (status = IDLE)
        SubTree Part (_autoremap = {remap})
BehaviorTree Part
    Go
"""
    }

    def found(given: str, remap: str) -> list[tuple[str, str]]:
        text = files["a.btq"].replace("{given}", given).replace("{remap}", remap)
        workspace = Workspace.of({"a.btq": text})
        return [(each.message, each.notes[0]) for each in check(workspace, "a.btq") if each.rule == "invalid-literal"]

    for status in ("SUCCESS", "FAILURE", "RUNNING", "SKIPPED", "{v}"):
        assert found(status, "true") == []
    refused = "expected SUCCESS, FAILURE, RUNNING or SKIPPED for `{}`, found `IDLE`"
    assert found("IDLE", "false") == [
        (refused.format(port), f"`{port}` is a BT::NodeStatus, and IDLE is not allowed")
        for port in ("if_empty", "else")
    ]
    note = "the engine reads this attribute before any entry exists: write `true`, or remove it"
    for remap in ("{=}", "{v}", '"{v}"'):
        shown = remap.strip('"')
        assert found("SUCCESS", remap) == [(f"expected true or false for `_autoremap`, found `{shown}`", note)]


@pytest.mark.parametrize(
    ("unit", "value", "number"), [("m/s", "1.8 km/h", "0.5"), ("l/min", "2.5 l/min", "2.5"), ("s", "2 min", "120")]
)
def test_a_quantity_where_the_description_of_a_port_is_a_unit(unit: str, value: str, number: str) -> None:
    text = f'Action Go\n    input v : double "{unit}"\nBehaviorTree Main\n    Go (v = {{}})\n'
    (found,) = problems(text.format(value), "quantity-on-unitless-port")
    assert found.message == "unknown unit of the port `v`"
    assert found.notes == (f"its description is `{unit}`: write the number in that unit, `{number}`",)
    assert [after(text.format(value), fix) for fix in found.fixes] == [text.format(number)]
    (other,) = problems(text.format("2 kg"), "quantity-on-unitless-port")
    assert other.fixes == ()
