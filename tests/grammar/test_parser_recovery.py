"""One mistake gives exactly one diagnostic, and the rest of the file is understood as if nothing had happened."""

from __future__ import annotations

import random

import pytest
from seeds import seeds
from syntax_asserts import apply_fix, assert_invariants, assert_parse, assert_safe_fixes, show_problems

from btq_lang.lexer import Lexer
from btq_lang.parser import Parsed, parse
from btq_lang.syntax.tree import SkippedLines, shape

IN_BRACKETS = (
    *("A", " (", ")", "p", " = ", " =", "=", ":", '"x"', '"a b"', '"', "'", "3", "30 s", ",", "{k}", "_skipIf", " "),
    *("\n", "\n    ", "# c", "/*", "*/", "satisfies r", "-> ", 'include "b"', "QualityReq q", "takes at most 3 s"),
)
MISSION = """\
include "skills.btq"
signal battery : % from {battery_level} fresh within 5 s
context low : battery < 20 %

QualityReq rq1 : time-behaviour "In time"
    BatteryCheck/MoveBase takes at most 30 s
    in at least 98 % of activations
    on violation fail

apply rq1 to every MoveBase except Home

Action MoveBase "Drives"
    input station : string = "charger"
    output done : bool

Root mainTree
    BehaviorTree mainTree
        R?
            -> BatteryCheck
                Condition BatteryLow
                MoveBase (station = "charger" satisfices performance, tags a)
                    satisfies rq1
                Charge
            Retry (
                num_attempts = 6
                name = "again"
            )
                SubTree PickPlace (pose = {pose})

    BehaviorTree PickPlace
        ->
            Pick
            Place

signal speed : m/s
"""


def shapes(parsed: Parsed) -> list[object]:
    return [shape(entry.item) for entry in parsed.entries]


def check_one_mistake(old: str, new: str, damaged: int | None, problem: str) -> None:
    """Replace something in the mission: one diagnostic, and no item but `damaged` is understood otherwise."""
    assert MISSION.count(old) == 1, "a test that says where its mistake is"
    text = MISSION.replace(old, new)
    parsed = parse(text)
    assert_invariants(parsed)
    assert_safe_fixes(parsed)
    assert show_problems(text, parsed.diagnostics) == problem
    found, expected = shapes(parsed), shapes(parse(MISSION))
    if damaged is not None:
        assert found[damaged] != expected[damaged], "this item is not damaged"
        found[damaged] = expected[damaged]
    assert found == expected


def test_the_mission_is_right() -> None:
    assert_parse(MISSION, None)


END = "found the end of the line"
NO_BLOCK = "unexpected indentation: the line above opens no block"


