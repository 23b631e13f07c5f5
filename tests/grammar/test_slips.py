"""Slips of newcomers that the parser reads as something else, each with the exact diagnostic that leads on.

The form is that of test_first_mistakes.py; where a fix leaves something to do, that is said in the case.
"""

from __future__ import annotations

from typing import Final

import pytest
from check_asserts import after, problems, show, workspace_of
from safe_fixes import unwanted
from test_first_mistakes import OTHER, Case, R, S, mistakes, requirement, tree

from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.grammar.cursor import shown
from btq_lang.parser import parse
from btq_lang.syntax.tree import quote

BELOW: Final = "a child goes on a line of its own below its parent, indented"
CHILDREN: Final = "children go on lines of their own below their parent, indented"
NO_TYPE: Final = (
    "a signal has a unit, not a type | write the unit of its values: `m/s`, `s`, `%`, …; or `1` if they have none"
)
UNITS: Final = "a unit is `m/s`, `s`, `%`, `bool`, `text` or `1`"
TO_PORT: Final = "a value goes after the name of its port:"
_CHOICE: Final = "v > 1 m/s ? 60 s : 30 s"
_UNLESS: Final = ("unless v > 1 m/s and v < 2 m/s", "while not (v > 1 m/s and v < 2 m/s)")
KEEPS: Final = tree("Go satisfies r") + "QualityReq r\n    keeps "


def label(word: str, kind: str) -> str:
    return f"btq reads `{word}` as the label of `{kind}`; {BELOW}"


def foreign(written: str, meant: str) -> str:
    return f"`{written}` is not built into BehaviorTree.CPP 4.6–4.10; did you mean `{meant}`?"


ON_ONE_LINE: Final[list[Case]] = [
    (
        tree("->", "    not Dark", "    Go"),
        f"3:9 warning not-an-engine-node «not» {foreign('not', 'Inverter')} | {label('Dark', 'not')}",
        tree("->", "    Inverter", "        Dark", "    Go"),
    ),
    (
        "Action Go\n" + tree("->", "    Invert Dark", "    Go"),
        f"4:9 warning not-an-engine-node «Invert» {foreign('Invert', 'Inverter')} | {label('Dark', 'Invert')}",
        "Action Go\n" + tree("->", "    Inverter", "        Dark", "    Go"),
    ),
    (
        tree("Selector Go"),
        f"2:5 warning not-an-engine-node «Selector» {foreign('Selector', 'Fallback')} | {label('Go', 'Selector')}",
        tree("Fallback", "    Go"),
    ),
    (
        tree("Not Near (at = 3)"),
        f"2:5 warning not-an-engine-node «Not» {foreign('Not', 'Inverter')} | {label('Near', 'Not')}",
        tree("Inverter", "    Near (at = 3)"),
    ),
    (
        tree("->", "    !Dark", "    Go"),
        "3:9 error syntax-error «!» expected a node: its kind, or a symbol: -> ? || …, found `!` | "
        "to negate a node, put an `Inverter` above it, and indent the node",
        tree("->", "    Inverter", "        Dark", "    Go"),
    ),
    (
        tree("Inverter Dark"),
        "2:5 error child-count «Inverter» `Inverter` requires exactly 1 child, found none | "
        f"{label('Dark', 'Inverter')}",
        tree("Inverter", "    Dark"),
    ),
    (
        "Action Greet\n" + tree("-> Greet"),
        f"3:5 error child-count «->» `->` requires 1 or more children, found none | {label('Greet', '->')}",
        "Action Greet\n" + tree("->", "    Greet"),
    ),
    (
        tree("Repeat Go (num_cycles = 3)"),  # the brackets are those of Repeat
        f"2:5 error child-count «Repeat» `Repeat` requires exactly 1 child, found none | {label('Go', 'Repeat')}",
        None,
    ),
    (
        tree("? Go, Turn  # or turn"),
        f"2:9 error syntax-error «,» {CHILDREN}",
        tree("?", "    Go", "    Turn  # or turn"),
    ),
    (tree("Sequence Go Turn"), f"2:17 error syntax-error «Turn» {CHILDREN}", tree("Sequence", "    Go", "    Turn")),
    (
        tree("Timeout (msec = 30 s) Go"),
        f"2:27 error syntax-error «Go» {BELOW}",
        tree("Timeout (msec = 30 s)", "    Go"),
    ),
    (
        tree("->", "    Retry (num_attempts = 3)", "    Go", "    Turn"),
        f"3:9 error child-count «Retry» `Retry` requires exactly 1 child, found none | {BELOW}",
        tree("->", "    Retry (num_attempts = 3)", "        Go", "    Turn"),
    ),
    (
        tree("Go (a = 1) if far"),
        "2:16 error syntax-error «if» expected the end of the line, found `if` | "
        "a node that runs only if something holds goes below a Precondition, or after a Condition in a Sequence `->`",
        None,
    ),
    (
        tree("->", '    include "other.btq"', "    Go"),
        "3:9 warning unknown-node «include» an include goes outside of trees, at the start of a line",
        None,
    ),
    (
        tree("while", "    Near", "    Go"),
        f"2:5 warning not-an-engine-node «while» {foreign('while', 'WhileDoElse')} | its first child is the condition",
        tree("WhileDoElse", "    Near", "    Go"),
    ),
    (tree("Retry (num_attempts = 3) Inverter", "    Go"), f"2:30 error syntax-error «Inverter» {BELOW}", None),
]

VALUES: Final[list[Case]] = [
    (
        tree("Timeout 30 s", "    Go"),
        f"2:13 error syntax-error «30 s» expected the end of the line, found `30 s` | {TO_PORT} `(msec = 30 s)`",
        tree("Timeout (msec = 30 s)", "    Go"),
    ),
    (
        tree("Timeout 30", "    Go"),
        "2:13 error syntax-error «30» expected the end of the line, found `30` | "
        f"{TO_PORT} `(msec = 30)`, or with a unit, `(msec = 30 s)`",
        None,
    ),
    (
        tree("Retry {n}", "    Go"),
        "2:11 error syntax-error «{n}» expected the end of the line, found `{n}` | "
        f"{TO_PORT} `(num_attempts = {{n}})`",
        tree("Retry (num_attempts = {n})", "    Go"),
    ),
    (
        tree('Repeat "again" 3', "    Go"),
        f"2:20 error syntax-error «3» expected the end of the line, found `3` | {TO_PORT} `(num_cycles = 3)`",
        tree('Repeat "again" (num_cycles = 3)', "    Go"),
    ),
    (
        tree("Sleep 500 ms"),
        f"2:11 error syntax-error «500 ms» expected the end of the line, found `500 ms` | {TO_PORT} `(msec = 500 ms)`",
        tree("Sleep (msec = 500 ms)"),
    ),
    (
        "Action Go\n    input station\n" + tree("Go {dock}"),
        "4:8 error syntax-error «{dock}» expected the end of the line, found `{dock}` | "
        f"{TO_PORT} `(station = {{dock}})`",
        "Action Go\n    input station\n" + tree("Go (station = {dock})"),
    ),
    (
        tree('Precondition "x > 3"', "    Go"),
        "2:5 error missing-port «Precondition» `Precondition` requires a value for its port `if` | "
        '`if`: the condition | btq reads `"x > 3"` as its label; for a value, write `(if = "x > 3")`',
        tree('Precondition (if = "x > 3")', "    Go"),
    ),
    (
        tree("Precondition (x > 3)", "    Go"),
        f'2:19 error syntax-error «x» expected an attribute: key = value, found `x` | {TO_PORT} `if = "x > 3"`',
        tree('Precondition (if = "x > 3")', "    Go"),
    ),
    (
        tree("Script (x := 3)"),
        f'2:15 error syntax-error «:=» expected `=` between key and value, found `:=` | {TO_PORT} `code = "x := 3"`',
        tree('Script (code = "x := 3")'),
    ),
]

