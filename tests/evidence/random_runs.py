"""Random missions with requirements of all kinds, and logs of them: what the model of the engine does, as rows.

The first tick of an action may take a while, before which no row tells that it began.  A log may be one of control
nodes like Nav2's, which do not reset their children and write their rows late, twice or not at all; it may lack all
rows to IDLE, be cut off, and have runs without an end.
"""

from __future__ import annotations

import itertools
import random
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from check_asserts import workspace_of
from random_guards import Guarded
from random_states import of_states
from requirement_problems import problems_of
from simulated_runs import Endless, SimulatedRuns, bare

from btq_lang.btcpp.marks import MARK
from btq_lang.diagnostics.rules import Severity
from btq_lang.evidence.identity import Candidate, Joined, join
from btq_lang.evidence.model import (
    FAILURE,
    IDLE,
    ROOT,
    RUNNING,
    SUCCESS,
    LoggedTree,
    SampleSeries,
)
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.simulator.errors import EngineError
from btq_lang.simulator.nodes import SimulatedNode
from btq_lang.simulator.ticking import halt_node
from btq_lang.workspace.resolved import ResolvedNode

if TYPE_CHECKING:
    from btq_lang.evidence.model import SampleValue, Transition

ACTIONS = ("Move", "Pick", "Look")
START = 1_795_209_740_000_000  # µs since the epoch
MOST_NODES = 40
MOST_ROWS = 300
EXACT = 6.25  # %: its multiples are sums of powers of two as fractions of one, so it does not matter how they are added


@dataclass(frozen=True)
class Case:
    """A mission, and a log of some runs of it.

    Attributes:
        subtrees: the uids of SubTree nodes.
        guards: the nodes that a build has put around others, with the requirement of each.
        delays: how long each Delay waits, in µs.
        sessions: the rows of each, in the order in which they are read.
        samples: by signal, in its own unit.
    """

    text: str
    mission: Candidate
    joined: Joined
    subtrees: frozenset[int]
    guards: dict[int, str]
    delays: dict[int, int]
    sessions: list[list[Transition]]
    samples: dict[str, list[tuple[int, SampleValue]]]

    @property
    def series(self) -> dict[str, SampleSeries]:
        """The samples as a file of them gives them."""
        found = {name: SampleSeries() for name in self.samples}
        for name, values in self.samples.items():
            for time, value in values:
                found[name].add(time, value)
        return found


def case(seed: int) -> Case:
    """The case of a seed: the same in every process."""
    chance = random.Random(seed)
    while True:
        text = mission(chance)
        candidate = Candidate(workspace_of({"main.btq": text}), "main.btq", "main", None)
        problems = [each.diagnostic for each in problems_of(candidate.requirements)]
        assert not any(each.severity == Severity.ERROR for each in problems), (text, problems)
        build = next(candidate.builds())
        elements = [each.element for each, _ in build.running.all]
        written = bare(candidate)
        if len(elements) <= MOST_NODES and is_loaded(written):
            break
    made = as_case(text, candidate)
    tree = made.joined.tree
    now = 0
    sessions: list[list[Transition]] = []
    while not sessions or chance.random() < 0.2:
        now, rows = runs(written, chance, now + 1000)
        rows = as_logged(chance, tree, Guarded(tree, made.guards, chance).of(rows))
        sessions.insert(chance.choice([0, len(sessions)]), rows)  # files may be read in any order
    return replace(made, sessions=sessions, samples=samples(chance, sorted(itertools.chain(*sessions))))


def as_case(text: str, mission: Candidate) -> Case:
    """A mission that has not run yet."""
    build = next(mission.builds())
    elements = [each.element for each, _ in build.running.all]
    joined = join([mission], build.tree())
    assert joined is not None
    assert joined.how == "as built now", text
    assert len(joined.tree.nodes) == len(elements)
    numbered = [*enumerate(elements, 1)]
    subtrees = frozenset(uid for uid, each in numbered if each.tag == "SubTree")
    guards = {uid: name for uid, each in numbered if (name := each.get(MARK)) is not None}
    waits = {uid: each.get("delay_msec") for uid, each in numbered if each.tag == "Delay"}
    delays = {uid: int(wait) * 1000 for uid, wait in waits.items() if wait is not None}
    return Case(text, mission, joined, subtrees, guards, delays, [], {})


# ---- Missions -------------------------------------------------------------------------------------------------------


