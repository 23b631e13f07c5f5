"""What btq writes, loaded and ticked by the engine: it must make the very tree that the mission says."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from engine_loader import Answer, Engine, job, stubs_of
from missions import Spelling, mission

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export, xml_name
from btq_lang.btcpp.instances import instances
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import legal_name
from btq_lang.catalog.nodes import xml_tag
from btq_lang.checks import check
from btq_lang.cli import main
from btq_lang.diagnostics.rules import Severity
from btq_lang.projects.opening import open_workspace
from btq_lang.syntax.tree import Node as Written
from btq_lang.syntax.tree import Tree
from btq_lang.workspace.config import Project
from btq_lang.workspace.node_names import is_placeholder
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted(folder.name for folder in (ROOT / "examples").iterdir() if folder.is_dir())
GOLDEN = ROOT / "tests" / "btcpp" / "golden"

# What a skill puts out when nothing else is said, by the type of the port.
VALUES = {"double": 80.0, "int": 3, "bool": True, "string": "a", "std::string": "a"}

# The golden files that show what no engine takes, each with the reason; all others load.
GOLDEN_REFUSED = {
    "attributes": "a port with name [x] is found in the XML",
    "kinds": "the port [v] was initially created with type [double] and, later type [std::string] was used",
    "models": "this library was compiled without ROS support",
    "models_verbatim": "Only a single node <TreeNodesModel> is supported",
    "names_refused": "Unknown node type: Action",
    "quoted_kinds": "Missing port [code] in Script",
    "xml_elements": "XML_ERROR_MISMATCHED_ELEMENT",
}
NOT_REFUSED_BY_4_6 = ("names_refused",)


@pytest.mark.parametrize("example", EXAMPLES)
def test_an_example_loads_and_ticks(engine: Engine, example: str, tmp_path: Path) -> None:
    workspace = open_workspace(str(ROOT / "examples" / example))
    assert assert_loads_and_ticks(engine, workspace, tmp_path, ticks=20) > 0


def test_the_published_example_loads_and_ticks(engine: Engine, shared: Path, tmp_path: Path) -> None:
    workspace = open_workspace(str(shared / "original" / "paper_example.qualitybtcpp"))
    assert assert_loads_and_ticks(engine, workspace, tmp_path, ticks=20) == 1


@pytest.mark.parametrize("example", EXAMPLES)
def test_side_files_number_nodes_as_the_engine_does(engine: Engine, example: str, tmp_path: Path) -> None:
    code = main(["build", str(ROOT / "examples" / example), "-o", str(tmp_path)])
    assert code == 0
    for side_file in sorted(tmp_path.rglob("*.qreq.json")):
        said = json.loads(side_file.read_text(encoding="utf-8"))
        if said["main_tree"] is not None:
            answer = engine.run_one(side_file.with_name(said["xml"]["file"]))
            made = [(node.uid, node.path) for node in answer.tree]
            assert made == [(each["uid"], each["path"]) for each in said["nodes"]]


@pytest.mark.parametrize("spelling", ["classic", "short"])
def test_missions_made_up_load_and_tick(engine: Engine, spelling: Spelling, tmp_path: Path) -> None:
    sizes = (20, 20, 50, 50, 100, 100, 200, 200, 500)
    texts = {f"mission{seed}.btq": mission(size, seed, spelling) for seed, size in enumerate(sizes)}
    # Their scripts read an entry that no skill of theirs puts out.
    assert (
        assert_loads_and_ticks(engine, Workspace.of(texts), tmp_path, 20, ("Variable not found: battery_level",)) == 9
    )


def test_golden_files_load_but_for_those_that_show_what_is_refused(engine: Engine, tmp_path: Path) -> None:
    shutil.copytree(GOLDEN, tmp_path / "golden")  # by themselves: the engine reads what they include
    files = sorted((tmp_path / "golden").glob("*.xml"))
    refused: dict[str, str] = {}
    for file, answer in zip(files, engine.run(job(file, every_tree=True) for file in files), strict=True):
        assert answer.crashed == 0, file
        if answer.stage != "done":
            refused[file.stem] = answer.error
    tolerated = NOT_REFUSED_BY_4_6 if engine.version.startswith("4.6") else ()
    assert sorted(refused) == sorted(set(GOLDEN_REFUSED) - set(tolerated))
    for name, error in refused.items():
        assert GOLDEN_REFUSED[name] in error, name


def test_constants_of_subtrees_reach_ports_of_every_type(engine: Engine, tmp_path: Path) -> None:
    workspace = Workspace.of({"constants.btq": (GOLDEN / "constants.btq").read_text(encoding="utf-8")})
    assert assert_loads_and_ticks(engine, workspace, tmp_path, ticks=2) == 1


def test_a_constant_reaches_ports_of_several_types(engine: Engine) -> None:
    text = """Action Drive
    input speed : double
    input tries : int
