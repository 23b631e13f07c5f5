"""The engine's scripting language: what each version reads, the diagnostics for the rest, and the properties of the
fixes.  Every row of the tables was run with BehaviorTree.CPP 4.6.2, 4.8.4 and 4.10.0; `4.6` and `4.8` mean them below.
"""

from __future__ import annotations

from collections import Counter
from functools import partial

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from script_text import unparse

from btq_lang.catalog.versions import VERSIONS as ENGINES
from btq_lang.diagnostics.model import Diagnostic, Fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.script.check import check_script
from btq_lang.syntax.script.parser import MAX_DEPTH, parse_script
from btq_lang.syntax.script.tree import (
    Assign,
    Bool,
    Expression,
    Name,
    Number,
    Script,
    ScriptBinary,
    ScriptComparison,
    ScriptGroup,
    ScriptText,
    Ternary,
    Unary,
    Variable,
    children,
    variables,
)
from btq_lang.util.record import replace
from btq_lang.util.text import Edit, Span, apply_edits

# ---- what a script means: the same in every version, and without a problem in any ----

READ_ALIKE = [
    # Values.
    ("x", "x"),
    ("@battery", "@battery"),
    ("_a1", "_a1"),
    ("007", "007"),
    ("0x1F", "0x1F"),
    ("0X1f", "0X1f"),
    ("1.5e-3", "1.5e-3"),
    ("1e5", "1e5"),
    ("9223372036854775807", "9223372036854775807"),
    ("true", "true"),
    ("''", "''"),
    ("'a\nb'", "'a\nb'"),
    ("'say \"hi\"'", "'say \"hi\"'"),
    # Operators and what binds them.
    ("-a", "(-a)"),
    ("--a", "(-(-a))"),
    ("!!a", "(!(!a))"),
    ("a--1", "(a - (-1))"),
    ("-a * b", "((-a) * b)"),
    ("a + b * c", "(a + (b * c))"),
    ("a * b + c", "((a * b) + c)"),
    ("a + b + c", "((a + b) + c)"),
    ("a + b - c", "((a + b) - c)"),
    ("a * b / c", "((a * b) / c)"),
    ("a & b | c", "((a & b) | c)"),
    ("a | b & c", "(a | (b & c))"),
    ("a ^ b | c", "((a ^ b) | c)"),
    ("~a & b", "((~a) & b)"),
    ("a .. b .. c", "((a .. b) .. c)"),
    ("a..1", "(a .. 1)"),
    ("1 ..a", "(1 .. a)"),
    ("a && b || c", "((a && b) || c)"),
    ("a || b || c", "((a || b) || c)"),
    ("a < b && c", "((a < b) && c)"),
    ("!a && b", "((!a) && b)"),
    ("a < b <= c == d", "(a < b <= c == d)"),
    ("a ? b : c", "(a ? b : c)"),
    ("a ? b ? c : d : e", "(a ? (b ? c : d) : e)"),
    ("a ? b : (c ? d : e)", "(a ? b : (c ? d : e))"),
    ("(a || b) && c", "((a || b) && c)"),
    ("((a))", "a"),
    # Statements and assignments.
    ("x := 1", "x := 1"),
    ("x = -1", "x = (-1)"),
    ("x += 1; x -= 1; x *= 2; x /= 2", "x += 1; x -= 1; x *= 2; x /= 2"),
    ("(x) := 1", "x := 1"),
    ("x := a ? b : c", "x := (a ? b : c)"),
    ("a ? x := 1 : 2", "(a ? (x := 1) : 2)"),
    ("(x := 1) + 2", "((x := 1) + 2)"),
    ("x := (y := 3)", "x := (y := 3)"),
    ("x = y == z", "x = (y == z)"),
    ("\n x := 1 ;\n y := 2\t\n", "x := 1; y := 2"),
    # The names of other languages' operators are names where no operator is possible.
    ("and := 1; or := and", "and := 1; or := and"),
    ("not == 3", "(not == 3)"),
]


@pytest.mark.parametrize(("text", "meaning"), READ_ALIKE)
def test_what_every_version_reads_alike(text: str, meaning: str) -> None:
    script = parse_script(text)
    assert check_script(script) == ()
    assert unparse(script) == meaning


