"""Completion by place, in lines that are half typed."""

from __future__ import annotations

import re

import pytest
from feature_asserts import (
    check_accept,
    check_completion,
    check_documentation,
    check_filter,
    check_include,
    check_left,
    check_list,
    check_offers,
)

from btq_lang.ide.completion import complete
from btq_lang.ide.snippets import snippets_for
from btq_lang.parser import parse
from btq_lang.workspace.workspace import Workspace

FILES = """//- main.btq
signal battery : % from {battery_level}
context low : battery < 20 %
quality gentleness : safety "soft"
QualityReq slow(limit : m/s) : safety "Slow"
    keeps speed <= limit
Action MoveBase "Drives"
    input station : string "a name"
    input speed : double = 0.5
    output pose : string
Condition Near
BehaviorTree Main
    input ward : string
    -> First
        MoveBase ToWard (station = {goal} pose = {here}) tags heavy
        SubTree Dock (place = x)
        Script (code = "n := 1")
BehaviorTree Dock
    input place : string
    Wait
//- lib.btq
QualityReq far "Far away"
    takes at most 1 s
BehaviorTree Far
    Pick
"""
MAIN, LIB = FILES.split("//- lib.btq\n")


FUNCTIONS = ("max()", "min()", "mean()", "p95()", "age()")
CONDITION = ("low", "battery", "not", "node", *FUNCTIONS)
SPEEDS = ("m/s", "kmh", "mph")
DURATIONS = ("s", "ns", "us", "ms", "min", "h", "d", "week")
BEHIND_OPERAND = ("and", "or", "<", "<=", ">", ">=", "==", "!=")
TIMES = "signal far : km\nsignal spent : s\nQualityReq a(limit : min = 2 min, near : m)\n"
NODES = ("MoveBase", "Near", "Wait", "Script", "Sequence", "Main", "Dock")


def typed(line: str) -> str:
    """The files, with a line being typed at the end of main.btq."""
    return f"{MAIN}{line}\n//- lib.btq\n{LIB}"


