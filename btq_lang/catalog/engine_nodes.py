"""The built-in nodes of BehaviorTree.CPP, 4.6 to 4.10, one row a node.

One invariant: tags, categories, ports, types and defaults are what the engines print of themselves (a test holds every
row against them); what is said of behaviour was read in the sources of 4.10.0 and, where versions differ, of 4.6.2 and
4.8.4.  It knows no look-up: that is `nodes`.
"""

from __future__ import annotations

from btq_lang.catalog.kinds import RESULT, Direction, NodeKind, PortKind

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final

_STRING: Final = "std::string"
_MILLISECONDS: Final = "unsigned int"
_ANYTHING: Final = "BT::AnyTypeAllowed"
_ENTRY: Final = "BT::Any"


def _input(name: str, type_: str, doc: str, default: str | None = None, *, required: bool = False) -> PortKind:
    return PortKind(name, "input", type_, doc, default, required)


def _result(name: str, doc: str, default: str) -> PortKind:
    return PortKind(name, "input", "BT::NodeStatus", doc, default, literal=RESULT)


def _duration(name: str, doc: str) -> PortKind:
    return PortKind(name, "input", _MILLISECONDS, doc, required=True, unit="ms")


def _script(name: str, type_: str, doc: str) -> PortKind:
    return PortKind(name, "input", type_, doc, required=True, content="script")


def _key(name: str, direction: Direction, type_: str, doc: str) -> PortKind:
    return PortKind(name, direction, type_, doc, required=True, content="key")


# ---- control nodes ----

