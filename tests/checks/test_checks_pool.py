"""What an XML file lacks is looked for in its pool: the XML of its folder, then the files of its project."""

from __future__ import annotations

from pathlib import Path

import pytest

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import check, check_each
from btq_lang.diagnostics.rules import Severity
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace


def pool(*files: str, pools: tuple[str, ...] = ("p",)) -> Workspace:
    """Files, each `path: content of <root>`, or a .btq file."""
    texts = {path: text for path, _, text in (file.partition(": ") for file in files)}
    xml = {
        path: f'<root BTCPP_format="4">{text}</root>' if path.endswith(".xml") else text for path, text in texts.items()
    }
    return Workspace({path: file_of(path, text) for path, text in xml.items()}, Project(pools=pools))


def tree(name: str, content: str = "<AlwaysSuccess/>") -> str:
    return f'<BehaviorTree ID="{name}">{content}</BehaviorTree>'


def problems(workspace: Workspace, path: str = "p/a.xml") -> list[str]:
    return [f"{each.rule}: {each.message}" for each in check(workspace, path)]


MAIN = "p/a.xml: " + tree("Main", '<SubTree ID="Dock"/>')
UNKNOWN = "unknown-tree: unknown tree `Dock`; {}"
HERE = UNKNOWN.format("neither this file nor its includes define it")
NOWHERE = UNKNOWN.format("no file of the project defines it")


def test_a_tree_of_the_folder_or_the_project_is_known() -> None:
    assert problems(pool(MAIN)) == [NOWHERE]
    assert problems(pool(MAIN, "p/b.xml: " + tree("Dock"))) == []
    assert problems(pool(MAIN, "p/sub/b.xml: " + tree("Dock"))) == []
    assert problems(pool(MAIN, "p/sub/b.btq: BehaviorTree Dock\n    AlwaysSuccess\n")) == []
    assert problems(pool(MAIN, "q/b.xml: " + tree("Dock"))) == [NOWHERE]  # another project


def test_the_innermost_pool_counts() -> None:
    files = (MAIN, "p/b.xml: " + tree("Dock"), "p/sub/a.xml: " + tree("Main", '<SubTree ID="Dock"/>'))
    assert problems(pool(*files, pools=("p", "p/sub")), "p/sub/a.xml") == [NOWHERE]
    assert problems(pool(*files, pools=("p",)), "p/sub/a.xml") == []


def test_a_mission_in_this_language_has_no_pool() -> None:
    workspace = pool("p/a.btq: BehaviorTree Main\n    SubTree Dock\n", "p/b.xml: " + tree("Dock"))
    assert problems(workspace, "p/a.btq") == [HERE]


PORTS = '<SubTree ID="Dock" x="1"/>'
DECLARED = '<TreeNodesModel><SubTree ID="Dock"><input_port name="{}"/></SubTree></TreeNodesModel>'


def test_the_ports_of_a_pooled_tree_are_known_unless_several_differ() -> None:
    main = "p/a.xml: " + tree("Main", PORTS)
    first = "p/b.xml: " + tree("Dock") + DECLARED.format("y")
    missing = "missing-port: `Dock` requires a value for its port `y`"
    assert problems(pool(main, first)) == [
        "unknown-port: `Dock` has no port `x`; did you mean `y`?",
    ]
    assert missing not in problems(pool(main, first, "p/c.xml: " + tree("Dock") + DECLARED.format("z")))
    assert problems(pool(main, first, "p/c.xml: " + tree("Dock") + DECLARED.format("z"))) == []


def model(port: str, category: str = "Action") -> str:
    return f'<TreeNodesModel><{category} ID="Go"><input_port name="{port}"/></{category}></TreeNodesModel>'


def test_the_nodes_of_any_model_in_the_pool_are_known() -> None:
    palette = '<TreeNodesModel><Action ID="Stop"/></TreeNodesModel>'
    main = "p/a.xml: " + tree("Main", '<Go goal="1"/>') + palette
    unknown = "unknown-node: unknown node `Go`"
    assert problems(pool(main)) == [unknown]
    assert problems(pool(main, "p/sub/b.xml: " + model("goal"))) == []
    assert problems(pool(main, "p/sub/b.xml: " + model("gaol"), "p/c.xml: " + model("gaol"))) == [
        "unknown-port: `Go` has no port `goal`; did you mean `gaol`?"
    ]
    assert problems(pool(main, "p/sub/b.xml: " + model("gaol"), "p/c.xml: " + model("x"))) == []  # one may be meant


