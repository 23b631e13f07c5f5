"""The records for node kinds and ports, and the categories.

One invariant: a record describes BehaviorTree.CPP's newest version; differences of older ones have fields of their own
(`since`, `type_before`).  It does not know particular nodes: those are rows of `engine_nodes` and `nav2/nodes`.
"""

from __future__ import annotations

from functools import partial
from typing import Final, Literal, TypeAlias

from btq_lang.util.record import Record

# The engine's five categories, as the word in a file and the tag of the explicit XML form have them.
Category: TypeAlias = "Literal['Action', 'Condition', 'Control', 'Decorator', 'SubTree']"
CATEGORIES: Final[tuple[Category, ...]] = ("Action", "Condition", "Control", "Decorator", "SubTree")

# The number of children of the nodes of a category; None: any number.
CHILDREN: Final[dict[str, tuple[int, int | None]]] = {
    "Action": (0, 0),
    "Condition": (0, 0),
    "SubTree": (0, 0),
    "Decorator": (1, 1),
    "Control": (1, None),
}

# Where a port's value flows, as in a model's Port.
Direction: TypeAlias = "Literal['input', 'output', 'inout']"

# When a node returns RUNNING.  synchronous: never, it completes within the tick that starts it.  asynchronous: by
# itself, if only between two children that complete at once; a Timeout around it can halt it.  as-children: exactly
# when one of its children does.
Execution: TypeAlias = "Literal['synchronous', 'asynchronous', 'as-children']"

# What a node does with its children, or by itself if it has none; empty: unknown, it may do anything.  Given the
# same behavior of their children, nodes of one flow return the same and take the same time, except as the other
# fields describe.
Flow: TypeAlias = Literal[
    "",
    "sequence",  # one child after the other, until one fails
    "fallback",  # one child after the other, until one succeeds
    "parallel",  # all children, until enough have succeeded or failed to determine the result
    "parallel-all",  # all children to their ends, then it counts the failures
    "choice",  # the first child is the condition: if it succeeds the second, else the third
    "switch",  # the child whose port `case_1`, `case_2` … equals its port `variable`, else the last
    "try",  # all but the last as a sequence, the last after a failure; with a port `catch_on_halt`
    "invert",  # its child, with success and failure exchanged
    "force-success",  # its child, whose failure becomes a success
    "force-failure",  # its child, whose success becomes a failure
    "repeat",  # its child again as long as it succeeds
    "retry",  # its child again as long as it fails
    "until-failure",  # its child at every tick, until it fails
    "for-each",  # its child for each item of a queue, until it fails
    "timeout",  # its child, which it halts after a time
    "delay",  # a time, then its child
    "once",  # its child, the first time only; with a port `then_skip`
    "precondition",  # its child, if a script is true
    "skip-unless-updated",  # its child, if an entry was written
    "wait-until-updated",  # waits until an entry is written, then its child
    "succeeds",  # returns SUCCESS within the tick
    "fails",  # returns FAILURE within the tick
    "answers",  # returns SUCCESS or FAILURE within the tick
    "sleeps",  # returns SUCCESS after a time
    "waits",  # returns SUCCESS or FAILURE, perhaps after a time
    "pipeline",  # a sequence that begins with its first child at every tick and lets the later ones run on
    "together",  # all children at every tick, until all succeed in one tick
    "resume",  # a sequence that begins with the child whose index an entry has
    "recover",  # its first child; the second after a failure, and then the first again
    "rotate",  # one child after the other until one succeeds; the next activation begins after that one
    "pause",  # its first child, and others in its place while a service has stopped that
    "pass",  # its child, with the same result
    "throttle",  # its child when it starts, and again each time that something has happened
    "throttle-or-fail",  # the same, but it fails without what it measures that by
    "pass-or-succeed",  # its child if something has happened; else SUCCESS
    "pass-once",  # its child until that ends, then FAILURE
    "notices",  # FAILURE when it starts, then SUCCESS each time that something has happened
]

# How far one tick of a node goes, which tells when its children began in a log, where there are no ticks.  first: it
# writes RUNNING and then ticks its first child; next: when a child has ended, it ticks the next one; both: first and
# next; unskipped: both, but it ticks a skipped child again at a later tick; empty: neither, or it is unknown.
OneTick: TypeAlias = Literal["", "first", "next", "both", "unskipped"]