_QUOTED: Final = "error syntax-error «{}» a script goes in quotes after the name of its port: `({})`"
SCRIPTS: Final[list[Case]] = [
    *(
        (
            tree(f"{node} {written}"),
            f"2:{6 + len(node) + at} {_QUOTED.format(pointed, port)}",
            tree(f"{node} ({port})"),
        )
        for node, written, at, pointed, port in (
            ("Script", "x = 3", 0, "x = 3", 'code = "x := 3"'),
            ("Script", "x := 3", 2, ":", 'code = "x := 3"'),
            ("Script", "x:=3", 1, ":", 'code = "x := 3"'),
            ("Script", "@x := 3", 0, "@", 'code = "@x := 3"'),
            ("Script", "x = 'a b'", 0, "x = 'a b'", "code = \"x := 'a b'\""),
            ("ScriptCondition", "x = 3", 0, "x = 3", 'code = "x == 3"'),
            ("ScriptCondition", "x > 3", 2, ">", 'code = "x > 3"'),
        )
    ),
    (
        tree("Script (code = x := 3)"),
        '2:22 error syntax-error «:» a script goes in quotes: `code = "x := 3"`',
        tree('Script (code = "x := 3")'),
    ),
    (
        tree("Go (_skipIf = hold == 1)"),
        '2:24 error syntax-error «==» a script goes in quotes: `_skipIf = "hold == 1"`',
        tree('Go (_skipIf = "hold == 1")'),
    ),
    (
        tree("Go (_while = !hold, a = 1)"),
        '2:18 error syntax-error «!» a script goes in quotes: `_while = "!hold"`',
        tree('Go (_while = "!hold", a = 1)'),
    ),
    (
        tree("Precondition (if = hold > 3)", "    Go"),
        '2:29 error syntax-error «>» a script goes in quotes: `if = "hold > 3"`',
        tree('Precondition (if = "hold > 3")', "    Go"),
    ),
    *(
        (
            tree(f"Go ({written})"),
            f"2:{written.index('=') + 11} error syntax-error «{written.split(' = ', 1)[1]}» "
            "unexpected text right after a string | "
            "write a quote in a string as \\\", in a script as '",
            tree(f"Go ({meant})"),
        )
        for written, meant in (
            ('a = "the "red" box"', "a = \"the 'red' box\""),
            ('_onSuccess = "b := "hello""', "_onSuccess = \"b := 'hello'\""),
        )
    ),
    (
        tree("Script (x = 3)"),
        '2:13 error unknown-port «x» `Script` has no port `x`; did you mean `code = "x := 3"`? | it has `code`',
        tree('Script (code = "x := 3")'),
    ),
    (
        tree('Script (code = "msg := hello")'),
        "2:28 hint misspelt-entry «hello» a script reads `hello` as an entry, which nothing here sets | "
        "a text goes in single quotes: `'hello'`",
        tree("Script (code = \"msg := 'hello'\")"),
    ),
]

SIGNS: Final[list[Case]] = [
    *(
        (
            tree(*lines),
            f"{place} error syntax-error «{sign}» unexpected `{sign}` | a node is written `kind name`",
            tree(*mended),
        )
        for place, sign, lines, mended in (
            ("2:13", ":", ("Sequence: Rows", "    Go"), ("Sequence Rows", "    Go")),
            ("2:14", ":", ("Fallback : Photo", "    Go"), ("Fallback Photo", "    Go")),
            ("2:14", "=", ("Fallback = Photo", "    Go"), ("Fallback Photo", "    Go")),
        )
    ),
    *(
        (
            f"Action Go\n    input at\n{tree('->', f'    {written}')}",
            f"5:{9 + at} error syntax-error «{span}» {message}",
            f"Action Go\n    input at\n{tree('->', '    Go Home (at = 3)')}",
        )
        for written, at, span, message in (
            ("Go: Home (at = 3)", 2, ":", "unexpected `:` | a node is written `kind name`"),
            ("Home: Go (at = 3)", 0, "Home: Go", "a node's name goes after its kind: `Go Home (…)`"),
            ("Home = Go (at = 3)", 0, "Home = Go", "a node's name goes after its kind: `Go Home (…)`"),
        )
    ),
    (
        tree("->", "    Home: AlwaysSuccess  # later"),
        "3:9 error syntax-error «Home: AlwaysSuccess» a node's name goes after its kind: `AlwaysSuccess Home`",
        tree("->", "    AlwaysSuccess Home  # later"),
    ),
]

OTHER_WORDS: Final[list[Case]] = [
    (
        tree('Go Home place="home" at = 3'),
        '2:13 error syntax-error «place="home" at = 3» attributes go in brackets: `(key = value)`',
        tree('Go Home (place="home" at = 3)'),
    ),
    *(
        (
            tree(f"{word} row : string", "Go (at = {row})"),
            f"2:5 error syntax-error «{word}» a port of a tree is written `input row : type`",
            tree("input row : string", "Go (at = {row})"),
        )
        for word in ("param", "parameter", "argument")
    ),
    (
        'Action Go\n    input at : string default "home"\n' + tree("Go"),
        '2:23 error syntax-error «default» a default is written `= "home"`',
        'Action Go\n    input at : string = "home"\n' + tree("Go"),
    ),
    *(
        (
            requirement("takes at most 40 s", f"goal {bound} 30 s"),
            f"5:10 error syntax-error «{bound}» a goal is a value: `goal 30 s`",
            requirement("takes at most 40 s", "goal 30 s"),
        )
        for bound in ("at most", "<=")
    ),
]

SIGNALS: Final[list[Case]] = [
    *(
        (
            f"signal v : {type_} from {{v}}\n" + tree("Go"),
            f"1:12 error unknown-unit «{type_}» unknown unit `{type_}`: {NO_TYPE}",
            None,
        )
        for type_ in (
            *("double", "float64", "int", "uint8_t", "unsigned int", "size_t", "long", "list"),
            *("std_msgs/Float32", "std_msgs::msg::Float64", "geometry_msgs/Twist", "std::vector<double>"),
        )
    ),
    (
        "signal lit : std_msgs/Bool from {v}\n" + KEEPS + "lit\n",
        "1:14 error unknown-unit «std_msgs/Bool» unknown unit `std_msgs/Bool`; did you mean `bool`?",
        "signal lit : bool from {v}\n" + KEEPS + "lit\n",
    ),
    (
        "signal v : velocity from {v}\n" + KEEPS + "v < 1 m/s\n",
        "1:12 error unknown-unit «velocity» unknown unit `velocity`; did you mean `m/s`?",
        "signal v : m/s from {v}\n" + KEEPS + "v < 1 m/s\n",
    ),
    (
        requirement("takes at most 30 s").replace("QualityReq r", "QualityReq r (n : double = 3)"),
        "3:19 error unknown-unit «double» unknown unit `double`: " + NO_TYPE.replace("signal", "parameter"),
        None,
    ),
    (
        "signal v = {v}\n" + tree("Go"),
        "1:10 error syntax-error «=» expected `:` and the signal's unit, found `=` | "
        f"write `signal v : <unit> from {{v}}`; {UNITS}",
        None,
    ),
    (
        "signal v from {v}\n" + tree("Go"),
        "1:10 error syntax-error «from» expected `:` and the signal's unit, found `from` | "
        f"write `signal v : <unit> from {{v}}`; {UNITS}",
        None,
    ),
    (
        "signal double v\n" + tree("Go"),
        "1:15 error syntax-error «v» expected `:` and the signal's unit, found `v` | "
        f"write `signal v : <unit> from {{v}}`; {UNITS}",
        None,
    ),
    (
        'signal from "/v"\n' + tree("Go"),
        "1:8 error syntax-error «from» expected the signal's name, found `from` | "
        f"write `signal battery : <unit> from {{battery}}`; {UNITS}",
        None,
    ),
    (
        "signal v : m/s = {v}\n" + KEEPS + "v < 1 m/s\n",
        "1:16 error syntax-error «=» expected `from`, found `=`",
        "signal v : m/s from {v}\n" + KEEPS + "v < 1 m/s\n",
    ),
]