def test_the_tree_knows_its_places() -> None:
    script = parse_script("x := (a < 2 <= b) ? -'t' .. true : 0x10")
    assert script.statements == (
        Assign(
            *(0, 39, ":="),
            Name(0, 1, "x"),
            Ternary(
                *(5, 39),
                ScriptGroup(
                    *(5, 17),
                    ScriptComparison(6, 16, ("<", "<="), (Name(6, 7, "a"), Number(10, 11, "2"), Name(15, 16, "b"))),
                ),
                ScriptBinary(20, 32, "..", Unary(20, 24, "-", ScriptText(21, 24, "t")), Bool(28, 32, True)),
                Number(35, 39, "0x10"),
            ),
        ),
    )


def test_the_worth_of_numbers() -> None:
    worths = [Number(0, 0, raw).value for raw in ("007", "0x1F", "2.5", "1e3", "9" * 500)]
    assert worths == [7, 31, 2.5, 1000.0, float("inf")]
    assert [type(worth) for worth in worths] == [int, int, float, float, float]


# ---- what the newest engine refuses, or loads only to fail at ----

# A script, what is marked, what is said (its beginning), and what the safe fix makes of it.
REFUSED: list[tuple[str, str, str, str | None]] = [
    # Slips with one certain meaning.
    ('a == "x"', '"x"', "strings in scripts go in single quotes", "a == 'x'"),
    ("a == “x”", "“x”", "strings in scripts go in single quotes", "a == 'x'"),
    ("a == ‘x’", "‘x’", "strings in scripts go in single quotes", "a == 'x'"),
    ("a == &quot;x&quot;", "&quot;x&quot;", "strings in scripts go in single quotes", "a == 'x'"),
    ("a and b", "and", "`and` is written `&&` in a script", "a && b"),
    ("a OR b", "OR", "`OR` is written `||` in a script", "a || b"),
    ("a && not b", "not ", "`not` is written `!` in a script", "a && !b"),
    ("not (a == b)", "not ", "`not` is written `!` in a script", "!(a == b)"),
    ("a => b", "=>", "`=>` is written `>=` in a script", "a >= b"),
    ("a =< b", "=<", "`=<` is written `<=` in a script", "a <= b"),
    ("a <> b", "<>", "`<>` is written `!=` in a script", "a != b"),
    ("a === b", "===", "`===` is written `==` in a script", "a == b"),
    ("a !== b", "!==", "`!==` is written `!=` in a script", "a != b"),
    ("a &lt;= b", "&lt;=", "`&lt;=` is written `<=` in a script", "a <= b"),
    ("a &amp;&amp; b", "&amp;&amp;", "`&amp;&amp;` is written `&&` in a script", "a && b"),
    ("a ≥ b", "≥", "`≥` is written `>=` in a script", "a >= b"),
    ("a ≠-b", "≠", "`≠` is written `!=` in a script", "a != -b"),
    ("{battery} > 20", "{battery}", "in a script, write the entry without braces", "battery > 20"),
    ("{ @battery } > 20", "{ @battery }", "in a script, write the entry without braces", "@battery > 20"),
    (".5 < a", ".5", "the engine does not read `.5` as a number; write `0.5`", "0.5 < a"),
    ("1. < a", "1.", "the engine does not read `1.` as a number; write `1.0`", "1.0 < a"),
    ("1_000 < a", "1_000", "the engine does not read `1_000` as a number; write `1000`", "1000 < a"),
    ("a + +3", "+", "unexpected `+`: numbers in scripts take no sign", "a + 3"),
    ("x := +3", "+", "unexpected `+`: numbers in scripts take no sign", "x := 3"),
    ("; x := 1", ";", "unexpected `;` at the start of a script", " x := 1"),
    ("a\xa0&& b", "\xa0", "the engine does not accept this character", "a && b"),
    ("0x1F.. 'a'", "0x1F", "a hexadecimal number and the `..` after it", "0x1F .. 'a'"),
    # What is certainly wrong, but not certainly mended.
    ("x =+ 3", "+", "unexpected `+`: numbers in scripts take no sign", None),
    (
        'a == "it\'s"',
        '"it\'s"',
        "strings in scripts go in single quotes: '…'; a string cannot contain a single quote",
        None,
    ),
    ('a == "x\n" && b == 1', '"x\n"', "strings in scripts go in single quotes", None),  # a quote is lost, perhaps
    ("not a == b", "not", "`not` is written `!` in a script, which binds more tightly", None),
    ("é > 3", "é", "invalid name `é`: names in scripts contain only", None),
    ("3foo", "3foo", "the engine does not read `3foo` as a number", None),
    ("1e", "1e", "the engine does not read `1e` as a number", None),
    ("0x", "0x", "the engine does not read `0x` as a number", None),
    ("1.5.3", "1.5.3", "the engine does not read `1.5.3` as a number", None),
    ("1e999 > a", "1e999", "`1e999` is too large for a number", None),
    ("1e-999 > a", "1e-999", "`1e-999` is too large for a number", None),
    ("9223372036854775808", "9223372036854775808", "`9223372036854775808` is too large for a whole number", None),
    ("0xFFFFFFFFFFFFFFFF", "0xFFFFFFFFFFFFFFFF", "`0xFFFFFFFFFFFFFFFF` is too large", None),
    ("x := 5 % 3", "%", "scripts have no remainder operator", None),
    ("a ** 2", "**", "scripts have no power operator", None),
    ("a << 2", "<<", "scripts have no shifts", None),
    ("a // b", "//", "scripts have neither comments", None),
    ("x++", "+", "scripts have no `++`; write `x += 1`", None),
    ("x--", "-", "scripts have no `--`; write `x -= 1`", None),
    ("x := 1,5", ",", "unexpected `,` in a script", None),
    ("a.b > 3", ".", "unexpected `.`: only numbers contain it", None),
    ("x := [1]", "[", "scripts have no lists", None),
    ("x := {}", "{", "braces belong to ports", None),
    ("$x", "$", "in a script, write the entry without `$`", None),
    ("# x", "#", "scripts have no comments", None),
    ("@ := 1", "@", "`@` must be followed at once", None),
    ("a == 'x", "'x", "missing closing quote for this string", None),
    ('a == "x', '"x', "missing closing quote for this string", None),
    # The grammar.
    ("battery > ", ">", "missing operand after `>`", None),
    ("1 +", "+", "missing operand after `+`", None),
    ("x := ; y := 1", ":=", "missing right-hand side of `:=`", None),
    ("> 3", ">", "missing operand before `>`", None),
    ("()", "()", "missing expression between the brackets", None),
    ("(a > 3", "(", "missing `)` for this `(`", None),
    ("(a; b)", ";", "unexpected `;` inside brackets", None),
    ("(a : b)", "(", "missing `)` before `:`", None),
    ("a)", ")", "unexpected `)`: no bracket is open", None),
    ("a ? b", "?", "a `?` needs both values", None),
    ("a ? b : c : d", ":", "unexpected `:` without `?`", None),
    ("x : 3", ":", "unexpected `:` without `?`", None),
    ("a ? b : x := 1", ":=", "an assignment in the last part of `? :`", None),
    # What the engine loads, and fails at when it ticks.
    ("1 := x", ":=", "only an entry can be assigned to", None),
    (
        "a && b = 1",
        "=",
        "only an entry can be assigned to: the engine loads this and fails at the tick; to compare",
        None,
    ),
    ("f(1)", "f(", "unexpected call `f(…)`", None),
    ("x := max(a, b)", "max(", "unexpected call `max(…)`", None),
    ("time < 30 sec", "30 sec", "unexpected unit `sec`", None),
    ("battery low", "battery low", "missing operator between `battery` and `low`", None),
    ("if a > 3 x := 1", "if a", "scripts have no `if`", None),
    ("a > 3 b > 4", "3 b", "missing operator between `3` and `b`", None),
    ("'a' 'b'", "'a' 'b'", "missing operator between `'a'` and `'b'`", None),
    ("(a b)", "a b", "missing operator between `a` and `b`", None),
    ("a@b", "a@b", "missing operator between `a` and `@b`", None),
]


