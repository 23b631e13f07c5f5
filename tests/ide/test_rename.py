"""Renaming, in every file or not at all."""

from __future__ import annotations

import pytest
from feature_asserts import check_no_rename, check_rename


@pytest.mark.parametrize(
    ("text", "name", "after"),
    [
        (
            "Root Ma$0in\nBehaviorTree Main\n    Pick\n",
            "Mission",
            "Root Mission\nBehaviorTree Mission\n    Pick\n",
        ),
        # Quotes where the new name needs them, and where there were some.
        (
            "BehaviorTree Main\n    SubTree Do$0ck\nBehaviorTree Dock\n    Pick\n",
            "to_the_dock!",
            "BehaviorTree Main\n    SubTree to_the_dock!\nBehaviorTree to_the_dock!\n    Pick\n",
        ),
        (
            'QualityReq r$0q "x"\nBehaviorTree Main\n    Pick satisfies rq\n',
            "in time",
            'QualityReq "in time" "x"\nBehaviorTree Main\n    Pick satisfies "in time"\n',
        ),
        (
            'BehaviorTree Main\n    Pick (satisfies QualityReq ID = "r$0q" description = "x")\n',
            "rq2",
            'BehaviorTree Main\n    Pick (satisfies QualityReq ID = "rq2" description = "x")\n',
        ),
        # `{=}` means the entry, which keeps its name, or the port, which does not.
        (
            "Action Pick\n    input fr$0om : string\nBehaviorTree Main\n    Pick (from = {=})\n",
            "shelf",
            "Action Pick\n    input shelf : string\nBehaviorTree Main\n    Pick (shelf = {from})\n",
        ),
        (
            "BehaviorTree Main\n    ->\n        Pick (from = {=})\n        Place (at = {fr$0om})\n",
            "shelf",
            "BehaviorTree Main\n    ->\n        Pick (from = {shelf})\n        Place (at = {shelf})\n",
        ),
        (  # both in a tree that runs itself
            "BehaviorTree Main\n    input fr$0om : string\n    SubTree Main (from = {=})\n",
            "shelf",
            "BehaviorTree Main\n    input shelf : string\n    SubTree Main (shelf = {=})\n",
        ),
        (
            'BehaviorTree Main\n    ->\n        Script (code = "n := n + 1")\n        Pick (a = "{n$0}")\n',
            "count",
            'BehaviorTree Main\n    ->\n        Script (code = "count := count + 1")\n        Pick (a = "{count}")\n',
        ),
        (
            "signal spe$0ed : m/s from {v}\ncontext fast : speed > 1 m/s and max(speed) < 2 m/s\n",
            "velocity",
            "signal velocity : m/s from {v}\ncontext fast : velocity > 1 m/s and max(velocity) < 2 m/s\n",
        ),
        (
            "QualityReq slow(lim$0it : m/s)\n    keeps v <= limit\napply slow(limit = 1 m/s) to Pick\n",
            "top",
            "QualityReq slow(top : m/s)\n    keeps v <= top\napply slow(top = 1 m/s) to Pick\n",
        ),
        (
            'quality gentle$0ness : safety "soft"\nBehaviorTree Main\n    Pick satisfices safety.Gentleness\n',
            "softness",
            'quality softness : safety "soft"\nBehaviorTree Main\n    Pick satisfices safety.softness\n',
        ),
        (
            "QualityReq rq\n    Fetch takes at most 1 s\nBehaviorTree Main\n    Pick Fe$0tch\n",
            "Bring",
            "QualityReq rq\n    Bring takes at most 1 s\nBehaviorTree Main\n    Pick Bring\n",
        ),
        (
            "BehaviorTree Main\n    Pick Fe$0tch\nQualityReq rq\n    Main/Fetch takes at most 1 s\n",
            "satisfies",
            'BehaviorTree Main\n    Pick "satisfies"\nQualityReq rq\n    Main/"satisfies" takes at most 1 s\n',
        ),
        # A custom node without a model is renamed everywhere.
        (
            "//- a.btq\nBehaviorTree A\n    Pi$0ck\n//- b.btq\nBehaviorTree B\n    Pick\n",
            "Grasp",
            "//- a.btq\nBehaviorTree A\n    Grasp\n//- b.btq\nBehaviorTree B\n    Grasp\n",
        ),
        (
            '//- main.btq\ninclude "lib.btq"\nBehaviorTree Main\n    P$0ick\n//- lib.btq\nAction Pick\n',
            "Grasp",
            '//- main.btq\ninclude "lib.btq"\nBehaviorTree Main\n    Grasp\n//- lib.btq\nAction Grasp\n',
        ),
    ],
)
def test_rename(text: str, name: str, after: str) -> None:
    check_rename(text, name, after)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("BehaviorTree Main\n    $0->\n        Pick\n", "cannot rename `Sequence`: the engine defines it"),
        (
            "BehaviorTree Main\n    Timeout (ms$0ec = 1 s)\n        Pick\n",
            "cannot rename `msec`: the engine defines it",
        ),
        ("BehaviorTree Main\n    Pick satisfices safe$0ty\n", "cannot rename `safety`: the quality model defines it"),
        ("BehaviorTree Main\n    Pick (_ski$0pIf = x)\n", "cannot rename an attribute of the engine"),
        ("BehaviorTree Main\n    SubTree Do$0ck\n", "cannot rename `Dock`: it is not defined"),
        ("BehaviorTree Main\n  $0  Pick\n", "nothing to rename here"),
        (
            "//- main.btq\nBehaviorTree Main\n    SubTree Do$0ck\n//- lib.btq\nBehaviorTree Dock\n    Pick\n",
            "cannot rename `Dock`: its definition is in lib.btq, which this file does not include",
        ),
        (
            "BehaviorTree Main\n    SubTree Dock (_autoremap = true at = {a$0t})\n",
            "cannot rename: `_autoremap` passes every entry under its own name",
        ),
    ],
)
def test_no_rename(text: str, reason: str) -> None:
    check_no_rename(text, reason)


