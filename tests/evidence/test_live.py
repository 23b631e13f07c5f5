"""`btq verify --live`: a robot in a thread is judged while it runs."""

from __future__ import annotations

import fcntl
import json
import os
import re
import select
import signal
import socket
import struct
import subprocess
import sys
import termios
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
import zmq
from evidence_logs import MAIN, MAIN_XML, Verify
from groot2_robot import KEPT, Robot
from running_process import running

from btq_lang.commands.live_screen import HINT, drawn
from btq_lang.evidence.verdicts import ClauseVerdict, RequirementVerdict
from btq_lang.evidence.watching import Watched
from btq_lang.render.colour import painter

GOOD = "0 1R 2R 5 2S 3R 10 3S 1S 2I 3I 1I 12 "
SLOW = "0 1R 2R 200 2S 3R 205 3S 1S 2I 3I 1I "
CLAUSE = ClauseVerdict(
    text="takes at most 1 s",
    path="A",
    of="",
    verdict="satisfied",
    counted=3,
    violated=0,
    unknown=0,
    cut_off=0,
    unit="activations",
    worst=None,
    interval=None,
    limits="every look",
    confidence=None,
    more=None,
    violations=(),
    why="",
    histogram=None,
)
REQUIREMENT = RequirementVerdict("rq", "", "satisfied", (CLAUSE,))
MISSION = f"QualityReq quick : safety\n    Move takes at most 100 ms\n{MAIN}"


class Live(Verify):
    """`btq verify --live`, while a robot does something in another thread."""

    def watch(self, robot: Robot, does: Callable[[], object], *arguments: str, mission: str = MISSION) -> str:
        """What the command prints when the robot has done it and Ctrl+C has been pressed."""
        if mission:
            (self.folder / "main.btq").write_text(mission, encoding="utf-8")
            arguments = ("--mission", "main.btq", *arguments)
        failures: list[BaseException] = []

        def act() -> None:
            try:
                robot.wait_for("r", "t")
                does()
                if not robot.is_gone:
                    robot.wait_for("t", "t")
            except BaseException as failure:
                failures.append(failure)
            finally:
                os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=act)
        thread.start()
        try:
            return self.text("--live", robot.address, *arguments)
        finally:
            thread.join()
            assert failures == []


