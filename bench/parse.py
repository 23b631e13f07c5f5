"""How fast parsers read the same mission: btq and every installed peer, in one run.

One invariant: only figures of one run are compared.  Every parser has a process of its own (worker.py), and the
processes take turns, a parse each, so that a busy minute of the machine hits all of them.  Figures are medians; how
many times one parser is faster than another is the median over the rounds, each compared with itself: on a machine with
neighbours a round may take twice as long as the next, and the quotient of two medians then says little.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import ceilings
import missions

HERE = Path(__file__).parent

Memory = Literal["traced", "resident"]


@dataclass(frozen=True)
class Tool:
    """A parser to measure.

    Attributes:
        command: starts its worker.
        reads: the file of the mission it reads: classic, short, json or xml.
        memory: how its memory is measured: `traced` where its trees are Python objects, else `resident`.
        ours: a form of btq, which the others are compared with.
        quadratic: not asked for 100 000 nodes, and for 10 000 in three rounds only.
    """

    name: str
    command: tuple[str, ...]
    reads: str = "classic"
    memory: Memory = "traced"
    ours: bool = False
    quadratic: bool = False


@dataclass
class Result:
    """What was measured of one parser; `seconds` by number of nodes, `growth` from 10 000 to 100 000."""

    tool: Tool
    version: str
    seconds: dict[int, list[float]] = field(default_factory=dict)
    growth: list[float] = field(default_factory=list)
    peak: dict[str, float] = field(default_factory=dict)

    def median(self, nodes: int) -> float:
        return statistics.median(self.seconds[nodes])

    def rate(self, nodes: int) -> float:
        return nodes / statistics.median(self.seconds[nodes])

    def best_rate(self, nodes: int) -> float:
        return nodes / min(self.seconds[nodes])

    def times(self, other: Result) -> float:
        """How many times faster than another it is, round by round."""
        rounds = zip(other.seconds[MIDDLE], self.seconds[MIDDLE], strict=False)  # the quadratic have fewer
        return statistics.median(theirs / own for theirs, own in rounds)

    def scaling(self) -> float | None:
        return statistics.median(self.growth) if self.growth else None


@dataclass(frozen=True)
class Goal:
    """A figure that btq must reach, with the figure reached."""

    text: str
    reached: float
    met: bool


SMALL, MIDDLE, LARGE = 500, 10_000, 100_000
FEW = 3  # rounds, where one takes long


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print; the exit code says nothing about speed."""
    options = _options(arguments)
    with tempfile.TemporaryDirectory() as folder:
        sizes = [SMALL, MIDDLE] if options.quick else [SMALL, MIDDLE, LARGE]
        files = write_missions(Path(folder), sizes, options.seed)
        results, missing = measure(tools(options.python), files, options.rounds, options.only)
    goals = compare(results)
    if options.json:
        print(json.dumps(as_data(results, missing, goals, options), indent=2))
    else:
        print(as_text(results, missing, goals))


def tools(pythons: Sequence[str] = ()) -> list[Tool]:
    """Every parser that can be measured; `pythons` have further installations of btq, a compiled one for example."""
    found = []
    for python in (sys.executable, *pythons):
        form = _form(python)
        found += [
            Tool(f"btq, {form}", _worker("with_btq", python), ours=True),
            Tool(f"btq, {form}, short spelling", _worker("with_btq", python), reads="short", ours=True),
            Tool(f"btq, {form}, with all tokens", _worker("with_btq_tokens", python), ours=True),
        ]
    langium = ("node", "--expose-gc", str(HERE / "parsers" / "langium" / "worker.mjs"))
    return [
        *found,
        Tool("textX", _worker("with_textx")),
        Tool("Lark LALR", _worker("with_lark")),
        Tool("Langium as shipped", (*langium, "shipped"), memory="resident", quadratic=True),
        Tool("Langium mended", (*langium, "mended"), memory="resident"),
        Tool("tree-sitter", _worker("with_tree_sitter"), memory="resident"),
        Tool("json.loads", _worker("with_json"), reads="json"),
        Tool("lxml", _worker("with_lxml"), reads="xml", memory="resident"),
    ]


def write_missions(folder: Path, sizes: Sequence[int], seed: int) -> dict[tuple[str, int], Path]:
    """The same mission in every form that a tool reads, by (form, nodes)."""
    files = {}
    for nodes in sizes:
        plan = missions.plan(nodes, seed)
        texts = {
            "classic": missions.write(plan, "classic"),
            "short": missions.write(plan, "short"),
            "json": ceilings.as_json(plan),
            "xml": ceilings.as_xml(plan),
        }
        for form, text in texts.items():
            files[form, nodes] = folder / f"{nodes}.{form}"
            files[form, nodes].write_text(text, encoding="utf-8")
    return files


