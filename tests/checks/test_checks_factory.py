"""The files of a factory see each other as one text does."""

from __future__ import annotations

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import check
from btq_lang.checks.lookups import is_defined
from btq_lang.workspace.config import Project
from btq_lang.workspace.factories import Factory, merged
from btq_lang.workspace.inputs import of_scope
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace


def factory(
    *files: str, main: tuple[str, ...] = (), nodes: tuple[str, ...] = (), lost: tuple[str, ...] = ()
) -> Workspace:
    """Files that a program registers in this order, each `path: content of <root>`, or a .btq file."""
    texts = {path: text for path, _, text in (file.partition(": ") for file in files)}
    xml = {
        path: f'<root BTCPP_format="4">{text}</root>' if path.endswith(".xml") else text for path, text in texts.items()
    }
    loaded = tuple(path for path in texts if path not in nodes)
    made = Factory("nav", main=main, files=loaded, node_files=nodes, lost=lost)
    return Workspace({path: file_of(path, text) for path, text in xml.items()}, Project(), made)


def tree(name: str, content: str = "<AlwaysSuccess/>") -> str:
    return f'<BehaviorTree ID="{name}">{content}</BehaviorTree>'


def problems(workspace: Workspace) -> list[str]:
    return [f"{path}: {each.rule}: {each.message}" for path in workspace.registered for each in check(workspace, path)]


MAIN = "a.xml: " + tree("Main", '<SubTree ID="Dock"/>')


LOOKED: list[str] = []


