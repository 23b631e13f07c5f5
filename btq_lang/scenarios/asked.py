"""Questions about what can happen as expectations of the scenario that shows the answer.

One invariant: what was asked whether it can happen is expected to happen, so that the scenario passes; what must never
happen is expected not to, so that the scenario fails until the mission is mended.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.exploration.questions import Asked, EndlessRun, Holds, Order, Question
from btq_lang.scenarios.witnessed import PossibleExpectation
from btq_lang.syntax.tree import AnyEvent, Event, written

ENDS = PossibleExpectation("mission finishes at least 1 per run", holds=False)
ENDLESS = PossibleExpectation("mission does not end")


def expectations(question: Question, is_wanted: bool, number: int) -> Iterator[PossibleExpectation]:
    """What a scenario may expect, the plainest first.

    Args:
        is_wanted: what is asked is to be possible.
        number: of the question among those that have a scenario, from 1.
    """
    text, asked = " ".join(question.text.split()), question.asked
    claims = [*_claims(text, asked)]
    name = "asked" if number == 1 else f"asked_{number}"
    if is_wanted:
        yield from map(PossibleExpectation, _happens(asked))
        for claim in claims:
            yield PossibleExpectation(f"{name} violated", claim)
        if isinstance(asked, Holds):
            yield PossibleExpectation(f"finally {text}")
        yield PossibleExpectation("")
        return
    yield from (PossibleExpectation(claim[0], holds=False) for claim in claims if len(claim) == 1)
    yield from (PossibleExpectation(name, claim, holds=False) for claim in claims)
    if isinstance(asked, EndlessRun):
        yield ENDS
    yield PossibleExpectation("", note="no claim says that this must not happen: the scenario passes while it can")


def is_start(question: Question) -> bool:
    """Whether it asks whether a node starts."""
    asked = question.asked
    return isinstance(asked, Order) and (event := _only(asked.event)) is not None and event.happening == "starts"


def _happens(asked: Asked) -> Iterator[str]:
    """Claims that hold when the event has happened, or the run does not end."""
    if isinstance(asked, EndlessRun):
        yield ENDLESS.line
    if isinstance(asked, Order) and not asked.word and (event := _only(asked.event)) is not None:
        if event.path is None and event.happening == "succeeds":
            yield "mission succeeds"
        elif event.happening != "halts":
            yield f"{_subject(event)} {event.happening} at least 1 per run"


def _claims(text: str, asked: Asked) -> Iterator[tuple[str, ...]]:
    """Claims that are violated when what was asked happens, each with its scope."""
    if isinstance(asked, Holds):
        yield (f"never {text}",)
    if not isinstance(asked, Order) or (event := _only(asked.event)) is None:
        return
    other = text[asked.other.start : asked.other.end] if asked.other is not None else ""
    if event.condition is not None:
        claim = f"never {text[event.condition.start : event.condition.end]}"
    elif event.happening == "starts" and event.path is not None:
        claim = f"never node {_subject(event)}"
    elif event.happening == "fails" and event.path is None:
        claim = "mission succeeds"
    else:
        claim = f"{_subject(event)} {event.happening} at most 0 per run"
    if not asked.word:
        yield (claim,)
    elif claim.startswith("never "):
        begin, end = ("mission starts", other) if asked.word == "before" else (other, "mission finishes")
        yield f"mission {claim}", f"from {begin} until {end}"


def _only(event: Event | AnyEvent) -> Event | None:
    """An event that is not one of several."""
    return event if isinstance(event, Event) else None


def _subject(event: Event) -> str:
    return "/".join(written(word.text) for word in event.path.names) if event.path is not None else "mission"