@pytest.mark.parametrize(
    ("text", "name", "reason"),
    [
        (
            "BehaviorTree Main\n    SubTree Do$0ck\nBehaviorTree Dock\n    Pick\nBehaviorTree Home\n    Pick\n",
            "Home",
            "`Home` is already in use: main.btq, line 5",
        ),
        ("BehaviorTree Main\n    Pi$0ck\n", "Retry", "`Retry` is a built-in node"),
        ("BehaviorTree Main\n    Pi$0ck\n", "my node", "the engine refuses the name: it contains a space"),
        (
            "BehaviorTree Main\n    ->\n        Pick (to = {wo$0rk})\n        Script (code = \"work := 'x'\")\n",
            "wörk",
            "a name in a script may contain only the letters A to Z, digits and `_`",
        ),
        ("signal sp$0eed : m/s\n", "top speed", "the name of a signal may contain only letters, digits and `_`"),
        ("context c : d\nsignal d$0 : bool\n", "c", "`c` is already a context: main.btq, line 1"),
        ("signal d : bool\ncontext c : d\ncontext e : c$0\n", "d", "`d` is already a signal: main.btq, line 1"),
        ("signal v : m/s\ncontext c : v$0 > 0\n", "not", "`not` would have another meaning here"),
        (
            "BehaviorTree Main\n    Pick (a = {b$0})\n",
            "x y",
            "the name of an entry must not contain braces, quotes, spaces, `@` or `=`",
        ),
        ('QualityReq r$0q "x"\n', "", "a name needs at least one character, on one line"),
        ("Action Pick\n    input fr$0om : string\n", "_skipIf", "the engine refuses the port name `_skipIf`"),
        (
            "Action Pick\n    input fr$0om\n    input to\nBehaviorTree Main\n    Pick (from = a to = b)\n",
            "to",
            "`to` is already in use: main.btq, line 3",
        ),
    ],
)
def test_no_rename_to_this(text: str, name: str, reason: str) -> None:
    check_no_rename(text, reason, name)
