"""What a node reads at its ports, and writes through them."""

from __future__ import annotations

from typing import Final

from btq_lang.simulator.blackboard import DOUBLE, Value, fits, parsed
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nodes import FAILURE, RUNNING, SKIPPED, SUCCESS, SimulatedNode


def key_of(written: str, port: str) -> str | None:
    """The key of a port that is an entry; None if it is a literal."""
    text = written.strip()
    if text in ("{=}", "="):
        return port
    return text[1:-1].strip() if text.startswith("{") and text.endswith("}") else None


def read(node: SimulatedNode, port: str) -> Value | None:
    """The value at a port: a literal as its text; None: the port or its entry is missing or empty."""
    written = node.ports.get(port)
    if written is None:
        return None
    key = key_of(written, port)
    if key is None:
        return written
    entry = node.board.entry(key)
    return entry.value if entry is not None else None


def read_whole(node: SimulatedNode, port: str) -> int | None:
    """The whole number at a port; None: there is none."""
    value = read(node, port)
    try:
        number = parsed(value, "int") if isinstance(value, str) else value
    except EngineError:
        return None
    return int(number) if number is not None and fits(float(number), "int") else None


def read_unsigned(node: SimulatedNode, port: str, wraps_negative: bool) -> int | None:
    """The number at a port that may not be negative; `wraps_negative`: -1 is the largest one.  None: there is none."""
    number = read_whole(node, port)
    return number if number is None or number >= 0 else number % (1 << 32) if wraps_negative else None


def read_real(node: SimulatedNode, port: str) -> float:
    """The real number at a port.

    Raises:
        NotModelled: there is none.
    """
    value = read(node, port)
    try:
        return float(parsed(value, DOUBLE) if isinstance(value, str) else value if value is not None else "")
    except (EngineError, ValueError):
        raise NotModelled(f"the port {port} of {node.path} has no number when it is read") from None


def read_text(node: SimulatedNode, port: str) -> str | None:
    """The text at a port; a number as a text.  None: it is missing."""
    value = read(node, port)
    if isinstance(value, float):
        return f"{value:.6f}"
    return str(value) if value is not None else None


def read_truth(node: SimulatedNode, port: str) -> bool | None:
    """The truth at a port; None: there is none."""
    value = read(node, port)
    try:
        return bool(parsed(value, "bool") if isinstance(value, str) else value) if value is not None else None
    except EngineError:
        return None


def read_status(node: SimulatedNode, port: str) -> int | None:
    """The status that a port names; None: it names none."""
    return _STATUSES.get(str(read(node, port)))


def write(node: SimulatedNode, port: str, value: Value, type_: str) -> None:
    """Write through an output port; nothing happens if it is a literal."""
    key = key_of(node.ports.get(port, ""), port)
    if key is not None:
        node.board.write(key, value, type_)


_STATUSES: Final = {"SUCCESS": SUCCESS, "FAILURE": FAILURE, "SKIPPED": SKIPPED, "RUNNING": RUNNING}
