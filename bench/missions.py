"""Missions made up for measuring: from a number of nodes and a seed, always the same file.

One invariant: the same `nodes` and `seed` give the same text on every machine and Python, and both spellings of them
the same trees, because everything is drawn in `plan` and only written afterwards.  What is drawn follows public
projects: small trees that call each other, one tree name in six that is no identifier, comments, 15 % of the nodes
with quality attributes; depth is pushed to 12.  It knows nothing of btq_lang: it is the other side of the measurement.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Literal, TypeVar

Spelling = Literal["classic", "short"]

SIZES = (100, 500, 10_000, 100_000)
NODES = 10_000
SEED = 1
MAX_DEPTH = 12
QUALITY_SHARE = 0.15

T = TypeVar("T")


def mission(nodes: int = NODES, seed: int = SEED, spelling: Spelling = "classic") -> str:
    """A mission file without a syntax error.

    Args:
        nodes: how many nodes its trees have together; the trees themselves and the requirements are not counted.
        seed: another number, another mission.
        spelling: `classic`, the published form (`Root`, `ScriptAction (name = …)`, `QualityReq ID = …`), or `short`,
            with models, signals and requirements that are measured.

    Raises:
        ValueError: fewer nodes than the smallest tree has.
    """
    return write(plan(nodes, seed), spelling)


@dataclass
class Requirement:
    """A quality requirement, in the words of both spellings.

    Attributes:
        shared: the short spelling defines it at file level, since more than one node refers to it.
    """

    id: str
    concern: str
    quality: str
    title: str
    description: str
    clauses: tuple[str, ...]
    shared: bool = False


@dataclass
class Mark:
    """What a node says about quality: concerns alone (early design), or a requirement (late design).

    Attributes:
        defines: the requirement is written out here; otherwise it is named.
    """

    concerns: tuple[tuple[str, str], ...]
    requirement: Requirement | None
    defines: bool


@dataclass
class Step:
    """A node: `kind` is its symbol or ID, `values` its attributes as (key, classic value, short value)."""

    role: Literal["control", "decorator", "action", "condition", "subtree"]
    kind: str
    depth: int
    built_in: bool = True
    label: str = ""
    values: list[tuple[str, str, str]] = field(default_factory=list)
    mark: Mark | None = None
    comment: str = ""  # on lines of its own, before the node
    remark: str = ""  # behind the node
    children: list[Step] = field(default_factory=list)

    def walk(self) -> Iterator[Step]:
        yield self
        for child in self.children:
            yield from child.walk()


@dataclass
class Mission:
    """The trees by name, in order; the first is the main tree."""

    seed: int
    nodes: int
    trees: list[tuple[str, Step]]

    def steps(self) -> Iterator[Step]:
        for _, top in self.trees:
            yield from top.walk()


def plan(nodes: int = NODES, seed: int = SEED) -> Mission:
    """Draw a mission; arguments and errors as of `mission`."""
    if nodes < _SMALLEST_TREE:
        raise ValueError(f"a mission has at least {_SMALLEST_TREE} nodes")
    draw = _Draw(seed)
    sizes = _tree_sizes(nodes, draw)
    names = [_tree_name(index, draw) for index in range(len(sizes))]
    trees = []
    for index, size in enumerate(sizes):
        top = _grow(size, 1, draw, spine=draw.chance(0.25))
        _call(top, names[2 * index + 1 : 2 * index + 3], draw)
        _name_controls(top, draw)
        trees.append((names[index], top))
    made = Mission(seed, nodes, trees)
    _mark(list(made.steps()), draw)
    return made


class _Draw:
    """Random choices, made of `random()` alone: that sequence is promised never to change, others' are not."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed).random

    def chance(self, probability: float) -> bool:
        return self._random() < probability

    def between(self, low: int, high: int) -> int:
        return low + int(self._random() * (high - low + 1))

    def of(self, things: Sequence[T]) -> T:
        return things[int(self._random() * len(things))]


# ---- drawing --------------------------------------------------------------------------------------------------------

_SMALLEST_TREE = 6  # room for two leaves that call other trees


