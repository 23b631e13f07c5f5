"""What people write instead of the words of scenarios, as in Gherkin or in plain English, and how it is reported.

One invariant: a function here reports at most one mistake, at the words that are wrong, with what is written instead.
"""

from __future__ import annotations

from typing import Final

from btq_lang.diagnostics.model import replace_fix, write_fix
from btq_lang.grammar.conditions import bound_ahead
from btq_lang.grammar.cursor import Cursor
from btq_lang.grammar.scenario_words import ANSWERS, BEHAVIOR_WORDS, DURATIONS, STEPS, TIMES, VERDICTS
from btq_lang.syntax.tokens import NAME, NEWLINE, QUANTITY
from btq_lang.util.spelling import near
from btq_lang.util.text import Span


def step_meant(cursor: Cursor) -> str:
    """Report a line that does not begin a step; the word that it is read with, or empty."""
    meant = ""
    if cursor.kind == NAME and cursor.kinds[cursor.index + 1] != NEWLINE:
        meant = _STEPS_MEANT.get(cursor.raw.casefold(), "") or (near(cursor.raw, STEPS, limit=1) or ("",))[0]
    if meant:
        cursor.misspelt(cursor.here(), cursor.raw, meant)
        return meant
    cursor.expected("given, when or expect", (_NO_STEPS[cursor.raw],) if cursor.raw in _NO_STEPS else ())
    return ""


def misplaced_head(cursor: Cursor) -> tuple[str, ...]:
    """The notes for what is left of a scenario's first line."""
    if cursor.at_word("of"):
        return ("`of` and the tree go before `verifies`",)
    if cursor.at_word("satisfies"):
        return ("a scenario `verifies` a requirement, a node `satisfies` it",)
    return ()


def no_behavior(cursor: Cursor) -> None:
    """Report that a node and what it does is not written so."""
    for length in (2, 1):
        words = tuple(cursor.raws[cursor.index : cursor.index + length])
        if cursor.kind == NAME and words in _BEHAVIORS_MEANT:
            _written(cursor, length, _BEHAVIORS_MEANT[words])
            return
    if cursor.kind == NAME and cursor.raw in ANSWERS:
        fix = cursor.put_before("answers")
        cursor.expected("what the node does", ("what a condition answers goes after `answers`",), (fix,))
    elif cursor.kind == QUANTITY and cursor.raws[cursor.index - 1] in DURATIONS:
        cursor.expected("what a node does", (_A_NODE_FIRST,))
    elif cursor.kind == QUANTITY:
        cursor.expected("what the node does", ("a duration goes after `takes`",), (cursor.put_before("takes"),))
    elif cursor.kind == NAME and cursor.raw in BEHAVIOR_WORDS:
        note = "how often, and what the node writes, goes last: `succeeds after 3 s twice`"
        cursor.expected("the end of the line", (note,))
    elif cursor.kind == NAME and (likely := near(cursor.raw, _OF_BEHAVIORS, limit=1)):
        cursor.misspelt(cursor.here(), cursor.raw, likely[0])
        cursor.recover()
    else:
        is_first = cursor.index < 2 or cursor.raws[cursor.index - 1] not in _OF_BEHAVIORS
        what = "what the node does: succeeds, fails, answers true, takes 3 s, …" if is_first else "the end of the line"
        cursor.expected(what)


def bound_of_duration(cursor: Cursor) -> None:
    """Report and skip the words of a bound before a duration: `takes at most 3 s`."""
    length = bound[0] if (bound := bound_ahead(cursor)) is not None else 0
    if not length or cursor.kinds[cursor.index + length] != QUANTITY:
        return
    value = cursor.starts[cursor.index + length]
    fix = replace_fix("Remove the bound", Span(cursor.here().start, value), "")
    span = Span(cursor.here().start, cursor.last_end() + cursor.base)
    cursor.go_to(cursor.index + length)
    span = Span(span.start, cursor.last_end() + cursor.base)
    cursor.complain(span, "a duration is given as a value, without a bound", fix)


def no_trigger(cursor: Cursor) -> bool:
    """Report that nothing can happen as it is written, if it is known how."""
    if cursor.at_word("after") and cursor.kinds[cursor.index + 1] == QUANTITY:
        time = cursor.raws[cursor.index + 1]
        span = Span(cursor.here().start, cursor.starts[cursor.index + 1] + len(time))
        cursor.complain(span, f"a time is written `{time} have passed`", write_fix(f"{time} have passed", span))
        return True
    if cursor.kind == NEWLINE or cursor.at(":"):
        cursor.expected("what happens: `30 s have passed`, `Dock fails` or a condition")
        return True
    return False


def no_expectation(cursor: Cursor) -> None:
    """Report `expect` alone."""
    cursor.expected('a claim, `Dock runs "A"`, `finally {key} == 1` or a requirement')


