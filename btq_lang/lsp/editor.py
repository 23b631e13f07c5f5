"""The editor at the other end: what it can do, what it has open, and what it has been told.

Every answer is made in the terms of `convert`; which request asks which feature is in the modules beside this one.
"""

from __future__ import annotations

import asyncio
import functools
import gc
import json
import logging
import os
import sys
from collections.abc import Callable, Iterable
from itertools import chain
from threading import Event
from time import perf_counter
from typing import TYPE_CHECKING, Any, BinaryIO, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.io_ import StdoutWriter, run_async
from pygls.lsp.server import LanguageServer

from btq_lang import ide as features
from btq_lang.lsp import failures
from btq_lang.lsp.convert import Converter
from btq_lang.lsp.protocol import Json, Messages, Protocol
from btq_lang.lsp.session import Session
from btq_lang.util.version import __version__
from btq_lang.workspace.findings import Findings
from btq_lang.workspace.queries import Cancelled

if TYPE_CHECKING:
    from btq_lang.ide import Colours
    from btq_lang.workspace.workspace import Workspace

T = TypeVar("T")
Handler = TypeVar("Handler", bound=Callable[..., Any])


class Refused(JsonRpcException):
    """A request that cannot be granted, with the reason for the user: no failure of the server."""

    CODE = -32803  # RequestFailed


NOT_JSON = json.JSONDecodeError, UnicodeDecodeError
NO_ITEMS = Json("[]")
NOTHING = Json('{"kind": "full", "items": []}')
TO_ASK = 0.01  # seconds, in which an editor that was told what is wrong with a file asks for more about it
A_PAUSE = 0.1  # seconds, less than between two keys of most who type
UNNOTICED = 0.05  # seconds, for which an answer may wait for a check
MOST_REST = 0.5  # seconds, for which a file that takes long to check is left alone after a key
A_LOOK = 5  # seconds between two looks at whether the editor's process still runs
MOST_DETAILS = 500  # a parameter may hold a whole text


class Traced(logging.Handler):
    """What is logged, for an editor that traces: it may not show what a server writes to standard error."""

    def __init__(self, server: Server) -> None:
        super().__init__(logging.WARNING)  # pygls logs at lower levels what it sends, this too
        self._server = server
        self._is_telling = False

    def emit(self, record: logging.LogRecord) -> None:
        if not self._is_telling:  # what goes wrong while it is told is logged, too
            self._is_telling = True
            self._server.trace(record.getMessage(), self.format(record))
            self._is_telling = False