OF_A_SIGNAL: Final = "signal v : m/s from {v}\n" + tree("Go satisfies r") + "QualityReq r\n    "
PROSE: Final[list[Case]] = [
    *(
        (
            requirement(prose),
            f"4:{5 + prose.index(slip)} error syntax-error «{slip}» this clause is written `{meant}`",
            requirement(meant),
        )
        for prose, slip, meant in (
            ("shall take at most 30 s", "shall take", "takes at most 30 s"),
            ("must takes at most 30 s", "must takes", "takes at most 30 s"),
            ("has to take at most 30 s", "has to take", "takes at most 30 s"),
            ("needs to take at most 30 s", "needs to take", "takes at most 30 s"),
            ("should be reached within 30 s", "should be reached within", "succeeds within 30 s"),
            ("Go should be done within 30 s", "should be done within", "Go succeeds within 30 s"),
            ("arrives within 30 s", "arrives within", "succeeds within 30 s"),
            ("Main/Go shall not exceed 30 s", "shall not exceed", "Main/Go takes at most 30 s"),
            ("must not take longer than 30 s", "must not take longer than", "takes at most 30 s"),
            ("Go must not fail", "must not fail", "Go succeeds"),
            ("mission must take at most 1 h", "must take", "mission takes at most 1 h"),
            ("mission needs to take at most 1 h", "needs to take", "mission takes at most 1 h"),
            ("every Go shall not exceed 30 s", "shall not exceed", "every Go takes at most 30 s"),
            ("sum of Go, Go must take at most 3 s", "must take", "sum of Go, Go takes at most 3 s"),
        )
    ),
    *(
        (
            OF_A_SIGNAL + prose + "\n",
            f"5:{5 + prose.index(slip)} error syntax-error «{slip}» this clause is written `{meant}`",
            OF_A_SIGNAL + prose.replace(slip, meant) + "\n",
        )
        for prose, slip, meant in (
            ("takes at most 30 s unless v > 1 m/s", "unless v > 1 m/s", "while not v > 1 m/s"),
            ("takes at most 30 s unless v > 1 m/s and v < 2 m/s on violation warn", *_UNLESS),
        )
    ),
    *(
        (
            OF_A_SIGNAL + prose + "\n",
            f"5:5 error syntax-error «{slip}» this clause is written `{meant}`",
            OF_A_SIGNAL + meant + "\n",
        )
        for prose, slip, meant in (
            ("v must stay below 1 m/s", "v must stay below", "keeps v < 1 m/s"),
            ("v must be at least 1 m/s", "v must be at least", "keeps v >= 1 m/s"),
            ("v shall not exceed 1 m/s", "v shall not exceed", "keeps v <= 1 m/s"),
            ("v is below 1 m/s", "v is below", "keeps v < 1 m/s"),
        )
    ),
    *(
        (
            OF_A_SIGNAL + f"{subject} {prose}\n",
            f"5:{6 + len(subject)} error syntax-error «{prose.removesuffix(' 1 m/s')}» "
            f"this clause is written `{subject} keeps v < 1 m/s`",
            OF_A_SIGNAL + f"{subject} keeps v < 1 m/s\n",
        )
        for subject in ("Go", "Main/Go", "every Go", "mission")
        for prose in ("v stays below 1 m/s", "v must be less than 1 m/s")
    ),
    *(
        (
            OF_A_SIGNAL + f"{subject}v < 1 m/s\n",
            f"5:{5 + len(subject)} error syntax-error «v <» expected a verb before the condition: "
            "`keeps`, `never`, `needs` or `leaves` | "
            "`keeps` holds while the node runs, `needs` when it starts, `leaves` when it has succeeded",
            OF_A_SIGNAL + f"{subject}keeps v < 1 m/s\n",
        )
        for subject in ("", "Go ", "every Go ", "mission ")
    ),
    (
        OF_A_SIGNAL + "takes at most 30 s\n    if v > 1 m/s\n",
        "6:5 error syntax-error «if v > 1 m/s» a clause has no `if` | "
        "to limit a clause to a situation, write `while v > 1 m/s` or `when v > 1 m/s`",
        None,
    ),
    (
        requirement("takes at most 30 s", "on timeout retry"),
        "5:8 error syntax-error «timeout» expected `violation`, found `timeout` | "
        "`on violation` is followed by fail, halt, warn or log; to try again, put a Retry around the node",
        None,
    ),
    *(
        (
            OF_A_SIGNAL + f"{clause} {choice}\n",
            f"5:{6 + len(clause)} error syntax-error «{choice}» a choice is written `{meant}`",
            OF_A_SIGNAL + f"{clause} {meant}\n",
        )
        for clause, choice, meant in (
            ("takes at most", "v > 1 m/s ? 60 s : 30 s", "60 s if v > 1 m/s else 30 s"),
            ("takes at most", "(v > 1 m/s) ? 60 s : 30 s", "60 s if (v > 1 m/s) else 30 s"),
            ("takes at most", "if v > 1 m/s then 60 s else 30 s", "60 s if v > 1 m/s else 30 s"),
            ("succeeds within", "v > 1 m/s ? 60 s : 30 s", "60 s if v > 1 m/s else 30 s"),
            ("takes at most 90 s goal", "v > 1 m/s ? 60 s : 30 s", "60 s if v > 1 m/s else 30 s"),
        )
    ),
    (
        "signal v : m/s from {v}\n" + requirement("takes at most n").replace("r\n ", f"r (n : s = {_CHOICE})\n "),
        f"4:23 error syntax-error «{_CHOICE}» a choice is written `60 s if v > 1 m/s else 30 s`",
        "signal v : m/s from {v}\n"
        + requirement("takes at most n").replace("r\n ", "r (n : s = 60 s if v > 1 m/s else 30 s)\n "),
    ),
    (
        requirement("takes at most Go ? (30 s) : 3 s"),
        "4:19 error syntax-error «Go» expected a value, found `Go` | "
        "a choice is written `60 s if battery_low else 30 s`",
        None,
    ),
]