def _tree_sizes(nodes: int, draw: _Draw) -> list[int]:
    """Trees of 6 to 80 nodes, most of them small: public trees have 16 on average."""
    sizes = []
    left = nodes
    while left:
        size = draw.between(6, 14) if draw.chance(0.6) else draw.between(12, 36)
        if draw.chance(0.04):
            size = draw.between(40, 80)
        if left - size < _SMALLEST_TREE:
            size = left
        sizes.append(size)
        left -= size
    return sizes


def _tree_name(index: int, draw: _Draw) -> str:
    if index == 0:
        return "mainTree"
    words = [draw.of(_VERBS), draw.of(_THINGS)]
    if draw.chance(0.16):
        return f"{index}-{words[0].lower()}-{words[1].lower()}"  # in btq quoted, for the engine a name
    return f"{words[0]}{words[1]}{index}"


def _grow(size: int, depth: int, draw: _Draw, spine: bool, parent: str = "") -> Step:
    """A subtree of exactly `size` nodes.  A spine gives nearly all to one child, so that some trees get deep."""
    if size == 1:
        return _leaf(depth, draw, parent)
    wanted = size == 2 or draw.chance(0.12)
    if wanted and 1 < depth < MAX_DEPTH - 1 and parent != "decorator":
        kind, values = draw.of(_DECORATORS)
        step = Step("decorator", kind, depth, values=list(values))
        step.children.append(_grow(size - 1, depth + 1, draw, spine, "decorator"))
        return _commented(step, draw)
    kind = draw.of(_CONTROLS)
    if depth == MAX_DEPTH - 1:
        kind, shares = "->", [1] * (size - 1)
    elif depth > 1 and size > 2 and draw.chance(0.12):
        kind, shares = draw.of(_REACTIVE), [size - 2]
    else:
        shares = _shares(size - 1, draw, spine)
    step = Step("control", kind, depth)
    if kind in _REACTIVE:  # a condition watches one action: two would run side by side
        step.children.append(_condition(depth + 1, draw))
    step.children += [_grow(share, depth + 1, draw, spine, kind) for share in shares]
    return _commented(step, draw)


def _shares(size: int, draw: _Draw, spine: bool) -> list[int]:
    count = min(size, draw.between(2, 5))
    shares = [1] * count
    left = size - count
    if spine:
        shares[draw.between(0, count - 1)] += left
        return shares
    for index in range(count - 1):
        part = draw.between(0, left)
        shares[index] += part
        left -= part
    shares[-1] += left
    return shares


def _leaf(depth: int, draw: _Draw, parent: str) -> Step:
    if draw.chance(0.22) and parent != "decorator":
        return _condition(depth, draw)
    if draw.chance(0.06) and parent in ("->", "M->"):
        kind, values = draw.of(_BUILT_IN_ACTIONS)
        return _commented(Step("action", kind, depth, values=list(values)), draw)
    skill, ports = draw.of(_SKILLS)
    step = Step("action", skill, depth, built_in=False)
    for name, _, literals in ports:
        literal = draw.of(literals)
        step.values.append((name, literal, literal))
    if draw.chance(0.04):
        step.values.append(draw.of(_CONDITIONS_ON_ENTRY))
    return _commented(step, draw)


def _condition(depth: int, draw: _Draw) -> Step:
    return _commented(Step("condition", draw.of(_CONDITIONS), depth, built_in=False), draw)


def _commented(step: Step, draw: _Draw) -> Step:
    if draw.chance(0.1):
        step.comment = draw.of(_COMMENTS)
    if draw.chance(0.05):
        step.remark = draw.of(_REMARKS)
    return step


def _call(top: Step, names: Sequence[str], draw: _Draw) -> None:
    """Turn leaves into calls of the trees below this one: each at least once, so no tree is unused, none recursive."""
    leaves = [step for step in top.walk() if step.role == "action" and not step.built_in]
    leaves += [step for step in top.walk() if step.role == "condition"]
    for index, step in enumerate(leaves):
        if names and (index < len(names) or (step.role == "action" and draw.chance(0.1))):
            step.role, step.kind, step.built_in = "subtree", names[index % len(names)], True
            step.values = [("station", '"{target}"', "{target}")] if draw.chance(0.3) else []