Root Main
BehaviorTree Main
    ->
        SubTree S (n = 2)
        SubTree S (n = 2.5)
BehaviorTree S
    Timeout (msec = {n})
        Drive (speed = {n} tries = {n})
"""
    done = export(Workspace.of({"main.btq": text}), "main.btq")
    assert [repair.message.partition(":")[0] for repair in done.repairs] == [
        "`2` is written as `2 `",
        "`2.5` is written as `2.5 `",
    ]
    answer = engine.run_one(write(done.document), ticks=5)
    assert (answer.stage, answer.error) == ("done", "")


@pytest.mark.parametrize("attribute", ["_skipIf", "_while"])
@pytest.mark.parametrize("choice", ["IfThenElse", "WhileDoElse"])
@pytest.mark.parametrize("around", ["", "Inverter\n            "])
def test_a_choice_whose_condition_is_skipped_throws(engine: Engine, choice: str, attribute: str, around: str) -> None:
    script = {"_skipIf": "1 == 1", "_while": "1 == 2"}[attribute]
    text = f"""Root Main
BehaviorTree Main
    {choice}
        {around}Condition Free ({attribute} = "{script}")
        AlwaysSuccess
        AlwaysFailure
"""
    workspace = Workspace.of({"main.btq": text})
    assert [each.rule for each in check(workspace, "main.btq")] == ["skipped-condition"]
    answer = engine.run_one(write(export(workspace, "main.btq").document), ticks=5)
    said = {"IfThenElse": "unexpected happened in IfThenElse", "WhileDoElse": "not allowed to set manually the status"}
    assert (answer.stage, said[choice] in answer.error) == ("tick", True)


# What a SubTree gives to the port `n` of its tree, and what stands in that tree.
NUMBERS_FOR_TEXT = {
    "whole": ("n = 4", "Say (text = {n})"),
    "real": ('n = ".5"', "Say (text = {n})"),
    "named": ("n = inf", "Say (text = {n})"),
    "not_all": ('n = "4 bars"', "Say (text = {n})"),
    "hexadecimal": ('n = "0x10"', "Say (text = {n})"),
    "switch": ("n = 1", "Switch2 (variable = {n} case_1 = a case_2 = b)\n        Rest\n        Rest\n        Rest"),
    "further_below": ("n = 4", "SubTree Below (text = {n})"),
    "untyped": ("n = 4", "Show (what = {n})"),
    "entry": ("n = {n}", "Say (text = {n})"),
}


@pytest.mark.parametrize("case", NUMBERS_FOR_TEXT)
def test_a_number_for_a_port_of_text_is_told_where_the_engine_makes_no_tree(engine: Engine, case: str) -> None:
    given, below = NUMBERS_FOR_TEXT[case]
    text = f"""Action Say
    input text : string
Root Main
BehaviorTree Main
    ->
        Script (code = "n := '4'")
        SubTree S ({given})
BehaviorTree S
    {below}
BehaviorTree Below
    Say (text = {{=}})
