"""How long the language server takes, driven over standard input and output as an editor drives it.

One invariant: a message is sent when all answers to the one before have come, and what counts is the time to the last
answer that it asks for: diagnostics are those of the version that was sent.  Processor time is that of the server's
process and of nobody else, so it tells little of what else the machine does; time by the clock tells all of it.  The
typing is drawn from a seed, so every run types the same.

The goals are for a machine where a server of pygls without features answers `initialize` after `PYGLS_ALONE`.  So that
is measured each time, and times that are held against goals are converted: on a machine that takes twice as long for
it, 60 ms count as 30.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import missions
import report
from btcpp_xml import built
from report import ENVIRONMENT, Goal
from robot_log import FETCH, fetching

from evidence_logs import btlog  # isort: skip

from btq_lang.btcpp.document import write

FILES, NODES_A_FILE, LARGE = 100, 500, 10_000
EDIT = {NODES_A_FILE: 16, LARGE: 50}  # nodes of a file of many trees, and the milliseconds to its diagnostics
QUESTION, ALL_TOKENS, TOKEN_DELTA = 20, 150, 20  # milliseconds
XML_NODES, XML_EDIT = 2_000, 50  # nodes of an XML file of many trees, and the milliseconds to its diagnostics
MEMORY = 60  # MB above pygls alone
LOGGED, COPIES = 1_000_000, 112  # transitions of a log, of 9 bytes each, and how many such logs there are
MANY, NODES_OF_MANY = 1_000, 50
ONE_TREE = {1_000: 60, 5_000: 250, 40_000: 2_000}  # nodes below one node, and the milliseconds that a key may take

PYGLS_ALONE = 0.428  # seconds by the clock

BTQ = (sys.executable, "-c", "from btq_lang.server import main; main(['--stdio'])")
BARE = (
    sys.executable,
    "-c",
    "from pygls.lsp.server import LanguageServer; LanguageServer('bare', '1').start_io()",
)

Message = dict[str, Any]


@dataclass(eq=False)
class Series:
    """What one kind of message took, in seconds: by the clock, and of the server's processor time."""

    name: str
    wall: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print; the exit code says nothing about speed."""
    options = _options(arguments)
    measured, goals = starts(options.starts)
    slowness = min(measured[0].wall) / PYGLS_ALONE
    parts: dict[str, Callable[[], tuple[list[Series], list[Goal]]]] = {
        "edits": lambda: typing(FILES, NODES_A_FILE, options, slowness),
        "large": lambda: typing(1, LARGE, options, slowness),
        "tree": lambda: one_tree(options, slowness),
        "xml": lambda: typing_xml(options, slowness),
        "many": lambda: many_files(options.spelling, slowness),
        "logs": lambda: typing_beside_logs(options),
    }
    for part, measure in parts.items():
        if options.only in (None, part):
            series, reached = measure()
            measured += series
            goals += reached
    times = [{"name": one.name, "wall_seconds": one.wall, "cpu_seconds": one.cpu} for one in measured]
    data = report.as_data({"series": times, "slowness": slowness}, goals)
    print(json.dumps(data, indent=2) if options.json else as_text(measured, goals, slowness))


# ---- what is measured -----------------------------------------------------------------------------------------------


def starts(rounds: int) -> tuple[list[Series], list[Goal]]:
    """From the start of the process to the answer to `initialize`, beside a server of pygls without features."""
    bare, btq = Series("start, pygls alone"), Series("start, btq-lsp")
    with tempfile.TemporaryDirectory() as folder:
        for turn in range(rounds + 1):
            for series, command in ((bare, BARE), (btq, BTQ)):
                begun = time.perf_counter()
                server = Server(command, Path(folder))
                if turn:  # the first one of each fills the caches of the disk
                    series.wall.append(time.perf_counter() - begun)
                    series.cpu.append(server.processor_time())
                server.end()
    quotient = statistics.median(ours / theirs for ours, theirs in zip(btq.cpu, bare.cpu, strict=True))
    return [bare, btq], [Goal("start in times of pygls alone, processor <= 1.15", quotient, quotient <= 1.15)]


def typing(files: int, nodes: int, options: argparse.Namespace, slowness: float) -> tuple[list[Series], list[Goal]]:
    """What an author does in one file of a folder: type, and ask.  It is done several times, each with a server of its
    own, and of each message the least counts: what the machine does besides comes at another one the next time."""
    runs = [_typed(files, nodes, options) for _ in range(options.repeats)]
    measured = [_least([series[at] for series, _, _ in runs]) for at in range(len(runs[0][0]))]
    edits, completion, hover, definition, first, full, delta = measured
    allowed = {edits: EDIT[nodes], completion: QUESTION, hover: QUESTION, definition: QUESTION}
    allowed |= {first: ALL_TOKENS, full: ALL_TOKENS, delta: TOKEN_DELTA}
    goals = [_by_the_clock(one, limit, slowness) for one, limit in allowed.items()]
    if nodes < LARGE:
        for when, at in (("when all is checked", 1), ("in the end", 2)):
            most = max(run[at] for run in runs)
            text = f"memory above pygls alone, {files} files of {nodes} nodes, {when}: MB <= {MEMORY}"
            goals.append(Goal(text, most, most <= MEMORY))
    return measured, goals


def _by_the_clock(series: Series, limit: int, slowness: float) -> Goal:
    taken = 1000 * percentile(series.wall, 99) / slowness
    return Goal(f"{series.name}: p99 ms by the clock, converted, <= {limit}", taken, taken <= limit)


def _least(runs: Sequence[Series]) -> Series:
    """Of the same messages in several runs, what each took at least."""
    wall = [min(times) for times in zip(*(one.wall for one in runs), strict=True)]
    return Series(runs[0].name, wall, [min(times) for times in zip(*(one.cpu for one in runs), strict=True)])


def _typed(files: int, nodes: int, options: argparse.Namespace) -> tuple[list[Series], float, float]:
    """One run of it; the megabytes above pygls alone when all is checked, and in the end."""
    size = f"{nodes:,} nodes".replace(",", " ")
    asked = ("completion", "hover", "definition", "first tokens", "all tokens", "token delta")
    edits, completion, hover, definition, first, full, delta = (
        Series(f"{what}, {size}") for what in ("edit to diagnostics", *asked)
    )
    draw = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for number in range(files):
            text = missions.mission(nodes, number + 1, options.spelling)
            (folder / f"mission{number:03}.btq").write_text(text, encoding="utf-8")
        server = Server(BTQ, folder)
        document = server.open(folder / "mission000.btq")
        server.wait_for(is_about(folder / "mission000.btq"))
        with server.measuring(first):
            full_id = server.request("textDocument/semanticTokens/full", textDocument=document.name)["resultId"]
        if files > 1:
            server.wait_for(is_end_of_progress)
        bare = _memory_of_bare(folder)
        memory = server.memory() - bare
        for _ in range(options.rounds):
            for edit in strokes(document, draw):
                with server.measuring(edits):
                    server.change(document, edit)
            at = document.position(draw.choice(document.words()))
            place = {"textDocument": document.name, "position": at}
            with server.measuring(delta):
                answer = server.request(
                    "textDocument/semanticTokens/full/delta", textDocument=document.name, previousResultId=full_id
                )
            full_id = answer["resultId"]
            for series, method in (
                (completion, "textDocument/completion"),
                (hover, "textDocument/hover"),
                (definition, "textDocument/definition"),
            ):
                with server.measuring(series):
                    server.request(method, **place)
            with server.measuring(full):
                server.request("textDocument/semanticTokens/full", textDocument=document.name)
            full_id = server.request("textDocument/semanticTokens/full", textDocument=document.name)["resultId"]
        in_the_end = server.memory() - bare
        server.end()
    return [edits, completion, hover, definition, first, full, delta], memory, in_the_end


def one_tree(options: argparse.Namespace, slowness: float) -> tuple[list[Series], list[Goal]]:
    """From a key to what it asks for, in a file that is one flat tree: its diagnostics, or a completion before them."""
    measured, goals = [], []
    for nodes, limit in ONE_TREE.items():
        for asks in (True, False) if nodes == min(ONE_TREE) else (True,):
            keys = _least([_keys_in_one_tree(nodes, asks=asks) for _ in range(options.repeats)])
            measured.append(keys)
            goals.append(_by_the_clock(keys, limit, slowness))
    return measured, goals


def _keys_in_one_tree(nodes: int, *, asks: bool) -> Series:
    """A node is typed in the middle of a tree, after it has been checked as it was; all is checked after each key."""
    size = f"{nodes:,} nodes".replace(",", " ")
    keys = Series(f"{'key to completion' if asks else 'edit to diagnostics'}, one tree of {size}")
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "mission.btq"
        lines = "".join(f"        Action Step{number} (level = {number})\n" for number in range(nodes))
        path.write_text(f"BehaviorTree Main\n    ->\n{lines}", encoding="utf-8")
        server = Server(BTQ, Path(name))
        document = server.open(path)
        server.wait_for(is_about(path))
        at = document.text.index("\n", len(document.text) // 2)
        for index, letter in enumerate("\n        Charge (level = 80)"):
            with server.measuring(keys):
                server.type(document, Stroke(at + index, 0, letter))
                place = {"textDocument": document.name, "position": document.position(at + index + 1)}
                if asks:
                    server.request("textDocument/completion", **place)
                else:
                    server.wait_for(is_of(document))
            if asks:
                server.wait_for(is_of(document))
        server.end()
    return keys


def typing_xml(options: argparse.Namespace, slowness: float) -> tuple[list[Series], list[Goal]]:
    """What an author types in one XML file, alone in its folder: after most keys in a tag it is not well-formed."""
    edits = _least([_typed_in_xml(options) for _ in range(options.repeats)])
    return [edits], [_by_the_clock(edits, XML_EDIT, slowness)]


def _typed_in_xml(options: argparse.Namespace) -> Series:
    size = f"{XML_NODES:,} nodes".replace(",", " ")
    edits = Series(f"edit to diagnostics, XML of {size}")
    draw = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "mission.xml"
        mission = missions.mission(XML_NODES, missions.SEED, options.spelling)
        path.write_text(write(built(mission)), encoding="utf-8")
        server = Server(BTQ, Path(name))
        document = server.open(path)
        server.wait_for(is_about(path))
        for _ in range(options.rounds):
            for edit in strokes(document, draw, IN_XML):
                with server.measuring(edits):
                    server.change(document, edit)
        server.end()
    return edits


def many_files(spelling: missions.Spelling, slowness: float) -> tuple[list[Series], list[Goal]]:
    """A folder of 1 000 files: when what is open is told, and when all is, with progress meanwhile."""
    first, whole = Series(f"first diagnostics, {MANY:,} files"), Series(f"all diagnostics, {MANY:,} files")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for number in range(MANY):
            text = missions.mission(NODES_OF_MANY, number, spelling)
            (folder / f"mission{number:04}.btq").write_text(text, encoding="utf-8")
        server = Server(BTQ, folder)
        begun, cpu = time.perf_counter(), server.processor_time()
        opened = folder / "mission0500.btq"
        server.open(opened)
        server.wait_for(is_about(opened))
        first.wall.append(time.perf_counter() - begun)
        first.cpu.append(server.processor_time() - cpu)
        reports = 0
        while server.wait_for(is_progress)["params"]["value"]["kind"] != "end":
            reports += 1
        whole.wall.append(time.perf_counter() - begun)
        whole.cpu.append(server.processor_time() - cpu)
        server.end()
    quotient = first.wall[0] / whole.wall[0]
    cpu = whole.cpu[0] / slowness
    return [first, whole], [
        Goal(f"{MANY} files: what is open is told, in times of the whole, < 0.5", quotient, quotient < 0.5),
        Goal(f"{MANY} files: all, s of processor, converted, <= 10", cpu, cpu <= 10),
        Goal(f"{MANY} files: reports of progress >= 3", reports, reports >= 3),
    ]


def typing_beside_logs(options: argparse.Namespace) -> tuple[list[Series], list[Goal]]:
    """What an author types in a mission: without logs, with logs that are judged, and while a gigabyte of them is."""
    measured: list[Series] = []
    with tempfile.TemporaryDirectory() as name:
        for folder, transitions, copies in ((None, 0, 0), ("judged", LOGGED // 10, 1), ("judging", LOGGED, COPIES)):
            root = Path(name) / (folder or "none")
            (root / "logs").mkdir(parents=True)
            (root / "main.btq").write_text(_LEAF.sub("", FETCH), encoding="utf-8")
            if folder is not None:
                (root / "btq.toml").write_text('[evidence]\nlogs = ["logs"]\n', encoding="utf-8")
                robot = fetching()
                (root / "logs" / "0.btlog").write_bytes(btlog(robot.xml, robot.rows(transitions)))
            for copy in range(1, copies):
                os.link(root / "logs" / "0.btlog", root / "logs" / f"{copy}.btlog")
            size = sum(path.stat().st_size for path in (root / "logs").iterdir()) / 1e6
            what = f"{size:.0f} MB of logs that are being judged" if folder == "judging" else f"{size:.0f} MB of logs"
            edits = Series(f"edit to diagnostics, {what}")
            server = Server((*BTQ[:2], f"import os; os.environ['XDG_CACHE_HOME'] = {str(root)!r}; {BTQ[2]}"), root)
            document = server.open(root / "main.btq")
            server.wait_for(is_about(root / "main.btq"))
            if folder is not None:
                server.wait_for(is_progress if folder == "judging" else is_end_of_progress)
            draw = random.Random(options.seed)
            for _ in range(options.rounds):
                for edit in strokes(document, draw):
                    with server.measuring(edits):
                        server.change(document, edit)
            server.end()
            measured.append(edits)
    without, *with_logs = (statistics.median(one.cpu) for one in measured)
    return measured, [
        Goal(f"{one.name}: processor in times of that without, <= 1.2", median / without, median / without <= 1.2)
        for one, median in zip(measured[1:], with_logs, strict=True)
    ]


_LEAF = re.compile(r"(?<=        )(?:Action|Condition) ")  # in a tree, where the author types without them


# ---- typing ---------------------------------------------------------------------------------------------------------


@dataclass
class Document:
    """An open file as the editor has it."""

    uri: str
    text: str
    version: int = 1

    @property
    def name(self) -> Message:
        return {"uri": self.uri}

    def position(self, offset: int) -> Message:
        start = self.text.rfind("\n", 0, offset) + 1
        return {"line": self.text.count("\n", 0, offset), "character": offset - start}

    def words(self) -> list[int]:
        """Offsets inside names, of nodes, trees and requirements."""
        return [match.start() + 1 for match in _WORD.finditer(self.text)]


@dataclass(frozen=True)
class Stroke:
    """What one change of the text is: so much gone at an offset, and something else there."""

    offset: int
    gone: int
    text: str


@dataclass(frozen=True)
class Typing:
    """What is typed in a language.

    Attributes:
        after: the lines after which nodes are typed; `blanks` is their indentation.
        node: the line that is typed.
        values: what a digit is typed behind, as `it`.
    """

    after: re.Pattern[str]
    node: str
    values: tuple[re.Pattern[str], ...]


IN_BTQ = Typing(
    re.compile(r"^(?P<blanks>[ \t]{8,})[A-Z]\w+(?: \([^()\n]*\))?(?=\n)", re.MULTILINE),
    "Charge (level = 80)",
    (
        re.compile(r" = (?P<it>[0-9]+)"),
        re.compile(r" at most (?P<it>[0-9]+)"),
        re.compile(r"^BehaviorTree (?P<it>\w+)", re.MULTILINE),
    ),
)
IN_XML = Typing(
    re.compile(r"^(?P<blanks>[ \t]{4,})<[^<>]*/>(?=\n)", re.MULTILINE),
    '<Charge level="80"/>',
    (re.compile(r' [a-z_]+="(?P<it>[0-9]+)"'), re.compile(r'<BehaviorTree ID="(?P<it>\w+)"')),
)


def strokes(document: Document, draw: random.Random, typing: Typing = IN_BTQ) -> Iterator[Stroke]:
    """What an author types in one go: a new node behind another, letter by letter, and a value; sometimes the name of
    a tree, or the bound of a requirement.  In the end all of it is taken back, so that the file stays as large."""
    before = document.text
    line = draw.choice(list(typing.after.finditer(before)))
    typed = f"\n{line['blanks']}{typing.node}"
    for index, letter in enumerate(typed):
        yield Stroke(line.end() + index, 0, letter)
    yield Stroke(line.end(), len(typed), "")
    for pattern in typing.values:
        place = draw.choice([match.span("it") for match in pattern.finditer(before)] or [(0, 0)])
        if place[1]:
            yield Stroke(place[1], 0, "1")
            yield Stroke(place[1], 1, "")


_WORD = re.compile(r"\b[A-Z]\w{3,}")


# ---- the server at the other end ------------------------------------------------------------------------------------


class Server:
    """A server and the editor's end of it: the editor takes whatever the server offers, and answers what it asks."""

    def __init__(self, command: tuple[str, ...], root: Path) -> None:
        # Not in a checkout: there `python -c` would import that, and not the package that is installed.
        self.process = subprocess.Popen(
            command, cwd=root, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=ENVIRONMENT
        )
        assert self.process.stdin is not None, "it is a pipe"
        assert self.process.stdout is not None, "as above"
        self._to, self._from = self.process.stdin, self.process.stdout
        self._count = 0
        self._kept: list[Message] = []
        capabilities = {
            "window": {"workDoneProgress": True},
            "textDocument": {
                "completion": {"completionItem": {"snippetSupport": True}},
                "semanticTokens": {
                    "requests": {"full": {"delta": True}},
                    "tokenTypes": [],
                    "tokenModifiers": [],
                    "formats": ["relative"],
                },
            },
        }
        answer = self.request("initialize", capabilities=capabilities, rootUri=root.as_uri(), processId=None)
        sync = answer["capabilities"].get("textDocumentSync", 1)
        self.takes_parts = (sync["change"] if isinstance(sync, dict) else sync) == 2
        self.notify("initialized")

    def open(self, path: Path) -> Document:
        document = Document(path.as_uri(), path.read_text(encoding="utf-8"))
        item = {"uri": document.uri, "languageId": path.suffix[1:], "version": 1, "text": document.text}
        self.notify("textDocument/didOpen", textDocument=item)
        return document

    def change(self, document: Document, stroke: Stroke) -> None:
        """Type, and wait for the diagnostics of what is typed."""
        self.type(document, stroke)
        self.wait_for(is_of(document))

    def type(self, document: Document, stroke: Stroke) -> None:
        """Change a document, here and there."""
        end = stroke.offset + stroke.gone
        change: Message = {"text": stroke.text}
        if self.takes_parts:
            change["range"] = {"start": document.position(stroke.offset), "end": document.position(end)}
        document.text = document.text[: stroke.offset] + stroke.text + document.text[end:]
        document.version += 1
        if not self.takes_parts:
            change["text"] = document.text
        name = {"uri": document.uri, "version": document.version}
        self.notify("textDocument/didChange", textDocument=name, contentChanges=[change])

    def request(self, method: str, **params: Any) -> Any:
        self._count += 1
        self._send(id=self._count, method=method, params=params)
        while (message := self._receive()).get("id") != self._count:
            self._kept.append(message)
        if "error" in message:
            raise SystemExit(f"{method} is refused: {message['error']}")
        return message["result"]

    def notify(self, method: str, **params: Any) -> None:
        self._send(method=method, params=params)

    def wait_for(self, is_wanted: Callable[[Message], bool]) -> Message:
        for index, message in enumerate(self._kept):
            if is_wanted(message):
                del self._kept[: index + 1]
                return message
        self._kept.clear()
        while not is_wanted(message := self._receive()):
            pass
        return message

    @contextmanager
    def measuring(self, series: Series) -> Iterator[None]:
        cpu, wall = self.processor_time(), time.perf_counter()
        yield
        series.wall.append(time.perf_counter() - wall)
        series.cpu.append(self.processor_time() - cpu)

    def processor_time(self) -> float:
        """Seconds of processor that the process has had, to the nanosecond, of all its threads (Linux)."""
        tasks = Path(f"/proc/{self.process.pid}/task").iterdir()
        return sum(int((task / "schedstat").read_text().split()[0]) for task in tasks) / 1e9

    def memory(self) -> float:
        """The megabytes that the process has resident (Linux)."""
        pages = int(Path(f"/proc/{self.process.pid}/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") / 1e6

    def end(self) -> None:
        self.request("shutdown")
        self.notify("exit")
        self.process.wait(timeout=30)
        self._to.close()
        self._from.close()

    def _send(self, **message: Any) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self._to.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self._to.flush()

    def _receive(self) -> Message:
        """The next message that is not a request of the server's; those are answered."""
        while True:
            length = 0
            while (line := self._from.readline()) not in (b"\r\n", b""):
                if line.lower().startswith(b"content-length:"):
                    length = int(line.split(b":")[1])
            if not length:
                raise SystemExit("the server has gone")
            message: Message = json.loads(self._from.read(length))
            if "id" not in message or "method" not in message:
                return message
            self._send(id=message["id"], result=None)


_DIAGNOSTICS = "textDocument/publishDiagnostics"


def is_about(path: Path) -> Callable[[Message], bool]:
    """Whether a message tells the diagnostics of a file."""
    uri = path.as_uri()
    return lambda message: message.get("method") == _DIAGNOSTICS and message["params"]["uri"] == uri


def is_of(document: Document) -> Callable[[Message], bool]:
    """Whether a message tells the diagnostics of a document as it is now."""
    now = document.uri, document.version
    return lambda message: (
        message.get("method") == _DIAGNOSTICS and (message["params"]["uri"], message["params"].get("version")) == now
    )


def is_progress(message: Message) -> bool:
    return message.get("method") == "$/progress"


def is_end_of_progress(message: Message) -> bool:
    return is_progress(message) and message["params"]["value"]["kind"] == "end"


def _memory_of_bare(folder: Path) -> float:
    server = Server(BARE, folder)
    memory = server.memory()
    server.end()
    return memory


# ---- the report -----------------------------------------------------------------------------------------------------


def percentile(times: Sequence[float], percent: int) -> float:
    """The time that so many percent of the others do not exceed."""
    ordered = sorted(times)
    return ordered[min(len(ordered) - 1, len(ordered) * percent // 100)]


def as_text(measured: Sequence[Series], goals: Sequence[Goal], slowness: float) -> str:
    """A table in Markdown."""
    lines = [
        report.machine(),
        "",
        "| message | processor ms, p50 | p99 | by the clock ms, p50 | p99 | messages |",
        "|---|---|---|---|---|---|",
    ]
    for series in measured:
        figures = (
            *(percentile(series.cpu, percent) for percent in (50, 99)),
            *(percentile(series.wall, percent) for percent in (50, 99)),
        )
        shown = " | ".join(f"{1000 * figure:.1f}" for figure in figures)
        lines.append(f"| {series.name} | {shown} | {len(series.cpu)} |")
    converted = (
        f"Converted: divided by {slowness:.2f}, as pygls alone takes {slowness:.2f} times {PYGLS_ALONE} s to start."
    )
    return "\n".join([*lines, "", converted, *report.shown(goals)])


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = report.options(__doc__)
    parser.add_argument(
        "--only",
        choices=("start", "edits", "large", "tree", "xml", "many", "logs"),
        help="measure one part, and the start",
    )
    parser.add_argument(
        "--rounds", type=int, default=20, help="how often something is typed, some 30 edits (default 20)"
    )
    parser.add_argument("--repeats", type=int, default=5, help="how often all of that is done (default 5)")
    parser.add_argument("--starts", type=int, default=10, help="how often a server is started (default 10)")
    parser.add_argument("--seed", type=int, default=1, help="another number, other typing")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    main()
