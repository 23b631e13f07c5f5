"""The built-in nodes of BehaviorTree.CPP, 4.6 to 4.10, one row a node.

One invariant: tags, categories, ports, types and defaults are what the engines print (a test compares every row);
behavior was read in the sources of 4.10.0 and, where versions differ, of 4.6.2 and 4.8.4.  Look-up is in `nodes`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from btq_lang.catalog.kinds import RESULT, Direction, NodeKind, PortKind, action, control, decorator
from btq_lang.catalog.versions import VERSION_3

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Role

_STRING: Final = "std::string"
_MILLISECONDS: Final = "unsigned int"
_ANYTHING: Final = "BT::AnyTypeAllowed"
_ENTRY: Final = "BT::Any"


def _input(
    name: str, type_: str, doc: str, default: str | None = None, *, required: bool = False, role: Role = ""
) -> PortKind:
    return PortKind(name, "input", type_, doc, default, required, role=role)


def _result(name: str, doc: str, default: str) -> PortKind:
    return PortKind(name, "input", "BT::NodeStatus", doc, default, role="otherwise", literal=RESULT)


def _duration(name: str, doc: str) -> PortKind:
    return PortKind(name, "input", _MILLISECONDS, doc, required=True, unit="ms", role="time")


def _script(name: str, type_: str, doc: str) -> PortKind:
    return PortKind(name, "input", type_, doc, required=True, content="script")


def _key(
    name: str, direction: Direction, type_: str, doc: str, *, removes: bool = False, indirect: bool = False
) -> PortKind:
    return PortKind(name, direction, type_, doc, required=True, content="key", removes=removes, indirect=indirect)


# ---- control nodes ----

_CONTROL: Final = (
    control(
        "Sequence",
        "Ticks its children in order until one fails.",
        "SUCCESS when all children have succeeded, FAILURE as soon as one fails. While a child is RUNNING, "
        "the next tick resumes that child and does not tick the children before it, so a condition in front "
        "of a long action is checked once. After a failure it starts from the first child again. Skipped "
        "children count as done; if all are skipped, so is the Sequence.",
        symbols=("->", "→"),
        flow="sequence",
        one_tick="both",
        since=VERSION_3,
    ),
    control(
        "Fallback",
        "Ticks its children in order until one succeeds.",
        "SUCCESS as soon as a child succeeds, FAILURE when all have failed. While a child is RUNNING, the "
        "next tick resumes that child: a condition that failed before it is not checked again and cannot "
        "interrupt it (ReactiveFallback can). It hides the failure of every child but the last.",
        symbols=("?",),
        flow="fallback",
        one_tick="both",
        since=VERSION_3,
    ),
    control(
        "Parallel",
        "Ticks all its children and succeeds or fails by counting.",
        "SUCCESS when success_count children have succeeded, FAILURE when failure_count have failed or "
        "success_count is out of reach; it then halts the children that still run. A negative count counts "
        "from the end: -1 means all children. The children share one thread: they are ticked one after the "
        "other, never at the same time. A count above the number of children throws at the first tick. With "
        "the default success_count, skipped children count as succeeded.",
        ports=(
            _input("success_count", "int", "How many children must succeed; -1 means all", "-1", role="successes"),
            _input("failure_count", "int", "How many failures make it fail; -1 means all", "1", role="failures"),
        ),
        symbols=("||", "⇉"),
        flow="parallel",
        one_tick="unskipped",
        since=VERSION_3,
    ),
    control(
        "ParallelAll",
        "Ticks all its children to their end, then counts the failures.",
        "Unlike Parallel it halts no child: it completes when every child has. FAILURE when max_failures or "
        "more have failed, although the name suggests more than max_failures; so 0 always fails, and -1 means "
        "all children. If all children are skipped, so is the node.",
        ports=(_input("max_failures", "int", "How many failures make it fail; -1 means all", "1", role="failures"),),
        symbols=("All||", "All⇉"),
        flow="parallel-all",
        one_tick="unskipped",
    ),
    control(
        "ReactiveSequence",
        "A Sequence that starts with its first child at every tick.",
        "Conditions in front of an action are checked at every tick while the action runs, and one that fails "
        "halts it: this is how to keep a condition. Give it only one asynchronous child, the last one: "
        "when a child returns RUNNING, the node halts all others, so two of them restart each other forever. "
        "From 4.7 on the engine refuses a child in the explicit form (<Action ID=…>) directly inside it.",
        symbols=("R->", "R→"),
        flow="sequence",
        one_tick="both",
        reactive=True,
        inspects_children=True,
        since=VERSION_3,
    ),
    control(
        "ReactiveFallback",
        "A Fallback that starts with its first child at every tick.",
        "A condition in front of an action is checked at every tick while the action runs, and halts it when "
        "it becomes true. Give it only one asynchronous child, the last one: when a child returns RUNNING, "
        "the node halts all others.",
        symbols=("R?",),
        flow="fallback",
        one_tick="both",
        reactive=True,
        since=VERSION_3,
    ),
    control(
        "SequenceWithMemory",
        "A Sequence that resumes, after a failure, with the child that failed.",
        "It does not tick children that have succeeded again before the whole has succeeded: neither a "
        "failure nor a halt takes it back to the first child. It returns RUNNING between two children that "
        "complete at once. Version 3 called it SequenceStar.",
        symbols=("M->", "M→"),
        execution="asynchronous",
        flow="sequence",
        one_tick="first",
        keeps_place=True,
    ),
    control(
        "AsyncSequence",
        "A Sequence that other nodes can interrupt between two children.",
        "It returns RUNNING after each child that succeeds at once, and continues with the next child at the "
        "next tick. Otherwise it is a Sequence.",
        symbols=("A->", "A→"),
        execution="asynchronous",
        flow="sequence",
        one_tick="first",
    ),
    control(
        "AsyncFallback",
        "A Fallback that other nodes can interrupt between two children.",
        "It returns RUNNING after each child that fails at once, and continues with the next child at the "
        "next tick. Otherwise it is a Fallback.",
        symbols=("A?",),
        execution="asynchronous",
        flow="fallback",
        one_tick="first",
    ),
    control(
        "IfThenElse",
        "Ticks its second child if its first child succeeds, else its third.",
        "The first child is the condition: it is ticked until it completes, and not again while the chosen "
        "branch runs. Without a third child a failing condition is a FAILURE. A skipped condition throws. The "
        "node requires two or three children, which the engine checks only at the first tick.",
        children=(2, 3),
        flow="choice",
        one_tick="both",
        late_count=True,
        since=VERSION_3,
    ),
    control(
        "WhileDoElse",
        "Like IfThenElse, but checks the condition at every tick.",
        "When the condition changes, the running branch is halted and the other one ticked. Without a third "
        "child a failing condition is a FAILURE, which also halts the branch. A skipped condition throws. The "
        "node requires two or three children, which the engine checks only at the first tick.",
        children=(2, 3),
        flow="choice",
        one_tick="both",
        reactive=True,
        late_count=True,
        since=VERSION_3,
    ),
    *(
        control(
            f"Switch{cases}",
            f"Chooses a child by comparing a variable with {cases} cases; the last is the default.",
            f"One child for each of the {cases} cases and a last one, the default. The variable is compared with "
            "case_1, case_2 … as text, as numbers and as names of enums, at every tick: when another case matches, the "
            "running child is halted. If the variable does not exist or no case matches, the last child runs. The "
            "engine checks the number of children only at the first tick.",
            children=(cases + 1, cases + 1),
            ports=(
                _input("variable", _STRING, "The value to compare, usually a blackboard entry"),
                *(_input(f"case_{n}", _STRING, f"The value that chooses child {n}") for n in range(1, cases + 1)),
            ),
            aliases=("Switch",),
            flow="switch",
            one_tick="next",
            late_count=True,
            since=VERSION_3,
        )
        for cases in range(2, 7)
    ),
    control(
        "TryCatch",
        "Ticks its children as a Sequence, and the last one only if another fails.",
        "All children but the last are the try block. If it succeeds, so does the node, and the last child is "
        "never ticked. If it fails, the last child cleans up and the node returns FAILURE, whatever the last "
        "child returns.",
        children=(2, None),
        ports=(_input("catch_on_halt", "bool", "Also clean up when the node is halted within the try block", "false"),),
        flow="try",
        one_tick="both",
        since="4.9",
    ),
)

# ---- decorators ----


def _loop(suffix: str, type_: str, queue_before: str, aliases: tuple[str, ...] = ()) -> NodeKind:
    return decorator(
        f"Loop{suffix}",
        f"Ticks its child once for each item of a queue of {type_}.",
        "Takes an item from the front of the queue, writes it to value, and ticks the child with it; it "
        "returns RUNNING between two items, so it handles one item per tick. A child that fails ends the loop "
        "with FAILURE. If the queue is empty, also at the end of a loop, it returns if_empty. A literal queue is a "
        "list with semicolons (1;2;3).",
        ports=(
            PortKind(
                "queue",
                "inout",
                _ANYTHING,
                "The items: an entry that holds a queue, or a list with semicolons",
                required=True,
                literal=f"std::deque<{type_}>",
                type_before=("4.9", queue_before),
            ),
            _result("if_empty", "The result for an empty queue: SUCCESS, FAILURE or SKIPPED", "SUCCESS"),
            PortKind("value", "output", type_, "The entry that receives the item"),
        ),
        aliases=aliases,
        execution="asynchronous",
        flow="for-each",
        one_tick="first",
    )


def _template(name: str, *arguments: str) -> str:
    """A template's type as compilers print it: with a blank between two `>`."""
    inside = ", ".join(arguments)
    return f"{name}<{inside}{' >' if inside.endswith('>') else '>'}"


