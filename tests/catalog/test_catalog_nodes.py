"""The node table, compared with what the engines print of themselves, and the look-ups of words and ports."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.kinds import RESULT
from btq_lang.catalog.nodes import (
    BUILTINS,
    KNOWN_WORDS,
    OLD_PORTS,
    PLACEHOLDERS,
    NodeKind,
    available,
    lookup,
    of_version,
    spellings,
    xml_tag,
)
from btq_lang.catalog.units import parse_unit
from btq_lang.catalog.versions import DEFAULT_VERSION, VERSIONS, at_least
from btq_lang.syntax.tokens import SYMBOLS


@pytest.mark.parametrize("version", VERSIONS)
def test_the_table_is_what_the_engine_prints(version: str, shared: Path) -> None:
    printed = json.loads((shared / "facts" / f"btcpp-builtin-nodes-{version}.json").read_text(encoding="utf-8"))
    assert [as_printed(kind, version) for kind in sorted_kinds(version)] == [
        {**node, "ports": [{k: v for k, v in port.items() if k != "description"} for port in node["ports"]]}
        for node in printed
    ]


def sorted_kinds(version: str) -> list[NodeKind]:
    return [kind for _, kind in sorted(BUILTINS.items()) if available(kind, version)]


def as_printed(kind: NodeKind, version: str) -> dict[str, object]:
    ports = [
        {
            "name": port.name,
            "dir": {"input": "Input", "output": "Output", "inout": "InOut"}[port.direction],
            "type": of_version(port, version).type,
            "has_default": port.default is not None,
            "default": port.default or "",
        }
        for port in sorted(kind.ports, key=lambda port: port.name)
    ]
    return {"id": kind.tag, "category": kind.category, "ports": ports}


def test_versions_are_numbers() -> None:
    assert VERSIONS == ("4.6", "4.8", "4.10")
    assert DEFAULT_VERSION == "4.10"
    assert at_least("4.10", "4.9")
    assert at_least("4.10", "4.10")
    assert at_least("4.9.1", "4.9")
    assert not at_least("4.8", "4.10")


def test_only_trycatch_and_the_loops_queue_depend_on_the_version() -> None:
    assert [kind.tag for kind in BUILTINS.values() if not available(kind, "4.8")] == ["TryCatch"]
    changed = {
        f"{kind.tag}.{port.name}"
        for kind in BUILTINS.values()
        for port in kind.ports
        if of_version(port, "4.8") != of_version(port, "4.10")
    }
    assert changed == {"LoopInt.queue", "LoopBool.queue", "LoopDouble.queue", "LoopString.queue"}


def test_every_row_is_documented() -> None:
    for kind in BUILTINS.values():
        assert kind.doc.endswith("."), kind.tag
        assert len(kind.doc) < 90, kind.tag
        assert kind.semantics.endswith("."), kind.tag
        assert [port.name for port in kind.ports if not port.doc] == [], kind.tag


@pytest.mark.parametrize(
    ("category", "children"),
    [("Action", (0, 0)), ("Condition", (0, 0)), ("SubTree", (0, 0)), ("Decorator", (1, 1))],
)
def test_children_follow_the_category(category: str, children: tuple[int, int]) -> None:
    found = {kind.children for kind in BUILTINS.values() if kind.category == category}
    assert found == {children}


def test_children_of_control_nodes() -> None:
    counts = {kind.tag: kind.children for kind in BUILTINS.values() if kind.category == "Control"}
    exceptions = {tag: children for tag, children in counts.items() if children != (1, None)}
    assert exceptions == {
        "IfThenElse": (2, 3),
        "WhileDoElse": (2, 3),
        "Switch2": (3, 3),
        "Switch3": (4, 4),
        "Switch4": (5, 5),
        "Switch5": (6, 6),
        "Switch6": (7, 7),
        "TryCatch": (2, None),
    }
    late = {kind.tag for kind in BUILTINS.values() if kind.late_count}
    assert late == exceptions.keys() - {"TryCatch"}


def test_who_returns_running_by_itself() -> None:
    by_execution = {
        execution: {kind.tag for kind in BUILTINS.values() if kind.execution == execution}
        for execution in ("synchronous", "asynchronous")
    }
    assert by_execution == {
        "synchronous": {
            *("AlwaysSuccess", "AlwaysFailure", "Script", "ScriptCondition", "SetBlackboard", "UnsetBlackboard"),
            "WasEntryUpdated",
        },
        "asynchronous": {
            *("AsyncSequence", "AsyncFallback", "SequenceWithMemory", "Repeat", "RetryUntilSuccessful", "Delay"),
            *("KeepRunningUntilFailure", "LoopInt", "LoopBool", "LoopDouble", "LoopString", "WaitValueUpdate", "Sleep"),
        },
    }
    reactive = {kind.tag for kind in BUILTINS.values() if kind.reactive}
    assert reactive == {"ReactiveSequence", "ReactiveFallback", "WhileDoElse"}


def test_nodes_that_share_a_flow() -> None:
    flows: dict[str, list[str]] = {}
    for kind in BUILTINS.values():
        flows.setdefault(kind.flow, []).append(kind.tag)
    assert {flow: tags for flow, tags in flows.items() if len(tags) > 1} == {
        "sequence": ["Sequence", "ReactiveSequence", "SequenceWithMemory", "AsyncSequence"],
        "fallback": ["Fallback", "ReactiveFallback", "AsyncFallback"],
        "choice": ["IfThenElse", "WhileDoElse"],
        "switch": [f"Switch{cases}" for cases in range(2, 7)],
        "for-each": ["LoopInt", "LoopBool", "LoopDouble", "LoopString"],
        "succeeds": ["AlwaysSuccess", "Script", "SetBlackboard", "UnsetBlackboard"],
        "answers": ["ScriptCondition", "WasEntryUpdated"],
    }
    assert flows[""] == ["SubTree"]


def test_roles_of_ports() -> None:
    ports = [(f"{kind.tag}.{port.name}", port) for kind in BUILTINS.values() for port in kind.ports]
    assert {name: port.role for name, port in ports if port.role} == {
        "Parallel.success_count": "successes",
        "Parallel.failure_count": "failures",
        "ParallelAll.max_failures": "failures",
        "Repeat.num_cycles": "count",
        "RetryUntilSuccessful.num_attempts": "count",
        "Timeout.msec": "time",
        "Delay.delay_msec": "time",
        "Sleep.msec": "time",
        "Precondition.else": "otherwise",
        "SetBlackboard.value": "copied",
        **{f"Loop{item}.if_empty": "otherwise" for item in ("Int", "Bool", "Double", "String")},
    }
    assert [name for name, port in ports if port.removes] == ["UnsetBlackboard.key"]


def test_required_ports() -> None:
    required = {kind.tag: [port.name for port in kind.ports if port.required] for kind in BUILTINS.values()}
    assert {tag: names for tag, names in required.items() if names} == {
        "Repeat": ["num_cycles"],
        "RetryUntilSuccessful": ["num_attempts"],
        "Timeout": ["msec"],
        "Delay": ["delay_msec"],
        "Sleep": ["msec"],
        "Precondition": ["if"],
        **{f"Loop{kind}": ["queue"] for kind in ("Int", "Bool", "Double", "String")},
        **{tag: ["entry"] for tag in ("SkipUnlessUpdated", "WaitValueUpdate", "WasEntryUpdated")},
        "Script": ["code"],
        "ScriptCondition": ["code"],
        "SetBlackboard": ["value", "output_key"],
        "UnsetBlackboard": ["key"],
    }


def test_units_and_contents_of_ports() -> None:
    ports = [(f"{kind.tag}.{port.name}", port) for kind in BUILTINS.values() for port in kind.ports]
    units = {name: port.unit for name, port in ports if port.unit is not None}
    assert units == {"Timeout.msec": "ms", "Delay.delay_msec": "ms", "Sleep.msec": "ms"}
    assert all(parse_unit(unit) is not None for unit in units.values())
    assert {name for name, port in ports if port.content == "script"} == {
        *("Script.code", "ScriptCondition.code", "Precondition.if")
    }
    assert {name for name, port in ports if port.content == "key"} == {
        *("SetBlackboard.output_key", "UnsetBlackboard.key"),
        *("SkipUnlessUpdated.entry", "WaitValueUpdate.entry", "WasEntryUpdated.entry"),
    }
    assert {name: port.literal for name, port in ports if port.literal is not None} == {
        "LoopInt.queue": "std::deque<int>",
        "LoopBool.queue": "std::deque<bool>",
        "LoopDouble.queue": "std::deque<double>",
        "LoopString.queue": "std::deque<std::string>",
        **{f"Loop{item}.if_empty": RESULT for item in ("Int", "Bool", "Double", "String")},
        "Precondition.else": RESULT,
    }


def test_port_look_up() -> None:
    found = BUILTINS["Timeout"].port("msec")
    assert found is not None
    assert found.name == "msec"
    assert BUILTINS["Timeout"].port("sec") is None


# Section 5 of the language page, and the symbols of section 2.
TABLE = {
    "->": "Sequence",
    "→": "Sequence",
    "?": "Fallback",
    "||": "Parallel",
    "⇉": "Parallel",
    "All||": "ParallelAll",
    "All⇉": "ParallelAll",
    "R->": "ReactiveSequence",
    "R→": "ReactiveSequence",
    "R?": "ReactiveFallback",
    "M->": "SequenceWithMemory",
    "M→": "SequenceWithMemory",
    "A->": "AsyncSequence",
    "A→": "AsyncSequence",
    "A?": "AsyncFallback",
    "Retry": "RetryUntilSuccessful",
    "Loop": "LoopDouble",
    "ScriptAction": "Script",
    "Switch": "Switch2",
    "EntryUpdatedAction": "WasEntryUpdated",
    "EntryUpdatedDecorator": "SkipUnlessUpdated",
}


@pytest.mark.parametrize(("word", "tag"), TABLE.items())
def test_symbols_and_aliases(word: str, tag: str) -> None:
    kind = lookup(word)
    assert kind is BUILTINS[tag]
    assert kind is not None
    assert word in spellings(kind)
    assert xml_tag(word) == tag
    assert lookup(word, quoted=True) is None
    assert xml_tag(word, quoted=True) == word


def test_the_table_of_aliases_is_complete() -> None:
    found = {word for kind in BUILTINS.values() for word in spellings(kind) if word != kind.tag}
    assert found == TABLE.keys()
    assert set(SYMBOLS) == {word for word in TABLE if not word.isidentifier()}


@pytest.mark.parametrize("tag", sorted(BUILTINS))
def test_every_built_in_is_its_own_tag_quoted_or_not(tag: str) -> None:
    assert lookup(tag) is lookup(tag, quoted=True) is BUILTINS[tag]
    assert xml_tag(tag) == tag


@pytest.mark.parametrize(
    ("children", "tag"),
    [(None, "Switch2"), (0, "Switch2"), (3, "Switch2"), (4, "Switch3"), (6, "Switch5"), (7, "Switch6"), (9, "Switch6")],
)
def test_switch_by_its_children(children: int | None, tag: str) -> None:
    assert xml_tag("Switch", child_count=children) == tag
    assert xml_tag("Switch4", child_count=children) == "Switch4"


@pytest.mark.parametrize("word", ["MoveBase", "sequence", "", "Action", "retry", "->>", "SWITCH"])
def test_everything_else_is_a_custom_node(word: str) -> None:
    assert lookup(word) is None
    assert xml_tag(word) == word


def test_words_that_are_no_nodes_of_the_engine() -> None:
    assert {known.word: known.replacement for known in KNOWN_WORDS.values()} == {
        **dict.fromkeys(("Test", "ThreadedAction", "CoroAction", "ManualSelector", "ConsumeQueue", "PopFromQueue")),
        **dict.fromkeys(("QueueSize", "StatefulAction", "SyncAction", "SubTreePlus")),
        **dict.fromkeys(f"BlackboardCheck{kind}" for kind in ("Int", "Double", "String", "Bool")),
        "SequenceStar": "SequenceWithMemory",
        "FallbackStar": "Fallback",
        "RetryUntilSuccesful": "RetryUntilSuccessful",
    }
    for word, known in KNOWN_WORDS.items():
        assert lookup(word) is None
        assert xml_tag(word) == known.tag == ("TestNode" if word == "Test" else word)
        assert xml_tag(word, quoted=True) == word
        assert known.replacement is None or known.replacement in BUILTINS
        assert word in known.why or known.tag in known.why


def test_placeholders_are_the_script_nodes() -> None:
    assert {word: (xml_tag(word), category) for word, category in PLACEHOLDERS.items()} == {
        "ScriptAction": ("Script", "Action"),
        "Script": ("Script", "Action"),
        "ScriptCondition": ("ScriptCondition", "Condition"),
    }


def test_old_ports_lead_to_ports() -> None:
    for (tag, old), new in OLD_PORTS.items():
        assert BUILTINS[tag].port(old) is None
        assert BUILTINS[tag].port(new) is not None


def test_reserved_attributes() -> None:
    groups = {
        group: [kind.name for kind in RESERVED_ATTRIBUTES.values() if kind.group == group]
        for group in ("pre", "post", "engine", "tool")
    }
    assert groups == {
        "pre": ["_failureIf", "_successIf", "_skipIf", "_while"],
        "post": ["_onHalted", "_onSuccess", "_onFailure", "_post"],
        "engine": ["_autoremap"],
        "tool": [
            *("_description", "_collapsed", "_favorite", "_hardcoded", "_subtreeOnly", "_fullpath", "_uid", "_btq"),
            *("__shared_blackboard", "__autoremap"),
        ],
    }
    assert [name for name, kind in RESERVED_ATTRIBUTES.items() if kind.is_script] == groups["pre"] + groups["post"]
    assert all(kind.doc for kind in RESERVED_ATTRIBUTES.values())
