"""What neither the engine nor a parser reports: counts of nothing, values for outputs, clauses about nothing."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from check_asserts import findings, fixes
from in_process import run_btq

from btq_lang.catalog.versions import VERSIONS
from btq_lang.workspace.config import Project

MODELS = """Action Plan
    output path : Path
    output cost : double
Action Follow
    input path : Path
"""


def tree(*lines: str) -> str:
    return "BehaviorTree Main\n    ->\n" + "".join(f"        {line}\n" for line in lines)


# ---- count-of-nothing ----

COUNT = "count-of-nothing"


@pytest.mark.parametrize(
    ("node", "problem"),
    [
        ("Repeat (num_cycles = 0)", "«0» `Repeat` never runs its child with `0`"),
        ("Repeat (num_cycles = -2)", "«-2» `Repeat` never runs its child with `-2`"),
        ('Retry (num_attempts = "0")', '«"0"» `Retry` never runs its child with `"0"`'),
        ("RetryUntilSuccessful (num_attempts = -5)", "«-5» `RetryUntilSuccessful` never runs its child with `-5`"),
        ("Timeout (msec = 0)", "«0» a Timeout of `0` is disabled: it never halts its child"),
        ("Timeout (msec = 0 s)", "«0 s» a Timeout of `0 s` is disabled: it never halts its child"),
        ("Repeat (num_cycles = -1)", None),
        ("Repeat (num_cycles = 1)", None),
        ("Repeat (num_cycles = {n})", None),
        ("Timeout (msec = 1)", None),
        ("Timeout", None),
        ("Delay (delay_msec = 0)", None),
        ("Decorator Mine (num_cycles = 0)", None),
    ],
)
def test_counts(node: str, problem: str | None) -> None:
    text = tree(node, "    Action Work")
    assert findings(text, COUNT) == ([f"3 warning {problem}"] if problem else [])


def test_a_negative_count_is_probably_meant_for_no_end() -> None:
    text = tree("Repeat (num_cycles = -2)", "    Action Work")
    assert fixes(text, COUNT) == [("Write `-1` for endless", False, text.replace("-2", "-1"))]
    assert fixes(text.replace("-2", "0"), COUNT) == []


@pytest.mark.parametrize(
    ("engines", "is_found"),
    [(("4.8",), True), (("4.6", "4.8"), True), (("4.7",), False), (("4.9", "4.10"), False), (VERSIONS, False)],
)
def test_a_delay_in_the_releases_that_do_not_wait(engines: tuple[str, ...], is_found: bool) -> None:
    found = findings(tree("Delay (delay_msec = 5 s)", "    Action Work"), COUNT, project=Project(engines=engines))
    what = "3 warning «Delay» `Delay` does not wait: 4.8.3 and 4.8.4 do not read `delay_msec`"
    assert found == ([what] if is_found else [])


@pytest.mark.parametrize("engines", ['["4.6", "4.8", "4.10"]', '"4.10"', ""])
def test_a_delay_of_a_project_that_names_all_versions(tmp_path: Path, engines: str) -> None:
    """As `btq init` does; without a project file nobody says that 4.8 must load it."""
    (tmp_path / "m.btq").write_text(tree("Delay (delay_msec = 5 s)", "    Action Work"))
    (tmp_path / "btq.toml").write_text(f"engine = {engines}\n" if engines else "")
    code, out, _ = run_btq("check", "--output-format", "json", cwd=tmp_path)
    problems = json.loads(out)["diagnostics"]
    if engines.count("4") < 2:
        assert (code, problems) == (0, [])
        return
    assert [(problem["rule"], problem["message"], problem["notes"]) for problem in problems] == [
        (
            "count-of-nothing",
            "`Delay` does not wait: 4.8.3 and 4.8.4 do not read `delay_msec`",
            ["put a Sleep before the child", 'if you run 4.10, set `engine = "4.10"` in btq.toml'],
        )
    ]


# ---- literal-for-output ----

OUTPUT = "literal-for-output"


def test_a_value_for_an_output() -> None:
    text = MODELS + tree("Plan (path = path cost = 3)")
    assert findings(text, OUTPUT) == [
        "8 warning «path» expected a blackboard entry for the output `path` of `Plan`, found `path`",
        "8 warning «3» expected a blackboard entry for the output `cost` of `Plan`, found `3`",
    ]
    assert fixes(text, OUTPUT) == [
        ("Write the entry `{path}`", False, text.replace("= path", "= {path}")),
        ("Write the entry `{cost}`", False, text.replace("= 3", "= {cost}")),
    ]


@pytest.mark.parametrize(
    "lines",
    [
        ("Plan (path = {path})", "Plan (path = {=})", 'Plan (path = "=")', 'Plan (path = "")'),
        ("Follow (path = home)", "SetBlackboard (value = 3 output_key = place)", "Unknown (path = home)"),
    ],
)
def test_no_value_for_an_output(lines: tuple[str, ...]) -> None:
    assert findings(MODELS + tree(*lines), OUTPUT) == []


def test_the_outputs_of_trees_and_of_built_ins() -> None:
    text = tree("SubTree Find (pose = here)", 'LoopInt (queue = "1;2" value = 3)', "    Action Work")
    text += "BehaviorTree Find\n    output pose : Pose\n    Action Look\n"
    assert [found.split(" ", 1)[0] for found in findings(text, OUTPUT)] == ["3", "4"]


def test_a_value_that_is_none_of_the_type_is_refused() -> None:
    text = MODELS + tree("Plan (cost = low)")
    assert [found.split(" ", 3)[:3] for found in findings(text, OUTPUT, "invalid-literal")] == [["8", "error", "«low»"]]


def test_a_file_that_does_so_as_a_rule_is_told_once() -> None:
    text = MODELS + tree('Plan (path = "a" cost = "3")', 'Plan (path = "c")', "Plan (path = {d})")
    assert [found.split(" ", 3)[:3] for found in findings(text, OUTPUT)] == [["8", "hint", '«"a"»']]
    assert fixes(text, OUTPUT) == []


# ---- clause-without-odds, goal-beyond-bound ----


def requirement(*clauses: str) -> str:
    lines = "".join(f"    {clause}\n" for clause in clauses)
    return f'QualityReq q : safety "Q"\n{lines}BehaviorTree Main\n    Action Work satisfies q\n'


@pytest.mark.parametrize(
    ("clauses", "told"),
    [
        (("takes at most 3 s", "confidence 95 %"), ["«confidence 95 %»"]),
        (("takes at most 3 s", "over last 20 runs"), ["«over last 20 runs»"]),
        (("takes at most 3 s", "over last 7 d"), []),
        (("takes at most 3 s", "in at least 9 % of runs", "confidence 95 %", "over last 20 runs"), []),
        (("takes at most 3 s", "in at least of runs", "confidence 95 %"), []),
    ],
)
def test_clauses_that_need_odds(clauses: tuple[str, ...], told: list[str]) -> None:
    found = findings(requirement(*clauses), "clause-without-odds")
    assert ["«" + each.split("«")[1].split("»")[0] + "»" for each in found] == told


def test_a_window_without_a_probability_has_no_effect() -> None:
    assert findings(requirement("takes at most 3 s", "over last 20 runs"), "clause-without-odds") == [
        "3 warning «over last 20 runs» the window has no effect here: "
        "without a required probability a single violation counts"
    ]


@pytest.mark.parametrize(
    ("clauses", "told"),
    [
        (("takes at most 60 s", "goal 90 s"), "`90 s` is worse than the bound, which is at most `60 s`"),
        (("takes at most 1 min", "goal 90 s"), "`90 s` is worse than the bound, which is at most `1 min`"),
        (("takes at least 60 s", "goal 50 s"), "`50 s` is worse than the bound, which is at least `60 s`"),
        (("takes between 10 s and 20 s", "goal 30 s"), "`30 s` is worse than the bound, which is at most `20 s`"),
        (("takes between 10 s and 20 s", "goal 5 s"), None),
        (("takes at most 60 s", "goal 60 s"), None),
        (("takes at most 60 s", "goal 30 s"), None),
        (("takes at most 60 s", "in at least 90 % of runs", "goal 95 %"), None),
    ],
)
def test_goals(clauses: tuple[str, ...], told: str | None) -> None:
    found = findings(requirement(*clauses), "goal-beyond-bound")
    assert [each.split("the goal ", 1)[1] for each in found] == ([told] if told else [])


# ---- unused-parameter ----


@pytest.mark.parametrize(
    ("clause", "unused"),
    [
        ("keeps speed <= limit", ["top"]),
        ("keeps speed <= limit * top", []),
        ("keeps speed <= 0.5 m/s if speed > top else limit", []),
        ("keeps speed <=", []),  # what it is for may be what could not be read
    ],
)
def test_parameters(clause: str, unused: list[str]) -> None:
    text = f"signal speed : m/s\nQualityReq slow(limit : m/s, top : m/s) : safety\n    {clause}\n"
    told = [found.split("«")[1].split("»")[0] for found in findings(text, "unused-parameter")]
    assert told == unused


# ---- ports ----


def test_two_ports_of_one_name() -> None:
    model = "Action A\n    input a : int\n    output a : double\n    input b\n"
    text = f"{model}BehaviorTree Main\n    input c\n    input c\n    A\n"
    assert findings(text, "duplicate-definition") == [
        "3 warning «a» duplicate port `a`",
        "7 warning «c» duplicate port `c`",
    ]


@pytest.mark.parametrize(
    ("type_", "meant"),
    [("strng", "string"), ("dooble", "double"), ("boool", "bool"), ("uint32_r", "uint32_t"), ("flaot", "float")],
)
def test_misspelt_types(type_: str, meant: str) -> None:
    text = f"Action A\n    input a : {type_}\nBehaviorTree Main\n    A (a = {{x}})\n"
    assert fixes(text, "misspelt-type") == [(f"Replace `{type_}` with `{meant}`", False, text.replace(type_, meant))]


@pytest.mark.parametrize(
    "type_", ["string", "std::string", "int", "uint8_t", "Strings", "String", "int8", "pose", "uint16"]
)
def test_types_that_may_be_ones_own(type_: str) -> None:
    assert findings(f"Action A\n    input a : {type_}\n", "misspelt-type") == []


@pytest.mark.parametrize(
    ("unit", "type_", "told"),
    [("%", "string", True), ("%", "double", False), ("text", "string", False), ("%", "", False)],
)
def test_a_signal_that_is_a_number_and_an_entry_that_is_a_text(unit: str, type_: str, told: bool) -> None:
    value = '"ok"' if unit == "text" else "3 %"
    text = (
        f"signal battery : {unit} from {{battery}}\n"
        f"Action Read\n    output battery{' : ' if type_ else ''}{type_}\n"
        f'QualityReq q : safety "Q"\n    leaves battery == {value}\n'
        "BehaviorTree Main\n    Read (battery = {=}) satisfies q\n"
    )
    message = "«battery» the signal `battery` is a number, but the port `battery` of `Read` writes a string"
    assert findings(text, "unit-mismatch") == ([f"1 warning {message}"] if told else [])


@pytest.mark.parametrize(("entry", "told"), [("@battery", True), ("battery", False)])
def test_a_text_that_a_subtree_writes_into_the_root_is_the_main_trees(entry: str, told: bool) -> None:
    text = (
        "signal battery : % from {battery}\n"
        "Action Read\n    output level : string\n"
        'QualityReq q : safety "Q"\n    leaves battery == 3 %\n'
        f"BehaviorTree Main\n    SubTree Part satisfies q\nBehaviorTree Part\n    Read (level = {{{entry}}})\n"
    )
    message = "«battery» the signal `battery` is a number, but the port `level` of `Read` writes a string"
    assert findings(text, "unit-mismatch") == ([f"1 warning {message}"] if told else [])