@pytest.mark.parametrize(
    ("old", "new", "damaged", "problem"),
    [
        ('"skills.btq"', "skills.btq", 0, "1:9 syntax-error «skills» expected a file in quotes, found `skills`"),
        ("battery : %", "battery %", 1, "2:16 syntax-error «%» expected `:` and the signal's unit, found `%`"),
        ("within 5 s", "within 5sek", 1, "2:55 unknown-unit «sek» unknown unit `sek`; did you mean `s`?"),
        (
            "battery < 20 %",
            "battery <",
            2,
            f"3:24 syntax-error «» expected a condition: a signal, a context, a value, …, {END}",
        ),
        (
            "context low",
            "contxt low",
            None,
            "3:1 syntax-error «contxt» unknown word `contxt`; did you mean `context`?",
        ),
        ("QualityReq rq1 :", "QualityReq :", 3, "5:12 syntax-error «:» expected the requirement's ID, found `:`"),
        (
            "takes at most",
            "takes most",
            3,
            "6:33 syntax-error «most» expected a bound: at most, at least, less than, more than or between, "
            "found `most`",
        ),
        (
            "takes at most",
            "take at most",
            3,
            "6:27 syntax-error «take» unknown word `take`; did you mean `takes`?",
        ),
        (
            "    in at least",
            "   in at least",
            None,
            "7:1 inconsistent-indentation «   » an indentation of 3 spaces matches no open block",
        ),
        (
            "    in at least",
            "\tin at least",
            None,
            "7:1 inconsistent-indentation «\t» tabs and spaces are mixed: 1 tab cannot be compared with 4 spaces",
        ),
        ("    in at least", "        in at least", 3, f"7:9 syntax-error «in at least 98 % of activations» {NO_BLOCK}"),
        ("on violation fail", "on violation", 3, f"8:17 syntax-error «» expected fail, halt, warn or log, {END}"),
        ("apply rq1 to", "apply rq1", 4, "10:11 syntax-error «every» expected `to`, found `every`"),
        ('"Drives"', "Drives", 5, "12:17 syntax-error «Drives» expected the end of the line, found `Drives`"),
        (
            "station : string",
            "station string",
            5,
            "13:19 syntax-error «string» expected `:` and the port's type, found `string`",
        ),
        (
            "output done",
            "outptu done",
            5,
            "14:5 syntax-error «outptu» expected a port (input, output or inout), metadata or xml, found `outptu`",
        ),
        ("Root mainTree", "Root main tree", 6, "16:11 syntax-error «tree» expected the end of the line, found `tree`"),
        ("Root mainTree", "Root mainTree (", 6, "16:15 unclosed-bracket «(» missing `)` for this `(`"),
        (
            "    BehaviorTree mainTree",
            "    BehaviourTree mainTree",
            None,
            "17:5 syntax-error «BehaviourTree» unknown word `BehaviourTree`; did you mean `BehaviorTree`?",
        ),
        (
            "-> BatteryCheck",
            "-> Battery Check",
            7,
            "19:24 syntax-error «Check» expected the end of the line, found `Check`",
        ),
        ("tags a)", "tags a", 7, "21:26 unclosed-bracket «(» missing `)` for this `(`"),
        ("tags a)", "tags a))", None, "21:78 syntax-error «)» unexpected `)`: no bracket is open"),
        (
            "MoveBase (station",
            "MoveBase station",
            7,
            '21:26 syntax-error «station = "charger" satisfices performance, tags a» '
            "attributes go in brackets: `(key = value)`",
        ),
        (
            "num_attempts = 6",
            "num_attempts 6",
            7,
            "25:17 syntax-error «num_attempts» expected an attribute: key = value, found `num_attempts`",
        ),
        ("            )\n", "", 7, "24:19 unclosed-bracket «(» missing `)` for this `(`"),
        ("            )\n", "        x = 1\n        )\n", 7, "24:19 unclosed-bracket «(» missing `)` for this `(`"),
        (
            "Retry (\n",
            "Retry\n",
            7,
            "25:17 syntax-error «num_attempts = 6» attributes go in brackets: `(key = value)`",
        ),
        ("{pose})", "{pose)", 7, "28:43 syntax-error «{» missing `}` for this `{`"),
        ("{pose})", "pose})", 7, "28:47 syntax-error «}» missing `{` for this `}`"),
        ("{pose})", "/pose)", 7, "28:43 syntax-error «/pose» this value needs quotes"),
        (
            "            Place\n",
            "            Place /* x\n",
            None,
            "33:19 unclosed-comment «/*» missing closing `*/` for this comment",
        ),
        (
            "    BehaviorTree PickPlace\n",
            "    BehaviorTree PickPlace#1\n",
            8,
            "30:18 misplaced-comment «PickPlace#1» `#` begins a comment only after a space; put this in quotes",
        ),
        ("speed : m/s", "speed : m/sek", 9, "35:16 unknown-unit «m/sek» unknown unit `m/sek`; did you mean `m/s`?"),
    ],
)
def test_one_mistake(old: str, new: str, damaged: int | None, problem: str) -> None:
    check_one_mistake(old, new, damaged, problem)


def test_a_tree_without_its_first_line() -> None:
    text = MISSION.replace("    BehaviorTree PickPlace\n", "").replace("Root mainTree\n", "Root mainTree\n    X\n")
    parsed = parse(text)
    assert_invariants(parsed)
    assert show_problems(text, parsed.diagnostics) == (
        "17:5 syntax-error «X» expected an item: BehaviorTree, QualityReq, include, signal, …, found `X`"
    )


def test_lines_that_are_no_items_are_one_mistake() -> None:
    text = "signal a : m\n->\n    X\nY (b = 1)\n3\n    satisfies z\nBehaviorTree c\n    Z\nW\n"
    tree = "signal a : m\nskipped\ntree c\n  Z\nskipped"
    message = "expected an item: BehaviorTree, QualityReq, include, signal, …"
    assert_parse(
        text, tree, f"2:1 syntax-error «->» {message}, found `->`", f"9:1 syntax-error «W» {message}, found `W`"
    )


def test_what_forgotten_brackets_leave_behind_is_no_mistake_of_its_own() -> None:
    text = """
        BehaviorTree t
            ->
                X (
                    a = 1
            b = 2
            c d = {e}
            )
            Y 3
    """
    tree = """
        tree t
          ->
            X (a=1)
          c as d
          Y
    """
    parsed = assert_parse(text, tree, "3:11 unclosed-bracket «(» missing `)` for this `(`",
                          "8:7 syntax-error «3» expected the end of the line, found `3`")  # fmt: skip
    assert not any(isinstance(entry.item, SkippedLines) for entry in parsed.entries)


def test_attributes_on_lines_of_their_own_without_brackets() -> None:
    text = """
        BehaviorTree t
            X
                a = 1
                b = 2
                satisfies c
                Y
    """
    parsed = assert_parse(text, "tree t\n  X\n    satisfies c\n    Y",
                          "3:9 syntax-error «a = 1» attributes go in brackets: `(key = value)`")  # fmt: skip
    assert parsed.diagnostics[0].fixes == ()


def test_indentation_behind_forgotten_brackets_is_no_mistake_of_its_own() -> None:
    text = "BehaviorTree t\n    ->\n        X (\n      a = 1\n      b = 2\n        )\n        Y\n"
    assert_parse(text, "tree t\n  ->\n    X\n    Y", "3:11 unclosed-bracket «(» missing `)` for this `(`")


