"""Entries that were never given a value: a skill writes them, and a script or a port of a built-in needs them.

Source: a skill writes its outputs when it ends; what it writes is known only where it is given.
"""

from __future__ import annotations

from collections.abc import Collection

from btq_lang.simulator.nodes import Machine
from btq_lang.simulator.ports import key_of
from btq_lang.syntax.script.tree import variables


def unknown_entry(machine: Machine, started: Collection[int], skills: Collection[str]) -> str:
    """Why a run is unknown whose engine threw an exception; empty if it threw for another reason.

    Args:
        started: the nodes that have started.
        skills: the names of the actions of the program.
    """
    writers: dict[int, tuple[str, str]] = {}  # by the identity of an empty entry: its key, and the path of the skill
    for node in machine.nodes:
        if node.uid in started and node.id in skills:
            for port, written in node.ports.items():
                key = key_of(written, port)
                entry = node.board.entry(key) if key is not None else None
                if key is not None and entry is not None and entry.value is None:
                    writers.setdefault(id(entry), (key, node.path))
    for node in machine.nodes:
        if node.id in skills:
            continue
        scripts = [*(script for _, script in node.conditions), *node.scripts.values()]
        keys = [variable.name for script in scripts for variable in variables(script)]
        keys += [key for port, written in node.ports.items() if (key := key_of(written, port)) is not None]
        for key in keys:
            entry = node.board.entry(key)
            if entry is not None and id(entry) in writers:
                name, writer = writers[id(entry)]
                return f"{node.path} reads {{{key}}}, and nothing says what {writer} writes into {{{name}}}"
    return ""
