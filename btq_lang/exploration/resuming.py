"""Which nodes can go on in the middle of a tick: all that they know is in their memories.

When such a node comes to its second child in a tick, a tick that began with these memories would do the same.
"""

from __future__ import annotations

from typing import Final

from btq_lang.simulator import controls, decorators, nav2
from btq_lang.simulator.nodes import Flow, SimulatedNode
from btq_lang.simulator.ports import key_of


def is_resumed(node: SimulatedNode) -> bool:
    """Whether a tick of a node can be resumed before any of its children."""
    counts = [node.ports.get(port, "") for port in _COUNTS]
    return node.rules.flow in _RESUMED and all(key_of(text, "") is None for text in counts)


def is_endless(node: SimulatedNode) -> bool:
    """Whether it ticks its child again and again, and how often it did so does not matter."""
    return is_resumed(node) and any(node.ports.get(port, "").strip() == "-1" for port in _COUNTS[:2])


def last_count(node: SimulatedNode) -> int:
    """The count of a node after which it does not tick its first child again; 0: it has none, or no count before it."""
    if not is_resumed(node):
        return 0
    text = next((node.ports[port].strip() for port in _COUNTS if port in node.ports), "")
    most = int(text) if text.isdecimal() and len(text) < 10 else 0
    return most if node.rules.flow == nav2.tick_recovery else max(most - 1, 0)


_COUNTS: Final = ("num_cycles", "num_attempts", "number_of_retries")
_RESUMED: Final[tuple[Flow, ...]] = (
    controls.tick_sequence,
    controls.tick_fallback,
    controls.tick_sequence_with_memory,
    controls.tick_if_then_else,
    controls.tick_try_catch,
    decorators.tick_repeat,
    decorators.tick_retry,
    nav2.tick_recovery,
)
