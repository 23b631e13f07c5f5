"""Scenarios: the tree of every production, what people write instead, and words that are names elsewhere, as before."""

from __future__ import annotations

import pytest
import scenario_outlines  # noqa: F401  # the outlines of these items
from syntax_asserts import apply_fix, assert_fix, assert_invariants, assert_parse

from btq_lang.parser import parse, reparse
from btq_lang.syntax.scenarios import Given, Scenario
from btq_lang.syntax.tree import Tree

SCENARIO = 'scenario "S" of Deliver\n    {}\n    expect in_time\n'


def test_the_specified_example() -> None:
    assert_parse(
        """
        scenario "The station cannot be reached" of Deliver
            given MoveTo (location = "E") fails
            given MoveTo takes 20 s
            given BatteryLow answers false, false, true          # its first, second, and every later answer
            given Dock fails twice, then succeeds after 3 s
            given battery = 80 %
            when 30 s have passed: person_near = true            # the world changes
            expect mission succeeds within 2 min
            expect MoveTo runs "A", "E", "B", "C", "D"
            expect never node Grasp
            expect Dock tries at most 3
            expect in_time violated
        """,
        """
        scenario "The station cannot be reached" of Deliver
          given MoveTo (location="E") [fails]
          given MoveTo [takes 20s]
          given BatteryLow [answers false/false/true]
          given Dock [fails x twice] [succeeds after 3s]
          given battery = 80%
          when after 30s: person_near = true
          expect claim <mission> succeeds <= 2min
          expect runs MoveTo: "A" "E" "B" "C" "D"
          expect claim never (node Grasp)
          expect claim <Dock> tries <= 3
          expect verdict in_time violated
        """,
    )


def test_givens() -> None:
    assert_parse(
        """
        given every MoveTo takes 20 s
        given Deliver/"Move To" (x = 1, y = {goal}) after 3 s succeeds 3 times and writes tubes = 2, "a b" = "c", fails
        given Dock does not end
        given Dock skips once, fails twice, then answers true, false, then succeeds
        given {goal} = "A"
        given {@goal} = {other}
        given speed = -0.5 m/s
        """,
        """
        given every MoveTo [takes 20s]
        given Deliver/"Move To" (x=1 y={goal}) [after 3s succeeds x 3 writes (tubes=2 "a b"="c")] [fails]
        given Dock [does]
        given Dock [skips x once] [fails x twice] [answers true/false] [succeeds]
        given {goal} = "A"
        given {@goal} = {other}
        given speed = -0.5m/s
        """,
    )


def test_changes() -> None:
    assert_parse(
        """
        scenario "S" verifies in_time, "REQ.1"
            when Dock (station = "A", n = 2) fails for the 2 time: every MoveTo does not end
            when mission starts: {x} = 3
            when Deliver/Dock halts for the second time: mission halts
            when {x} > 3 and battery < 3 %: Dock fails
            when node Dock: Dock fails
            when near: speed = 0 m/s
        """,
        """
        scenario "S" verifies in_time, "REQ.1"
          when event Dock fails (station="A" n=2) #2: every MoveTo [does]
          when event (mission) starts: {x} = 3
          when event Deliver/Dock halts #2: mission halts
          when (and ({x} > 3) (battery < 3%)): Dock [fails]
          when (node Dock): Dock [fails]
          when near: speed = 0m/s
        """,
    )


