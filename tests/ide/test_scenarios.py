"""Scenarios in an editor: what their words name, wherever that is defined."""

from __future__ import annotations

import pytest
from feature_asserts import (
    check_accept,
    check_folds,
    check_goto,
    check_hover,
    check_offers,
    check_outline,
    check_references,
    check_rename,
    check_search,
    check_tokens,
)

MISSION = """\
//- mission.btq
signal battery : % from {level}
QualityReq in_time
    takes at most 2 min
Action MoveTo
    input station : string
BehaviorTree Deliver
    -> satisfies in_time
        MoveTo ToDock (station = {goal})
        SubTree Charge
BehaviorTree Charge
    Plug (current = {@amount}, by = {hand})
"""
CASES = """\
//- cases.btq
include "mission.btq"
given MoveTo takes 3 s
scenario "Closed" of Deliver verifies in_time
    given Deliver/ToDock (station = "A") fails
    given battery = 80 %
    given {goal} = {@amount}
    when battery < 3 %: every MoveTo does not end
    expect ToDock (station) runs "A"
    expect finally {goal} == "A"
    expect in_time violated
scenario "Charging" of Charge
    given {hand} = "left"
"""


@pytest.mark.parametrize(
    ("old", "new", "at"),
    [
        ("Deliver", "Bring", "scenario \"Closed\" of $0Deliver"),
        ("in_time", "in-time", "verifies $0in_time"),
        ("in_time", "on_time", "expect $0in_time violated"),
        ("ToDock", "ToShelf", "Deliver/$0ToDock"),
        ("MoveTo", "Drive", "every $0MoveTo"),
        ("battery", "charge", "when $0battery"),
        ("goal", "aim", "finally {$0goal}"),
        ("amount", "much", "{@$0amount}\n    when"),
        ("hand", "arm", "given {$0hand}"),
        ("station", "place", "ToDock ($0station)"),
        ("Charge", "Load", "\"Charging\" of $0Charge"),
    ],
)  # fmt: skip
def test_rename(old: str, new: str, at: str) -> None:
    plain = at.replace("$0", "")
    assert plain in CASES
    # As a whole word: `Charge` is no part of `Charging`.
    words = (MISSION + CASES).replace("Charging", "\0").replace(old, new).replace("\0", "Charging")
    check_rename(MISSION + CASES.replace(plain, at), new, words)


def test_references() -> None:
    check_references(
        "QualityReq <def>$0r</def>\n    takes at most 3 s\nBehaviorTree T\n    A satisfies <ref>r</ref>\n"
        'scenario "S" of T verifies <ref>r</ref>\n    expect <ref>r</ref>\n'
    )


def test_definition() -> None:
    check_goto('BehaviorTree <def>T</def>\n    A\nscenario "S" of $0T\n    expect succeeds\n')
    check_goto('Action A\n    input <def>x</def> : string\nscenario "S"\n    given A ($0x = 3) fails\n')


def test_hover() -> None:
    check_hover(
        'Action A\n    input x : string "where to"\nBehaviorTree T\n    A First\n'
        'scenario "S"\n    given First (<hover>$0x</hover> = 3) fails\n',
        "`input x : string` (required): where to",
    )
    check_hover(
        'scenario "S"\n    expect <hover>$0finally</hover> {done} == true\n',
        """
        **finally** (expectation) · `expect finally {done} == true`

        A condition at the end of the run.
        """,
    )


def test_outline_and_search() -> None:
    check_outline(
        'scenario "Closed" of Deliver\n    expect succeeds\nscenario "Open"\n',
        "scenario Closed | Deliver",
        "scenario Open",
    )
    check_search(
        'scenario "The station is closed"\n    expect succeeds\n', "closed", "scenario The station is closed (main.btq)"
    )


def test_folds() -> None:
    check_folds('<block>scenario "Closed"\n    given A fails\n    expect succeeds</block>\nBehaviorTree T\n')


def test_tokens() -> None:
    check_tokens(
        'scenario "S" of Main\n    given A (x = 1) fails twice\n',
        "keyword scenario",
        'string "S"',
        "keyword of",
        "class Main",
        "keyword given",
        "function A",
        "property x",
        "number 1",
        "keyword fails",
        "keyword twice",
    )


MODELS = """\
signal battery : % from {level}
signal door : bool from {door}
QualityReq in_time
    Deliver takes at most 2 min
Action MoveTo
    input station : string
Condition BatteryLow
BehaviorTree Deliver
    ->
        BatteryLow
        MoveTo ToDock (station = "A")
        MoveTo (station = {goal})
"""