class Server(LanguageServer):
    """The server: a session, the way to the editor's terms, and what the editor has been told."""

    protocol: Protocol

    def __init__(self) -> None:
        super().__init__("btq", __version__, protocol_cls=Protocol)
        self.session = Session()
        self.convert = Converter()
        self.versions: dict[str, int] = {}
        self.published: dict[str, tuple[int | None, int | None]] = {}  # hashes of what was told, if any, and versions
        self.asks_for_all = False  # the editor asks for the diagnostics of all files, and not only of what is open
        self.shown: set[str] = set()  # the files of which an editor that asks may still show something
        self.tokens: dict[str, tuple[str, Colours]] = {}
        self.count = 0
        self.waiting: dict[str, None] = {}
        self.last_key = -MOST_REST  # when something was typed
        self._pause: asyncio.TimerHandle | None = None
        self._preparing: asyncio.Task[None] | None = None
        self.answering = 0  # how many questions are answered step by step: somebody waits
        self._ready: set[str] = set()  # the files for whose first questions everything is there
        self.task: asyncio.Task[None] | None = None
        self.scanned = asyncio.Event()  # the folders were read once: before, what files there are is not known
        self._is_settled = False  # what was read first is frozen for the garbage collector
        self._failures: set[object] = set()  # the places of those that are logged
        self.protocol.log_failure = self.log_failure
        self._watching: asyncio.Task[None] | None = None
        self.is_outdated: Callable[[], bool] = lambda: False  # an edit waits to be handled

    def start_io(self, stdin: BinaryIO | None = None, stdout: BinaryIO | None = None) -> None:
        """As in pygls, but for how messages are read."""
        self._stop_event = Event()
        self.protocol.set_writer(StdoutWriter(stdout or sys.stdout.buffer))
        reader = Messages(stdin or sys.stdin.buffer)
        self.is_outdated = lambda: reader.bring_edit
        report = self.report_server_error
        try:
            asyncio.run(run_async(self._stop_event, reader, self.protocol, error_handler=report))
        except BrokenPipeError:
            logging.getLogger(__name__).error("the editor has gone")
        except (KeyboardInterrupt, SystemExit):
            pass
        finally:
            self.shutdown()  # type: ignore[no-untyped-call]  # pygls has no types there

    def report_server_error(self, error: Exception, source: Any) -> None:
        """As in pygls, which shows the user that a message is not JSON, and does not answer it."""
        if isinstance(error, NOT_JSON):
            self.protocol.refuse(types.ErrorCodes.ParseError, f"a message is not JSON: {error}")
        else:
            super().report_server_error(error, source)

    # ---- the end ----

    @property
    def exit_code(self) -> int:
        """What the process ends with: an editor that goes without `shutdown` has crashed, or is badly written."""
        return 0 if self.protocol.is_shut_down else 1

    def end_with(self, process: int) -> None:
        """End soon after a process has ended: an editor that crashes may leave its end of the pipes open."""
        self._watching = asyncio.ensure_future(self._end_with(process))

    async def _end_with(self, process: int) -> None:
        while _is_running(process):
            await asyncio.sleep(A_LOOK)
        try:
            logging.getLogger(__name__).error("the editor's process %d has ended", process)
        finally:  # nobody may read what is logged
            os._exit(self.exit_code)  # `sys.exit` would wait for the thread that waits for the next message

    # ---- what an editor that traces is told ----

    def feature(self, feature_name: str, options: Any | None = None) -> Callable[[Handler], Handler]:
        """As in pygls, which would look for what each handler takes, and compile a converter to check its options."""

        def register(handler: Handler) -> Handler:
            self.protocol.fm.features[feature_name] = self._timed(feature_name, handler)
            if options is not None:
                self.protocol.fm.feature_options[feature_name] = options
            return handler

        return register

    def trace(self, message: str, details: str) -> None:
        """Tell what the server does, if the editor has asked for it; the details, if it has asked for those."""
        value = self.protocol.trace
        if value is not types.TraceValue.Off:
            verbose = details if value is types.TraceValue.Verbose else None
            self.log_trace(types.LogTraceParams(message, verbose))

    def _timed(self, name: str, handler: Handler) -> Handler:
        """A handler that says how long it took."""

        def say(begin: float, arguments: tuple[Any, ...]) -> None:
            if self.protocol.trace is not types.TraceValue.Off:
                self.trace(f"{name}: {1000 * (perf_counter() - begin):.1f} ms", repr(arguments)[:MOST_DETAILS])

        @functools.wraps(handler)
        def answer(*arguments: Any) -> Any:
            begin = perf_counter()
            try:
                return handler(*arguments)
            finally:
                say(begin, arguments)

        @functools.wraps(handler)
        async def answer_later(*arguments: Any) -> Any:
            begin = perf_counter()
            try:
                return await handler(*arguments)
            finally:
                say(begin, arguments)

        return answer_later if asyncio.iscoroutinefunction(handler) else answer  # type: ignore[return-value]  # `wraps`

    def log_failure(self, error: BaseException) -> tuple[str, bool]:
        """Log an exception that nothing expected, once: while somebody types it is raised at every key.

        Returns:
            What is said of it, and whether it is a new one.
        """
        said, where = failures.internal_error(error), failures.place(error)
        is_new = where not in self._failures
        self._failures.add(where)
        if is_new:
            logging.getLogger(__name__).error(said, exc_info=error)
        return said, is_new

    # ---- what an editor can do ----

    @property
    def pulls(self) -> bool:
        """The editor asks for diagnostics itself."""
        document = self.client_capabilities.text_document
        return document is not None and document.diagnostic is not None

    @property
    def takes_snippets(self) -> bool:
        document = self.client_capabilities.text_document
        completion = document.completion if document else None
        item = completion.completion_item if completion else None
        return bool(item and item.snippet_support)

    @property
    def takes_links(self) -> bool:
        document = self.client_capabilities.text_document
        return bool(document and document.definition and document.definition.link_support)

    @property
    def asks_for_tokens(self) -> bool:
        document = self.client_capabilities.text_document
        return document is not None and document.semantic_tokens is not None

    def versions_for_edits(self) -> dict[str, int] | None:
        """The versions of open files, for an editor that compares them."""
        workspace = self.client_capabilities.workspace
        edit = workspace.workspace_edit if workspace else None
        return self.versions if edit and edit.document_changes else None

    def can_refresh(self, what: str) -> bool:
        """Whether the editor asks again when told so."""
        capabilities = getattr(self.client_capabilities.workspace, what, None)
        return bool(capabilities and capabilities.refresh_support)

    def knows_command(self, command: str) -> bool:
        """Whether the editor has said, under `experimental`, that it has a command of its own."""
        experimental = self.client_capabilities.experimental
        commands = experimental.get("commands") if isinstance(experimental, dict) else None
        return isinstance(commands, list) and command in commands

    # ---- asking features ----

    def at(self, document: types.TextDocumentIdentifier, *, reads: bool = False) -> tuple[Workspace, str] | None:
        """The workspace and the path of a document; None where it is unknown, or written in XML.

        Args:
            reads: what is asked changes nothing and names places that `convert.range` finds, so XML will do.
        """
        path = self.convert.path(document.uri)
        workspace = self.session.workspace_of(path)
        if workspace is None or (workspace.files[path].origin is not None and not reads):
            return None
        return workspace, path

    def ask(
        self,
        document: types.TextDocumentIdentifier,
        position: types.Position,
        feature: Callable[[Workspace, str, int], T],
        *,
        reads: bool = False,
    ) -> tuple[Workspace, str, T] | None:
        """What a feature answers at a position, and the workspace and path that its spans are of; `reads`: as `at`."""
        place = self.at(document, reads=reads)
        offset = self.convert.offset_made(*place, position) if place is not None else None
        if place is None or offset is None:
            return None
        workspace, path = place
        return workspace, path, feature(workspace, path, offset)

    # ---- telling diagnostics ----

    def findings(self, path: str) -> Findings:
        """What is wrong with a file; nothing is said of XML that is nobody's tree: an editor may send all it has."""
        found = self.session.findings(path)
        workspace = self.session.workspace_of(path)
        if workspace is None or workspace.files[path].origin is None or path in workspace.included_files:
            return found
        is_strange = any(one.rule == "xml-root" for one in found.diagnostics)
        return Findings([]) if is_strange else found

    def told(self, path: str) -> Json | None:
        """All that is wrong with a file, a mission or a project's, as JSON; None: the file is not known."""
        if path in self.session.projects:
            return self.convert.problems(*self.session.projects[path])
        workspace = self.session.workspace_of(path)
        return None if workspace is None else self.convert.findings(workspace, path, self.findings(path))

    def check_soon(self, paths: Iterable[str]) -> None:
        """Tell the diagnostics of files, those first that come first; what waits already waits on behind them."""
        self.waiting = dict.fromkeys((*paths, *self.waiting))
        for idle in (self._pause, self._preparing):
            if idle is not None:
                idle.cancel()
        if self.task is None or self.task.done():
            self.task = asyncio.ensure_future(self._check())

    async def rest(self, path: str) -> None:
        """Let whoever types ask first: wait after the last key as long as it takes to check a large file."""
        clock = asyncio.get_running_loop().time
        while (took := self.session.took.get(path, 0)) > UNNOTICED:
            rest = self.last_key + min(took, MOST_REST) - clock()
            if rest <= 0:
                break
            await asyncio.sleep(rest)

    async def check(self, path: str) -> None:
        """Check a file that an editor asks about, and begin anew if it is edited meanwhile."""
        while True:
            await self.rest(path)
            try:
                self.session.check(path, self.is_outdated)
                return
            except Cancelled:
                await asyncio.sleep(0)

    async def _check(self) -> None:
        """Check file by file, and listen between two: an edit that comes meanwhile is checked first, and what is asked
        meanwhile is answered before any file that is not open."""
        await asyncio.sleep(0)
        if self.pulls:
            self.waiting.clear()
            self.publish_projects()
            if self.can_refresh("diagnostics"):
                self.workspace_diagnostic_refresh(None)
        loop = asyncio.get_running_loop()
        told = -TO_ASK
        while self.waiting:
            path = next(iter(self.waiting))
            is_open = path in self.session.open
            if not is_open and (self.answering or loop.time() < told + TO_ASK):
                await asyncio.sleep(TO_ASK / 10)
                continue
            await self.rest(path)
            if path != next(iter(self.waiting)):  # another file was typed in meanwhile
                continue
            del self.waiting[path]
            try:
                self.session.check(path, self.is_outdated)
                self.publish(path)
            except Cancelled:
                self.waiting = {path: None, **self.waiting}
                await asyncio.sleep(0)
                continue
            except Exception as error:  # one file that cannot be checked must not silence the others
                self.log_failure(error)
            self.session.let_go()
            told = loop.time() if is_open else told
            await asyncio.sleep(0)
        for path in [path for path in self.published if not self.session.knows(path)]:
            self.publish(path)
        self._await_pause()

    def _await_pause(self) -> None:
        if self._pause is not None:
            self._pause.cancel()
        self._pause = asyncio.get_running_loop().call_later(A_PAUSE, self._use_pause)

    def _use_pause(self) -> None:
        """Do what would be in the way while somebody waits."""
        if self.answering:
            self._await_pause()
            return
        if self.scanned.is_set() and not self._is_settled:
            gc.freeze()  # what was read first stays: to look through it would hold up an answer
            self._is_settled = True
        self._preparing = asyncio.ensure_future(self._prepare())

    async def _prepare(self) -> None:
        """Get ready for the first questions about what is open, and listen between two steps: an edit ends it."""
        self._ready.intersection_update(self.session.open)
        for path in [path for path in self.session.open if path not in self._ready]:
            place = self.at(types.TextDocumentIdentifier(self.convert.uri(path)))
            if place is not None:
                tokens = features.making(*place, self.convert.encoding) if self.asks_for_tokens else ()
                for _ in chain(self.protocol.getting_ready(), tokens, features.getting_ready(*place)):
                    await asyncio.sleep(A_PAUSE if self.answering else 0)
            self._ready.add(path)

    def publish(self, path: str) -> None:
        """Tell the diagnostics of a file, unless the editor knows them."""
        version = self.versions.get(path)
        told = self.told(path) if path in self.session.open or self.session.setting("checkClosedFiles", True) else None
        if told is None:
            self.withdraw(path)
            self.session.forget(path)
            return
        known = self.published.get(path)
        now = self.published[path] = hash(told) if told != NO_ITEMS else None, version
        if now != known and (told != NO_ITEMS or known is not None or path in self.session.open):
            name = json.dumps({"uri": self.convert.uri(path), **({"version": version} if version is not None else {})})
            params = Json(f'{name[:-1]}, "diagnostics": {told}}}')
            self.protocol.tell(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS, params)

    def publish_projects(self) -> None:
        """Tell what is wrong with project files to an editor that asks for the diagnostics of open files alone."""
        for path in {*self.session.projects, *self.published}:
            if self.asks_for_all or path in self.session.open:
                self.withdraw(path)
            else:
                self.publish(path)

    def withdraw(self, path: str) -> None:
        """Tell that nothing is wrong with a file, if something was told by the URI that it has."""
        if self.published.pop(path, (None, None))[0] is not None:
            gone = {"uri": self.convert.uri(path), "diagnostics": []}
            self.protocol.tell(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS, gone)

    def report(self, path: str, previous: str | None) -> Json:
        """The diagnostics of a file for an editor that asks: all, or that nothing has changed."""
        items = self.told(path)
        if items is None:
            return NOTHING
        if items != NO_ITEMS:
            self.shown.add(path)
        result = f"{path in self.session.open}:{hash(items):x}"
        if previous == result:
            return Json(f'{{"kind": "unchanged", "resultId": "{result}"}}')
        return Json(f'{{"kind": "full", "resultId": "{result}", "items": {items}}}')

    def reload(self) -> None:
        """Read folders and projects again, and tell what has changed."""
        self.check_soon(self.session.reload())
        for what, refresh in (
            ("semantic_tokens", self.workspace_semantic_tokens_refresh),
            ("inlay_hint", self.workspace_inlay_hint_refresh),
            ("code_lens", self.workspace_code_lens_refresh),
        ):
            if self.can_refresh(what):
                refresh(None)


def _is_running(process: int) -> bool:
    """Whether there is a process of this number."""
    if sys.platform == "win32":  # there `os.kill` ends the process, whatever the signal
        import ctypes

        kernel = ctypes.WinDLL("kernel32", use_last_error=True)
        handle = kernel.OpenProcess(_SYNCHRONIZE, False, process)
        if not handle:
            return ctypes.get_last_error() == _ACCESS_DENIED
        has_ended = kernel.WaitForSingleObject(handle, 0) == 0
        kernel.CloseHandle(handle)
        return not has_ended
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):  # another user's; or no number of this system's, which says nothing
        pass
    return True


_SYNCHRONIZE, _ACCESS_DENIED = 0x00100000, 5  # of the Windows API
