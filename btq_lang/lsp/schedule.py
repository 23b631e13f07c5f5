"""When files are checked: messages go first, then the edited file, then the others.

One invariant: only one task checks files, and it handles messages between its steps.  What a check is, and how its
result is published, is unknown here.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Protocol

from btq_lang.workspace.queries import Cancelled

if TYPE_CHECKING:
    from btq_lang.lsp.session import Session

TOGETHER = 0.001  # seconds, within which a request arrives that an editor sends together with an edit
REQUEST_WINDOW = 0.01  # seconds, within which an editor sends requests about published diagnostics
PAUSE = 0.1  # seconds, less than between most keystrokes
LONG_CHECK = 0.2  # seconds; of a longer check, a single step may delay an answer noticeably
MAX_REST = 0.5  # seconds, for which a long check is delayed after a keystroke


class Client(Protocol):
    """What checks files and publishes the results."""

    has_message: Callable[[], bool]

    @property
    def session(self) -> Session:
        """The open files."""

    @property
    def pulls(self) -> bool:
        """Whether the editor pulls diagnostics, so that nothing is checked before it asks."""

    def announce_changes(self) -> None:
        """Make an editor that pulls diagnostics ask for them again."""

    def publish(self, path: str) -> None:
        """Publish the diagnostics of a file."""

    def publish_gone(self) -> None:
        """Withdraw the diagnostics of files that are no longer known."""

    def log_failure(self, error: BaseException) -> object:
        """Log an unexpected exception."""

    def getting_ready(self) -> Iterator[None]:
        """Prepare for requests while the editor is idle, in steps."""


class CheckSchedule:
    """The files that wait for a check, and the task that checks them.

    Attributes:
        waiting: the files, the next one first.
        task: checks them; None: nothing has been scheduled yet.
        last_keystroke: the time of the last keystroke.
        answering: how many requests are being answered in steps.
    """

    def __init__(self, client: Client) -> None:
        self._client = client
        self.waiting: dict[str, None] = {}
        self.task: asyncio.Task[None] | None = None
        self.last_keystroke = -MAX_REST
        self.answering = 0
        self._pause: asyncio.Task[None] | None = None  # waits for a pause, and uses it

    def check_soon(self, paths: Iterable[str]) -> None:
        """Schedule files, in their order, for checking and publishing, before those already waiting."""
        self.waiting = dict.fromkeys((*paths, *self.waiting))
        if self._pause is not None:
            self._pause.cancel()
        if self.task is None or self.task.done():
            self.task = asyncio.ensure_future(self._check_waiting())

    async def check(self, path: str) -> None:
        """Check a file for a request, after handling any message that comes meanwhile."""
        while True:
            await self._wait_after_keystroke(path)
            try:
                self._client.session.check(path, self._client.has_message)
                return
            except Cancelled:
                await asyncio.sleep(0)

    async def _wait_after_keystroke(self, path: str) -> None:
        """Let requests go first: wait after the last keystroke as long as a long check takes."""
        clock = asyncio.get_running_loop().time
        while (check_seconds := self._client.session.check_seconds.get(path, 0)) > LONG_CHECK:
            rest = self.last_keystroke + min(check_seconds, MAX_REST) - clock()
            if rest <= 0:
                break
            await asyncio.sleep(rest)

    async def _check_waiting(self) -> None:
        """Check file by file: messages are handled first, then the edited file is checked, then the others, and those
        that are not open only when no request is being answered.
        """
        client = self._client
        await asyncio.sleep(TOGETHER)
        if client.pulls:
            self.waiting.clear()
            client.announce_changes()
        loop = asyncio.get_running_loop()
        published_at = -REQUEST_WINDOW
        while self.waiting:
            path = next(iter(self.waiting))
            is_open = path in client.session.open
            if not is_open and (self.answering or loop.time() < published_at + REQUEST_WINDOW):
                await asyncio.sleep(REQUEST_WINDOW / 10)
                continue
            await self._wait_after_keystroke(path)
            if path != next(iter(self.waiting)):  # another file was edited meanwhile
                continue
            del self.waiting[path]
            try:
                client.session.check(path, client.has_message)
                client.publish(path)
            except Cancelled:
                self.waiting = {path: None, **self.waiting}
                await asyncio.sleep(0)
                continue
            except Exception as error:  # a file that cannot be checked must not block the others
                client.log_failure(error)
            client.session.let_go()
            published_at = loop.time() if is_open else published_at
            await asyncio.sleep(0)
        client.publish_gone()
        self._pause = asyncio.ensure_future(self._use_pause())

    async def _use_pause(self) -> None:
        """While the editor is idle, prepare for requests, handling messages between steps; an edit ends it."""
        steps = self._client.getting_ready()
        next(steps, None)
        await asyncio.sleep(PAUSE)
        while self.answering:
            await asyncio.sleep(PAUSE)
        for _ in steps:
            await asyncio.sleep(PAUSE if self.answering else 0)