@pytest.mark.parametrize(("text", "marked", "message", "fixed"), REFUSED)
def test_what_the_newest_engine_refuses(text: str, marked: str, message: str, fixed: str | None) -> None:
    (problem,) = parse_script(text).problems
    assert (problem.rule, problem.effective_severity) == ("script-error", Severity.ERROR)
    assert text[problem.span.start : problem.span.end] == marked
    assert problem.message.startswith(message)
    safe = [fix for fix in problem.fixes if fix.safe]
    assert [apply_fix(text, fix) for fix in safe] == ([] if fixed is None else [fixed])
    assert fixed is None or parse_script(fixed).problems == ()


PROSE = [
    "the charging took longer than 30 sec",
    " the moving to charging station shall take at most 30 sec.",
    "x := 1 if true",
    "the robot and the arm",
    "Battery is not low",
    "don't touch the robot",
    "don’t",
    'the "gripper" holds .5',
]


@pytest.mark.parametrize("text", PROSE)
def test_prose_is_one_problem_of_the_whole_text(text: str) -> None:
    (problem,) = check_script(parse_script(text))
    assert problem.rule == "script-error"
    assert problem.message.startswith("this is prose, not a script")
    assert text[problem.span.start : problem.span.end] == text.strip()
    assert problem.fixes == ()