def measure(
    chosen: Sequence[Tool], files: dict[tuple[str, int], Path], rounds: int, only: str = ""
) -> tuple[list[Result], dict[str, str]]:
    """Measure the tools that are there.

    Returns:
        A result for each, and why the others are missing.
    """
    missing = {}
    results = []
    workers = {}
    for tool in chosen:
        if only and only.lower() not in tool.name.lower() and not tool.ours:
            continue
        worker = _Worker(tool)
        if "missing" in worker.hello:
            missing[tool.name] = worker.hello["missing"]
            worker.close()
        else:
            results.append(Result(tool, worker.hello["version"]))
            workers[tool.name] = worker
    _measure_speed(results, workers, files, SMALL, rounds, repeat=3)
    _measure_speed(results, workers, files, MIDDLE, rounds, repeat=1)
    if (results[0].tool.reads, LARGE) in files:
        _measure_growth([result for result in results if not result.tool.quadratic], workers, files)
    for worker in workers.values():
        worker.close()
    for result in results:
        _progress(f"memory of {result.tool.name}")
        for how in ("traced", "resident") if "worker.py" in " ".join(result.tool.command) else ("resident",):
            result.peak[how] = _peak(result.tool, how, files) / MIDDLE
    _progress("")
    return results, missing


def _measure_speed(
    results: Sequence[Result],
    workers: dict[str, _Worker],
    files: dict[tuple[str, int], Path],
    nodes: int,
    rounds: int,
    repeat: int,
) -> None:
    for result in results:  # a first parse is for caches
        workers[result.tool.name].time(files[result.tool.reads, nodes], nodes, repeat)
    for turn in range(rounds):
        _progress(f"{nodes} nodes, round {turn + 1} of {rounds}")
        for result in _rotated(results, turn):
            if result.tool.quadratic and nodes == MIDDLE and turn >= FEW:
                continue
            times = workers[result.tool.name].time(files[result.tool.reads, nodes], nodes, repeat)
            result.seconds.setdefault(nodes, []).extend(times)


def _measure_growth(results: Sequence[Result], workers: dict[str, _Worker], files: dict[tuple[str, int], Path]) -> None:
    """100 000 nodes, with 10 000 right before and after: a quotient over minutes would measure the neighbours."""
    for turn in range(FEW):
        _progress(f"{LARGE} nodes, round {turn + 1} of {FEW}")
        for result in _rotated(results, turn):
            middle, large, again = (
                workers[result.tool.name].time(files[result.tool.reads, nodes], nodes, 1)[0]
                for nodes in (MIDDLE, LARGE, MIDDLE)
            )
            result.seconds.setdefault(LARGE, []).append(large)
            result.growth.append(2 * large / (middle + again))


def _rotated(results: Sequence[Result], turn: int) -> list[Result]:
    start = turn % len(results)
    return [*results[start:], *results[:start]]