def test_expectations() -> None:
    assert_parse(
        """
        scenario "S"
            expect succeeds
            expect succeeds within 3 min
            expect every MoveTo takes at most 3 s
            expect never {x} > 3
            expect from Pick starts to Place succeeds takes at most 45 s
            expect each Pick fails is followed by Recover starts within 5 s
            expect Dock runs at least 3 per 10 s
            expect Dock runs 1, 2.5, 3 m, {key}
            expect every MoveTo (speed = 1, location) runs "A"
            expect Deliver/MoveTo (speed = 1) runs "A"
            expect finally {done} == true or not near
            expect mission does not end
            expect mission fails
            expect mission halts
            expect mission fails at most 1 per run
            expect in_time
            expect "REQ 1"
            expect in_time satisfied
            expect "REQ 1" undecided
            expect never exercised
            expect in_time never exercised
            expect "look" never exercised
            expect in_time not applicable
            expect in_time unknown
        """,
        """
        scenario "S"
          expect claim succeeds
          expect claim succeeds <= 3min
          expect claim <every MoveTo> takes <= 3s
          expect claim never ({x} > 3)
          expect claim <from Pick starts to Place succeeds> takes <= 45s
          expect claim <each Pick fails> followed <= 5s Recover starts
          expect claim <Dock> runs >= 3 per 10s
          expect runs Dock: 1 2.5 3m {key}
          expect runs every MoveTo (speed=1).location: "A"
          expect runs Deliver/MoveTo (speed=1): "A"
          expect finally (or ({done} == true) (not near))
          expect no end
          expect ends fails
          expect ends halts
          expect claim <mission> fails <= 1 per run
          expect verdict in_time
          expect verdict "REQ 1"
          expect verdict in_time satisfied
          expect verdict "REQ 1" undecided
          expect claim never exercised
          expect verdict in_time never exercised
          expect claim <"look"> never exercised
          expect verdict in_time not applicable
          expect verdict in_time unknown
        """,
    )