def mission(chance: random.Random) -> str:
    """The text of a mission."""
    tree = Trees(chance)
    main = [f"BehaviorTree {name}\n" + "\n".join(lines) for name, lines in tree.all().items()]
    labels = [*tree.labels, *tree.labels[: len(tree.labels) // 2 + 1]]  # what comes first runs more often
    demands = [requirement(chance, f"r{number}", labels) for number in range(chance.randint(2, 6))]
    known = declarations(chance)
    apart = random.Random(repr(chance.getstate()))
    draws = lambda drawn: condition(drawn, labels), lambda drawn: claim(drawn, labels)
    demands += of_states(apart, labels, *draws)
    return "\n".join(["Root Main", *known, *demands, *main]) + "\n"


class Trees:
    """Two trees, the second of which may be used several times, and the labels of their nodes."""

    def __init__(self, chance: random.Random) -> None:
        self.chance = chance
        self.labels: list[str] = []
        self.subtrees = 0

    def all(self) -> dict[str, list[str]]:
        main = self.node(1, 3, sub=True)
        return {"Main": main, "Part": self.node(1, 2, sub=False)}

    def node(self, indent: int, depth: int, *, sub: bool) -> list[str]:
        chance = self.chance
        kinds = [*"LLL", "S" if sub else "L", "C"] if indent > 1 else []
        kinds += [*_CONTROLS, *_CONTROLS, *_DECORATORS] if depth else []
        kind = chance.choice(kinds)
        blank = "    " * indent
        if kind == "S":
            self.subtrees += 1
            return [f"{blank}SubTree Part part{self.subtrees}"]
        label = f"n{len(self.labels)}"
        self.labels.append(label)
        if kind in ("L", "C"):
            return [f"{blank}{f'Action {chance.choice(ACTIONS)}' if kind == 'L' else 'Condition Seen'} {label}"]
        few, many, port = (_CONTROLS | _DECORATORS)[kind]
        attributes = f" ({port} = {chance.randint(1, 4) * (500 if 'msec' in port else 1)})" if port else ""
        if kind == "Switch2":
            attributes = ' (variable = "{mode}" case_1 = "near" case_2 = "far")'
        children = [self.node(indent + 1, depth - 1, sub=sub) for _ in range(chance.randint(few, many))]
        return [f"{blank}{kind} {label}{attributes}", *(line for child in children for line in child)]


_CONTROLS = {
    "->": (1, 3, ""),
    "?": (2, 2, ""),
    "R->": (2, 2, ""),
    "R?": (2, 2, ""),
    "M->": (2, 2, ""),
    "A->": (2, 3, ""),
    "AsyncFallback": (2, 2, ""),
    "||": (2, 3, ""),
    "Switch2": (3, 3, ""),
    "IfThenElse": (3, 3, ""),
    "WhileDoElse": (3, 3, ""),
}
_DECORATORS = {
    "Timeout": (1, 1, "msec"),
    "Delay": (1, 1, "delay_msec"),
    "Retry": (1, 1, "num_attempts"),
    "Repeat": (1, 1, "num_cycles"),
    "Inverter": (1, 1, ""),
    "ForceSuccess": (1, 1, ""),
}


def declarations(chance: random.Random) -> list[str]:
    """Signals and contexts."""

    def perhaps(word: str) -> str:
        return f" {word}" if chance.random() < 0.4 else ""

    fresh = f"fresh within {chance.choice(['250 ms', '1 s', '3 s'])}"
    return [
        f"signal battery : % from {{battery}} level{perhaps(fresh)}{perhaps('initially 50 %')}",
        f"signal energy : Wh from {{energy}} counter{perhaps(fresh)}{perhaps('initially 0 Wh')}",
        f"signal speed : m/s from {{speed}}{perhaps(fresh)}{perhaps('initially 0 m/s')}",
        f"signal near : bool from {{near}}{perhaps(fresh)}{perhaps('initially false')}",
        f"signal state : text from {{state}}{perhaps(fresh)}",
        "context close : near",
        "context fast : speed > 0.5 m/s",
        "context careful : close or fast and not (battery >= 50 %)",
    ]


def requirement(chance: random.Random, name: str, labels: list[str]) -> str:
    """A requirement with a clause or two; its subject is a node, the mission, or all of an ID."""
    lines = []
    head = f"QualityReq {name} : reliability"
    apply = ""
    if chance.random() < 0.15:
        head = f"QualityReq {name}(limit : s = {seconds(chance)}) : reliability"
        lines.append("takes at most limit")
        given = chance.choice(["", f"(limit = {seconds(chance)})"])
        other = f" except {chance.choice(labels)}" if chance.random() < 0.3 else ""
        apply = f"\napply {name}{given} to every {chance.choice(ACTIONS)}{other}"
    else:
        lines += [claim(chance, labels) for _ in range(chance.choice([1, 1, 1, 2]))]
    if all(re.search(" (keeps|never) ", line) for line in lines) and chance.random() < 0.5:
        lines.append(f"from {event(chance, labels)} until {event(chance, labels)}")
    for word in ("while", "when"):
        if chance.random() < 0.2:
            lines.append(f"{word} {condition(chance, labels)}")
    if chance.random() < 0.35:
        share = chance.choice(["50 %", "80 %", "100 %"])
        of = chance.choice(["activations", "runs"])
        lines.append(chance.choice([f"in at least {share} of {of}", f"with probability > {share} of {of}"]))
        if chance.random() < 0.6:
            lines.append(f"confidence {chance.choice(['60 %', '90 %', '95 %'])}")
        if chance.random() < 0.2:
            lines.append(f"over last {chance.choice(['5 activations', '2 runs', '4 s'])}")
    elif chance.random() < 0.4:
        lines.append(f"on violation {chance.choice(['fail', 'fail', 'halt'])}")
    return "\n    ".join([head, *of_more(lines)]) + apply


def of_more(lines: list[str]) -> list[str]:
    """Some of the clauses demand a share of the time, or count results; drawn apart, so that the other cases stay the
    same.
    """
    chance = random.Random("\n".join(lines))
    for index, line in enumerate(lines):
        if " tries " in line and chance.random() < 0.6:
            verb = chance.choice(["succeeds", "starts", "fails", "finishes"])
            lines[index] = line.replace(" tries ", f" {verb} ") + ("" if " per " in line else " per run")
    if len(lines) == 1 and " tries " in lines[0] and chance.random() < 0.5:
        subject = lines[0].partition(" tries ")[0]
        of = f" of {subject}" if chance.random() < 0.3 and subject.startswith("n") else ""
        relation = chance.choice(["at most", "at most", "less than", "at least"])
        lines[0] = f"{subject} fails {relation} {chance.choice([0, 0.5, 1, 2])} per {chance.randint(1, 20)} s{of}"
        lines.extend([f"confidence {chance.choice([60, 90])} %"] if chance.random() < 0.5 else [])
    if (
        len(lines) == 1
        and re.search("^(?!from|sum).* (takes|uses) ", lines[0])
        and not re.search(" if |limit", lines[0])
        and chance.random() < 0.4
    ):
        lines.append("on average")
        lines.extend([f"confidence {chance.choice([60, 90])} %"] if chance.random() < 0.5 else [])
    claims = [line for line in lines if line.split()[0] not in _HEADS]
    if all(re.search(" (keeps|never) ", line) for line in claims) and chance.random() < 0.4:
        share = f"{chance.choice([20, 50, 75, 90])} % of time"
        lines.insert(len(claims), chance.choice([f"in at least {share}", f"with probability > {share}"]))
    return lines


_HEADS = ("while", "when", "in", "with", "confidence", "over", "on")


def claim(chance: random.Random, labels: list[str]) -> str:
    """A subject and a verb."""
    subject = chance.choice([*labels, *labels, "mission", "Part", *(f"every {action}" for action in ACTIONS)])
    verb = chance.choice([*_VERBS, *_VERBS, "span", "each", "sum" if len({*labels}) > 1 else "span"])
    if verb == "span":
        return f"from {event(chance, labels)} to {event(chance, labels)} takes at most {seconds(chance)}"
    if verb == "each":
        answer = event(chance, labels) if chance.random() < 0.6 else condition(chance, labels)
        within = f" within {value(chance, labels, lambda: seconds(chance))}" if chance.random() < 0.7 else ""
        return f"each {event(chance, labels)} is followed by {answer}{within}"
    if verb == "sum":
        return f"sum of {', '.join(chance.sample(sorted({*labels}), 2))} takes at most {seconds(chance)}"
    operand = {
        "takes": lambda: bound(chance, labels, lambda: seconds(chance)),
        "succeeds": lambda: f"within {value(chance, labels, lambda: seconds(chance))}" if chance.random() < 0.6 else "",
        "uses": lambda: uses(chance, labels),
        "tries": lambda: (
            f"{chance.choice(['at most', 'at most', 'at least'])} {chance.randint(0, 3)}"
            + chance.choice(["", f" per {chance.choice(labels)}"])
        ),
        "runs": lambda: chance.choice(
            [f"every {seconds(chance)}", f"at least {chance.randint(1, 3)} per {seconds(chance)}"]
        ),
        "starts": lambda: f"within {seconds(chance)} after {event(chance, labels)}",
        "ends": lambda: f"within {seconds(chance)} after {event(chance, labels)}",
        "follows": lambda: event(chance, labels),
    }.get(verb, lambda: condition(chance, labels))()
    return f"{subject} {verb} {operand}".rstrip()


_VERBS = (
    *("takes", "succeeds", "needs", "keeps", "never", "leaves", "uses"),
    *("tries", "runs", "starts", "ends", "follows"),
)


def uses(chance: random.Random, labels: list[str]) -> str:
    """What `uses` is followed by."""
    name, unit, step = chance.choice([("battery", "%", EXACT), ("energy", "Wh", 5)])
    return f"{bound(chance, labels, lambda: f'{chance.randint(0, 6) * step:g} {unit}')} of {name}"


def bound(chance: random.Random, labels: list[str], simple: Callable[[], str]) -> str:
    """A bound of values as `simple` draws them; one end may depend on the situation."""
    words = chance.choice(["at most", "at most", "less than", "at least", "more than", "between"])
    if words != "between":
        return f"{words} {value(chance, labels, simple)}"
    low, high = sorted([simple(), simple()], key=lambda text: float(text.split()[0]))
    return f"between {low} and {high}"


def value(chance: random.Random, labels: list[str], simple: Callable[[], str]) -> str:
    """A value, or one for each situation."""
    if chance.random() < 0.75:
        return simple()
    cases = [f"{simple()} if {condition(chance, labels)}" for _ in range(chance.randint(1, 2))]
    return f"{', '.join(cases)} else {simple()}"


def seconds(chance: random.Random) -> str:
    return f"{chance.randint(1, 16) / 4:g} s"


def event(chance: random.Random, labels: list[str]) -> str:
    if chance.random() < 0.2:
        return f"when {condition(chance, labels)}"
    if chance.random() < 0.2:
        return f"{chance.choice(labels)} {chance.choice(_HAPPENINGS)} or {event(chance, labels)}"
    return f"{chance.choice(labels)} {chance.choice(_HAPPENINGS)}"


_HAPPENINGS = ("starts", "starts", "finishes", "finishes", "succeeds", "fails", "halts")


def condition(chance: random.Random, labels: list[str], depth: int = 2) -> str:
    """A condition on signals, contexts, and now and then on nodes that run."""
    if depth and chance.random() < 0.35:
        one, other = (condition(chance, labels, depth - 1) for _ in range(2))
        return chance.choice([f"({one} and {other})", f"({one} or {other})", f"not ({one})"])
    if chance.random() < 0.05:
        return f"node {chance.choice(labels)}"
    if chance.random() < 0.05:
        function = chance.choice(["max", "min", "mean", "p95", "stddev", "change", "count"])
        return (
            f"{function}(energy) <= {chance.randint(0, 4) if function == 'count' else f'{chance.randint(0, 8) * 5} Wh'}"
        )
    return chance.choice(
        [
            *("near", "close", "fast", "careful", "not careful", 'state == "up"', 'state != "down"', "speed > 0 m/s"),
            f"battery >= {chance.randint(0, 20) * 5} %",
            f"{chance.randint(0, 10) * 5} % < battery <= {chance.randint(10, 20) * 5} %",
            f"speed <= {chance.randint(0, 4) / 4:g} m/s",
            f"battery + {chance.randint(0, 4) * 5} % > 60 %",
        ]
    )


# ---- Logs -----------------------------------------------------------------------------------------------------------


class LoggedRun(SimulatedRuns):
    """A run whose changes of status are written down.

    Attributes:
        resets: whether parents make children IDLE that have ended.
    """

    def __init__(self, mission: ScenarioMission, chance: random.Random, rows: list[Transition], resets: bool) -> None:
        super().__init__(mission, random.Random(chance.randrange(1 << 30)))
        self.rows = rows
        self.resets = resets

    def drawn(self, leaf: ResolvedNode) -> float:
        """A duration; the first tick, which asks for it, takes a while itself."""
        self.machine.now += round(self.chance.choice([0.0, 0.0, 0.003, 0.04, 0.25, 1.25]) * 1000)
        return self.chance.choice([0.0, 0.25, 0.5, 1.0, 1.0, 2.0, 3.5])

    def changed(self, node: SimulatedNode, before: int, status: int) -> None:
        super().changed(node, before, status)
        if status != IDLE or before == RUNNING or self.resets:
            self.rows.append((START + self.machine.now * 1000, node.uid, status))


def is_loaded(mission: ScenarioMission) -> bool:
    """Whether the engine takes the tree."""
    try:
        SimulatedRuns(mission, random.Random())
    except EngineError:
        return False
    return True


def runs(mission: ScenarioMission, chance: random.Random, now: int) -> tuple[int, list[Transition]]:
    """When some runs from a time on have ended, and their rows; times are in milliseconds."""
    resets = chance.random() < 0.7
    rows: list[Transition] = []
    for _ in range(chance.randint(1, 8)):
        run = LoggedRun(mission, chance, rows, resets)
        run.wait(now)
        first = len(rows)
        try:
            run.run()
        except Endless:
            if chance.random() < 0.5:
                halt_node(run.machine, run.machine.root)
        if len(rows) - first > MOST_ROWS or chance.random() < 0.15:
            del rows[first + chance.randint(0, min(len(rows) - first, MOST_ROWS)) :]
        now = run.machine.now + chance.choice([0, 250, 1000])
    return run.machine.now, rows


def as_logged(chance: random.Random, tree: LoggedTree, rows: list[Transition]) -> list[Transition]:
    """Rows as control nodes like Nav2's write them, some or all to IDLE left out, cut off, and with pauses."""
    habits = {}
    if chance.random() < 0.4:
        inner = [uid for uid, last in tree.last.items() if last > uid]
        habits = {uid: chance.choice(["late", "only its result", "IDLE first"]) for uid in inner}
        habits[ROOT] = chance.choice(["late", "IDLE first"])  # a run without a logged end would be part of the next
    found: list[Transition] = []
    open_: set[int] = set()
    late: Transition | None = None
    for row in rows:
        time, uid, status = row
        habit = habits.get(uid)
        if late is not None:
            _, parent, _ = late
            found += [row, late] if parent < uid <= tree.last[parent] else [late, row]
            late = None
        elif habit == "late" and status == RUNNING:
            late = row
        elif habit == "IDLE first" and uid in open_ and status in (SUCCESS, FAILURE):
            found += [(time, uid, IDLE), row]
        elif habit != "only its result" or status in (SUCCESS, FAILURE):
            found.append(row)
        (open_.add if status == RUNNING else open_.discard)(uid)
    without = chance.choice([0.0, 0.0, 0.0, 0.1, 1.0])
    found = [row for row in found if row[2] != IDLE or chance.random() >= without]
    if chance.random() < 0.3:
        del found[chance.randint(0, len(found)) :]
    pause, last = chance.choice([0, 0, 3]), 0
    for index, (time, uid, status) in enumerate(found):
        last = max(time, last + chance.randint(0, pause))
        found[index] = last, uid, status
    return found


def samples(chance: random.Random, rows: list[Transition]) -> dict[str, list[tuple[int, SampleValue]]]:
    """Samples of some of the signals: at any time, often just that of a row; some begin late."""
    begin, end = (rows[0][0], rows[-1][0]) if rows else (START, START)
    times = [time for time, *_ in rows] or [START]
    steps = [-2, -1, -1, -0.125, 0.125, -0.125, 0.125, 7]
    level = itertools.accumulate(iter(lambda: chance.choice(steps) * EXACT, None), charged, initial=10 * EXACT)
    count = itertools.accumulate(iter(lambda: chance.choice([0, 1, 3, 5, 10, -1, -100]), None), increased, initial=20)
    walks = chance.random() < 0.5
    values: dict[str, Callable[[], SampleValue]] = {
        "battery": lambda: next(level) if walks else chance.randint(0, 16) * EXACT,
        "energy": lambda: next(count) if walks else chance.randint(0, 10) * 5,
        "speed": lambda: chance.randint(-1, 4) / 4,
        "near": lambda: chance.random() < 0.5,
        "state": lambda: chance.choice(["up", "down"]),
    }
    found: dict[str, list[tuple[int, SampleValue]]] = {}
    for name, draw in values.items():
        if chance.random() < 0.85:
            at = [chance.choice(times) + chance.choice([0, 0, 1, -1]) for _ in range(chance.choice([0, 3, 12]))]
            at += [chance.randint(begin - 1_000_000, end) for _ in range(chance.choice([1, 4, 12]))]
            since = chance.randint(begin, end) if chance.random() < 0.2 else begin - 1_000_000
            found[name] = [(time, draw()) for time in sorted(at) if time >= since]
    return found


def charged(level: float, change: float) -> float:
    """A level of a battery after one more sample."""
    return min(max(level + change, 0), 100)


def increased(count: int, change: int) -> int:
    """A counter after one more sample: a large fall is a restart."""
    return 0 if change < -1 else max(count + change, 0)