_CONTROL: Final = (
    NodeKind(
        "Sequence",
        "Control",
        (1, None),
        "Ticks its children in order until one fails.",
        "SUCCESS when all children have succeeded, FAILURE as soon as one fails. While a child is RUNNING the next "
        "tick goes on with that child: those before it are not looked at again, so a condition in front of a long "
        "action is checked once. A failure starts from the first child again. Skipped children count as done; when "
        "all are skipped, so is the Sequence.",
        symbols=("->", "→"),
    ),
    NodeKind(
        "Fallback",
        "Control",
        (1, None),
        "Ticks its children in order until one succeeds.",
        "SUCCESS as soon as a child succeeds, FAILURE when all have failed. While a child is RUNNING the next tick "
        "goes on with that child: a condition that failed before it is not looked at again and cannot interrupt it "
        "(ReactiveFallback can). It swallows the failure of every child but the last.",
        symbols=("?",),
    ),
    NodeKind(
        "Parallel",
        "Control",
        (1, None),
        "Ticks all its children and succeeds or fails by counting.",
        "SUCCESS when success_count children have succeeded, FAILURE when failure_count have failed or success_count "
        "can no longer be reached; children that still run are then halted. A negative count is counted from the "
        "end: -1 is all of them. The children share one thread: nothing runs at the same time, they are ticked one "
        "after the other. A count above the number of children throws at the first tick. With the default "
        "success_count skipped children count as succeeded.",
        (
            _input("success_count", "int", "How many children must succeed; -1 is all of them", "-1"),
            _input("failure_count", "int", "How many failures make it fail; -1 is all of them", "1"),
        ),
        symbols=("||", "⇉"),
    ),
    NodeKind(
        "ParallelAll",
        "Control",
        (1, None),
        "Ticks all its children to their end, then counts the failures.",
        "Unlike Parallel it halts nobody: it completes when every child has. FAILURE when max_failures or more have "
        "failed, although the name suggests more than max_failures; 0 therefore always fails, -1 asks for all. When "
        "all children are skipped, so is it.",
        (_input("max_failures", "int", "From how many failures on it fails; -1 is all of them", "1"),),
        symbols=("All||", "All⇉"),
    ),
    NodeKind(
        "ReactiveSequence",
        "Control",
        (1, None),
        "A Sequence that begins with its first child at every tick.",
        "Conditions in front of an action are checked at every tick while the action runs, and one that fails halts "
        "it: this is how to keep a condition. Give it one asynchronous child, the last: a child that returns RUNNING "
        "halts all others, so two of them restart each other for ever. From 4.7 on the engine refuses a child in the "
        "explicit form (<Action ID=…>) directly inside it.",
        symbols=("R->", "R→"),
        reactive=True,
    ),
    NodeKind(
        "ReactiveFallback",
        "Control",
        (1, None),
        "A Fallback that begins with its first child at every tick.",
        "A condition in front of an action is checked at every tick while the action runs, and halts it when it "
        "becomes true. Give it one asynchronous child, the last: a child that returns RUNNING halts all others.",
        symbols=("R?",),
        reactive=True,
    ),
    NodeKind(
        "SequenceWithMemory",
        "Control",
        (1, None),
        "A Sequence that goes on, after a failure, with the child that failed.",
        "Children that succeeded are not ticked again before the whole has succeeded: neither a failure nor a halt "
        "takes it back to the first child. Between two children that complete at once it returns RUNNING. Version 3 "
        "called it SequenceStar.",
        symbols=("M->", "M→"),
        execution="asynchronous",
    ),
    NodeKind(
        "AsyncSequence",
        "Control",
        (1, None),
        "A Sequence that lets others interrupt it between two children.",
        "It returns RUNNING after each child that succeeded at once, and goes on with the next child at the next "
        "tick. Otherwise it is a Sequence.",
        symbols=("A->", "A→"),
        execution="asynchronous",
    ),
    NodeKind(
        "AsyncFallback",
        "Control",
        (1, None),
        "A Fallback that lets others interrupt it between two children.",
        "It returns RUNNING after each child that failed at once, and goes on with the next child at the next tick. "
        "Otherwise it is a Fallback.",
        symbols=("A?",),
        execution="asynchronous",
    ),
    NodeKind(
        "IfThenElse",
        "Control",
        (2, 3),
        "Ticks its second or its third child, as its first one says.",
        "The first child is the condition, ticked until it completes and then no more while the chosen branch runs. "
        "Without a third child a failing condition is a FAILURE. A condition that is skipped throws. Two or three "
        "children; another number is noticed at the first tick only.",
        late_count=True,
    ),
    NodeKind(
        "WhileDoElse",
        "Control",
        (2, 3),
        "Like IfThenElse, but looks at the condition at every tick.",
        "When the condition changes, the branch that runs is halted and the other one ticked. Without a third child a "
        "failing condition is a FAILURE; then the branch is halted, too. A condition that is skipped throws. Two or "
        "three children; another number is noticed at the first tick only.",
        late_count=True,
    ),
    *(
        NodeKind(
            f"Switch{cases}",
            "Control",
            (cases + 1, cases + 1),
            f"Ticks the one of {cases} children whose case equals a variable, or the last.",
            f"One child for each of the {cases} cases and a last one, the default. The variable is compared with "
            "case_1, case_2 … as text, as numbers and as names of enums, at every tick: when another case fits, the "
            "child that runs is halted. An absent variable, or no case that fits, means the default. Another number "
            "of children is noticed at the first tick only.",
            (
                _input("variable", _STRING, "What is compared: usually a blackboard entry"),
                *(_input(f"case_{n}", _STRING, f"The value that chooses child {n}") for n in range(1, cases + 1)),
            ),
            aliases=("Switch",),
            late_count=True,
        )
        for cases in range(2, 7)
    ),
    NodeKind(
        "TryCatch",
        "Control",
        (2, None),
        "Ticks its children as a Sequence, and the last one only when another fails.",
        "All children but the last are the try block. If it succeeds, so does the node, and the last child is never "
        "ticked. If it fails, the last child cleans up and the node returns FAILURE, whatever the clean-up returned.",
        (_input("catch_on_halt", "bool", "Also clean up when the node is halted within the try block", "false"),),
        since="4.9",
    ),
)

# ---- decorators ----


def _loop(suffix: str, type_: str, queue_before: str, aliases: tuple[str, ...] = ()) -> NodeKind:
    return NodeKind(
        f"Loop{suffix}",
        "Decorator",
        (1, 1),
        f"Ticks its child once for each item of a queue of {type_}.",
        "Takes an item from the front of the queue, writes it to value, and ticks the child with it; between two "
        "items it returns RUNNING, so there is one item a tick. A child that fails ends the loop with FAILURE. An "
        "empty queue gives if_empty, also at the end of a loop. A literal queue is a list with semicolons (1;2;3).",
        (
            PortKind(
                "queue",
                "inout",
                _ANYTHING,
                "The items: an entry that holds a queue, or a list with semicolons",
                required=True,
                literal=f"std::deque<{type_}>",
                type_before=("4.9", queue_before),
            ),
            _result("if_empty", "What an empty queue gives: SUCCESS, FAILURE or SKIPPED", "SUCCESS"),
            PortKind("value", "output", type_, "The entry that gets the item"),
        ),
        aliases=aliases,
        execution="asynchronous",
    )


