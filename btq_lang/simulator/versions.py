"""How nodes differ between versions of the engine.

Source: facts about BehaviorTree.CPP 3.8 and 4.6 to 4.10, seen in runs of 3.8.7, 4.6.2 and 4.10.0, and read in the
sources between.
"""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.versions import numbers


class Dialect:
    """A version of the engine.

    Attributes:
        nav2: the distribution of ROS 2 whose nodes of Nav2 the program has; empty: none.
        is_old: it is version 3, which has other nodes, and no result SKIPPED.
        counts_skips: a Sequence whose child ran and was then skipped counts that as a skip (since 4.7).
        reads_attempts_again: Retry reads its port again after each failure (since 4.7).
        keeps_precondition: a Precondition asks no more once its child has begun (since 4.7).
        copies_queues: a loop over a literal has all its items again at each start (since 4.7).
        counts_copies: SetBlackboard counts the copy of an entry as a write (since 4.7).
        names_thrower: messages of exceptions name the node (since 4.9).
        has_real_truth: `true` in a script is a real number (since 4.9).
        halts_updated_child: SkipUnlessUpdated and WaitValueUpdate halt their child (since 4.9).
        types_constants: a number given to a port of a SubTree is one there (since 4.9.1), rather than a text.
        matches_prefixes: a case of a Switch matches a variable that begins with its number (up to 4.9).
    """

    def __init__(self, version: str, nav2: str = "") -> None:
        """A version, such as `4.6`."""
        key = numbers(version)
        self.nav2: Final = nav2
        self.is_old: Final = key < (4,)
        self.version: Final = version
        since_4_7 = key >= (4, 7)
        since_4_9 = key >= (4, 9)
        self.counts_skips: Final = since_4_7 or self.is_old  # there are none
        self.reads_attempts_again: Final = since_4_7
        self.keeps_precondition: Final = since_4_7
        self.copies_queues: Final = since_4_7
        self.counts_copies: Final = since_4_7
        self.names_thrower: Final = since_4_9
        self.has_real_truth: Final = since_4_9
        self.halts_updated_child: Final = since_4_9
        self.types_constants: Final = key >= (4, 9, 1) or key == (4, 9)
        self.matches_prefixes: Final = key < (4, 10)
