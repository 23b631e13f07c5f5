"""The client: its capabilities, its open files, and what was published to it.

`convert` makes all results; the handlers are in the other modules of this package.
"""

from __future__ import annotations

import asyncio
import functools
import gc
import json
import logging
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import chain
from threading import Event, Timer
from time import perf_counter
from typing import TYPE_CHECKING, Any, BinaryIO, TypeVar
from typing import Protocol as Shape

from lsprotocol import types
from pygls.capabilities import get_capability
from pygls.exceptions import JsonRpcException
from pygls.io_ import run_async
from pygls.lsp.server import LanguageServer

from btq_lang import ide as features
from btq_lang.lsp.convert import Converter
from btq_lang.lsp.outlooks import Outlooks
from btq_lang.lsp.protocol import Json, Messages, OutgoingMessages, Protocol
from btq_lang.lsp.schedule import CheckSchedule
from btq_lang.lsp.tested import TestedScenarios
from btq_lang.projects import failures
from btq_lang.util.version import __version__

if TYPE_CHECKING:
    from btq_lang.ide.colours import Colours
    from btq_lang.lsp.session import Session
    from btq_lang.workspace.workspace import Workspace

T = TypeVar("T")
Handler = TypeVar("Handler", bound=Callable[..., Any])


class Asked(Shape):
    """The parameters of a request about a position."""

    text_document: types.TextDocumentIdentifier
    position: types.Position


class RequestRefused(JsonRpcException):
    """A request that is refused, with the reason for the user; not a failure of the server."""

    CODE = -32803  # RequestFailed


class RequestOutdated(RequestRefused):
    """A request whose answer would be about a text that has been edited."""

    CODE = -32801  # ContentModified


class UnknownDocument(Exception):  # not an error: there is nothing to answer
    """A document that btq does not know, or that a feature does not read."""


NOT_JSON = json.JSONDecodeError, UnicodeDecodeError
NO_ITEMS = Json("[]")
EMPTY_REPORT = Json('{"kind": "full", "items": []}')
POLL = 5  # seconds between checks that the editor's process still runs
MAX_DETAILS = 500  # a parameter may contain a whole text


class Handlers:
    """What a module registers: functions whose first argument is the server."""

    def __init__(self) -> None:
        self._registrations: list[Callable[[Server], object]] = []

    def feature(self, name: str, options: Any | None = None, otherwise: Any = None) -> Callable[[Handler], Handler]:
        """Handle a request or a notification; the arguments are those of `Server.feature`."""

        def add(handler: Handler) -> Handler:
            self._registrations.append(
                lambda server: server.feature(name, options, otherwise)(functools.partial(handler, server))
            )
            return handler

        return add

    def command(self, name: str) -> Callable[[Handler], Handler]:
        """Handle a command, whose arguments pygls converts as the annotations say."""

        def add(handler: Handler) -> Handler:
            self._registrations.append(lambda server: server.command(name)(handler))
            return handler

        return add

    def register(self, server: Server) -> None:
        """Register all of them with pygls."""
        for register in self._registrations:
            register(server)


class Traced(logging.Handler):
    """Sends log records to an editor that traces, which may not show the server's standard error."""

    def __init__(self, server: Server) -> None:
        super().__init__(logging.WARNING)  # at lower levels pygls logs what it sends, including this
        self._server = server
        self._is_sending = False

    def emit(self, record: logging.LogRecord) -> None:
        if not self._is_sending:  # errors while sending are logged, too
            self._is_sending = True
            self._server.trace(record.getMessage(), self.format(record))
            self._is_sending = False


