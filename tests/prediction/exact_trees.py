"""Trees of all nodes that can be folded, and skills, which are drawn: what is folded and what runs show."""

from __future__ import annotations

from collections.abc import Iterable
from math import sqrt
from random import Random

from test_drawn_runs import mission_of, with_settings

from btq_lang.prediction.exact import Folded, TreeFold
from btq_lang.prediction.prepared import PreparedMission
from btq_lang.simulator.nodes import SUCCESS
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

SKILLS = tuple("ABCDE")


def prepared_tree(tree: str, settings: str, names: Iterable[str] = SKILLS, more: str = "") -> PreparedMission:
    """A tree of actions by their names; `more`: other items of its file."""
    leaves = "".join(f"Action {name}\n" for name in names)
    text = f"Root Main\n{more}{leaves}BehaviorTree Main\n{tree}"
    return with_settings(mission_of(Workspace.of({"m.btq": text}, Project()), "m.btq"), settings, with_all_rows=False)


def fold_of(prepared: PreparedMission) -> Folded:
    robot = prepared.loaded.robot
    return TreeFold(robot.skills).of(robot.machine.root)


def drawn_tree(random: Random, indent: int = 4, depth: int = 3, may_keep: bool = True) -> str:
    """A tree below some nodes; `may_keep`: it may have nodes that keep their place."""
    kinds = [*_LEAVES, *_CONTROLS, *_DECORATORS] if depth else _LEAVES
    if depth == 3:
        kinds = [*_CONTROLS, *_DECORATORS]
    kind = random.choice(kinds)
    line = " " * indent
    if kind in _LEAVES:
        return f"{line}{random.choice(SKILLS) if kind == 'skill' else kind}\n"
    children = random.randint(1, 3) if kind in _CONTROLS else 1
    if kind == "SequenceWithMemory" and not may_keep:
        kind = "Sequence"
    may_keep &= kind not in ("Timeout", "Parallel", "ParallelAll")
    ports = {
        "Retry": f" (num_attempts = {random.randint(1, 4)})",
        "Repeat": f" (num_cycles = {random.randint(1, 3)})",
        "Timeout": f" (msec = {random.choice((3000, 5000, 12340, 20000))})",
        "Delay": f" (delay_msec = {random.choice((10, 500, 4000))})",
        "Parallel": f" (success_count = {random.randint(1, children)}, failure_count = {random.randint(1, children)})",
        "ParallelAll": f" (max_failures = {random.randint(1, children)})",
    }
    below = "".join(drawn_tree(random, indent + 4, depth - 1, may_keep) for _ in range(children))
    return f"{line}{kind}{ports.get(kind, '')}\n{below}"


def drawn_settings(random: Random) -> str:
    """What the skills do: a duration of any form, and a result."""
    lines = []
    for name in SKILLS:
        low = random.choice((0, 0.004, 1, 2, 5))
        takes = random.choice(
            (
                f'"{low} s"',
                f'["{low} s", "{low + random.choice((0.1, 3, 10))} s"]',
                f'{{ median = "{low + 1} s", p95 = "{(low + 1) * random.choice((1.2, 2, 4))} s" }}',
            )
        )
        lines.append(f'{name} = {{ takes = {takes}, succeeds = "{random.choice((20, 50, 70.6, 90, 99, 100))} %" }}\n')
    return "[simulate.skills]\n" + "".join(lines)


def contradictions(prepared: PreparedMission, known: Folded, runs: int) -> list[str]:
    """What is folded and is more than four standard deviations from what runs show."""
    shown = [prepared.loaded.run(1, number) for number in range(1, runs + 1)]
    times = [run.now for run in shown if run.end == "succeeds"]
    wrong = []
    success = float(known.success)
    margin = 4 * sqrt(success * (1 - success) / runs) + known.doubt + 1e-9
    if abs(len(times) / runs - success) > margin:
        wrong.append(f"succeeds {len(times) / runs}, not {success} ± {margin}")
    takes = known.takes(SUCCESS)
    if takes is None or not times:
        return wrong
    for share in (0.25, 0.5, 0.95):
        point = takes.percentile(share)
        margin = 4 * sqrt(share * (1 - share) / len(times)) + (known.doubt + takes.strays) / success
        if (at_most := sum(time <= point + takes.error for time in times) / len(times)) < share - margin:
            wrong.append(f"{share} of {len(times)} take {point} ± {takes.error}, not only {at_most}")
        if (less := sum(time < point - takes.error for time in times) / len(times)) > share + margin:
            wrong.append(f"{share} of {len(times)} take {point} ± {takes.error}, not {less}")
    return wrong


_LEAVES = ("skill", "skill", "skill", "AlwaysSuccess", "AlwaysFailure")
_CONTROLS = (
    *("Sequence", "Fallback", "AsyncSequence", "AsyncFallback", "SequenceWithMemory"),
    *("Parallel", "ParallelAll", "Parallel"),
)
_DECORATORS = ("Retry", "Repeat", "Inverter", "ForceSuccess", "ForceFailure", "Timeout", "Timeout", "Delay")
