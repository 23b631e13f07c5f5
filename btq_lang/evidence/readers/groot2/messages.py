"""Requests to a Groot2Publisher and its replies, as bytes.

One invariant: whatever the bytes are, decoding gives a value or one BadReply.

A request is a part of six bytes (protocol, type, an ID), and for some types a second part.  A reply repeats the six
bytes, followed by the publisher's own ID, and has the content in a second part; or its parts are `error` and a text.
"""

from __future__ import annotations

from collections.abc import Sequence
from struct import Struct
from typing import Final

from btq_lang.evidence.model import IDLE, SKIPPED, SampleValue, Transition, by_entry, is_sample
from btq_lang.util.record import Record

TREE: Final = "T"  # the types of requests that are sent; others would change what the robot does
STATUS: Final = "S"
BLACKBOARD: Final = "B"
RECORDING: Final = "r"
TRANSITIONS: Final = "t"
MOST_KEPT: Final = 1000  # transitions in the publisher's buffer; older ones are dropped


class BadReply(Exception):
    """A reply that does not follow the protocol, or an error; the message says what came instead."""


class Reply(Record):
    """The content of a reply, and the ID of the publisher, which is another one after each start."""

    publisher: bytes
    content: bytes


def request(kind: str, number: int, argument: str | None = None) -> list[bytes]:
    """The parts of a request with this number; `argument`: the second part."""
    head = _REQUEST.pack(_PROTOCOL, ord(kind), number)
    return [head] if argument is None else [head, argument.encode()]


def reply(parts: Sequence[bytes], asked: bytes) -> Reply:
    """The reply to a request.

    Args:
        asked: the first part of the request.

    Raises:
        BadReply: it is an error, or no reply to this request.
    """
    head = parts[0] if parts else b""
    if head == b"error" and len(parts) > 1:
        raise BadReply(f"the publisher refused a request: {parts[1][:_SHOWN].decode('utf-8', 'replace')}")
    if len(head) != _REQUEST.size + _ID:
        raise BadReply(f"expected a reply of a Groot2Publisher, found one that begins with {len(head)} bytes")
    if head[0] != _PROTOCOL:
        raise BadReply(f"protocol {head[0]} of Groot2; btq speaks protocol {_PROTOCOL}")
    if head[: _REQUEST.size] != asked:
        raise BadReply("the reply is to another request")
    return Reply(head[_REQUEST.size :], parts[1] if len(parts) > 1 else b"")


def transitions(content: bytes) -> list[Transition]:
    """The transitions in a reply, with times in µs since the recording began.

    Raises:
        BadReply: its size is not that of whole transitions.
    """
    if len(content) % _TRANSITION.size:
        raise BadReply(f"expected {_TRANSITION.size} bytes for each transition, found {len(content)} in all")
    return [(low + (high << 32), uid, status) for low, high, uid, status in _TRANSITION.iter_unpack(content)]


def statuses(content: bytes, nodes: int) -> dict[int, int]:
    """The status of each node, by uid, in a tree with so many nodes.

    Raises:
        BadReply: it is for another number of nodes.
    """
    if len(content) != _STATUS.size * nodes:
        raise BadReply(f"expected {_STATUS.size} bytes for each of {nodes} nodes, found {len(content)} in all")
    return {uid: status if status <= SKIPPED else IDLE for uid, status in _STATUS.iter_unpack(content)}


def blackboard(content: bytes, boards: Sequence[str]) -> dict[str, SampleValue]:
    """The values on the blackboards that can be samples, by entry; the first board is the main tree's.

    Raises:
        BadReply: it is not MessagePack, or no map.
    """
    import msgpack

    try:
        boards_by_name = msgpack.unpackb(content, strict_map_key=False, unicode_errors="replace")
    except _NOT_MESSAGEPACK as error:
        raise BadReply("the blackboard is not MessagePack") from error
    if not isinstance(boards_by_name, dict | None):
        raise BadReply("expected a map of blackboards")
    entries = {name: board for name, board in (boards_by_name or {}).items() if isinstance(board, dict)}
    values = by_entry(entries, boards[0] if boards else None)
    return {key: value for key, value in values.items() if isinstance(key, str) and is_sample(value)}


def start_of(content: bytes) -> int:
    """When a recording began, in µs since the epoch, on the robot's clock.

    Raises:
        BadReply: it is something else.
    """
    if not (content.isdigit() and len(content) <= _MOST_DIGITS):
        raise BadReply(f"expected the time at which the recording began, found {content[:_SHOWN]!r}")
    return int(content)


_PROTOCOL: Final = 2
_REQUEST: Final = Struct("<BBI")  # protocol, type, ID
_ID: Final = 16  # bytes of a publisher's ID
_TRANSITION: Final = Struct("<IHHB")  # µs since the recording began in 48 bits, uid, status
_STATUS: Final = Struct("<HB")  # uid, status; 10 + the status before, for a node that has become idle
_NOT_MESSAGEPACK: Final = (ValueError, TypeError, RecursionError, OverflowError)  # ValueError: also of msgpack itself
_SHOWN: Final = 200
_MOST_DIGITS: Final = 18
