"""A small model of the engine's nodes, to hold budgets against: it runs trees whose leaves take what time they like.

Time is continuous: a tick costs nothing, and the tree is ticked whenever something happens, and sometimes between.
Written after the behaviour of BehaviorTree.CPP 4.10; nothing in it knows how budgets are computed.
"""

from __future__ import annotations

import random
from collections.abc import Callable

from btq_lang.requirements.model import Quantity
from btq_lang.requirements.resolve import Requirements
from btq_lang.workspace.resolved import ResolvedNode

SUCCESS, FAILURE, SKIPPED, RUNNING, IDLE = "success", "failure", "skip", "running", "idle"
Report = Callable[[ResolvedNode, str, float], None]


class Endless(Exception):
    """The run has gone on for so long that it is not worth waiting for its end."""


class Run:
    """Runs of one tree, one after the other: what a node remembers from one to the next it keeps."""

    last = 500.0  # s, when a run that still goes on counts as endless

    def __init__(self, found: Requirements, root: ResolvedNode, seed: int, report: Report) -> None:
        self.found = found
        self.chance = random.Random(seed)
        self.now = 0.0
        self.alarms: list[float] = []  # when something happens next
        self.wakes = False  # something asks to be ticked again at once
        self.report = report
        self.root = make(self, root)

    def change(self, node: Sim, status: str) -> None:
        """A node's status changes: nothing is done with it here."""

    def drawn(self, leaf: ResolvedNode) -> float:
        """A duration that the leaf's `takes between` allows, often one of the ends."""
        (applied,) = [each for each in self.found.applied if each.node is leaf]
        limit = applied.requirement.claims[0].limit
        assert limit is not None
        assert isinstance(limit.value, Quantity)
        assert isinstance(limit.upper, Quantity)
        low, high = limit.value.si, limit.upper.si
        return self.chance.choice([low, high, self.chance.randint(int(low * 4), int(high * 4)) / 4])

    def ended(self, leaf: ResolvedNode) -> str:
        """How an activation of the leaf ends."""
        return self.chance.choice([SUCCESS, FAILURE])

    def answer(self, condition: ResolvedNode) -> str:
        """What a condition says when it is asked."""
        return self.chance.choice([SUCCESS, SUCCESS, SUCCESS, FAILURE])

    def mission(self) -> None:
        """One run, from the first tick to the end.

        Raises:
            Endless: it has none.
        """
        idle = 0
        for _ in range(400):
            self.alarms, self.wakes = [], False
            if self.root.execute() != RUNNING:
                return
            later = [alarm for alarm in self.alarms if alarm > self.now]
            idle = 0 if later and not self.wakes else idle + 1
            if idle > 20 or self.now > self.last:
                break
            if later and not self.wakes:
                following = min(later)
                between = self.chance.choice([0.25, 0.5, 1.0, 1.0, 1.0])
                self.now += (following - self.now) * between
        raise Endless