@pytest.mark.parametrize(
    ("line", "labels"),
    [
        # Behind SubTree and Root: trees, those of other files too.
        ("BehaviorTree X\n    SubTree $0", ("Main", "Dock", "X", "Far")),
        ("Root M$0", ("Main", "Dock", "Far")),
        # After a characteristic and its dot: its parts, by any name of the whole.
        (
            "BehaviorTree X\n    Pick satisfices safety, performance-efficiency.$0",
            ("time-behaviour", "resource-utilization", "capacity"),
        ),
        ("quality quick : performance.ti$0", ("time-behaviour", "resource-utilization", "capacity")),
        ('QualityReq a : "Performance Efficiency".$0', ("time-behaviour", "resource-utilization", "capacity")),
        ("BehaviorTree X\n    Pick satisfices nonsense.$0", ()),
        # Requirements, with those that are elsewhere; their parameters.
        ("BehaviorTree X\n    Pick satisfies $0", ("slow", "far", "QualityReq")),
        ("BehaviorTree X\n    Pick satisfies slow, $0", ("slow", "far", "QualityReq")),
        ("BehaviorTree X\n    Pick (satisfies $0)", ("slow", "far", "QualityReq")),
        ("BehaviorTree X\n    Pick (satisfies QualityReq ID = $0)", ("slow", "far")),
        ("BehaviorTree X\n    Pick satisfies slow($0", ("limit",)),
        ("apply $0", ("slow", "far")),
        ("apply slow($0) to Pick", ("limit",)),
        ("apply slow $0", ("to",)),
        ("apply slow to every node tagged $0", ("heavy",)),
        # What follows a node and what follows a list.
        ("BehaviorTree X\n    Pick $0", ("satisfies", "satisfices", "tags")),
        ("BehaviorTree X\n    Pick satisfies slow $0", ("satisfies", "satisfices", "tags")),
        ("BehaviorTree X\n    Pick tags $0", ("heavy",)),
        # Entries of the blackboard.
        ("BehaviorTree X\n    input shelf : string\n    Pick (from = {$0", ("=", "shelf", "@battery_level")),
        ("BehaviorTree X\n    Pick (a = {there} from = {t$0} b = 1)", ("=", "there", "@battery_level")),
        ("BehaviorTree X\n    Pick (from = {@$0", ("battery_level",)),
        (
            'BehaviorTree X\n    input shelf : string\n    Script (code = "a := sh$0',
            ("shelf", "@battery_level", "true", "false"),
        ),
        # The grammar of clauses.
        ('QualityReq a "t" takes $0', ("at most", "at least", "less than", "more than", "between")),
        ('QualityReq a "t" takes at $0', ("most", "least")),
        ('QualityReq a "t"\n    on $0', ("violation", "average")),
        ('QualityReq a "t"\n    on violation $0', ("fail", "halt", "warn", "log")),
        ('QualityReq a "t"\n    verified by $0', ("monitor", "analysis", "test", "review")),
        ('QualityReq a "t"\n    uses at most 3 Wh of $0', ("battery",)),
        ('QualityReq a "t"\n    keeps $0', ("low", "battery", "not", "node", *FUNCTIONS)),
        ('QualityReq a "t"\n    starts within 1 s after Dock $0', ("fails", "finishes", "halts", "starts", "succeeds")),
        (
            'QualityReq a "t"\n    starts within 1 s after Wait fails or Dock $0',
            ("fails", "finishes", "halts", "starts", "succeeds"),
        ),
        ('QualityReq a "t"\n    from Wait fails or Dock starts $0', ("to", "until", "or")),
        (
            'QualityReq a "t"\n    keeps low\n    from Wait fails until Dock $0',
            ("fails", "finishes", "halts", "starts", "succeeds"),
        ),
        ('QualityReq a "t"\n    each Wait fails $0', ("is followed by", "or")),
        ('QualityReq a "t"\n    each Wait $0', ("fails", "finishes", "halts", "starts", "succeeds")),
        ('QualityReq a "t"\n    each Wait fails is $0', ("followed by",)),
        ('QualityReq a "t"\n    each Wait fails is followed $0', ("by",)),
        # In the brackets of a condition, closed or not: its parts, and no clause, for what is open goes on.
        ('QualityReq a "t"\n    keeps ($0', CONDITION),
        ('QualityReq a "t"\n    keeps low and (not ($0)', CONDITION),
        ('QualityReq a "t"\n    takes at most 3 s if ($0', CONDITION),
        ("context high : ($0)", CONDITION),
        ('BehaviorTree X\n    Pick (satisfies QualityReq a "t" keeps ($0', CONDITION),
        ('QualityReq a "t"\n    keeps battery <= ($0)', ("battery", *FUNCTIONS)),
        ('QualityReq a "t"\n    keeps (battery $0)', BEHIND_OPERAND),
        ('QualityReq a "t"\n    takes at most 3 s if (low $0', BEHIND_OPERAND),
        ('QualityReq a "t"\n    keeps max($0)', ("battery",)),
        ('QualityReq a "t"\n    keeps max(ba$0) < 3', ("battery",)),
        ('QualityReq a "t"\n    keeps (low or max($0) >= 15 %', ("battery",)),
        ('QualityReq a "t"\n    keeps max(battery $0', ()),
        ("QualityReq max($0", ()),
        # Of what a value measures: no signal that is none where that is certain, else those that do first.
        (f"{TIMES}    takes at most $0", ("limit", "spent")),
        (f"{TIMES}    succeeds within $0", ("limit", "spent")),
        (f"{TIMES}    runs every $0", ("limit", "spent", *NODES)),
        (f"{TIMES}    takes at most 9 s\n    goal $0", ("limit", "spent")),
        (f"{TIMES}    uses at most 9 m\n    goal $0", ("limit", "near", "battery", "far", "spent")),
        (f"{TIMES}    tries at most $0", ("limit", "near", "battery", "far", "spent")),
        (f"{TIMES}    keeps far <= $0", ("near", "far", "limit", "battery", "spent", *FUNCTIONS)),
        (f"{TIMES}    keeps near <= $0", ("near", "far", "limit", "battery", "spent", *FUNCTIONS)),
        (f"{TIMES}    keeps battery > 3 % and far + $0", ("near", "far", "limit", "battery", "spent", *FUNCTIONS)),
        (f"{TIMES}    keeps far > 3 * $0", ("limit", "near", "battery", "far", "spent", *FUNCTIONS)),
        (f"{TIMES}    in at least $0", ("battery",)),
        # Units alone that measure what is declared; the one that it is declared with first.
        ("BehaviorTree X\n    Pick satisfies slow(limit = 10 $0)", (*SPEEDS, "limit")),
        ("BehaviorTree X\n    Pick (satisfies slow(limit = 10$0))", SPEEDS),
        ("apply slow(limit = 1 m/s if battery < 3 % else 3$0) to Pick", SPEEDS),
        ("signal a : m/s initially 5$0", SPEEDS),
        ("signal a : m/s fresh within 5 s initially 3$0", SPEEDS),
        ("signal a : bool initially 5$0", ()),
        ("signal a : N*m/s initially 5$0", ("N*m/s", "W", "uW", "mW", "kW", "MW", "GW")),
        ("QualityReq a(n : m/s = 3 $0", SPEEDS),
        ("QualityReq a(k : m = 3 m, n : m/s = 3$0)", SPEEDS),
        # Counts have none; a window counts, or it is a time.
        ('QualityReq a "t"\n    tries at most 3$0', ()),
        ('QualityReq a "t"\n    over last 200 $0', ("activations", "runs", *DURATIONS)),
        ('QualityReq a "t"\n    over last 7$0', DURATIONS),
        # Strings and comments.
        ('include "$0', ("lib.btq",)),
        ("include $0", ("lib.btq",)),
        ("qualities $0", ("iso25010-2023", "iso25010-2011")),
        ('BehaviorTree X\n    Pick (name = "$0")', ()),
        ("# a comment $0", ()),
        ("# btq$0", ("btq: ignore[…]",)),
        # Models.
        ("Action $0", ("Pick", "Wait")),
        ("Action Wait\n    $0", ("input", "output", "inout")),
        ("BehaviorTree X\n    Condition $0", ("Near", "Wait")),
    ],
)
def test_all_that_may_stand_here(line: str, labels: tuple[str, ...]) -> None:
    check_completion(typed(line), *labels)


