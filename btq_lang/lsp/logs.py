"""Verdicts on the open projects' requirements: a process of its own judges the logs, and its summary is loaded.

One invariant: the server never reads a log.  It looks at names, sizes and times of the logs that `[evidence]` names, in
a thread; when these have changed, and then rest, `btq verify --summary` reads the logs, one project at a time.
Summaries stay in the user's cache, each named by what it was made of, so that a new session need not read them again.
"""

from __future__ import annotations

import asyncio
import hashlib
import json
import logging
import os
from asyncio.subprocess import DEVNULL, Process
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final

from lsprotocol import types

from btq_lang.lsp.editor import Handlers, RequestRefused, Server, UnknownDocument
from btq_lang.lsp.processes import start_python
from btq_lang.lsp.progress import progress
from btq_lang.util.caches import cache_folder
from btq_lang.util.version import __version__

if TYPE_CHECKING:
    from btq_lang.ide.runs import LoggedRun
    from btq_lang.ide.verdicts import ProjectVerdicts
    from btq_lang.workspace.config import Project
    from btq_lang.workspace.workspace import Workspace


RUNS = "btq.server.runs"
RUN = "btq.server.run"
JUDGED = "$/btq/judged"  # a notification: pictures and overviews that the editor shows are outdated


handlers = Handlers()


def watch_logs(server: Server) -> None:
    """Have the logs of a server's projects judged from when it has read their folders."""
    logs = Logs(server)
    server.on_scanned, server.on_saved, server.on_end = logs.watch, logs.saved, logs.stop


@handlers.feature(types.SHUTDOWN)
def shutdown(server: Server, _: None) -> None:
    server.on_end()


@handlers.feature(types.TEXT_DOCUMENT_DID_SAVE)
def did_save(server: Server, params: types.DidSaveTextDocumentParams) -> None:
    server.on_saved(server.convert.path(params.text_document.uri))


@handlers.command(RUNS)
def runs(server: Server, document: types.TextDocumentIdentifier) -> list[dict[str, object]]:
    """The runs in the logs that people look for: the `run`, and what it is."""
    from btq_lang.ide.runs import runs_to_show  # few projects have logs

    shown_runs = runs_to_show(*_mission_with_verdicts(server, document))
    return [{"run": run, "said": description} for run, description in shown_runs]


@handlers.command(RUN)
async def run(server: Server, document: types.TextDocumentIdentifier, number: int) -> dict[str, object]:
    """A run of the logs, step by step, with the keys of nodes as in the picture."""
    from btq_lang.ide.runs import logged_run, run_on_picture  # as above

    workspace, path, evidence = _mission_with_verdicts(server, document)
    where = logged_run(workspace, path, evidence, number)
    if where is None:
        raise RequestRefused(f"the logs have no run {number} of this mission")
    run_steps = await _read_run(evidence.root, where)
    if isinstance(run_steps, str):
        raise RequestRefused(run_steps)
    drawn = run_on_picture(workspace, path, where, run_steps)
    if drawn is None:
        raise RequestRefused("this run is of an earlier text: the trees have been edited since, or are not saved")
    return drawn


def _mission_with_verdicts(
    server: Server, document: types.TextDocumentIdentifier
) -> tuple[Workspace, str, ProjectVerdicts]:
    with suppress(UnknownDocument):
        workspace, path = server.at(document, reads=True)
        if (evidence := server.session.evidence(workspace)) is not None:
            return workspace, path, evidence
    raise RequestRefused("no logs of this mission have been judged; name them with `logs` in [evidence] of btq.toml")


async def _read_run(root: str, run: LoggedRun) -> dict[str, Any] | str:
    """A run as `btq verify --run` prints it, or why there is none."""
    log, number = os.path.join(root, run.log), str(run.number_in_log)
    process = await _start_btq(root, ("verify", "--no-store", log, "--mission", run.mission, "--run", number))
    output, errors = await process.communicate()
    return json.loads(output) if process.returncode == 0 else errors.decode(errors="replace").strip()


