"""A publisher followed without a network, on clocks that a test sets: sessions, gaps, samples, and other publishers."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import SimpleNamespace

import pytest
from evidence_logs import MAIN, MAIN_XML, START, rows
from groot2_robot import KEPT, Publisher

from btq_lang.cli import main
from btq_lang.commands.candidates import candidates
from btq_lang.evidence.json_document import render
from btq_lang.evidence.judging import Means
from btq_lang.evidence.model import GAP, PAUSE, LogSession
from btq_lang.evidence.readers import read
from btq_lang.evidence.readers.groot2.following import (
    Began,
    Came,
    Event,
    Following,
    LostTransitions,
    Notice,
    Passed,
    Sampled,
)
from btq_lang.evidence.readers.groot2.messages import Reply, reply, request
from btq_lang.evidence.readers.groot2.publisher import NoAnswer
from btq_lang.evidence.readers.groot2.sessions import sessions_of
from btq_lang.evidence.readers.tree import read_tree
from btq_lang.evidence.verdicts import ClauseVerdict
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

    def ask(self, kind: str, argument: str | None = None) -> Reply:
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
    assert events[0] == LostTransitions(START + 100_000, SEVERAL)
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
    assert events[0] == LostTransitions(START + 100_000, NO_MORE)
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
    assert [type(each) for each in events] == [LostTransitions, Came]
    assert ms(events) == "200:gap"
    assert ms(line.step("3R")) == "250:3R"


def test_a_recording_stopped_by_another_program_goes_on() -> None:
    line = Line()
    line.step()
    line.step("1R 2R")
    line.step()
    line.ask("r", "stop")
    line.step("2S 3R")
    assert [type(each) for each in line.step()] == [LostTransitions, Came]
    assert ms(line.step("3S 1S")) == "250:3S 250:1S"


def test_a_recording_restarted_by_another_program_has_other_times() -> None:
    line = Line()
    line.step()
    for _ in range(40):
        line.step()
    line.ask("r", "start")
    lost, came = line.step("1R 2R")
    assert lost == LostTransitions(
        START + 2_050_000, "another program has restarted the recording, or the robot's clock was set"
    )
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
    assert lost == LostTransitions(START + 150_000, "the publisher had not answered for a while")
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
def test_a_bad_reply_is_told(
    damage: Callable[[list[bytes]], list[bytes]], told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = Line()
    assert line.robot is not None
    answer = line.robot.answer
    monkeypatch.setattr(line.robot, "answer", lambda parts: damage(answer(parts)))
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
def test_bad_content_is_told(kind: str, content: bytes, told: str, monkeypatch: pytest.MonkeyPatch) -> None:
    line = Line(entries=("battery",))
    assert line.robot is not None
    answer = line.robot.answer

    def damaged(parts: list[bytes]) -> list[bytes]:
        found = answer(parts)
        return [found[0], content] if parts[0][1] == ord(kind) else found

    monkeypatch.setattr(line.robot, "answer", damaged)
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
    reply_of: Callable[[bytes], list[bytes]], told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = Line(entries=("battery",))
    assert line.robot is not None
    line.robot.boards["Main"] = {"battery": 80.0}
    line.step()
    assert line.step() == [Sampled(START + 100_000, {"battery": 80.0})]
    answer = line.robot.answer

    def damaged(parts: list[bytes]) -> list[bytes]:
        return reply_of(answer(parts)[0]) if parts[0][1:2] == b"B" else answer(parts)

    monkeypatch.setattr(line.robot, "answer", damaged)
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
    rows_of_log = [
        each for session in read(str(log)) if isinstance(session, LogSession) for each in session.transitions
    ]

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


class Judged:
    """What a session reports while the steps of a robot are judged.

    Attributes:
        news: the verdicts and texts so far, each with the number of the step after which it was told.
        tables: after each step, the verdicts so far.
    """

    def __init__(self, folder: Path, mission: str, steps: Sequence[str | Callable[[Line], object]]) -> None:
        (folder / "main.btq").write_text(mission, encoding="utf-8")
        self.news: list[tuple[int, str | None, str]] = []
        self.tables: list[list[str]] = []
        means = Means(candidates([str(folder / "main.btq")], (), []))
        entries = {signal.entry for each in means.missions for signal in each.requirements.signals.values()}
        self._line = Line(entries=tuple(entries))
        self._step = 0
        told = sessions_of(self._events(steps), lambda text: watched.tell(text), lambda time: watched.look(time))
        watched = Watched(
            told, "tcp://robot:1667", lambda each: self.news.append((self._step, each.verdict, each.text))
        )
        self._watched = watched
        self.found = judged_live(watched, "tcp://robot:1667", means, [str(folder / "main.btq")])

    def _events(self, steps: Sequence[str | Callable[[Line], object]]) -> Iterator[Event]:
        yield from self._line.step()
        for self._step, each in enumerate(steps, 1):
            if callable(each):
                each(self._line)
            yield from self._line.step(each if isinstance(each, str) else "")
            if self._line.following.passed is not None:
                yield Passed(self._line.following.passed)
            self.tables.append([one.verdict for requirements in self._watched.so_far() for one in requirements])

    @property
    def violations(self) -> list[tuple[int, str]]:
        """Those that were told, each with its step."""
        return [(step, text.partition(": ")[2]) for step, verdict, text in self.news if verdict == "violated"]

    @property
    def clause(self) -> ClauseVerdict:
        """The only clause, at the end."""
        ((requirement,),) = [each.requirements for each in self.found.report.missions]
        return requirement.clauses[0]


def sets(**values: object) -> Callable[[Line], object]:
    """A step in which entries of the blackboard get values."""

    def act(line: Line) -> None:
        assert line.robot is not None
        line.robot.boards.setdefault("Main", {}).update(values)

    return act


END = "2S 3R 3S 1S 2I 3I 1I"
BATTERY = "signal battery : % from {battery}\n"


@pytest.mark.parametrize(
    ("demand", "broken"),
    [
        ("Move takes at most 120 ms", "Move::2 took 150 ms, bound 120 ms; it is still active"),
        ("Move succeeds within 120 ms", "Move::2 had not succeeded after 150 ms, bound 120 ms; it is still active"),
        ("mission takes at most 120 ms", "Sequence::1 took 150 ms, bound 120 ms; it is still active"),
    ],
)
def test_a_time_that_is_over_is_told_while_the_node_runs(demand: str, broken: str, tmp_path: Path) -> None:
    """At the first poll after it is over, and not again when the node ends, by which its whole time counts."""
    mission = f"QualityReq rq : safety\n    {demand}\n{MAIN}"
    judged = Judged(tmp_path, mission, ["1R 2R", "", "", "", "", "", END, "1R 2R 2S 3R 3S 1S 2I 3I 1I", ""])
    assert judged.violations == [(3, broken)]
    assert judged.tables == [["never exercised"]] * 2 + [["violated"]] * 7
    assert (judged.clause.counted, judged.clause.violated) == (2, 1)
    assert judged.clause.worst is not None
    assert judged.clause.worst.text == "300 ms"
    assert [text for _, _, text in judged.news if text.startswith("run ")] == [
        "run 1 succeeded after 300 ms",
        "run 2 succeeded after 0 ms",
    ]


@pytest.mark.parametrize(
    ("demand", "broken"),
    [
        ("keeps battery >= 20 %", "`battery` was 15 %, bound 20 %"),
        ("never battery < 20 %", "`battery` was 15 %, bound 20 %"),
    ],
)
def test_a_sample_that_breaks_a_condition_is_told_while_the_node_runs(demand: str, broken: str, tmp_path: Path) -> None:
    mission = f"{BATTERY}QualityReq rq : safety\n    Move {demand}\n{MAIN}"
    steps: list[str | Callable[[Line], object]] = [
        sets(battery=50),
        "1R 2R",
        sets(battery=30),
        sets(battery=15),
        "",
        sets(battery=5),
        END,
        "",
    ]
    judged = Judged(tmp_path, mission, steps)
    ((step, told),) = judged.violations
    assert step == 4
    assert told.endswith("; it is still active")
    assert "`battery` was 15 %" in told
    assert judged.tables[step - 2 :] == [["never exercised"]] + [["violated"]] * (len(steps) - step + 1)
    assert (judged.clause.counted, judged.clause.violated) == (1, 1)


def test_what_a_node_needed_at_its_start_is_told_while_it_runs(tmp_path: Path) -> None:
    mission = f"{BATTERY}QualityReq rq : safety\n    Move needs battery >= 20 %\n{MAIN}"
    judged = Judged(tmp_path, mission, [sets(battery=15), "1R 2R", "", "", END, ""])
    assert [step for step, _ in judged.violations] == [2]


@pytest.mark.parametrize(
    ("demand", "steps", "at"),
    [
        ("takes at most 120 ms\n    while battery > 20 %", [END], 8),  # it might still not count
        ("takes at most 120 ms\n    while battery > 20 %", [sets(battery=10), END], None),
        ("takes at most 120 ms\n    when battery > 60 %", [END], None),
        ("takes at most 120 ms\n    when battery > 20 %", [END], 4),
        ("takes at most 120 ms if battery > 60 % else 200 ms", [END], 6),
        ("keeps mean(battery) < 60 %", [sets(battery=90), END], 9),
        ("takes at most 120 ms\n    in at least 50 % of runs\n    confidence 95 %", [END], None),
    ],
)
def test_only_what_stays_a_violation_is_told_early(
    demand: str, steps: list[str | Callable[[Line], object]], at: int | None, tmp_path: Path
) -> None:
    mission = f"{BATTERY}QualityReq rq : safety\n    Move {demand}\n{MAIN}"
    judged = Judged(tmp_path, mission, [sets(battery=50), "1R 2R", "", "", "", "", "", *steps, ""])
    assert [step for step, _ in judged.violations] == ([at] if at is not None else [])


def test_what_was_told_counts_when_nobody_watches_any_more(tmp_path: Path) -> None:
    """The node is still active then; also if transitions were lost meanwhile."""
    mission = f"QualityReq rq : safety\n    Move takes at most 120 ms\n{MAIN}"
    judged = Judged(tmp_path, mission, ["1R 2R", "", "", "", ""])
    assert len(judged.violations) == 1
    assert (judged.clause.verdict, judged.clause.violated) == ("violated", 1)

    def taken(line: Line) -> None:
        assert line.robot is not None
        line.robot.change(2, 2)
        line.robot.drain()

    judged = Judged(tmp_path, mission, ["1R 2R", "", "", "", "", taken, "2R", "2S 3R 3S 1S", ""])
    assert len(judged.violations) == 1
    assert (judged.clause.verdict, judged.clause.violated) == ("violated", 1)


def test_what_another_program_may_have_taken_is_not_told(tmp_path: Path) -> None:
    """Only the statuses show that the node has ended."""
    mission = f"QualityReq rq : safety\n    Move takes at most 120 ms\n{MAIN}"

    def taken(line: Line) -> None:
        assert line.robot is not None
        line.robot.change(2, 2)
        line.robot.drain()

    judged = Judged(tmp_path, mission, ["1R 2R", taken, "", "", "", "3R", "3S 1S", ""])
    assert judged.violations == []
    assert judged.clause.verdict == "unknown"


def test_a_robot_that_restarts_with_the_same_tree_goes_on(tmp_path: Path) -> None:
    mission = f"QualityReq rq : safety\n    Move takes at most 120 ms\n{MAIN}"

    def restart(line: Line) -> None:
        line.robot = line.another()

    judged = Judged(tmp_path, mission, [f"1R 2R {END}", "", restart, f"1R 2R {END}", ""])
    assert [text for _, verdict, text in judged.news if verdict is None] == [
        "mission main (as built now, 3 of 3 nodes)",
        "run 1 succeeded after 0 ms",
        "the robot has been started again",
        "run 2 succeeded after 0 ms",
    ]
    ((source,),) = [each.sources for each in judged.found.report.missions]
    assert (source.runs, judged.clause.counted) == (2, 2)
