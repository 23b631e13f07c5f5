"""A running robot of the real engine, judged through its Groot2Publisher."""

from __future__ import annotations

import json
import os
import signal
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import zmq
from engine_loader import Answer, Engine, Published
from evidence_logs import Verify
from groot2_recording import RECORDINGS, exchanges, meaning, read, write

from btq_lang.commands.live_screen import Lines
from btq_lang.evidence.model import IDLE, PAUSE, UNTIL
from btq_lang.evidence.readers.groot2.sessions import sessions

MISSION = """
signal battery : % from {battery} level
QualityReq quick : safety
    Move takes at most 2 s
QualityReq charged : safety
    Pick needs battery >= 20 %
Root Main
BehaviorTree Main
    ->
        Script (code = "battery := 50.0")
        Action Move Move
        SubTree Part (battery = "{battery}")
BehaviorTree Part
    ->
        Action Pick Pick
TreeNodesModel
    Action Move
    Action Pick
"""
XML = """<root BTCPP_format="4" main_tree_to_execute="Main">
  <BehaviorTree ID="Main"><Sequence><Script code="battery := 50.0"/><Move name="Move"/>
    <SubTree ID="Part" battery="{battery}"/></Sequence></BehaviorTree>
  <BehaviorTree ID="Part"><Sequence><Pick name="Pick"/></Sequence></BehaviorTree>
</root>"""
MOVES = ["RUNNING", {"status": "SUCCESS", "ms": 50}]
SLOW = ["RUNNING", {"status": "SUCCESS", "ms": 2500}]
PARTS = {"Move": [MOVES, SLOW, MOVES], "Pick": ["RUNNING", "RUNNING", "SUCCESS"]}
STATUSES = ("IDLE", "RUNNING", "SUCCESS", "FAILURE")


@pytest.fixture
def publisher(engine: Engine) -> Engine:
    """An engine that has its publisher."""
    if not engine.publishes:
        pytest.skip("this engine was built without ZeroMQ, so it has no Groot2Publisher")
    return engine


@contextmanager
def robot(publisher: Engine, runs: int) -> Iterator[tuple[Published, str]]:
    """A robot that does what PARTS say, and its address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with publisher.publishing(XML, port, parts=PARTS, ticks=1000, tick_ms=5, runs=runs, seconds=120) as published:
        yield published, f"tcp://127.0.0.1:{port}"


def act(published: Published, seen: Callable[[], int], end: Callable[[], object], answers: list[Answer]) -> None:
    """Let the robot run three times, and then end.

    Args:
        seen: of how many runs the end has been seen.
        end: ends the watching.
    """
    patience = time.monotonic() + 90
    for run in range(4):
        while seen() < run:
            assert time.monotonic() < patience, f"the end of run {run} was not seen"
            time.sleep(0.01)
        if run < 3:
            published.go_on()
    end()
    published.go_on()
    answers.append(published.answer())


def test_every_transition_of_the_engine_comes(publisher: Engine) -> None:
    stop = threading.Event()
    answers: list[Answer] = []
    transitions: list[tuple[int, int]] = []
    with robot(publisher, 3) as (published, address):
        found = next(sessions(address, {"battery"}, stop, lambda text: None, lambda: None))
        thread = threading.Thread(target=act, args=(published, lambda: transitions.count((1, IDLE)), stop.set, answers))
        thread.start()
        for _, uid, status in found.transitions:
            transitions.append((uid, status))
        thread.join()
    (answer,) = answers
    engines = [(uid, STATUSES.index(after)) for _, uid, _, after in answer.transitions]
    assert [each for each in transitions if each[0] not in (PAUSE, UNTIL)] == engines
    assert len(engines) > 50
    assert [node.path for node in answer.tree] == [each.path for each in found.tree.nodes.values()]
    assert {*found.samples["battery"].values} == {50.0}
    assert found.remarks == []


def test_the_command_judges_the_engine_while_it_runs(
    publisher: Engine, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    answers: list[Answer] = []
    news: list[str] = []
    monkeypatch.setattr(Lines, "show", lambda self, each: news.append(each.text))
    with robot(publisher, 3) as (published, address):

        def runs() -> int:
            begun = any(each.startswith("mission main") for each in news)
            return sum(each.startswith("run ") for each in news) if begun else -1

        def end() -> None:
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=act, args=(published, runs, end, answers))
        thread.start()
        verify = Verify(tmp_path, capsys)
        found = json.loads(verify.text("--live", address, "--mission", "main.btq", "--format", "json"))
        thread.join()
    assert found["runs"] == 3
    assert [source["identity"] for source in found["sources"]] == ["as built now"]
    clauses = {each["id"]: each["clauses"][0] for each in found["requirements"]}
    quick, charged = clauses["quick"], clauses["charged"]
    assert (quick["verdict"], quick["counted"], quick["violated"]) == ("violated", 3, 1)
    assert (charged["verdict"], charged["counted"]) == ("satisfied", 3)
    assert verify.code == 1


def test_the_engine_replies_as_it_was_recorded(publisher: Engine, request: pytest.FixtureRequest) -> None:
    with robot(publisher, 1) as (published, address), zmq.Context() as context, context.socket(zmq.REQ) as asking:
        asking.setsockopt(zmq.LINGER, 0)
        asking.setsockopt(zmq.RCVTIMEO, 60_000)
        asking.connect(address)

        def ask(parts: list[bytes]) -> list[bytes]:
            asking.send_multipart(parts)
            return asking.recv_multipart()

        def run() -> None:
            published.go_on()
            while not ask([b"\2S\0\0\0\0"])[1].startswith(b"\1\0\x0c"):  # the root is idle after its success
                time.sleep(0.01)

        found = exchanges(ask, run)
    path = RECORDINGS / f"groot2-{publisher.version.rpartition('.')[0]}.json"
    if request.config.getoption("--update"):
        write(path, found)
    assert meaning(found) == meaning(read(path))