@pytest.mark.parametrize(
    ("line", "labels", "absent"),
    [
        ("Beh$0", ("BehaviorTree", "QualityReq", "Root"), ("satisfies",)),
        ("$0", ("BehaviorTree", "QualityReq", "include", "Root", "signal", "apply"), ("satisfies",)),
        (
            "BehaviorTree X\n    $0",
            ("MoveBase", "Near", "Wait", "->", "Sequence", "Retry", "RetryUntilSuccessful", "SubTree", "satisfies"),
            ("BehaviorTree", "takes at most"),
        ),
        (
            "BehaviorTree X\n    MoveBase (station = a $0",
            ("speed", "pose", "name", "_skipIf", "satisfies"),
            ("station", "_autoremap", "_uid"),
        ),
        ("BehaviorTree X\n    SubTree Dock ($0", ("place", "name", "_autoremap"), ("station",)),
        ("BehaviorTree X\n    Timeout ($0)", ("msec", "name", "_skipIf"), ("satisfied",)),
        ("BehaviorTree X\n    Timeout (msec = 3$0", ("s", "ms", "min"), ("m", "kg", "satisfies")),
        ("BehaviorTree X\n    Retry (num_attempts = 3 $0", ("name", "_skipIf"), ("s", "num_attempts")),
        (
            "BehaviorTree X\n    Pick satisfices perf$0",
            ("gentleness", "performance-efficiency", "safety", "performance-efficiency.time-behaviour"),
            ("satisfies",),
        ),
        ("BehaviorTree X\n    Pick (satisfices Quality = $0", ("gentleness", "safety"), ("satisfies",)),
        ('QualityReq a : $0 "t"', ("gentleness", "safety"), ("takes at most",)),
        ('QualityReq a "t" takes at most 30 $0', ("s", "min", "if"), ("m", "%", "takes at most", "on violation")),
        ('QualityReq a "t"\n    keeps battery >= 30$0', ("%", "m", "s"), ()),
        ('signal far : km\nQualityReq a "t"\n    keeps far < 3 $0', ("km", "m", "s", "%"), ()),
        ('signal far : km\nQualityReq a "t"\n    takes at most 3 s while far < 3 $0', ("km", "m", "s", "%"), ()),
        (
            'QualityReq a "t"\n    goal 1 s\n    $0',
            ("takes at most", "needs", "while", "in at least", "confidence", "over last", "on violation", "because"),
            ("satisfies", "BehaviorTree"),
        ),
        ('QualityReq a "t" on violation fail $0', ("takes at most", "goal"), ("on violation",)),
        ("QualityReq a(n : m/s)\n    keeps battery <= $0", ("battery", "n", "max()"), ("low", "not", "takes at most")),
        (f"{TIMES}    takes at most 3 s if low, $0", ("limit", "spent", "Main"), ("near", "battery", "far")),
        (f"{TIMES}    takes at most 3 s if far > 3 $0", ("km", "m", "s", "%"), ()),
        (f"{TIMES}    takes at most 3 s if far > 3 m else 3 $0", ("s", "ms", "min"), ("km", "m", "%")),
        ('QualityReq a "t"\n    tries at most 3 $0', ("per", "if", "takes at most"), ("m", "s", "%")),
        ('QualityReq a "t"\n    fails at most 3 $0', ("per", "if"), ("m", "s", "%")),
        ('QualityReq a "t"\n    takes at most 3 s\n    on $0', ("violation", "average"), ("s",)),
        ('QualityReq a "t"\n    fails at most 1 per 200 $0', ("s", "h"), ("m", "%")),
        ('QualityReq a "t"\n    fails at most 1 per 200 h $0', ("of", "takes at most"), ("s",)),
        ('QualityReq a "t"\n    fails at most 1 per 200 h of $0', ("Main",), ("runs", "battery")),
        ('QualityReq a "t"\n    succeeds at least 12 per $0', ("run", "Main"), ("m", "s", "%")),
        ('QualityReq a "t"\n    succeeds within 12 $0', ("s", "min"), ("per",)),
        ('QualityReq a "t"\n    runs between 3 and 9 $0', ("per", "if"), ("m", "s", "%")),
        ('QualityReq a "t"\n    tries at most 3 if low else 5 $0', ("per",), ("m", "s", "%")),
        ('QualityReq a "t"\n    tries at most 3 if battery < 5 $0', ("%", "m", "s"), ()),
        ('QualityReq a "t"\n    runs at least 3 per 9 $0', ("s", "ms"), ("m", "per", "%", "takes at most")),
        ('QualityReq a "t"\n    over last 7 d $0', ("takes at most",), ("activations", "runs", "s")),
        ("BehaviorTree X\n    Pick satisfies slow(limit = 1 m/s if battery < 3 $0)", ("%", "m", "s"), ()),
        (f"{TIMES}    in at least 95 $0", ("%", "of runs"), ("s", "m")),
        ('QualityReq a "t"\n    keeps low\n    in at least 95 % $0', ("of runs", "of time"), ("s",)),
        ('QualityReq a "t"\n    keeps low in at least 95 % of $0', ("runs", "time"), ("battery",)),
        ('QualityReq a "t"\n    takes at most 3 s in at least 95 % of $0', ("activations", "runs"), ("time",)),
        ("signal a : $0", ("m", "%", "m/s", "bool", "text"), ("level",)),
        ("QualityReq a(n : $0", ("m", "%", "m/s", "bool", "text"), ("takes at most",)),
        ("QualityReq a(n : m, k : $0) : safety", ("m", "%", "m/s", "bool", "text"), ("takes at most",)),
        ("BehaviorTree X\n    Pick satisfies QualityReq a(n : $0", ("m", "%", "bool"), ("limit", "takes at most")),
        ('QualityReq a "t"\n    keeps (low) $0', ("and", "or", "takes at most"), ("battery", "not")),
        ("signal a : m/s $0", ("from {}", "level", "fresh within"), ("m",)),
        ('QualityReq a "t"\n    from $0', ("mission", "when", "Main", "MoveBase", "ToWard"), ("Sequence",)),
        (
            'QualityReq a "t"\n    follows Wait fails or $0',
            ("mission", "when", "Main", "MoveBase", "ToWard"),
            ("battery",),
        ),
        ('QualityReq a "t"\n    follows Wait fails $0', ("or", "while"), ("to", "battery")),
        ('QualityReq a "t"\n    from Wait fails to Dock starts $0', ("or", "takes at most"), ("to",)),
        (
            'QualityReq a "t"\n    from Wait fails until $0',
            ("mission", "when", "Main", "MoveBase", "ToWard"),
            ("battery",),
        ),
        ('QualityReq a "t"\n    from Wait fails until Dock starts $0', ("or", "takes at most"), ("to",)),
        ('QualityReq a "t"\n    each $0', ("mission", "when", "Main", "MoveBase", "ToWard"), ("battery",)),
        (
            'QualityReq a "t"\n    each Wait fails is followed by $0',
            ("mission", "when", "low", "battery", "Main"),
            ("to",),
        ),
        (
            'QualityReq a "t"\n    each Wait fails is followed by Dock starts $0',
            ("or", "within", "while"),
            ("to", "by"),
        ),
        ('QualityReq a "t"\n    each Wait fails is followed by low $0', ("and", "or", "within", "while"), ("to", "by")),
        ('QualityReq a "t"\n    each Wait fails is followed by Dock starts within $0', (), ("to", "by", "while")),
        ("BehaviorTree X\n    MoveBase  # btq: ignore[$0", ("syntax-error", "unknown-node"), ()),
        ("BehaviorTree X\n    MoveBase  # btq: ignore[unknown-node, unk$0]", ("unknown-port",), ()),
    ],
)
def test_among_what_may_stand_here(line: str, labels: tuple[str, ...], absent: tuple[str, ...]) -> None:
    check_offers(typed(line), *labels, absent=absent)


