"""The mistakes that newcomers make first: from BehaviorTree.CPP's XML, from Python and YAML, from the published syntax.

Each mission has one mistake and each gets one diagnostic, which says what to write; where that is certain, a fix writes
it, and the mission is clean afterwards.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Final

import pytest
from check_asserts import MAIN, after, show

from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.workspace.workspace import Workspace

Case = tuple[str, str, str | None]  # a mission, its diagnostic with the notes, and the mission after the fix


def tree(*lines: str) -> str:
    return "\n    ".join(("BehaviorTree Main", *lines)) + "\n"


def requirement(*lines: str) -> str:
    return tree("Go satisfies r") + "\n    ".join(("QualityReq r", *lines)) + "\n"


def condition(text: str) -> str:
    signals = "signal lit : bool from {lit}\nsignal far : m from {far}\n"
    requirement = "QualityReq r\n    keeps c or lit\n"
    return f"{signals}context c : far > 1 m and {text}\n" + tree("Go satisfies r") + requirement


R: Final = 'QualityReq r "in time"\n'
S: Final = 'QualityReq s "in order"\n'
OTHER: Final = "BehaviorTree Other\n    Go\n"

FROM_XML: Final[list[Case]] = [
    (
        tree('SubTree ID="Other"') + OTHER,
        '2:13 error syntax-error «ID="Other"» attributes go in brackets: `(key = value)`',
        tree('SubTree (ID="Other")') + OTHER,
    ),
    (
        tree('Retry num_attempts="3"', "    Go"),
        '2:11 error syntax-error «num_attempts="3"» attributes go in brackets: `(key = value)`',
        tree('Retry (num_attempts="3")', "    Go"),
    ),
    (
        tree('-> name="all"', "    Go"),
        '2:8 error syntax-error «name="all"» attributes go in brackets: `(key = value)`',
        tree('-> (name="all")', "    Go"),
    ),
    (
        tree('Script (code = "a := True")'),
        "2:26 warning misspelt-entry «True» a script reads `True` as the name of an entry; did you mean `true`?",
        tree('Script (code = "a := true")'),
    ),
    (
        tree("<Sequence>", "    Go", "</Sequence>"),
        "2:5 error syntax-error «<Sequence>» expected btq, found XML: a node is written `Sequence` | "
        "if this is BehaviorTree.CPP XML, rename the file to .xml, or convert it with `btq import`; "
        "a comment begins with `#`, not `<!--`",
        None,
    ),
    (
        tree('<MoveBase station="charger"/>'),
        '2:5 error syntax-error «<MoveBase station="charger"/>» expected btq, found XML: a node is written '
        '`MoveBase (station="charger")` | '
        "if this is BehaviorTree.CPP XML, rename the file to .xml, or convert it with `btq import`; "
        "a comment begins with `#`, not `<!--`",
        tree('MoveBase (station="charger")'),
    ),
    (
        tree("->", "    <!-- to the charger -->", "    Go"),
        "3:9 error syntax-error «<!-- to the charger -->» a comment begins with `#`",
        tree("->", "    # to the charger", "    Go"),
    ),
    (
        '<?xml version="1.0"?>\n<root BTCPP_format="4">\n  <BehaviorTree ID="Main"/>\n</root>\n',
        '1:1 error syntax-error «<?xml version="1.0"?>» expected btq, found XML | '
        "if this is BehaviorTree.CPP XML, rename the file to .xml, or convert it with `btq import`; "
        "a comment begins with `#`, not `<!--`",
        None,
    ),
    (
        'Root main_tree_to_execute="Main"\n' + tree("Go"),
        "1:6 error syntax-error «main_tree_to_execute» expected the main tree's name after `Root` | "
        "attributes go in brackets: `(key = value)`",
        'Root "Main"\n' + tree("Go"),
    ),
    (
        "TreeNodesModel\n    Action Go\n        output_port done\n" + tree("Go (done = {d})"),
        "3:9 error syntax-error «output_port» unknown word `output_port`; did you mean `output`?",
        "TreeNodesModel\n    Action Go\n        output done\n" + tree("Go (done = {d})"),
    ),
    (
        'include path="stations.btq"\n' + tree("Go"),
        "1:9 error syntax-error «path» the path of an include needs no `path =`",
        'include "stations.btq"\n' + tree("Go"),
    ),
    (
        "include <stations.btq>\n" + tree("Go"),
        "1:9 error syntax-error «<» expected a file in quotes, found `<`",
        'include "stations.btq"\n' + tree("Go"),
    ),
    (
        tree("Retry (num_attempts = 5) Again", "    Go"),
        "2:30 error syntax-error «Again» a node's label goes before its brackets | "
        "a child goes on a line of its own below its parent, indented",
        tree("Retry Again (num_attempts = 5)", "    Go"),
    ),
    (
        tree('Go(a = 5) "Again" satisfies r') + R,
        '2:15 error syntax-error «"Again"» a node\'s label goes before its brackets | '
        "a child goes on a line of its own below its parent, indented",
        tree('Go "Again" (a = 5) satisfies r') + R,
    ),
    (
        tree("Go (a = 1; b = 2)"),
        "2:14 error syntax-error «;» expected `,` between attributes, found `;`",
        tree("Go (a = 1, b = 2)"),
    ),
    (tree("Go (a = /map)"), "2:13 error syntax-error «/map» this value needs quotes", tree('Go (a = "/map")')),
    (
        tree("SubTree (Other)") + OTHER,
        "2:14 error syntax-error «Other» expected an attribute: key = value, found `Other`",
        tree("SubTree Other") + OTHER,
    ),
]

FROM_PYTHON: Final[list[Case]] = [
    (
        "Root Main\n" + tree('Go {station = "x", at = {y}} satisfies r') + R,
        "3:8 error syntax-error «{» attributes go in round brackets: `(key = value)`",
        "Root Main\n" + tree('Go (station = "x", at = {y}) satisfies r') + R,
    ),
    (
        "Root Main\n" + tree("Go {n = 1}"),
        "3:8 error syntax-error «{n = 1}» attributes go in round brackets: `(key = value)`",
        "Root Main\n" + tree("Go (n = 1)"),
    ),
    (
        "Root Main\n" + tree('Go There {place: "do: ck", at: {y}}'),
        "3:14 error syntax-error «{» attributes go in round brackets: `(key = value)`",
        "Root Main\n" + tree('Go There (place = "do: ck", at = {y})'),
    ),
    (
        "Root Main\n" + tree('Go {"n": 1}'),
        "3:8 error syntax-error «{» attributes go in round brackets: `(key = value)`",
        "Root Main\n" + tree("Go (n = 1)"),
    ),
    (
        "Root Main\n" + tree("Go {n: 1}"),
        "3:8 error syntax-error «{n: 1}» attributes go in round brackets: `(key = value)`",
        "Root Main\n" + tree("Go (n = 1)"),
    ),
    (
        tree("->", "    Condtion AtDoor"),
        "3:9 warning unknown-node «Condtion» btq reads `Condtion` as a node here; did you mean `Condition`?",
        tree("->", "    Condition AtDoor"),
    ),
    (
        tree("Decoratr Slowly", "    Acton Go (n = 1)"),
        "2:5 warning unknown-node «Decoratr» btq reads `Decoratr` as a node here; did you mean `Decorator`?",
        tree("Decorator Slowly", "    Acton Go (n = 1)"),
    ),
    (tree("Sequence:", "    Go"), "2:13 error syntax-error «:» unexpected `:`", tree("Sequence", "    Go")),
    ("BehaviorTree Main:\n    Go\n", "1:18 error syntax-error «:» unexpected `:`", tree("Go")),
    (tree("Action: Go"), "2:11 error syntax-error «:» unexpected `:`", tree("Action Go")),
    (
        tree("- Go"),
        "2:5 error syntax-error «-» unexpected `-` before a node | "
        "a node needs no dash; its children go below it, indented",
        tree("Go"),
    ),
    (
        tree("- Sequence", "    Go"),
        "2:5 error syntax-error «-» unexpected `-` before a node | "
        "a node needs no dash; its children go below it, indented",
        tree("Sequence", "    Go"),
    ),
    (
        tree('Go (station: "charger")'),
        "2:16 error syntax-error «:» expected `=` between key and value, found `:`",
        tree('Go (station = "charger")'),
    ),
    (
        tree('Go station: "charger"'),
        '2:8 error syntax-error «station: "charger"» attributes go in brackets: `(key = value)`',
        tree('Go (station = "charger")'),
    ),
    (
        tree("Go", "    station: charger"),
        "3:9 error syntax-error «station: charger» attributes go in brackets: `(key = value)`",
        None,
    ),
    (
        tree("Go (a == 3)"),
        "2:11 error syntax-error «==» expected `=` between key and value, found `==`",
        tree("Go (a = 3)"),
    ),
    (
        tree("Go (a := 3)"),
        "2:11 error syntax-error «:=» expected `=` between key and value, found `:=`",
        tree("Go (a = 3)"),
    ),
    (tree("Go (a = [1, 2])"), "2:13 error syntax-error «[1, 2]» this value needs quotes", tree('Go (a = "[1, 2]")')),
    (tree("Go (a = ${b})"), "2:13 error syntax-error «${b}» a blackboard entry is written `{b}`", tree("Go (a = {b})")),
    (
        tree("Go [a = 3]"),
        "2:8 error syntax-error «[» unexpected `[` | attributes go in round brackets: `(key = value)`",
        tree("Go (a = 3)"),
    ),
    (
        tree("Sequence [Go, Turn]"),
        "2:14 error syntax-error «[» unexpected `[` | children go on lines of their own below their parent, indented",
        None,
    ),
    (
        tree("Sequence(Go, Turn)"),
        "2:14 error syntax-error «Go» expected an attribute: key = value, found `Go` | "
        "children go on lines of their own below their parent, indented",
        None,
    ),
    (
        tree("Sequence Go, Turn"),
        "2:16 error syntax-error «,» children go on lines of their own below their parent, indented",
        tree("Sequence", "    Go", "    Turn"),
    ),
    (
        tree("Sequence [", "    Go", "]"),
        "2:14 error syntax-error «[» unexpected `[`: a block consists of indented lines",
        tree("Sequence", "    Go"),
    ),
    (
        tree("Sequence {", "    Go", "}"),
        "2:14 error syntax-error «{» unexpected `{`: a block consists of indented lines",
        tree("Sequence", "    Go"),
    ),
    (
        tree("Retry (attempts=3)", "    Go"),
        "2:12 error unknown-port «attempts» `Retry` has no port `attempts`; did you mean `num_attempts`? | "
        "it has `num_attempts`",
        tree("Retry (num_attempts=3)", "    Go"),
    ),
    (
        tree("Retry 3", "    Go"),
        "2:11 error syntax-error «3» expected the end of the line, found `3` | "
        "a value goes after the name of its port: `(num_attempts = 3)`",
        tree("Retry (num_attempts = 3)", "    Go"),
    ),
    (
        tree("Retry (3)", "    Go"),
        "2:12 error syntax-error «3» expected an attribute: key = value, found `3` | "
        "a value goes after the name of its port: `num_attempts = 3`",
        tree("Retry (num_attempts = 3)", "    Go"),
    ),
    (
        "def main():\n    Go\n",
        "1:1 error syntax-error «def» unknown word `def`; did you mean `BehaviorTree`?",
        "BehaviorTree main\n    Go\n",
    ),
    (
        "import stations\n" + tree("Go"),
        "1:1 error syntax-error «import» unknown word `import`; did you mean `include`?",
        'include "stations.btq"\n' + tree("Go"),
    ),
    (
        "from stations import charger\n" + tree("Go"),
        "1:1 error syntax-error «from» expected an item: BehaviorTree, QualityReq, include, signal, …, found "
        "`from` | "
        'another file is read with `include "stations.btq"`',
        None,
    ),
    (tree('"""Goes"""', "Go"), '2:5 error syntax-error «"""Goes"""» a comment begins with `#`', tree("# Goes", "Go")),
    (
        tree("Go -- to the charger"),
        "2:8 error syntax-error «-- to the charger» a comment begins with `#`",
        tree("Go # to the charger"),
    ),
    (
        tree("if far < 2 m:", "    Go"),
        "2:5 error syntax-error «if» expected a node, found the statement `if` | "
        "to choose, use a Fallback `?` with a Condition, or `_skipIf` on the node",
        None,
    ),
    (
        tree("while True:", "    Go"),
        "2:5 error syntax-error «while» expected a node, found the statement `while` | "
        "to repeat, use `Repeat`, `Retry` or `KeepRunningUntilFailure`",
        None,
    ),
    (
        tree("->", "    !BatteryLow", "    Go"),
        "3:9 error syntax-error «!» expected a node: its kind, or a symbol: -> ? || …, found `!` | "
        "to negate a node, put an `Inverter` above it, and indent the node",
        tree("->", "    Inverter", "        BatteryLow", "    Go"),
    ),
    (
        condition("lit && far > 2 m"),
        "3:31 error syntax-error «&&» in conditions `&&` is written `and`",
        condition("lit and far > 2 m"),
    ),
    (
        condition("(lit || far > 2 m)"),
        "3:32 error syntax-error «||» in conditions `||` is written `or`",
        condition("(lit or far > 2 m)"),
    ),
    (condition("!lit"), "3:27 error syntax-error «!» in conditions `!` is written `not`", condition("not lit")),
    (condition("far = 2 m"), "3:31 error syntax-error «=» values are compared with `==`", condition("far == 2 m")),
    (
        condition("lit == True"),
        "3:34 error unknown-signal «True» unknown signal `True`; did you mean `true`? | "
        "or declare it: `signal True : bool from {True}`",
        condition("lit == true"),
    ),
    (
        "BehaviorTree Main\n    ->\n        Go\n\t\tTurn\n",
        "4:1 error inconsistent-indentation «\t\t» tabs and spaces are mixed: 2 tabs cannot be compared with 8 "
        "spaces | "
        "btq reads the line as if indented by 8 spaces",
        tree("->", "    Go", "    Turn"),
    ),
    (
        "Action Go (station : string)\n" + tree("Go (station = home)"),
        "1:11 error syntax-error «(» ports do not go in brackets | "
        "a port goes on a line of its own below the node, indented: `input name : type`",
        "Action Go\n    input station : string\n" + tree("Go (station = home)"),
    ),
]

FROM_THE_PUBLISHED_SYNTAX: Final[list[Case]] = [
    (
        tree("Go satisfy r") + R,
        "2:8 error syntax-error «satisfy» unknown word `satisfy`; did you mean `satisfies`?",
        tree("Go satisfies r") + R,
    ),
    (
        tree("Go satisfied by r") + R,
        "2:8 error syntax-error «satisfied» unknown word `satisfied`; did you mean `satisfies`?",
        tree("Go satisfies r") + R,
    ),
    (tree("Go satisfies: r") + R, "2:17 error syntax-error «:» unexpected `:`", tree("Go satisfies r") + R),
    (tree("Go satisfies = r") + R, "2:18 error syntax-error «=» unexpected `=`", tree("Go satisfies r") + R),
    (
        tree("Go satisfies (r, s)") + R + S,
        "2:18 error syntax-error «(» requirements of a node need no brackets",
        tree("Go satisfies r, s") + R + S,
    ),
    (
        tree("Go satisfies [r, s]") + R + S,
        "2:18 error syntax-error «[» unexpected `[` | a list needs no brackets",
        tree("Go satisfies r, s") + R + S,
    ),
    (
        tree("Go satisfies r s") + R + S,
        "2:20 error syntax-error «s» expected `,` or the end of the line, found `s`",
        tree("Go satisfies r, s") + R + S,
    ),
    (
        tree("Go (satisfices Quality safety)"),
        "2:28 error syntax-error «safety» expected `=` after `Quality`, found `safety`",
        tree("Go (satisfices Quality = safety)"),
    ),
    (
        tree("Go (satisfices Quality: safety)"),
        "2:27 error syntax-error «:» expected `=` after `Quality`, found `:`",
        tree("Go (satisfices Quality = safety)"),
    ),
    (
        tree('Go (satisfices safety (QualityReq ID = r description = "calm"))'),
        "2:27 error syntax-error «(» expected an attribute: key = value, found `(`",
        tree('Go (satisfices Quality = safety (QualityReq ID = r description = "calm"))'),
    ),
    (
        tree("Go (satisfices Quality = safety"),
        "2:8 error unclosed-bracket «(» missing `)` for this `(`",
        tree("Go (satisfices Quality = safety)"),
    ),
    (
        'requirement r "in time"\n' + tree("Go satisfies r"),
        "1:1 error syntax-error «requirement» unknown word `requirement`; did you mean `QualityReq`?",
        R + tree("Go satisfies r"),
    ),
    (
        'QualityReq: r "in time"\n' + tree("Go satisfies r"),
        "1:11 error syntax-error «:» unexpected `:`",
        R + tree("Go satisfies r"),
    ),
    (
        "QualityReq r:\n    takes at most 30 s\n" + tree("Go satisfies r"),
        "1:13 error syntax-error «:» unexpected `:`",
        "QualityReq r\n    takes at most 30 s\n" + tree("Go satisfies r"),
    ),
    (
        'QualityReq (ID = r description = "in time")\n' + tree("Go satisfies r"),
        "1:12 error syntax-error «(» a requirement's ID goes after `QualityReq`, without brackets",
        'QualityReq ID = r description = "in time"\n' + tree("Go satisfies r"),
    ),
    (
        'QualityReq ID r description "in time"\n' + tree("Go satisfies r"),
        "1:12 error syntax-error «ID» expected `=` after `ID`",
        'QualityReq ID = r description = "in time"\n' + tree("Go satisfies r"),
    ),
    (
        'QualityReq ID = r, description: "in time"\n' + tree("Go satisfies r"),
        "1:20 error syntax-error «description» expected `=` after `description`",
        'QualityReq ID = r, description = "in time"\n' + tree("Go satisfies r"),
    ),
    (
        'QualityReq r description = "in time"\n' + tree("Go satisfies r"),
        "1:14 error syntax-error «description =» a title goes after the ID without `description =`",
        R + tree("Go satisfies r"),
    ),
    (
        'QualityReq r quality = safety "in time"\n' + tree("Go satisfies r"),
        "1:14 error syntax-error «quality =» expected `:` before the quality, found `quality =`",
        'QualityReq r : safety "in time"\n' + tree("Go satisfies r"),
    ),
    ("Root = Main\n" + tree("Go"), "1:6 error syntax-error «=» unexpected `=`", "Root Main\n" + tree("Go")),
    (
        "Root ID = Main\n" + tree("Go"),
        "1:6 error syntax-error «ID» expected the main tree's name after `Root` | "
        "attributes go in brackets: `(key = value)`",
        "Root Main\n" + tree("Go"),
    ),
    (
        "BehaviorTree ID Main\n    Go\n",
        "1:14 error syntax-error «ID» expected `=` after `ID`",
        "BehaviorTree ID = Main\n    Go\n",
    ),
    (
        requirement("takes <= 30 s"),
        "4:11 error syntax-error «<=» this bound is written `at most`",
        requirement("takes at most 30 s"),
    ),
    (
        requirement("<=30s"),
        "4:5 error syntax-error «<=» expected a clause: takes, keeps, in at least, on violation, …, found "
        "`<=` | "
        "a bound goes after its verb: `takes at most 30 s`",
        requirement("takes at most 30s"),
    ),
    (
        requirement("at most 30 s"),
        "4:8 error syntax-error «most» expected a verb before `at most`, found `most` | "
        "a bound goes after its verb, `takes at most 3 s`; a probability is written `in at least 95 % of runs`",
        requirement("takes at most 30 s"),
    ),
    (
        requirement("takes 30 s"),
        "4:11 error syntax-error «30 s» expected a bound: at most, at least, less than, more than or "
        "between, found `30 s` | "
        "write the kind of bound before the value: `at most 30 s`",
        requirement("takes at most 30 s"),
    ),
    (
        requirement("time <= 30 s"),
        "4:5 error syntax-error «time <= 30 s» this clause is written `takes at most 30 s`",
        requirement("takes at most 30 s"),
    ),
    (
        requirement("takes less or equal 30 s"),
        "4:11 error syntax-error «less or equal» this bound is written `at most`",
        requirement("takes at most 30 s"),
    ),
    (
        requirement("takes less than or equal to 30 s"),
        "4:11 error syntax-error «less than or equal to» this bound is written `at most`",
        requirement("takes at most 30 s"),
    ),
    (
        requirement("takes at most 30 Sekunden"),
        "4:22 error unknown-unit «Sekunden» unknown unit `Sekunden`; did you mean `s`?",
        requirement("takes at most 30 s"),
    ),
    (
        requirement("takes at most 30"),
        "4:19 error number-without-unit «30» missing unit after `30`; expected a time",
        requirement("takes at most 30 s"),
    ),
    (
        requirement("takes at most 3 s", "on failure fail"),
        "5:8 error syntax-error «failure» expected `violation`, found `failure`",
        requirement("takes at most 3 s", "on violation fail"),
    ),
    (
        requirement("takes at most 3 s", "on_violation fail"),
        "5:5 error syntax-error «on_violation» expected `on violation`, found `on_violation`",
        requirement("takes at most 3 s", "on violation fail"),
    ),
    (
        requirement("takes at most 3 s", "on violation = fail"),
        "5:18 error syntax-error «=» unexpected `=`",
        requirement("takes at most 3 s", "on violation fail"),
    ),
    (
        requirement("succeeds with 98 %"),
        "4:19 error syntax-error «98 %» a probability is written `with probability >= 98 %`",
        requirement("succeeds with probability >= 98 %"),
    ),
    (
        requirement("succeeds with probability 0.98"),
        "4:31 error syntax-error «0.98» expected `>=` or `>` and a percentage, found `0.98`",
        requirement("succeeds with probability >= 98 %"),
    ),
    (
        tree("SubTree Inspect") + "BehaviorTree Inspect\n    Dock\nQualityReq r\n    Inspect Dock succeeds\n",
        "6:5 error syntax-error «Inspect Dock» a path is written with `/`: `Inspect/Dock` | "
        'a name of several words goes in quotes: "Inspect Dock"',
        tree("SubTree Inspect") + "BehaviorTree Inspect\n    Dock\nQualityReq r\n    Inspect/Dock succeeds\n",
    ),
    (
        tree("SubTree Inspect") + "BehaviorTree Inspect\n    Dock\napply r to Inspect Dock\n" + R,
        "5:12 error syntax-error «Inspect Dock» a path is written with `/`: `Inspect/Dock` | "
        'a name of several words goes in quotes: "Inspect Dock"',
        tree("SubTree Inspect") + "BehaviorTree Inspect\n    Dock\napply r to Inspect/Dock\n" + R,
    ),
    (
        tree("->", "    Go satisfies r", "    Turn") + "QualityReq r\n    ends within 3 s after Main Turn fails\n",
        "6:27 error syntax-error «Main Turn» a path is written with `/`: `Main/Turn` | "
        'a name of several words goes in quotes: "Main Turn"',
        tree("->", "    Go satisfies r", "    Turn") + "QualityReq r\n    ends within 3 s after Main/Turn fails\n",
    ),
    (
        "signal far (m)\n" + tree("Go satisfies r") + "QualityReq r\n    keeps far > 1 m\n",
        "1:12 error syntax-error «(» expected `:` and the signal's unit, found `(`",
        "signal far : m\n" + tree("Go satisfies r") + "QualityReq r\n    keeps far > 1 m\n",
    ),
    (
        "signal far = 3 m\n" + tree("Go satisfies r") + "QualityReq r\n    keeps far > 1 m\n",
        "1:12 error syntax-error «=» expected `:` and the signal's unit, found `=`",
        "signal far : m initially 3 m\n" + tree("Go satisfies r") + "QualityReq r\n    keeps far > 1 m\n",
    ),
    (
        "signal far : m from far\n" + tree("Go satisfies r") + "QualityReq r\n    keeps far > 1 m\n",
        "1:21 error syntax-error «far» expected a blackboard entry: `{key}`, found `far`",
        "signal far : m from {far}\n" + tree("Go satisfies r") + "QualityReq r\n    keeps far > 1 m\n",
    ),
]


PUT_TOGETHER = (
    "a value is one literal or one entry, and nothing puts several together | "
    "write a text in quotes or an entry `{key}`, to which a Script before can give `'dock' .. n`"
)
ON_ITS_OWN = "a child goes on a line of its own below its parent, indented"
A_VALUE = 'a value goes to a port: `MoveBase (speed = 0.5)`; or to an entry: `Script (code = "speed := 0.5")`'
AN_ITEM = "expected an item: BehaviorTree, QualityReq, include, signal, …, found"
FROM_OTHER_LANGUAGES: list[tuple[str, str, str | None]] = [
    (tree('Go (station = f"dock{n}")'), f'2:19 error syntax-error «f"dock{{n}}"» {PUT_TOGETHER}', None),
    (tree("Go (station = f'dock')"), f"2:19 error syntax-error «f'dock'» {PUT_TOGETHER}", None),
    (tree('Go (station = rb"dock" x = 1)'), f'2:19 error syntax-error «rb"dock"» {PUT_TOGETHER}', None),
    (tree('Go (station = "dock" + n)'), f"2:26 error syntax-error «+» {PUT_TOGETHER}", None),
    (tree('Go (station = "dock%d" % n)'), f"2:28 error syntax-error «%» {PUT_TOGETHER}", None),
    (
        tree("Inverter Condition Dark"),
        f"2:14 error syntax-error «Condition Dark» {ON_ITS_OWN}",
        tree("Inverter", "    Condition Dark"),
    ),
    (
        tree("Retry (num_attempts = 3) Action Dock (x = 1)"),
        f"2:30 error syntax-error «Action Dock (x = 1)» {ON_ITS_OWN}",
        tree("Retry (num_attempts = 3)", "    Action Dock (x = 1)"),
    ),
    (
        tree('Timeout "at most" (msec = 1 s) SubTree Dock_it') + "BehaviorTree Dock_it\n    Go\n",
        f"2:36 error syntax-error «SubTree Dock_it» {ON_ITS_OWN}",
        tree('Timeout "at most" (msec = 1 s)', "    SubTree Dock_it") + "BehaviorTree Dock_it\n    Go\n",
    ),
    (
        "BehaviorTree Main\n\t->\n\t\tInverter Action Dock\n",
        f"3:12 error syntax-error «Action Dock» {ON_ITS_OWN}",
        "BehaviorTree Main\n\t->\n\t\tInverter\n\t\t\tAction Dock\n",
    ),
    ("speed = 0.5\n" + tree("Go"), f"1:1 error syntax-error «speed» {AN_ITEM} `speed` | {A_VALUE}", None),
    (
        'main_tree_to_execute = "Main"\n' + tree("Go"),
        f"1:1 error syntax-error «main_tree_to_execute» {AN_ITEM} `main_tree_to_execute` | `Root` names the main tree",
        'Root "Main"\n' + tree("Go"),
    ),
    (
        '"""docks"""\n' + tree("Go"),
        '1:1 error syntax-error «"""docks"""» a comment begins with `#`',
        "# docks\n" + tree("Go"),
    ),
    (
        tree("->", "    Go") + "/Sequence\n",
        f"4:1 error syntax-error «/» {AN_ITEM} `/` | "
        "a block ends where its indentation does, without a line of its own",
        tree("->", "    Go") + "\n",
    ),
    (
        tree("Action Go", "    on failure abort"),
        "3:9 error syntax-error «on» unexpected clause `on` in a tree; clauses go in a requirement | "
        "after a failure, a Fallback `?` runs its next child; `_onFailure` on a node runs a script",
        None,
    ),
    (
        tree("Go satisfies QualityRequirement ID = r takes at most 3 s"),
        "2:18 error syntax-error «QualityRequirement» unknown word `QualityRequirement`; did you mean `QualityReq`?",
        tree("Go satisfies QualityReq ID = r takes at most 3 s"),
    ),
    (
        tree("-> (satisfies qualityreq ID = r takes at most 3 s)", "    Go"),
        "2:19 error syntax-error «qualityreq» unknown word `qualityreq`; did you mean `QualityReq`?",
        tree("-> (satisfies QualityReq ID = r takes at most 3 s)", "    Go"),
    ),
    (
        tree("Go satisfies requirement r") + R,
        "2:18 error syntax-error «requirement» a requirement is named by its ID alone",
        tree("Go satisfies r") + R,
    ),
    (
        requirement("takes at most 3 s", 'rationale "the dock is near"'),
        '5:5 error syntax-error «rationale» `rationale` is not in btq; nearest is `because "…"`',
        requirement("takes at most 3 s", 'because "the dock is near"'),
    ),
    (
        requirement("takes at most 3 s", 'Reason: "it is near"'),
        '5:5 error syntax-error «Reason» `Reason` is not in btq; nearest is `because "…"`',
        requirement("takes at most 3 s", 'because "it is near"'),
    ),
    (
        requirement("takes at most 3 s", "status approved"),
        "5:5 error syntax-error «status» `status` is not in btq; nearest is a comment `# …`",
        requirement("takes at most 3 s", "# status approved"),
    ),
    (
        requirement("takes at most 3 s", "importance must"),
        "5:5 error syntax-error «importance» `importance` is not in btq; nearest is `priority` with a word",
        None,
    ),
    (
        requirement("takes at most 3 s", "wish Go takes at most 2 s"),
        "5:5 error syntax-error «wish» `wish` is not in btq; nearest is `goal`, a better bound than the required one",
        None,
    ),
    (
        requirement("tries at most 2 per mission"),
        "4:25 error unmatched-path «mission» unknown node `mission` | write `per run`",
        None,
    ),
    (
        "Action Go\n    input station\n" + tree('Go ("dock")'),
        '4:9 error syntax-error «"dock"» expected an attribute: key = value, found `"dock"` | '
        'a value goes after the name of its port: `station = "dock"`',
        "Action Go\n    input station\n" + tree('Go (station = "dock")'),
    ),
    (
        tree("Timeout (30)", "    Go"),  # of which unit nobody knows
        "2:14 error syntax-error «30» expected an attribute: key = value, found `30` | "
        "a value goes after the name of its port: `msec = 30`, or with a unit, `msec = 30 s`",
        None,
    ),
    (
        tree("Timeout (30 s)", "    Go"),
        "2:14 error syntax-error «30 s» expected an attribute: key = value, found `30 s` | "
        "a value goes after the name of its port: `msec = 30 s`",
        tree("Timeout (msec = 30 s)", "    Go"),
    ),
]


def test_subjects_that_are_words_of_other_notations() -> None:
    text = tree("->", "    status satisfies r", "    Go") + "QualityReq r\n    status takes at most 3 s\n"
    assert mistakes(text) == []


@pytest.mark.parametrize(
    ("text", "said", "mended"), [*FROM_XML, *FROM_PYTHON, *FROM_THE_PUBLISHED_SYNTAX, *FROM_OTHER_LANGUAGES]
)
def test_one_mistake_is_one_diagnostic(text: str, said: str, mended: str | None) -> None:
    found = mistakes(text)
    assert [" | ".join((line, *found[0].notes)) for line in show(text, found)] == [said]
    assert [after(text, fix) for fix in found[0].fixes] == ([mended] if mended else [])
    assert mistakes(mended or "") == []


@pytest.mark.parametrize(
    ("text", "mended"),
    [
        (tree("Retry attempts=3", "    Go"), tree("Retry (num_attempts=3)", "    Go")),
        (tree("- Action: Go"), tree("Action Go")),
        (tree("->", "    <Go/>", "    <Turn/>"), tree("->", "    Go", "    Turn")),
        ("tree Main:\n    Sequence:\n        Go\n", tree("Sequence", "    Go")),
    ],
)
def test_several_mistakes_are_mended_one_after_another(text: str, mended: str) -> None:
    while found := mistakes(text):
        (fix,) = found[0].fixes
        assert after(text, fix) != text
        text = after(text, fix)
    assert text == mended


def test_a_person_is_told_what_to_write(tmp_path: Path) -> None:
    mission = tree("Retry(num_attempts = 5) Again", "    Dock") + "QualityReq r\n    Main Dock succeeds\n"
    (tmp_path / "mission.btq").write_text(mission, encoding="utf-8")
    command = [sys.executable, "-m", "btq_lang", "check", "--output-format", "concise", "mission.btq"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stdout.splitlines()[:2]) == (
        1,
        [
            "mission.btq:2:29: error[syntax-error] a node's label goes before its brackets",
            "mission.btq:5:5: error[syntax-error] a path is written with `/`: `Main/Dock`",
        ],
    )


def mistakes(text: str) -> list[Diagnostic]:
    """What is wrong with a mission, but that its nodes have no models."""
    workspace = Workspace.of({MAIN: text, "stations.btq": "Action Go\n"})
    return [found for found in check(workspace, MAIN) if found.rule != "no-models"]
