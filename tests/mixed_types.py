"""Entries that are read and written with two types."""

from __future__ import annotations

MODELS = """
Action Count
    output n : int
Action Count32
    input n : int32_t
Action Drive
    input speed : double
Action Say
    input text : string
Action Any
    inout value
Action Both
    input n : int
    input text : string
"""


# The lines of trees, and whether two types meet in them.
CASES = {
    "another type": ("Count (n = {k})\n Drive (speed = {k})", True),
    "a text later": ("Count (n = {k})\n Say (text = {k})", True),
    "a text first": ("Say (text = {k})\n Drive (speed = {k})\n Count (n = {k})", False),
    "the same type by another name": ("Count (n = {k})\n Count32 (n = {k})", False),
    "the engine's own nodes": ("Repeat (num_cycles = {k})\n  Sleep (msec = {k})", True),
    "a port that takes anything first": ("Any (value = {k})\n Count (n = {k})\n Drive (speed = {k})", False),
    "the node of nobody's model first": ("Act (value = {k})\n Count (n = {k})\n Drive (speed = {k})", False),
    "two ports of one node, one of text": ("Both (n = {k} text = {k})\n Drive (speed = {k})", False),
    "an entry of the same name": ("Count (n = {n})\n Drive (speed = {k})", False),
    "the port's own name": ("Count (n = {=})\n Drive (speed = {n})", True),
    "a tree below": ("Count (n = {k})\n SubTree S (v = {k})\nBehaviorTree S\n Drive (speed = {v})", True),
    "two trees below": (
        "SubTree S (v = {k})\n SubTree T (v = {k})\n"
        "BehaviorTree S\n Drive (speed = {v})\nBehaviorTree T\n Count (n = {v})",
        True,
    ),
    "not handed on": ("Count (n = {k})\n SubTree S\nBehaviorTree S\n Drive (speed = {k})", False),
    "handed on by the same name": (
        "Count (n = {k})\n SubTree S (_autoremap = true)\nBehaviorTree S\n Drive (speed = {k})",
        True,
    ),
    "a private entry is not handed on": (
        "Count (n = {_k})\n SubTree S (_autoremap = true)\nBehaviorTree S\n Drive (speed = {_k})",
        False,
    ),
    "in a tree whose entry was a text before": (
        "Say (text = {k})\n SubTree S (v = {k})\nBehaviorTree S\n ->\n  Count (n = {v})\n  Drive (speed = {v})",
        False,
    ),
    "in a tree whose entry is new": (
        "Say (text = {t})\n SubTree S (v = {k})\nBehaviorTree S\n ->\n  Count (n = {v})\n  Drive (speed = {v})",
        True,
    ),
    "in a tree that gets a text": (
        'Say (text = {t})\n SubTree S (v = "x")\nBehaviorTree S\n ->\n  Count (n = {v})\n  Drive (speed = {v})',
        False,
    ),
    "the root's entry": ("Count (n = {k})\n SubTree S\nBehaviorTree S\n Drive (speed = {@k})", True),
    "the root's entry in two trees": (
        "SubTree S\n SubTree T\nBehaviorTree S\n Drive (speed = {@k})\nBehaviorTree T\n Count (n = {@k})",
        True,
    ),
}


def mission(lines: str) -> str:
    return f"{MODELS}Root Main\nBehaviorTree Main\n ->\n  {lines.replace(chr(10) + ' ', chr(10) + '  ')}\n"