@pytest.mark.parametrize(
    ("typed_before", "names"),
    [
        (
            "",
            "performance-efficiency.time-behaviou time-behaviou performance-efficiency.time-behavio Tim behaviou",
        ),
        (
            "Perf",
            "performance-efficiency.time-behaviou performance-efficiency.time-behavio time-behaviou Tim behaviou",
        ),
        (
            "time",
            "time-behaviou Tim behaviou performance-efficiency.time-behaviou performance-efficiency.time-behavio",
        ),
    ],
)
def test_the_name_that_is_typed_comes_first_for_editors_that_compare_beginnings(typed_before: str, names: str) -> None:
    """Each word lacks its last letter: complete, it leaves the list."""
    line = f"BehaviorTree X\n    Pick satisfices {typed_before}$0"
    check_filter(typed(line), "performance-efficiency.time-behaviour", names)


@pytest.mark.parametrize(
    ("line", "label", "after", "plain"),
    [
        ("    Move$0", "MoveBase", "    MoveBase (station = ${1:{=\\}})", "    MoveBase"),
        ("    Move$0 (station = x)", "MoveBase", "    MoveBase (station = x)", "    MoveBase (station = x)"),
        ("    Ret$0", "Retry …", "    Retry (num_attempts = ${1:1})\n    $0", "    Retry"),
        ("    Preco$0", "Precondition", '    Precondition (if = "${1:true}")\n    $0', "    Precondition"),
        ("    Pick (from = {w$0", "=", "    Pick (from = {=}", None),
        ("    Pick (from = {w$0})", "=", "    Pick (from = {=})", None),
        ("    MoveBase (st$0)", "station", "    MoveBase (station = ${0:{=\\}})", "    MoveBase (station = )"),
        ("    Timeout (msec = 30$0)", "s", "    Timeout (msec = 30 s)", None),
        ("    Timeout (msec = 30 m$0)", "min", "    Timeout (msec = 30 min)", None),
        ("    Pick satisfies s$0", "slow", "    Pick satisfies slow(limit = ${1:limit})", "    Pick satisfies slow"),
        ("    SubTree D$0", "Dock", "    SubTree Dock (place = ${1:{=\\}})", "    SubTree Dock"),
        ("    Pick satisfices perf$0", "safety", "    Pick satisfices safety", None),
        ("    Pick satisfices safety.ha$0", "hazard-warning", "    Pick satisfices safety.hazard-warning", None),
        ("    Pick  # btq: ign$0", "btq: ignore[…]", "    Pick  # btq: ignore[$0]", "    Pick  # btq: ignore[]"),
    ],
)
def test_what_is_written(line: str, label: str, after: str, plain: str | None) -> None:
    head = f"{MAIN.removeprefix('//- main.btq' + chr(10))}BehaviorTree X\n"
    check_accept(f"{head}{line}", label, f"{head}{after}", plain=f"{head}{plain}" if plain else None)