_FAILURE: Final = "`succeeds within` is violated by a failure too, `takes at most` is not"
_ANEW: Final = "`Place follows Pick succeeds` asks for another success of Pick before each start of Place"
_USED: Final = "a signal whose use is limited is a `counter` or a `level`: `signal energy : Wh from {energy} counter`"
_SITUATION: Final = "`while` counts the time in which it holds, `when` the activations at whose start it holds"
_SIGNAL: Final = "a name alone is a signal or context: `signal latency : s from {latency}`"
# A clause, how it is written here (the first is the likeliest), and the note.
CLAUSES: Final[list[tuple[str, tuple[str, ...], str]]] = [
    *(
        (clause, ("succeeds within 30 s",), "")
        for clause in ("succeeds in 30 s", "succeeds by 30 s", "succeeds within at most 30 s", "done within 30 s")
    ),
    ("Go succeeds in under 30 s", ("Go succeeds within 30 s",), ""),
    *(
        (clause, ("mission succeeds within 1 h", "mission takes at most 1 h"), _FAILURE)
        for clause in ("mission finishes within 1 h", "mission ends within 1 h", "mission is finished in less than 1 h")
    ),
    (
        "every Go finishes within 40 s",
        ("every Go succeeds within 40 s", "every Go takes at most 40 s"),
        _FAILURE,
    ),
    ("is finished in 40 s", ("succeeds within 40 s", "takes at most 40 s"), _FAILURE),
    ("mission duration <= 1 h", ("mission takes at most 1 h",), ""),
    ("every Go runs at 10 Hz", ("every Go runs at least 10 per 1 s",), ""),
    ("every Go ends before Turn", ("mission never node Turn from mission starts until <node> finishes",), _ANEW),
    ("Go succeeds 95 % of runs", ("Go succeeds in at least 95 % of runs",), ""),
    *(
        (clause, ("succeeds within 30 s", "takes at most 30 s"), _FAILURE)
        for clause in ("finishes within 30 s", "completes within 30 s", "ends before 30 s", "must finish in 30 s")
    ),
    ("Go must finish in 30 s", ("Go succeeds within 30 s", "Go takes at most 30 s"), _FAILURE),
    ("response time < 200ms", ("takes less than 200ms",), ""),
    ("the reaction time is at most 200 ms", ("takes at most 200 ms",), ""),
    ("execution time of Go <= 3 s", ("Go takes at most 3 s",), ""),
    ("maximum duration: 30 s", ("takes at most 30 s",), ""),
    ("timeout 30 s", ("takes at most 30 s",), ""),
    ("deadline = 30 s", ("succeeds within 30 s",), ""),
    ("latency < 200 ms", ("takes less than 200 ms", "keeps latency < 200 ms"), _SIGNAL),
    ("runs every 2 Hz", ("runs at least 2 per 1 s",), ""),
    ("runs at 10 Hz", ("runs at least 10 per 1 s",), ""),
    ("runs at most 2 Hz", ("runs at most 2 per 1 s",), ""),
    ("Go is called 3 times per minute", ("Go runs at least 3 per 1 min",), ""),
    ("runs at least 10 per second", ("runs at least 10 per 1 s",), ""),
    ("runs once every 2 s", ("runs every 2 s",), ""),
    ("runs once per hour", ("runs at least 1 per 1 h",), ""),
    ("update rate > 10 Hz", ("runs more than 10 per 1 s",), ""),
    ("period <= 100 ms", ("runs every 100 ms",), ""),
    ("retries at most 3", ("tries at most 3",), ""),
    ("average execution time of Go <= 30 s", ("Go takes at most 30 s on average",), ""),
    ("takes on average at most 30 s", ("takes at most 30 s on average",), ""),
    ("uses on average less than 3 m of way", ("uses less than 3 m of way on average",), ""),
    ("mean time between failures at least 200 h", ("fails at most 1 per 200 h",), ""),
    ("MTBF >= 200 h", ("fails at most 1 per 200 h",), ""),
    ("failures <= 2", ("fails at most 2 per run",), ""),
    ("number of successes at least 12", ("succeeds at least 12 per run",), ""),
    *(
        (clause, ("succeeds in at least 95 % of activations", "succeeds in at least 95 % of runs"), "")
        for clause in ("success rate >= 95 %", "succeeds 95 % of the time", "succeeds at least 95 %")
    ),
    *(
        (clause, ("in at least 95 % of time",), "")
        for clause in ("at least 95 % of the time", "for 95 % of its time", "during at least 95 % of time")
    ),
    (
        "availability >= 98 %",
        ("keeps <signal> in at least 98 % of time", "succeeds in at least 98 % of runs"),
        "the first is a share of the time, of a signal that is true while it is available",
    ),
    *(
        (clause, ("over last 200 activations",), "")
        for clause in (
            *("window 200 activations", "window of 200 activations", "over 200 activations", "last 200 activations"),
            *("in the last 200 activations", "sliding window: 200 activations", "over the past 200 activations"),
        )
    ),
    ("window 200", ("over last 200 activations", "over last 200 runs"), ""),
    ("sliding window 1 h", ("over last 1 h",), ""),
    ("during lit", ("while lit",), ""),
    ("as long as v > 1 m/s", ("while v > 1 m/s",), ""),
    ("provided that lit", ("while lit", "when lit"), _SITUATION),
    ("only when lit or v > 1 m/s", ("while lit or v > 1 m/s", "when lit or v > 1 m/s"), _SITUATION),
    ("until lit", ("while not lit",), ""),
    ("except when lit", ("while not lit",), ""),
    ("Go ends before Turn starts", ("mission never node Turn from mission starts until Go finishes",), _ANEW),
    ("Go must precede Turn", ("mission never node Turn from mission starts until Go succeeds",), _ANEW),
    ("Go -> Turn", ("mission never node Turn from mission starts until Go succeeds",), _ANEW),
    ("ends before Turn starts", ("mission never node Turn from mission starts until <node> finishes",), _ANEW),
    ("starts after Turn fails", ("follows Turn fails",), ""),
    (
        "Go runs after Turn",
        ("Go follows Turn succeeds", "Go follows Turn finishes"),
        "`finishes` is a success or a failure",
    ),
    ("uses at most 20 m", ("uses at most 20 m of <signal>",), _USED),
    ("uses at most 5", ("uses at most 5 of <signal>",), _USED),
    ("uses at most 20 m way", ("uses at most 20 m of way",), ""),
    ("consumes <= 20 m from way", ("uses at most 20 m of way",), ""),
    ("uses way at most 20 m", ("uses at most 20 m of way",), ""),
    ("uses 20 m of way", ("uses at most 20 m of way",), ""),
]
AMONG_PORTS: Final = "expected a port (input, output or inout), metadata or xml, found"
MEMORY: Final = (
    "a Sequence or Fallback goes on with the child that is running; "
    "a ReactiveSequence or ReactiveFallback begins with the first one at every tick"
)
OF_OTHER_LIBRARIES: Final[list[Case]] = [
    (
        tree("Sequence (memory = True)", "    Go"),
        f"2:15 error unknown-port «memory» `Sequence` has no port `memory` | it has no ports | {MEMORY}",
        None,
    ),
    (
        tree("Retry (num_attempts = 3, delay = 2)", "    Go"),
        "2:30 error unknown-port «delay» `Retry` has no port `delay` | it has `num_attempts` | "
        "to wait before each attempt, put a Delay around its child",
        None,
    ),
    (
        tree("Parallel (policy = all)", "    Go"),
        "2:15 error unknown-port «policy» `Parallel` has no port `policy` | it has `success_count`, `failure_count` | "
        "`success_count` says how many children must succeed, and -1 is all of them",
        None,
    ),
    (
        tree("? (timeout = 3 s)", "    Go"),
        "2:8 error unknown-port «timeout» `?` has no port `timeout` | it has no ports | "
        "to limit its time, put a Timeout around it",
        None,
    ),
    *(
        (
            f"Action Go\n    {port}\n" + tree("Go (p = {p})"),
            f"2:5 error syntax-error «{word}» {AMONG_PORTS} `{word}` | a port is written `input name : type`",
            mended and f"Action Go\n    {mended}\n" + tree("Go (p = {p})"),
        )
        for port, word, mended in (
            ("InputPort<std::string> p", "InputPort", "input p : std::string"),
            ('BT::OutputPort<std::vector<int>>("p")', "BT", 'output p : "std::vector<int>"'),
            ("BidirectionalPort p  # both ways", "BidirectionalPort", "inout p  # both ways"),
            ("std::string p", "std", "input p : std::string"),
            ("double p", "double", "input p : double"),
            ('InputPort<int>("p", 3, "how many")', "InputPort", None),
        )
    ),
]


@pytest.mark.parametrize(
    ("text", "fixed"),
    [
        (tree("Go [x = 3, y = {a}] satisfies r") + R, tree("Go (x = 3, y = {a}) satisfies r") + R),
        (tree('Go {x = "a b", y = {a}}'), tree('Go (x = "a b", y = {a})')),
        (tree("Go x = 3, y = {a}"), tree("Go (x = 3, y = {a})")),
        (tree("Go satisfies [r, s]") + R + S, tree("Go satisfies r, s") + R + S),
        (tree("Other") + OTHER, tree("SubTree Other") + OTHER),
        (tree("Go") + "apply r to all Go\n" + R, tree("Go") + "apply r to every Go\n" + R),
        # what may be meant otherwise is not written:
        (tree("SubTree (Other)") + OTHER, None),  # a tree that may not exist
        (tree("Go [x = 3; y = 4]"), None),
        (tree("Go [x = a b]"), None),
        (tree("Go (x = 3) [y = 4]"), None),
        (tree("Go x = 3 s"), None),
        (tree("Other (x = 3)") + OTHER, None),
        (tree("Other") + "BehaviorTree Other\n    input x\n    Go (x = {x})\n", None),
        (tree("Other") + "BehaviorTree Other\n    SubTree Main\n", None),
    ],
)
def test_what_a_check_mends_by_itself(text: str, fixed: str | None) -> None:
    safe = [fix for found in mistakes(text) for fix in found.fixes if fix.safe]
    assert [after(text, fix) for fix in safe] == ([fixed] if fixed else [])
    assert list(unwanted(text)) == []


