"""What the protocol does otherwise than pygls: faster on the hot paths, and without a leak.

One invariant: an editor cannot tell the difference, but by the time.  Nothing is known here of btq.
"""

from __future__ import annotations

import asyncio
import json
import logging
import re
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from typing import Any, BinaryIO

from cattrs import ClassValidationError, transform_error
from lsprotocol import types
from pygls.exceptions import JsonRpcException, JsonRpcInvalidRequest, JsonRpcServerNotInitialized
from pygls.protocol import LanguageServerProtocol, lsp_method

Plain = dict[str, Any]  # what json writes as it is


class Json(str):
    """A result, or what is told, that is JSON already."""

    __slots__ = ()


class Protocol(LanguageServerProtocol):
    """The protocol.

    Documents are kept by the session, and not by pygls too, which at every key cuts a text into lines, and not where
    editors do (form feeds, U+2028).  Answers are written as what they are made of: plain data by `json`, at once.

    Attributes:
        log_failure: logs an exception that no handler should raise; returns what to say of it, and whether it is new.
    """

    log_failure: Callable[[BaseException], tuple[str, bool]]

    def _run_generator(self, future: Future[Any] | None, *, gen: Any, result_future: Future[Any]) -> None:
        """As in pygls, which logs a handler that is cancelled because the server ends."""
        if future is not None and future.cancelled():
            result_future.cancel()
        super()._run_generator(future, gen=gen, result_future=result_future)

    def _check_handler_result(self, future: Future[Any]) -> None:
        kept = {} if future.cancelled() else self._request_futures  # pygls goes through them when it cancels all
        for key in [key for key, other in kept.items() if other is future]:  # pygls 2.1 keeps each notification
            del kept[key]
        failed = _failure(future)
        if failed is None:
            super()._check_handler_result(future)
            return
        said, is_new = self.log_failure(failed)
        if is_new:
            self._server.window_show_message(types.ShowMessageParams(types.MessageType.Error, said))

    def _send_handler_result(self, future: Future[Any], *, msg_id: int | str) -> None:
        failed = _failure(future)
        if failed is None:
            super()._send_handler_result(future, msg_id=msg_id)
            return
        self._request_futures.pop(msg_id, None)
        said, _ = self.log_failure(failed)
        self._send_response(msg_id, error=types.ResponseError(types.ErrorCodes.InternalError, said))

    def _send_response(self, msg_id: int | str, result: Any = None, error: types.ResponseError | None = None) -> None:
        if error is not None:
            super()._send_response(msg_id, error=error)
        elif isinstance(result, Json):
            self._write(f'{{"jsonrpc": "2.0", "id": {json.dumps(msg_id)}, "result": {result}}}')
        else:  # what is of lsprotocol in it is made plain by `_serialize_message`
            self._send_data({"jsonrpc": self.VERSION, "id": msg_id, "result": result})

    @property
    def is_shut_down(self) -> bool:
        """Whether the editor has sent `shutdown`: only then may it send `exit`."""
        return self._shutdown

    def handle_message(self, message: Any) -> None:
        """As in pygls, which leaves requests after `shutdown` without an answer and takes a second `initialize`."""
        if not hasattr(message, "jsonrpc"):
            self.refuse(types.ErrorCodes.InvalidRequest, "a message is not JSON-RPC: it has no `jsonrpc`")
            return
        refusal = self._refusal(getattr(message, "method", ""))
        if refusal is None or not (hasattr(message, "id") and hasattr(message, "method")):
            super().handle_message(message)
        else:
            self._send_response(message.id, error=refusal.to_response_error())

    def refuse(self, code: types.ErrorCodes, why: str) -> None:
        """Answer a message that cannot be read, not even whether it is a request."""
        logging.getLogger(__name__).error(why)
        self._send_data({"jsonrpc": self.VERSION, "id": None, "error": {"code": code.value, "message": why}})

    def _refusal(self, method: str) -> JsonRpcException | None:
        """Why a request cannot be answered at this point of the server's life."""
        if self._shutdown:
            return JsonRpcInvalidRequest("the server is shut down: it accepts only `exit`")
        if (self._workspace is not None) is not (method == types.INITIALIZE):
            return None
        if method == types.INITIALIZE:
            return JsonRpcInvalidRequest("the server is already initialized: `initialize` can be sent only once")
        return JsonRpcServerNotInitialized("the server is not initialized: send `initialize` first")

    def structure_message(self, data: dict[str, Any]) -> Any:
        """As in pygls, which does not answer a request that it cannot read: who asked would wait for ever."""
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
        """Read a question of each usual kind: pygls has a reader compiled for the first one."""
        place = {"textDocument": {"uri": ""}, "position": {"line": 0, "character": 0}}
        for method in _USUAL:
            self.structure_message({"jsonrpc": self.VERSION, "id": 0, "method": method, "params": place})
            yield

    def tell(self, method: str, params: Plain | Json) -> None:
        """Send a notification of plain data, or of what is JSON already."""
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
    """What comes in, read a message at a time by a thread: pygls has a thread read each line of each head.

    One for `pygls.io_.run_async`.
    """

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream
        self._head: list[bytes] = []
        self._body = b""
        self._is_taken = True

    async def readline(self) -> bytes:
        if not self._head:
            await asyncio.get_running_loop().run_in_executor(None, self._read)
        return self._head.pop(0) if self._head else b""

    async def readexactly(self, _: int) -> bytes:
        self._is_taken = True
        return self._body

    @property
    def bring_edit(self) -> bool:
        """Whether an edit has come in that is not yet handled."""
        return not self._is_taken and _CHANGE in self._body

    def _read(self) -> None:
        """One message; nothing at the end of all."""
        length = 0
        while (line := self._stream.readline()).strip() or (line and not length):
            found = _LENGTH.match(line)
            length = int(found[1]) if found else length
        if length:
            self._head = [b"Content-Length: %d\r\n" % length, b"\r\n"]
            self._body = self._stream.read(length)
            self._is_taken = False


def _failure(future: Future[Any]) -> BaseException | None:
    """The exception that a handler should not have raised."""
    error = None if future.cancelled() else future.exception()
    return None if isinstance(error, JsonRpcException) else error


_USUAL = (
    types.TEXT_DOCUMENT_COMPLETION,
    types.TEXT_DOCUMENT_HOVER,
    types.TEXT_DOCUMENT_DEFINITION,
    types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT,
)
_CHANGE = f'"{types.TEXT_DOCUMENT_DID_CHANGE}"'.encode()
_LENGTH = re.compile(rb"Content-Length: *(\d+)", re.IGNORECASE)
