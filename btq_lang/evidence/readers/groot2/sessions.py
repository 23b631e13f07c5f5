"""The sessions of a running robot, for the judge; a thread follows the publisher meanwhile, whatever judging takes.

One invariant: the judge and the screen receive everything in one thread, in the order in which it came.
"""

from __future__ import annotations

import queue
import time
from collections.abc import Callable, Collection, Iterator
from threading import Event as Flag
from threading import Thread
from typing import Final

from btq_lang.evidence.model import IDLE, UNTIL, LoggedTree, LogSession, SampleSeries, Transition
from btq_lang.evidence.readers.groot2.following import (
    Began,
    Came,
    Event,
    Following,
    LostTransitions,
    Notice,
    Passed,
    Sampled,
)
from btq_lang.evidence.readers.groot2.publisher import NotAPublisher, Publisher
from btq_lang.evidence.runs import Oddities


def sessions(
    address: str,
    entries: Collection[str],
    stop: Flag,
    tell: Callable[[str], None],
    wait: Callable[[], None],
    look: Callable[[int], None] = lambda time: None,
) -> Iterator[LogSession]:
    """The sessions of the robots that publish at an address, until it is stopped.

    Args:
        entries: those of the blackboard that are wanted.
        stop: ends the last session.
        tell: given what happens to the connection.
        wait: called several times a second.
        look: as in `sessions_of`.
    """
    yield from sessions_of(_followed(address, entries, stop, wait), tell, look)


def sessions_of(
    events: Iterator[Event], tell: Callable[[str], None], look: Callable[[int], None] = lambda time: None
) -> Iterator[LogSession]:
    """The sessions that the events of a `Following` make; each must be read before the next is requested.

    Args:
        look: called with each time until which all that the robot did has been read.
    """
    for event in events:
        began = [event] if isinstance(event, Began) else []
        while began:
            yield _session(began.pop(), events, began, tell, look)
        if isinstance(event, Notice):
            tell(event.text)


def _session(
    began: Began,
    events: Iterator[Event],
    after: list[Began],
    tell: Callable[[str], None],
    look: Callable[[int], None],
) -> LogSession:
    samples: dict[str, SampleSeries] = {}
    remarks: list[str] = []
    if began.is_amid:
        remarks.append("it was running already, so what was active then is left out")
        tell("a run is open already; what is active now is left out")
    return LogSession(
        began.tree, _transitions(began.tree, events, samples, remarks, after, tell, look), samples, remarks
    )


def _transitions(
    tree: LoggedTree,
    events: Iterator[Event],
    samples: dict[str, SampleSeries],
    remarks: list[str],
    after: list[Began],
    tell: Callable[[str], None],
    look: Callable[[int], None],
) -> Iterator[Transition]:
    """The transitions of a session; samples and remarks are appended while they are read, and at the end the next
    session.
    """
    gaps, silent_until, passed = Oddities(), 0.0, 0
    for event in events:
        if isinstance(event, Came):
            yield from event.transitions
        elif isinstance(event, Sampled):
            for entry, value in event.values.items():
                samples.setdefault(entry, SampleSeries()).add(event.time, value)
        elif isinstance(event, Passed):
            passed = event.time
            look(passed)
        elif isinstance(event, LostTransitions):
            yield passed, UNTIL, IDLE
            before = gaps.count(f"gaps: {event.why}", event.time)
            if time.monotonic() >= silent_until:
                silent_until = time.monotonic() + _BETWEEN
                times = f", {before + 1} times so far" if before else ""
                tell(f"gap: {event.why}{times}; what happened meanwhile is unknown")
        elif isinstance(event, Began):
            after.append(event)
            tell("the robot has been started again" if event.tree.is_like(tree) else "another tree")
            break
        else:
            tell(event.text)
    yield passed, UNTIL, IDLE
    remarks.extend(gaps.remarks())


def _followed(address: str, entries: Collection[str], stop: Flag, wait: Callable[[], None]) -> Iterator[Event]:
    """The events of a thread that follows a publisher, until it is stopped and no more are there."""
    events: queue.Queue[Event | Exception] = queue.Queue(_MOST_WAITING)
    thread = Thread(target=_follow, args=(address, entries, stop, events), daemon=True)
    thread.start()
    try:
        while True:
            try:
                event = events.get(timeout=_SLICE)
            except queue.Empty:
                if not thread.is_alive() and events.empty():
                    return
            else:
                if isinstance(event, Exception):
                    raise event
                yield event
            wait()
    finally:
        stop.set()
        while thread.is_alive():  # also if it waits for room in the queue
            while not events.empty():
                events.get()
            thread.join(_SLICE)


def _follow(address: str, entries: Collection[str], stop: Flag, events: queue.Queue[Event | Exception]) -> None:
    try:
        publisher = Publisher(address, stop.is_set)
        try:
            following = Following(publisher.ask, lambda: time.monotonic_ns() // 1000, entries, address)
            is_last, passed = False, following.passed
            while not is_last:
                is_last = stop.wait(following.pause)
                for event in following.step():
                    if following.refused:
                        raise NotAPublisher(following.refused)
                    events.put(event)
                if following.passed is not None and following.passed != passed:
                    events.put(Passed(following.passed))
                passed = following.passed
        finally:
            publisher.close()
    except Exception as error:  # no publisher, or a bug: it is raised where people see it
        events.put(error)


_MOST_WAITING: Final = 256  # events; while the judge is slower than the robot, the publisher's buffer overflows: a gap
_SLICE: Final = 0.1  # s
_BETWEEN: Final = 10.0  # s between two gaps that are reported