def _name_controls(top: Step, draw: _Draw) -> None:
    """Names of controls are unique in their tree."""
    for number, step in enumerate(step for step in top.walk() if step.role == "control"):
        if draw.chance(0.6):
            step.label = f"{draw.of(_VERBS)}{draw.of(_THINGS)}" + (f"_{number}" if number else "")


def _mark(steps: Sequence[Step], draw: _Draw) -> None:
    """Give exactly 15 % of the nodes quality attributes."""
    wanted = int(len(steps) * QUALITY_SHARE)
    seen: list[Requirement] = []
    for index, step in enumerate(steps):
        if not draw.chance(wanted / (len(steps) - index)):
            continue
        wanted -= 1
        if draw.chance(0.3):
            first = draw.between(0, len(_CONCERNS) - 2)
            step.mark = Mark(_CONCERNS[first : first + (2 if draw.chance(0.3) else 1)], None, False)
        elif seen and draw.chance(0.2):
            requirement = draw.of(seen[-20:])
            requirement.shared = True
            step.mark = Mark((), requirement, False)
        else:
            requirement = _requirement(len(seen) + 1, draw)
            seen.append(requirement)
            concerns = ((requirement.concern, requirement.quality),) if draw.chance(0.4) else ()
            step.mark = Mark(concerns, requirement, True)


def _requirement(number: int, draw: _Draw) -> Requirement:
    concern, quality, title, description, clauses = draw.of(_REQUIREMENTS)
    amount = draw.between(2, 90)
    return Requirement(
        f"rq{number}",
        concern,
        quality,
        f"{title} (part {number})",
        description.format(amount) + f" (part {number})",
        tuple(clause.format(amount) for clause in clauses),
    )


# ---- writing --------------------------------------------------------------------------------------------------------


def write(made: Mission, spelling: Spelling) -> str:
    """A planned mission as a file."""
    lines = _classic(made) if spelling == "classic" else _short(made)
    return "\n".join(lines) + "\n"


def _classic(made: Mission) -> Iterator[str]:
    yield f"# A mission made for measuring: {made.nodes} nodes in {len(made.trees)} trees, seed {made.seed}."
    yield "Root mainTree"
    for name, top in made.trees:
        yield ""
        yield f"    # {name}: {_SINCE}"
        yield f"    BehaviorTree ID = {_name(name)}"
        for step in top.walk():
            yield from _classic_step(step, "    " * (step.depth + 1))


def _classic_step(step: Step, indent: str) -> Iterator[str]:
    yield from _comment(step, indent)
    pairs = [f"{key} = {value}" for key, value, _ in step.values]
    kind = step.kind
    if step.role == "subtree":
        kind = "SubTree"
        pairs.insert(0, f"ID = {_name(step.kind)}")
    elif not step.built_in:
        kind = "ScriptAction" if step.role == "action" else "ScriptCondition"
        sign = "?" if step.role == "condition" else ""
        pairs.insert(0, f'name = "{step.kind}{sign}"')
    elif step.label:
        pairs.insert(0, f'name = "{step.label}"')
    remark = f"  // {step.remark}" if step.remark else ""
    if step.mark is None:
        yield indent + kind + (f" ({' '.join(pairs)})" if pairs else "") + remark
        return
    pairs += _classic_mark(step.mark, indent)
    if len(pairs) == 1:
        yield f"{indent}{kind} ({pairs[0]}){remark}"
        return
    # As the published examples break their lines, but indented.
    yield f"{indent}{kind} ({remark}"
    yield from (f"{indent}    {pair}" for pair in pairs)
    yield f"{indent})"


def _classic_mark(mark: Mark, indent: str) -> list[str]:
    requirement = mark.requirement
    qualities = ", ".join(f"Quality = {concern}" for concern, _ in mark.concerns)
    if requirement is None:
        return [f"satisfices {qualities}"]
    head = f'QualityReq ID = "{requirement.id}"'
    description = requirement.description.replace("\n", f"\n{indent}        ")
    if not mark.defines:
        return [f"satisfies {head}"]
    if mark.concerns:
        quality = f"satisfices Quality = {requirement.concern}"
        return [quality, f'({head} description = "{description}")']
    return [f"satisfies {head}", f'description = "{description}"']


