"""Attributes that other engines have and no built-in of this one: what does the same here.

One invariant: it is asked only about a built-in without a port of that name, and it names nodes by their tags, which
XML and this language share.
"""

from __future__ import annotations

from typing import Final


def of_other_engines(flow: str, key: str) -> str:
    """What does here what an attribute of another engine does, as a sentence; empty if nothing is known of it.

    Args:
        flow: of the built-in that has the attribute.
    """
    return _NOTES.get((flow, key.casefold())) or _ANYWHERE.get(key.casefold(), "")


# Sources: the documentation of py_trees (`memory`, `policy`), Unreal Engine, Behavior Designer and Beehave.
_NOTES: Final = {
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
_ANYWHERE: Final = {
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
