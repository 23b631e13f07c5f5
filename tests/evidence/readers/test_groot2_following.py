"""A publisher followed without a network, on clocks that a test sets: sessions, gaps, samples, and other publishers."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from evidence_logs import MAIN_XML, START, rows
from groot2_robot import KEPT, Publisher

from btq_lang.cli import main
from btq_lang.commands.candidates import candidates
from btq_lang.evidence.json_document import render
from btq_lang.evidence.judging import Means
from btq_lang.evidence.model import GAP, PAUSE, Session
from btq_lang.evidence.readers import read
from btq_lang.evidence.readers.groot2.following import Began, Came, Event, Following, Lost, Notice, Sampled
from btq_lang.evidence.readers.groot2.messages import reply, request
from btq_lang.evidence.readers.groot2.publisher import NoAnswer
from btq_lang.evidence.readers.groot2.sessions import sessions_of
from btq_lang.evidence.readers.tree import read_tree
from btq_lang.evidence.verifying import judged_live
from btq_lang.evidence.watching import Watched

POLL = 50_000  # µs
NO_MORE = "another program took some"
SEVERAL = "more transitions than the publisher keeps came between two requests"


class Line:
    """A robot and who follows it.

    Attributes:
        now: the time in µs since the robot's start.
        robot: the publisher; None: it is away.
    """

    def __init__(self, xml: str = MAIN_XML, entries: tuple[str, ...] = ()) -> None:
        self.now = 0
        self.robot: Publisher | None = self.another(xml)
        self.following = Following(self.ask, lambda: self.now + 7_000_000, entries, "tcp://robot:1667")

    def another(self, xml: str = MAIN_XML) -> Publisher:
        return Publisher(xml, clock=lambda: START + self.now)

    def ask(self, kind: str, argument: str | None = None) -> object:
        if self.robot is None:
            raise NoAnswer
        parts = request(kind, len(self.robot.asked), argument)
        return reply(self.robot.answer(parts), parts[0])

    def step(self, text: str = "") -> list[Event]:
        """What is found when the robot has done something, as `rows` reads it, and a poll has passed."""
        assert self.robot is not None
        begin = self.now
        for at, uid, status in rows(text):
            self.now = begin + at
            self.robot.change(uid, status)
        self.now = max(self.now, begin) + POLL
        return [*self.following.step()]


def ms(events: list[Event]) -> str:
    """The transitions among events, with their times in ms."""
    found = [each for event in events if isinstance(event, Came) for each in event.transitions]
    names: dict[int, str] = {GAP: "gap", PAUSE: "pause"}
    return " ".join(
        f"{(time - START) / 1000:g}:{names.get(uid) or str(uid) + 'IRSF'[status]}" for time, uid, status in found
    )


def test_transitions_come_with_the_robots_times() -> None:
    line = Line()
    (began,) = line.step()
    assert isinstance(began, Began)
    assert not began.is_amid
    assert ms(line.step("1R 2R 20 2S 3R")) == "50:1R 50:2R 70:2S 70:3R"
    assert line.step() == []
    assert ms(line.step("3S 1S 1I")) == "170:3S 170:1S 170:1I"
    assert ms(line.step()) == "220:pause"
    assert line.step() == []
    assert line.robot is not None
    assert set(line.robot.asked) == {"T", "S", "r", "t"}  # and never one that changes what the robot does


def test_a_robot_that_runs_already_begins_with_a_gap() -> None:
    line = Line()
    assert line.robot is not None
    line.robot.change(1, 1)
    began, came = line.step()
    assert isinstance(began, Began)
    assert began.is_amid
    assert ms([came]) == "50:gap"


def test_a_full_buffer_is_a_gap() -> None:
    line = Line()
    line.step()
    line.step("1R")
    events = line.step("2R 2S 2I " * (KEPT // 3) + "2R")
    assert events[0] == Lost(START + 100_000, SEVERAL)
    assert ms(events).startswith("100:gap 100:2R 100:2S")
    assert line.following.pause == 0.0
    assert ms(line.step("2S")) == "150:2S"
    assert line.following.pause > 0


def test_what_another_program_takes_while_more_comes_is_a_gap() -> None:
    line = Line()
    line.step()
    line.step("1R 2R")
    assert line.robot is not None
    line.robot.change(2, 2)
    line.robot.drain()
    events = line.step("2R")  # it ran already, as far as is known
    assert events[0] == Lost(START + 100_000, NO_MORE)
    assert ms(events) == "100:gap 100:2R"


def test_what_another_program_takes_before_a_rest_is_a_gap() -> None:
    line = Line()
    line.step()
    line.step("1R 2R")
    line.step()
    assert line.robot is not None
    line.robot.change(2, 2)
    line.robot.drain()
    assert line.step() == []  # only now all statuses are asked for
    events = line.step()
    assert [type(each) for each in events] == [Lost, Came]
    assert ms(events) == "200:gap"
    assert ms(line.step("3R")) == "250:3R"


def test_a_recording_stopped_by_another_program_goes_on() -> None:
    line = Line()
    line.step()
    line.step("1R 2R")
    line.step()
    line.ask("r", "stop")
    line.step("2S 3R")
    assert [type(each) for each in line.step()] == [Lost, Came]
    assert ms(line.step("3S 1S")) == "250:3S 250:1S"


def test_a_recording_restarted_by_another_program_has_other_times() -> None:
    line = Line()
    line.step()
    for _ in range(40):
        line.step()
    line.ask("r", "start")
    lost, came = line.step("1R 2R")
    assert lost == Lost(START + 2_050_000, "another program has restarted the recording, or the robot's clock was set")
    assert ms([came]) == "2050:gap"
    assert ms(line.step("2S 3R")) == "2100:2S 2100:3R"


def test_a_publisher_that_comes_back_has_a_gap() -> None:
    line = Line()
    line.step()
    line.step("1R 2R")
    robot, line.robot = line.robot, None
    assert [*line.following.step()] == [
        Notice("the publisher does not answer any more; waiting for one at tcp://robot:1667")
    ]
    assert [*line.following.step()] == []
    line.robot = robot
    lost, came = line.step("2S 3R")
    assert lost == Lost(START + 150_000, "the publisher had not answered for a while")
    assert ms([came]) == "150:gap"
    assert ms(line.step("3S 1S")) == "150:3S 150:1S"


def test_another_publisher_begins_another_session() -> None:
    line = Line()
    line.step()
    line.robot = line.another(MAIN_XML.replace("Pick", "Place"))
    (began,) = line.step()
    assert isinstance(began, Began)
    assert [node.path for node in began.tree.nodes.values()] == ["Sequence::1", "Move::2", "Place::3"]


def test_no_publisher_is_told_once() -> None:
    line = Line()
    robot, line.robot = line.robot, None
    assert [*line.following.step()] == [Notice("no publisher yet; waiting for one at tcp://robot:1667")]
    assert [*line.following.step()] == []
    line.robot = robot
    assert [type(each) for each in line.step()] == [Began]


def test_an_entry_is_sampled_when_it_changes() -> None:
    line = Line(entries=("battery", "speed", "load"))
    assert line.robot is not None
    line.robot.boards["Main"] = {"battery": 80.0, "other": 1, "speed": {"x": 1}}
    line.step()
    assert line.step() == [Sampled(START + 100_000, {"battery": 80.0})]
    assert line.step() == []
    line.robot.boards["Main"]["battery"] = True
    assert line.step() == [Sampled(START + 200_000, {"battery": True})]
    del line.robot.boards["Main"]["battery"]
    assert line.step() == [Sampled(START + 250_000, {"battery": None})]


def test_samples_are_of_the_main_tree_or_of_the_only_subtree_that_has_them() -> None:
    tree = '<BehaviorTree ID="Sub" _fullpath="{}"><Move name="Move" _uid="{}"/></BehaviorTree>'
    xml = MAIN_XML.replace(
        '<Move name="Move" _uid="2"/><Pick name="Pick" _uid="3"/>',
        ('<SubTree ID="Sub" _fullpath="a" _uid="2"/><SubTree ID="Sub" _fullpath="b" _uid="4"/>'),
    ).replace("</root>", f"{tree.format('a', 3)}{tree.format('b', 5)}</root>")
    line = Line(xml, ("x", "y", "z"))
    assert line.robot is not None
    line.robot.boards |= {"Main": {"x": 1}, "a": {"x": 2, "y": 3, "z": 4}, "b": {"z": 5}}
    line.step()
    (sampled,) = line.step()
    assert isinstance(sampled, Sampled)
    assert sampled.values == {"x": 1, "y": 3}


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (lambda parts: [], "expected a reply of a Groot2Publisher, found one that begins with 0 bytes"),
        (lambda parts: [b"error", b"no \xff"], "the publisher refused a request: no �"),
        (lambda parts: [b"\3" + parts[0][1:], parts[1]], "protocol 3 of Groot2; btq speaks protocol 2"),
        (lambda parts: [parts[0][:2] + b"abcd" + parts[0][6:], parts[1]], "the reply is to another request"),
        (lambda parts: [parts[0], b"<root>"], "its tree is not BehaviorTree.CPP XML"),
        (
            lambda parts: [parts[0], parts[1].replace(b'_uid="3"', b'_uid="4"')],
            "the nodes of its tree are not numbered 1, 2, 3 … as BehaviorTree.CPP numbers them",
        ),
        (lambda parts: [parts[0]], "its tree is not BehaviorTree.CPP XML"),
    ],
)
def test_a_bad_reply_is_told(damage: Callable[[list[bytes]], list[bytes]], told: str) -> None:
    line = Line()
    assert line.robot is not None
    answer = line.robot.answer
    line.robot.answer = lambda parts: damage(answer(parts))
    assert line.step() == [Notice(f"{told}; waiting for one at tcp://robot:1667")]
    assert line.step() == []


@pytest.mark.parametrize(
    ("kind", "content", "told"),
    [
        ("S", b"\1\0\1", "expected 3 bytes for each of 3 nodes, found 3 in all"),
        ("r", b"soon", "expected the time at which the recording began, found b'soon'"),
        ("t", b"\0" * 10, "expected 9 bytes for each transition, found 10 in all"),
    ],
)
def test_bad_content_is_told(kind: str, content: bytes, told: str) -> None:
    line = Line(entries=("battery",))
    assert line.robot is not None
    answer = line.robot.answer

    def damaged(parts: list[bytes]) -> list[bytes]:
        found = answer(parts)
        return [found[0], content] if parts[0][1] == ord(kind) else found

    line.robot.answer = damaged
    events = [*line.step(), *line.step("1R 2R")]
    assert [each.text for each in events if isinstance(each, Notice)] == [
        f"{told}; waiting for one at tcp://robot:1667"
    ]


@pytest.mark.parametrize(
    ("reply_of", "told"),
    [
        (lambda head: [head, b"\xc1"], "the blackboard is not MessagePack"),
        (lambda head: [head, b"\1"], "expected a map of blackboards"),
        (lambda head: [b"error", b"no ROOT"], "the publisher refused a request: no ROOT"),
    ],
)
def test_a_blackboard_that_cannot_be_read_ends_only_the_samples(
    reply_of: Callable[[bytes], list[bytes]], told: str
) -> None:
    line = Line(entries=("battery",))
    assert line.robot is not None
    line.robot.boards["Main"] = {"battery": 80.0}
    line.step()
    assert line.step() == [Sampled(START + 100_000, {"battery": 80.0})]
    answer = line.robot.answer
    line.robot.answer = lambda parts: reply_of(answer(parts)[0]) if parts[0][1:2] == b"B" else answer(parts)
    assert line.step() == [
        Notice(f"{told}; signals have no samples from now on"),
        Sampled(START + 150_000, {"battery": None}),
    ]
    assert ms(line.step("1R 2R")) == "150:1R 150:2R"


def test_a_log_judged_live_has_the_verdicts_of_its_file(
    shared: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    log, mission = shared / "logs" / "lab.btlog", Path(__file__).parents[1] / "lab.btq"
    main(["verify", str(log), "--mission", str(mission), "--format", "json"])
    of_file = json.loads(capsys.readouterr().out)
    data = log.read_bytes()
    length = int.from_bytes(data[19:23], "little")
    line = Line(data[23 : 23 + length].decode())
    rows_of_log = [each for session in read(str(log)) if isinstance(session, Session) for each in session.transitions]

    def events() -> Iterator[Event]:
        yield from line.following.step()
        polled = 0
        for time, uid, status in rows_of_log:
            while time - START >= polled + POLL:
                polled += POLL
                line.now = polled
                yield from line.following.step()
            line.now = time - START
            assert line.robot is not None
            line.robot.change(uid, status)
        yield from line.following.step()

    news: list[object] = []
    watched = Watched(sessions_of(events(), lambda text: watched.tell(text)), "tcp://robot:1667", news.append)
    found = judged_live(watched, "tcp://robot:1667", Means(candidates([str(mission)], (), [])), [str(mission)])
    live = json.loads(render(found.report))
    assert found.problems == ()
    assert live["runs"] == of_file["runs"] == 200
    assert _without_limits(live) == _without_limits(of_file)


def _without_limits(document: dict[str, object]) -> object:
    """The requirements, without what depends on how often one looks, and on the name of the log."""
    text = json.dumps(document["requirements"]).replace("tcp://robot:1667", "lab.btlog")
    return json.loads(text, object_hook=_reduced)


def _reduced(found: dict[str, object]) -> object:
    for name in ("interval", "limits", "more", "source"):
        found.pop(name, None)
    return SimpleNamespace(**found)


def test_read_tree_of_the_publisher_is_that_of_a_log() -> None:
    assert [node.path for node in read_tree(MAIN_XML).nodes.values()] == ["Sequence::1", "Move::2", "Pick::3"]
