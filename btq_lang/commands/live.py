"""`btq verify --live`: judge a running robot until Ctrl+C, and print the verdicts then as for logs."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event
from types import FrameType
from typing import Final
from urllib.parse import urlsplit

from btq_lang.commands.candidates import candidates, strict_problem
from btq_lang.commands.live_screen import Lines, Screen, is_screen
from btq_lang.commands.output import form_of, form_problem, is_coloured
from btq_lang.commands.stored import name_problem, opened, with_store
from btq_lang.commands.verdict_events import events_problem
from btq_lang.commands.verdict_report import finish
from btq_lang.commands.verify_options import FORMATS, VerifyOptions, given_options
from btq_lang.evidence.judging import Means
from btq_lang.evidence.own_trees import OwnTrees
from btq_lang.evidence.readers.groot2.publisher import NoLive, check_installed
from btq_lang.evidence.readers.groot2.sessions import sessions
from btq_lang.evidence.verifying import judged_live
from btq_lang.evidence.watching import Watched
from btq_lang.projects.files import usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import refuse


def verify_live(options: VerifyOptions, address: str, messages: CommandOutput) -> int:
    """Judge a running robot; returns the exit code."""
    options = with_store(options)
    refuse(usage_problem(options.mission) or _problem(options, address))
    problems: list[str] = []
    own_trees = OwnTrees()
    missions = candidates(options.mission, (), problems) or own_trees.missions
    problems += strict_problem(options.strict, missions)
    keeping = opened(options, problems)
    refuse(*problems)
    entries = {signal.entry for mission in missions for signal in mission.requirements.signals.values()} - {""}
    form = form_of(options.format, options.output, FORMATS)
    stream = sys.stdout if form == "table" and options.output is None else sys.stderr
    news_display = Screen(stream, is_coloured(options.color, True)) if is_screen(stream) else Lines(stream)
    with stopped_by_signals() as stop, news_display:
        robot = sessions(
            address,
            entries,
            stop,
            lambda text: watched.tell(text),
            lambda: news_display.refresh(watched),
            lambda time: watched.look(time),
        )
        is_own = missions is own_trees.missions
        watched = Watched(own_trees.of(robot, address) if is_own else robot, address, news_display.show)
        means = Means(missions, with_timelines=form == "html", keeping=keeping)
        verification = judged_live(watched, address, means, options.mission)
    return finish(options, verification, missions, (), messages)


@contextmanager
def stopped_by_signals() -> Iterator[Event]:
    """A flag that Ctrl+C and the signal to terminate raise; the second signal ends the process."""
    stop = Event()

    def raise_it(number: int, frame: FrameType | None) -> None:
        stop.set()
        restore()

    def restore() -> None:
        for number, handler in before.items():
            signal.signal(number, handler)

    before = {number: signal.signal(number, raise_it) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield stop
    finally:
        restore()


def _problem(options: VerifyOptions, address: str) -> str | None:
    """The usage error of the command line."""
    for option in given_options(options, [*_NOT_LIVE]):
        return f"{option} {_NOT_LIVE[option]}"
    if options.logs:
        return "--live watches a robot; judge logs by themselves"
    if options.jobs != 1:
        return "--jobs is for logs; a running robot is judged in one process"
    if problem := name_problem(options):
        return problem
    if options.store is None and (options.label or options.robot):
        where = "leave out --no-store" if options.no_store else "give --store DIR, where they are kept"
        return f"{'--label' if options.label else '--robot'} names the runs in a store; {where}"
    try:
        parts = urlsplit(address)
        is_address = parts.scheme == "tcp" and bool(parts.hostname and parts.port) and not parts.path
    except ValueError:
        is_address = False
    if not is_address:
        return f"--live {address}: expected an address with a port, as in tcp://127.0.0.1:1667"
    try:
        check_installed()
    except NoLive as error:
        return str(error)
    return form_problem(options.format, options.output, FORMATS) or events_problem(options.events)


_NOT_LIVE: Final = {
    "--signals": "is read before the robot runs; with --live, values come from its blackboard",
    "--summary": "is for logs",
    "--run": "is for logs",
    "--by": "goes with --store DIR and no log",
    "--engine": "goes with --store DIR and no log",
    "--label-by": "is for logs, which are in folders; give --label NAME",
    "--robot-by": "is for logs, which are in folders; give --robot NAME",
}