class _Worker:
    """A worker process, asked by lines and answering by lines."""

    def __init__(self, tool: Tool) -> None:
        self.tool = tool
        self._process: subprocess.Popen[str] | None = None
        try:
            self._process = subprocess.Popen(tool.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        except FileNotFoundError:
            self.hello: dict[str, str] = {"missing": f"`{tool.command[0]}` is not installed"}
        else:
            self.hello = self._read()

    def time(self, file: Path, nodes: int, repeat: int) -> list[float]:
        answer = self._ask({"do": "time", "path": str(file), "repeat": repeat}, nodes)
        seconds: list[float] = answer["seconds"]
        return seconds

    def peak(self, how: Memory, file: Path, nodes: int) -> int:
        peak: int = self._ask({"do": how, "path": str(file)}, nodes)["bytes"]
        return peak

    def close(self) -> None:
        if self._process is not None:
            self._process.communicate()

    def _ask(self, request: dict[str, object], nodes: int) -> dict[str, Any]:
        assert self._process is not None
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()
        answer = self._read()
        if answer["nodes"] != nodes:
            raise SystemExit(f"{self.tool.name} found {answer['nodes']} nodes in a mission of {nodes}")
        return answer

    def _read(self) -> dict[str, Any]:
        assert self._process is not None
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise SystemExit(f"{self.tool.name} ended without an answer")
        answer: dict[str, Any] = json.loads(line)
        return answer


def _peak(tool: Tool, how: Memory, files: dict[tuple[str, int], Path]) -> int:
    """The peak of one parse in a new process, where a small mission was parsed before: it loads what is loaded late."""
    worker = _Worker(tool)
    worker.time(files[tool.reads, SMALL], SMALL, 1)
    peak = worker.peak(how, files[tool.reads, MIDDLE], MIDDLE)
    worker.close()
    return peak


def _worker(module: str, python: str = sys.executable) -> tuple[str, ...]:
    return (python, str(HERE / "worker.py"), module)


def _form(python: str) -> str:
    """Whether the btq of an installation is `pure` or `compiled`; `not installed` where it cannot be imported."""
    worker = _Worker(Tool("btq", _worker("with_btq", python)))
    worker.close()
    return worker.hello.get("form", "not installed")


def _progress(text: str) -> None:
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


# ---- what the figures mean ------------------------------------------------------------------------------------------


def compare(results: Sequence[Result]) -> list[Goal]:
    """The goals of docs/performance.md that this run can say something about."""
    by_name = {result.tool.name: result for result in results}
    goals = []
    pure, compiled = by_name.get("btq, pure"), by_name.get("btq, compiled")
    if pure:
        goals.append(_at_least("pure: nodes/s", pure.rate(MIDDLE), 120_000))
        for peer, factor in (("textX", 30), ("Lark LALR", 10), ("Langium mended", 3)):
            if peer in by_name:
                goals.append(_at_least(f"pure: times {peer}", pure.times(by_name[peer]), factor))
        goals.append(_at_most("pure: peak bytes/node", pure.peak["traced"], 1_500))
        if (scaling := pure.scaling()) is not None:
            goals.append(_at_most("pure: 100 000 nodes, in times of 10 000", scaling, 11))
        goals.append(_at_most("pure: ms for 500 nodes", 1000 * pure.median(SMALL), 5))
    if compiled:
        goals.append(_at_least("compiled: nodes/s", compiled.rate(MIDDLE), 600_000))
        if "tree-sitter" in by_name:
            goals.append(_at_least("compiled: times tree-sitter", compiled.times(by_name["tree-sitter"]), 2))
    return goals


def _at_least(what: str, reached: float, wanted: float) -> Goal:
    return Goal(f"{what} >= {wanted:,}", reached, reached >= wanted)


def _at_most(what: str, reached: float, wanted: float) -> Goal:
    return Goal(f"{what} <= {wanted:,}", reached, reached <= wanted)


def as_text(results: Sequence[Result], missing: dict[str, str], goals: Sequence[Goal]) -> str:
    """Tables in Markdown."""
    references = _references(results)
    lines = [
        f"Python {platform.python_version()}, {os.cpu_count()} cores, {platform.system()} {platform.machine()}; "
        f"load {_load()} over 15 minutes; {MIDDLE:,} nodes unless said otherwise; medians.",
        "",
        _row(
            "parser",
            "version",
            "nodes/s",
            "best",
            *(f"{reference.tool.name}, is faster" for reference in references),
            "peak B/node",
            "500 nodes",
            "100 000 / 10 000",
        ),
    ]
    lines.append("|" + "---|" * (lines[-1].count("|") - 1))
    for result in results:
        scaling = result.scaling()
        lines.append(
            _row(
                result.tool.name,
                result.version,
                f"{_round(result.rate(MIDDLE)):,}",
                f"{_round(result.best_rate(MIDDLE)):,}",
                *(f"{reference.times(result):.2f}×" for reference in references),
                f"{_round(result.peak[result.tool.memory]):,} {result.tool.memory}",
                f"{1000 * result.median(SMALL):.1f} ms",
                f"{scaling:.1f}" if scaling else "not measured",
            )
        )
    lines += ["", *(f"Left out: {name}: {why}" for name, why in missing.items())]
    lines += [f"{'met   ' if goal.met else 'MISSED'}  {goal.text}: {goal.reached:,.1f}" for goal in goals]
    return "\n".join(lines)


def _load() -> str:
    """How many processes wanted a core, this benchmark among them: much over 1, and figures are worth less."""
    return f"{os.getloadavg()[2]:.1f}"


def _references(results: Sequence[Result]) -> list[Result]:
    """The forms of btq that the others are compared with: no spellings, no extras."""
    return [result for result in results if result.tool.ours and result.tool.name.count(",") == 1]


def _row(*cells: str) -> str:
    return f"| {' | '.join(cells)} |"


def _round(value: float) -> int:
    """Three figures: the machine vouches for no more."""
    return int(float(f"{value:.3g}"))


def as_data(
    results: Sequence[Result], missing: dict[str, str], goals: Sequence[Goal], options: argparse.Namespace
) -> dict[str, object]:
    """Everything that was measured, for machines."""
    return {
        "python": platform.python_version(),
        "platform": platform.platform(),
        "cores": os.cpu_count(),
        "load": os.getloadavg(),
        "seed": options.seed,
        "tools": [
            {
                "name": result.tool.name,
                "version": result.version,
                "reads": result.tool.reads,
                "nodes_per_second": result.rate(MIDDLE),
                "seconds": result.seconds,
                "faster": {reference.tool.name: reference.times(result) for reference in _references(results)},
                "peak_bytes_per_node": result.peak,
                "peak_measured_by": result.tool.memory,
                "scaling": result.scaling(),
                "growth": result.growth,
            }
            for result in results
        ],
        "missing": missing,
        "goals": [{"goal": goal.text, "reached": goal.reached, "met": goal.met} for goal in goals],
    }


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=11, help="parses of each tool at each size (default 11)")
    parser.add_argument("--quick", action="store_true", help="leave the 100 000 nodes out")
    parser.add_argument("--only", default="", metavar="TEXT", help="beside btq, only peers with TEXT in their name")
    parser.add_argument("--python", action="append", default=[], help="a further Python that has btq, perhaps compiled")
    parser.add_argument("--seed", type=int, default=missions.SEED)
    parser.add_argument("--json", action="store_true", help="print JSON with every single time")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    main()
