"""How the server begins and ends, as an editor sees its process: initialize, shutdown, exit, an editor that is gone."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from forked_server import Forked, serve
from lsp_editor import SERVER, Editor, Message
from running_process import running

from btq_lang.lsp import editor as btq_editor

NOT_INITIALIZED, INVALID_REQUEST, PARSE_ERROR = -32002, -32600, -32700
# A server that looks all the time whether its editor's process still runs.
POLLING = "import btq_lang.lsp.editor as editor; editor.POLL = 0; from btq_lang.server import main; main([])"


@pytest.fixture
def editor(tmp_path: Path) -> Iterator[Editor]:
    editor = Editor(tmp_path)
    editor.open("main.btq", "BehaviorTree Main\n    Pick\n")
    with editor.process:
        yield editor
        editor.process.kill()


def refusal(answer: Message) -> tuple[int, str]:
    return answer["error"]["code"], answer["error"]["message"]


def test_after_shutdown_every_request_is_refused(editor: Editor) -> None:
    assert editor.request("shutdown") is None
    expected = INVALID_REQUEST, "the server is shut down: it accepts only `exit`"
    assert refusal(editor.ask("textDocument/hover", **editor.at("main.btq", 1, 5))) == expected
    assert refusal(editor.ask("textDocument/hover")) == expected  # as above, whatever is wrong with it besides
    assert refusal(editor.ask("textDocument/somethingNew", **editor.document("main.btq"))) == expected
    assert refusal(editor.ask("initialize", capabilities={}, processId=None, rootUri=None)) == expected
    assert refusal(editor.ask("shutdown")) == expected
    editor.change("main.btq", "")  # a notification has no answer
    editor.notify("exit")
    assert editor.process.wait(timeout=20) == 0


def test_exit_without_shutdown_is_a_failure(editor: Editor) -> None:
    editor.notify("exit")
    assert editor.process.wait(timeout=20) == 1


def test_it_is_initialized_once(editor: Editor) -> None:
    again = editor.ask("initialize", capabilities={}, processId=None, rootUri=None)
    assert refusal(again) == (
        INVALID_REQUEST,
        "the server is already initialized: `initialize` can be sent only once",
    )
    assert editor.request("textDocument/documentSymbol", **editor.document("main.btq"))[0]["name"] == "Main"
    assert editor.close() == ""


def test_before_initialize_every_request_is_refused(tmp_path: Path) -> None:
    class Hasty(Editor):
        def request(self, method: str, **params: object) -> object:
            if method == "initialize":
                early = self.ask("textDocument/hover", **self.at("main.btq", 0, 0))
                assert refusal(early) == (NOT_INITIALIZED, "the server is not initialized: send `initialize` first")
            return super().request(method, **params)

    assert Hasty(tmp_path).close() == ""


@pytest.mark.parametrize("is_told", [False, True])
def test_it_ends_quietly_while_it_begins(is_told: bool, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text("BehaviorTree Main\n    Pick\n", encoding="utf-8")
    editor = Editor(tmp_path)
    if is_told:
        editor.notify("exit")
    _, log = editor.process.communicate(timeout=20)
    assert (log.decode(), editor.process.returncode) == ("", 1)


@pytest.mark.parametrize(
    ("body", "code", "message"),
    [
        (
            b"{bad}",
            PARSE_ERROR,
            "a message is not JSON: Expecting property name enclosed in double quotes: line 1 column 2 (char 1)",
        ),
        (
            b'"\xff"',
            PARSE_ERROR,
            "a message is not JSON: 'utf-8' codec can't decode byte 0xff in position 1: invalid start byte",
        ),
        (b"[1]", INVALID_REQUEST, "a message is not JSON-RPC: it has no `jsonrpc`"),
        (b'{"id": 1}', INVALID_REQUEST, "a message is not JSON-RPC: it has no `jsonrpc`"),
    ],
)
def test_what_is_no_message_is_refused_in_one_line(body: bytes, code: int, message: str, editor: Editor) -> None:
    assert editor.process.stdin is not None
    editor.process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
    editor.process.stdin.flush()
    answer = editor.wait_for(lambda each: "id" in each)
    assert (answer["id"], *refusal(answer)) == (None, code, message)
    assert editor.request("textDocument/documentSymbol", **editor.document("main.btq"))[0]["name"] == "Main"
    assert editor.close().splitlines() == [f"ERROR:btq_lang.lsp.protocol:{message}"]
    assert not any(each.get("method") == "window/showMessage" for each in editor.kept)


@pytest.mark.parametrize("is_shut_down", [False, True])
def test_it_ends_with_its_standard_input(is_shut_down: bool, editor: Editor) -> None:
    if is_shut_down:
        editor.request("shutdown")
    assert editor.process.stdin is not None
    editor.process.stdin.close()
    assert editor.process.wait(timeout=20) == (0 if is_shut_down else 1)


@pytest.mark.parametrize("is_shut_down", [False, True])
def test_it_ends_in_silence_when_nobody_reads_its_answers(is_shut_down: bool, editor: Editor) -> None:
    """While its standard input stays open."""
    server = editor.process
    assert server.stdin is not None
    assert server.stdout is not None
    assert server.stderr is not None
    if is_shut_down:
        editor.request("shutdown")
    server.stdout.close()
    with suppress(BrokenPipeError):  # it may have ended already, at a notification
        editor.send(id=100, method="textDocument/hover", params=editor.at("main.btq", 1, 5))
    assert (server.wait(timeout=20), server.stderr.read()) == (0 if is_shut_down else 1, b"")


def test_it_ends_in_silence_when_nobody_reads_its_findings(editor: Editor) -> None:
    server = editor.process
    assert server.stdout is not None
    assert server.stderr is not None
    server.stdout.close()
    editor.open("other.btq", "BehaviorTree Other\n    Pick (\n")
    assert (server.wait(timeout=20), server.stderr.read()) == (1, b"")


def test_it_ends_in_silence_where_its_input_ends_within_a_message(editor: Editor) -> None:
    server = editor.process
    assert server.stdin is not None
    assert server.stderr is not None
    server.stdin.write(b'Content-Length: 500\r\n\r\n{"jsonrpc"')
    server.stdin.close()
    assert (server.wait(timeout=20), server.stderr.read()) == (1, b"")


def test_it_ends_with_its_standard_input_while_it_reads_folders(tmp_path: Path) -> None:
    """As with a folder so large that it takes minutes, without handling messages."""
    program = (
        "import os, sys\n"
        "from btq_lang.projects.files import Files\n"
        "from btq_lang.lsp import editor\n"
        "from btq_lang.server import main\n"
        "def groups(*_, **__):\n"
        "    os.write(2, b'reading')\n"
        "    while True: pass\n"
        "Files.groups = groups\n"
        "editor.POLL = 0.1\n"
        "sys.exit(main([]))"
    )
    editor = Editor(tmp_path, program=program)
    with editor.process as server:
        assert server.stderr is not None
        assert server.stderr.read(7) == b"reading"
        assert server.stdin is not None
        server.stdin.close()
        try:
            assert server.wait(timeout=60) == 1
        finally:
            server.kill()


def test_it_ends_after_the_process_of_its_editor(tmp_path: Path) -> None:
    """While its standard input stays open, as where another process has inherited it."""
    with running((sys.executable, "-c", "input()"), stdin=subprocess.PIPE) as crashing:
        editor = Editor(tmp_path, program=POLLING, processId=crashing.pid)
        editor.open("main.btq", "BehaviorTree Main\n    Pick\n")
        assert editor.diagnostics("main.btq") == []
        crashing.kill()
        crashing.wait()
        with editor.process as server:
            assert server.wait(timeout=60) == 1
            assert server.stderr is not None
            assert (
                server.stderr.read() == b"ERROR:btq_lang.lsp.editor:the editor's process %d has ended\n" % crashing.pid
            )


def test_it_lives_as_long_as_the_process_of_its_editor(tmp_path: Path) -> None:
    editor = Editor(tmp_path, program=POLLING, processId=os.getpid())
    for number in range(20):
        editor.open(f"main{number}.btq", "")
        assert editor.diagnostics(f"main{number}.btq") == []
    assert editor.close() == ""
    assert 0 < btq_editor.POLL <= 10


@pytest.mark.parametrize("port", ["99999", "-1", "port", "example.invalid:5007", ""])
def test_what_is_no_port_is_a_usage_error(port: str) -> None:
    with Forked(serve(f"--tcp={port}")) as server:
        said = server.communicate(timeout=60)
    assert (server.returncode, *said) == (2, b"", f"btq-lsp: {no_port(port)}".encode())


@pytest.mark.parametrize("command", [SERVER[:-1], (sys.executable, "-m", "btq_lang", "lsp")])
def test_so_it_is_with_either_command(command: tuple[str, ...]) -> None:
    done = subprocess.run((*command, "--tcp=-1"), capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"btq-lsp: {no_port('-1')}")


def no_port(port: str) -> str:
    return f"cannot serve on `--tcp {port}`: expected a port of this machine, 0 to 65535\n"


def test_a_port_that_is_taken_is_a_usage_error() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        command = (*SERVER[:-1], "--tcp", str(port))
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    line = f"btq-lsp: cannot serve on `--tcp {port}`: "
    assert (done.returncode, done.stderr[: len(line)], done.stderr.count("\n")) == (2, line, 1)


@pytest.mark.parametrize("is_shut_down", [False, True])
def test_over_a_port_it_ends_the_same(is_shut_down: bool, tmp_path: Path) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = (*SERVER[:-1], "--tcp", str(port), "--log", "info")
    with running(command, stderr=subprocess.PIPE) as process:
        assert process.stderr is not None
        next(line for line in process.stderr if "Serving on" in line)
        bridge = "import socket, sys, threading\n" + BRIDGE.replace("PORT", str(port))
        editor = Editor(tmp_path, command=(sys.executable, "-c", bridge))
        if is_shut_down:
            editor.request("shutdown")
        editor.notify("exit")
        assert process.wait(timeout=20) == (0 if is_shut_down else 1)
        process.stderr.read()
        editor.process.communicate(timeout=20)


def test_an_editor_that_reads_nothing_any_more_ends_it_silently(tmp_path: Path) -> None:
    editor = Editor(tmp_path, command=SERVER)
    process = editor.process
    assert isinstance(process, subprocess.Popen)
    assert process.stdin is not None
    assert process.stdout is not None
    assert process.stderr is not None
    with process:
        process.stdout.close()
        editor.open("main.btq", "BehaviorTree Main\n    Rety\n")
        process.stdin.close()
        assert (process.wait(timeout=20), process.stderr.read()) == (1, b"")


# Standard input and output of an editor, to and from a port.
BRIDGE = """
port = socket.create_connection(("127.0.0.1", PORT))
def send():
    while data := sys.stdin.buffer.read1():
        port.sendall(data)
threading.Thread(target=send, daemon=True).start()
while data := port.recv(65536):
    sys.stdout.buffer.write(data)
    sys.stdout.buffer.flush()
"""