def _template(name: str, *arguments: str) -> str:
    """A template's type as compilers print it: a blank parts two `>`."""
    inside = ", ".join(arguments)
    return f"{name}<{inside}{' >' if inside.endswith('>') else '>'}"


def _queue(item: str) -> str:
    return _template("std::shared_ptr", _template("std::deque", item, _template("std::allocator", item)))


_CXX11_STRING: Final = "std::__cxx11::basic_string<char, std::char_traits<char>, std::allocator<char> >"

_DECORATORS: Final = (
    NodeKind(
        "Inverter",
        "Decorator",
        (1, 1),
        "Turns success into failure and failure into success.",
        "RUNNING and SKIPPED are passed on as they are.",
    ),
    NodeKind(
        "ForceSuccess",
        "Decorator",
        (1, 1),
        "Succeeds whenever its child completes.",
        "A failure of the child is swallowed; RUNNING and SKIPPED are passed on.",
    ),
    NodeKind(
        "ForceFailure",
        "Decorator",
        (1, 1),
        "Fails whenever its child completes.",
        "A success of the child is turned into FAILURE; RUNNING and SKIPPED are passed on.",
    ),
    NodeKind(
        "KeepRunningUntilFailure",
        "Decorator",
        (1, 1),
        "Repeats its child until it fails.",
        "A success of the child becomes RUNNING and the child starts anew at the next tick. It can only end in FAILURE "
        "or by being halted: what stands behind it in a Sequence is never reached.",
        execution="asynchronous",
    ),
    NodeKind(
        "Repeat",
        "Decorator",
        (1, 1),
        "Repeats its child as long as it succeeds, at most num_cycles times.",
        "SUCCESS after num_cycles successes, FAILURE at the first failure. -1 repeats for ever: it then never "
        "succeeds. 0 cycles succeed at once (4.6: are skipped). Between two cycles of a child that completes at once "
        "it returns RUNNING. A child that is skipped skips the Repeat, and the count is kept.",
        (_input("num_cycles", "int", "How often; -1 is for ever", required=True),),
        execution="asynchronous",
    ),
    NodeKind(
        "RetryUntilSuccessful",
        "Decorator",
        (1, 1),
        "Tries its child again when it fails, at most num_attempts times in all.",
        "SUCCESS at the first success, FAILURE after num_attempts failures. -1 tries for ever: it then never fails. "
        "0 attempts fail at once (4.6: are skipped). Between two attempts of a child that completes at once it "
        "returns RUNNING.",
        (_input("num_attempts", "int", "How often in all; -1 is without end", required=True),),
        aliases=("Retry",),
        execution="asynchronous",
    ),
    NodeKind(
        "Timeout",
        "Decorator",
        (1, 1),
        "Halts its child and fails when a time has passed.",
        "The clock starts with the first tick of the child. A child that completes in time passes its result on. Only "
        "a child that returns RUNNING can be halted: around a synchronous action the Timeout does nothing. 0 means no "
        "limit.",
        (_duration("msec", "The time limit; 0 is none"),),
    ),
    NodeKind(
        "Delay",
        "Decorator",
        (1, 1),
        "Waits, then ticks its child.",
        "RUNNING until the time has passed, then whatever the child returns.",
        (_duration("delay_msec", "How long to wait before the child's first tick"),),
        execution="asynchronous",
    ),
    NodeKind(
        "RunOnce",
        "Decorator",
        (1, 1),
        "Runs its child once in the life of the tree.",
        "After the child has completed for the first time it is never ticked again: the node is then SKIPPED or, with "
        "then_skip=false, returns the child's result again.",
        (_input("then_skip", "bool", "Afterwards: skip, or else repeat the first result", "true"),),
    ),
    NodeKind(
        "Precondition",
        "Decorator",
        (1, 1),
        "Ticks its child only if a script is true.",
        "Otherwise it returns else. From 4.7 on the script is looked at only when the child starts, so it does not "
        "guard an action that runs (4.6 looks at every tick): for that put a ScriptCondition in front of it in a "
        "ReactiveSequence.",
        (
            _script("if", _STRING, "The condition"),
            _result("else", "What a false condition returns: FAILURE, SUCCESS, SKIPPED", "FAILURE"),
        ),
    ),
    _loop("Int", "int", _queue("int")),
    _loop("Bool", "bool", _queue("bool")),
    _loop("Double", "double", _queue("double"), ("Loop",)),
    _loop("String", _STRING, _queue(_CXX11_STRING)),
    NodeKind(
        "SkipUnlessUpdated",
        "Decorator",
        (1, 1),
        "Ticks its child when a blackboard entry was written since the last look.",
        "Otherwise it is SKIPPED, also where the entry does not exist. A child that runs is ticked on in any case.",
        (_key("entry", "input", _ENTRY, "The entry to watch, with or without braces"),),
        aliases=("EntryUpdatedDecorator",),
    ),
    NodeKind(
        "WaitValueUpdate",
        "Decorator",
        (1, 1),
        "Waits until a blackboard entry is written, then ticks its child.",
        "RUNNING until the entry was written since the last look. A child that runs is ticked on in any case.",
        (_key("entry", "input", _ENTRY, "The entry to watch, with or without braces"),),
        execution="asynchronous",
    ),
)

