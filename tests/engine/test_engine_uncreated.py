"""Trees that a program loads and does not create: the engine does not refuse what is wrong in them."""

from __future__ import annotations

from engine_loader import Engine

from btq_lang.btcpp.opening import file_of
from btq_lang.checks import check
from btq_lang.checks.trees import AT_CREATION
from btq_lang.diagnostics.rules import Severity
from btq_lang.workspace.config import Project
from btq_lang.workspace.factories import Factory
from btq_lang.workspace.workspace import Workspace

ROOT = '<root BTCPP_format="4"><BehaviorTree ID="{}">{}</BehaviorTree></root>'
ONE = "<AlwaysSuccess/>"
MISTAKES = {
    "unknown-port": f'<Timeout msec="1" mssec="1">{ONE}</Timeout>',
    "missing-port": "<Script/>",
    "invalid-literal": f'<Timeout msec="soon">{ONE}</Timeout>',
    "entry-with-two-types": f'<Sequence><Sleep msec="{{x}}"/><Repeat num_cycles="{{x}}">{ONE}</Repeat></Sequence>',
    "unknown-tree": '<SubTree ID="Nope"/>',
    "duplicate-instance-name": '<Sequence><SubTree ID="Main" name="x"/><SubTree ID="Main" name="x"/></Sequence>',
    "script-error": '<Script code="a := "/>',
    "empty-script": '<AlwaysSuccess _skipIf=" ; "/>',
    "switch-cases": f'<Switch2 variable="{{x}}" case_1="1" case_2="2" case_3="3">{ONE * 3}</Switch2>',
}
# The engine creates it too, and only a tick shows what is wrong.
WHEN_TICKED = {"parallel-threshold": f'<Parallel success_count="5">{ONE}</Parallel>'}
# Without a file of their own here: 4.6 never returns if it creates the tree, and a number goes to a text port below.
OTHERS = {"recursive-tree", "number-for-text"}


def test_they_are_loaded_and_only_creating_them_fails(engine: Engine) -> None:
    version = ".".join(engine.version.split(".")[:2])
    main = ROOT.format("Main", ONE)
    for rule, body in {**MISTAKES, **WHEN_TICKED}.items():
        other = ROOT.format("Other", body)
        both = main.replace("</root>", other.removeprefix('<root BTCPP_format="4">'))
        both = both.replace("<root ", '<root main_tree_to_execute="Main" ')
        assert engine.run_one(both, stubs=[]).stage == "done", rule
        is_old = rule == "duplicate-instance-name" and version == "4.6"
        expected = "done" if rule in WHEN_TICKED or is_old else "create"
        assert engine.run_one(both, stubs=[], every_tree=True).stage == expected, rule
        files = {"main.xml": main, "other.xml": other}
        factory = Factory("nav", main=("Main",), files=tuple(files))
        workspace = Workspace({path: file_of(path, text) for path, text in files.items()}, Project(), factory)
        found = {each.rule: each.effective_severity for each in check(workspace, "other.xml")}
        assert found[rule] is Severity.WARNING
    assert {*MISTAKES, *WHEN_TICKED, *OTHERS} == AT_CREATION