def test_a_quote_that_is_missing_is_said_first() -> None:
    """Strings run to their closing quote (language.md §2), so what follows is read inside out."""
    text = MISSION.replace('"In time"', '"In time')
    (first, *_) = parse(text).diagnostics
    assert (first.rule, text[first.span.start : first.span.end + 7]) == ("unclosed-string", '"In time')
    text = MISSION.replace('"charger" sat', 'charger" sat')
    (only,) = parse(text).diagnostics
    assert only.message == "missing quote before `charger`"
    assert [fix.title for fix in only.fixes] == ['Put " before it']
    (alone,) = parse('BehaviorTree A\n    B (p = charger")\n').diagnostics
    assert alone.message == only.message


LOST = 'a closing " is probably missing: this string ends at the next one, on another line'
OVER = "this string runs past a line that looks like the start of an item"


@pytest.mark.parametrize(
    ("text", "problem", "mended"),
    [
        (
            'BehaviorTree A\n  ->\n    B (p = "a)\n    C (p = "b")\n    D (p = "c")\n',
            f'3:12 unclosed-string «"a)» {LOST}',
            '"a")',
        ),
        ('BehaviorTree A\n  ->\n    B (p = "a)\n    C (p = "b")\n', f'3:12 unclosed-string «"a)» {LOST}', '"a")'),
        (
            'BehaviorTree A\n  B (p = "a)\nBehaviorTree B\n  C (p = " b")\nBehaviorTree C\n  D (p = "d")\n',
            f'2:10 unclosed-string «"» {OVER}',
            '"a")',
        ),
        (
            'BehaviorTree A\n  -> "A\n    B (p = "b")\n    C (p = "c")\n',
            f'2:6 unclosed-string «"A» {LOST}',
            '"A"\n',
        ),
        (
            'BehaviorTree A\n  ->\n    B (p = a")\n    C (p = "b")\n    D (p = "c")\n',
            "3:12 syntax-error «a» missing quote before `a`",
            '"a")',
        ),
        (
            'QualityReq r : safety "A\n  takes at most 3 s\nQualityReq s : safety "B"\nQualityReq t : safety "C"\n',
            f'1:23 unclosed-string «"» {OVER}',
            '"A"\n',
        ),
        (
            'QualityReq r : safety "A\n  takes at most 3 s because "so"\n',
            f'1:23 unclosed-string «"A» {LOST}',
            '"A"\n',
        ),
    ],
)
def test_a_quote_that_is_missing_is_one_mistake(text: str, problem: str, mended: str) -> None:
    parsed = assert_parse(text, None, problem)
    (fix,) = parsed.diagnostics[0].fixes
    after = apply_fix(text, fix)
    assert (parse(after).diagnostics, mended in after) == ((), True)


def test_a_string_over_lines_that_is_closed_is_not_to_blame() -> None:
    text = 'BehaviorTree A\n  B (p = "a\n  b" c)\n'
    assert_parse(text, None, "3:6 syntax-error «c» expected an attribute: key = value, found `c`")


def test_a_quote_alone_at_the_end_of_a_line_is_no_string_that_ends_further_down() -> None:
    text = "BehaviorTree A\n  B (\n    satisfies QualityReq ID = x '\n    a b\n  )\n"
    problems = show_problems(text, parse(text).diagnostics)
    assert problems == (
        "3:33 unclosed-string «'» missing closing ' for this string\n"
        "4:5 syntax-error «a» expected a verb after `'` (takes, succeeds, needs, keeps, …), found `a`"
    )


def test_a_root_without_a_block_leaves_no_column_behind() -> None:
    text = "Root A\n    BehaviorTree A\n        X\n    Root\n  QualityReq rq1\n"
    found = [(problem.rule, problem.span.start) for problem in parse(text).diagnostics]
    assert found == [("second-root", 40), ("inconsistent-indentation", 45)]


# ---- common mistakes and their diagnostics --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "problem", "mended"),
    [
        ("X satisifes r", "unknown word `satisifes`; did you mean `satisfies`?", "X satisfies r"),
        ("X (a = 1) tag b", "unknown word `tag`; did you mean `tags`?", "X (a = 1) tags b"),
        ("--> Go", "expected a node: its kind, or a symbol: -> ? || …, found `-`", "-> Go"),
        ("- > Go", "expected a node: its kind, or a symbol: -> ? || …, found `-`", "-> Go"),
        ("=> Go", "expected a node: its kind, or a symbol: -> ? || …, found `=`", "-> Go"),
        ("r->", "the symbol is written `R->`", "R->"),
        ("R -> Go", "the symbol is written `R->`", "R-> Go"),
    ],
)
def test_a_slip_on_the_line_of_a_node(line: str, problem: str, mended: str) -> None:
    text = f"BehaviorTree t\n    {line}\n"
    (only,) = parse(text).diagnostics
    assert only.message == problem
    (fix,) = only.fixes
    assert apply_fix(text, fix) == f"BehaviorTree t\n    {mended}\n"


