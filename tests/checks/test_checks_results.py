"""The possible results of nodes, compared with running them: a small engine below ticks random trees, and no node may
return what the check believes to be impossible."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from random import Random

from hypothesis import given
from hypothesis import strategies as st

from btq_lang.checks.results import Results, result
from btq_lang.checks.statuses import FAILURE, RUNNING, SKIPPED, SUCCESS
from btq_lang.checks.view import View
from btq_lang.syntax.tree import Node
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

IDLE = 0


def results(text: str) -> dict[str, Results]:
    """The results of every named node of a file."""
    return {
        seen.node.name.text: result(view, seen.node)
        for view in views({"main.btq": text})
        for seen in view.nodes
        if seen.node.name is not None
    }


def views(texts: Mapping[str, str]) -> list[View]:
    """The items of the first of some files."""
    store = Store(Workspace.of(texts))
    (path, *_) = texts
    return [View(store, path, facts) for facts in store.state.files[path].facts.values()]


# ---- a small engine, written from the descriptions of BehaviorTree.CPP 4.10 ----


class Ticked:
    """A node that runs.  `seen` has what it returned so far; `first` what it returned when it was started."""

    def __init__(self, node: Node, decide: Callable[[int], int]) -> None:
        self.node = node
        self.decide = decide  # a number below the given one
        self.children = [Ticked(child, decide) for child in node.nodes]
        self.status = IDLE
        self.at = 0
        self.count = 0
        self.seen = self.first = 0
        self.actions_take_time = True

    def tick(self) -> int:
        starts = self.status in (IDLE, SKIPPED)
        afresh = starts and not any(below.at for below in self.all())
        if starts and self.node.attribute("_skipIf") and self.decide(2):
            status = SKIPPED
        elif starts and self.node.attribute("_failureIf") and self.decide(2):
            status = FAILURE
        else:
            status = getattr(self, f"tick_{self.node.head.text}")(starts)
        self.seen |= status
        self.first |= status if afresh else 0
        self.status = status
        return status

    def halt(self) -> None:
        if self.status == RUNNING:
            for child in self.children:
                child.halt()
            if self.node.head.text != "SequenceWithMemory":
                self.at = 0
            self.count = 0
        self.status = IDLE

    def reset(self) -> None:
        for child in self.children:
            child.halt()
        self.at = 0

    def tick_AlwaysSuccess(self, starts: bool) -> int:
        return SUCCESS

    def tick_AlwaysFailure(self, starts: bool) -> int:
        return FAILURE

    def tick_Check(self, starts: bool) -> int:
        return (SUCCESS, FAILURE)[self.decide(2)]

    def tick_Work(self, starts: bool) -> int:
        return RUNNING if starts and self.actions_take_time else (SUCCESS, FAILURE, RUNNING)[self.decide(3)]

    def in_order(self, goes_on: int, pauses: bool = False, remembers: bool = False) -> int:
        skipped = self.at == 0
        while self.at < len(self.children):
            child = self.children[self.at]
            started = child.status != RUNNING
            status = child.tick()
            if status == RUNNING:
                return RUNNING
            if status not in (goes_on, SKIPPED):
                at = self.at
                self.reset()
                self.at = at if remembers else 0
                return status
            skipped = skipped and status == SKIPPED
            self.at += 1
            if pauses and started and status == goes_on and self.at < len(self.children):
                return RUNNING
        self.reset()
        return SKIPPED if skipped else goes_on

    def tick_Sequence(self, starts: bool) -> int:
        return self.in_order(SUCCESS)

    def tick_Fallback(self, starts: bool) -> int:
        return self.in_order(FAILURE)

    def tick_AsyncSequence(self, starts: bool) -> int:
        return self.in_order(SUCCESS, pauses=True)

    def tick_AsyncFallback(self, starts: bool) -> int:
        return self.in_order(FAILURE, pauses=True)

    def tick_SequenceWithMemory(self, starts: bool) -> int:
        return self.in_order(SUCCESS, pauses=True, remembers=True)

    def reactive(self, goes_on: int) -> int:
        skipped = True
        for child in self.children:
            status = child.tick()
            if status == RUNNING:
                for other in self.children:
                    if other is not child:
                        other.halt()
                return RUNNING
            if status not in (goes_on, SKIPPED):
                self.reset()
                return status
            skipped = skipped and status == SKIPPED
        self.reset()
        return SKIPPED if skipped else goes_on

    def tick_ReactiveSequence(self, starts: bool) -> int:
        return self.reactive(SUCCESS)

    def tick_ReactiveFallback(self, starts: bool) -> int:
        return self.reactive(FAILURE)

    def only(self, **others: int) -> int:
        status = self.children[0].tick()
        if status != RUNNING:
            self.children[0].halt()
        return {SUCCESS: others.get("success", SUCCESS), FAILURE: others.get("failure", FAILURE)}.get(status, status)

    def tick_Inverter(self, starts: bool) -> int:
        return self.only(success=FAILURE, failure=SUCCESS)

    def tick_ForceSuccess(self, starts: bool) -> int:
        return self.only(failure=SUCCESS)

    def tick_ForceFailure(self, starts: bool) -> int:
        return self.only(success=FAILURE)

    def tick_KeepRunningUntilFailure(self, starts: bool) -> int:
        return self.only(success=RUNNING)

    def tick_Timeout(self, starts: bool) -> int:
        status = self.only()
        if status == RUNNING and not starts and self.decide(2):
            self.children[0].halt()
            return FAILURE
        return status

    def again(self, repeats: int, port: str) -> int:
        value = self.node.attribute(port)
        most = int(value.text) if value else 0
        if most == 0:
            return repeats
        status = self.only()
        if status == repeats:
            self.count += 1
            if most == -1 or self.count < most:
                return RUNNING
        if status in (SUCCESS, FAILURE):
            self.count = 0
        return status

    def tick_Repeat(self, starts: bool) -> int:
        return self.again(SUCCESS, "num_cycles")

    def tick_RetryUntilSuccessful(self, starts: bool) -> int:
        return self.again(FAILURE, "num_attempts")

    def tick_RunOnce(self, starts: bool) -> int:
        if self.count:
            return SKIPPED
        status = self.only()
        self.count = status in (SUCCESS, FAILURE)
        return status

    def tick_Precondition(self, starts: bool) -> int:
        if starts and self.decide(2):
            return FAILURE
        return self.only()

    def tick_IfThenElse(self, starts: bool) -> int:
        if self.at == 0:
            status = self.children[0].tick()
            if status in (RUNNING, SKIPPED):
                return status
            self.at = 1 if status == SUCCESS else 2
            if self.at == len(self.children):
                self.reset()
                return FAILURE
        status = self.children[self.at].tick()
        if status != RUNNING:
            self.reset()
        return status

    def tick_WhileDoElse(self, starts: bool) -> int:
        status = self.children[0].tick()
        if status in (RUNNING, SKIPPED):
            return status
        chosen = 1 if status == SUCCESS else 2
        for number, child in enumerate(self.children[1:], 1):
            if number != chosen:
                child.halt()
        if chosen == len(self.children):
            self.reset()
            return FAILURE
        status = self.children[chosen].tick()
        if status != RUNNING:
            self.reset()
        return status

    def tick_Parallel(self, starts: bool) -> int:
        """One failure fails it, and all must succeed; what has completed is not ticked again."""
        for child in self.children:
            if child.status not in (SUCCESS, FAILURE):
                child.tick()
        statuses = [child.status for child in self.children]
        if FAILURE in statuses:
            self.reset()
            return FAILURE
        if RUNNING in statuses:
            return RUNNING
        self.reset()
        return SUCCESS

    def tick_TryCatch(self, starts: bool) -> int:
        last = self.children[-1]
        if not self.count:
            tried, self.children = self.children[:-1], self.children
            whole, self.children = self.children, tried
            status = self.in_order(SUCCESS)
            self.children = whole
            if status != FAILURE:
                return status
            self.count = 1
        if last.tick() == RUNNING:
            return RUNNING
        last.halt()
        self.count = 0
        return FAILURE

    def all(self) -> Iterator[Ticked]:
        yield self
        for child in self.children:
            yield from child.all()


# ---- random trees ----

CONTROLS = (
    *("Sequence", "Fallback", "ReactiveSequence", "ReactiveFallback", "AsyncSequence", "AsyncFallback"),
    *("SequenceWithMemory", "Parallel"),
)
DECORATORS = (
    *("Inverter", "ForceSuccess", "ForceFailure", "KeepRunningUntilFailure", "RunOnce", "Timeout (msec = 5 s)"),
    *("Repeat (num_cycles = -1)", "Repeat (num_cycles = 0)", "Repeat (num_cycles = 1)", "Repeat (num_cycles = 2)"),
    *("RetryUntilSuccessful (num_attempts = -1)", "RetryUntilSuccessful (num_attempts = 0)"),
    *("RetryUntilSuccessful (num_attempts = 1)", "RetryUntilSuccessful (num_attempts = 2)"),
    'Precondition (if = "x")',
)
LEAVES = (
    *("AlwaysSuccess", "AlwaysFailure", "Condition Check", "Action Work"),
    *('AlwaysSuccess (_skipIf = "x")', 'Action Work (_skipIf = "x")', 'AlwaysSuccess (_failureIf = "x")'),
)
CONDITIONS = ("AlwaysSuccess", "AlwaysFailure", "Condition Check", "Action Work")


def indented(head: str, children: list[str]) -> str:
    return "\n".join([head, *(f"    {line}" for child in children for line in child.split("\n"))])


def larger(trees: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    some = st.lists(trees, min_size=1, max_size=3)
    two = st.lists(trees, min_size=1, max_size=2)
    return (
        st.builds(indented, st.sampled_from(CONTROLS), some)
        | st.builds(lambda head, child: indented(head, [child]), st.sampled_from(DECORATORS), trees)
        | st.builds(
            lambda head, condition, branches: indented(head, [condition, *branches]),
            st.sampled_from(("IfThenElse", "WhileDoElse")),
            st.sampled_from(CONDITIONS),
            two,
        )
        | st.builds(lambda tried, last: indented("TryCatch", [*tried, last]), two, trees)
    )


TREES = st.recursive(st.sampled_from(LEAVES), larger, max_leaves=8)


@given(TREES, st.randoms(use_true_random=False), st.booleans())
def test_no_node_returns_what_is_impossible(tree: str, random: Random, actions_take_time: bool) -> None:
    (view,) = views({"main.btq": indented("BehaviorTree Main", [tree])})
    top = Ticked(view.nodes[0].node, random.randrange)
    for ticked in top.all():
        ticked.actions_take_time = actions_take_time
    for _ in range(12):
        if top.tick() != RUNNING or random.randrange(6) == 0:
            top.halt()
    for ticked in top.all():
        found = result(view, ticked.node)
        place = f"{ticked.node.head.text} in\n{tree}"
        assert ticked.seen & ~found.ever == 0, place
        if actions_take_time:
            assert ticked.first & ~found.usual == 0, place
        elif "Timeout" not in tree:
            assert ticked.first & ~found.first == 0, place


# ---- what can be said of single nodes, and across trees ----


def test_what_is_known_of_leaves() -> None:
    text = (
        "BehaviorTree Main\n    ->\n        Action Work a\n        Condition Check b\n        Foo c\n"
        '        ScriptAction (name = "d")\n        ScriptCondition (name = "e")\n        Script f (code = "x := 1")\n'
        "        Sleep g (msec = 1 s)\n        Sleep h (msec = 0)\n        SubTree Elsewhere i\n"
    )
    leaf = SUCCESS | FAILURE | RUNNING
    anything = leaf | SKIPPED
    check = SUCCESS | FAILURE
    assert results(text) == {
        "a": Results(leaf, RUNNING, leaf),
        "b": Results(check, check, check),
        "c": Results(leaf, leaf, leaf),
        "d": Results(leaf, RUNNING, leaf),
        "e": Results(check, check, check),
        "f": Results(SUCCESS, SUCCESS, SUCCESS),
        "g": Results(RUNNING, RUNNING, SUCCESS | RUNNING),
        "h": Results(SUCCESS | RUNNING, SUCCESS | RUNNING, SUCCESS | RUNNING),
        "i": Results(anything, anything, anything),
    }


def test_a_subtree_returns_what_its_tree_does() -> None:
    text = (
        "BehaviorTree Main\n    -> top\n        SubTree Patrol patrol\n        SubTree Circle circle\n\n"
        "BehaviorTree Patrol\n    SubTree Endless\n\n"
        "BehaviorTree Endless\n    KeepRunningUntilFailure\n        Action Work\n\n"
        "BehaviorTree Circle\n    SubTree Circle\n"
    )
    found = results(text)
    assert found["patrol"] == Results(FAILURE | RUNNING, RUNNING, FAILURE | RUNNING)
    assert found["circle"].ever == SUCCESS | FAILURE | SKIPPED | RUNNING
    assert found["top"].ever == FAILURE | RUNNING


def test_a_long_chain_of_trees() -> None:
    chain = "".join(f"BehaviorTree T{n}\n    SubTree T{n + 1} s{n}\n\n" for n in range(3000))
    found = results(f"{chain}BehaviorTree T3000\n    AlwaysSuccess\n")
    assert found["s0"] == found["s2999"] == Results(SUCCESS, SUCCESS, SUCCESS)


def test_an_included_tree() -> None:
    texts = {
        "main.btq": 'include "other.btq"\n\nBehaviorTree Main\n    SubTree Other\n',
        "other.btq": "BehaviorTree Other\n    AlwaysFailure\n",
    }
    view = views(texts)[1]
    assert result(view, view.nodes[0].node).ever == FAILURE