# ---- leaves and the subtree ----

_LEAVES: Final = (
    NodeKind(
        "AlwaysSuccess",
        "Action",
        (0, 0),
        "Succeeds.",
        "It does nothing else; useful as a placeholder and as a last child.",
        execution="synchronous",
    ),
    NodeKind(
        "AlwaysFailure",
        "Action",
        (0, 0),
        "Fails.",
        "It does nothing else; useful as a placeholder and to test what happens then.",
        execution="synchronous",
    ),
    NodeKind(
        "Script",
        "Action",
        (0, 0),
        "Runs a script and succeeds.",
        "The script reads and writes blackboard entries: battery := 100.0; tubes -= 1. The value of the last statement "
        "does not matter. A variable that does not exist throws when the script runs. Without code the engine refuses "
        "the node; an empty code does nothing.",
        (_script("code", _STRING, "The script"),),
        aliases=("ScriptAction",),
        execution="synchronous",
    ),
    NodeKind(
        "ScriptCondition",
        "Condition",
        (0, 0),
        "Succeeds if a script is true, else fails.",
        "The value of the last statement must be 0 or 1. A variable that does not exist throws when the script runs, "
        "and || does not stop at its first true side. An empty code loads and throws at the first tick.",
        (_script("code", _ANYTHING, "The condition"),),
        execution="synchronous",
    ),
    NodeKind(
        "SetBlackboard",
        "Action",
        (0, 0),
        "Writes a value into a blackboard entry.",
        "output_key names the entry, without braces; {k} means the entry whose name k holds. A value {k} copies that "
        "entry. From 4.7 on a literal written over an entry without a type stores an empty value: Script does it "
        "right.",
        (
            _input("value", _ANYTHING, "The literal, or the entry to copy", required=True),
            _key("output_key", "inout", _ANYTHING, "The entry to write, without braces"),
        ),
        execution="synchronous",
    ),
    NodeKind(
        "UnsetBlackboard",
        "Action",
        (0, 0),
        "Removes a blackboard entry.",
        "Succeeds also where the entry does not exist. Scripts that read it afterwards throw.",
        (_key("key", "input", _STRING, "The entry to remove, without braces"),),
        execution="synchronous",
    ),
    NodeKind(
        "Sleep",
        "Action",
        (0, 0),
        "Waits, then succeeds.",
        "RUNNING until the time has passed; a halt ends the wait.",
        (_duration("msec", "How long to wait"),),
        execution="asynchronous",
    ),
    NodeKind(
        "WasEntryUpdated",
        "Action",
        (0, 0),
        "Succeeds if a blackboard entry was written since the last look, else fails.",
        "It fails, too, where the entry does not exist. The first look at an entry that was ever written succeeds.",
        (_key("entry", "input", _ENTRY, "The entry to watch, with or without braces"),),
        aliases=("EntryUpdatedAction",),
        execution="synchronous",
    ),
    NodeKind(
        "SubTree",
        "SubTree",
        (0, 0),
        "Stands for another tree.",
        "The other tree has a blackboard of its own: a port {key} gives it an entry of this one, a literal a constant, "
        "{=} the entry of the same name, {@key} one of the root blackboard. A tree must not contain itself.",
        (_input("_autoremap", "bool", "Give it every entry under its own name", "false"),),
    ),
)

ENGINE_NODES: Final = _CONTROL + _DECORATORS + _LEAVES
