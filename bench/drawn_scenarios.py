"""Drawn scenarios: what is given, what changes, and what is expected, from docs/grammar.md."""

from __future__ import annotations

from collections.abc import Iterator

from drawn_requirements import claim, condition
from drawn_words import KEYS, Hand, Line

VERDICTS = ("", "satisfied", "violated", "unknown", "undecided", "never exercised", "not applicable")
HAPPENINGS = ("starts", "succeeds", "fails", "finishes", "halts")


def scenarios(hand: Hand) -> list[Line]:
    """Givens for all scenarios of the file, and scenarios."""
    lines = [_scenario(hand) for _ in hand.some(3, 0.3)]
    return [*(Line(_given(hand)) for _ in hand.some(2, 0.2)), *lines]


def _scenario(hand: Hand) -> Line:
    of = f"of {hand.name('tree')}" if hand.maybe(0.7) else ""
    verifies = f"verifies {hand.listed(hand.name('requirement') for _ in range(hand.pick((1, 2))))}"
    line = Line(hand.words("scenario", hand.prose(), of, verifies if hand.maybe(0.3) else ""))
    line.block += [Line(_given(hand)) for _ in hand.some(6, 0.8)]
    line.block += [Line(_change(hand)) for _ in hand.some(3, 0.4)]
    line.block += [Line(_expectation(hand)) for _ in range(hand.pick({1: 3, 2: 3, 4: 1}))]
    return line


def _given(hand: Hand) -> str:
    return hand.words("given", _assignment(hand) if hand.maybe(0.25) else _nodes_do(hand))


def _assignment(hand: Hand) -> str:
    return hand.pair(hand.pick((hand.name("signal"), "{goal}", "{@goal}")), hand.value())


def _nodes_do(hand: Hand) -> str:
    behaviors = [_behavior(hand) for _ in range(hand.pick({1: 6, 2: 2, 3: 1}))]
    then = ", then " if hand.maybe(0.8) else ", "
    return hand.words(_nodes(hand), then.join(behaviors))


def _nodes(hand: Hand, bare: str = "") -> str:
    ports = [*_pairs(hand), bare] if bare else _pairs(hand)
    brackets = f"({hand.listed(ports)})" if ports else ""
    return hand.words(f"every {hand.name('model')}" if hand.maybe(0.2) else hand.path(), brackets)


def _pairs(hand: Hand) -> list[str]:
    return [hand.pair(key, hand.value()) for key in hand.chance.sample(KEYS, len(hand.some(2, 0.3)))]


def _behavior(hand: Hand) -> str:
    answers = f"answers {hand.listed(hand.pick(('true', 'false')) for _ in range(hand.pick((1, 2, 3))))}"
    result = hand.pick({"succeeds": 5, "fails": 5, "skips": 1, "does not end": 1, answers: 2})
    duration = f"{hand.pick(('takes', 'after'))} {hand.quantity('time')}"
    parts = hand.pick({(result,): 5, (duration,): 2, (result, duration): 2, (duration, result): 1})
    times = hand.pick({"": 6, "once": 1, "twice": 1, f"{hand.pick('23456')} times": 1})
    writes = f"and writes {hand.listed([hand.pair(key, hand.value()) for key in KEYS[:1]])}"
    return hand.words(*parts, times, writes if hand.maybe(0.1) else "")


def _change(hand: Hand) -> str:
    return hand.words("when", _trigger(hand) + hand.pick({":": 9, " :": 1}), _effect(hand))


def _trigger(hand: Hand) -> str:
    kind = hand.pick({"time": 3, "event": 4, "condition": 3})
    if kind == "time":
        return f"{hand.quantity('time')} have passed"
    if kind == "condition":
        return condition(hand) if hand.maybe(0.7) else "{n} > 3"
    brackets = f"({hand.listed(pairs)})" if (pairs := _pairs(hand)) else ""
    node = "mission" if hand.maybe(0.2) else hand.words(hand.path(), brackets)
    number = f"for the {hand.pick(('first', 'second', 'third', '4'))} time" if hand.maybe(0.4) else ""
    return hand.words(node, hand.pick(HAPPENINGS), number)


def _effect(hand: Hand) -> str:
    return hand.pick({"mission halts": 1, _assignment(hand): 4, _nodes_do(hand): 3})


def _expectation(hand: Hand) -> str:
    return hand.words("expect", hand.pick(list(_expectations(hand))))


def _expectations(hand: Hand) -> Iterator[str]:
    yield claim(hand)
    yield claim(hand)
    values = hand.listed(hand.pick((hand.string("A"), hand.number(), "{x}")) for _ in range(hand.pick((1, 2, 5))))
    yield hand.words(_nodes(hand, hand.pick({"": 3, KEYS[0]: 1})), f"runs {values}")
    yield f"finally {condition(hand) if hand.maybe(0.5) else '{done} == true'}"
    yield "mission does not end"
    yield hand.words(hand.name("requirement"), hand.pick(VERDICTS))
