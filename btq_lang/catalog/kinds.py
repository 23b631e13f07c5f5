"""What the catalog says of a node kind and of a port: the records and the categories.

One invariant: a record describes BehaviorTree.CPP's newest version; what older ones do otherwise is said beside it
(`since`, `type_before`).  It knows no particular node: those are rows of `engine_nodes`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from btq_lang.util.record import Record

# The engine's five categories, as the word in a file and the tag of the explicit XML form have them.
Category: TypeAlias = "Literal['Action', 'Condition', 'Control', 'Decorator', 'SubTree']"
CATEGORIES: Final[tuple[Category, ...]] = ("Action", "Condition", "Control", "Decorator", "SubTree")

# Where a port's value flows, as a model's Port says it.
Direction: TypeAlias = "Literal['input', 'output', 'inout']"

# When a node returns RUNNING.  synchronous: never, it completes within the tick that started it.  asynchronous: by
# itself, if only between two children that complete at once; a Timeout around it can halt it.  as-children: exactly
# when a child of it does.
Execution: TypeAlias = "Literal['synchronous', 'asynchronous', 'as-children']"

if TYPE_CHECKING:
    # What a node does with its children, or by itself if it has none; empty: unknown, it may do anything.  Nodes of one
    # flow return the same and take the same time, given what their children do, but for what the other fields say.
    Flow: TypeAlias = Literal[
        "",
        "sequence",  # one child after the other, until one fails
        "fallback",  # one child after the other, until one succeeds
        "parallel",  # all children, until so many have succeeded or failed that the others cannot change it
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
        "once",  # its child, for the first time only; with a port `then_skip`
        "precondition",  # its child, if a script is true
        "skip-unless-updated",  # its child, if an entry was written
        "wait-until-updated",  # waits until an entry is written, then its child
        "succeeds",  # returns SUCCESS within the tick
        "fails",  # returns FAILURE within the tick
        "answers",  # returns SUCCESS or FAILURE within the tick
        "sleeps",  # returns SUCCESS after a time
    ]

    # What the value of a port is to the flow of its node.  count: how often it runs its child at most; -1: without end.
    # time: how long it waits, or lets its child run.  successes, failures: how many of its children must succeed or
    # fail for it to do so; a negative number counts from the end.  otherwise: what it returns without its child.
    Role: TypeAlias = Literal["", "count", "time", "successes", "failures", "otherwise"]

# What the text of a port is: a value, a script, or the name of a blackboard entry, written without braces.
Content: TypeAlias = "Literal['value', 'script', 'key']"

# The literals of a port that says what its node returns: with IDLE the engine ends with an error.
RESULT: Final = "BT::NodeStatus except IDLE"


class PortKind(Record):
    """A port of a built-in.

    Attributes:
        type: the C++ type as the engine prints it.
        default: the value of an absent port; None: there is none.
        required: the engine complains where it is absent, at load or when the node is ticked.
        unit: the unit of a number in it, where one is known.
        doc: one line.
        role: what its value is to the flow of its node.
        removes: the node removes the entry that it names.
        literal: the type that a literal is read as, where that is not `type`.
        type_before: a version and the type that every earlier one prints.
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
    literal: str | None = None
    type_before: tuple[str, str] | None = None


class NodeKind(Record):
    """A built-in node of the engine.

    Attributes:
        tag: its XML tag, which is also its name in a file.
        children: how many it takes, at least and at most; None: any number.
        doc: one line.
        semantics: what it does, in a paragraph.
        symbols: its spellings that are no words, the canonical one first.
        aliases: other words for it.
        flow: what it does with its children.
        reactive: at every tick it begins with its first child again, and halts a running one that it does not reach.
        keeps_place: neither a failure nor a halt takes it back to its first child.
        inspects_children: the engine looks up the tags of its children when it loads it, and refuses what
            `versions.NO_EXPLICIT_CHILD` and `versions.ONE_ASYNC_SEQUENCE` say.
        late_count: a wrong number of children passes the engine's load and throws when the node is ticked.
        since, until: the first and the last version that has it; None: the newest does.
    """

    tag: str
    category: Category
    children: tuple[int, int | None]
    doc: str
    semantics: str
    ports: tuple[PortKind, ...] = ()
    symbols: tuple[str, ...] = ()
    aliases: tuple[str, ...] = ()
    execution: Execution = "as-children"
    flow: Flow = ""
    reactive: bool = False
    keeps_place: bool = False
    inspects_children: bool = False
    late_count: bool = False
    since: str = "4.6"
    until: str | None = None

    def port(self, name: str) -> PortKind | None:
        """Its port of that name."""
        for port in self.ports:
            if port.name == name:
                return port
        return None

    def port_for(self, role: Role) -> PortKind | None:
        """Its port of that role."""
        for port in self.ports:
            if port.role == role:
                return port
        return None

    @property
    def pauses(self) -> bool:
        """Whether it runs its children one after the other and returns RUNNING between two that complete at once."""
        return self.execution == "asynchronous" and self.flow in ("sequence", "fallback")
