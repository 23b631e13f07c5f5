"""`btq preview`: shows a mission's trees in a browser, redrawn when a file changes or an editor sends a new text."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from threading import Event, Lock, Thread
from typing import TYPE_CHECKING

from btq_lang.graph.picture import picture, places
from btq_lang.preview.server import Preview
from btq_lang.projects.files import Files, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused, refuse
from btq_lang.requirements.resolve import requirements
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.loader import absolute, shown, stamp
from btq_lang.workspace.watcher import watch
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import RequirementVerdict
    from btq_lang.graph.missions import MeasuredBy


class PreviewOptions(Record):
    """The options of `btq preview`.

    Attributes:
        port: on this machine; 0: a free one.
        open: show it in the browser.
        evidence: the paths of logs, stores and files of verdicts; none: those of the project.
        on_click: the command to run on a click on a node.
        follow: read the messages of an editor from standard input.
    """

    file: str
    port: int
    open: bool
    evidence: Sequence[str]
    on_click: str | None
    follow: bool


def run(options: PreviewOptions, messages: CommandOutput) -> int:
    """Serve one file until Ctrl+C."""
    refuse(usage_problem([options.file]))
    if not os.path.isfile(options.file):
        what = "expected a file, found a folder" if os.path.isdir(options.file) else "no such file"
        raise Refused(f"{options.file}: {what}")
    mission = _Mission(absolute(options.file), shlex.split(options.on_click or ""), options.evidence)
    try:
        preview = Preview(options.port, mission.drawn, mission.reveal)
    except (OSError, OverflowError) as error:
        raise Refused(f"port {options.port}: {error}") from error
    print(f"{shown(mission.path)} is shown at {preview.url}", flush=True)
    ended = Event()
    if options.follow:
        Thread(target=_follow, args=(mission, preview, ended), daemon=True).start()
    else:
        messages.remark("Watching for changes; press Ctrl+C to stop")
    if options.open:
        import webbrowser

        webbrowser.open(preview.url)

    def wait(seconds: float) -> None:
        if ended.wait(seconds):
            raise EOFError

    Thread(target=mission.judge, args=(preview.changed,), daemon=True).start()
    try:
        for _ in watch(mission.watched, stamp, wait, time.monotonic):
            mission.judge_again()
            preview.changed()
    except KeyboardInterrupt:
        messages.remark("")
    except EOFError:  # the editor has gone
        pass
    preview.close()
    return 0


def _follow(mission: _Mission, preview: Preview, ended: Event) -> None:
    """Follow an editor's messages on standard input, a JSON object a line: the `line` of its cursor, its `text`, and a
    `run` of the logs to show.
    """
    try:
        for line_read in sys.stdin.buffer:
            try:
                message = json.loads(line_read)
                text, line, run = message.get("text"), message.get("line"), message.get("run")
            except (ValueError, AttributeError):
                print(f"btq preview: expected a JSON object, found {line_read!r}", file=sys.stderr)
                continue
            if isinstance(text, str):
                mission.typed(text)
                preview.changed()
            if isinstance(line, int):
                preview.mark_line(line)
            if isinstance(run, dict):
                preview.show_run(json.dumps(run))
    finally:
        ended.set()


class _Mission:
    """The current state of the file; several pages may request it at once."""

    def __init__(self, path: str, on_click: Sequence[str], evidence: Sequence[str]) -> None:
        self.path = path
        self._on_click = on_click
        self._evidence = evidence
        self._logs: tuple[str, ...] = ()
        self._verdicts: Sequence[RequirementVerdict] = ()
        self._is_outdated = Event()
        self._is_outdated.set()
        self._files = Files()
        self._lock = Lock()
        self._watched: tuple[str, ...] = (path,)
        self._read()  # so that all dependencies are watched from the start

    def drawn(self, folded: Sequence[str]) -> dict[str, object]:
        """The picture for the page, or the reason why there is none."""
        workspace = self._read()
        title = os.path.basename(self.path)
        if isinstance(workspace, str):
            return {"title": title, "trouble": workspace}
        drawing = picture(workspace, self.path, folded, self._measured_by(workspace))
        lines = {key: self._position(workspace, span)[0] for key, span in drawing.places.items()}
        return {"title": title, "svg": drawing.svg, "lines": lines}

    def reveal(self, key: str) -> dict[str, object]:
        """Print the place of a node, which terminals turn into a link, and open it in the user's editor."""
        workspace = self._read()
        span = None if isinstance(workspace, str) else places(workspace, self.path).get(key)
        if span is None or isinstance(workspace, str):
            return {"trouble": "this node no longer exists"}
        line, column = self._position(workspace, span)
        place = f"{shown(self.path)}:{line}:{column}"
        print(place, flush=True)
        values = {"file": self.path, "line": str(line), "column": str(column)}
        try:
            if self._on_click:
                subprocess.Popen([_with_values(word, values) for word in self._on_click], stdin=subprocess.DEVNULL)
        except OSError as error:
            return {"trouble": f"{self._on_click[0]}: {error.strerror}"}
        return {"said": place}

    def judge(self, judged: Callable[[], None]) -> None:
        """Judge the mission by the evidence, now and each time that it is outdated; reading logs takes time.

        Args:
            judged: called when the verdicts have changed.
        """
        from btq_lang.commands.given_evidence import evidence_paths, verdicts_for  # it imports the readers of logs

        while self._is_outdated.wait():
            self._is_outdated.clear()
            problems: list[str] = []
            groups, _ = Files().groups([self.path])  # as saved: `measured_by` judges again what has been typed since
            self._logs = tuple(evidence_paths(self._evidence, groups))
            verdicts_of = verdicts_for(self._logs, groups, problems) if self._logs else None
            for problem in problems:
                print(f"btq preview: {problem}", file=sys.stderr)
            verdicts = verdicts_of(self.path) if verdicts_of is not None else ()
            if verdicts != self._verdicts:
                self._verdicts = verdicts
                judged()

    def judge_again(self) -> None:
        """Have the evidence judged again, as a file has changed."""
        self._is_outdated.set()

    def _measured_by(self, workspace: Workspace) -> MeasuredBy:
        if not self._verdicts:
            return lambda applied: ()
        from btq_lang.evidence.boxes import measured_by  # few missions have evidence

        return measured_by(requirements(workspace, self.path), self._verdicts)

    def typed(self, text: str) -> None:
        """Use this text from now on instead of the file on the disk."""
        with self._lock:
            self._files.overlay[self.path] = text

    def watched(self) -> tuple[str, ...]:
        """The files that the picture depends on, as far as known."""
        return (*self._watched, *self._logs)

    def _position(self, workspace: Workspace, span: Span) -> tuple[int, int]:
        """Line and column, counted from 1, in the original file."""
        file = workspace.files[self.path]
        position = file.source_lines.position(file.on_disk(span).start)
        return position.line + 1, position.column + 1

    def _read(self) -> Workspace | str:
        """The mission with its includes, or why it cannot be read."""
        with self._lock:
            groups, problems = self._files.groups([self.path])
        for group in groups:
            if self.path in group.given:
                self._watched = (self.path, *group.watched)
                return group.workspace
        return "; ".join(map(str, problems))


def _with_values(word: str, values: dict[str, str]) -> str:
    """`+{line}` with the line filled in; all other braces stay, because editor commands may contain them."""
    for name, value in values.items():
        word = word.replace(f"{{{name}}}", value)
    return word