def test_the_model_of_a_tree_is_not_taken_for_a_nodes() -> None:
    main = "p/a.xml: " + tree("Main", '<Action ID="Go"/>')
    assert problems(pool(main, "p/b.xml: " + model("goal", "SubTree"))) == []


def test_nothing_else_is_checked_across_a_pool() -> None:
    main = "p/a.xml: " + tree("Main", '<Script code="x := 1"/>') + tree("Dock")
    other = "p/b.xml: " + tree("Main", '<Script code="y := x"/>') + model("Main")
    assert problems(pool(main, other)) == problems(pool(main))


@pytest.mark.scheduled
def test_public_files_find_their_trees_in_one_folder_and_not_alone(shared: Path) -> None:
    folder = shared / "corpus" / "dev"
    texts = {f"corpus/{path.name}": path.read_text("utf-8-sig") for path in sorted(folder.iterdir())}
    files = {path: file_of(path, text) for path, text in texts.items()}
    together = Workspace(files, Project(pools=("corpus",)))
    trees = {name for file in files.values() for kind, name in file.defined_names if kind is Kind.TREE}
    alone = 0
    for path, found in zip(files, check_each(together, files), strict=True):
        unknown = [each.message for each in found if each.rule == "unknown-tree"]
        assert not [name for name in trees if any(f"unknown tree `{name}`" in each for each in unknown)], path
        by_itself = check(Workspace({path: files[path]}, Project()), path)
        alone += sum(each.rule == "unknown-tree" for each in by_itself)
        assert {each.rule for each in by_itself} - {each.rule for each in found} <= {"unknown-tree", "unknown-node"}
    assert alone == 415


def test_a_model_of_the_pool_may_be_one_of_another_program() -> None:
    main = "p/a.xml: " + tree("Main", '<Sequence><Go/><Go goal="1"/><Go gaol="1"/></Sequence>')
    found = check(pool(main, "p/b.xml: " + model("goal")), "p/a.xml")
    assert [(each.rule, each.effective_severity) for each in found] == [("unknown-port", Severity.WARNING)]
    included = main.replace("a.xml: ", 'a.xml: <include path="b.xml"/>')
    found = check(pool(included, "p/b.xml: " + model("goal")), "p/a.xml")
    assert [(each.rule, each.effective_severity) for each in found] == [
        ("missing-port", Severity.WARNING),
        ("unknown-port", Severity.ERROR),
    ]


def test_a_node_of_nav2_is_not_taken_for_another_of_its_name() -> None:
    """A model in the pool with ports that Nav2's node has in no distribution is of another; others may lack some."""
    main = "p/a.xml: " + tree("Main", '<Wait wait_duration="1"/>')
    other = '<TreeNodesModel><Action ID="Wait"><input_port name="{}"/></Action></TreeNodesModel>'
    assert problems(pool(main, "p/b.xml: " + other.format("duration"))) == []
    assert problems(pool(main, "p/b.xml: " + other.format("server_name"))) == []
    misspelt = main.replace("wait_duration", "wait_time")
    assert problems(pool(misspelt, "p/b.xml: " + other.format("wait_duration"))) == [
        "unknown-port: `Wait` has no port `wait_time`; did you mean `wait_duration`?"
    ]
    assert problems(pool(misspelt, "p/b.xml: " + other.format("duration"))) == []


def test_the_model_that_lacks_a_port_is_named() -> None:
    """It may be older than the node; a port that is surely misspelt is not the model's mistake."""
    main = "p/a.xml: " + tree("Main", '<Go spaed="1"/>')
    lacks = "unknown-port: `Go` has no port `spaed`: its model in p/b.xml lacks it"
    assert problems(pool(main, "p/b.xml: " + model('duration" default="1') + tree("Other"))) == [lacks]
    assert problems(pool(main, "p/b.xml: " + model("speed") + tree("Other"))) == [
        "unknown-port: `Go` has no port `spaed`; did you mean `speed`?"
    ]


def test_an_old_entry_at_an_output_is_one_mistake() -> None:
    output = '<TreeNodesModel><Action ID="Go"><output_port name="pose"/></Action></TreeNodesModel>'
    old = "old-entry: the engine reads `${here}` as a text, not as an entry"
    assert problems(pool("p/a.xml: " + tree("Main", '<Go pose="${here}"/>') + output)) == [old]