@pytest.mark.parametrize(
    ("step", "message", "title", "fixed"),
    [
        ("given Dock succeed", "this is written `succeeds`", "Write `succeeds`", "given Dock succeeds"),
        (
            "given Dock fals",
            "unknown word `fals`; did you mean `fails`?",
            "Replace `fals` with `fails`",
            "given Dock fails",
        ),
        ("given Dock hangs", "this is written `does not end`", "Write `does not end`", "given Dock does not end"),
        ("given Dock returns FAILURE", "this is written `fails`", "Write `fails`", "given Dock fails"),
        ("given Dock then fails", "the first behavior has no `then`", "Remove `then`", "given Dock fails"),
        (
            "given Dock fails twice then succeeds",
            "behaviors are separated by `, then`",
            "Write `, then`",
            "given Dock fails twice, then succeeds",
        ),
        (
            "given Dock fails and then succeeds",
            "behaviors are separated by `, then`",
            "Write `, then`",
            "given Dock fails, then succeeds",
        ),
        (
            "given Dock takes at most 3 s",
            "a duration is given as a value, without a bound",
            "Remove the bound",
            "given Dock takes 3 s",
        ),
        ("given Dock 3 s", "expected what the node does, found `3 s`", "Put `takes` before it", "given Dock takes 3 s"),
        (
            "given Dock succeeds afer 3 s",
            "unknown word `afer`; did you mean `after`?",
            "Replace `afer` with `after`",
            "given Dock succeeds after 3 s",
        ),
        (
            "given Low answers true false",
            "expected `,` before `false`",
            "Put `,` before it",
            "given Low answers true, false",
        ),
        ("given Low answers yes", "an answer is true or false, not `yes`", "Write `true`", "given Low answers true"),
        ("given Low is true", "a value goes after `=`", "Write `answers`", "given Low answers true"),
        (
            "given Low true",
            "expected what the node does, found `true`",
            "Put `answers` before it",
            "given Low answers true",
        ),
        ("given battery == 80 %", "a value goes after `=`", "Write `=`", "given battery = 80 %"),
        (
            'given "battery" = 80 %',
            "a signal has no quotes, and an entry is in braces: `{key} = …`",
            "Write `{battery}`",
            "given {battery} = 80 %",
        ),
        (
            "given Dock succeeds and writes {x} = 3",
            "the entries that a node writes have no braces",
            "Write `x`",
            "given Dock succeeds and writes x = 3",
        ),
        (
            "given all Dock fails",
            "all nodes of a kind are written `every …`",
            "Replace `all` with `every`",
            "given every Dock fails",
        ),
        (
            "when 30 s: x = 3",
            "a time is written `30 s have passed`",
            "Write `30 s have passed`",
            "when 30 s have passed: x = 3",
        ),
        (
            "when 1 s has passed: x = 3",
            "a time is written `1 s have passed`",
            "Write `1 s have passed`",
            "when 1 s have passed: x = 3",
        ),
        (
            "when after 30 s: x = 3",
            "a time is written `30 s have passed`",
            "Write `30 s have passed`",
            "when 30 s have passed: x = 3",
        ),
        (
            "when Dock fails x = 3",
            "expected `:` and what happens then, found `x`",
            "Put `:` before it",
            "when Dock fails: x = 3",
        ),
        ("when Dock fails, then x = 3", "what happens then goes after `:`", "Write `:`", "when Dock fails: x = 3"),
        (
            "when Dock fails: mission stops",
            "expected `halts`, found `stops`",
            "Replace `stops` with `halts`",
            "when Dock fails: mission halts",
        ),
        (
            "expects mission succeeds",
            "unknown word `expects`; did you mean `expect`?",
            "Replace `expects` with `expect`",
            "expect mission succeeds",
        ),
        (
            "then mission succeeds",
            "unknown word `then`; did you mean `expect`?",
            "Replace `then` with `expect`",
            "expect mission succeeds",
        ),
        (
            "Given Dock fails",
            "unknown word `Given`; did you mean `given`?",
            "Replace `Given` with `given`",
            "given Dock fails",
        ),
        (
            "expect mission should succeed within 3 min",
            "this clause is written `mission succeeds within 3 min`",
            "Write `succeeds`",
            "expect mission succeeds within 3 min",
        ),
        (
            "expect Dock fails",
            "this claim is written `fails at least 1 per run`",
            "Write `fails at least 1 per run`",
            "expect Dock fails at least 1 per run",
        ),
        (
            "expect Dock runs twice",
            "this claim is written `starts between 2 and 2 per run`",
            "Write `starts between 2 and 2 per run`",
            "expect Dock starts between 2 and 2 per run",
        ),
        (
            "expect Deliver/Dock never runs",
            "this claim is written `never node Deliver/Dock`",
            "Write `never node Deliver/Dock`",
            "expect never node Deliver/Dock",
        ),
        ("expect Dock does not fail", "this claim is written `succeeds`", "Write `succeeds`", "expect Dock succeeds"),
        ("expect Dock runs A", "a value of a port goes in quotes", "Put quotes around it", 'expect Dock runs "A"'),
        ('expect Dock runs "A" "B"', 'expected `,` before `"B"`', "Put `,` before it", 'expect Dock runs "A", "B"'),
        (
            "expect in_time is violated",
            "this verdict is written `violated`",
            "Write `violated`",
            "expect in_time violated",
        ),
        ("expect in_time violatd", "this verdict is written `violated`", "Write `violated`", "expect in_time violated"),
        (
            "expect in_time holds",
            "this verdict is written `satisfied`",
            "Write `satisfied`",
            "expect in_time satisfied",
        ),
        (
            "expect {done} == true",
            "a condition at the end of the run goes after `finally`",
            "Put `finally` before it",
            "expect finally {done} == true",
        ),
        (
            "expect mission does not finish",
            "expected `end`, found `finish`",
            "Replace `finish` with `end`",
            "expect mission does not end",
        ),
    ],
)
def test_near_forms(step: str, message: str, title: str, fixed: str) -> None:
    text = SCENARIO.format(step)
    parsed = parse(text)
    assert_invariants(parsed)
    (problem,) = parsed.diagnostics
    assert problem.message == message
    (fix,) = (fix for fix in problem.fixes if fix.title == title)
    assert apply_fix(text, fix) == SCENARIO.format(fixed)
    assert parse(SCENARIO.format(fixed)).diagnostics == ()