@pytest.fixture
def live(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Live:
    """The command in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return Live(tmp_path, capsys)


def plain(text: str, robot: Robot) -> list[str]:
    """The lines of a text, without times and ports."""
    text = text.replace(robot.address, "ROBOT")
    text = re.sub(r"took [\d.]+ ms(?=, bound 100 ms; it is still active)", "took MORE", text)
    text = re.sub(r"\d{4}-\d\d-\d\d\s+\d\d:\d\d:\d\d\.\d{3} UTC\)", "DAY", text)
    text = re.sub(r"\d\d:\d\d:\d\d\.\d{3}", "TIME", text)
    text = re.sub(r"\d{4}-\d\d-\d\d \d\d:\d\d(–\d\d:\d\d)? UTC", "DAY", text)
    return text.splitlines()


def test_verdicts_are_printed_as_they_fall_and_then_the_table(live: Live) -> None:
    with Robot(MAIN_XML) as robot:
        printed = live.watch(robot, lambda: robot.play(GOOD, SLOW))
    assert live.code == 1
    assert live.errors == ""
    assert plain(printed, robot)[:7] == [
        "TIME  mission main (as built now, 3 of 3 nodes)",
        "TIME  run 1 succeeded after 10 ms",
        "TIME  satisfied        quick  Move takes at most 100 ms: held so far in 1 activation, worst 5 ms in run 1",
        "TIME  violated         quick  Move takes at most 100 ms: Move::2 took MORE, bound 100 ms; it is still active",
        "TIME  run 2 succeeded after 205 ms",
        "2 runs in ROBOT, DAY, mission main (as built now, 3 of 3 nodes)",
        "",
    ]
    assert "violated         quick  Move takes at most 100 ms  1 of 2 activations, worst" in printed
    assert {*robot.asked} == {"T", "S", "r", "t"}  # no blackboard without signals, and no hooks


def test_a_robot_of_which_no_mission_is_known(live: Live) -> None:
    with Robot(MAIN_XML) as robot:
        printed = live.watch(robot, lambda: robot.play(GOOD, SLOW), mission="")
    lines = plain(printed, robot)
    assert any(line.endswith("mission Main (the tree in the log, 3 of 3 nodes)") for line in lines)
    assert "runs: 2 succeeded" in lines
    assert [line.split()[:3] for line in lines if line.startswith("  Move::2")] == [["Move::2", "2", "2"]]
    assert (live.code, live.errors) == (0, "")


def test_a_mission_is_demanded_before_the_robot_runs(live: Live) -> None:
    live.text("--live", "tcp://127.0.0.1:1", "--strict")
    told = "btq verify: --strict: no mission found; name one with --mission FILE, a .btq file or XML"
    told += ", or make one with btq import LOG\n"
    assert (live.code, live.errors) == (2, told)


def test_the_page_shows_what_is_printed(live: Live) -> None:
    page = Path(__file__).parents[2] / "docs" / "evidence.md"
    *_, shown = re.findall(r"^```text\n(.*?)^```$", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    first, second = "0 1R 2R 80 2S 3R 90 3S 1S 2I 3I 1I", "0 1R 2R 400 2F 1F 2I 1I"
    with Robot(MAIN_XML) as robot:
        printed = live.watch(robot, lambda: robot.play(first, second))
    assert plain(printed, robot)[:5] == plain(shown, robot)


def test_a_run_that_is_open_is_left_out(live: Live) -> None:
    with Robot(MAIN_XML) as robot:
        robot.play("1R 2R")
        printed = live.watch(robot, lambda: robot.play("200 2S 3R 3S 1S 2I 3I 1I", GOOD))
    assert live.code == 0
    assert "  a run is open already; what is active now is left out" in printed
    assert "  note: it was running already, so what was active then is left out" in printed
    assert "  satisfied        quick  Move takes at most 100 ms  held so far in 1 activation, worst" in printed
    assert "runs: 2 succeeded" in printed


def test_what_a_gap_hides_is_unknown(live: Live) -> None:
    def flood() -> None:
        robot.play("1R 2R")
        robot.wait_for("t", "t")
        for _ in range(KEPT):
            robot.change(3, 1)
            robot.change(3, 2)
        robot.wait_for("t", "t")
        robot.play("2S 1S 2I 1I")
        robot.play(GOOD)

    with Robot(MAIN_XML) as robot:
        printed = live.watch(robot, flood, "--strict", mission=MISSION.replace("100 ms", "9 s"))
    assert live.code == 1
    gap = "gap: more transitions than the publisher keeps came between two requests; what happened meanwhile is unknown"
    assert gap in printed
    assert (
        "  unknown          quick  Move takes at most 9 s  transitions were lost meanwhile (1 of 2 activations)"
        in printed
    )
    assert (
        "  note: gaps: more transitions than the publisher keeps came between two requests: 1, the first at 20"
        in printed
    )


def test_a_violation_after_a_gap_is_still_one(live: Live) -> None:
    def take() -> None:
        robot.play("1R 2R")
        robot.wait_for("t", "t")
        robot.change(2, 2)
        robot.drain()
        robot.play("2R 700 2S")

    with Robot(MAIN_XML) as robot:
        found = json.loads(live.watch(robot, take, "--format", "json", mission=MISSION.replace("100 ms", "500 ms")))
    (clause,) = found["requirements"][0]["clauses"]
    assert (clause["verdict"], clause["counted"], clause["violated"], clause["unknown"]) == ("violated", 1, 1, 1)


def test_a_robot_goes_comes_back_and_restarts_with_another_tree(live: Live) -> None:
    other = MAIN_XML.replace("Pick", "Place").replace("Move", "Turn")
    with Robot(MAIN_XML) as robot:

        def restart() -> None:
            robot.play(GOOD)
            robot.wait_for("t", "t")
            robot.__exit__()
            with Robot(other, port=robot.port) as second:
                second.wait_for("r", "t")
                second.play(GOOD)
                second.wait_for("t", "t")
            with Robot(MAIN_XML, port=robot.port) as third:
                third.wait_for("r", "t")
                third.play(GOOD)
                third.wait_for("t", "t")

        printed = live.watch(robot, restart)
    lines = plain(printed, robot)
    foreign = (
        "its tree belongs to no known mission: main has 1 of the 3 nodes in the log; the first that it does not have is"
        " `Turn::2`; it is not judged"
    )
    assert f"TIME  {foreign}" in lines
    assert lines.count("TIME  mission main (as built now, 3 of 3 nodes)") == 2
    assert "runs: 2 succeeded" in lines
    assert plain(live.errors, robot) == ["btq verify: ROBOT: 1 run of another mission, not judged"]


def test_no_robot_is_an_error(live: Live) -> None:
    with Robot(MAIN_XML) as robot:
        pass
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    (live.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    printed = live.text("--live", robot.address, "--mission", "main.btq")
    assert live.code == 2
    assert plain(printed, robot) == ["TIME  no publisher yet; waiting for one at ROBOT"]
    assert plain(live.errors, robot) == ["btq verify: no robot answered at ROBOT, so there is nothing to judge"]


def listening(does: Callable[[socket.socket], object]) -> tuple[str, socket.socket]:
    """The address of a server that does this with each connection, and its socket, which ends it."""
    server = socket.create_server(("127.0.0.1", 0))

    def serve() -> None:
        with suppress(OSError):
            while True:
                connection, _ = server.accept()
                threading.Thread(target=does, args=(connection,), daemon=True).start()

    threading.Thread(target=serve, daemon=True).start()
    return f"tcp://127.0.0.1:{server.getsockname()[1]}", server


def web_server(connection: socket.socket) -> None:
    text = b""
    with suppress(OSError):
        while not text.endswith(b"\r\n\r\n") and (more := connection.recv(1000)):
            text += more
        connection.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")
    connection.close()


def says_at_once(connection: socket.socket) -> None:
    connection.sendall(b"SSH-2.0-OpenSSH_9.6\r\n" + bytes(range(256)))


EXPECTED = "expected a Groot2Publisher of BehaviorTree.CPP 4, found"
PORT = "Groot2Publisher has the port 1667 unless the program names another one"


@pytest.mark.parametrize(
    ("does", "told"),
    [
        (web_server, f"{EXPECTED} something else, which says 'HTTP/1.1 400 Bad Request'"),
        (says_at_once, f"{EXPECTED} something else, which says 'SSH-2.0-OpenSSH_9.6'"),
        (lambda connection: None, f"{EXPECTED} something that does not answer; {PORT}"),
    ],
)
def test_another_protocol_is_an_error(does: Callable[[socket.socket], object], told: str, live: Live) -> None:
    kept: list[socket.socket] = []

    def keeps(connection: socket.socket) -> None:
        kept.append(connection)
        does(connection)

    address, server = listening(keeps)
    (live.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    with server:
        live.text("--live", address, "--mission", "main.btq")
        server.shutdown(socket.SHUT_RDWR)
    for each in kept:
        each.close()
    assert (live.code, live.errors) == (2, f"btq verify: {address}: {told}\n")


@pytest.mark.parametrize("kind", [zmq.PUB, zmq.PULL, zmq.DEALER, zmq.ROUTER])
def test_another_socket_of_zeromq_is_an_error(kind: int, live: Live) -> None:
    """PUB is that of the port 1666 of BehaviorTree.CPP 3."""
    (live.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    with zmq.Context() as context, context.socket(kind) as other:
        address = f"tcp://127.0.0.1:{other.bind_to_random_port('tcp://127.0.0.1')}"
        live.text("--live", address, "--mission", "main.btq")
    told = f"{EXPECTED} a ZeroMQ socket of another type that does not answer; {PORT}"
    assert (live.code, live.errors) == (2, f"btq verify: {address}: {told}\n")


def test_a_server_of_another_protocol_over_zeromq_is_an_error(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    """As that of the port 1667 of BehaviorTree.CPP 3, which replies to whatever it is asked."""
    with Robot(MAIN_XML) as robot:
        monkeypatch.setattr(robot, "answer", lambda parts: [b"\x0c\0\0\0flatbuffer"])
        (live.folder / "main.btq").write_text(MISSION, encoding="utf-8")
        live.text("--live", robot.address, "--mission", "main.btq")
    told = "expected a reply of a Groot2Publisher, found one that begins with 14 bytes"
    assert (live.code, live.errors) == (2, f"btq verify: {robot.address}: {told}\n")


def test_what_hangs_up_is_waited_for(live: Live) -> None:
    """As the end of a tunnel to a robot that does not run yet."""
    address, server = listening(lambda connection: connection.close())
    (live.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    threading.Timer(6, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with server:
        printed = live.text("--live", address, "--mission", "main.btq")
        server.shutdown(socket.SHUT_RDWR)
    assert printed.endswith(f"no publisher yet; waiting for one at {address}\n")
    assert live.errors == f"btq verify: no robot answered at {address}, so there is nothing to judge\n"


def test_samples_are_those_of_the_blackboard(live: Live) -> None:
    mission = f"signal battery : % from {{level}} level\nQualityReq rq : safety\n    Move needs battery >= 20 %\n{MAIN}"

    def drive() -> None:
        robot.wait_for("B", "t")
        robot.play(GOOD)
        robot.boards["Main"]["level"] = 10
        robot.wait_for("B", "B", "t")
        robot.play(GOOD)

    with Robot(MAIN_XML, {"Main": {"level": 50, "other": None}}) as robot:
        found = json.loads(live.watch(robot, drive, "--format", "json", mission=mission))
    (clause,) = found["requirements"][0]["clauses"]
    assert (clause["counted"], clause["violated"], clause["worst"]["text"]) == (2, 1, "10 %")
    assert "  violated         rq  Move needs battery >= 20 %: Move::2 " in live.errors  # the report has the output


SPAN = "QualityReq rq : safety\n    mission keeps battery >= 20 %\n    from {0} until {1}\n"


@pytest.mark.parametrize(
    ("first", "last", "times"),
    [
        ("Move starts", "Pick succeeds", 1),
        ("Move succeeds", "Pick finishes", 1),
        ("when battery < 15 %", "Pick succeeds", 1),
        ("Pick succeeds", "Move succeeds", 0),
        # Pick may have started just after Move, as far as its row tells, so the verdict is unknown.
        ("Move starts", "Pick starts", 0),
    ],
)
def test_what_is_kept_from_an_event_until_another_is_news_at_once(
    first: str, last: str, times: int, live: Live
) -> None:
    """The battery is low from Move until Pick starts, in the second of three runs."""
    signal_line = "signal battery : % from {level} level\n"

    def drive() -> None:
        robot.wait_for("B", "t")
        robot.play(GOOD)
        robot.play("1R 2R 20 2S")
        robot.boards["Main"]["level"] = 10
        robot.wait_for("B", "B", "t")
        time.sleep(0.3)  # the next look must find the entry changed
        robot.boards["Main"]["level"] = 50
        robot.wait_for("B", "B", "t")
        time.sleep(0.3)
        robot.play("3R 20 3S 1S 2I 3I 1I")
        robot.play(GOOD)

    with Robot(MAIN_XML, {"Main": {"level": 50}}) as robot:
        printed = live.watch(robot, drive, mission=signal_line + SPAN.format(first, last) + MAIN)
    news = [line for line in plain(printed, robot) if line.startswith("TIME")]
    told = [place for place, line in enumerate(news) if "violated" in line]
    second = next(place for place, line in enumerate(news) if "run 2 succeeded" in line)
    assert len(told) == times
    assert [place < second for place in told] == [True] * times
    assert live.code == times, printed


def test_odds_use_limits_that_hold_at_every_look(live: Live) -> None:
    mission = (
        f"QualityReq rq : reliability\n    mission succeeds\n    in at least 10 % of runs\n    confidence 90 %\n{MAIN}"
    )
    with Robot(MAIN_XML) as robot:
        printed = live.watch(robot, lambda: robot.play(GOOD, GOOD, GOOD), mission=mission)
    assert "3 of 3, at least 29.2 % with confidence 90 % at every look" in printed


def test_what_is_found_is_kept_in_a_store(live: Live) -> None:
    kept = ["--label", "v1", "--robot", "r7"]
    with Robot(MAIN_XML) as robot:
        live.watch(robot, lambda: robot.play(GOOD), "--store", "evidence", *kept)
        assert (live.code, live.errors) == (0, "")
        (live.folder / "btq.toml").write_text('[evidence]\nstore = "evidence"\n', encoding="utf-8")
        live.watch(robot, lambda: robot.play(GOOD), *kept)
        assert (live.code, live.errors) == (0, "")
        live.watch(robot, lambda: robot.play(GOOD), "--no-store")
    found = live.json("--store", "evidence", "--by", "label", "--by", "robot")
    assert found["runs"] == 2
    assert [each["mission"] for each in found["sources"]] == ["main, label v1, robot r7"]


def test_the_report_goes_where_it_is_asked(live: Live) -> None:
    with Robot(MAIN_XML) as robot:
        printed = live.watch(robot, lambda: robot.play(GOOD), "-o", "page.html")
    assert printed == ""
    assert "run 1 succeeded" in live.errors
    assert "<html" in (live.folder / "page.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["x:1667"], "--live x:1667: expected an address with a port, as in tcp://127.0.0.1:1667"),
        (["tcp://x"], "--live tcp://x: expected an address with a port, as in tcp://127.0.0.1:1667"),
        (["tcp://x:99999"], "--live tcp://x:99999: expected an address with a port, as in tcp://127.0.0.1:1667"),
        (["tcp://x:1", "--jobs", "2"], "--jobs is for logs; a running robot is judged in one process"),
        (["tcp://x:1", "--summary", "a.json"], "--summary is for logs"),
        (["tcp://x:1", "--run", "1"], "--run is for logs"),
        (["tcp://x:1", "--by", "label"], "--by goes with --store DIR and no log"),
        (["tcp://x:1", "--label", ""], "--label is empty; give a name, or leave it out to keep what the store has"),
        (["tcp://x:1", "--label", "v1"], "--label names the runs in a store; give --store DIR, where they are kept"),
        (["tcp://x:1", "--robot", "r1", "--no-store"], "--robot names the runs in a store; leave out --no-store"),
        (["tcp://x:1", "--label-by", "folder"], "--label-by is for logs, which are in folders; give --label NAME"),
        (["tcp://x:1", "--robot-by", "folder"], "--robot-by is for logs, which are in folders; give --robot NAME"),
        (
            ["tcp://x:1", "--signals", "a.csv"],
            "--signals is read before the robot runs; with --live, values come from its blackboard",
        ),
        (["tcp://x:1", "run.btlog"], "--live watches a robot; judge logs by themselves"),
        (["tcp://x:1", "-o", "a.png"], None),
    ],
)
def test_what_makes_no_sense_is_a_usage_error(live: Live, arguments: list[str], problem: str | None) -> None:
    assert live.text("--live", *arguments) == ""
    assert live.code == 2
    assert problem is None or live.errors == f"btq verify: {problem}\n"


def test_without_the_extra_it_says_so(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zmq", None)
    assert live.text("--live", "tcp://127.0.0.1:1667") == ""
    assert live.code == 2
    assert live.errors == (
        "btq verify: a running robot is read with pyzmq; install it with pip install 'btq-lang[live]'\n"
    )


TIMEOUT = ["timeout", "--foreground", "--preserve-status", "1h"]  # as docs/evidence.md has it; SIGALRM ends the hour


@pytest.mark.parametrize(
    ("before", "number"),
    [
        ([], signal.SIGINT),
        ([], signal.SIGTERM),
        pytest.param(
            TIMEOUT, signal.SIGALRM, marks=pytest.mark.skipif(sys.platform != "linux", reason="timeout is of coreutils")
        ),
    ],
)
def test_a_process_ends_with_the_table(before: list[str], number: signal.Signals, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    with Robot(MAIN_XML) as robot:
        command: list[Any] = [*before, sys.executable, "-m", "btq_lang", "verify", "--live", robot.address]
        with running(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as btq:
            robot.wait_for("r", "t")
            robot.play(GOOD)
            robot.wait_for("t", "t")
            btq.send_signal(number)
            printed, errors = btq.communicate(timeout=30)
    assert (btq.returncode, errors) == (0, "")
    assert "satisfied        quick  Move takes at most 100 ms  held so far in 1 activation" in printed


def test_on_a_terminal_the_verdicts_are_drawn_in_place(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    with Robot(MAIN_XML) as robot, Terminal(tmp_path, 80, 16, "verify", "--live", robot.address) as terminal:
        robot.wait_for("r", "t")
        robot.play(GOOD)
        terminal.wait_for("run 1 succeeded")
        robot.play(SLOW.replace("205 3S 1S 2I 3I 1I", ""))
        terminal.wait_for("violated  ")
        running = terminal.screen()
        robot.play("3S 1S 2I 3I 1I")
        terminal.wait_for("run 2 succeeded")
        code, left = terminal.end()
    changing = r"(?<=worst )[\d.]+ ms|(?<= )[\d.]+ ms(?= in run 2| after its)|(?<=took )[\d.]+( ms)?(?=,|$)"
    assert plain(re.sub(changing, "MORE", "\n".join(running), flags=re.MULTILINE), robot) == [
        "ROBOT",
        "mission main (as built now, 3 of 3 nodes)",
        "runs: 1 succeeded",
        "",
        "  violated         quick  Move takes at most 100 ms  1 of 2 activations, worst",
        "                                                     MORE in run 2",
        "                   Move::2: took MORE, bound 100 ms (run 2 of",
        "                   ROBOT, MORE after its start at DAY",
        "",
        "TIME  mission main (as built now, 3 of 3 nodes)",
        "TIME  run 1 succeeded after 10 ms",
        "TIME  satisfied        quick  Move takes at most 100 ms: held so far in ",
        "TIME  violated         quick  Move takes at most 100 ms: Move::2 took MORE",
        "",
        "Ctrl+C ends with the table",
    ]
    assert code == 1
    assert left.startswith(f"2 runs in {robot.address}, ")
    assert "\x1b[?" not in left


class Terminal:
    """A terminal of some columns and lines, in which btq runs."""

    def __init__(self, folder: Path, columns: int, lines: int, *arguments: str) -> None:
        self._size = columns, lines
        self._text = ""
        self._file, inside = os.openpty()
        fcntl.ioctl(inside, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))
        command = [sys.executable, "-m", "btq_lang", *arguments]
        environment = {**os.environ, "TERM": "xterm", "NO_COLOR": "1"}
        self._btq = subprocess.Popen(command, cwd=folder, env=environment, stdin=inside, stdout=inside, stderr=inside)
        os.close(inside)

    def __enter__(self) -> Terminal:
        return self

    def __exit__(self, *_: object) -> None:
        self._btq.kill()
        self._btq.wait()
        os.close(self._file)

    def wait_for(self, text: str) -> None:
        """Wait until a text is on the screen."""
        end = time.monotonic() + 30
        while not any(text in line for line in self.screen()):
            assert time.monotonic() < end, f"no {text!r} on the screen: {self.screen()}"
            if select.select([self._file], [], [], 0.1)[0]:
                self._text += os.read(self._file, 65536).decode()

    def screen(self) -> list[str]:
        """What was drawn last, as far as it is wide."""
        whole = [each for each in self._text.split("\x1b[H") if each.endswith("\x1b[J")]
        lines = whole[-1].removesuffix("\x1b[K\x1b[J").split("\x1b[K\r\n") if whole else []
        assert len(lines) <= self._size[1]
        return [line[: self._size[0]] for line in lines]

    def end(self) -> tuple[int, str]:
        """Send what Ctrl+C sends; returns the exit code, and what is on the terminal then."""
        self._btq.send_signal(signal.SIGINT)
        with suppress(OSError):  # so a terminal ends
            while data := os.read(self._file, 65536):
                self._text += data.decode()
        return self._btq.wait(), self._text.rpartition("\x1b[?1049l")[2]


def test_a_small_screen_leaves_verdicts_out_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    watched = Watched((), "tcp://robot:1667", lambda news: None)
    news = [f"news {number}" for number in range(9)]
    assert drawn(watched, news, 80, 10, painter(False)) == ["tcp://robot:1667", "", *news[3:], "", HINT]
    monkeypatch.setattr(watched, "so_far", lambda: iter([(REQUIREMENT,) * 9]))
    assert drawn(watched, news, 80, 14, painter(False)) == [
        "tcp://robot:1667",
        "",
        *["  satisfied        rq  takes at most 1 s  held so far in 3 activations"] * 3,
        "  … 6 more lines; the table at the end has all",
        "",
        *news[4:],
        "",
        HINT,
    ]