class Sim:
    """A node at run time.  Subclasses say what a tick does, and what is forgotten when it is over or halted."""

    def __init__(self, run: Run, source: ResolvedNode) -> None:
        self.run = run
        self.source = source
        self.started: float | None = None
        self.children = [make(run, child) for child in source.children]
        self.keys = {pair.key.text for pair in source.node.attributes}
        self.begin()

    def execute(self) -> str:
        chance = self.run.chance
        is_new = self.started is None
        if is_new:
            self.started = self.run.now
            if "_failureIf" in self.keys and chance.random() < 0.3:
                return self.end(FAILURE)
            if "_successIf" in self.keys and chance.random() < 0.3:
                return self.end(SUCCESS)
            if self.keys & {"_skipIf", "_while"} and chance.random() < 0.3:
                return self.end(SKIPPED)
        elif "_while" in self.keys and chance.random() < 0.2:
            for child in self.children:
                child.halt()
            self.halted()
            return self.end(SKIPPED)
        if is_new and self.children:
            self.run.change(self, RUNNING)
        status = self.tick()
        if is_new and not self.children and status == RUNNING:
            self.run.change(self, RUNNING)
        return status if status == RUNNING else self.end(status)

    def end(self, status: str) -> str:
        assert self.started is not None
        self.run.report(self.source, status, self.run.now - self.started)
        self.run.change(self, status)
        self.started = None
        if status != SKIPPED:
            self.begin()
        return status

    def halt(self) -> None:
        if self.started is not None:
            for child in self.children:
                child.halt()
            self.started = None
            self.halted()
            self.run.change(self, IDLE)

    def halted(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Forget."""

    def tick(self) -> str:
        raise NotImplementedError

    def pause(self) -> str:
        """RUNNING, though nothing is waited for."""
        self.run.wakes = True
        return RUNNING

    def number(self, port: str, default: int) -> int:
        word = self.source.node.attribute(port)
        return int(word.text) if word is not None else default

    @property
    def child(self) -> Sim:
        (child,) = self.children
        return child


class Leaf(Sim):
    length: float | None

    def tick(self) -> str:
        if self.source.tag in ("AlwaysSuccess", "Script"):
            return SUCCESS
        if self.source.tag == "AlwaysFailure":
            return FAILURE
        if self.source.category == "Condition":
            return self.run.answer(self.source)
        assert self.started is not None
        if self.length is None:
            self.length = self.number("msec", 0) / 1000 if self.source.tag == "Sleep" else self.run.drawn(self.source)
        if self.run.now < self.started + self.length:
            self.run.alarms.append(self.started + self.length)
            return RUNNING
        return SUCCESS if self.source.tag == "Sleep" else self.run.ended(self.source)

    def begin(self) -> None:
        self.length = None


class InOrder(Sim):
    """Sequence, Fallback, and what is like them."""

    def __init__(self, run: Run, source: ResolvedNode) -> None:
        self.goes, self.ends = (FAILURE, SUCCESS) if "Fallback" in source.tag else (SUCCESS, FAILURE)
        super().__init__(run, source)

    def begin(self) -> None:
        self.at = 0
        self.passed = False

    def tick(self) -> str:
        while self.at < len(self.children):
            before = self.run.now if self.children[self.at].started is None else None
            status = self.children[self.at].execute()
            if status in (RUNNING, self.ends):
                return status
            self.at += 1
            self.passed = self.passed or status == self.goes
            if self.source.tag.startswith("Async") and before is not None and self.at < len(self.children):
                return self.pause()
        return self.over()

    def over(self) -> str:
        status = self.goes if self.passed else SKIPPED
        self.begin()
        return status


class WithMemory(InOrder):
    """A failure and a halt leave it where it is."""

    def end(self, status: str) -> str:
        at, passed = self.at, self.passed
        super().end(status)
        if status == FAILURE:
            self.at, self.passed = at, passed
        return status

    def halted(self) -> None:
        pass


class Reactive(InOrder):
    def tick(self) -> str:
        passed = False
        for child in self.children:
            status = child.execute()
            if status in (RUNNING, self.ends):
                for other in self.children:
                    if other is not child:
                        other.halt()
                return status
            passed = passed or status == self.goes
        return self.goes if passed else SKIPPED


class Parallel(Sim):
    def begin(self) -> None:
        self.done: dict[int, str] = {}

    def tick(self) -> str:
        n = len(self.children)
        wanted, failures = self.number("success_count", -1), self.number("failure_count", 1)
        needed = wanted if wanted >= 0 else n + wanted + 1
        most = failures if failures >= 0 else n + failures + 1
        skipped = 0
        for index, child in enumerate(self.children):
            if index not in self.done:
                status = child.execute()
                if status in (SUCCESS, FAILURE):
                    self.done[index] = status
                skipped += status == SKIPPED
            succeeded = list(self.done.values()).count(SUCCESS)
            failed = list(self.done.values()).count(FAILURE)
            if succeeded >= needed or (wanted < 0 and succeeded + skipped >= needed):
                return self.stop(SUCCESS)
            if n - failed < needed or failed == most:
                return self.stop(FAILURE)
        return SKIPPED if skipped == n else RUNNING

    def stop(self, status: str) -> str:
        for child in self.children:
            child.halt()
        return status


class ParallelAll(Sim):
    def begin(self) -> None:
        self.done: dict[int, str] = {}

    def tick(self) -> str:
        n = len(self.children)
        skipped = 0
        for index, child in enumerate(self.children):
            if index not in self.done:
                status = child.execute()
                skipped += status == SKIPPED
                if status in (SUCCESS, FAILURE):
                    self.done[index] = status
        if skipped == n:
            return SKIPPED
        if len(self.done) + skipped < n:
            return RUNNING
        failed = list(self.done.values()).count(FAILURE)
        most = self.number("max_failures", 1)
        return FAILURE if failed >= (most if most >= 0 else n + most + 1) else SUCCESS


class IfThenElse(Sim):
    def begin(self) -> None:
        self.at = 0

    def tick(self) -> str:
        if self.at == 0:
            status = self.children[0].execute()
            if status == RUNNING:
                return RUNNING
            self.at = 1 if status == SUCCESS else 2
        if self.at == len(self.children):
            return FAILURE
        status = self.children[self.at].execute()
        if status != RUNNING:
            self.begin()
        return status


class WhileDoElse(Sim):
    def tick(self) -> str:
        status = self.children[0].execute()
        if status == RUNNING:
            return RUNNING
        chosen = 1 if status == SUCCESS else 2
        for index, child in enumerate(self.children[1:], 1):
            if index != chosen:
                child.halt()
        return self.children[chosen].execute() if chosen < len(self.children) else FAILURE


class Switch(Sim):
    """Its variable does not change while it runs."""

    def begin(self) -> None:
        self.chosen: Sim | None = None

    def tick(self) -> str:
        if self.chosen is None:
            self.chosen = self.run.chance.choice(self.children)
        status = self.chosen.execute()
        if status != RUNNING:
            self.chosen = None
        return status


class TryCatch(InOrder):
    def begin(self) -> None:
        super().begin()
        self.caught = False

    def tick(self) -> str:
        *tried, catch = self.children
        while not self.caught and self.at < len(tried):
            status = tried[self.at].execute()
            if status == RUNNING:
                return RUNNING
            self.caught = status == FAILURE
            self.passed = self.passed or status == SUCCESS
            self.at += 1
        if self.caught:
            return RUNNING if catch.execute() == RUNNING else FAILURE
        return self.over()


class Again(Sim):
    """Repeat and RetryUntilSuccessful; a skip leaves the count as it is."""

    def begin(self) -> None:
        self.count = 0

    def tick(self) -> str:
        repeat = self.source.tag == "Repeat"
        goes, most = (SUCCESS, self.number("num_cycles", 1)) if repeat else (FAILURE, self.number("num_attempts", 1))
        if most == 0:
            return goes
        status = self.child.execute()
        if status != goes:
            return status
        self.count += 1
        return self.pause() if most == -1 or self.count < most else goes


class Decorator(Sim):
    def tick(self) -> str:
        tag = self.source.tag
        status = self.child.execute()
        if status in (RUNNING, SKIPPED):
            return self.pause() if tag == "KeepRunningUntilFailure" and status == SKIPPED else status
        if tag == "Inverter":
            return FAILURE if status == SUCCESS else SUCCESS
        if tag == "KeepRunningUntilFailure":
            return self.pause() if status == SUCCESS else FAILURE
        return {"ForceSuccess": SUCCESS, "ForceFailure": FAILURE}[tag]


class Timeout(Sim):
    def tick(self) -> str:
        assert self.started is not None
        status = self.child.execute()
        seconds = self.number("msec", 0) / 1000
        if status != RUNNING or seconds == 0.0:
            return status
        if self.run.now >= self.started + seconds:
            self.child.halt()
            return FAILURE
        self.run.alarms.append(self.started + seconds)
        return RUNNING


class Delay(Sim):
    def tick(self) -> str:
        assert self.started is not None
        ready = self.started + self.number("delay_msec", 0) / 1000
        if self.run.now < ready:
            self.run.alarms.append(ready)
            return RUNNING
        return self.child.execute()


class RunOnce(Sim):
    result: str | None = None

    def tick(self) -> str:
        if self.result is not None:
            return SKIPPED if "then_skip" not in self.keys else self.result
        status = self.child.execute()
        if status in (SUCCESS, FAILURE):
            self.result = status
        return status


class Precondition(Sim):
    def begin(self) -> None:
        self.asked = False

    def tick(self) -> str:
        if not self.asked and self.run.chance.random() < 0.3:
            word = self.source.node.attribute("else")
            return {"SUCCESS": SUCCESS, "SKIPPED": SKIPPED}.get(word.text if word else "", FAILURE)
        self.asked = True
        status = self.child.execute()
        if status == SKIPPED:
            self.asked = False
        return status


# ---- Nav2's nodes, after its code for Lyrical ----


class Pipeline(Sim):
    def begin(self) -> None:
        self.furthest = 0

    def tick(self) -> str:
        skipped = 0
        for index, child in enumerate(self.children):
            status = child.execute()
            if status == FAILURE:
                return self.over(FAILURE)
            if status == RUNNING and index >= self.furthest:
                self.furthest = index
                return RUNNING
            skipped += status == SKIPPED
        return self.over(SKIPPED if skipped == len(self.children) else SUCCESS)

    def over(self, status: str) -> str:
        for child in self.children:
            child.halt()
        self.begin()
        return status


class Recovery(Sim):
    count = 0  # a skip of the second child keeps it

    def begin(self) -> None:
        self.at = 0

    def halted(self) -> None:
        self.at = self.count = 0

    def tick(self) -> str:
        first, second = self.children
        while True:
            if self.at == 0:
                status = first.execute()
                if status != FAILURE or self.count >= self.number("number_of_retries", 1):
                    self.count = 0 if status != RUNNING else self.count
                    return status
                self.at = 1
            status = second.execute()
            if status == RUNNING:
                return RUNNING
            self.at = 0
            if status != SUCCESS:
                self.count = 0 if status == FAILURE else self.count
                return FAILURE
            self.count += 1


class RoundRobin(Sim):
    at = 0

    def begin(self) -> None:
        self.failed = 0

    def halted(self) -> None:
        self.at = self.failed = 0

    def tick(self) -> str:
        skipped, n = 0, len(self.children)
        word = self.source.node.attribute("wrap_around")
        wraps = word is not None and word.text == "true"
        while self.failed + skipped < n:
            status = self.children[self.at].execute()
            if status == RUNNING:
                return RUNNING
            self.at += 1
            skipped += status == SKIPPED
            self.failed += status == FAILURE
            if self.at == n and not wraps:
                break
            self.at %= n
            if status == SUCCESS:
                self.failed = 0
                return SUCCESS
        self.halted()
        return SKIPPED if skipped == n else FAILURE


class Nonblocking(Sim):
    def tick(self) -> str:
        found = []
        for child in self.children:
            found.append(child.execute())
            if found[-1] == FAILURE:
                break
        if RUNNING in found and FAILURE not in found:
            return RUNNING
        for child in self.children:
            child.halt()
        return found[-1] if FAILURE in found else SUCCESS


class Persistent(Sim):
    at = 0

    def tick(self) -> str:
        while self.at < len(self.children):
            status = self.children[self.at].execute()
            if status == RUNNING:
                return RUNNING
            self.at += 1
            if status == FAILURE:
                break
        else:
            status = SUCCESS
        self.at = 0
        return status


class PathLonger(Sim):
    """The path does not change while its child runs."""

    def tick(self) -> str:
        is_longer = self.child.started is not None or self.run.chance.random() < 0.5
        return self.child.execute() if is_longer else SUCCESS


class Through(Sim):
    """GoalUpdater, and a RateController that its parent has reset."""

    def tick(self) -> str:
        return self.child.execute()


class ByDistance(Sim):
    def tick(self) -> str:
        if self.run.chance.random() < 0.1:
            self.child.halt()
            return FAILURE
        return self.child.execute()


class SubTree(Sim):
    def __init__(self, run: Run, source: ResolvedNode) -> None:
        super().__init__(run, source)
        root = run.found.nodes.run_by(source)
        assert root is not None
        self.children = [make(run, root)]

    def tick(self) -> str:
        return self.child.execute()


_CLASSES: dict[str, type[Sim]] = {
    "Sequence": InOrder,
    "AsyncSequence": InOrder,
    "Fallback": InOrder,
    "AsyncFallback": InOrder,
    "SequenceWithMemory": WithMemory,
    "ReactiveSequence": Reactive,
    "ReactiveFallback": Reactive,
    "Parallel": Parallel,
    "ParallelAll": ParallelAll,
    "IfThenElse": IfThenElse,
    "WhileDoElse": WhileDoElse,
    "Switch2": Switch,
    "TryCatch": TryCatch,
    "RetryUntilSuccessful": Again,
    "Repeat": Again,
    "Timeout": Timeout,
    "Delay": Delay,
    "RunOnce": RunOnce,
    "Precondition": Precondition,
    "Inverter": Decorator,
    "ForceSuccess": Decorator,
    "ForceFailure": Decorator,
    "KeepRunningUntilFailure": Decorator,
    "PipelineSequence": Pipeline,
    "RecoveryNode": Recovery,
    "RoundRobin": RoundRobin,
    "NonblockingSequence": Nonblocking,
    "PersistentSequence": Persistent,
    "PathLongerOnApproach": PathLonger,
    "GoalUpdater": Through,
    "RateController": Through,
    "SingleTrigger": Through,
    "DistanceController": ByDistance,
}


def make(run: Run, source: ResolvedNode) -> Sim:
    if source.category == "SubTree":
        return SubTree(run, source)
    return _CLASSES.get(source.behavior.tag if source.behavior is not None else "", Leaf)(run, source)