ONE_CLAIM = (
    "a step expects one claim; write another `expect`, or a requirement with several clauses and expect its verdict"
)
A_NODE_FIRST = "a given begins with its node: `given Dock succeeds after 3 s`"


@pytest.mark.parametrize(
    ("step", "message", "note"),
    [
        ("given", "expected a node, a signal or {key}, found the end of the line", ""),
        (
            "given Dock",
            "expected what the node does: succeeds, fails, answers true, takes 3 s, …, found the end of the line",
            "",
        ),
        ("given after 3s succeeds", "expected what a node does, found `3s`", A_NODE_FIRST),
        (
            "given Dock succeeds twice after 3 s",
            "expected the end of the line, found `after`",
            "how often, and what the node writes, goes last: `succeeds after 3 s twice`",
        ),
        (
            "given Dock succeeds fails",
            "a behavior has one result: `succeeds` or `fails`",
            "what the node does in its next activation goes after `, then`",
        ),
        ("given Dock takes 3 s after 2 s", "a behavior has one duration: `takes` or `after`", ""),
        ("given Dock takes between 2 s and 3 s", "expected a duration: 3 s, found `between`", ""),
        ("given Dock fails 0 times", "expected a whole number from 1, found `0`", ""),
        ("given mission fails", "a given is about a node: the mission does what its nodes do", ""),
        ("given Dock does end", "expected `not`, found `end`", ""),
        ("when Dock fails:", "expected a node, a signal or {key}, found the end of the line", ""),
        ("when Dock fail: x = 3", "unknown word `fail`; did you mean `fails`?", ""),
        ("when Dock fails for the 1.5 time: x = 3", "expected a whole number from 1, found `1.5`", ""),
        ("when Dock fails for the 2nd time: x = 3", "unknown unit `nd`", "expected a unit of time: ms, s, min, h"),
        (
            "when",
            "expected what happens: `30 s have passed`, `Dock fails` or a condition, found the end of the line",
            "",
        ),
        (
            "expect",
            'expected a claim, `Dock runs "A"`, `finally {key} == 1` or a requirement, found the end of the line',
            "",
        ),
        ("expect mission", "expected a verb: takes, succeeds, needs, keeps, …, found the end of the line", ""),
        ("expect mission succeeds while near", "expected the end of the line, found `while`", ONE_CLAIM),
        (
            "and Dock fails",
            "expected given, when or expect, found `and`",
            "each step begins with its own word: given, when or expect",
        ),
        (
            "after 3 s: x = 3",
            "expected given, when or expect, found `after`",
            "what changes during the run is written `when 30 s have passed: person_near = true`",
        ),
        (
            "verifies in_time",
            "expected given, when or expect, found `verifies`",
            "it goes on the first line of the scenario",
        ),
    ],
)
def test_what_is_not_in_btq(step: str, message: str, note: str) -> None:
    parsed = parse(SCENARIO.format(step))
    assert_invariants(parsed)
    (problem,) = parsed.diagnostics
    assert (problem.message, "".join(problem.notes)) == (message, note)
    scenario = parsed.entries[0].item
    assert isinstance(scenario, Scenario)
    assert len(scenario.steps) >= 1  # the next line is read