SIGNAL = "expected a condition, which begins with its signal, found "
VERB = "expected a verb: takes, succeeds, needs, keeps, …, found "
EVENT = "expected starts, succeeds, fails, finishes or halts, found "
IS_EVENT = "an event is a node and what happens to it: `Pick starts`, `Place succeeds`"
A_TIME = "expected a unit of time: ms, s, min, h"
TITLE = "a title goes in quotes"
ITEM = "expected an item: BehaviorTree, QualityReq, include, signal, …, found "
A_FILE = "expected a file in quotes, found "
A_PORT = "expected a port (input, output or inout), metadata or xml, found "


@pytest.mark.parametrize(
    ("text", "problem", "note", "mended"),
    [
        ("QualityReq r safety 't'\n", "a quality goes after `:`", None, "QualityReq r : safety 't'\n"),
        ("QualityReq r reach the charger, then dock  # soon\n", TITLE, None,
         'QualityReq r "reach the charger, then dock"  # soon\n'),
        ("QualityReq r : time-behaviour reach it takes at most 3 s\n", TITLE, None,
         'QualityReq r : time-behaviour "reach it" takes at most 3 s\n'),
        ("QualityReq r arrive in time because 'it is late'\n", TITLE, None,
         "QualityReq r \"arrive in time\" because 'it is late'\n"),
        ("QualityReq r stop in the lab in at least 95 % of runs\n", TITLE, None,
         'QualityReq r "stop in the lab" in at least 95 % of runs\n'),
        ("QualityReq r keep the arm still\n", TITLE, None, 'QualityReq r "keep the arm still"\n'),
        ("QualityReq r the robot shall arrive\n", TITLE, None, 'QualityReq r "the robot shall arrive"\n'),
        ("QualityReq r robot shall arrive\n", TITLE, None, 'QualityReq r "robot shall arrive"\n'),
        ("QualityReq r takes at most 5 mtr on violation fail\n", "unknown unit `mtr`", A_TIME, None),
        ("QualityReq r takes at most 5mtr\n", "unknown unit `mtr`", A_TIME, None),
        ("QualityReq r takes at most 5 m if near else 7 metr\n", "unknown unit `metr`", A_TIME, None),
        ("QualityReq r takes at most 5 msk\n", "unknown unit `msk`; did you mean `ms`?", None,
         "QualityReq r takes at most 5 ms\n"),
        ("QualityReq r keeps a < 5 metr\n", "unknown unit `metr`; did you mean `m`?", None,
         "QualityReq r keeps a < 5 m\n"),
        ("QualityReq r : safety calm\n", "a quality's name has no spaces", None, "QualityReq r : safety-calm\n"),
        ("QualityReq r robot shall take at most 3 s\n", "this clause is written `robot takes at most 3 s`", None,
         "QualityReq r robot takes at most 3 s\n"),
        ("QualityReq r keep level > 5 %\n", "unknown word `keep`; did you mean `keeps`?", None,
         "QualityReq r keeps level > 5 %\n"),
        ("QualityReq r robot leave level > 5 %\n",
         "unknown word `leave`; did you mean `leaves`?", None, "QualityReq r robot leaves level > 5 %\n"),
        ("QualityReq r : safety 'a' 'b'\n",
         "expected a verb after `'b'` (takes, succeeds, needs, keeps, …), found the end of the line",
         "a requirement has one title, after its name; reasons are written `because …`", None),
        ("QualityReq r\n    title 'a'\n",
         '`title` is not in btq; nearest is the title in quotes after the name: `QualityReq fast "in time"`',
         None, "QualityReq r 'a'\n"),
        ("QualityReq r\n    quality safety\n",
         "expected a verb after `quality` (takes, succeeds, needs, keeps, …), found `safety`",
         "a requirement's quality goes after its name: `QualityReq fast : reliability`", None),
        ("QualityReq r\n    satisfices safety\n",
         "expected a clause: takes, keeps, in at least, on violation, …, found `satisfices`",
         "a requirement's quality goes after its name: `QualityReq fast : reliability`", None),
        ("QualityReq r\n    violation fail\n",
         "expected a verb after `violation` (takes, succeeds, needs, keeps, …), found `fail`",
         "write `on violation fail`", None),
        ("QualityReq r\n    at most 2 min\n",
         "expected a verb before `at most`, found `most`",
         "a bound goes after its verb, `takes at most 3 s`; a probability is written `in at least 95 % of runs`",
         "QualityReq r\n    takes at most 2 min\n"),
        ("QualityReq r\n    takes at most 0,5 s\n", "a decimal number is written with a point", None,
         "QualityReq r\n    takes at most 0.5 s\n"),
        ("QualityReq r\n    all A takes at most 3 s\n", "all nodes of a kind are written `every …`", None,
         "QualityReq r\n    every A takes at most 3 s\n"),
        ("apply r to each A\n", "all nodes of a kind are written `every …`", None, "apply r to every A\n"),
        ("apply r on every A\n", "expected `to`, found `on`", None, "apply r to every A\n"),
        ("apply r to every tagged t\n", "nodes with a tag are selected with `every node tagged …`", None,
         "apply r to every node tagged t\n"),
        ("QualityReq r\n    sum of A and B takes at most 3 s\n", "expected `,` instead of `and`", None,
         "QualityReq r\n    sum of A, B takes at most 3 s\n"),
        ("QualityReq r\n    A.B takes at most 3 s\n", "the names of a path are separated by `/`", None,
         "QualityReq r\n    A/B takes at most 3 s\n"),
        ("QualityReq r\n    A and B takes at most 3 s\n", VERB + "`and`",
         "a clause applies to one node; write it for each, or `sum of A, B` for the time of both", None),
        ("QualityReq r\n    A shall succeed\n", "this clause is written `A succeeds`", None,
         "QualityReq r\n    A succeeds\n"),
        ("QualityReq r\n    A never fails\n", "expected a condition, found `fails`",
         "write `succeeds` for a node that must not fail, or `never node Dock` for a node that must not run", None),
        ("QualityReq r\n    follows A succeed\n", EVENT + "`succeed`", IS_EVENT,
         "QualityReq r\n    follows A succeeds\n"),
        ("QualityReq r\n    from A to B takes at most 3 s\n", EVENT + "`to`", IS_EVENT, None),
        ("QualityReq r\n    starts within 2 s of A succeeds\n", "expected `after`, found `of`", None,
         "QualityReq r\n    starts within 2 s after A succeeds\n"),
        ("QualityReq r\n    runs at least 1\n", "expected `per` and a time, found the end of the line",
         "a rate is written `runs at least 10 per 1 s`", None),
        ("QualityReq r\n    uses at most 5 % battery\n", "this clause is written `uses at most 5 % of battery`", None,
         "QualityReq r\n    uses at most 5 % of battery\n"),
        ("QualityReq r\n    in at least 98 % runs\n", "expected `of`, found `runs`", None,
         "QualityReq r\n    in at least 98 % of runs\n"),
        ("QualityReq r\n    confidence 0.95\n", "expected a percentage: 95 %, found `0.95`", None,
         "QualityReq r\n    confidence 95 %\n"),
        ("QualityReq r\n    because people are near  # yes\n", "expected the reason in quotes, found `people`", None,
         'QualityReq r\n    because "people are near"  # yes\n'),
        ("QualityReq r\n    keeps avg(a) < 3\n",
         "expected a function (age, change, count, max, mean, min, p95, stddev), found `avg`", None,
         "QualityReq r\n    keeps mean(a) < 3\n"),
        ("signal a : m fresh 200 ms\n", "expected `within`, found `200 ms`", None,
         "signal a : m fresh within 200 ms\n"),
        ("signal a : boolean\n", "unknown unit `boolean`; did you mean `bool`?", None, "signal a : bool\n"),
        ('import "a.btq"\n', "unknown word `import`; did you mean `include`?", None, 'include "a.btq"\n'),
        ('include: "b.btq"\n', "unexpected `:`", None, 'include "b.btq"\n'),
        ('include = "b.btq"\n', "unexpected `=`", None, 'include "b.btq"\n'),
        ('include: /* x */ "b.btq"\n', "unexpected `:`", None, 'include /* x */ "b.btq"\n'),
        ('include:"b.btq"\n', "unexpected `:`", None, 'include "b.btq"\n'),
        ('include = b.btq"\n', A_FILE + "`=`", None, 'include "b.btq"\n'),
        ('include =\n', A_FILE + "`=`", None, None),
        ('include b.btq"\n', A_FILE + "`b`", None, 'include "b.btq"\n'),
        ('include my b.btq"  # and\nAction A "x"\n', A_FILE + "`my`", None,
         'include "my b.btq"  # and\nAction A "x"\n'),
        ('Requirement r "t"\n', "unknown word `Requirement`; did you mean `QualityReq`?", None, 'QualityReq r "t"\n'),
        ("Action A\n    in x\n", A_PORT + "`in`", None, "Action A\n    input x\n"),
        ("Action A\n    out x\n", A_PORT + "`out`", None, "Action A\n    output x\n"),
        ("tree T\n    A\n", "unknown word `tree`; did you mean `BehaviorTree`?", None, "BehaviorTree T\n    A\n"),
        ('QualityReq REQ.001 : safety "t"\n', "this ID needs quotes", None, 'QualityReq "REQ.001" : safety "t"\n'),
        ("QualityReq 4711 : safety\n", "this ID needs quotes", None, 'QualityReq "4711" : safety\n'),
        ("QualityReq r : safety, usability\n", "qualities are joined by `and`, not by `,`", None,
         "QualityReq r : safety and usability\n"),
        ("QualityReq r : safety and\n", "expected a quality, found the end of the line", None, None),
        ('QualityReq r "t" : safety\n', "a requirement's quality goes before its title", None, None),
        ("QualityReq r (x = 3 m)\n", "expected `:` and the parameter's unit, found `=`",
         "write its unit after `:`, and its default after that: `limit : m = 3 m`", None),
        ("BehaviorTree t\n    A satisfies r (3 m)\n", "expected a parameter's name, found `3 m`",
         "a value goes after the name of its parameter: `x = 3 m`", None),
        ("BehaviorTree t\n    A satisfies 1.2.3\n", "this ID needs quotes", None,
         'BehaviorTree t\n    A satisfies "1.2.3"\n'),
        ("BehaviorTree t\n    A satisfies r,\n",
         "expected another requirement after the comma, found the end of the line", None,
         "BehaviorTree t\n    A satisfies r\n"),
        ("BehaviorTree t\n    A satisfies r s\n", "expected `,` or the end of the line, found `s`", None,
         "BehaviorTree t\n    A satisfies r, s\n"),
        ("QualityReq r\n    takes no more than 3 s\n", "this bound is written `at most`", None,
         "QualityReq r\n    takes at most 3 s\n"),
        ("QualityReq r\n    takes =< 3 s\n", "this bound is written `at most`", None,
         "QualityReq r\n    takes at most 3 s\n"),
        ("QualityReq r\n    takes 10-20 s\n",
         "expected a bound: at most, at least, less than, more than or between, found `10`",
         "a range is written `between 10 s and 20 s`", None),
        ("QualityReq r\n    takes up to 3 s\n", "this bound is written `at most`", None,
         "QualityReq r\n    takes at most 3 s\n"),
        ("QualityReq r\n    takes at most 30 Sekunden\n", "unknown unit `Sekunden`; did you mean `s`?", None,
         "QualityReq r\n    takes at most 30 s\n"),
        ("QualityReq r\n    keeps a < .5 m\n", "a number begins with a digit", None,
         "QualityReq r\n    keeps a < 0.5 m\n"),
        ("BehaviorTree t\n    A (x = 0,5)\n", "a decimal number is written with a point", None,
         "BehaviorTree t\n    A (x = 0.5)\n"),
        ('BehaviorTree t\n    A (x "y")\n', "expected an attribute: key = value, found `x`", None,
         'BehaviorTree t\n    A (x = "y")\n'),
        ("BehaviorTree t\n    A (x = {{y}})\n", "a blackboard entry has one pair of braces", None,
         "BehaviorTree t\n    A (x = {y})\n"),
        ("BehaviorTree t\n    Action A.B\n", "expected the end of the line, found `.`",
         "a name that contains a point goes in quotes", None),
        ("QualityReq r\n    on violation: fail\n", "unexpected `:`", None, "QualityReq r\n    on violation fail\n"),
        ("QualityReq r\n    takes: at most 3 s\n", "unexpected `:`", None, "QualityReq r\n    takes at most 3 s\n"),
        ("QualityReq r\n    takes at most: 3 s\n", "unexpected `:`", None, "QualityReq r\n    takes at most 3 s\n"),
        ("QualityReq r\n    takes at most 3 s.\n", "unexpected `.`", None,
         "QualityReq r\n    takes at most 3 s\n"),
        ("QualityReq r\n    takes max 3 s\n", "this bound is written `at most`", None,
         "QualityReq r\n    takes at most 3 s\n"),
        ("QualityReq r\n    in 98 % of runs\n", "a probability is written `in at least 98 %`", None,
         "QualityReq r\n    in at least 98 % of runs\n"),
        ("QualityReq r\n    with probability 98%\n", "a probability is written `with probability >= 98%`", None,
         "QualityReq r\n    with probability >= 98%\n"),
        ("QualityReq r\n    speed <= 3 m/s\n",
         "expected a verb before the condition: `keeps`, `never`, `needs` or `leaves`",
         "`keeps` holds while the node runs, `needs` when it starts, `leaves` when it has succeeded",
         "QualityReq r\n    keeps speed <= 3 m/s\n"),
        ("QualityReq r\n    must take at most 3 s\n", "this clause is written `takes at most 3 s`", None,
         "QualityReq r\n    takes at most 3 s\n"),
        ("QualityReq r\n    max 30 s\n",
         "expected a verb after `max` (takes, succeeds, needs, keeps, …), found `30 s`",
         "an upper bound goes after its verb: `takes at most 30 s`", None),
        ("QualityReq r\n    minimum 1 s\n",
         "expected a verb after `minimum` (takes, succeeds, needs, keeps, …), found `1 s`",
         "a lower bound goes after its verb: `takes at least 1 s`", None),
        ("QualityReq r\n    MoveBase fails at most 3 times\n",
         "expected `per`, and `run` or a node, found the end of the line",
         "the number is that of each run, or of each activation of a node",
         "QualityReq r\n    MoveBase fails at most 3 times per run\n"),
        ("QualityReq r\n    Dock docks fast\n",
         "expected a verb after `Dock` (takes, succeeds, needs, keeps, …), found `docks`",
         "btq reads `Dock` as the subject of a clause; write a verb after it, or begin with a clause word: "
         "in at least, while, on violation, goal, …", None),
        ("QualityReq r\n    battery stays above 3 %\n", "this clause is written `keeps battery > 3 %`", None,
         "QualityReq r\n    keeps battery > 3 %\n"),
        ("QualityReq r\n    Dock is fast\n", VERB + "`is`",
         "what holds while a node runs is written `keeps battery >= 15 %`", None),
        ("QualityReq r\n    responds within 30 s\n", "this clause is written `succeeds within 30 s`", None,
         "QualityReq r\n    succeeds within 30 s\n"),
        ("QualityReq r\n    leaves at least 3 % battery\n", SIGNAL + "`at`",
         "write `leaves battery >= 3 %`", "QualityReq r\n    leaves battery >= 3 %\n"),
        ("QualityReq r\n    leaves no less than 3 % battery\n", SIGNAL + "`no`",
         "write `leaves battery >= 3 %`", "QualityReq r\n    leaves battery >= 3 %\n"),
        ("QualityReq r\n    keeps less than 3 N of force while near\n", SIGNAL + "`less`",
         "write `keeps force < 3 N`", "QualityReq r\n    keeps force < 3 N while near\n"),
        ("QualityReq r\n    keeps wind below 10 m/s\n", "this comparison is written `<`", None,
         "QualityReq r\n    keeps wind < 10 m/s\n"),
        ("QualityReq r\n    leaves water at  least 5 % or a\n", "this comparison is written `>=`", None,
         "QualityReq r\n    leaves water >= 5 % or a\n"),
        ("context c : wind no more than 3 m/s\n", "this comparison is written `<=`", None,
         "context c : wind <= 3 m/s\n"),
        ("QualityReq r\n    docks within 20 s\n",
         "expected a verb after `docks` (takes, succeeds, needs, keeps, …), found `within`",
         "write `succeeds within 30 s`, or `takes at most 30 s`", None),
        ("QualityReq r\n    fails in at least 3 % of runs\n",
         "expected a verb after `fails` (takes, succeeds, needs, keeps, …), found `in`",
         "`fails at most 3 per run` limits the failures, `succeeds` demands that the node does not fail", None),
        ("QualityReq r\n    takes 10 s to 20 s\n",
         "expected a bound: at most, at least, less than, more than or between, found `10 s`",
         "a range is written `between 10 s and 20 s`", None),
        ("QualityReq r\n    otherwise halt\n",
         "expected a verb after `otherwise` (takes, succeeds, needs, keeps, …), found `halt`",
         "write `on violation fail`", None),
        ("QualityReq r\n    succeeds in at least 97 of 200 runs\n", "expected a percentage: 98 %, found `97`", None,
         "QualityReq r\n    succeeds in at least 48.5 % of runs\n"),
        ("QualityReq r\n    succeeds in 97 of 100 runs\n", "expected a percentage: at least 98 %, found `97`", None,
         "QualityReq r\n    succeeds in at least 97 % of runs\n"),
        ("QualityReq r\n    succeeds in at least 9 of 0 runs\n", "expected a percentage: 98 %, found `9`", None,
         "QualityReq r\n    succeeds in at least 9 % of 0 runs\n"),
        ("QualityReq r\n    leaves 3 % battery\n", SIGNAL + "`3 %`", "write `leaves battery >= 3 %`", None),
        ("QualityReq r\n    leaves 3 % <= battery, 3\n", "expected the end of the line, found `,`", None, None),
        ("QualityReq r\n    succeeds 30 s\n", "expected `within`, or the end of the line, found `30 s`",
         "a deadline is written `within 30 s`, a probability `in at least 98 % of runs`",
         "QualityReq r\n    succeeds within 30 s\n"),
        ("QualityReq r\n    within 30 s\n",
         "expected a verb after `within` (takes, succeeds, needs, keeps, …), found `30 s`",
         "write `succeeds within 30 s`, or `takes at most 30 s`", None),
        ('QualityReq r : time behaviour "t"\n', "a quality's name has no spaces", None,
         'QualityReq r : time-behaviour "t"\n'),
        ("QualityReq r\n    keeps a ≤ 3 m and b ≥ 2 m  # ≤\n", "unexpected `≤`", None,
         "QualityReq r\n    keeps a <= 3 m and b >= 2 m  # ≤\n"),
        ("QualityReq r “t ≤ 3”\n", "unexpected `“`", "strings go in straight quotes",
         'QualityReq r "t ≤ 3"\n'),
        ("signal t : °C from {t}\n", "unexpected `°`", None, "signal t : degC from {t}\n"),
        ("signal d [m]\n", "unexpected `[`", "a signal's unit goes after `:`: `signal distance : m`", None),
        ("signal d in m\n", "expected `:` and the signal's unit, found `in`", None, "signal d : m\n"),
        ("context c = d < 3 m\n", "expected `:` and a condition, found `=`", None, "context c : d < 3 m\n"),
        ("BehaviorTree t:\n    A\n", "unexpected `:`", None, "BehaviorTree t\n    A\n"),
        ("BehaviorTree t\n    Sequence:\n        A\n", "unexpected `:`", None,
         "BehaviorTree t\n    Sequence\n        A\n"),
        ("BehaviorTree t\n    - A\n", "unexpected `-` before a node",
         "a node needs no dash; its children go below it, indented", "BehaviorTree t\n    A\n"),
        ("BehaviorTree t\n    Repeat (3)\n        A\n", "expected an attribute: key = value, found `3`",
         "a value goes after the name of its port: `port = 3`", None),
        ("BehaviorTree t\n    A satisfies: b\n", "unexpected `:`", None, "BehaviorTree t\n    A satisfies b\n"),
        ("BehaviorTree t\n    A satisfies b and c\n", "expected `,` instead of `and`", None,
         "BehaviorTree t\n    A satisfies b, c\n"),
        ("BehaviorTree t\n    Fallback {\n        A\n",
         "unexpected `{`: a block consists of indented lines", None,
         "BehaviorTree t\n    Fallback\n        A\n"),
        ("BehaviorTree t\n    A;\n", "unexpected `;`",
         "a line needs no sign at its end; comments begin with `#`", None),
        ("QualityReq r\n    keeps maen(a) < 3\n",
         "expected a function (age, change, count, max, mean, min, p95, stddev), found `maen`", None,
         "QualityReq r\n    keeps mean(a) < 3\n"),
        ("signal a : m conter\n", "expected the end of the line, found `conter`",
         "the order is: signal x : % from {x} level fresh within 5 s initially 100 %", "signal a : m counter\n"),
        ("Action A\n    in b : c\n", "expected a port (input, output or inout), metadata or xml, found `in`", None,
         "Action A\n    input b : c\n"),
        ("Action A\n    input b c\n", "expected `:` and the port's type, found `c`",
         "a port is written `input name : type`", "Action A\n    input b : c\n"),
        ("quality a safety\n", "expected the end of the line, found `safety`",
         "write the quality it belongs to after `:`, and its definition in quotes", None),
        ("<!-- hello -->\n", "a comment begins with `#`", None, "# hello\n"),
    ],
)  # fmt: skip
def test_a_slip_outside_of_trees(text: str, problem: str, note: str | None, mended: str | None) -> None:
    (only,) = parse(text).diagnostics
    assert (only.message, only.notes) == (problem, (note,) if note else ())
    assert [apply_fix(text, fix) for fix in only.fixes] == ([mended] if mended else [])


