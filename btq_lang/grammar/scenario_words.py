"""The words of scenarios that the parser knows."""

from __future__ import annotations

from typing import Final

STEPS: Final = ("given", "when", "expect")
RESULTS: Final = ("succeeds", "fails", "skips", "does", "answers")  # `does not end`
DURATIONS: Final = ("takes", "after")
BEHAVIOR_WORDS: Final = (*RESULTS, *DURATIONS)
ANSWERS: Final = ("true", "false")
TIMES: Final = ("once", "twice")
ORDINALS: Final = ("first", "second", "third")
OUTCOMES: Final = (("fails",), ("halts",))  # `mission succeeds` is a claim
VERDICTS: Final = (
    *(("satisfied",), ("violated",), ("unknown",), ("undecided",)),
    *(("never", "exercised"), ("not", "applicable")),
)
