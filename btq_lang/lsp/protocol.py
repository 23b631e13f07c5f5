"""Deviations from pygls: faster on hot paths, and without a leak.

One invariant: for an editor only the speed differs.  It is independent of btq.
"""

from __future__ import annotations

import asyncio
import json
import logging
import re
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from functools import partial
from typing import Any, BinaryIO

from cattrs import ClassValidationError, transform_error
from lsprotocol import types
from pygls.exceptions import (
    JsonRpcException,
    JsonRpcInvalidRequest,
    JsonRpcRequestCancelled,
    JsonRpcServerNotInitialized,
)
from pygls.io_ import StdoutWriter
from pygls.protocol import LanguageServerProtocol, lsp_method

Plain = dict[str, Any]  # what json writes directly


class Json(str):
    """A result, or parameters of a notification, already serialised."""

    __slots__ = ()


class Protocol(LanguageServerProtocol):
    """The protocol.

    Only the session keeps documents: pygls would split a text into lines at every keystroke, and at other characters
    than editors (form feeds, U+2028).  Results are plain data, serialised by `json` directly.

    Attributes:
        log_failure: logs an unexpected exception of a handler; returns its message, and whether it is new.
    """

    log_failure: Callable[[BaseException], tuple[str, bool]]

    def _run_generator(self, future: Future[Any] | None, *, gen: Any, result_future: Future[Any]) -> None:
        """As in pygls, but without logging handlers that are cancelled because the server ends; a command's handler is
        cancelled with its request.
        """
        if future is not None and future.cancelled():
            result_future.cancel()
        before = {*self._request_futures}
        super()._run_generator(future, gen=gen, result_future=result_future)
        for key in self._request_futures.keys() - before:  # pygls 2.1 keeps each under a key that no message has
            handling = self._request_futures.pop(key)
            result_future.add_done_callback(partial(_cancel_with, handling))

    def _check_handler_result(self, future: Future[Any]) -> None:
        kept = {} if future.cancelled() else self._request_futures  # pygls iterates over them when it cancels all
        for key in [key for key, other in kept.items() if other is future]:  # pygls 2.1 keeps each notification
            del kept[key]
        failed = _failure(future)
        if failed is None:
            super()._check_handler_result(future)
            return
        message_text, is_new = self.log_failure(failed)
        if is_new:
            self._server.window_show_message(types.ShowMessageParams(types.MessageType.Error, message_text))

    def _send_handler_result(self, future: Future[Any], *, msg_id: int | str) -> None:
        if future.cancelled():  # pygls would forget it while it cancels all, one after the other
            cancelled = JsonRpcRequestCancelled(f'Request with id "{msg_id}" is canceled')
            self._send_response(msg_id, error=cancelled.to_response_error())
            return
        failed = _failure(future)
        if failed is None:
            super()._send_handler_result(future, msg_id=msg_id)
            return
        self._request_futures.pop(msg_id, None)
        message_text, _ = self.log_failure(failed)
        self._send_response(msg_id, error=types.ResponseError(types.ErrorCodes.InternalError, message_text))

    def _send_response(self, msg_id: int | str, result: Any = None, error: types.ResponseError | None = None) -> None:
        if error is not None:
            super()._send_response(msg_id, error=error)
        elif isinstance(result, Json):
            self._write(f'{{"jsonrpc": "2.0", "id": {json.dumps(msg_id)}, "result": {result}}}')
        else:  # `_serialize_message` converts objects of lsprotocol in it
            self._send_data({"jsonrpc": self.VERSION, "id": msg_id, "result": result})

    @property
    def is_shut_down(self) -> bool:
        """Whether the editor has sent `shutdown`: only then may it send `exit`."""
        return self._shutdown

    def handle_message(self, message: Any) -> None:
        """As in pygls, but answers requests after `shutdown` with an error, and refuses a second `initialize`."""
        if not hasattr(message, "jsonrpc"):
            self.refuse(types.ErrorCodes.InvalidRequest, "a message is not JSON-RPC: it has no `jsonrpc`")
            return
        refusal = self._refusal(getattr(message, "method", ""))
        if refusal is None or not (hasattr(message, "id") and hasattr(message, "method")):
            super().handle_message(message)
        else:
            self._send_response(message.id, error=refusal.to_response_error())

    def refuse(self, code: types.ErrorCodes, why: str) -> None:
        """Answer a message that cannot be parsed, not even to tell whether it is a request."""
        logging.getLogger(__name__).error(why)
        self._send_data({"jsonrpc": self.VERSION, "id": None, "error": {"code": code.value, "message": why}})

    def _refusal(self, method: str) -> JsonRpcException | None:
        """Why a request is not allowed in this state of the server; None if it is."""
        if self._shutdown:
            return JsonRpcInvalidRequest("the server is shut down: it accepts only `exit`")
        if (self._workspace is not None) is not (method == types.INITIALIZE):
            return None
        if method == types.INITIALIZE:
            return JsonRpcInvalidRequest("the server is already initialized: `initialize` can be sent only once")
        return JsonRpcServerNotInitialized("the server is not initialized: send `initialize` first")

    def structure_message(self, data: dict[str, Any]) -> Any:
        """As in pygls, but answers requests that cannot be read, for which the editor would wait forever."""
        try:
            return super().structure_message(data)
        except JsonRpcException as error:
            if "id" in data and "method" in data:
                problem = error.__cause__
                why = "; ".join(transform_error(problem)) if isinstance(problem, ClassValidationError) else str(problem)
                refusal = self._refusal(data["method"])
                unread = types.ResponseError(error.code, f"{data['method']} cannot be read: {why}")
                self._send_response(data["id"], error=refusal.to_response_error() if refusal else unread)
            raise

    def getting_ready(self) -> Iterator[None]:
        """Parse a request of each usual kind: pygls compiles a parser for the first of each."""
        place = {"textDocument": {"uri": ""}, "position": {"line": 0, "character": 0}}
        for method in _USUAL:
            self.structure_message({"jsonrpc": self.VERSION, "id": 0, "method": method, "params": place})
            yield

    def notify_plain(self, method: str, params: Plain | Json) -> None:
        """Send a notification with plain data or JSON as parameters."""
        if isinstance(params, Json):
            self._write(f'{{"jsonrpc": "2.0", "method": "{method}", "params": {params}}}')
        else:
            self._send_data({"jsonrpc": self.VERSION, "method": method, "params": params})

    def _write(self, message: str) -> None:
        if self.writer is not None:
            body = message.encode()
            self.writer.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))

    @lsp_method(types.TEXT_DOCUMENT_DID_OPEN)
    def lsp_text_document__did_open(self, params: types.DidOpenTextDocumentParams) -> None:
        self.fm.features[types.TEXT_DOCUMENT_DID_OPEN](params)

    @lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)
    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> None:
        self.fm.features[types.TEXT_DOCUMENT_DID_CHANGE](params)

    @lsp_method(types.TEXT_DOCUMENT_DID_CLOSE)
    def lsp_text_document__did_close(self, params: types.DidCloseTextDocumentParams) -> None:
        self.fm.features[types.TEXT_DOCUMENT_DID_CLOSE](params)