def test_what_may_be_meant_in_several_ways_has_several_fixes() -> None:
    for clause, words, fixed in (("verified by", "simulation", "analysis test"), ("on violation", "stop", "halt fail")):
        text = f"QualityReq r\n    {clause} {words}\n"
        (only,) = parse(text).diagnostics
        assert [apply_fix(text, fix) for fix in only.fixes] == [text.replace(words, each) for each in fixed.split()]
    text = "QualityReq r calm\n"
    (only,) = parse(text).diagnostics
    assert [apply_fix(text, fix) for fix in only.fixes] == ['QualityReq r "calm"\n', "QualityReq r : calm\n"]
    text = "QualityReq r\n    takes at most 1,000 s\n"
    (only,) = parse(text).diagnostics
    assert [apply_fix(text, fix) for fix in only.fixes] == [text.replace(",", "."), text.replace(",", "")]


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('A (p"q = "r = 3")', '")'),
        ("A ({k}3)satisfies r=)", ")"),
        ('A (include "b"A)satisfies r=)', ")"),
    ],
)
def test_what_would_be_said_instead_of_a_mistake_but_is_not(line: str, said: str) -> None:
    text = f"BehaviorTree t\n    {line}\n"
    (only,) = parse(text).diagnostics
    assert text[only.span.start : only.span.end] == said