@pytest.mark.parametrize("text", ["", "  \n\t", ";", " ; ; ", "\xa0;"])
def test_a_script_that_says_nothing(text: str) -> None:
    (problem,) = check_script(parse_script(text), expects_value=True)
    assert (problem.rule, problem.span) == ("empty-script", Span(0, len(text)))


def test_every_certain_slip_is_found_at_once() -> None:
    text = """{a} and not "b" or .5 => c"""
    script = parse_script(text)
    assert [text[problem.span.start : problem.span.end] for problem in script.problems] == [
        "{a}", "and", "not ", '"b"', "or", ".5", "=>",
    ]  # fmt: skip
    assert apply_all(text, script.problems) == "a && !'b' || 0.5 >= c"


def test_unsafe_fixes_propose() -> None:
    assert proposals("(a > 3 ") == ["(a > 3) "]
    assert proposals("a && b = 1") == ["a && b == 1"]
    assert proposals("9223372036854775808") == ["9223372036854775808.0"]


def proposals(text: str) -> list[str]:
    return [apply_fix(text, fix) for problem in parse_script(text).problems for fix in problem.fixes if not fix.safe]


# ---- what older engines refuse, or read in another way ----

# A script, what is said of it, and the script that all versions read as the newest reads this one.
VERSIONS: list[tuple[str, list[str], str]] = [
    # Other meanings.
    ("a - b + c", ["4.8 reads `a - b + c` as `a - (b + c)`"], "(a - b) + c"),
    ("10-4-3", ["4.8 reads `10-4-3` as `10-(4-3)`"], "(10-4)-3"),
    ("8/4/2", ["4.8 reads `8/4/2` as `8/(4/2)`"], "(8/4)/2"),
    ("a / b * c", ["4.8 reads `a / b * c` as `a / (b * c)`"], "(a / b) * c"),
    ("a - b - c - d", ["4.8 reads `a - b - c - d` as `a - (b - (c - d))`"], "((a - b) - c) - d"),
    ("x := a - b*c + d", ["4.8 reads `a - b*c + d` as `a - (b*c + d)`"], "x := (a - b*c) + d"),
    ("a || b && c", ["4.6 and 4.8 read `a || b && c` as `(a || b) && c`"], "a || (b && c)"),
    ("a || b && c && d", ["4.6 and 4.8 read `a || b && c && d` as `(a || b) && c && d`"], "a || (b && c && d)"),
    (
        "a .. b + c",
        ["4.8 refuses `..` beside `+` without brackets", "4.6 reads `a .. b + c` as `a .. (b + c)`"],
        "(a .. b) + c",
    ),
    # Operators that do not mix.
    ("a + b == c", ["4.6 refuses `+` beside `==` without brackets"], "(a + b) == c"),
    ("!a == b", ["4.6 refuses `!` beside `==` without brackets"], "(!a) == b"),
    ("a == -1", ["4.6 refuses `==` beside `-` without brackets"], "a == (-1)"),
    ("!a && b == 1", ["4.6 refuses `!` beside `==` without brackets"], "(!a) && b == 1"),
    ("a & b == c", ["4.6 refuses `&` beside `==` without brackets"], "(a & b) == c"),
    ("!-a", ["4.6 and 4.8 refuse `!` beside `-` without brackets"], "!(-a)"),
    ("~a + b", ["4.6 and 4.8 refuse `~` beside `+` without brackets"], "(~a) + b"),
    ("x := a + 1 && !b", ["4.6 and 4.8 refuse `+` beside `!` without brackets"], "x := (a + 1) && (!b)"),
    ("a + b .. c", ["4.8 refuses `+` beside `..` without brackets"], "(a + b) .. c"),
    ("x := a == -1 ? b + 1 : c", ["4.6 refuses `==` beside `-` without brackets"], "x := a == (-1) ? b + 1 : c"),
    (
        "a .. b * c == d",
        ["4.6 refuses `..` beside `==` without brackets", "4.8 refuses `..` beside `*` without brackets"],
        "(a .. (b * c)) == d",
    ),
    # Operators that do not chain.
    ("x := y := 3", ["4.6 and 4.8 refuse two assignments in one without brackets"], "x := (y := 3)"),
    (
        "a ? b : c ? d : e",
        ["4.6 and 4.8 refuse a `?:` as the last part of another without brackets"],
        "a ? b : (c ? d : e)",
    ),
    # Separators of statements.
    ("x := 1 y := 2", ["4.6 and 4.8 refuse a statement without a `;` before it"], "x := 1; y := 2"),
    ("x := a ready", ["4.6 and 4.8 refuse a statement without a `;` before it"], "x := a; ready"),
    ("x := 1;; y := 2", ["4.6 and 4.8 refuse more than one `;` between statements"], "x := 1; y := 2"),
    ("x := 1;", ["4.6 and 4.8 refuse a `;` after the last statement"], "x := 1"),
    ("x := 1 ; ;\n", ["4.6 and 4.8 refuse a `;` after the last statement"], "x := 1 \n"),
    # Tokens.
    ("1..'a'", ["4.6 and 4.8 refuse a number with `..` at its end"], "1 ..'a'"),
    ("a * 2.5..b", ["4.8 refuses `*` beside `..` without brackets",
                    "4.6 and 4.8 refuse a number with `..` at its end"], "(a * 2.5)..b"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "messages", "fixed"), VERSIONS)