class Messages:
    """Incoming messages, each read by one call in a thread: pygls uses a call for each header line.

    A reader for `pygls.io_.run_async`.

    Args:
        at_end: called in that thread at the end of input, whatever the server is doing.

    Attributes:
        has_message: whether a message has arrived that is not yet handled.
    """

    def __init__(self, stream: BinaryIO, at_end: Callable[[], None] = lambda: None) -> None:
        self._stream = stream
        self._at_end = at_end
        self._head: list[bytes] = []
        self._body = b""
        self.has_message = False

    async def readline(self) -> bytes:
        if not self._head:
            await asyncio.get_running_loop().run_in_executor(None, self._read)
        return self._head.pop(0) if self._head else b""

    async def readexactly(self, _: int) -> bytes:
        self.has_message = False
        return self._body

    def _read(self) -> None:
        """One message; empty at the end of input."""
        length = 0
        while (line := self._stream.readline()).strip() or (line and not length):
            match = _LENGTH.match(line)
            length = int(match[1]) if match else length
        if length:
            self._body = self._stream.read(length)
        if length and len(self._body) == length:  # an editor that crashes may end within a message
            self._head = [b"Content-Length: %d\r\n" % length, b"\r\n"]
            self.has_message = True
        else:
            self._at_end()


class OutgoingMessages(StdoutWriter):
    """Outgoing messages.

    Args:
        at_end: called when they are not read any more.
    """

    def __init__(self, stream: BinaryIO, at_end: Callable[[], None]) -> None:
        super().__init__(stream)
        self._at_end = at_end

    def write(self, data: bytes) -> None:
        try:
            super().write(data)
        except OSError:
            self._at_end()


def _cancel_with(handling: Future[Any], asked: Future[Any]) -> None:
    """Cancel the handler of a request that has ended by being cancelled."""
    if asked.cancelled():
        handling.cancel()


def _failure(future: Future[Any]) -> BaseException | None:
    """The unexpected exception of a handler."""
    error = None if future.cancelled() else future.exception()
    return None if isinstance(error, JsonRpcException) else error


_USUAL = (
    types.TEXT_DOCUMENT_COMPLETION,
    types.TEXT_DOCUMENT_HOVER,
    types.TEXT_DOCUMENT_DEFINITION,
    types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT,
)
_LENGTH = re.compile(rb"Content-Length: *(\d+)", re.IGNORECASE)