@pytest.mark.parametrize(
    ("text", "said", "mended"),
    [*ON_ONE_LINE, *VALUES, *SCRIPTS, *SIGNS, *OTHER_WORDS, *SIGNALS, *PROSE, *OF_OTHER_LIBRARIES],
)
def test_a_slip_is_one_diagnostic(text: str, said: str, mended: str | None) -> None:
    found = mistakes(text)
    assert [" | ".join((line, *found[0].notes)) for line in show(text, found)] == [said]
    assert [after(text, fix) for fix in found[0].fixes] == ([mended] if mended else [])
    assert [each for each in mistakes(mended or "") if each.rule != "unset-entry"] == []  # programs may set entries


SELECTORS: Final = (
    "write `every` and an ID or kind, `every MoveBase`; `every node tagged …`; or list the nodes, with `,` between them"
)
TARGETS: Final = (
    tree("->", "    Go Home", "    SubTree Bye")
    + "BehaviorTree Bye\n    ->\n        Go Out\n"
    + requirement("succeeds")[len(tree("Go satisfies r")) :]
)


@pytest.mark.parametrize(
    ("targets", "slip", "message", "mended"),
    [
        *(
            (f"Main{sign}Home", sign, "the names of a path are separated by `/`", "Main/Home")
            for sign in (".", "::", "->", ":")
        ),
        *(
            (f"every Go {word} Home", word, f"expected `except`, found `{word}`", "every Go except Home")
            for word in ("but", "without", "but not", "except for", "other than", "excluding")
        ),
        *(
            (f"every Go {word} Bye", word, f"expected `under`, found `{word}`", "every Go under Bye")
            for word in ("in", "of", "inside", "within", "below")
        ),
    ],
)
def test_a_selector_in_other_words(targets: str, slip: str, message: str, mended: str) -> None:
    text = f"apply r to {targets}\n{TARGETS}"
    found = mistakes(text)
    column = len("apply r to ") + targets.index(slip) + 1
    assert show(text, found) == [f"1:{column} error syntax-error «{slip}» {message}"]
    assert [after(text, fix) for fix in found[0].fixes] == [f"apply r to {mended}\n{TARGETS}"]
    assert mistakes(after(text, found[0].fixes[0])) == []


@pytest.mark.parametrize(
    ("targets", "rule", "message"),
    [
        *((all_, "syntax-error", "no selector names all nodes") for all_ in ("*", "every", "every *", "all nodes")),
        ("all", "unmatched-path", "unknown node `all`"),
        ("everything", "unmatched-path", "unknown node `everything`"),
        ("every node", "unmatched-path", "no node matches `every node`"),
        ("every Action", "unmatched-path", "no node matches `every Action`"),
    ],
)
def test_a_selector_of_all_nodes(targets: str, rule: str, message: str) -> None:
    found = [each for each in mistakes(f"apply r to {targets}\n{TARGETS}") if each.rule in (rule, "syntax-error")]
    assert [(each.rule, each.message, each.notes, each.fixes) for each in found] == [(rule, message, (SELECTORS,), ())]


def test_a_node_that_is_called_all_is_one() -> None:
    assert mistakes("apply r to all, everything\n" + TARGETS.replace("Home", "all").replace("Out", "everything")) == []


def test_a_path_with_a_wildcard() -> None:
    (found,) = [each for each in mistakes("apply r to Main/*\n" + TARGETS) if each.rule == "misplaced-comment"]
    assert found.notes == ("the nodes below another are selected with `every <node> under Main`",)
    assert found.fixes == ()


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("person_near", ("people_near",)),
        ("near_people", ("people_near",)),
        ("person-near", ("people_near",)),
        ("not people", ("people_near",)),
        ("robot_docked", ()),
    ],
)
def test_a_context_with_a_word_of_another(written: str, meant: tuple[str, ...]) -> None:
    of = "signal far : m from {far}\ncontext people_near : far < 1 m\ncontext raining : far > 1 m and not people_near\n"
    text = f"{of}{requirement('takes at most 3 s', f'while {written}', 'when raining')}"
    (found,) = [each for each in mistakes(text) if each.rule == "unknown-signal"]
    name = written.removeprefix("not ")
    assert found.message == f"unknown signal `{name}`" + "".join(f"; did you mean `{each}`?" for each in meant)
    assert found.notes == (f"{'or ' if meant else ''}declare it: `signal {name} : bool from {{{name}}}`",)
    assert [after(text, fix) for fix in found.fixes] == [text.replace(f" {name}\n", f" {each}\n") for each in meant]


ELSE: Final = "a Fallback `?` runs its next child after a failure, and the third child of an IfThenElse is its `else`"
THEN: Final = "a Sequence `->` runs its children one after another"
WITH_MEMORY: Final = (
    "`->` goes on with the child that is running; `M->` goes on with the one that failed too, when it is ticked again"
)
OF_FALLBACK: Final = "`?` goes on with the child that is running; `R?` begins with the first one at every tick"
UNITS_OF_SCRIPTS: Final = "a script has numbers without units"
NO_NODES: Final[list[tuple[str, str, tuple[str, ...]]]] = [
    *(
        (f"{word} Go", f"3:9 warning unknown-node «{word}» there is no `{word}`: {how}", ("Go",))
        for word, how in (("else", ELSE), ("otherwise", ELSE), ("catch", ELSE), ("then", THEN), ("finally", THEN))
    ),
    ("else", f"3:9 warning unknown-node «else» there is no `else`: {ELSE}", ()),
    (
        "else:",
        "3:9 error syntax-error «else» expected a node, found the statement `else` | "
        "to choose, use a Fallback `?` with a Condition, or `_skipIf` on the node",
        (),
    ),
    *(
        (
            line,
            f"3:9 error syntax-error «{line}» a condition is not a node: "
            f"write `{shown(f'ScriptCondition (code = {quote(code)})')}`",
            (f"ScriptCondition (code = {quote(code)})",),
        )
        for line, code in (
            ("battery > 20", "battery > 20"),
            ("{battery} >= 20", "battery >= 20"),
            ("20 < {@battery}", "20 < @battery"),
            ("if x != 3", "x != 3"),
            ("Condition x == 3", "x == 3"),
            ("(x > 3)", "(x > 3)"),
            ("x > 3 and lit", "x > 3 && lit"),
        )
    ),
    (
        "battery > 20 %",
        f'3:9 error syntax-error «battery > 20 %» a condition is not a node: write `ScriptCondition (code = "…")` | '
        f"{UNITS_OF_SCRIPTS}",
        (),
    ),
    (
        "speed := 3",
        '3:9 error syntax-error «speed := 3» an assignment is not a node: write `Script (code = "speed := 3")`',
        ('Script (code = "speed := 3")',),
    ),
]
SYMBOLS_OF_OTHERS: Final = [
    *(
        (symbol, f"the symbol with memory is written `M->` | {WITH_MEMORY}", ("M->", "->"))
        for symbol in ("->*", "*->", "→*", "M->*")
    ),
    ("?*", f"the symbol is written `?` | {OF_FALLBACK}", ("?",)),
    ("R->*", "the symbol is written `R->`", ("R->",)),
    ("||*", "the symbol is written `||`", ("||",)),
]


@pytest.mark.parametrize(("line", "said", "meant"), NO_NODES)
def test_a_line_that_is_no_node(line: str, said: str, meant: tuple[str, ...]) -> None:
    text = tree("?", f"    {line}", "    Go")
    found = mistakes(text)
    assert [" | ".join((each, *found[0].notes)) for each in show(text, found)] == [said]
    mended = [tree("?", f"    {each}", "    Go") for each in meant]
    assert [after(text, fix) for fix in found[0].fixes] == mended
    assert [parse(each).diagnostics for each in mended] == [()] * len(mended)


@pytest.mark.parametrize(("symbol", "said", "meant"), SYMBOLS_OF_OTHERS)
def test_a_symbol_with_a_star(symbol: str, said: str, meant: tuple[str, ...]) -> None:
    text = tree(symbol, "    Go")
    found = mistakes(text)
    assert [" | ".join((each, *found[0].notes)) for each in show(text, found)] == [
        f"2:5 error syntax-error «{symbol}» {said}"
    ]
    assert [after(text, fix) for fix in found[0].fixes] == [tree(each, "    Go") for each in meant]
    assert [mistakes(after(text, fix)) for fix in found[0].fixes] == [[]] * len(meant)