class Logs:
    """The logs of the projects of a session, and the process that judges them."""

    def __init__(self, server: Server) -> None:
        self._server: Final = server
        self._task: asyncio.Task[None] | None = None
        self._process: Process | None = None
        self._shown: Final[dict[str, str]] = {}  # what is shown, or could not be made, by the project's folder
        self._before: Final[dict[str, str]] = {}  # what was there at the last look
        self._saved = asyncio.Event()  # a file was saved, or the logs are to be looked at for another reason

    def watch(self) -> None:
        """Look at the logs from now on."""
        if self._task is None:
            self._task = asyncio.ensure_future(self._watch())

    def stop(self) -> None:
        """End the process, and look at the logs no more."""
        if self._task is not None:
            self._task.cancel()
        if self._process is not None and self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.terminate()

    def saved(self, path: str) -> None:
        """Note that a file has been saved: if the summary does not fit the new text, the logs are read again."""
        session = self._server.session
        workspace = session.workspace_of(path)
        if workspace is None or workspace.project.root not in self._shown:
            return
        evidence = session.evidence(workspace)
        if evidence is not None:
            from btq_lang.ide.verdicts import is_outdated  # few projects have logs

            missions = evidence.missions.keys() & workspace.files
            if not any(is_outdated(workspace, mission, evidence) for mission in missions):
                return
        del self._shown[workspace.project.root]
        self._saved.set()

    async def _watch(self) -> None:
        while True:
            for project in self._projects():
                try:
                    await self._look(project)
                except OSError as error:
                    self._server.log_failure(error)
            with suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self._saved.wait(), PAUSE)
            self._saved.clear()

    def _projects(self) -> Sequence[Project]:
        projects = (workspace.project for workspace in self._server.session.workspaces())
        return [
            *{
                project.root: project for project in projects if project.evidence is not None and project.evidence.logs
            }.values()
        ]

    async def _look(self, project: Project) -> None:
        root = project.root
        there = await asyncio.to_thread(_digest_of_logs, project)
        is_at_rest = there == self._before.get(root, there)
        self._before[root] = there
        if self._shown.get(root) == there or not is_at_rest:
            return
        texts = await asyncio.to_thread(_digest_of_files, [*self._missions(root)])
        summary = os.path.join(cache_folder(), f"{_digest(root)}-{_digest(there, texts)}.json")
        if not os.path.exists(summary) and there != _digest(repr(project.evidence)):
            await self._judge(root, summary)
        if os.path.exists(summary):
            self._show(root, summary)
        self._shown[root] = there

    def _missions(self, root: str) -> set[str]:
        workspaces = self._server.session.workspaces()
        return {path for workspace in workspaces if workspace.project.root == root for path in workspace.files}

    async def _judge(self, root: str, summary: str) -> None:
        """Have the logs judged, with progress in the editor."""
        os.makedirs(os.path.dirname(summary), exist_ok=True)
        process = await _start_btq(root, ("verify", "--no-store", "--summary", summary))
        self._process = process
        assert process.stdout is not None, "it is a pipe"
        assert process.stderr is not None, "likewise"
        errors = asyncio.ensure_future(process.stderr.read())
        async with progress(self._server, "judging logs") as report:
            async for line in process.stdout:
                now = json.loads(line)
                message = f"{now['done']} of {now['of']} logs, {now['runs']} runs"
                report(100 * now["done"] // max(now["of"], 1), message)
        if await process.wait() == _TROUBLE:
            logging.getLogger(__name__).warning((await errors).decode(errors="replace").strip())
        else:
            await errors

    def _show(self, root: str, summary: str) -> None:
        from btq_lang.evidence.json_document import NotVerdicts, read_verdicts  # few projects have logs
        from btq_lang.ide.verdicts import ProjectVerdicts
        from btq_lang.workspace.loader import absolute, read

        try:
            missions = read_verdicts(read(summary)[0] or "")
        except NotVerdicts as error:
            logging.getLogger(__name__).warning("%s: %s", summary, error)
            return
        by_path = {absolute(os.path.join(root, mission.file)): mission for mission in missions if mission.runs}
        self._server.session.show(root, ProjectVerdicts(root, by_path))
        self._server.schedule.check_soon(self._server.session.paths())
        self._server.refresh()
        self._server.protocol.notify_plain(JUDGED, {})
        _forget_others(summary, root)


async def _start_btq(folder: str, words: Sequence[str]) -> Process:
    """A command of btq in a folder."""
    return await start_python(folder, _COMMAND, words, stdin=DEVNULL)


def _digest_of_logs(project: Project) -> str:
    """A digest of what is judged: the logs with their sizes and times, and the project's settings for them."""
    from btq_lang.projects.files import logs_of
    from btq_lang.workspace.loader import stamp

    stamped = [f"{path} {stamp(path)}" for log in logs_of(project) for path in _files(log) if stamp(path) is not None]
    return _digest(repr(project.evidence), *stamped)


def _files(path: str) -> Sequence[str]:
    """A file, or what is below a folder."""
    if not os.path.isdir(path):
        return [path]
    return sorted(os.path.join(folder, name) for folder, _, names in os.walk(path) for name in names)


def _digest_of_files(paths: Sequence[str]) -> str:
    """A digest of files as they are on the disk, which is what is judged."""
    from btq_lang.workspace.loader import read

    return _digest(*(read(path)[0] or "" for path in sorted(paths)))


def _digest(*parts: str) -> str:
    return hashlib.sha256("\n".join([__version__, *parts]).encode(errors="surrogateescape")).hexdigest()[:_DIGITS]


def _forget_others(summary: str, root: str) -> None:
    """Remove older summaries of a project."""
    folder, name = os.path.split(summary)
    for entry in os.listdir(folder):
        if entry.startswith(_digest(root)) and entry != name:
            with suppress(OSError):
                os.remove(os.path.join(folder, entry))


PAUSE = 5  # seconds between two looks at the logs
_COMMAND: Final = "import sys; from btq_lang.cli import main; sys.exit(main())"
_TROUBLE: Final = 2  # the exit code of an error
_DIGITS: Final = 24
