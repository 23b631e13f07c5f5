"""Replies of the real publisher, recorded: the one of the tests replies the same, and damaged ones do no harm."""

from __future__ import annotations

import random
import struct
from collections.abc import Callable
from pathlib import Path

import msgpack
import pytest
from groot2_recording import RECORDINGS, Exchange, exchanges, meaning, read
from groot2_robot import Publisher
from seeds import seeds, share_of

from btq_lang.evidence.readers.groot2.following import Began, Came, Following, LostTransitions, Notice, Sampled
from btq_lang.evidence.readers.groot2.messages import Reply, reply, request
from btq_lang.evidence.readers.groot2.sessions import sessions_of
from btq_lang.evidence.runs import activations

RECORDED = sorted(RECORDINGS.glob("groot2-*.json"))


@pytest.mark.parametrize("path", RECORDED, ids=lambda path: path.stem)
def test_the_publisher_of_the_tests_replies_like_the_real_one(path: Path) -> None:
    recorded = read(path)
    replies = [answer for _, answer in recorded]
    publisher = Publisher(replies[0][1].decode(), msgpack.unpackb(replies[2][1]))

    def run() -> None:
        for _, uid, status in struct.iter_unpack("<6sHB", replies[4][1]):
            publisher.change(uid, status)
        publisher.boards |= msgpack.unpackb(replies[6][1])

    assert meaning(exchanges(publisher.answer, run)) == meaning(recorded)


def test_the_recordings_are_followed() -> None:
    for path in RECORDED:
        following = Following(asked_of(read(path), lambda parts: parts), lambda: 0, ["battery"], "here")
        (began,) = following.step()
        assert isinstance(began, Began)
        assert [node.path for node in began.tree.nodes.values()] == [
            "Sequence::1",
            "Script::2",
            "Move::3",
            "Part::4",
            "Part::4/Sequence::5",
            "Part::4/Pick::6",
        ]
        came, sampled = following.step()
        assert isinstance(came, Came)
        assert [(uid, "IRSF"[status]) for _, uid, status in came.transitions[:4]] == [
            (1, "R"),
            (2, "S"),
            (3, "R"),
            (3, "S"),
        ]
        assert isinstance(sampled, Sampled)
        assert sampled.values == {"battery": 50.0}


def test_damaged_replies_do_no_harm() -> None:
    recordings = [read(path) for path in RECORDED]
    kinds = set()
    for seed in share_of(seeds(5000), 16):
        chance = random.Random(seed)
        recorded = chance.choice(recordings)
        at = chance.randrange(12)
        count = iter(range(1000))

        def damage(parts: list[bytes]) -> list[bytes]:
            return damaged(chance, parts) if next(count) == at else parts  # noqa: B023  # called in this iteration only

        ask = asked_of(recorded, damage)
        following = Following(ask, lambda: 0, ["battery"], "here")
        events = [event for _ in range(8) for event in following.step()]
        kinds |= {type(event) for event in events}
        for session in sessions_of(iter(events), lambda text: None):
            for _ in activations(session):
                pass
        assert any(isinstance(event, Began) for event in events)
    assert kinds == {Began, Came, LostTransitions, Sampled, Notice}


@pytest.mark.parametrize(
    "xml",
    [
        '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa">'
        + "".join(f'<!ENTITY a{n} "{"&a;" * 10}">' for n in range(9))
        + ']><root><BehaviorTree ID="&a8;" _fullpath=""><A name="&a8;" _uid="2"/></BehaviorTree></root>',
        '<!DOCTYPE r SYSTEM "file:///etc/passwd"><root BTCPP_format="4"><BehaviorTree/></root>',
        '<root BTCPP_format="4"><BehaviorTree ID="M">' + "<A>" * 100_000,
        "<" * 100_000,
        '<root BTCPP_format="4">' + '<BehaviorTree ID="M"><A _uid="1"/></BehaviorTree>' * 1000 + "</root>",
        "",
        "\0",
    ],
)
def test_a_hostile_tree_does_no_harm(xml: str) -> None:
    recorded = read(RECORDED[0])
    recorded[0] = recorded[0][0], [recorded[0][1][0], xml.encode()]
    (event,) = Following(asked_of(recorded, lambda parts: parts), lambda: 0, (), "here").step()
    assert isinstance(event, Notice)


def asked_of(recorded: list[Exchange], damage: Callable[[list[bytes]], list[bytes]]) -> Callable[..., Reply]:
    """Asks a publisher that replies as it was recorded, with what is damaged on the way."""
    whole = [each for each in recorded if each[1][0] != b"error"]
    # Of several replies, of the boards the last one, which has values, and of the others the first.
    by_kind = {asked[0][1:2].decode(): answer for asked, answer in reversed(whole)}
    by_kind["B"] = next(answer for asked, answer in reversed(whole) if asked[0][1:2] == b"B")

    def ask(kind: str, argument: str | None = None) -> Reply:
        parts = request(kind, 7, argument)
        head, *content = by_kind[kind]
        return reply(damage([parts[0] + head[6:], *content]), parts[0])

    return ask


def damaged(chance: random.Random, parts: list[bytes]) -> list[bytes]:
    """A reply with something wrong."""
    found = [*parts]
    at = chance.randrange(len(found))
    part = bytearray(found[at])
    where = chance.randrange(len(part) + 1)
    how = chance.randrange(7)
    if how == 0:
        del part[where:]
    elif how == 1:
        part[where:where] = chance.randbytes(chance.randrange(1, 20))
    elif how == 2 and where < len(part):
        part[where] = chance.randrange(256)
    elif how == 3:
        part[:] = chance.randbytes(chance.randrange(60))
    elif how == 4:
        return found[:at]
    elif how == 5:
        return [*found, bytes(part)]
    else:
        return [b"error", bytes(part)]
    found[at] = bytes(part)
    return found