@pytest.mark.parametrize(
    ("line", "labels"),
    [
        # Entries, in braces where they have none yet; the root's with their `@`.
        ("BehaviorTree X\n    input shelf : string\n    Pick (from = $0)", ("{=}", "{shelf}", "{@battery_level}")),
        (
            "BehaviorTree X\n    MoveBase (station = {goal} speed = $0)",
            ("{=}", "{goal}", "{@battery_level}", "0.5"),
        ),
        ('BehaviorTree X\n    Pick (_skipIf = "@$0")', ("@battery_level",)),
        # What takes no entries.
        ("BehaviorTree X\n    SubTree Dock (_autoremap = $0)", ("true", "false")),
        ("BehaviorTree X\n    Pick (_skipIf = $0)", ('""',)),
        ("BehaviorTree X\n    Pick (name = $0)", ()),
        ("BehaviorTree X\n    Script (code = $0)", ('""',)),
        # Statuses, those that the port takes.
        (
            "BehaviorTree X\n    LoopInt (if_empty = $0)",
            ("{=}", "{@battery_level}", "SUCCESS", "FAILURE", "SKIPPED"),
        ),
        (
            "Action Other\n    input status : NodeStatus\nBehaviorTree X\n    Other (status = $0)",
            ("{=}", "{@battery_level}", "SUCCESS", "FAILURE", "RUNNING", "SKIPPED"),
        ),
        # The word that is typed is not known from itself; one that stands elsewhere is.
        ("BehaviorTree X\n    Pick tags w$0", ("heavy",)),
        ("BehaviorTree X\n    Pick (a = {there} b = {th$0})", ("=", "there", "@battery_level")),
        ("BehaviorTree X\n    Pick (a = {there} b = {there$0})", ("=", "there", "@battery_level")),
    ],
)
def test_values(line: str, labels: tuple[str, ...]) -> None:
    check_completion(typed(line), *labels)


