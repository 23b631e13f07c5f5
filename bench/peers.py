"""How fast parsers read the synthetic mission, and in how much memory: btq and every installed peer, in one run.

One invariant: only figures of one run are compared.  Figures are medians; how many times one parser is faster than
another is the median over the rounds, each compared with itself: on a machine with neighbours a round may take twice as
long as the next, and the quotient of two medians then says little.
"""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import ceilings
import missions
from forms import Form
from report import Goal
from turns import HERE, ROOT, Memory, Worker, progress, rotated, rounded, row, worker


@dataclass(frozen=True)
class Tool:
    """A parser to measure.

    Attributes:
        command: starts its worker.
        reads: the file of the mission it reads: classic, short, json or xml.
        memory: how its memory is measured: `traced` where its trees are Python objects, else `resident`.
        package: the folder that it imports btq from.
        reference: a form of btq that the others are compared with.
        quadratic: not asked for 100 000 nodes, and for 10 000 in three rounds only.
    """

    name: str
    command: tuple[str, ...]
    reads: str = "classic"
    memory: Memory = "traced"
    package: Path = ROOT
    reference: bool = False
    quadratic: bool = False


@dataclass
class Result:
    """What was measured of one parser; `seconds` by number of nodes, `growth` from 10 000 to 100 000."""

    tool: Tool
    version: str
    seconds: dict[int, list[float]] = field(default_factory=dict)
    growth: list[float] = field(default_factory=list)
    peak: dict[str, float] = field(default_factory=dict)

    def rate(self) -> float:
        """Nodes per second."""
        return MIDDLE / statistics.median(self.seconds[MIDDLE])

    def times(self, other: Result) -> float:
        """How many times faster than another it is, round by round."""
        rounds = zip(other.seconds[MIDDLE], self.seconds[MIDDLE], strict=False)  # the quadratic have fewer
        return statistics.median(theirs / own for theirs, own in rounds)

    def scaling(self) -> float | None:
        return statistics.median(self.growth) if self.growth else None


SMALL, MIDDLE, LARGE = 500, 10_000, 100_000
FEW = 3  # rounds, where one takes long


def tools(forms: Sequence[Form]) -> list[Tool]:
    """Every parser that can be measured."""
    found = []
    for form in forms:
        name, btq = f"btq, {form.name}", worker("with_btq")
        found += [
            Tool(name, btq, package=form.package, reference=True),
            Tool(f"{name}, short spelling", btq, reads="short", package=form.package),
            Tool(f"{name}, with all tokens", worker("with_btq_tokens"), package=form.package),
        ]
    langium = ("node", "--expose-gc", str(HERE / "parsers" / "langium" / "worker.mjs"))
    return [
        *found,
        Tool("textX", worker("with_textx")),
        Tool("Lark LALR", worker("with_lark")),
        Tool("Langium as shipped", (*langium, "shipped"), memory="resident", quadratic=True),
        Tool("Langium mended", (*langium, "mended"), memory="resident"),
        Tool("tree-sitter", worker("with_tree_sitter"), memory="resident"),
        Tool("json.loads", worker("with_json"), reads="json"),
        Tool("lxml", worker("with_lxml"), reads="xml", memory="resident"),
    ]


def write_missions(folder: Path, sizes: Sequence[int]) -> dict[tuple[str, int], Path]:
    """The same mission in every form that a tool reads, by (form, nodes)."""
    files = {}
    for nodes in sizes:
        plan = missions.plan(nodes)
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
    """Measure the tools that are there, beside btq only those with a text in their name.

    Returns:
        A result for each, and why the others are missing.
    """
    missing = {}
    results = []
    workers = {}
    for tool in chosen:
        if only.lower() not in tool.name.lower() and not tool.name.startswith("btq"):
            continue
        started = Worker(tool.command, tool.package)
        if "missing" in started.hello:
            missing[tool.name] = started.hello["missing"]
            started.close()
        else:
            results.append(Result(tool, started.hello["version"]))
            workers[tool.name] = started
    _measure_speed(results, workers, files, SMALL, rounds, repeat=3)
    _measure_speed(results, workers, files, MIDDLE, rounds, repeat=1)
    if (results[0].tool.reads, LARGE) in files:
        _measure_growth([result for result in results if not result.tool.quadratic], workers, files)
    for started in workers.values():
        started.close()
    for result in results:
        progress(f"memory of {result.tool.name}")
        for how in ("traced", "resident") if "worker.py" in " ".join(result.tool.command) else ("resident",):
            result.peak[how] = _peak(result.tool, how, files) / MIDDLE
    progress("")
    return results, missing