class Server(LanguageServer):
    """The server: a session, a converter, and what was published to the editor."""

    protocol: Protocol

    def __init__(self) -> None:
        super().__init__("btq", __version__, protocol_cls=Protocol)
        self.initial_settings: object = None
        self.convert = Converter()
        self.versions: dict[str, int] = {}
        self.published: dict[str, tuple[int | None, int | None]] = {}  # hashes of what was published, and versions
        self.pulls_all = False  # the editor pulls workspace diagnostics
        self.shown: set[str] = set()  # files whose diagnostics a pulling editor may still show
        self.tokens: dict[str, tuple[str, Colours]] = {}
        self.count = 0
        self.tested = TestedScenarios()
        self.outlooks = Outlooks()
        self.schedule = CheckSchedule(self)
        self.explorations: set[asyncio.Task[Any]] = set()  # searches that the next edit ends
        self._ready: set[str] = set()  # the files prepared for first requests
        self.scanned = asyncio.Event()  # the folders have been read; before, the set of files is unknown
        self._is_settled = False  # the first objects are frozen for the garbage collector
        self._failures: set[object] = set()  # the places of logged failures
        self.on_scanned: Callable[[], None] = lambda: None  # called when the folders have been read
        self.on_saved: Callable[[str], None] = lambda path: None  # called when a file has been saved
        self.on_end: Callable[[], None] = lambda: None  # called when the server ends
        self.protocol.log_failure = self.log_failure
        self._watching: asyncio.Task[None] | None = None
        self.has_message: Callable[[], bool] = lambda: False  # whether one waits to be handled

    @functools.cached_property
    def session(self) -> Session:
        """The open files.  Not used before `initialize` is answered: what a session needs takes long to import."""
        from btq_lang.lsp.session import Session

        session = Session()
        session.configure(self.initial_settings)
        return session

    def start_io(self, stdin: BinaryIO | None = None, stdout: BinaryIO | None = None) -> None:
        """As in pygls, except for how messages are read."""
        self._stop_event = Event()
        self.protocol.set_writer(OutgoingMessages(stdout or sys.stdout.buffer, self._end))
        reader = Messages(stdin or sys.stdin.buffer, self._end_soon)
        self.has_message = lambda: reader.has_message
        report = self.report_server_error
        try:
            asyncio.run(run_async(self._stop_event, reader, self.protocol, error_handler=report))
        except (KeyboardInterrupt, SystemExit):
            pass
        finally:
            self.on_end()
            self.shutdown()  # type: ignore[no-untyped-call]  # pygls has no types there

    def report_server_error(self, error: Exception, source: Any) -> None:
        """Answer and log a message that is not JSON, which pygls shows to the user without an answer."""
        if isinstance(error, NOT_JSON):
            self.protocol.refuse(types.ErrorCodes.ParseError, f"a message is not JSON: {error}")
        else:
            super().report_server_error(error, source)

    # ---- exit ----

    @property
    def exit_code(self) -> int:
        """The exit code of the process: an error if the editor exits without `shutdown`."""
        return 0 if self.protocol.is_shut_down else 1

    def end_with(self, process: int) -> None:
        """Exit soon after a process has ended: an editor that crashes may leave its end of the pipes open."""
        self._watching = asyncio.ensure_future(self._end_with(process))

    def _end_soon(self) -> None:
        """Exit a while after the editor has closed the input, if a long step, such as reading folders, goes on."""
        timer = Timer(POLL, self._end)
        timer.daemon = True
        timer.start()

    def _end(self) -> None:
        """Exit without waiting for the thread that reads messages, as `sys.exit` would."""
        os._exit(self.exit_code)

    async def _end_with(self, process: int) -> None:
        while _is_running(process):
            await asyncio.sleep(POLL)
        try:
            logging.getLogger(__name__).error("the editor's process %d has ended", process)
        finally:  # the log may have no reader
            self._end()

    # ---- tracing ----

    def feature(
        self, feature_name: str, options: Any | None = None, otherwise: Any = None
    ) -> Callable[[Handler], Handler]:
        """As in pygls, but without inspecting each handler's parameters and compiling a converter for its options;
        `otherwise`: the answer about a document that is unknown.
        """

        def register(handler: Handler) -> Handler:
            self.protocol.fm.features[feature_name] = self._timed(feature_name, handler, otherwise)
            if options is not None:
                self.protocol.fm.feature_options[feature_name] = options
            return handler

        return register

    def trace(self, message: str, details: str) -> None:
        """Send a trace message if the editor has enabled tracing; the details only if it is verbose."""
        value = self.protocol.trace
        if value is not types.TraceValue.Off:
            verbose = details if value is types.TraceValue.Verbose else None
            self.log_trace(types.LogTraceParams(message, verbose))

    def _timed(self, name: str, handler: Handler, otherwise: Any) -> Handler:
        """A handler that traces how long it took, and answers about unknown documents."""

        @contextmanager
        def timing(arguments: tuple[Any, ...]) -> Iterator[None]:
            begin = perf_counter()
            try:
                yield
            finally:
                if self.protocol.trace is not types.TraceValue.Off:
                    self.trace(f"{name}: {1000 * (perf_counter() - begin):.1f} ms", repr(arguments)[:MAX_DETAILS])

        @functools.wraps(handler)
        def answer(*arguments: Any) -> Any:
            with timing(arguments), suppress(UnknownDocument):
                return handler(*arguments)
            return otherwise

        @functools.wraps(handler)
        async def answer_later(*arguments: Any) -> Any:
            with timing(arguments), suppress(UnknownDocument):
                return await handler(*arguments)
            return otherwise

        return answer_later if asyncio.iscoroutinefunction(handler) else answer  # type: ignore[return-value]  # `wraps`

    def log_failure(self, error: BaseException) -> tuple[str, bool]:
        """Log an unexpected exception, once: while the user types it may be raised at every keystroke.

        Returns:
            Its message, and whether it is a new one.
        """
        message, where = failures.internal_error(error), failures.place(error)
        is_new = where not in self._failures
        self._failures.add(where)
        if is_new:
            logging.getLogger(__name__).error(message, exc_info=error)
        return message, is_new

    # ---- capabilities ----

    def supports(self, capability: str) -> bool:
        """Whether the editor has declared a capability, such as `window.work_done_progress`."""
        return bool(get_capability(self.client_capabilities, capability))

    @property
    def pulls(self) -> bool:
        """Whether the editor pulls diagnostics."""
        return self.supports("text_document.diagnostic")

    def versions_for_edits(self) -> dict[str, int] | None:
        """The versions of open files, if the editor supports them in edits."""
        return self.versions if self.supports("workspace.workspace_edit.document_changes") else None

    def can_refresh(self, what: str) -> bool:
        """Whether the editor supports a refresh request."""
        return self.supports(f"workspace.{what}.refresh_support")

    def knows_command(self, command: str) -> bool:
        """Whether the editor has declared a command of its own under `experimental`."""
        experimental = self.client_capabilities.experimental
        commands = experimental.get("commands") if isinstance(experimental, dict) else None
        return isinstance(commands, list) and command in commands

    # ---- calling features ----

    def end_explorations(self) -> None:
        """End all searches: a text that they depend on may have changed."""
        ending = [*self.explorations]
        self.explorations.clear()
        for exploration in ending:
            exploration.cancel()

    def at(self, document: types.TextDocumentIdentifier, *, reads: bool = False) -> tuple[Workspace, str]:
        """The workspace and the path of a document.

        Args:
            reads: whether the request changes nothing, and its result has places that `convert.range` maps: only such
                requests have answers about XML.

        Raises:
            UnknownDocument: it is in no folder, or C++, or XML that is not the engine's or not to be read.
        """
        path = self.convert.path(document.uri)
        workspace = self.session.workspace_of(path)
        if workspace is None or workspace.files[path].is_cpp:
            raise UnknownDocument
        if workspace.files[path].is_foreign and not (reads and self.session.knows(path)):
            raise UnknownDocument
        return workspace, path

    def ask(
        self, place: Asked, feature: Callable[[Workspace, str, int], T], *, reads: bool = False
    ) -> tuple[Workspace, str, T]:
        """The result of a feature at a position, and the workspace and path of its spans; `reads`: as in `at`.

        Raises:
            UnknownDocument: the document is unknown, or no text is translated from this place of it.
        """
        workspace, path = self.at(place.text_document, reads=reads)
        offset = workspace.files[path].from_disk(self.convert.offset(workspace, path, place.position))
        if offset is None:
            raise UnknownDocument
        return workspace, path, feature(workspace, path, offset)

    # ---- publishing diagnostics ----

    def diagnostics_of(self, path: str) -> Json | None:
        """All diagnostics of a file, a mission or a project file, as JSON; None: the file is not reported on."""
        if path in self.session.projects:
            return self.convert.problems(*self.session.projects[path])
        if path in self.session.parameters:
            named, diagnostics = self.session.parameters[path]
            return self.convert.findings(named, path, diagnostics)
        workspace = self.session.workspace_of(path)
        if workspace is None or not self.session.knows(path):
            return None
        items = self.convert.findings(workspace, path, self.session.findings(path))
        shown = ", ".join(self.tested.diagnostics(workspace, path))
        if not shown:
            return items
        return Json(f"[{shown}]" if items == NO_ITEMS else f"{items[:-1]}, {shown}]")

    def announce_changes(self) -> None:
        """Make an editor that pulls diagnostics ask for them again."""
        self.publish_projects()
        if self.can_refresh("diagnostics"):
            self.workspace_diagnostic_refresh(None)

    def publish_gone(self) -> None:
        """Withdraw the diagnostics of files that are no longer known."""
        for path in [path for path in self.published if not self.session.knows(path)]:
            self.publish(path)

    def getting_ready(self) -> Iterator[None]:
        """Do pending maintenance, and prepare for the first requests about open files, in steps."""
        if self.scanned.is_set() and not self._is_settled:
            gc.freeze()  # the first objects stay alive: scanning them would delay an answer
            self._is_settled = True
        yield
        self._ready.intersection_update(self.session.open)
        for path in [path for path in self.session.open if path not in self._ready]:
            with suppress(UnknownDocument):
                place = self.at(types.TextDocumentIdentifier(self.convert.uri(path)))
                has_tokens = self.supports("text_document.semantic_tokens")
                tokens = features.colours.making(*place, self.convert.encoding) if has_tokens else ()
                yield from chain(self.protocol.getting_ready(), tokens, features.readiness.getting_ready(*place))
            self._ready.add(path)
        if self.session.is_on("codeLens"):
            for path in [*self.session.open]:
                with suppress(UnknownDocument):
                    place = self.at(types.TextDocumentIdentifier(self.convert.uri(path)), reads=True)
                    yield from self.outlooks.renewed(*place, self.has_message, self.refresh_lenses)

    def refresh_lenses(self) -> None:
        """Make the editor ask for code lenses again."""
        if self.can_refresh("code_lens"):
            self.workspace_code_lens_refresh(None)

    def publish(self, path: str) -> None:
        """Publish the diagnostics of a file, unless they are already published."""
        version = self.versions.get(path)
        diagnostics = (
            self.diagnostics_of(path) if path in self.session.open or self.session.is_on("checkClosedFiles") else None
        )
        if diagnostics is None:
            self.withdraw(path)
            self.session.forget(path)
            return
        before = self.published.get(path)
        current = self.published[path] = hash(diagnostics) if diagnostics != NO_ITEMS else None, version
        if current != before and (diagnostics != NO_ITEMS or before is not None or path in self.session.open):
            name = json.dumps({"uri": self.convert.uri(path), **({"version": version} if version is not None else {})})
            params = Json(f'{name[:-1]}, "diagnostics": {diagnostics}}}')
            self.protocol.notify_plain(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS, params)

    def publish_projects(self) -> None:
        """Publish the diagnostics of files that an editor does not send to one that pulls those of open files only."""
        for path in {*self.session.unsent(), *self.published}:
            if self.pulls_all or path in self.session.open:
                self.withdraw(path)
            else:
                self.publish(path)

    def withdraw(self, path: str) -> None:
        """Publish an empty list for a file, if something was published for its URI."""
        if self.published.pop(path, (None, None))[0] is not None:
            gone = {"uri": self.convert.uri(path), "diagnostics": []}
            self.protocol.notify_plain(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS, gone)

    def report(self, path: str, previous: str | None) -> Json:
        """The diagnostic report of a file for an editor that pulls: full or unchanged."""
        items = self.diagnostics_of(path)
        if items is None:
            return EMPTY_REPORT
        if items != NO_ITEMS:
            self.shown.add(path)
        result = f"{path in self.session.open}:{hash(items):x}"
        if previous == result:
            return Json(f'{{"kind": "unchanged", "resultId": "{result}"}}')
        return Json(f'{{"kind": "full", "resultId": "{result}", "items": {items}}}')

    def reload(self) -> None:
        """Read folders and projects again, and publish changes."""
        self.schedule.check_soon(self.session.reload())
        self.refresh()

    def refresh(self) -> None:
        """Make the editor ask again for what it shows in texts."""
        for what, refresh in (
            ("semantic_tokens", self.workspace_semantic_tokens_refresh),
            ("inlay_hint", self.workspace_inlay_hint_refresh),
            ("code_lens", self.workspace_code_lens_refresh),
        ):
            if self.can_refresh(what):
                refresh(None)


def _is_running(process: int) -> bool:
    """Whether a process with this id runs."""
    if sys.platform == "win32":  # `os.kill` would end the process there, whatever the signal
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
    except (PermissionError, OverflowError):  # another user's; or not a valid id: unknown
        pass
    return True


_SYNCHRONIZE, _ACCESS_DENIED = 0x00100000, 5  # of the Windows API