def test_the_half_typed_word() -> None:
    check_offers(typed("BehaviorTree X\n    Mov$0"), "MoveBase", absent=["Mov"])
    check_offers(typed("BehaviorTree X\n    Sequence$0"), "Sequence")
    check_offers(typed("BehaviorTree X\n    MoveBase$0"), "MoveBase")
    check_offers(typed("BehaviorTree X\n    Action Mov$0"), "MoveBase", absent=["Mov"])
    check_offers(typed("BehaviorTree X\n    ->\n        Grip\n        Grip$0"), "Grip")


def test_what_every_is_followed_by() -> None:
    files = typed("apply slow(limit = 1 m/s) to every $0")
    check_completion(files, "MoveBase", "Near", "Wait", "Script", "Sequence", "Main", "Dock")
    check_offers(typed('QualityReq a "t"\n    every $0'), "MoveBase", absent=["ToWard"])


def test_documentation() -> None:
    check_documentation(
        typed("BehaviorTree X\n    Pick satisfies $0"),
        "far",
        "**far**\n\nFar away\n\n```btq\ntakes at most 1 s\n```",
    )
    check_documentation(
        typed("BehaviorTree X\n    MoveBase ($0"),
        "station",
        "`input station : string` (required): a name",
    )


def test_what_the_file_cannot_see_brings_its_include() -> None:
    check_include(typed("BehaviorTree X\n    Pick satisfies $0"), "far", 'include "lib.btq"\n')
    check_include(typed("BehaviorTree X\n    Pick satisfies $0"), "slow", "")
    check_include("//- a.btq\n# head\n\nRoot M$0\n//- b.btq\nBehaviorTree Far\n    Pick\n", "Far", 'include "b.btq"\n')


def test_the_cursor_on_an_empty_line_between_others() -> None:
    check_offers(
        "BehaviorTree Main\n    ->\n        $0\n        Pick\n", "Pick", "->", "SubTree", absent=["takes at most"]
    )
    check_offers('QualityReq a "t"\n    $0\n    on violation fail\n', "takes at most", absent=["SubTree"])


def test_no_include_that_would_define_something_twice() -> None:
    main = "Action Move\n    input to : string\nBehaviorTree Main\n    Move satisfies $0\n"
    check_completion(
        f"//- main.btq\n{main}"
        '//- same_tree.btq\nQualityReq a "A"\nBehaviorTree Main\n    Pick\n'
        '//- other_model.btq\nQualityReq b "B"\nAction Move\n    input speed : double\n'
        '//- same_model.btq\nQualityReq c "C"\nAction Move\n    input to : string\n'
        '//- brings_tree.btq\ninclude "same_tree.btq"\nQualityReq d "D"\n'
        '//- circle.btq\ninclude "main.btq"\nQualityReq e "E"\n'
        '//- apart.btq\nQualityReq f "F"\nBehaviorTree Far\n    Pick\n',
        "f",
        "c",
        "QualityReq",
    )


# ---- the list that opens by itself, and what Enter takes of it ----

SOON = 'QualityReq soon "Soon"\n    '


