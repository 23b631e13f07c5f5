"""Folding, selection ranges and document links."""

from __future__ import annotations

import pytest
from feature_asserts import check_folds, check_links, check_selection


@pytest.mark.parametrize(
    "text",
    [
        "<block>BehaviorTree Main\n    <block>->\n        Pick\n        Place</block></block>\nRoot Main\n",
        "<block>BehaviorTree Main\n    Pick <brackets>(\n        a = 1\n    )</brackets></block>\n",
        "<comment># one\n# two</comment>\n\n# three\n<block>BehaviorTree Main\n    Pick</block>\n",
        '<includes>include "a.btq"\ninclude "b.btq"</includes>\n',
        "<comment>/* one\ntwo */</comment>\nRoot Main # behind\n",
        "BehaviorTree Main",
        "",
    ],
)
def test_folds(text: str) -> None:
    check_folds(text)


def test_selection_grows() -> None:
    check_selection(
        'BehaviorTree Main\n    ->\n        Pick (from = "the sh$0elf")\n            satisfies rq\n        Place\n',
        "the shelf",
        '"the shelf"',
        'from = "the shelf"',
        '(from = "the shelf")',
        'Pick (from = "the shelf")',
        'Pick (from = "the shelf")\n            satisfies rq',
        '->\n        Pick (from = "the shelf")\n            satisfies rq\n        Place',
        'BehaviorTree Main\n    ->\n        Pick (from = "the shelf")\n            satisfies rq\n        Place',
    )


def test_selection_in_nothing() -> None:
    check_selection("$0")
    check_selection("Root Main\n\n$0\n")


def test_links() -> None:
    check_links(
        """
        //- missions/main.btq
        include "<link>../lib.btq</link>"
        include "<link>nowhere.btq</link>"
        include "<link>lib.btq</link>" (ros_pkg = "p")
        //- lib.btq
        Action Pick
        """,
        "lib.btq",
        None,
        None,
    )