def test_first_lines() -> None:
    assert_parse(
        """
        scenario
        scenario of T
            expect r
        scenario The lab
        scenario "a" verifies r of T
        scenario "a" verifies r s
        Scenario: "x"
        test "x"
        scenario "a" satisfies r
        """,
        """
        scenario MISSING
        scenario MISSING of T
          expect verdict r
        scenario MISSING
        scenario "a" verifies r
        scenario "a" verifies r, s
        scenario "x"
        scenario "x"
        scenario "a"
        """,
        "1:9 syntax-error «» expected the scenario's title in quotes, found the end of the line",
        "2:10 syntax-error «of» expected the scenario's title in quotes, found `of`",
        "4:10 syntax-error «The» expected the scenario's title in quotes, found `The`",
        "5:25 syntax-error «of» expected the end of the line, found `of`",
        "6:25 syntax-error «s» expected `,` before `s`",
        "7:1 syntax-error «Scenario» unknown word `Scenario`; did you mean `scenario`?",
        "8:1 syntax-error «test» unknown word `test`; did you mean `scenario`?",
        "9:14 syntax-error «satisfies» expected the end of the line, found `satisfies`",
    )
    assert_fix("scenario The lab\n", "Put quotes around it", 'scenario "The lab"\n')


def test_where_givens_go() -> None:
    assert_parse(
        """
        given Dock fails
        scenario "a"
            expect r
        given Dock succeeds
        Root M
            given Dock fails
            scenario "b"
                expect r
        """,
        """
        given Dock [fails]
        scenario "a"
          expect verdict r
        given Dock [succeeds]
        root M
          given Dock [fails]
          scenario "b"
            expect verdict r
        """,
        "4:1 syntax-error «given» unexpected given after the first scenario of its file",
        "6:5 syntax-error «given» unexpected given in a Root block",
    )


def test_steps_outside_a_scenario() -> None:
    assert_parse(
        """
        expect r
        given Dock fails
            expect r
        """,
        """
        skipped
        given Dock [fails]
        """,
        "1:1 syntax-error «expect» expected an item: BehaviorTree, QualityReq, include, signal, …, found `expect`",
        "3:5 syntax-error «expect r» unexpected indentation: the line above opens no block",
    )


def test_entries_are_read_in_scenarios_alone() -> None:
    text = "QualityReq r\n    keeps {x} > 3\n"
    (problem,) = parse(text).diagnostics
    assert problem.message == "expected a condition: a signal, a context, a value, …, found `{x}`"
    (problem,) = parse(f'scenario "S"\n    expect never {{x}} > 3\n{text}').diagnostics
    assert problem.message == "expected a condition: a signal, a context, a value, …, found `{x}`"


def test_the_words_are_names_elsewhere() -> None:
    (tree,) = parse("BehaviorTree given\n    scenario\n        given takes\n        expect (given = 3)\n").trees
    assert [node.head.text for node in tree.walk()] == ["scenario", "given", "expect"]


@pytest.mark.parametrize(
    "line",
    [
        'scenario "S"',
        "given battery = 3 %",
        'given {x} = "A"',
        "given every Dock fails",
        "given Deliver/Dock (x = 3) fails",
        "given Dock takes 3 s",
    ],
)
def test_a_forgotten_bracket_ends_before_it(line: str) -> None:
    parsed = parse(f"BehaviorTree T\n    A (x = 3\n{line}\n")
    assert [problem.rule for problem in parsed.diagnostics] == ["unclosed-bracket"]
    assert [type(entry.item) for entry in parsed.entries] == [Tree, Scenario if "scenario" in line else Given]


@pytest.mark.parametrize("line", ["scenario = 3", "given = 3", '"given" = 3'])
def test_a_bracket_goes_on_over_a_name(line: str) -> None:
    parsed = parse(f"BehaviorTree T (x = 3\n{line})\n    A\n")
    assert parsed.diagnostics == ()
    assert len(parsed.entries) == 1


def test_an_edit_reads_the_file_again_from_the_right_state() -> None:
    text = 'given A fails\nBehaviorTree T\n    A\nscenario "S"\n    expect r\ngiven B fails\n'
    moved = text.replace('scenario "S"', "QualityReq r")
    assert reparse(parse(text), moved).entries == parse(moved).entries
    assert reparse(parse(moved), text).entries == parse(text).entries
    assert [problem.message for problem in parse(text).diagnostics] == [
        "unexpected given after the first scenario of its file"
    ]