@pytest.mark.parametrize(
    ("line", "trigger", "labels"),
    [
        # A quote that closes a string opens nothing; one that opens a string shows what belongs there.
        (f'{SOON}because "why"$0', '"', ()),
        ('QualityReq a : safety "Safe"$0', '"', ()),
        ('BehaviorTree X\n    Pick (at = "a"$0)', '"', ()),
        ('include "$0', '"', ("lib.btq",)),
        ('include "$0"', '"', ("lib.btq",)),
        ('BehaviorTree X\n    Pick satisfies "$0"', '"', ("slow", "far", "QualityReq")),
        # Over a complete word none opens, but over one that begins others.
        ("BehaviorTree X\n    MoveBase$0", "", ()),
        ("BehaviorTree X\n    Near$0", "", ()),
        ("BehaviorTree X\n    Pick satisfies slow$0", "", ()),
        ("BehaviorTree X\n    Pick satisfices gentleness$0", "", ()),
        (f"{SOON}takes at most 30 s$0", "", ()),
        (f"{SOON}on violation fail$0", "", ()),
        (f"{SOON}keeps low$0", "", ()),
        ("signal$0", "", ()),
        ("BehaviorTree X\n    Retry$0", "", ("MoveBase",)),
        ("BehaviorTree X\n    Pick satisfices safety$0", "", ("gentleness",)),
        # A number is complete, with its decimal point, too; behind it units are begun.
        (f"{SOON}takes at most 0.$0", ".", ()),
        (f"{SOON}takes at most 30 $0", "", ("s", "ns")),
        (f"{SOON}keeps spare < 0.8 m/$0", "/", ("m", "N", "nm")),
        ("signal a : m/$0", "/", ()),
        # A name that begins with a capital is no keyword.
        ("BehaviorTree X\n    -> S$0", "", ()),
        ("BehaviorTree X\n    -> s$0", "", ("satisfies", "satisfices")),
        ("context a : low $0", "", ("and", "or")),
    ],
)
def test_the_list_that_opens_by_itself(line: str, trigger: str, labels: tuple[str, ...]) -> None:
    check_list(typed(line), *labels, trigger=trigger)


@pytest.mark.parametrize(
    ("line", "labels"),
    [
        # Typed to its end a word is left alone, though it may be written with ports: then Enter is a line break.
        ("BehaviorTree X\n    MoveBas$0", ("MoveBase",)),
        ("BehaviorTree X\n    MoveBase$0", ()),
        ("BehaviorTree X\n    MoveBase (stat$0", ("station",)),
        ("BehaviorTree X\n    MoveBase (station$0", ()),
        ("BehaviorTree X\n    Pick satisfies slow$0", ()),
        ("BehaviorTree$0", ()),
        # One that an editor finds in another, also with letters between its own, stays as it is.
        ("Action A\n    output label : string$0", ("string",)),
        ("Action A\n    output label : double$0", ("double",)),
        ("Action A\n    output label : bool$0", ()),
        # One that begins others stays, first and as it is.
        ("BehaviorTree X\n    Retr$0", ("Retry …", "Retry", "retry", "RetryUntilSuccessful")),
        ("BehaviorTree X\n    Retry$0", ("Retry", "retry", "RetryUntilSuccessful")),
        ("BehaviorTree X\n    Timeout$0", ("Timeout", "timeout")),
        (f"{SOON}succeeds$0", ("succeeds", "succeeds within", "succeeds at least", "succeeds at most")),
        ("BehaviorTree X\n    Pick satisfices perf$0", PERFORMANCE := (
            "performance", "performance-efficiency", "performance-efficiency.time-behaviour",
            "performance-efficiency.resource-utilization", "performance-efficiency.capacity",
        )),
        ("BehaviorTree X\n    Pick satisfices performance$0", PERFORMANCE),
        ("BehaviorTree X\n    Pick satisfices performance-efficiency$0", PERFORMANCE[1:]),
    ],
)  # fmt: skip
def test_what_is_left_of_the_list_behind_a_word(line: str, labels: tuple[str, ...]) -> None:
    check_left(typed(line), *labels)


def test_a_list_that_is_asked_for_opens_over_a_complete_word() -> None:
    check_offers(typed("BehaviorTree X\n    MoveBase$0"), "MoveBase", "MoveBase …")
    check_accept(
        typed("BehaviorTree X\n    MoveBase$0").partition("//- lib")[0].removeprefix("//- main.btq\n"),
        "MoveBase …",
        MAIN.removeprefix("//- main.btq\n") + "BehaviorTree X\n    MoveBase (station = ${1:{=\\}})\n",
    )


@pytest.mark.parametrize(
    ("line", "labels"),
    [
        ("BehaviorTree $0", ("Gone",)),
        ("SubTree $0", ("Gone",)),
        ("QualityReq $0", ("quick",)),
        ("BehaviorTree X\n    Pick satisfies QualityReq $0", ("quick",)),
        ("signal $0", ("depth",)),
        ("context $0", ("depth",)),
        ("quality $0", ("neatness",)),
        ("Action $0", ("Pick",)),
        ("BehaviorTree Go$0", ("Gone",)),
        ("BehaviorTree Gone$0", ()),
    ],
)
def test_where_a_name_is_declared_those_are_offered_that_are_referred_to(line: str, labels: tuple[str, ...]) -> None:
    files = """//- main.btq
BehaviorTree Main
    ->
        SubTree Gone
        Pick satisfies quick satisfices safety, neatness
QualityReq slow(limit : m) "Slow"
    keeps depth <= limit
//- lib.btq
signal far : m
"""
    main, lib = files.split("//- lib.btq\n")
    check_completion(f"{main}{line}\n//- lib.btq\n{lib}", *labels)