def test_what_older_engines_read_otherwise(text: str, messages: list[str], fixed: str) -> None:
    script = parse_script(text)
    problems = check_script(script)
    assert sorted(problem.message for problem in problems) == sorted(messages)
    assert {problem.rule for problem in problems} == {"script-version"}
    assert {problem.effective_severity for problem in problems} == {Severity.WARNING}
    assert all(fix.safe for problem in problems for fix in problem.fixes)

    assert apply_fix(text, problems[0].fixes[0]) == fixed
    assert check_script(parse_script(fixed)) == ()
    assert shapes(parse_script(fixed)) == shapes(script)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("false_alarms > 3", "4.6 and 4.8 refuse a name that begins with `true` or `false`"),
        ("a == 'Küche'", "4.6 and 4.8 refuse a string with characters outside ASCII"),
    ],
)
def test_what_older_engines_refuse_and_no_bracket_mends(text: str, message: str) -> None:
    (problem,) = check_script(parse_script(text))
    assert (problem.rule, problem.message, problem.fixes) == ("script-version", message, ())


@pytest.mark.parametrize(
    ("text", "versions", "messages"),
    [
        ("a - b + c", ("4.10",), []),
        ("a - b + c", ("4.9", "4.10.1"), []),
        ("a - b + c", ("4.6.2", "4.10"), []),
        ("a - b + c", ("4.7.3",), ["4.7.3 reads `a - b + c` as `a - (b + c)`"]),
        ("a + b == c", ("4.8", "4.10"), []),
        ("a || b && c", ("4.8",), ["4.8 reads `a || b && c` as `(a || b) && c`"]),
        ("x := 1;", ("4.10",), []),
    ],
)
def test_only_the_given_versions_count(text: str, versions: tuple[str, ...], messages: list[str]) -> None:
    problems = check_script(parse_script(text), versions=versions)
    assert [problem.message for problem in problems] == messages


def test_what_every_given_version_refuses_is_an_error() -> None:
    script = parse_script("x := 1;")
    assert [problem.effective_severity for problem in check_script(script, versions=("4.6", "4.8"))] == [Severity.ERROR]
    assert [problem.effective_severity for problem in check_script(script)] == [Severity.WARNING]


def test_a_broken_script_is_only_told_what_is_broken() -> None:
    assert [problem.rule for problem in check_script(parse_script("a - b + c; x >"))] == ["script-error"]


