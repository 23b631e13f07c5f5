"""`btq preview` as a process: the page, the pictures, the word that something changed, and whom it does not answer."""

from __future__ import annotations

import http.client
import json
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
from evidence_logs import MAIN, MAIN_XML, btlog, rows

from btq_lang.cli import main

MISSION = "BehaviorTree Main\n    -> Way\n        Dock satisfices safety\n        Charge\n"
FOLDED = "Main/-> Way"


class Previewed:
    """A running `btq preview`, asked over HTTP."""

    def __init__(self, process: subprocess.Popen[str], port: int) -> None:
        self.process, self.port = process, port

    def ask(self, method: str, path: str, body: object = None, headers: Mapping[str, str] | None = None) -> Any:
        """The status, and the answer: JSON as what it says."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        sent = None if body is None else body if isinstance(body, str) else json.dumps(body)
        connection.request(method, path, sent, dict(headers or {}))
        response = connection.getresponse()
        text = response.read().decode()
        connection.close()
        is_json = response.getheader("Content-Type") == "application/json"
        return response.status, json.loads(text) if is_json else text

    def line(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.readline()


@pytest.fixture
def preview(tmp_path: Path) -> Iterator[Callable[..., Previewed]]:
    running = []

    def start(name: str, *options: str) -> Previewed:
        command = [sys.executable, "-m", "btq_lang", "preview", name, *options]
        pipe = subprocess.PIPE
        process = subprocess.Popen(command, cwd=tmp_path, stdin=pipe, stdout=pipe, stderr=pipe, text=True)
        running.append(process)
        assert process.stdout is not None
        said = process.stdout.readline()
        found = re.fullmatch(rf"{name} is shown at http://127\.0\.0\.1:(\d+)/\n", said)
        assert found is not None, said or process.communicate()[1]
        return Previewed(process, int(found[1]))

    yield start
    for process in running:
        process.terminate()
        process.communicate(timeout=30)


def test_the_page_and_its_picture(preview: Callable[..., Previewed], tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(MISSION)
    previewed = preview("main.btq")
    status, page = previewed.ask("GET", "/")
    assert status == 200
    (nonce,) = set(re.findall(r"'nonce-(\w+)'", page))
    assert f'<script nonce="{nonce}">' in page
    assert nonce not in previewed.ask("GET", "/")[1]
    status, picture = previewed.ask("POST", "/picture", {"folded": []})
    assert (status, picture["title"], len(re.findall('class="box', picture["svg"]))) == (200, "main.btq", 3)
    folded = previewed.ask("POST", "/picture", {"folded": [FOLDED]})[1]["svg"]
    assert len(re.findall('class="box', folded)) == 1
    assert 'data-hidden="2"' in folded


def lines(events: http.client.HTTPResponse, number: int) -> list[bytes]:
    """The next lines of events, without those that only keep the connection, which come whenever nothing happens."""
    taken: list[bytes] = []
    while len(taken) < number:
        line = events.readline()
        if line == b": still here\n":
            events.readline()  # the blank line that ends it
        else:
            taken.append(line)
    return taken


def test_pages_are_told_of_changes_in_every_file_that_matters(
    preview: Callable[..., Previewed], tmp_path: Path
) -> None:
    (tmp_path / "demands.btq").write_text('QualityReq soon "In time"\n    takes at most 30 s\n')
    (tmp_path / "main.btq").write_text('include "demands.btq"\nBehaviorTree Main\n    Dock satisfies soon\n')
    previewed = preview("main.btq")
    connection = http.client.HTTPConnection("127.0.0.1", previewed.port, timeout=60)
    connection.request("GET", "/events")
    events = connection.getresponse()
    assert lines(events, 2) == [b"data: changed\n", b"\n"]  # for a page that was asleep
    assert "takes at most 30 s" in previewed.ask("POST", "/picture", {"folded": []})[1]["svg"]
    (tmp_path / "demands.btq").write_text('QualityReq soon "In time"\n    takes at most 20 s\n')
    assert lines(events, 2) == [b"data: changed\n", b"\n"]
    assert "takes at most 20 s" in previewed.ask("POST", "/picture", {"folded": []})[1]["svg"]
    (tmp_path / "main.btq").unlink()
    assert lines(events, 1) == [b"data: changed\n"]
    answer = previewed.ask("POST", "/picture", {"folded": []})
    assert answer == (200, {"title": "main.btq", "trouble": "main.btq: cannot be read: No such file or directory"})
    connection.close()


def test_an_editor_tells_the_text_and_the_cursor(preview: Callable[..., Previewed], tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(MISSION)
    previewed = preview("main.btq", "--follow")
    editor = previewed.process.stdin
    assert editor is not None

    def tells(said: str) -> None:
        editor.write(said + "\n")
        editor.flush()

    connection = http.client.HTTPConnection("127.0.0.1", previewed.port, timeout=60)
    connection.request("GET", "/events")
    events = connection.getresponse()
    assert lines(events, 2) == [b"data: changed\n", b"\n"]
    assert previewed.ask("POST", "/picture", {"folded": [FOLDED]})[1]["lines"] == {"n0": 2}
    tells(json.dumps({"line": 4}))
    assert lines(events, 3) == [b"event: here\n", b"data: 4\n", b"\n"]
    tells("[]")
    tells("{")
    tells(json.dumps({"text": MISSION.replace("Charge", "Rest")}))
    assert lines(events, 2) == [b"data: changed\n", b"\n"]
    picture = previewed.ask("POST", "/picture", {"folded": []})[1]
    assert ("Rest" in picture["svg"], picture["lines"]) == (True, {"n0": 2, "n1": 3, "n2": 4})
    assert (tmp_path / "main.btq").read_text() == MISSION
    connection.close()
    _, said = previewed.process.communicate(timeout=30)  # its standard input is closed, and it ends
    assert (previewed.process.returncode, said.count("expected a JSON object")) == (0, 2)


def test_a_click_says_where_the_node_stands_and_tells_the_editor(
    preview: Callable[..., Previewed], tmp_path: Path
) -> None:
    (tmp_path / "main.btq").write_text(MISSION)
    program = "import sys; open('clicked', 'w').write(sys.argv[1]); print('clicked')"
    command = f'"{Path(sys.executable).as_posix()}" -c "{program}" {{file}}+{{line}}:{{column}}{{}}'
    previewed = preview("main.btq", "--on-click", command)
    assert previewed.ask("POST", "/go", {"key": "n1"}) == (200, {"said": "main.btq:3:9"})
    assert {previewed.line(), previewed.line()} == {"main.btq:3:9\n", "clicked\n"}
    assert (tmp_path / "clicked").read_text() == f"{(tmp_path / 'main.btq').as_posix()}+3:9{{}}"
    gone = {"trouble": "this node no longer exists"}
    assert previewed.ask("POST", "/go", {"key": "n3"}) == (200, gone)


def test_a_command_that_is_not_there(preview: Callable[..., Previewed], tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(MISSION)
    status, answer = preview("main.btq", "--on-click", "no-such-editor").ask("POST", "/go", {"key": "n0"})
    assert (status, answer["trouble"].partition(":")[0]) == (200, "no-such-editor")


def test_xml_is_shown_and_its_own_lines_are_told(preview: Callable[..., Previewed], tmp_path: Path) -> None:
    lines = ['<root BTCPP_format="4">', '<BehaviorTree ID="Main">', "", "<Dock/>", "</BehaviorTree>", "</root>"]
    (tmp_path / "main.xml").write_text("\n".join(lines))
    assert preview("main.xml").ask("POST", "/go", {"key": "n0"})[1]["said"].startswith("main.xml:4:")


@pytest.mark.parametrize(
    ("method", "path", "body", "headers", "status"),
    [
        ("POST", "/go", {"key": "n0"}, {"Origin": "http://example.org"}, 403),
        ("POST", "/go", {"key": "n0"}, {"Origin": "null"}, 403),
        ("GET", "/", None, {"Host": "example.org"}, 403),
        ("GET", "/", None, {"Host": "127.0.0.1:1"}, 403),
        ("GET", "/../main.btq", None, {}, 404),
        ("GET", "/picture", None, {}, 404),
        ("POST", "/else", {}, {}, 404),
        ("POST", "/picture", "{", {}, 400),
        ("POST", "/picture", [], {}, 400),
        ("POST", "/picture", {"folded": 1}, {}, 400),
        ("POST", "/go", {}, {}, 400),
        ("POST", "/picture", {"folded": []}, {"Content-Length": "9999999999"}, 400),
        ("PUT", "/", None, {}, 501),
    ],
)
def test_whom_and_what_it_does_not_answer(
    method: str,
    path: str,
    body: object,
    headers: Mapping[str, str],
    status: int,
    preview: Callable[..., Previewed],
    tmp_path: Path,
) -> None:
    (tmp_path / "main.btq").write_text(MISSION)
    assert preview("main.btq").ask(method, path, body, headers)[0] == status


def test_its_own_page_may_call_it_localhost(preview: Callable[..., Previewed], tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(MISSION)
    previewed = preview("main.btq")
    own = f"localhost:{previewed.port}"
    headers = {"Host": own, "Origin": f"http://{own}"}
    assert previewed.ask("POST", "/picture", {"folded": []}, headers)[0] == 200


def test_what_cannot_be_shown(
    preview: Callable[..., Previewed], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["preview", str(tmp_path / "none.btq")]) == 2
    assert main(["preview", str(tmp_path)]) == 2
    (tmp_path / "main.btq").write_text(MISSION)
    port = preview("main.btq").port
    assert main(["preview", str(tmp_path / "main.btq"), "--port", str(port)]) == 2
    assert main(["preview", str(tmp_path / "main.btq"), "--port", "99999"]) == 2
    said = capsys.readouterr().err.splitlines()
    assert [line.rpartition(": ")[2] for line in said[:2]] == ["no such file", "expected a file, found a folder"]
    assert [line.split(":")[1] for line in said[2:]] == [f" port {port}", " port 99999"]


def test_what_logs_show_is_drawn_when_they_are_judged(preview: Callable[..., Previewed], tmp_path: Path) -> None:
    demand = "QualityReq quick : performance-efficiency\n    Move takes at most 30 ms\n"
    (tmp_path / "main.btq").write_text(demand + MAIN)
    (tmp_path / "btq.toml").write_text('[evidence]\nlogs = ["*.btlog"]\n')
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 20 2S 3R 60 3S 1S")))
    previewed = preview("main.btq")

    def wait_for(words: str) -> None:
        while words not in previewed.ask("POST", "/picture", {"folded": []})[1]["svg"]:
            time.sleep(0.05)

    wait_for("last run: 20 ms, satisfied")
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 40 2S 3R 60 3S 1S")))
    wait_for("last run: 40 ms, violated")
    (tmp_path / "main.btq").write_text(demand.replace("30", "50") + MAIN)
    wait_for("last run: 40 ms, satisfied")