@pytest.mark.parametrize("line", ["quality neat : $0\nquality tidy : safety", "context neat : $0\ncontext tidy : low"])
def test_a_definition_does_not_offer_itself(line: str) -> None:
    check_offers(typed(line), "tidy", absent=("neat",))


def test_where_a_name_is_declared_no_file_is_read_that_refers_to_nothing_undeclared() -> None:
    main, user, other = (
        "BehaviorTree ",
        'include "main.btq"\nBehaviorTree A\n    SubTree B',
        "BehaviorTree C\n    SubTree D\n",
    )
    for declares_it, labels in ((False, ["B"]), (True, [])):
        tree = "\nBehaviorTree B\n    X\n" if declares_it else "\n"
        workspace = Workspace.of({"main.btq": main, "user.btq": user + tree, "other.btq": other})
        for path in ("user.btq", "other.btq"):
            workspace.files[path].let_go()
        assert [one.label for one in complete(workspace, "main.btq", len(main)).proposals] == labels
        assert workspace.files["user.btq"].is_parsed is not declares_it
        assert not workspace.files["other.btq"].is_parsed


ITEMS = ("tree", "mission", "req-time", "req-resource", "req-keeps", "req-odds", "skill")
NODE_SNIPPETS = ("reactive", "retry", "guard", "timeout", "classic-action")


@pytest.mark.parametrize(
    ("line", "labels", "absent"),
    [
        ("$0", ITEMS, NODE_SNIPPETS),
        ("TreeNodesModel\n    $0", ("skill",), (*ITEMS[:-1], *NODE_SNIPPETS)),
        ("BehaviorTree X\n    $0", NODE_SNIPPETS, ITEMS),
        ("BehaviorTree X\n    ->\n        $0", NODE_SNIPPETS, ITEMS),
        ("BehaviorTree X\n    -> $0", (), (*ITEMS, *NODE_SNIPPETS)),
        ("BehaviorTree $0", (), (*ITEMS, *NODE_SNIPPETS)),
        ("Action $0", (), (*ITEMS, *NODE_SNIPPETS)),
        (f"{SOON}$0", (), ("tree", "skill", *NODE_SNIPPETS)),
    ],
)
def test_snippets_are_offered_where_their_construct_may_begin(
    line: str, labels: tuple[str, ...], absent: tuple[str, ...]
) -> None:
    check_offers(typed(line), *labels, absent=absent)


@pytest.mark.parametrize("is_node", [False, True])
def test_every_snippet_is_without_a_mistake_as_it_comes(is_node: bool) -> None:
    for one in snippets_for("node" if is_node else "items"):
        text = filled(one.snippet or "")
        if is_node:
            text = "BehaviorTree X\n    " + text.replace("\n", "\n    ")
        assert [found for entry in parse(text).entries for found in entry.diagnostics] == [], text


def filled(snippet: str) -> str:
    """A snippet with what it proposes for its places, of choices the first."""
    hole = re.compile(r"\$\{(\d+)(?:\|([^,|]*)[^}]*|:((?:[^}\\]|\\.)*))\}")
    values = {number: chosen or text for number, chosen, text in hole.findall(snippet)}
    without_holes = hole.sub(lambda found: values[found[1]], snippet)
    return re.sub(r"\$(\d)", lambda found: values.get(found[1], ""), without_holes).replace("\\}", "}")


def test_in_a_long_list_every_word_stays_as_it_is_typed() -> None:
    """None is looked for in the others then; Enter is a line break all the same."""
    names = [f"Skill{number:03}" for number in range(300)]
    tree = "BehaviorTree Main\n    ->\n" + "".join(f"        {name}\n" for name in names)
    check_left(f"{tree}        Skill299$0\n", "Skill299")


@pytest.mark.parametrize(
    ("text", "insert"),
    [
        ("QualityReq soon :", " reliability"),
        ("QualityReq soon : ", "reliability"),
        ("BehaviorTree Main\n    Dock satisfices safety,", " reliability"),
        ("BehaviorTree Main\n    Dock satisfices safety, ", "reliability"),
    ],
)
def test_a_quality_right_after_its_sign_is_written_with_a_blank(text: str, insert: str) -> None:
    """An editor whose list goes on after a blank replaces that."""
    workspace = Workspace.of({"main.btq": text})
    proposals = complete(workspace, "main.btq", len(text)).proposals
    assert [each.insert for each in proposals if each.label == "reliability"] == [insert]