def _queue(item: str) -> str:
    return _template("std::shared_ptr", _template("std::deque", item, _template("std::allocator", item)))


_CXX11_STRING: Final = "std::__cxx11::basic_string<char, std::char_traits<char>, std::allocator<char> >"

_DECORATORS: Final = (
    decorator(
        "Inverter",
        "Turns success into failure and failure into success.",
        "It passes RUNNING and SKIPPED on.",
        flow="invert",
        one_tick="first",
        since=VERSION_3,
    ),
    decorator(
        "ForceSuccess",
        "Succeeds whenever its child completes.",
        "It turns a failure of the child into SUCCESS, and passes RUNNING and SKIPPED on.",
        flow="force-success",
        one_tick="first",
        since=VERSION_3,
    ),
    decorator(
        "ForceFailure",
        "Fails whenever its child completes.",
        "It turns a success of the child into FAILURE, and passes RUNNING and SKIPPED on.",
        flow="force-failure",
        one_tick="first",
        since=VERSION_3,
    ),
    decorator(
        "KeepRunningUntilFailure",
        "Repeats its child until it fails.",
        "A success of the child becomes RUNNING, and the child restarts at the next tick. The node ends only "
        "with FAILURE or when it is halted: a Sequence never reaches the nodes after it.",
        execution="asynchronous",
        flow="until-failure",
        since=VERSION_3,
    ),
    decorator(
        "Repeat",
        "Repeats its child as long as it succeeds, at most num_cycles times.",
        "SUCCESS after num_cycles successes, FAILURE at the first failure. -1 repeats forever: it then never "
        "succeeds. 0 cycles succeed at once (4.6: are skipped). It returns RUNNING between two cycles of a "
        "child that completes at once. A skipped child skips the Repeat, which keeps its count.",
        ports=(_input("num_cycles", "int", "The number of cycles; -1 means forever", required=True, role="count"),),
        execution="asynchronous",
        flow="repeat",
        one_tick="first",
        since=VERSION_3,
    ),
    decorator(
        "RetryUntilSuccessful",
        "Tries its child again when it fails, at most num_attempts times in all.",
        "SUCCESS at the first success, FAILURE after num_attempts failures. -1 tries forever: it then never fails. "
        "0 attempts fail at once (4.6: are skipped). It returns RUNNING between two attempts of a child that "
        "completes at once.",
        ports=(
            _input(
                "num_attempts", "int", "The total number of attempts; -1 means endless", required=True, role="count"
            ),
        ),
        aliases=("Retry",),
        execution="asynchronous",
        flow="retry",
        one_tick="first",
        since=VERSION_3,
    ),
    decorator(
        "Timeout",
        "Halts its child and fails after a time limit.",
        "The clock starts with the first tick of the child. The result of a child that completes in time is "
        "passed on. Only a child that returns RUNNING can be halted: around a synchronous action the Timeout "
        "has no effect. 0 means no limit.",
        ports=(_duration("msec", "The time limit; 0 means no limit"),),
        flow="timeout",
        one_tick="first",
        since=VERSION_3,
    ),
    decorator(
        "Delay",
        "Waits, then ticks its child.",
        "RUNNING until the time has passed, then the result of the child.",
        ports=(_duration("delay_msec", "How long to wait before the child's first tick"),),
        execution="asynchronous",
        flow="delay",
        since=VERSION_3,
    ),
    decorator(
        "RunOnce",
        "Runs its child once in the lifetime of the tree.",
        "After the child has completed for the first time it is never ticked again: the node then returns "
        "SKIPPED or, with then_skip=false, the child's result again.",
        ports=(_input("then_skip", "bool", "Afterwards return SKIPPED; false repeats the first result", "true"),),
        flow="once",
        one_tick="first",
    ),
    decorator(
        "Precondition",
        "Ticks its child only if a script is true.",
        "Otherwise it returns the value of else. From 4.7 on the engine checks the script only when the child "
        "starts, so it does not guard a running action (4.6 checks it at every tick): for that, put a "
        "ScriptCondition in front of it in a ReactiveSequence.",
        ports=(
            _script("if", _STRING, "The condition"),
            _result("else", "The result of a false condition: SUCCESS, FAILURE, RUNNING or SKIPPED", "FAILURE"),
        ),
        flow="precondition",
    ),
    _loop("Int", "int", _queue("int")),
    _loop("Bool", "bool", _queue("bool")),
    _loop("Double", "double", _queue("double"), ("Loop",)),
    _loop("String", _STRING, _queue(_CXX11_STRING)),
    decorator(
        "SkipUnlessUpdated",
        "Ticks its child if a blackboard entry was written since the last check.",
        "Otherwise it returns SKIPPED, also if the entry does not exist. It keeps ticking a running child in any case.",
        ports=(_key("entry", "input", _ENTRY, "The entry to watch, with or without braces"),),
        aliases=("EntryUpdatedDecorator",),
        flow="skip-unless-updated",
    ),
    decorator(
        "WaitValueUpdate",
        "Waits until a blackboard entry is written, then ticks its child.",
        "RUNNING until the entry is written after the last check. It keeps ticking a running child in any case.",
        ports=(_key("entry", "input", _ENTRY, "The entry to watch, with or without braces"),),
        execution="asynchronous",
        flow="wait-until-updated",
    ),
)