@pytest.mark.parametrize(
    ("brackets", "ports"),
    [
        ("(place)", ["input place"]),
        (" (place, other)", ["input place", "input other"]),
        ("(place : string, n : int)", ["input place : string", "input n : int"]),
        ("(string place)", ["input place : string"]),
        ("(output std::string place)", ["output place : std::string"]),
        ("(inout place)", ["inout place"]),
        ("(place: string, speed: double = 0.5)", ["input place : string", "input speed : double = 0.5"]),
    ],
)
@pytest.mark.parametrize(("item", "owner"), [("BehaviorTree Main", "tree"), ("Action Turn", "node")])
def test_ports_in_brackets(brackets: str, ports: list[str], item: str, owner: str) -> None:
    below = "\n    Go\n" if owner == "tree" else "\n" + tree("Turn")
    text = f"{item}{brackets}{below}"
    (found,) = mistakes(text)
    assert (found.rule, found.message) == ("syntax-error", "ports do not go in brackets")
    assert found.notes == (f"a port goes on a line of its own below the {owner}, indented: `input name : type`",)
    (fix,) = found.fixes
    assert after(text, fix) == "\n    ".join((item, *ports)) + below
    assert parse(after(text, fix)).diagnostics == ()


TOO_FAR: Final = "what is below it may be indented too far"


@pytest.mark.parametrize(
    ("lines", "dedented", "said"),
    [
        (
            ("    Action Go", "        Turn", "    Turn"),
            ("    Action Go", "    Turn", "    Turn"),
            "3:16 error child-count «Go» the Action `Go` requires no children, found 1",
        ),
        (
            ("    AlwaysSuccess", "        Go", "            Turn", "        Go"),
            ("    AlwaysSuccess", "    Go", "        Turn", "    Go"),
            "3:9 error child-count «AlwaysSuccess» `AlwaysSuccess` requires no children, found 2",
        ),
        (
            ("    Retry (num_attempts = 3)", "        Go", "        Turn"),
            ("    Retry (num_attempts = 3)", "        Go", "    Turn"),
            "3:9 error child-count «Retry» `Retry` requires exactly 1 child, found 2",
        ),
    ],
)
def test_a_child_that_is_indented_too_far(lines: tuple[str, ...], dedented: tuple[str, ...], said: str) -> None:
    text = tree("->", *lines)
    found = [each for each in mistakes(text) if each.rule != "unknown-node"]
    assert (show(text, found), found[0].notes) == ([said], (TOO_FAR,))
    assert after(text, found[0].fixes[0]) == tree("->", *dedented)
    assert [fix.title.split()[0] for fix in found[0].fixes] == ["Dedent", "Put"][: 1 + ("Retry" in lines[0])]


def test_a_child_below_an_undeclared_node() -> None:
    declared = "Action Go\nAction Turn\n"
    text = declared + tree("->", "    Look", "        Go", "    Turn")
    (found,) = mistakes(text)
    assert (found.rule, found.notes[1:]) == ("unknown-node", (TOO_FAR,))
    assert after(text, found.fixes[-1]) == declared + tree("->", "    Look", "    Go", "    Turn")


@pytest.mark.parametrize("lines", [("Action Go", "    Turn"), ("Inverter", "    Action Go", "        Turn")])
def test_a_child_that_no_parent_takes_is_not_dedented(lines: tuple[str, ...]) -> None:
    assert [each.fixes for each in mistakes(tree(*lines)) if each.rule == "child-count"] == [()]


@pytest.mark.parametrize(
    ("comment", "path"),
    [
        ('#include "x.btq"', "x.btq"),
        ("#include <x.btq>", "x.btq"),
        ("#include 'sub/x.xml'", "sub/x.xml"),
        ("#include x.btq;", "x.btq"),
        ('#import "x.btq"', "x.btq"),
    ],
)
def test_an_include_in_a_comment(comment: str, path: str) -> None:
    text = f"{comment}\n{tree('Go')}"
    (found,) = mistakes(text)
    assert show(text, [found]) == [
        f'1:1 hint missing-include «{comment}» this is a comment; did you mean `include "{path}"`?'
    ]
    assert [after(text, fix) for fix in found.fixes] == [f'include "{path}"\n{tree("Go")}']
    assert mistakes(f"{tree('->', f'    Go  {comment}')}")[0].rule == "missing-include"


@pytest.mark.parametrize(
    "comment",
    [
        '# include "x.btq"',  # one that is left out on purpose
        '#include "x.btq" later',
        '#include "x.hpp"',
        "#include",
        "#included in x.btq",
        '##include "x.btq"',
        '# see #include "x.btq"',
    ],
)
def test_a_comment_about_an_include(comment: str) -> None:
    assert mistakes(f"{comment}\n{tree('Go')}") == []
    assert mistakes(tree(f'Say (text = "{comment[1:].replace(chr(34), chr(39))}")')) == []


def test_a_comment_in_xml_is_no_include() -> None:
    xml = "<root BTCPP_format='4'><!--#include \"x.xml\"--><BehaviorTree ID='T'><Go/></BehaviorTree></root>"
    assert check(workspace_of({"main.xml": xml}), "main.xml") == ()


@pytest.mark.parametrize(
    ("xml", "said"),
    [
        (
            "<Root><BehaviorTree ID='T'><Go/></BehaviorTree></root>",
            "xml-syntax «</root>» expected </Root>, found </root> | "
            "the engine's element is <root>: write <root> where it opens, and </root> here",
        ),
        (
            "<root><BehaviorTree ID='T'><Go/></BehaviorTree></Root>",
            "xml-syntax «</Root>» expected </root>, found </Root> | write </root>",
        ),
        (
            "<root><BehaviorTree ID='T'><fallback><Go/></Fallback></BehaviorTree></root>",
            "xml-syntax «</Fallback>» expected </fallback>, found </Fallback> | "
            "the engine's element is <Fallback>: write <Fallback> where it opens, and </Fallback> here",
        ),
        (
            "<root><BEHAVIORTREE ID='T'><Go/></behaviortree></root>",
            "xml-syntax «</behaviortree>» expected </BEHAVIORTREE>, found </behaviortree> | "
            "the engine's element is <BehaviorTree>: write <BehaviorTree> where it opens, and </BehaviorTree> here",
        ),
        (
            "<Root><BehaviorTree ID='T'><Go/></BehaviorTree></Root>",
            "xml-root «Root» the document element is <Root>, not <root> | "
            "the engine distinguishes capital letters: write <root> and </root>",
        ),
        (
            "<root BTCPP_format='4'><BehaviorTree ID='T'><Fallback ID='Give'><Go/></Fallback></BehaviorTree></root>",
            "unknown-port «ID» the engine refuses the attribute `ID` on `Fallback` | a node's own name is its `name`",
        ),
        (
            "<root BTCPP_format='4'><BehaviorTree ID='T'><Fallback label='Give'><Go/></Fallback></BehaviorTree></root>",
            "unknown-port «label» `Fallback` has no port `label` | it has no ports | a node's own name is its `name`",
        ),
        (
            "<root BTCPP_format='4'><BehaviorTree ID='T'><Inverter child='Go'/></BehaviorTree></root>",
            "unknown-port «child» `Inverter` has no port `child` | it has no ports | "
            "children go below their parent, in XML between its tags: `<Inverter><Dock/></Inverter>`",
        ),
    ],
)
def test_a_slip_in_xml(xml: str, said: str) -> None:
    found = [each for each in check(workspace_of({"main.xml": xml}), "main.xml") if each.rule != "child-count"]
    shown_here = [f"{each.rule} «{xml[each.span.start : each.span.end]}» {each.message}" for each in found]
    assert [" | ".join((line, *each.notes)) for line, each in zip(shown_here, found, strict=True)] == [said]


