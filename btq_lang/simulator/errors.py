"""What ends a simulated run early."""

from __future__ import annotations


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
        uid: the number of the node in whose tick it was raised; 0: in none, or that tick has not been left yet.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.uid = 0