# ---- leaves and the subtree ----

_LEAVES: Final = (
    action(
        "AlwaysSuccess",
        "Succeeds.",
        "It does nothing else; useful as a placeholder and as a last child.",
        execution="synchronous",
        flow="succeeds",
        since=VERSION_3,
    ),
    action(
        "AlwaysFailure",
        "Fails.",
        "It does nothing else; useful as a placeholder and for testing failures.",
        execution="synchronous",
        flow="fails",
        since=VERSION_3,
    ),
    action(
        "Script",
        "Runs a script and succeeds.",
        "The script reads and writes blackboard entries: battery := 100.0; tubes -= 1. The value of the last statement "
        "does not matter. A variable that does not exist throws when the script runs. Without code the engine refuses "
        "the node; an empty code does nothing.",
        ports=(_script("code", _STRING, "The script"),),
        aliases=("ScriptAction",),
        execution="synchronous",
        flow="succeeds",
    ),
    NodeKind(
        "ScriptCondition",
        "Succeeds if a script is true, else fails.",
        "The value of the last statement must be 0 or 1. A variable that does not exist throws when the script runs, "
        "and || does not stop at its first true side. An empty code loads and throws at the first tick.",
        "Condition",
        (0, 0),
        ports=(_script("code", _ANYTHING, "The condition"),),
        execution="synchronous",
        flow="answers",
    ),
    action(
        "SetBlackboard",
        "Writes a value into a blackboard entry.",
        "output_key names the entry, without braces; {k} means the entry whose name is the value of k. A "
        "value {k} copies that entry; from 4.7 on, it fails if that has no value. A literal that it writes over an "
        "entry without a type stores an empty value then, too: use Script instead.",
        ports=(
            _input("value", _ANYTHING, "The literal, or the entry to copy", required=True, role="copied"),
            _key("output_key", "inout", _ANYTHING, "The entry to write, without braces", indirect=True),
        ),
        execution="synchronous",
        flow="succeeds",
        since=VERSION_3,
    ),
    action(
        "UnsetBlackboard",
        "Removes a blackboard entry.",
        "Also succeeds if the entry does not exist. Scripts that read it afterwards throw.",
        ports=(_key("key", "input", _STRING, "The entry to remove, without braces", removes=True, indirect=True),),
        execution="synchronous",
        flow="succeeds",
    ),
    action(
        "Sleep",
        "Waits, then succeeds.",
        "RUNNING until the time has passed; a halt ends the wait.",
        ports=(_duration("msec", "How long to wait"),),
        execution="asynchronous",
        flow="sleeps",
    ),
    action(
        "WasEntryUpdated",
        "Succeeds if a blackboard entry was written since the last check, else fails.",
        "It also fails if the entry does not exist. The first check of an entry that has been written succeeds.",
        ports=(_key("entry", "input", _ENTRY, "The entry to watch, with or without braces"),),
        aliases=("EntryUpdatedAction",),
        execution="synchronous",
        flow="answers",
    ),
    NodeKind(
        "SubTree",
        "Runs another tree.",
        "The other tree has its own blackboard: a port {key} passes it an entry of this one, a literal a "
        "constant, {=} the entry of the same name, {@key} one of the root blackboard. A tree must not contain "
        "itself.",
        "SubTree",
        (0, 0),
        ports=(_input("_autoremap", "bool", "Pass every entry under its own name", "false"),),
        one_tick="first",
        since=VERSION_3,
    ),
)

ENGINE_NODES: Final = _CONTROL + _DECORATORS + _LEAVES