def _short(made: Mission) -> Iterator[str]:
    yield f"# A mission made for measuring: {made.nodes} nodes in {len(made.trees)} trees, seed {made.seed}."
    yield from _HEADER
    for skill, ports in _SKILLS:
        yield ""
        yield f"Action {skill}"
        for name, type_, _ in ports:
            yield f"    input {name} : {type_}"
    yield ""
    yield from (f"Condition {condition}" for condition in _CONDITIONS)
    for step in made.steps():
        if step.mark and step.mark.defines and step.mark.requirement and step.mark.requirement.shared:
            yield ""
            yield from _short_requirement(step.mark.requirement, "")
    for name, top in made.trees:
        yield ""
        yield f"# {name}: {_SINCE}"
        yield f"BehaviorTree {_name(name)}"
        for step in top.walk():
            yield from _short_step(step, "    " * step.depth)


def _short_step(step: Step, indent: str) -> Iterator[str]:
    yield from _comment(step, indent)
    words = [step.kind]
    if step.role == "subtree":
        words = ["SubTree", _name(step.kind)]
    elif step.role == "condition":
        words = ["Condition", step.kind]
    if step.label:
        words.append(step.label)
    if step.values:
        words.append(f"({', '.join(f'{key} = {value}' for key, _, value in step.values)})")
    line = indent + " ".join(words)
    remark = f"  # {step.remark}" if step.remark else ""
    mark = step.mark
    if mark and not mark.defines and not remark:
        concerns = ", ".join(quality for _, quality in mark.concerns)
        yield f"{line} satisfies {mark.requirement.id}" if mark.requirement else f"{line} satisfices {concerns}"
        return
    yield line + remark
    if mark and mark.concerns:
        yield f"{indent}    satisfices {', '.join(quality for _, quality in mark.concerns)}"
    if mark and mark.requirement:
        if mark.defines and not mark.requirement.shared:
            yield from _short_requirement(mark.requirement, f"{indent}    ", "satisfies ")
        else:
            yield f"{indent}    satisfies {mark.requirement.id}"


def _short_requirement(requirement: Requirement, indent: str, verb: str = "") -> Iterator[str]:
    yield f'{indent}{verb}QualityReq {requirement.id} : {requirement.quality} "{requirement.title}"'
    yield from (f"{indent}    {clause}" for clause in requirement.clauses)


def _comment(step: Step, indent: str) -> Iterator[str]:
    for line in step.comment.splitlines():
        yield indent + line


def _name(name: str) -> str:
    return name if name.isidentifier() else f'"{name}"'


# ---- what missions are made of --------------------------------------------------------------------------------------

_VERBS = ("Fetch", "Inspect", "Deliver", "Clean", "Sort", "Load", "Scan", "Approach", "Handle", "Return", "Prepare")
_THINGS = ("Tubes", "Tray", "Shelf", "Corridor", "Samples", "Box", "Pallet", "Ward", "Plates", "Door", "Bench", "Cart")