@pytest.mark.parametrize("seed", seeds(4))
def test_no_text_in_which_the_lexer_finds_a_mistake_passes(seed: int) -> None:
    chance = random.Random(seed)
    for _ in range(2_000):
        line = "".join(chance.choices(IN_BRACKETS, k=chance.randrange(2, 9)))
        text = f"BehaviorTree t\n    A ({line})\n"
        lexer = Lexer(text)
        while lexer.open_line():
            lexer.scan()
        assert parse(text).diagnostics or not lexer.problems, text


def test_a_lost_quote_before_a_string_that_begins_with_a_sign() -> None:
    text = 'BehaviorTree t\n    ->\n        A (p = "x)\n        B (q = {r})\n        Script (code = "@a := 1")\n'
    parsed = parse(text + '        C (p = "z")\n\nBehaviorTree u\n    D (p = "y")\n')
    (only,) = parsed.diagnostics
    assert (only.rule, only.message, parsed.text[only.span.start : only.span.end]) == ("unclosed-string", LOST, '"x)')


def test_a_line_that_ends_after_from() -> None:
    (only,) = parse("from\n").diagnostics
    assert (only.rule, only.notes) == ("syntax-error", ("a clause goes in the block of a QualityReq, indented",))


def test_xml_below_what_has_no_block_is_part_of_it() -> None:
    (found,) = parse('include "a.btq"\n    xml "<a/>"\nsignal b : m\n').diagnostics
    assert found.message == "unexpected indentation: the line above opens no block"


@pytest.mark.parametrize(
    ("written", "meant"), [("BehaviourTre", "BehaviorTree"), ("Rot", "Root"), ("TreeNodeModel", "TreeNodesModel")]
)
@pytest.mark.parametrize("rest", ["\n", " (a = 1)\n"])
def test_a_misspelt_item_whose_name_is_optional_is_read(written: str, meant: str, rest: str) -> None:
    parsed = parse(written + rest)
    assert [each.message for each in parsed.diagnostics][:1] == [f"unknown word `{written}`; did you mean `{meant}`?"]
    assert type(parsed.entries[0].item) is type(parse(meant + rest).entries[0].item)