@of_scope
def looked(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    LOOKED.append(viewpoint)
    return store.ask(is_defined, viewpoint, Kind.TREE, name)


def test_what_depends_on_the_scope_alone_is_computed_once_for_all_files() -> None:
    workspace = factory("a.xml: " + tree("Main"), "b.xml: " + tree("Dock"), "c.xml: " + tree("Wait"))
    LOOKED.clear()
    assert [workspace.store.ask(looked, path, "Dock") for path in ("c.xml", "b.xml", "a.xml")] == [True, True, True]
    assert LOOKED == ["a.xml"]
    alone = Workspace(dict(workspace.files), Project())
    assert [alone.store.ask(looked, path, "Dock") for path in ("c.xml", "b.xml", "a.xml")] == [False, True, False]
    assert LOOKED == ["a.xml", "c.xml", "b.xml", "a.xml"]


def test_trees_are_known_whatever_the_order_and_the_language() -> None:
    assert problems(factory(MAIN, "b.xml: " + tree("Dock"))) == []
    assert problems(factory("b.btq: BehaviorTree Dock\n    AlwaysSuccess\n", MAIN)) == []
    assert problems(factory("b.btq: BehaviorTree Main\n    SubTree Dock\n", "a.xml: " + tree("Dock"))) == []
    assert problems(factory(MAIN, "b.xml: " + tree("Undock"))) == [
        "a.xml: unknown-tree: unknown tree `Dock`; no file of its factory defines it"
    ]


def test_a_second_tree_is_reported_at_both_places() -> None:
    workspace = factory(MAIN, "b.xml: " + tree("Dock"), "c.xml: " + tree("Dock"))
    assert problems(workspace) == [
        "b.xml: duplicate-tree: duplicate tree `Dock`",
        "c.xml: duplicate-tree: duplicate tree `Dock`",
    ]
    (first,), (second,) = check(workspace, "b.xml"), check(workspace, "c.xml")
    assert [(each.place.path, each.message) for each in first.related] == [("c.xml", "second one")]
    assert [(each.place.path, each.message) for each in second.related] == [("b.xml", "first one")]
    assert problems(factory(MAIN, "b.xml: " + tree("Dock") * 2)) == ["b.xml: duplicate-tree: duplicate tree `Dock`"]


def test_a_second_model_or_requirement_is_too_if_it_differs() -> None:
    model = '<TreeNodesModel><Action ID="Go"><input_port name="{}"/></Action></TreeNodesModel>'.format
    assert problems(factory("a.xml: " + model("x"), "b.xml: " + model("x"))) == []
    assert problems(factory("a.xml: " + model("x"), "b.xml: " + model("y"))) == [
        f"{name}.xml: duplicate-definition: duplicate definition of the node model `Go`" for name in "ab"
    ]
    requirement = 'QualityReq rq1 "{}"\nBehaviorTree {}\n    AlwaysSuccess satisfies rq1\n'.format
    assert problems(factory("a.btq: " + requirement("one", "A"), "b.btq: " + requirement("two", "B"))) == [
        f"{name}.btq: conflicting-requirement: conflicting definitions of the requirement `rq1`" for name in "ab"
    ]


def test_ports_and_models_of_other_files_count() -> None:
    palette = '<TreeNodesModel><Action ID="Go"><input_port name="goal"/></Action></TreeNodesModel>'
    main = "a.xml: " + tree("Main", '<Go gaol="1"/>')
    found = ["a.xml: unknown-port: `Go` has no port `gaol`; did you mean `goal`?"]
    assert problems(factory(main, "p.xml: " + palette)) == found
    assert problems(factory(main, "p.xml: " + palette, nodes=("p.xml",))) == found


def test_of_the_files_of_nodes_only_models_count() -> None:
    palette = "p.xml: " + tree("Dock") + '<TreeNodesModel><Action ID="Go"/></TreeNodesModel>'
    found = "a.xml: unknown-tree: unknown tree `Dock`; no file of its factory defines it"
    assert problems(factory(MAIN, palette, nodes=("p.xml",))) == [found]
    assert problems(factory("a.xml: " + tree("Dock"), palette, nodes=("p.xml",))) == []


def test_entries_pass_from_file_to_file() -> None:
    main = "a.xml: " + tree("Main", '<Sequence><Script code="goal := 1"/><SubTree ID="Dock" to="{gaol}"/></Sequence>')
    dock = "b.xml: " + tree("Dock", '<ScriptCondition code="to == 1"/>')
    (found,) = problems(factory(main, dock))
    assert found.startswith("a.xml: misspelt-entry: ")


def test_without_a_main_tree_nothing_is_unreachable_or_ambiguous() -> None:
    files = ("a.xml: " + tree("A") + tree("B"), "b.xml: " + tree("C"))
    assert problems(factory(*files)) == []
    assert problems(factory(*files, main=("A",))) == [
        "a.xml: unused-tree: unused tree `B`: nothing refers to it, and the main tree is `A`",
        "b.xml: unused-tree: unused tree `C`: nothing refers to it, and the main tree is `A`",
    ]
    assert problems(factory(*files, main=("A", "B"))) == [
        "b.xml: unused-tree: unused tree `C`: nothing refers to it, and the main trees are `A`, `B`"
    ]
    assert problems(factory(*files, main=("A", "B", "C"))) == []


def test_a_tree_that_only_unreached_trees_run_is_unreachable() -> None:
    files = ("a.xml: " + tree("A") + tree("B", '<SubTree ID="C"/>'), "b.xml: " + tree("C"))
    assert problems(factory(*files, main=("A",)))[1:] == [
        "b.xml: unreachable-tree: unreachable tree `C`: the main tree `A` never reaches it"
    ]
    both = problems(factory(*files, "c.xml: " + tree("D"), main=("A", "D")))
    assert both[1:] == ["b.xml: unreachable-tree: unreachable tree `C`: no main tree ever reaches it"]


def test_a_missing_main_tree_is_reported_once() -> None:
    found = problems(
        factory("p.xml: <TreeNodesModel/>", "a.xml: " + tree("Main"), "b.xml: " + tree("B"), main=("Mian",))
    )
    assert found == [
        "a.xml: unknown-main-tree: the factory `nav` has no tree `Mian`, which is its main tree; did you mean `Main`?"
    ]


def test_what_a_lost_package_defines_is_unknown() -> None:
    workspace = factory(MAIN, main=("Start",), lost=("package://docking/trees/*.xml", "gone/*.xml"))
    assert problems(workspace) == [
        "a.xml: missing-include: no file matches `package://docking/trees/*.xml`, a pattern of the factory `nav`",
        "a.xml: missing-include: no file matches `gone/*.xml`, a pattern of the factory `nav`",
    ]


def test_findings_that_only_some_factories_have_name_them() -> None:
    dock = factory(MAIN, "b.xml: " + tree("Dock"), main=("Dock",))
    lacking = factory(MAIN)
    assert dock.factory is not None
    assert lacking.factory is not None
    names = ("one", "two", "three")
    of_each = [check(dock, "a.xml"), check(lacking, "a.xml"), check(lacking, "a.xml")]
    found = merged([(Factory(name), each) for name, each in zip(names, of_each, strict=True)])
    assert [(each.rule, each.notes[-1:]) for each in found] == [
        ("unused-tree", ("only in the factory `one`",)),
        ("unknown-tree", ("only in the factories `two`, `three`",)),
    ]
    assert merged([(Factory(name), of_each[1]) for name in names]) == of_each[1]


REFUSED = """<Timeout mssec="1"><Sequence><SubTree ID="Nope" name="x"/><SubTree ID="Main" name="x"/>
  <Script code="a := "/><Timeout msec="soon"><AlwaysSuccess/></Timeout><Sequence/></Sequence></Timeout>"""


def severities(workspace: Workspace, path: str) -> list[tuple[str, str]]:
    return [(each.rule, each.effective_severity.value) for each in check(workspace, path)]


def test_what_the_engine_refuses_only_in_trees_that_it_creates() -> None:
    """In a tree that no main tree reaches, it is a warning, and what keeps the file from being loaded an error."""
    files = ("a.xml: " + tree("Main"), "b.xml: " + tree("Other", REFUSED))
    at_creation = ["unknown-port", "unknown-tree", "duplicate-instance-name", "script-error", "invalid-literal"]
    created = severities(factory(*files, main=("Main", "Other")), "b.xml")
    assert created == [*((rule, "error") for rule in at_creation), ("child-count", "error")]
    unreached = factory(*files, main=("Main",))
    assert [each for each in severities(unreached, "b.xml") if each[0] in at_creation] == [
        (rule, "warning") for rule in at_creation
    ]
    assert ("child-count", "error") in severities(unreached, "b.xml")
    noted = next(each for each in check(unreached, "b.xml") if each.rule == "unknown-tree")
    assert noted.notes[-1] == "no main tree of the factory `nav` reaches `Other`; the engine would refuse to create it"
    for unsure in (factory(*files), factory(*files, main=("Mian",)), factory(*files, main=("Main",), lost=("c.xml",))):
        assert ("script-error", "error") in severities(unsure, "b.xml")
    reaching_a_gap = factory("a.xml: " + tree("Main", '<SubTree ID="Othr"/>'), files[1], main=("Main",))
    assert ("script-error", "error") in severities(reaching_a_gap, "b.xml")


def test_an_error_in_one_factory_is_not_a_warning_of_another_too() -> None:
    files = ("a.xml: " + tree("Main"), "b.xml: " + tree("Other", '<Timeout msec="soon"><AlwaysSuccess/></Timeout>'))
    both = [factory(*files, main=("Main",)), factory(*files, main=("Other",))]
    other = Factory("other", main=("Other",), files=both[1].registered)
    both[1] = Workspace(both[1].files, Project(), other)
    found = merged([(each.factory, check(each, "b.xml")) for each in both])
    assert [(each.rule, each.effective_severity.value, each.notes[-1:]) for each in found] == [
        ("unused-tree", "warning", ("only in the factory `nav`",)),
        ("invalid-literal", "error", ("only in the factory `other`",)),
    ]