# The role of a port's value in the flow of its node.  count: how often it runs its child at most; -1: without end.
# time: how long it waits, or lets its child run.  successes, failures: how many of its children must succeed or
# fail for it to do so; a negative number counts from the end.  otherwise: what it returns without its child.
# retries: how often its second child may help its first.  wraps: whether its first child follows its last.  index:
# the entry with the number of its child, which it counts on.  copied: the value that it writes; if that is an entry
# without a value, it fails.
Role: TypeAlias = Literal[
    "", "count", "time", "successes", "failures", "otherwise", "retries", "wraps", "index", "copied"
]

# The text of a port: a value, a script, or the name of a blackboard entry, written without braces.
Content: TypeAlias = "Literal['value', 'script', 'key']"

# The literals of a port that determines what its node returns: IDLE would be an error of the engine.
RESULT: Final = "BT::NodeStatus except IDLE"


class PortKind(Record):
    """A port of a built-in, or of a node of a library that btq knows.

    Attributes:
        type: the C++ type as the engine prints it.
        default: the value of an absent port; None if there is none.
        required: whether the engine reports its absence, at load or when the node is ticked.
        unit: the unit of a number in it, if known.
        role: of its value in the flow of its node.
        removes: whether the node removes the entry that it names.
        indirect: whether `{key}` means the entry whose name is the value of `key`.
        literal: the type with which a literal is read, if not `type`.
        type_before: a version, and the type that every earlier one prints.
    """

    name: str
    direction: Direction
    type: str
    doc: str
    default: str | None = None
    required: bool = False
    unit: str | None = None
    content: Content = "value"
    role: Role = ""
    removes: bool = False
    indirect: bool = False
    literal: str | None = None
    type_before: tuple[str, str] | None = None


class NodeKind(Record):
    """A built-in node of the engine, or one of a library that btq knows (`nav2/nodes.py`).

    Attributes:
        tag: its XML tag, which is also its name in a file.
        children: minimum and maximum number of children; None: any number.
        doc, semantics: what it does, in a line and in a paragraph.
        symbols: its symbols, the canonical one first.
        aliases: other words for it.
        reactive: whether it begins with its first child at every tick, and halts a running one that it does not reach.
        keeps_place: whether it stays at its child after a failure or a halt.
        inspects_children: whether the engine looks up the tags of its children at load, and refuses what
            `versions.NO_EXPLICIT_CHILD` and `versions.ONE_ASYNC_SEQUENCE` describe.
        one_tick: how far one tick of it goes.
        late_count: whether a wrong number of children throws only when the node is ticked, not at load.
        memory: the result after which its parent must not reset it, or it forgets what it waits for; empty: any parent
            may reset it.
        since: the first version that has it.
    """

    tag: str
    doc: str
    semantics: str
    category: Category
    children: tuple[int, int | None]
    ports: tuple[PortKind, ...] = ()
    symbols: tuple[str, ...] = ()
    aliases: tuple[str, ...] = ()
    execution: Execution = "as-children"
    flow: Flow = ""
    reactive: bool = False
    keeps_place: bool = False
    inspects_children: bool = False
    one_tick: OneTick = ""
    late_count: bool = False
    memory: Literal["", "success", "failure"] = ""
    since: str = "4.6"

    def port(self, name: str) -> PortKind | None:
        """Its port of that name."""
        for port in self.ports:
            if port.name == name:
                return port
        return None

    def port_for(self, role: Role) -> PortKind | None:
        """Its port of that role."""
        return next((port for port in self.ports if port.role == role), None)

    @property
    def pauses(self) -> bool:
        """Whether it runs its children one after the other and returns RUNNING between two that complete at once."""
        return self.execution == "asynchronous" and self.flow in ("sequence", "fallback")


# The rows of a category, with the number of children that is usual in it.
control = partial(NodeKind, category="Control", children=CHILDREN["Control"])
decorator = partial(NodeKind, category="Decorator", children=CHILDREN["Decorator"])
action = partial(NodeKind, category="Action", children=CHILDREN["Action"])
