"""Runs files through an installed BehaviorTree.CPP: builds `main.cpp` against it, hands it jobs, reads its answers.

A version before 4.6 gets `old_main.cpp`, which knows of a job its XML, its ticks, its actions and their statuses.

One invariant: an engine that crashes or never returns is one `Answer` (`crashed`), and the jobs behind it are run.
It does not know what a right answer is.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from lxml import etree

from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.versions import at_least, is_before_4

SOURCES = Path(__file__).parent
EXPLICIT = ("Action", "Condition", "Control", "Decorator")
ANSWER = "\x1e"  # before each line that is the loader's and not the engine's

Stage = Literal["load", "create", "tick", "done"]


class NoEngine(Exception):
    """There is no compiler, no CMake, or no BehaviorTree.CPP where CMake looks."""


@dataclass(frozen=True)
class Node:
    """A node of an instantiated tree.

    Attributes:
        uid: the engine's number of it, depth first, subtrees expanded in place.
        path: what the engine calls `fullPath`.
        parent: the uid of its parent, 0 of none.
        conditions: its scripts before and after, by attribute name.
    """

    uid: int
    path: str
    ID: str
    name: str
    parent: int
    inputs: Mapping[str, str]
    outputs: Mapping[str, str]
    conditions: Mapping[str, str]


@dataclass(frozen=True)
class Answer:
    """What the engine made of a file.

    Attributes:
        stage: how far it came; `done` is the only good one.
        error: the text of the exception that ended it there.
        crashed: the signal that killed the engine meanwhile (14: it never returned), 0 of none.
        trees: the nodes of each tree that was instantiated, depth first, by the tree's ID.
        status: of the root after the last tick.
        transitions: (tick, uid, from, to), in order.
        blackboards: their values, by the path of the subtree; that of the main tree is `""`.
    """

    stage: Stage
    error: str = ""
    crashed: int = 0
    trees: Mapping[str, tuple[Node, ...]] = field(default_factory=dict)
    status: str = "IDLE"
    ticks: int = 0
    transitions: tuple[tuple[int, int, str, str], ...] = ()
    blackboards: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @property
    def tree(self) -> tuple[Node, ...]:
        """The nodes of the first tree."""
        return next(iter(self.trees.values()))

    def statuses(self, name: str) -> list[str]:
        """What the first node of an instance name went through, one after the other."""
        uid = next(node.uid for node in self.tree if node.name == name)
        return [after for _, changed, _, after in self.transitions if changed == uid]


@dataclass(frozen=True)
class Published:
    """A tree that is published while it runs: it waits before each run, and at the end."""

    process: subprocess.Popen[str]

    def go_on(self, line: str = "") -> None:
        """Let it begin the next run; after the last one, let it end."""
        assert self.process.stdin is not None
        self.process.stdin.write(f"{line}\n")

    def answer(self) -> Answer:
        """What happened, when it has ended."""
        return _answer(_told(self.process.communicate()[0])[1])


@dataclass(frozen=True)
class Engine:
    """An installed BehaviorTree.CPP, as a program that runs jobs."""

    program: Path
    version: str
    publishes: bool  # whether it was built with its Groot2Publisher
    prefix: str | None = None  # where it is installed; None: where CMake looks by itself

    @contextmanager
    def publishing(self, source: str | Path, port: int, **what: Any) -> Iterator[Published]:
        """A tree that is published while it runs.

        Args:
            what: as of `job`.
        """
        line = json.dumps(job(source, **what) | {"publish": port})
        pipe = subprocess.PIPE
        with subprocess.Popen([self.program], stdin=pipe, stdout=pipe, text=True, bufsize=1) as process:
            published = Published(process)
            try:
                published.go_on(line)
                yield published
            finally:
                process.kill()

    @property
    def is_old(self) -> bool:
        return not at_least(self.version, "4.6")

    def run(self, jobs: Iterable[Mapping[str, object]]) -> list[Answer]:
        """The answers to some jobs, see `job`, in their order."""
        if self.is_old:
            return [self._run_old(job) for job in jobs]
        waiting = [json.dumps(job) for job in jobs]
        answers: list[Answer] = []
        while waiting:
            run = subprocess.run([self.program], input="\n".join(waiting), capture_output=True, text=True)
            told = _told(run.stdout)[1:]
            answers += [_answer(each) for each in told]
            waiting = waiting[len(told) :]
            if waiting:
                assert run.returncode < 0, f"the loader ended by itself: {run.returncode} {run.stderr}"
                answers.append(Answer("load", run.stderr, -run.returncode))
                waiting = waiting[1:]
        return answers

    def run_one(self, source: str | Path, **what: Any) -> Answer:
        """The answer to one job, its arguments as of `job`."""
        return self.run([job(source, **what)])[0]

    def _run_old(self, job: Mapping[str, Any]) -> Answer:
        lines = [f"ticks {job['ticks']} {job['tick_ms']}", *(f"stub {stub['ID']}" for stub in job["stubs"])]
        for name, activations in job["parts"].items():
            lines.append(
                f"part {name} " + " / ".join(" ".join(each["status"] for each in steps) for steps in activations)
            )
        text = "\n".join((*lines, "", job["text"]))
        run = subprocess.run([self.program], input=text, capture_output=True, text=True, timeout=job["seconds"])
        return _answer(_told(run.stdout)[0])


def job(
    source: str | Path,
    *,
    stubs: Sequence[Mapping[str, object]] | None = None,
    parts: Mapping[str, Sequence[object]] | None = None,
    blackboard: Mapping[str, object] | None = None,
    ticks: int = 0,
    tick_ms: int = 0,
    halt: bool = False,
    every_tree: bool = False,
    seconds: int = 10,
    runs: int = 1,
    log: Path | None = None,
    rules: str | None = None,
) -> dict[str, object]:
    """One file to load, as the loader reads it.

    Args:
        source: a file, or XML as text.
        stubs: the custom nodes to register; those of `stubs_of(source)` by default.
        parts: what stubs do, by the path, the name or the ID of a node: a list of activations, each a list of steps,
            one a tick.  A step is a status, or a mapping with a `status` and perhaps `write` (blackboard entries),
            `output` (ports) and `ms` (how long the tick takes).  One activation may be written without its list.  What
            is not said succeeds, an action in its second tick.
        blackboard: entries there before the tree is made.
        ticks: how often the tree is ticked at most, unless it ends before; 0 of only loading it.
        tick_ms: how long to wait between ticks.
        halt: the tree is halted after the last tick.
        every_tree: every tree is instantiated, and not only the main one.
        seconds: after which the engine is said to never return.
        runs: how often the tree is run.
        log: the file in which the engine's FileLogger2 logs the ticks, a .btlog.
        rules: substitution rules, as JSON.
    """
    asked: dict[str, object] = {"file": str(source)} if isinstance(source, Path) else {"text": source}
    asked["stubs"] = list(stubs_of(source) if stubs is None else stubs)
    asked["parts"] = {name: _activations(said) for name, said in (parts or {}).items()}
    asked |= {"blackboard": dict(blackboard or {}), "ticks": ticks, "tick_ms": tick_ms, "halt": halt}
    asked |= {"every_tree": every_tree, "seconds": seconds, "runs": runs}
    asked |= {"log": str(log)} if log is not None else {}
    return asked | ({"rules": rules} if rules is not None else {})


def stubs_of(source: str | Path) -> list[dict[str, Any]]:
    """The custom nodes of a file and of what it includes: those of its models, and those it uses without a model.

    A node with a model has the ports of the model alone; one without has those that are written somewhere.
    """
    modelled: dict[str, dict[str, object]] = {}
    used: dict[str, dict[str, Any]] = {}
    for root in _documents(source):
        for model in root.iterfind("TreeNodesModel/*"):
            if model.tag in EXPLICIT:
                modelled.setdefault(model.get("ID", ""), _modelled(model))
        for tree in root.iterfind("BehaviorTree"):
            for element in tree.iterdescendants(etree.Element):
                _note_use(element, used)
    stubs = {**used, **modelled}
    return [stub for ID, stub in stubs.items() if ID and ID not in BUILTINS and ID != "SubTree"]


def build_engine(prefix: str | None, folder: Path) -> Engine:
    """The loader, built against the engine in a prefix, or where CMake looks by itself.

    Args:
        prefix: its name ends in the version of an engine before 4.6.
        folder: where it is built; what is there is used again while sources and prefix are the same.

    Raises:
        NoEngine: there is nothing to build it with or against.
        subprocess.CalledProcessError: it cannot be built.
    """
    if not shutil.which("cmake"):
        raise NoEngine("no cmake on PATH")
    # An old engine does not say what it is.
    named = re.search(r"\d+(\.\d+)+$", prefix or "")
    old = named[0] if named and not at_least(named[0], "4.6") else None
    main = "old_main.cpp" if old else "main.cpp"
    sources = b"".join((SOURCES / name).read_bytes() for name in ("CMakeLists.txt", main))
    # What CMake finds by itself depends on where a sourced ROS points it.
    found_by = prefix or ":".join(os.environ.get(name, "") for name in ("CMAKE_PREFIX_PATH", "AMENT_PREFIX_PATH"))
    build = folder / hashlib.sha256(sources + found_by.encode()).hexdigest()[:16]
    program = build / "loader"
    if not program.exists():
        configure = ["cmake", "-S", str(SOURCES), "-B", str(build), f"-DMAIN={main}"]
        if old and is_before_4(old):
            configure.append("-DPACKAGE=behaviortree_cpp_v3")
        run = subprocess.run(
            configure + ([f"-DCMAKE_PREFIX_PATH={prefix}"] if prefix else []), capture_output=True, text=True
        )
        if run.returncode:
            shutil.rmtree(build, ignore_errors=True)  # what CMake did not find it would not look for again
            raise NoEngine(_why_not(run.stderr))
        subprocess.run(["cmake", "--build", str(build)], check=True, capture_output=True, text=True)
    if old:
        return Engine(program, old, publishes=False)
    hello = subprocess.run([program], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True)
    about = _told(hello.stdout)[0]
    return Engine(program, about["engine"], about["publishes"], prefix)


def _why_not(complaint: str) -> str:
    if "behaviortree_cpp" in complaint:
        return "no behaviortree_cpp found by CMake"
    if "No CMAKE_CXX_COMPILER" in complaint:
        return "no C++ compiler found by CMake"
    return f"CMake cannot configure the loader: {complaint}"


def _told(output: str) -> list[dict[str, Any]]:
    return [json.loads(piece.partition("\n")[0]) for piece in output.split(ANSWER)[1:]]


def _answer(told: dict[str, Any]) -> Answer:
    trees = {tree["ID"]: tuple(Node(**node) for node in tree["nodes"]) for tree in told.pop("trees")}
    transitions = tuple((tick, uid, before, after) for tick, uid, before, after in told.pop("transitions", ()))
    return Answer(trees=trees, transitions=transitions, **told)


def _activations(said: Sequence[Any]) -> list[list[dict[str, object]]]:
    activations = said if said and isinstance(said[0], list) else [said]
    return [[{"status": step} if isinstance(step, str) else dict(step) for step in each] for each in activations]


def _documents(source: str | Path, seen: frozenset[Path] = frozenset()) -> Iterable[etree._Element]:
    # As forgiving as the engine's reader, which takes what is not well-formed.
    parser = etree.XMLParser(recover=True, resolve_entities=False, huge_tree=True)
    data = source.read_bytes() if isinstance(source, Path) else source.encode()
    root = etree.fromstring(data, parser)
    if root is None:
        return
    yield root
    if isinstance(source, Path):
        for include in root.iterfind("include"):
            path = (source.parent / include.get("path", "")).resolve()
            if path.is_file() and path not in seen:
                yield from _documents(path, seen | {path})


def _modelled(model: etree._Element) -> dict[str, object]:
    ports = [
        {"name": port.get("name"), "direction": str(port.tag).removesuffix("_port"), "type": port.get("type", "")}
        for port in model
        if isinstance(port.tag, str) and port.tag.endswith("_port")
    ]
    return {"ID": model.get("ID"), "category": model.tag, "ports": ports}


def _note_use(element: etree._Element, used: dict[str, dict[str, Any]]) -> None:
    tag = str(element.tag)
    ID = element.get("ID", "") if tag in EXPLICIT else tag
    children = len(list(element.iterchildren(etree.Element)))
    category = tag if tag in EXPLICIT else ("Action", "Decorator")[children] if children < 2 else "Control"
    stub = used.setdefault(ID, {"ID": ID, "category": category, "ports": []})
    known = {port["name"] for port in stub["ports"]}
    stub["ports"] += [
        {"name": str(name), "direction": "inout"}
        for name in element.attrib
        if name not in known and is_port_name(str(name))
    ]