_CONTROLS = ("->", "->", "->", "->", "?", "?", "M->", "||")
_REACTIVE = ("R->", "R?")
_DECORATORS = (
    ("Retry", (("num_attempts", "6", "6"),)),
    ("Retry", (("num_attempts", '"3"', "3"),)),
    ("Timeout", (("msec", "30000", "30 s"),)),
    ("Repeat", (("num_cycles", "2", "2"),)),
    ("Delay", (("delay_msec", "500", "500 ms"),)),
    ("Inverter", ()),
)
_BUILT_IN_ACTIONS = (
    ("Sleep", (("msec", "2000", "2 s"),)),
    ("SetBlackboard", (("value", '"idle"', '"idle"'), ("output_key", '"state"', '"state"'))),
)
_CONDITIONS_ON_ENTRY = (
    ("_skipIf", '"battery_level < 20"', '"battery_level < 20"'),
    ("_onSuccess", '"attempts := 0"', '"attempts := 0"'),
)
_STATIONS = ('"charger"', '"solid station"', '"liquid handler"', '"ward 3, bed 2"', "{target}")
_SKILLS: tuple[tuple[str, tuple[tuple[str, str, tuple[str, ...]], ...]], ...] = (
    ("MoveBase", (("station", "string", _STATIONS),)),
    ("MoveArm", (("pose", "string", ('"home"', '"above the rack"', "{pose}")), ("speed", "double", ("0.25", "0.5")))),
    ("Pick", (("object", "string", ('"microplate"', '"tube"', "{object}")),)),
    ("Place", (("object", "string", ('"microplate"', "{object}")), ("slot", "int", ("1", "4", "12")))),
    ("OpenGripper", ()),
    ("CloseGripper", (("force", "double", ("12.5", "20")),)),
    ("DetectObject", (("object", "string", ('"label"', '"tube"', "{object}")), ("tries", "int", ("2", "5")))),
    ("ReadLabel", (("camera", "string", ('"wrist"', '"head"')),)),
    ("OpenDoor", (("door", "string", ('"lab/north"', '"ward-2"', "{door}")),)),
    ("CallLift", (("floor", "int", ("0", "1", "-1")),)),
    ("Dock", ()),
    ("Undock", ()),
    ("Charge", (("level", "int", ("80", "100")),)),
    ("Say", (("text", "string", ('"Please step aside"', '"Delivery for you"')),)),
    ("WeighSample", (("scale", "string", ('"scale #2"', '"scale #1"')),)),
    ("UpdateMap", (("url", "string", ('"http://maps.local/floor1"', "{map}")),)),
)
_CONDITIONS = (
    "BatteryLow",
    "AtStation",
    "GripperEmpty",
    "ObjectVisible",
    "DoorOpen",
    "PathFree",
    "HumansNear",
    "MicroplateNotEmpty",
    "LabelRead",
)
_COMMENTS = (
    "# the charger is the only safe place to wait",
    "# see the risk analysis, item 4",
    "# TODO: ask the night shift whether the lift may be used",
    "// was a plain Sequence before the trial in March",
    "// keep in step with the map",
    "/* The tray must not tilt here:\n   the tubes are open. */",
)
_SINCE = "agreed with the users of the robot, changes need a new risk analysis"
_REMARKS = ("slow on carpet", "checked on the robot", "see the manual", "not in the simulator")
_CONCERNS = (
    ("performance", "performance-efficiency"),
    ("reliability", "reliability"),
    ("safety", "safety"),
    ("security", "security"),
    ("performance-efficiency.time-behaviour", "performance-efficiency.time-behaviour"),
    ("reliability.fault-tolerance", "reliability.fault-tolerance"),
)
_REQUIREMENTS = (
    (
        "performance",
        "performance-efficiency.time-behaviour",
        "Done in time",
        "SuccessIf the moving to the station shall take at most {} sec.\nFailureIf the moving took longer than that",
        ("takes at most {} s", "on violation fail"),
    ),
    (
        "performance",
        "performance-efficiency.resource-utilization",
        "Battery left for the way home",
        "The robot should have at least a battery capacity of {}% left when it is done.",
        ("leaves battery >= {} %", "on violation warn"),
    ),
    (
        "safety",
        "safety.operational-constraint",
        "Slow near people",
        "The base shall not be faster than 0.{} m/s near people.",
        ("keeps speed <= 0.{} m/s while humans_near", 'because "movement next to people"'),
    ),
    (
        "reliability",
        "reliability.faultlessness",
        "Succeeds nearly always",
        "SuccessIf {} of 100 runs succeed.\nFailureIf more of them fail in one week",
        ("succeeds in at least {} % of activations over last 200 activations", "verified by monitor"),
    ),
    (
        "reliability",
        "reliability.recoverability",
        "Few attempts",
        "FailureIf it needs more than {} attempts before it succeeds.",
        ("tries at most {}",),
    ),
    (
        "security",
        "security.confidentiality",
        "Labels stay on the robot",
        "The information on the label shall be processed locally, within {} s.",
        ("succeeds within {} s", "verified by review"),
    ),
)
_HEADER = (
    "",
    "signal battery : % from {battery_level}",
    "signal speed : m/s from {speed} fresh within 1 s",
    "signal humans : 1 from {humans} initially 0",
    "",
    "context humans_near : humans > 0",
)


def main(arguments: Sequence[str] | None = None) -> None:
    """Write a mission to standard output."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--nodes", type=int, default=NODES)
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--spelling", choices=("classic", "short"), default="classic")
    options = parser.parse_args(arguments)
    sys.stdout.write(mission(options.nodes, options.seed, options.spelling))


if __name__ == "__main__":
    main()