@pytest.mark.parametrize(("clause", "meant", "note"), CLAUSES)
@pytest.mark.parametrize("further", ["", " on violation warn"])
def test_a_clause_of_other_notations(clause: str, meant: tuple[str, ...], note: str, further: str) -> None:
    signals = "signal v : m/s from {v}\nsignal lit : bool from {lit}\nsignal way : m from {way} counter\n"
    text = f"{signals}{tree('->', '    Go satisfies r', '    Turn')}QualityReq r\n    {clause}{further}\n"
    found = mistakes(text)
    assert show(text, found) == [
        f"9:5 error syntax-error «{clause}» this clause is written {' or '.join(f'`{each}`' for each in meant)}"
    ]
    assert found[0].notes == ((note,) if note else ())
    complete = [each for each in meant if "<node>" not in each and "<signal>" not in each]
    assert [after(text, fix) for fix in found[0].fixes] == [text.replace(clause, each) for each in complete]
    assert [parse(text.replace(clause, each)).diagnostics for each in complete] == [()] * len(complete)


@pytest.mark.parametrize(("clause", "mended"), [('because: "x"', 'because "x"'), ("while: node Go", "while node Go")])
def test_a_sign_after_a_clause_word(clause: str, mended: str) -> None:
    text = requirement("takes at most 3 s", clause)
    (found,) = mistakes(text)
    assert found.message == "unexpected `:`"
    assert [(after(text, fix), fix.safe) for fix in found.fixes] == [(requirement("takes at most 3 s", mended), True)]


def test_a_clause_until_an_event() -> None:
    text = requirement("takes at most 3 s", "until Go succeeds")
    assert show(text, mistakes(text)) == [
        "5:5 error syntax-error «until Go succeeds» this clause is written `from mission starts until Go succeeds`"
    ]


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("3:30 min", "3.5 min, 210 s"),
        ("3:30", "3.5 min, 210 s, 3.5 h, 210 min"),
        ("0:30 h", "0.5 h, 30 min"),
        ("00:03:30", "210 s"),
        ("1 min 30 s", "1.5 min, 90 s"),
        ("1 h 20 min", "80 min"),
        ("1m30s", "1.5 min, 90 s"),
        ("3min30", "3.5 min, 210 s"),
        ("3 min, 30 s", "3.5 min, 210 s"),
    ],
)
def test_a_time_of_several_numbers(written: str, meant: str) -> None:
    text = requirement(f"takes at most {written}")
    found = mistakes(text)
    shown = meant.replace(", ", "` or `")
    assert show(text, found) == [f"4:19 error syntax-error «{written}» a time has one number and one unit: `{shown}`"]
    fixed = [requirement(f"takes at most {each}") for each in meant.split(", ")]
    assert [after(text, fix) for fix in found[0].fixes] == fixed
    assert [mistakes(each) for each in fixed] == [[]] * len(fixed)


@pytest.mark.parametrize(
    ("line", "rule", "mended"),
    [
        ("input int count", "syntax-error", "input count : int"),
        ('input string name = "x"', "syntax-error", 'input name : string = "x"'),
        ("output uint16_t code", "syntax-error", "output code : uint16_t"),
        ("input count int", "syntax-error", "input count : int"),
        ("input goal Pose", "syntax-error", "input goal : Pose"),
    ],
)
def test_a_port_with_its_type_in_another_place(line: str, rule: str, mended: str) -> None:
    text = f"Action Go\n    {line}\n" + tree("Go (count = 1 name = a goal = {g} code = {c})")
    found = next(each for each in mistakes(text) if each.span.start < text.index("BehaviorTree"))
    assert (found.rule, found.notes) == (rule, ("a port is written `input name : type`",))
    assert [after(text, fix) for fix in found.fixes] == [text.replace(line, mended)]


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize(
    ("lines", "moved"),
    [
        (("->", "    input p : string", "    Go"), ("input p : string", "->", "    Go")),
        (("->", "    Go", "    output p : int = 3"), ("output p : int = 3", "->", "    Go")),
        (("->", "    Go", "input p : string"), ("input p : string", "->", "    Go")),
        (("->", "    Go", "        inout p : string", "    Turn"), ("inout p : string", "->", "    Go", "    Turn")),
    ],
)
def test_a_port_below_a_node(lines: tuple[str, ...], moved: tuple[str, ...], newline: str) -> None:
    text, mended = tree(*lines).replace("\n", newline), tree(*moved).replace("\n", newline)
    found = parse(text).diagnostics[0]
    assert found.message == "the ports of a tree go directly below its own line, before its node"
    assert [after(text, fix) for fix in found.fixes] == [mended]
    assert parse(mended).diagnostics == ()


def test_a_node_that_is_called_like_a_port_is_one() -> None:
    assert parse(tree("->", "    input p", "    output (x = 3)")).diagnostics == ()


@pytest.mark.parametrize(("value", "meant"), [("'home\"", "'home'"), ("\"home'", '"home"')])
@pytest.mark.parametrize("rest", [")", " at = 3)", ", at = 3)", " ) satisfies r"])
def test_a_string_in_mixed_quotes(value: str, meant: str, rest: str) -> None:
    text = tree(f"Go (to = {value}{rest}")
    found = parse(text).diagnostics[0]
    assert (found.rule, [after(text, fix) for fix in found.fixes]) == ("unclosed-string", [text.replace(value, meant)])


def test_another_quote_in_a_string_that_is_not_closed() -> None:
    text = tree("Go (to = \"it's home)")
    (fix,) = parse(text).diagnostics[0].fixes
    assert after(text, fix) == text.replace("home", 'home"')


@pytest.mark.parametrize(
    ("written", "meant"),
    [("0.15", "15 %"), ("0.995", "99.5 %"), ("0", "0 %"), ("1", "1 %"), ("15", "15 %")],
)
def test_a_share_that_is_meant_as_a_percentage(written: str, meant: str) -> None:
    text = tree("Go satisfies r") + f"signal b : % from {{b}}\nQualityReq r\n    leaves b >= {written}\n"
    (found,) = [each for each in mistakes(text) if each.rule == "number-without-unit"]
    assert [after(text, fix) for fix in found.fixes] == [text.replace(f">= {written}", f">= {meant}")]


@pytest.mark.parametrize(
    ("written", "meant"),
    [("5min30s", ["5.5 min", "330 s"]), ("1h30m", ["1.5 h", "90 min"]), ("2s500ms", ["2.5 s", "2500 ms"])],
)
def test_a_time_of_several_numbers_in_a_port(written: str, meant: list[str]) -> None:
    text = tree(f"Timeout (msec = {written})", "    Go")
    (found,) = mistakes(text)
    assert [after(text, fix) for fix in found.fixes] == [text.replace(written, each) for each in meant]


@pytest.mark.parametrize("topic", ["/battery", "/bot/battery", '"/battery"', '"/bot_1/battery"'])
@pytest.mark.parametrize("rest", ["", " level"])
def test_a_signal_from_a_topic(topic: str, rest: str) -> None:
    text = tree("Go") + f"signal b : % from {topic}{rest}\n"
    (found,) = parse(text).diagnostics
    assert found.notes == (
        "the topic from which `btq verify` takes samples goes under `[evidence.signals]` in btq.toml",
    )
    assert [after(text, fix) for fix in found.fixes] == [text.replace(topic, "{battery}")]


@pytest.mark.parametrize("indent", ["", "    "])
def test_a_comment_after_dashes(indent: str) -> None:
    text = f"BehaviorTree Main\n    Go\n{indent}-- drives home\n"
    (found,) = parse(text).diagnostics
    assert (found.message, found.notes) == ("a comment begins with `#`", ())
    assert [after(text, fix) for fix in found.fixes] == [text.replace("--", "#")]


@pytest.mark.parametrize("word", ["Action", "Condition", "Control", "Decorator"])
def test_a_model_with_the_name_of_a_class(word: str) -> None:
    text = f"{word}Node Go\n    input a : int\n" + tree("Turn")
    (found,) = parse(text).diagnostics
    assert [after(text, fix) for fix in found.fixes] == [text.replace("Node", "")]


BRANCH: Final = "the third child of an IfThenElse is the else branch"