def test_a_mended_slip_does_not_hide_what_older_engines_read_otherwise() -> None:
    text = "a or b and c"
    problems = check_script(parse_script(text))
    assert [problem.rule for problem in problems] == ["script-version", "script-error", "script-error"]
    assert problems[0].message == "4.6 and 4.8 read `a or b and c` as `(a or b) and c`"


# ---- where a value is expected ----


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("'ready'", "a condition must evaluate to 0 or 1: with a string, the engine fails at the tick"),
        ("2", "a condition must evaluate to 0 or 1: with 2, the engine fails at the tick"),
        ("x := 1; (0.5)", "a condition must evaluate to 0 or 1: with 0.5, the engine fails at the tick"),
        ("a ? 'x' : true", "a condition must evaluate to 0 or 1: with a string, the engine fails at the tick"),
    ],
)
def test_a_value_that_is_no_condition(text: str, message: str) -> None:
    (problem,) = check_script(parse_script(text), expects_value=True)
    assert (problem.rule, problem.message, problem.effective_severity) == ("script-error", message, Severity.ERROR)
    assert check_script(parse_script(text)) == ()


def test_an_assignment_as_a_condition() -> None:
    text = "ready; x = 1"
    (problem,) = check_script(parse_script(text), expects_value=True)
    assert text[problem.span.start : problem.span.end] == "="
    assert problem.message == "this condition ends in an assignment: `=` changes the entry; to compare, write `==`"
    assert (problem.rule, problem.effective_severity) == ("script-error", Severity.WARNING)
    assert [(fix.safe, apply_fix(text, fix)) for fix in problem.fixes] == [(False, "ready; x == 1")]
    (problem,) = check_script(parse_script("(x := 1)"), expects_value=True)
    assert (problem.message, problem.fixes) == ("this condition ends in an assignment: `:=` changes the entry", ())


@pytest.mark.parametrize("text", ["0", "1", "1.0", "true", "ready", "a > 3", "x := 3; x == 3", "a ? 0 : b", "!a"])
def test_values_that_are_conditions(text: str) -> None:
    assert check_script(parse_script(text), expects_value=True) == ()


# ---- variables ----


def test_variables_in_the_order_of_the_text() -> None:
    text = "x := a + @b; x += x; y = (c < 1 ? z := 'n' : true)"
    assert variables(parse_script(text)) == (
        Variable("x", Span(0, 1), reads=False, writes=True, creates=True),
        Variable("a", Span(5, 6), reads=True),
        Variable("@b", Span(9, 11), reads=True),
        Variable("x", Span(13, 14), reads=True, writes=True),
        Variable("x", Span(18, 19), reads=True),
        Variable("y", Span(21, 22), reads=False, writes=True),
        Variable("c", Span(26, 27), reads=True),
        Variable("z", Span(34, 35), reads=False, writes=True, creates=True),
    )


def test_variables_of_broken_scripts() -> None:
    assert [variable.name for variable in variables(parse_script("x := 1; y > "))] == ["x"]
    assert [variable.name for variable in variables(parse_script("{x} := y"))] == ["x", "y"]
    assert [(variable.name, variable.writes) for variable in variables(parse_script("x + y := 1"))] == [
        ("x", False),
        ("y", False),
    ]


# ---- how tightly operators bind ----


@pytest.mark.parametrize(
    ("text", "short"),
    [
        ("((a + b)) * c", "(a + b) * c"),
        ("(a * b) + c", "a * b + c"),
        ("a - (b - c)", "a - (b - c)"),
        ("(a - b) - c", "a - b - c"),
        ("-(a + b)", "-(a + b)"),
        ("!(-a)", "!-a"),
        ("(a < b) == c", "(a < b) == c"),
        ("(a || b) && c", "(a || b) && c"),
        ("a ? (x := 1) : (x := 2)", "a ? x := 1 : (x := 2)"),
        ("(a ? b : c) ? d : (e ? f : g)", "(a ? b : c) ? d : e ? f : g"),
        ("(x := 1) + 2;y:=(z:=3)", "(x := 1) + 2; y := z := 3"),
    ],
)
def test_how_tightly_operators_bind(text: str, short: str) -> None:
    script = parse_script(text)
    assert unparse(script, fully_parenthesised=False) == short
    assert shapes(parse_script(short)) == shapes(script)


