"""`btq verify --live`: judge a running robot until Ctrl+C, and print the verdicts then as for logs."""

from __future__ import annotations

import signal
import sys
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event
from types import FrameType
from typing import Final
from urllib.parse import urlsplit

from btq_lang.commands.candidates import candidates, strict_problem
from btq_lang.commands.live_lines import Lines
from btq_lang.commands.live_screen import Screen, is_screen
from btq_lang.commands.output import form_of, form_problem, is_coloured
from btq_lang.commands.stored import name_problem, opened, store_of_project
from btq_lang.commands.verdict_events import events_problem
from btq_lang.commands.verdict_formats import FORMATS
from btq_lang.commands.verdict_report import finish
from btq_lang.evidence.judging import Means
from btq_lang.evidence.own_trees import OwnTrees
from btq_lang.evidence.readers.groot2.publisher import NoLive, check_installed
from btq_lang.evidence.readers.groot2.sessions import sessions
from btq_lang.evidence.verifying import judged_live
from btq_lang.evidence.watching import Watched
from btq_lang.projects.files import usage_problem
from btq_lang.projects.options import refuse


def run(options: Namespace) -> int:
    """Judge a running robot; returns the exit code."""
    if options.store is None and not options.no_store:
        options.store = store_of_project()
    refuse(usage_problem(options.mission) or _problem(options))
    problems: list[str] = []
    own = OwnTrees()
    missions = candidates(options.mission, (), problems) or own.missions
    problems += strict_problem(options, missions)
    keeping = opened(options, problems)
    refuse(*problems)
    address = options.live
    entries = {signal.entry for mission in missions for signal in mission.requirements.signals.values()} - {""}
    form = form_of(options, FORMATS)
    stream = sys.stdout if form == "table" and options.output is None else sys.stderr
    shown = Screen(stream, is_coloured(options, True)) if is_screen(stream) else Lines(stream)
    with stopped_by_signals() as stop, shown:
        robot = sessions(
            address,
            entries,
            stop,
            lambda text: watched.tell(text),
            lambda: shown.refresh(watched),
            lambda time: watched.look(time),
        )
        watched = Watched(own.of(robot, address) if missions is own.missions else robot, address, shown.show)
        means = Means(missions, with_timelines=form == "html", keeping=keeping)
        found = judged_live(watched, address, means, options.mission)
    return finish(options, found, missions, ())


@contextmanager
def stopped_by_signals() -> Iterator[Event]:
    """A flag that Ctrl+C and the signal to terminate raise; at the second, the process ends as it always does."""
    stop = Event()

    def raise_it(number: int, frame: FrameType | None) -> None:
        stop.set()
        restore()

    def restore() -> None:
        for each, handler in before.items():
            signal.signal(each, handler)

    before = {each: signal.signal(each, raise_it) for each in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield stop
    finally:
        restore()


def _problem(options: Namespace) -> str | None:
    """What is wrong with the command line."""
    given = vars(options)
    for option, why in _NOT_LIVE.items():
        if given[option.strip("-").replace("-", "_")]:
            return f"{option} {why}"
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
        parts = urlsplit(options.live)
        is_address = parts.scheme == "tcp" and bool(parts.hostname and parts.port) and not parts.path
    except ValueError:
        is_address = False
    if not is_address:
        return f"--live {options.live}: expected an address with a port, as in tcp://127.0.0.1:1667"
    try:
        check_installed()
    except NoLive as error:
        return str(error)
    return form_problem(options, FORMATS) or events_problem(options)


_NOT_LIVE: Final = {
    "--signals": "is read before the robot runs; with --live, values come from its blackboard",
    "--summary": "is for logs",
    "--run": "is for logs",
    "--by": "goes with --store DIR and no log",
    "--engine": "goes with --store DIR and no log",
    "--label-by": "is for logs, which are in folders; give --label NAME",
    "--robot-by": "is for logs, which are in folders; give --robot NAME",
}