def activations_counted(cursor: Cursor, index: int) -> bool:
    """Report `mission fails` and `Dock never runs`, whose verb is at a token, as the claims that are meant."""
    words = tuple(cursor.raws[index:-1])
    counted = _COUNTED.get(words[0]) if words else None
    span = Span(cursor.starts[index], cursor.starts[-2] + len(cursor.raws[-2]))
    if words in _NEVER and ")" not in cursor.raws[cursor.index : index]:
        subject = cursor.text[cursor.here().start : cursor.starts[index - 1] + len(cursor.raws[index - 1])]
        span = Span(cursor.here().start, span.end)
        written = f"never node {subject}"
    elif words in _SUCCEEDS:
        written = "succeeds"
    elif counted is not None and len(words) == 1:
        written = f"{counted} at least 1 per run"
    elif counted is not None and (number := _number(words[1:])):
        written = f"{counted} between {number} and {number} per run"
    else:
        return False
    cursor.complain(span, f"this claim is written `{written}`", write_fix(written, span))
    cursor.recover()
    return True


def verdict_meant(cursor: Cursor) -> bool:
    """Report a requirement with its verdict in other words, which are all that is left of the line."""
    words = tuple(cursor.raws[cursor.index + 1 : -1])
    if cursor.kind != NAME or not words or max(cursor.kinds[cursor.index + 1 : -1]) != NAME:
        return False
    after_is = words[1:] if words[0] in ("is", "was") else words
    written = " ".join(after_is) if after_is in VERDICTS else _VERDICTS_MEANT.get(after_is, "")
    if not written and len(words) == 1:
        written = (near(words[0], _VERDICT_WORDS, limit=1) or ("",))[0]
    if not written:
        return False
    span = Span(cursor.starts[cursor.index + 1], cursor.starts[-2] + len(cursor.raws[-2]))
    cursor.complain(span, f"this verdict is written `{written}`", write_fix(written, span))
    return True


def _written(cursor: Cursor, length: int, written: str) -> None:
    """Report that the next words, so many, are others here, and skip the rest."""
    last = cursor.index + length - 1
    span = Span(cursor.here().start, cursor.starts[last] + len(cursor.raws[last]))
    cursor.complain(span, f"this is written `{written}`", write_fix(written, span))
    cursor.recover()


def _number(words: tuple[str, ...]) -> str:
    """The number of `once`, `twice` and `3 times`; else empty."""
    if words in (("once",), ("twice",)):
        return "1" if words[0] == "once" else "2"
    return words[0] if len(words) == 2 and words[1] in ("times", "time") and words[0].isdecimal() else ""


_OF_BEHAVIORS: Final = (*BEHAVIOR_WORDS, *TIMES, "then", "end")
_STEPS_MEANT: Final = {  # of Gherkin and other notations, folded
    **dict.fromkeys(("given", "suppose", "assume", "assuming", "background", "stub", "mock"), "given"),
    **dict.fromkeys(("when", "whenever", "if", "once"), "when"),
    **dict.fromkeys(("expect", "expects", "expected", "then", "should", "must", "assert", "check", "ensure"), "expect"),
}
_OWN_WORD: Final = "each step begins with its own word: given, when or expect"
_OF_HEAD: Final = "it goes on the first line of the scenario"
_NO_STEPS: Final = {
    **dict.fromkeys(("and", "And", "but", "But", "*", "-"), _OWN_WORD),
    **dict.fromkeys(("of", "verifies"), _OF_HEAD),
    "after": "what changes during the run is written `when 30 s have passed: person_near = true`",
}
_A_NODE_FIRST: Final = "a given begins with its node: `given Dock succeeds after 3 s`"
_BEHAVIORS_MEANT: Final[dict[tuple[str, ...], str]] = {
    **dict.fromkeys((("succeed",), ("passes",), ("works",), ("returns", "SUCCESS"), ("SUCCESS",)), "succeeds"),
    **dict.fromkeys((("fail",), ("failed",), ("crashes",), ("returns", "FAILURE"), ("FAILURE",)), "fails"),
    **dict.fromkeys((("skip",), ("skipped",), ("returns", "SKIPPED"), ("SKIPPED",)), "skips"),
    **dict.fromkeys(
        (("hangs",), ("blocks",), ("never", "ends"), ("never", "finishes"), ("returns", "RUNNING"), ("RUNNING",)),
        "does not end",
    ),
    **dict.fromkeys((("does", "nothing"), ("lasts",)), "takes"),
    **dict.fromkeys((("in",), ("within",)), "after"),
    ("returns", "true"): "answers true",
    ("returns", "false"): "answers false",
    ("is", "true"): "answers true",
    ("is", "false"): "answers false",
}
_COUNTED: Final = {"runs": "starts", "starts": "starts", "fails": "fails", "finishes": "finishes"}
_NEVER: Final = (("does", "not", "run"), ("does", "not", "start"), ("never", "runs"), ("never", "starts"))
_SUCCEEDS: Final = (("does", "not", "fail"), ("never", "fails"))
_VERDICT_WORDS: Final = ("satisfied", "violated", "unknown", "undecided")
_VERDICTS_MEANT: Final[dict[tuple[str, ...], str]] = {
    **dict.fromkeys((("holds",), ("passes",), ("passed",), ("met",), ("fulfilled",), ("not", "violated")), "satisfied"),
    **dict.fromkeys((("broken",), ("failed",), ("not", "satisfied"), ("not", "met")), "violated"),
    ("not", "exercised"): "never exercised",
}
