"""Other engines' names of this one's built-ins and their attributes, which people who know those engines write here.

One invariant: no name of a node here, written as its engine writes it, is a spelling of a built-in.  A node of a
program may have any of them, so callers ask only about nodes with children that nothing declares, and about attributes
only of a built-in without a port of that name.  Nodes are named by their tags, which XML and this language share.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.catalog.nodes import BUILTINS, spellings
from btq_lang.util.record import Record


class ForeignName(Record):
    """The meaning of a name in other engines.

    Attributes:
        tag: the built-in that does the same.
        attributes: what it requires to do so, as a file writes it; empty if nothing, or if the name does not tell.
        note: in what the two differ, as a sentence; empty if in nothing.
    """

    tag: str
    attributes: str = ""
    note: str = ""


def foreign_name(word: str) -> ForeignName | None:
    """The meaning of a name in other engines, or of a class of this one: `Selector`, `BTInvert`, `SequenceNode`; None
    if it has none there."""
    plain = _plain(word)
    if plain in _SPELLINGS:
        return None
    stem = _AFFIXES.sub("", plain)
    meaning = _NAMES.get(plain) or _NAMES.get(stem)
    return ForeignName(_SPELLINGS[stem]) if meaning is None and stem in _SPELLINGS else meaning


def statement(word: str) -> str:
    """The way in which a tree expresses a statement of programming languages, for a message; empty for other words."""
    return _STATEMENTS.get(word, "")


def branch(word: str) -> str:
    """How a tree expresses the branches that a word of programming languages begins, for a message; empty for other
    words. A node of a program may have such a name."""
    return _BRANCHES.get(word, "")


def is_of_leaves(word: str) -> bool:
    """Whether programs have leaves of that name too: a word after it may then be a label."""
    return _plain(word) in _OF_LEAVES


def of_other_engines(flow: str, key: str) -> str:
    """The replacement here of an attribute of another engine, as a sentence; empty if it is unknown.

    Args:
        flow: of the built-in that has the attribute.
    """
    return _PORTS.get((flow, key.casefold())) or _PORTS_ANYWHERE.get(key.casefold(), "")


def _plain(word: str) -> str:
    return re.sub(r"[\W_]", "", word).casefold()


_ENDLESS: Final = "; -1 means without end"
_UNTIL_FAILURE: Final = ForeignName(
    "KeepRunningUntilFailure",
    note="it returns FAILURE at the end; for SUCCESS, write `Retry (num_attempts = -1)` around an `Inverter`",
)

# By name without case and underscores; sources: the documentation of py_trees, behavior3, Unreal Engine, Behavior
# Designer, gdx-ai, BrainTree, Beehave and LimboAI.
_NAMES: Final[dict[str, ForeignName]] = {
    **dict.fromkeys(
        ("selector", "select", "priority", "priorityselector", "mempriority", "memselector", "statefulselector", "or"),
        ForeignName("Fallback"),
    ),
    **dict.fromkeys(("memsequence", "and"), ForeignName("Sequence")),
    **dict.fromkeys(
        ("activeselector", "dynamicselector", "reactiveselector", "selectorreactive"), ForeignName("ReactiveFallback")
    ),
    **dict.fromkeys(("activesequence", "dynamicsequence", "sequencereactive"), ForeignName("ReactiveSequence")),
    **dict.fromkeys(("simpleparallel", "parallelsequence", "concurrent"), ForeignName("Parallel")),
    **dict.fromkeys(
        ("if", "ifelse", "ifthen"),
        ForeignName("IfThenElse", note="its first child is the condition, a node of its own"),
    ),
    **dict.fromkeys(("while", "whiledo"), ForeignName("WhileDoElse", note="its first child is the condition")),
    **dict.fromkeys(("not", "negate", "negation", "negator", "invert", "inversion"), ForeignName("Inverter")),
    **dict.fromkeys(
        ("succeeder", "succeed", "alwayssucceed", "forcesucceed", "returnsuccess", "failureissuccess"),
        ForeignName("ForceSuccess"),
    ),
    **dict.fromkeys(
        ("failer", "fail", "alwaysfail", "forcefail", "returnfailure", "successisfailure"), ForeignName("ForceFailure")
    ),
    **dict.fromkeys(("untilfail", "untilfailure", "repeatuntilfail", "repeatuntilfailure"), _UNTIL_FAILURE),
    **dict.fromkeys(
        ("untilsuccess", "untilsucceed", "repeatuntilsuccess"),
        ForeignName("RetryUntilSuccessful", "num_attempts = -1", f"`num_attempts` limits how often{_ENDLESS}"),
    ),
    **dict.fromkeys(
        ("repeater", "looper", "loop"),
        ForeignName("Repeat", "num_cycles = -1", f"`num_cycles` says how often{_ENDLESS}"),
    ),
    **dict.fromkeys(
        ("timelimit", "timelimiter", "maxtime"),
        ForeignName("Timeout", note="`msec` says after which time it halts its child: `msec = 30 s`"),
    ),
    **dict.fromkeys(
        ("wait", "delayer"),
        ForeignName("Delay", note="`delay_msec` says how long it waits before its child: `delay_msec = 2 s`"),
    ),
    **dict.fromkeys(("oneshot", "once"), ForeignName("RunOnce")),
}

_STATEMENTS: Final = {
    **dict.fromkeys(
        ("else", "elif", "otherwise", "catch", "except"),
        "a Fallback `?` runs its next child after a failure, and the third child of an IfThenElse is its `else`",
    ),
    **dict.fromkeys(("then", "finally", "do", "begin"), "a Sequence `->` runs its children one after another"),
    **dict.fromkeys(("end", "endif", "fi", "done", "pass"), "indentation shows where a node's children end"),
}
_BRANCHES: Final = {
    **dict.fromkeys(("Else", "Otherwise"), "the third child of an IfThenElse is the else branch"),
    **dict.fromkeys(("Elif", "ElseIf"), "the third child of an IfThenElse is its else branch: another IfThenElse"),
    "Then": "the second child of an IfThenElse, after the condition, is the then branch",
}
_OF_LEAVES: Final = frozenset(
    (
        *("wait", "select", "priority", "once", "succeed", "succeeder", "alwayssucceed", "returnsuccess"),
        *("fail", "failer", "alwaysfail", "returnfailure", "while"),
    )
)
_SPELLINGS: Final = {
    _plain(spelling): kind.tag for kind in BUILTINS.values() for spelling in spellings(kind) if spelling[0].isalpha()
}
_AFFIXES: Final = re.compile(r"^bt(?:composite|decorator)?|^decorator|(?:composite|decorator|node)$")
# Sources: the documentation of py_trees (`memory`, `policy`), Unreal Engine, Behavior Designer and Beehave.
_PORTS: Final = {
    **dict.fromkeys(
        (("sequence", "memory"), ("fallback", "memory")),
        "a Sequence or Fallback goes on with the child that is running; "
        "a ReactiveSequence or ReactiveFallback begins with the first one at every tick",
    ),
    **dict.fromkeys(
        (
            (flow, key)
            for flow in ("retry", "repeat")
            for key in ("delay", "delay_msec", "wait", "interval", "period", "backoff", "sleep", "pause")
        ),
        "to wait before each attempt, put a Delay around its child",
    ),
    **dict.fromkeys(
        (("parallel", key) for key in ("policy", "success_policy", "mode", "synchronise")),
        "`success_count` says how many children must succeed, and -1 is all of them",
    ),
    **dict.fromkeys(
        (("choice", key) for key in ("condition", "cond", "if", "test", "expression", "code")),
        "its first child is the condition, such as a ScriptCondition",
    ),
}
NAME: Final = "a node's own name is its `name`"
_PORTS_ANYWHERE: Final = {
    **dict.fromkeys(("timeout", "time_limit", "max_time", "deadline"), "to limit its time, put a Timeout around it"),
    **dict.fromkeys(
        ("retries", "max_retries", "attempts"), "to try again after a failure, put a RetryUntilSuccessful around it"
    ),
    **dict.fromkeys(
        ("child", "children", "node", "nodes", "task"),
        "children go below their parent, in XML between its tags: `<Inverter><Dock/></Inverter>`",
    ),
    **dict.fromkeys(("id", "label", "title", "name"), NAME),
}