@pytest.mark.parametrize(
    ("word", "how"),
    [
        ("Else", BRANCH),
        ("Otherwise", BRANCH),
        ("Elif", "the third child of an IfThenElse is its else branch: another IfThenElse"),
        ("ElseIf", "the third child of an IfThenElse is its else branch: another IfThenElse"),
        ("Then", "the second child of an IfThenElse, after the condition, is the then branch"),
    ],
)
def test_a_branch_as_a_node(word: str, how: str) -> None:
    lines = ("IfThenElse", "    Near", "    Go", f"    {word}")
    below = tree(*lines, "        Turn")
    models = "Action Go\nAction Turn\nCondition Near\n"
    for text in (below, models + below, models + tree(*lines)):
        (found,) = [each for each in mistakes(text) if each.rule == "unknown-node"]
        assert (found.message, found.notes, found.fixes) == (f"there is no `{word}`: {how}", (), ())
    assert [each.rule for each in mistakes(tree(*lines))] == []  # a node of the program


@pytest.mark.parametrize("word", ["description", "title", "text:", "summary ="])
def test_a_title_in_the_block_of_a_requirement(word: str) -> None:
    text = requirement("takes at most 3 s", f'{word} "in time"')
    found = mistakes(text)
    plain = word.strip(":= ")
    assert show(text, found) == [
        f"5:5 error syntax-error «{plain}» `{plain}` is not in btq; "
        'nearest is the title in quotes after the name: `QualityReq fast "in time"`'
    ]
    mended = requirement("takes at most 3 s").replace("QualityReq r", 'QualityReq r "in time"')
    assert [after(text, fix) for fix in found[0].fixes] == [mended]
    titled = text.replace("QualityReq r", 'QualityReq r "soon"')
    assert [each.fixes for each in mistakes(titled)] == [()]


@pytest.mark.parametrize(
    "node",
    [
        "Wait Door",  # a leaf of the program, with a label
        "Select Target",
        "Succeeder Done",
        "Not",
        'Not "yet"',
        "Not (x = 1)",
    ],
)
def test_a_leaf_with_a_label(node: str) -> None:
    assert mistakes(tree("->", f"    {node}", "    Go")) == []


@pytest.mark.parametrize(
    "text", [tree("Retry (num_attempts = 5) Again", "    Go"), tree('Retry (num_attempts = 5) "Go"')]
)
def test_a_label_after_brackets_may_be_one(text: str) -> None:
    assert mistakes(text)[0].message == "a node's label goes before its brackets"


def test_each_node_with_a_sign_is_reported() -> None:
    text = tree("Sequence: Rows", "    Fallback: Photo", "        Go: Home (at = 3)", "        Turn: Back (at = 3)")
    assert [text[found.span.start :].split(":")[0] for found in parse(text).diagnostics] == [
        *("Sequence", "Fallback", "Go", "Turn")
    ]


def test_the_start_of_the_next_line_is_no_value() -> None:
    assert [found.notes for found in mistakes(tree("->", "    Go", "    3"))] == [()]


def test_children_beside_the_first_node_of_a_tree() -> None:
    text = tree("Sequence", "Go", "Inverter  # or", "    Left")
    found = mistakes(text)
    assert [(each.rule, each.notes) for each in found] == [("tree-root-count", (CHILDREN,))]
    fixes = [(fix.title, after(text, fix)) for each in found for fix in each.fixes]
    assert fixes == [("Indent them below `Sequence`", tree("Sequence", "    Go", "    Inverter  # or", "        Left"))]


@pytest.mark.parametrize(("word", "number"), [("three", "3"), ("Ten", "10"), ("dozen", None)])
def test_a_number_as_a_word(word: str, number: str | None) -> None:
    text = requirement(f"Go tries at most {word} per Main")
    (found,) = problems(text, "unknown-signal")
    meant = f"; did you mean `{number}`?" if number is not None else ""
    assert found.message == f"unknown signal `{word}`{meant}"
    assert [after(text, fix) for fix in found.fixes] == ([text.replace(word, number)] if number is not None else [])
    declared = f"signal {word} : 1 from {{{word}}}\n{text}"
    assert problems(declared, "unknown-signal") == []


@pytest.mark.parametrize("clause", ["onviolation halt", "on-violation: halt"])
def test_on_violation_as_one_word(clause: str) -> None:
    text = requirement("takes at most 3 s", clause)
    (found,) = parse(text).diagnostics
    assert show(text, [found]) == [
        f"5:5 error syntax-error «{clause}» this clause is written `on violation halt`",
    ]
    assert [after(text, fix) for fix in found.fixes] == [requirement("takes at most 3 s", "on violation halt")]


def test_a_deadline_with_in_is_no_probability() -> None:
    text = requirement("succeeds in 45 s", "in at least 95 % of activations")
    assert show(text, check(workspace_of({"main.btq": text}), "main.btq")) == [
        "4:5 error syntax-error «succeeds in 45 s» this clause is written `succeeds within 45 s`"
    ]
    assert len(problems(text.replace("in 45 s", "in at least 45 % of runs"), "duplicate-clause")) == 1


def test_a_subtree_without_its_word_is_the_only_diagnostic() -> None:
    """A path that names its tree means the tree."""
    text = (
        "Root Main\nQualityReq r\n    Go tries at most 3 per Water\n"
        "BehaviorTree Main\n    ->\n        Water\nBehaviorTree Water\n    ->\n        Action Go\n"
    )
    assert show(text, check(workspace_of({"main.btq": text}), "main.btq")) == [
        "6:9 error unknown-node «Water» `Water` is a tree, not a node"
    ]
    action = text.replace("        Water\n", "        Action Water\n")
    assert [each.message for each in problems(action, "ambiguous-path")] == ["ambiguous path `Water`: 2 nodes match"]


def test_a_signal_whose_entry_could_not_be_read_is_the_only_diagnostic() -> None:
    """Whether its requirement is enforced is unknown."""
    text = (
        "Root Main\nsignal tank : L from tank_level initially 20 L\nQualityReq r\n    keeps tank >= 2 L\n"
        "    on violation halt\nBehaviorTree Main\n    Action Go satisfies r\n"
    )
    assert show(text, check(workspace_of({"main.btq": text}), "main.btq")) == [
        "2:22 error syntax-error «tank_level» expected a blackboard entry: `{key}`, found `tank_level`"
    ]


@pytest.mark.parametrize(
    ("subtree", "said"),
    [
        ('ID="go"', "unknown-tree «go» unknown tree `go`; did you mean `Go`?"),
        ('name="Go"', 'unknown-tree «SubTree» missing tree of this SubTree: write `ID="Go"`'),
    ],
)
def test_an_entry_of_a_tree_that_a_misspelt_subtree_may_run(subtree: str, said: str) -> None:
    xml = (
        f'<root BTCPP_format="4" main_tree_to_execute="M"><BehaviorTree ID="M"><SubTree {subtree} place="{{p}}"/>'
        '</BehaviorTree><BehaviorTree ID="Go"><Drive to="{place}"/></BehaviorTree>'
        '<TreeNodesModel><Action ID="Drive"><input_port name="to"/></Action></TreeNodesModel></root>'
    )
    found = [each for each in check(workspace_of({"main.xml": xml}), "main.xml") if "`p`" not in each.message]
    assert [f"{each.rule} «{xml[each.span.start : each.span.end]}» {each.message}" for each in found] == [said]


def test_a_port_of_a_model_in_another_element_is_the_only_diagnostic() -> None:
    xml = (
        '<root BTCPP_format="4"><BehaviorTree ID="M"><Say text="hello"/></BehaviorTree>'
        '<TreeNodesModel><Action ID="Say"><input name="text" type="std::string"/></Action></TreeNodesModel></root>'
    )
    (found,) = check(workspace_of({"main.xml": xml}), "main.xml")
    message = 'the engine and its tools ignore <input> in a model; did you mean `<input_port name="text"/>`?'
    assert (found.rule, found.message) == ("xml-ignored", message)
    (other,) = problems_in_xml(xml.replace('Say text="hello"', 'Say word="hello"'), "unknown-port")
    assert other.message.startswith("`Say` has no port `word`")


def problems_in_xml(xml: str, rule: str) -> list[Diagnostic]:
    return [each for each in check(workspace_of({"main.xml": xml}), "main.xml") if each.rule == rule]