@pytest.mark.parametrize(
    ("line", "offered", "absent"),
    [
        ("$0", ("given", "when", "expect"), ("succeeds", "MoveTo")),
        ("given $0", ("every", "battery", "Deliver", "MoveTo", "ToDock"), ("mission halts", "succeeds")),
        ("given every $0", ("MoveTo", "BatteryLow"), ("every",)),
        ("given Deliver/$0", ("MoveTo", "ToDock"), ("every",)),
        ("given MoveTo $0", ("succeeds", "fails", "does not end", "takes", "after", "skips"), ("answers", "MoveTo")),
        ("given BatteryLow $0", ("answers",), ("succeeds", "fails")),
        ("given BatteryLow answers $0", ("true", "false"), ("then",)),
        ("given BatteryLow answers false, $0", ("true", "false", "then"), ()),
        ("given MoveTo fails $0", ("after", "once", "twice", "and writes"), ("succeeds", "takes")),
        ("given MoveTo fails twice, $0", ("succeeds", "then"), ("true",)),
        ("given MoveTo fails twice, then $0", ("succeeds", "does not end"), ("then",)),
        ("given MoveTo does $0", ("not end",), ("fails",)),
        ("given MoveTo ($0) fails", ("station",), ("MoveTo",)),
        ("given ToDock ($0) fails", ("station",), ()),
        ("given MoveTo (station = $0) fails", ("A", "{goal}"), ("station",)),
        ('given MoveTo (station = "$0") fails', ("A",), ("station",)),
        ('given MoveTo (station = "A") $0', ("succeeds", "takes"), ("answers",)),
        ("given door = $0", ("true", "false"), ()),
        ("given {$0}", ("goal", "level"), ("MoveTo",)),
        ("when $0", ("mission", "MoveTo", "battery", "not"), ("in_time",)),
        ("when 30 s $0", ("have passed",), ("MoveTo",)),
        ("when MoveTo $0", ("fails", "halts", "starts"), ("true",)),
        ("when MoveTo fails $0", ("for the second time",), ("succeeds",)),
        ("when MoveTo fails for the second $0", ("time",), ()),
        ("when MoveTo fails: $0", ("every", "mission halts", "battery", "MoveTo"), ("in_time",)),
        ("when MoveTo fails: MoveTo $0", ("succeeds", "takes"), ("answers",)),
        (
            "expect $0",
            ("mission", "never node", "every", "finally", "in_time", "MoveTo", "succeeds"),
            ("while", "goal"),
        ),
        ("expect in_time $0", ("violated", "never exercised"), ()),
        ("expect MoveTo $0", ("runs", "succeeds", "takes", "tries"), ()),
        ("expect MoveTo runs $0", ("A", "{goal}", "every"), ()),
        ('expect MoveTo runs "A", $0', ("A", "{goal}"), ("every",)),
        ("expect MoveTo ($0) runs", ("station",), ()),
        ("expect finally $0", ("battery", "not", "node"), ("MoveTo fails",)),
        ("expect never $0", ("battery", "node"), ("while",)),
        ("expect mission does $0", ("not end",), ()),
    ],
)
def test_completion(line: str, offered: tuple[str, ...], absent: tuple[str, ...]) -> None:
    check_offers(f'{MODELS}scenario "S" of Deliver\n    {line}\n', *offered, absent=absent)


def test_completion_of_first_lines() -> None:
    check_offers(f"{MODELS}$0", "given", "scenario")
    check_offers(f'{MODELS}scenario "S" $0\n', "of", "verifies", absent=("given",))
    check_offers(f'{MODELS}scenario "S" of $0\n', "Deliver", absent=("in_time", "MoveTo"))
    check_offers(f'{MODELS}scenario "S" of Deliver verifies $0\n', "in_time", absent=("Deliver",))
    check_offers(f"{MODELS}given MoveTo $0\n", "succeeds", "takes", absent=("answers",))


def test_a_decorator_of_nav2_that_is_asked() -> None:
    text = "Decorator {0}\nBehaviorTree Main\n    {0}\n        MoveTo\ngiven {0} $0\n"
    check_offers(text.format("DistanceController"), "answers")
    check_offers(text.format("RateController"), absent=("answers",))


def test_accepted_proposals() -> None:
    check_accept(
        f'{MODELS}scenario "S"\n    given MoveTo (station = $0) fails\n',
        "A",
        f'{MODELS}scenario "S"\n    given MoveTo (station = "A") fails\n',
    )
    check_accept(
        f'{MODELS}scenario "S"\n    given batt$0\n', "battery …", f'{MODELS}scenario "S"\n    given battery = \n'
    )
