"""What written nodes mean, and that an edit elsewhere leaves them as they are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

import pytest

from btq_lang.syntax.tree import Tree
from btq_lang.workspace import inputs
from btq_lang.workspace.node_names import kind_of, tag_of
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode, ResolvedTree, tree_named, tree_nodes
from btq_lang.workspace.workspace import Workspace

MODELS = "Action Go\n    input place\nCondition Near\n"
MAIN = """include "models.btq"
BehaviorTree Main
    -> Steps
        Go (place = x)
        Condition Go
        Unknown
        SubTree Other
        SubTree (ID = Other, name = Again)
        ScriptCondition (name = "Is open")
        ScriptCondition (code = "a == b")
        "Retry"
        SequenceStar
            SubTreePlus (ID = Other)
        Test
        xml "<X/>"
        Switch (variable = x, case_1 = a)
            Near
            xml "<X/>"
            Near
BehaviorTree Other
    Unknown
"""
FILES = {"/models.btq": MODELS, "/main.btq": MAIN}


def nodes_of(workspace: Workspace, name: str) -> ResolvedTree:
    found = workspace.store.ask(tree_named, "/main.btq", name)
    assert found is not None, "there is such a tree"
    return found


@pytest.mark.parametrize(
    ("shown", "tag", "category", "stated", "of_model"),
    [
        ("`-> Steps`", "Sequence", "Control", "Control", None),
        ("`Go`", "", "Action", "Action", "Action"),
        ("`Unknown`", "", None, None, None),
        ("`Other`", "", "SubTree", "SubTree", None),
        ("`Other Again`", "", "SubTree", "SubTree", None),
        ("`ScriptCondition Is open`", "", "Condition", "Condition", None),
        ("`ScriptCondition`", "ScriptCondition", "Condition", "Condition", None),
        ("`Retry`", "", None, None, None),
        ("`SequenceStar`", "SequenceWithMemory", "Control", "Control", None),
        ("`SubTreePlus`", "", "SubTree", None, None),
        ("`Test`", "", "Action", None, None),
        ("`Switch`", "Switch2", "Control", "Control", None),
        ("`Near`", "", "Condition", "Condition", "Condition"),
    ],
)
def test_what_a_node_means(
    shown: str, tag: str, category: str | None, stated: str | None, of_model: str | None
) -> None:
    node = next(node for node in nodes_of(Workspace.of(FILES), "Main").all if node.shown == shown)
    assert (node.tag, node.category, node.stated_category, node.of_model) == (tag, category, stated, of_model)
    assert node.is_defined == (of_model is not None)
    assert node.is_subtree == (stated == "SubTree")
    assert node.is_placeholder == (shown == "`ScriptCondition Is open`")


def test_a_written_category_counts_and_the_model_is_known_all_the_same() -> None:
    first, second = [node for node in nodes_of(Workspace.of(FILES), "Main").all if node.shown == "`Go`"]
    assert (first.category, first.of_model) == ("Action", "Action")
    assert (second.category, second.of_model) == ("Condition", "Action")


def test_where_a_node_is() -> None:
    tree = nodes_of(Workspace.of(FILES), "Main")
    assert tree.root is not None
    switch = tree.root.children[-1]
    assert [(node.shown, node.index) for node in switch.children] == [("`Near`", 0), ("`Near`", 2)]
    assert [node.shown for node in switch.children[0].ancestors()] == ["`Switch`", "`-> Steps`"]
    assert switch.index == 11
    assert (switch.path, switch.tree, switch.item, switch.facts) == ("/main.btq", "Main", tree.item, tree.facts)
    assert tree.called == ("Other", "Other", "SubTreePlus")  # that one has the tree's name in an attribute


def test_the_children_that_choose_among_switches() -> None:
    item = Workspace.of(FILES).files["/main.btq"].parsed.entries[1].item
    assert isinstance(item, Tree)
    (switch,) = [node for node in item.walk() if node.head.text == "Switch"]
    kind = kind_of(switch)
    assert kind is not None
    assert (kind.tag, tag_of(switch)) == ("Switch2", "Switch2")


@pytest.mark.parametrize(
    ("path", "old", "new", "made_again"),
    [
        ("/models.btq", "input place", "input there", 0),
        ("/models.btq", "Action Go", "Control Go", 1),
        ("/models.btq", "Condition Near\n", "Condition Near\nAction Unknown\n", 2),
        ("/main.btq", "BehaviorTree Other\n    Unknown", "BehaviorTree Other\n    Retry\n        Unknown", 1),
        ("/main.btq", "BehaviorTree Main", "# a remark\n\nBehaviorTree Main", 0),
    ],
)
def test_an_edit_elsewhere_leaves_the_nodes(
    monkeypatch: pytest.MonkeyPatch, path: str, old: str, new: str, made_again: int
) -> None:
    computed: Counter[str] = Counter()
    compute: Callable[..., object] = Store._compute

    def counting(store: Store[Workspace], answer: object) -> object:
        computed[answer.key[0].__name__] += 1  # type: ignore[attr-defined]  # it is one of the store's own
        return compute(store, answer)

    workspace = Workspace.of(FILES)
    before = asked(workspace)
    assert old in FILES[path]
    after = workspace.with_file(path, FILES[path].replace(old, new))
    inputs.advance(workspace, after)
    monkeypatch.setattr(Store, "_compute", counting)
    now = asked(after)
    assert computed[tree_nodes.__name__] == made_again
    assert sum(one is not other for one, other in zip(before, now, strict=True)) == made_again


def asked(workspace: Workspace) -> list[ResolvedNode | None]:
    """The root of each tree."""
    return [nodes_of(workspace, name).root for name in ("Main", "Other")]