def _measure_speed(
    results: Sequence[Result],
    workers: dict[str, Worker],
    files: dict[tuple[str, int], Path],
    nodes: int,
    rounds: int,
    repeat: int,
) -> None:
    for result in results:  # a first parse is for caches
        workers[result.tool.name].time(files[result.tool.reads, nodes], nodes, repeat)
    for turn in range(rounds):
        progress(f"{nodes} nodes, round {turn + 1} of {rounds}")
        for result in rotated(results, turn):
            if result.tool.quadratic and nodes == MIDDLE and turn >= FEW:
                continue
            times = workers[result.tool.name].time(files[result.tool.reads, nodes], nodes, repeat)
            result.seconds.setdefault(nodes, []).extend(times)


def _measure_growth(results: Sequence[Result], workers: dict[str, Worker], files: dict[tuple[str, int], Path]) -> None:
    """100 000 nodes, with 10 000 right before and after: a quotient over minutes would measure the neighbours."""
    for turn in range(FEW):
        progress(f"{LARGE} nodes, round {turn + 1} of {FEW}")
        for result in rotated(results, turn):
            middle, large, again = (
                workers[result.tool.name].time(files[result.tool.reads, nodes], nodes)[0]
                for nodes in (MIDDLE, LARGE, MIDDLE)
            )
            result.growth.append(2 * large / (middle + again))


def _peak(tool: Tool, how: Memory, files: dict[tuple[str, int], Path]) -> int:
    """The peak of one parse in a new process, where a small mission was parsed before: it loads what is loaded late."""
    started = Worker(tool.command, tool.package)
    started.time(files[tool.reads, SMALL], SMALL)
    peak = started.peak(how, files[tool.reads, MIDDLE], MIDDLE)
    started.close()
    return peak


# ---- what the figures mean ------------------------------------------------------------------------------------------


def compare(results: Sequence[Result]) -> list[Goal]:
    """The goals of docs/performance.md that this run can say something about."""
    by_name = {result.tool.name: result for result in results}
    goals = []
    for form, factors in (("interpreted", {"textX": 8, "Lark LALR": 2}), ("compiled", {"tree-sitter": 1})):
        own = by_name.get(f"btq, {form}")
        if own is None:
            continue
        for peer in factors.keys() & by_name.keys():
            times = own.times(by_name[peer])
            goals.append(Goal(f"{form}: times {peer} >= {factors[peer]}", times, times >= factors[peer]))
        peak, scaling = own.peak["traced"], own.scaling()
        goals.append(Goal(f"{form}: peak bytes/node <= 1,500", peak, peak <= 1_500))
        if scaling is not None:
            goals.append(Goal(f"{form}: 100 000 nodes, in times of 10 000 <= 11", scaling, scaling <= 11))
    return goals


def as_text(results: Sequence[Result], missing: dict[str, str]) -> list[str]:
    """A table in Markdown, of 10 000 nodes unless it says otherwise, and what could not be measured."""
    references = [result for result in results if result.tool.reference]
    headings = (
        *("parser", "version", "nodes/s", "best"),
        *(f"{reference.tool.name}, is faster" for reference in references),
        *("peak B/node", "500 nodes", "100 000 / 10 000"),
    )
    lines = [row(*headings), "|---" * len(headings) + "|"]
    for result in results:
        scaling = result.scaling()
        cells = (
            *(result.tool.name, result.version, rounded(result.rate()), rounded(MIDDLE / min(result.seconds[MIDDLE]))),
            *(f"{reference.times(result):.2f}×" for reference in references),
            f"{rounded(result.peak[result.tool.memory])} {result.tool.memory}",
            f"{1000 * statistics.median(result.seconds[SMALL]):.1f} ms",
            f"{scaling:.1f}" if scaling else "",
        )
        lines.append(row(*cells))
    return lines + [f"{name} is not measured: {why}" for name, why in missing.items()]


def as_data(results: Sequence[Result]) -> list[dict[str, object]]:
    """Everything that was measured, for machines."""
    return [
        {
            "name": result.tool.name,
            "version": result.version,
            "reads": result.tool.reads,
            "seconds": result.seconds,
            "peak_bytes_per_node": result.peak,
            "peak_measured_by": result.tool.memory,
            "growth": result.growth,
        }
        for result in results
    ]