# ---- properties ----

words = st.sampled_from(
    [
        *"abx'\"(){}[];:?!~&|^<>=+-*/%.,@#_\n\xa0é≤“”",
        "@b",
        "true",
        "truth",
        "1",
        "2.5",
        ".5",
        "1.",
        "0x1F",
        "3s",
        "'t'",
        "and",
        "or",
        "not",
        ":=",
        "+=",
        "==",
        "!=",
        "<=",
        "&&",
        "||",
        "..",
        "=>",
        "&lt;",
        "&amp;&amp;",
        "{k}",
        "’",
        "===",
        "**",
        "the robot",
        "1_000",
        '"q"',
        "9" * 20,
    ]
)
soups = st.lists(st.tuples(words, st.sampled_from(["", " "])), max_size=14).map(
    lambda parts: "".join(word + blank for word, blank in parts)
)
leaves: st.SearchStrategy[Expression] = st.sampled_from(
    [
        *(Name(0, 0, name) for name in ("a", "@b", "trueish")),
        *(Number(0, 0, raw) for raw in ("1", "2.5")),
        *(ScriptText(0, 0, "t"), ScriptText(0, 0, "é"), Bool(0, 0, True)),
    ]
)


def _larger(inside: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
    binary = st.sampled_from(["+", "-", "*", "/", "..", "&", "|", "^", "&&", "||"])
    comparison = st.sampled_from(["==", "!=", "<", ">", "<=", ">="])
    return st.one_of(
        st.builds(partial(ScriptGroup, 0, 0), inside),
        st.builds(partial(Unary, 0, 0), st.sampled_from(["-", "!", "~"]), inside),
        st.builds(partial(ScriptBinary, 0, 0), binary, inside, inside),
        st.builds(partial(ScriptBinary, 0, 0), binary, inside, inside),
        st.builds(
            lambda operator, left, right: ScriptComparison(0, 0, (operator,), (left, right)), comparison, inside, inside
        ),
        st.builds(
            lambda operators, left, middle, right: ScriptComparison(0, 0, operators, (left, middle, right)),
            st.tuples(comparison, comparison),
            inside,
            inside,
            inside,
        ),
        st.builds(partial(Ternary, 0, 0), inside, inside, inside),
        st.builds(partial(Assign, 0, 0), st.sampled_from([":=", "=", "+="]), st.just(Name(0, 0, "x")), inside),
    )


def _script(statements: list[Expression]) -> Script:
    return Script("", tuple(statements))


scripts = st.lists(st.recursive(leaves, _larger, max_leaves=8), min_size=1, max_size=3).map(_script)
texts = st.one_of(
    soups, scripts.map(unparse), scripts.map(lambda script: unparse(script, fully_parenthesised=False)), st.text()
)


@given(texts, st.booleans())
@example("'", True)
@example("@", True)
@example("\x00", True)
def test_every_text_is_read(text: str, expects_value: bool) -> None:
    script = parse_script(text)
    problems = check_script(script, expects_value=expects_value)
    assert script.complete or script.problems
    assert bool(script.statements) or bool(script.problems)
    for problem in problems:
        assert 0 <= problem.span.start <= problem.span.end <= len(text)
    assert list(problems) == sorted(problems, key=lambda problem: problem.span)
    assert_nested(script.statements, Span(0, len(text)))


@given(scripts)
def test_a_tree_survives_its_text(script: Script) -> None:
    for fully_parenthesised in (True, False):
        text = unparse(script, fully_parenthesised=fully_parenthesised)
        again = parse_script(text)
        assert again.problems == ()
        assert shapes(again) == shapes(script)
        assert unparse(again, fully_parenthesised=fully_parenthesised) == text


@given(texts)
def test_a_text_survives_its_tree(text: str) -> None:
    script = parse_script(text)
    assert shapes(parse_script(unparse(script))) == shapes(script)


@given(scripts)
def test_full_brackets_mean_the_same_in_all_versions(script: Script) -> None:
    problems = check_script(parse_script(unparse(script)))
    # No bracket helps a name or a text that older engines cannot read.
    assert {problem.message.partition(" refuse ")[2] for problem in problems} <= {
        "a name that begins with `true` or `false`",
        "a string with characters outside ASCII",
    }


@given(texts, st.sampled_from([ENGINES, ("4.6",), ("4.8",), ("4.10",)]))
@example("a and b or not c => d", ENGINES)
@example("a≠=b", ENGINES)
@example("a{b}", ENGINES)
@example("a & 1.{b}", ENGINES)
@example("{é}", ENGINES)
@example("a {and} b", ENGINES)
@example("a.5", ENGINES)
@example("a and.5", ENGINES)
@example("a2.52.5", ENGINES)
@example(".5a3", ENGINES)
@example(".5e999", ENGINES)
@example("1_00099999999999999999999", ENGINES)
@example('\'"a"', ENGINES)
@example("a + b .. c == d && -e || ~f", ENGINES)
def test_a_safe_fix_mends_its_problem_and_makes_none(text: str, versions: tuple[str, ...]) -> None:
    script = parse_script(text)
    problems = check_script(script, versions=versions)
    for problem in problems:
        for fix in problem.fixes:
            if fix.safe:
                mended = parse_script(apply_fix(text, fix))
                left = kinds(check_script(mended, versions=versions))
                assert left < kinds(problems)
                assert left[problem.rule] < kinds(problems)[problem.rule]
                assert shapes(mended) == shapes(script)


@settings(deadline=None)  # some hundred scripts in one example
@given(st.integers(0, 3), st.sampled_from(["(", "-", "!(", "x := ", "a ? b : ", "a + (", "a || (b && ("]))
def test_depth_is_limited_and_the_fixes_stay_below_it(over: int, opening: str) -> None:
    """A script just below the limit, whose every fix adds brackets, does not pass it."""
    per_piece = 2 if opening.endswith("&& (") else 1
    times = MAX_DEPTH // per_piece - 1 + over
    text = opening * times + "c" + ")" * (opening.count("(") * times)
    problems = check_script(parse_script(text))
    if any(problem.rule == "script-error" for problem in problems):
        assert [problem.message for problem in problems] == [TOO_DEEP]
        return
    for problem in problems:
        mended = check_script(parse_script(apply_fix(text, problem.fixes[0])))
        assert all(problem.rule == "script-version" for problem in mended)


TOO_DEEP = "more than 100 nested operators; use several statements"


@pytest.mark.parametrize(
    "text",
    [
        "(" * 5000, "(" * 5000 + "a" + ")" * 5000, "-" * 5000 + "a", "!(" * 5000, "(-" * 5000, "x := " * 5000 + "1",
        "a ? b : " * 5000 + "c", "a ? " * 5000, "a + " * 5000 + "a", "(a + " * 5000, "a && (b || " * 5000,
    ],
)  # fmt: skip
def test_any_depth_is_one_problem(text: str) -> None:
    problems = check_script(parse_script(text))
    assert [problem.message for problem in problems] == [TOO_DEEP]


@pytest.mark.parametrize("text", ["(" * 99 + "a" + ")" * 99, "a" + " + a" * 100, "!" * 100 + "a"])
def test_a_hundred_levels_are_read(text: str) -> None:
    script = parse_script(text)
    assert script.problems == ()
    assert shapes(parse_script(unparse(script))) == shapes(script)


def apply_fix(text: str, fix: Fix) -> str:
    return apply_edits(text, [Edit(change.place.span, change.text) for change in fix.changes])


def apply_all(text: str, problems: tuple[Diagnostic, ...]) -> str:
    changes = [change for problem in problems for fix in problem.fixes for change in fix.changes]
    return apply_edits(text, [Edit(change.place.span, change.text) for change in changes])


def kinds(problems: tuple[Diagnostic, ...]) -> Counter[str]:
    return Counter(problem.rule for problem in problems)


def shapes(script: Script) -> list[object]:
    return [shape(statement) for statement in script.statements]


def shape(node: Expression) -> object:
    """An expression without places and brackets."""
    while isinstance(node, ScriptGroup):
        node = node.inner
    if below := children(node):
        operator = getattr(node, "operator", None) or getattr(node, "operators", None)
        return (type(node).__name__, operator, *map(shape, below))
    return replace(node, start=0, end=0)


def assert_nested(nodes: tuple[Expression, ...], outer: Span) -> None:
    at = outer.start
    for node in nodes:
        assert at <= node.start < node.end <= outer.end
        assert_nested(children(node), Span(node.start, node.end))
        at = node.end
