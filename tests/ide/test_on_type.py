"""Edits while typing: new lines, brackets, names that change together."""

from __future__ import annotations

import pytest
from feature_asserts import check_linked, check_typed


@pytest.mark.parametrize(
    ("text", "after"),
    [
        # A block is opened by trees, requirements, models, controls and decorators, not by leaves.
        ("BehaviorTree Main\n$0", "BehaviorTree Main\n    "),
        ("BehaviorTree Main\n    ->\n    $0", "BehaviorTree Main\n    ->\n        "),
        ("BehaviorTree Main\n    Retry First (n = 3)\n    $0", "BehaviorTree Main\n    Retry First (n = 3)\n        "),
        ("BehaviorTree Main\n    Pick\n$0", "BehaviorTree Main\n    Pick\n    "),
        ("BehaviorTree Main\n    SubTree Dock\n$0", "BehaviorTree Main\n    SubTree Dock\n    "),
        ("Decorator Wrap\nBehaviorTree Main\n    Wrap\n$0", "Decorator Wrap\nBehaviorTree Main\n    Wrap\n        "),
        ("Action Pick\n$0", "Action Pick\n    "),
        ('QualityReq rq "x"\n$0', 'QualityReq rq "x"\n    '),
        ('QualityReq rq "x"\n    takes at most 1 s\n$0', 'QualityReq rq "x"\n    takes at most 1 s\n    '),
        (
            'BehaviorTree Main\n    Pick\n        satisfies QualityReq rq "x"\n$0',
            'BehaviorTree Main\n    Pick\n        satisfies QualityReq rq "x"\n            ',
        ),
        ("BehaviorTree Main\n    -> satisfies rq\n$0", "BehaviorTree Main\n    -> satisfies rq\n        "),
        ("Root Main\n$0", "Root Main\n"),
        ('TreeNodesModel\n    Action A "a"\n    $0', 'TreeNodesModel\n    Action A "a"\n        '),
        # Between lines, too, and behind blank ones and comments.
        ("BehaviorTree Main\n    ->\n$0\n        Pick\n", "BehaviorTree Main\n    ->\n        \n        Pick\n"),
        ("BehaviorTree Main\n    ->  # first\n\n$0", "BehaviorTree Main\n    ->  # first\n\n        "),
        # In brackets, and when they are closed.
        ("BehaviorTree Main\n    Pick (\n$0", "BehaviorTree Main\n    Pick (\n        "),
        (
            "BehaviorTree Main\n    Pick (\n        a = 1\n        )$0",
            "BehaviorTree Main\n    Pick (\n        a = 1\n    )",
        ),
        ("BehaviorTree Main\n    Pick (a = 1)$0", "BehaviorTree Main\n    Pick (a = 1)"),
        # In the characters of the lines above, or of the first that is indented.
        ("BehaviorTree Main\n\t->\n\t    $0", "BehaviorTree Main\n\t->\n\t\t"),
        ("BehaviorTree Main\n\tPick (\n        $0", "BehaviorTree Main\n\tPick (\n\t\t"),
        ("BehaviorTree A\n\tPick\nBehaviorTree B\n    $0", "BehaviorTree A\n\tPick\nBehaviorTree B\n\t"),
        # A line that was parted between its words, one that was only moved down, and one that the editor indented.
        ("BehaviorTree Main\n    ->\n    $0Pick\n", "BehaviorTree Main\n    ->\n        Pick\n"),
        (
            "BehaviorTree Main\n    ->\n        Inverter\n            Pick\n\n$0        ->\n            Place\n",
            "BehaviorTree Main\n    ->\n        Inverter\n            Pick\n\n        ->\n            Place\n",
        ),
        (
            "BehaviorTree A\n    ->\n        Pick\n\n$0# The other one.\nBehaviorTree B\n    Place\n",
            "BehaviorTree A\n    ->\n        Pick\n\n# The other one.\nBehaviorTree B\n    Place\n",
        ),
        (
            "BehaviorTree Main\n    ->\n        Retry\n            Pick\n     \n$0   Place\n",
            "BehaviorTree Main\n    ->\n        Retry\n            Pick\n     \n        Place\n",
        ),
        (
            "BehaviorTree Main\n    ->\n        \n        $0Pick\n",
            "BehaviorTree Main\n    ->\n        \n        Pick\n",
        ),
        ("BehaviorTree Main\n    ->\n    \n        $0Pick\n", "BehaviorTree Main\n    ->\n    \n        Pick\n"),
        ("BehaviorTree Main\n    Pick (\n\n$0    a = 1\n)\n", "BehaviorTree Main\n    Pick (\n\n    a = 1\n)\n"),
        ("\r\n$0Root A\r\n", "\r\nRoot A\r\n"),
        # Not inside texts.
        ('BehaviorTree Main\n    Pick (a = "x\n$0y")\n', 'BehaviorTree Main\n    Pick (a = "x\ny")\n'),
    ],
)
def test_typed(text: str, after: str) -> None:
    check_typed(text, after)


@pytest.mark.parametrize(
    "text",
    [
        "QualityReq slow(<name>lim$0it</name> : m/s)\n    keeps v <= <name>limit</name>\n",
        "Root Main\nBehaviorTree Other\n    Pick (a = {<name>k$0ey</name>} b = {<name>key</name>})\n",
        # A name with quotes elsewhere, one that stands in another file, and one that stands alone are not linked.
        "Root Main\nBehaviorTree Other\n    Pick (key = {=} b = {ke$0y})\n",
        "//- main.btq\nsignal v$0 : m/s\n//- other.btq\nsignal w : m/s\n",
        "QualityReq slow(lim$0it : m/s)\n",
        "BehaviorTree Main\n    $0-> \n",
    ],
)
def test_linked(text: str) -> None:
    check_linked(text)