"""
    workspace = Workspace.of({"main.btq": text}, Project(engines=(engine.version,)))
    told = [each.rule for each in check(workspace, "main.btq") if each.effective_severity is Severity.ERROR]
    answer = engine.run_one(write(export(workspace, "main.btq").document), ticks=5)
    refused = "was initially created with type" in answer.error
    assert (told, answer.stage) == (["number-for-text"] * refused, "load" if refused else "done")
    is_number = case in ("whole", "real", "named", "switch", "further_below")
    assert refused == (is_number and tuple(map(int, engine.version.split("."))) >= (4, 9, 1))


def assert_loads_and_ticks(
    engine: Engine, workspace: Workspace, folder: Path, ticks: int, pardoned: tuple[str, ...] = ()
) -> int:
    """Every file of a workspace, written for this engine, loads; its main tree is the tree that is said, and ticks.

    Args:
        folder: where the XML is written.
        pardoned: errors while ticking that are the mission's own.

    Returns:
        how many main trees were ticked.
    """
    files: dict[str, Path] = {}
    common = os.path.commonpath([os.path.dirname(path) for path in workspace.files])
    for path in workspace.files:
        made = export(workspace, path, target=".".join(engine.version.split(".")[:2]))
        assert made.problems == (), path
        files[path] = folder / xml_name(os.path.relpath(path, common or "."))
        files[path].parent.mkdir(parents=True, exist_ok=True)
        files[path].write_text(write(made.document), encoding="utf-8", newline="")
    mains = [path for path in files if workspace.main_tree(path) is not None]
    jobs = [job(file, every_tree=True) for file in files.values()]
    jobs += [job(files[path], parts=parts_of(files[path]), ticks=ticks) for path in mains]
    answers = engine.run(jobs)
    for path, answer in zip(files, answers[: len(files)], strict=True):
        assert (answer.stage, answer.crashed, answer.error) == ("done", 0, ""), path
    for path, answer in zip(mains, answers[len(files) :], strict=True):
        if not any(pardon in answer.error for pardon in pardoned):
            assert (answer.stage, answer.crashed, answer.error) == ("done", 0, ""), path
            assert answer.ticks > 0
        assert_same_tree(answer, workspace, path)
    return len(mains)


def assert_same_tree(answer: Answer, workspace: Workspace, path: str) -> None:
    """The engine's tree is the main tree of the file: nodes in order, with their names, each below its parent."""
    main = workspace.main_tree(path)
    assert main is not None
    assert [(node.ID, node.name, node.parent) for node in answer.tree] == list(said(workspace, path, main.symbol.name))
    documents = [export(workspace, each).document for each in workspace.closure(path)]
    numbered = instances(documents, str(documents[-1].root.get("main_tree_to_execute")))
    assert [(node.uid, node.path) for node in answer.tree] == [(each.uid, each.path) for each in numbered]


def said(workspace: Workspace, path: str, tree: str) -> Iterator[tuple[str, str, int]]:
    """The nodes of a tree as the file says them, subtrees in place: ID, name, and the number of the parent."""
    scope = workspace.scope(path)
    number = 0

    def below(name: str, parent: int) -> Iterator[tuple[str, str, int]]:
        definition = scope.find(Kind.TREE, name)
        assert definition is not None, name
        assert isinstance(definition.symbol.target, Tree)
        for child in definition.symbol.target.children:
            assert isinstance(child, Written)
            yield from one(child, parent)

    def one(node: Written, parent: int) -> Iterator[tuple[str, str, int]]:
        nonlocal number
        number += 1
        own = number
        assert node.id is not None
        if node.category is not None and node.category.raw == "SubTree":
            yield "SubTree", node.name.text if node.name else node.id.text, parent
            yield from below(node.id.text, own)
            return
        ID = xml_tag(node.id.text, node.id.quoted, len(node.children))
        name = node.name.text if node.name else ID
        if is_placeholder(node):
            ID = legal_name(name)
        yield ID, name, parent
        for child in node.nodes:
            yield from one(child, own)

    return below(tree, 0)


def parts_of(file: Path) -> dict[str, list[object]]:
    """Parts in which every skill puts out a value of the right type on each of its output ports."""
    parts: dict[str, list[object]] = {}
    for stub in stubs_of(file):
        ports = [port for port in stub["ports"] if port["direction"] != "input"]
        output = {port["name"]: VALUES[port["type"]] for port in ports if port.get("type") in VALUES}
        if output and stub["category"] in ("Action", "Condition"):
            parts[str(stub["ID"])] = [{"status": "SUCCESS", "output": output}]
    return parts
