"""What ends a simulated run early."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.simulator.blackboard import Unknown
    from btq_lang.simulator.nodes import SimulatedNode


class EngineError(Exception):
    """An exception that the engine throws, with its message.

    Attributes:
        is_wrapped: the message names the node in which it was thrown (since 4.9).
    """

    def __init__(self, message: str, is_wrapped: bool = False) -> None:
        super().__init__(message)
        self.is_wrapped = is_wrapped


class NotModelled(Exception):
    """The tree has something whose effect is not known here; the message says what.

    Attributes:
        value: the unknown value that is needed; None: something else is not known.
        reader: the node that needs it; None: no node, or the tick has not been left yet.
    """

    def __init__(self, message: str, value: Unknown | None = None) -> None:
        super().__init__(message)
        self.value: Final = value
        self.reader: SimulatedNode | None = None
