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
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import missions
import report
from btcpp_xml import built
from editor import IN_XML, Series, Server, Stroke, is_about, is_end_of_progress, is_of, is_progress, strokes
from report import Goal
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
        of_checks, of_ends = [checked for _, checked, _ in runs], [end for _, _, end in runs]
        for when, most in (("when all is checked", max(of_checks)), ("in the end", max(of_ends))):
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
    return "\n".join([*lines, "", converted, "", *report.shown(goals)])


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
