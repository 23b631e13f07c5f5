"""Pictures: the positions and texts of boxes, and the three formats."""

from __future__ import annotations

import random
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.cli import main
from btq_lang.graph import DIRECTIONS, FORMATS, draw
from btq_lang.graph.layout import Size, layout
from btq_lang.graph.missions import figures
from btq_lang.graph.picture import foldable, picture, places
from btq_lang.graph.placing import Drawing, Rectangle, place
from btq_lang.graph.widths import shortened, width, wrapped
from btq_lang.projects.opening import open_workspace
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[2]
SVG = "{http://www.w3.org/2000/svg}"

MISSION = """\
QualityReq rq1 "In time"
    takes at most 30 s
    on violation fail
Action Drive
BehaviorTree Main
    ->
        satisfices safety
        Condition Ready
        Retry Again (num_attempts = 3)
            Drive ToDock satisfies rq1
        SubTree Rest
BehaviorTree Rest
    Sleep (msec = 1 s)
"""


# ---- layout ---------------------------------------------------------------------------------------------------------


@st.composite
def trees(draw: st.DrawFn) -> tuple[list[Size], list[int | None]]:
    number = draw(st.integers(1, 60))
    parents: list[int | None] = [
        draw(st.one_of(st.none(), st.integers(0, at - 1))) if at else None for at in range(number)
    ]
    # Siblings in the order of a text: parents before their children, each subtree in one piece.
    children: dict[int | None, list[int]] = {}
    for at, parent in enumerate(parents):
        children.setdefault(parent, []).append(at)
    order: list[int] = []
    waiting = list(reversed(children.get(None, [])))
    while waiting:
        at = waiting.pop()
        order.append(at)
        waiting += reversed(children.get(at, []))
    place_of = {at: place for place, at in enumerate(order)}
    found = [parents[at] for at in order]
    sizes = []
    for _ in range(number):
        breadth = draw(st.integers(1, 200))
        sizes.append(Size(breadth, draw(st.integers(1, 150)), draw(st.integers(0, breadth))))
    return sizes, [place_of[parent] if parent is not None else None for parent in found]


@given(trees())
def test_boxes_stand_apart_below_the_middle_of_their_parents(tree: tuple[list[Size], list[int | None]]) -> None:
    sizes, parents = tree
    places = layout(sizes, parents, 10, 20)
    assert min(x for x, _ in places) == 0
    boxes = [(x, y, x + size.breadth, y + size.depth) for (x, y), size in zip(places, sizes, strict=True)]
    for at, (left, top, right, bottom) in enumerate(boxes):
        for other_left, other_top, other_right, other_bottom in boxes[:at]:
            beside = right + 9 <= other_left or other_right + 9 <= left  # places are rounded
            assert beside or bottom <= other_top or other_bottom <= top
    children: dict[int, list[int]] = {}
    for at, parent in enumerate(parents):
        if parent is not None:
            children.setdefault(parent, []).append(at)
            assert boxes[at][1] >= boxes[parent][3] + 20
    for parent, mine in children.items():
        assert [places[at][0] + sizes[at].breadth for at in mine] == sorted(
            places[at][0] + sizes[at].breadth for at in mine
        )
        first, last = (places[at][0] + sizes[at].anchor for at in (mine[0], mine[-1]))
        assert abs(places[parent][0] + sizes[parent].anchor - (first + last) / 2) <= 1


def test_a_layer_stands_at_one_depth_and_leaves_push_no_layer_down() -> None:
    sizes = [Size(10, 10, 5), Size(10, 300, 5), Size(10, 30, 5), Size(10, 10, 5)]
    assert layout(sizes, [None, 0, 0, 2], 5, 20) == [(8, 0), (0, 30), (15, 30), (15, 80)]


def test_deep_and_broad_trees() -> None:
    size = Size(10, 10, 5)
    deep = layout([size] * 20_000, [None, *range(19_999)], 5, 20)
    assert deep[-1] == (0, 19_999 * 30)
    broad = layout([size] * 20_001, [None, *[0] * 20_000], 5, 20)
    assert broad[0] == (149_992, 0)
    assert broad[-1] == (19_999 * 15, 30)


def test_no_boxes() -> None:
    assert layout([], [], 5, 20) == []


# ---- texts ----------------------------------------------------------------------------------------------------------


def test_widths() -> None:
    assert width("", 10) == 0
    assert width("MoveBase", 13, bold=True) > width("MoveBase", 13) > width("illicit.", 13)
    assert width("充電", 10) == 22
    assert shortened("ChargeUntilFull", 10, 50) == "Charge…"
    assert shortened("Charge", 10, 50) == "Charge"


def test_a_number_keeps_its_unit() -> None:
    assert wrapped("mission keeps mean(load) < 80 %", 10, 150, 3) == ("mission keeps mean(load) <", "80 %")
    assert wrapped("one two three four", 10, 50, 2) == ("one two", "three …")


# ---- placing --------------------------------------------------------------------------------------------------------


def rectangles(drawing: Drawing) -> list[Rectangle]:
    return [at for box in drawing.boxes for at in (box.area, *(note.area for note in box.notes))]


def apart(one: Rectangle, other: Rectangle) -> bool:
    beside = one.x + one.w < other.x or other.x + other.w < one.x
    return beside or one.y + one.h < other.y or other.y + other.h < one.y


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("example", sorted(path.name for path in (ROOT / "examples").iterdir() if path.is_dir()))
def test_nothing_overlaps_in_the_examples(example: str, direction: str) -> None:
    workspace = open_workspace(str(ROOT / "examples" / example))
    for path in workspace.files:
        for figure in figures(workspace, path, with_qualities=True):
            drawing = place(figure, direction)
            found = rectangles(drawing)
            for at, one in enumerate(found):
                assert 0 < one.x < one.x + one.w < drawing.width
                assert 0 < one.y < one.y + one.h < drawing.height
                assert all(apart(one, other) for other in found[:at])


def test_what_is_written_on_boxes() -> None:
    workspace = Workspace.of({"a.btq": MISSION})
    main_tree, rest = figures(workspace, "a.btq", with_qualities=True)
    assert (main_tree.title, rest.title) == ("Main", "Rest")
    assert [(box.outline, box.title, box.lines, box.parent) for box in main_tree.boxes] == [
        ("control", "->", (), None),
        ("condition", "Ready", (), 0),
        ("decorator", "RetryUntilSuccessful", ("Again", "num_attempts = 3"), 0),
        ("action", "Drive", ("ToDock",), 2),
        ("subtree", "Rest", (), 0),
    ]
    assert [(note.kind, note.title, note.lines) for box in main_tree.boxes for note in box.notes] == [
        ("quality", "safety", ()),
        ("requirement", "rq1", ("takes at most 30 s", "on violation fail")),
    ]
    assert [box.notes for figure in figures(workspace, "a.btq") for box in figure.boxes] == [()] * 6


def test_a_subject_is_not_repeated_at_its_node() -> None:
    text = "QualityReq r : safety\n    Main/Drive takes at most 3 s\nBehaviorTree Main\n    Action Drive\n"
    (figure,) = figures(Workspace.of({"a.btq": text}), "a.btq", with_qualities=True)
    assert [note.lines for note in figure.boxes[0].notes] == [("takes at most 3 s",)]


@pytest.mark.parametrize(
    "text", ["BehaviorTree\n", "BehaviorTree A\n    x (\n  y\n    ->\n", "BehaviorTree A\n    a\n    b\n"]
)
@pytest.mark.parametrize("form", FORMATS)
def test_broken_files_are_drawn_as_far_as_they_can_be_read(text: str, form: str) -> None:
    assert draw(figures(Workspace.of({"a.btq": text}), "a.btq", with_qualities=True), form)


# ---- formats --------------------------------------------------------------------------------------------------------


def test_svg_is_well_formed_says_everything_and_is_the_same_each_time() -> None:
    workspace = Workspace.of({"a.btq": MISSION.replace("ToDock", '"<&> 充電"')})
    text = draw(figures(workspace, "a.btq", with_qualities=True))
    assert text == draw(figures(Workspace.of(dict(workspace_texts(workspace))), "a.btq", with_qualities=True))
    root = ElementTree.fromstring(text)
    assert [element.text for element in root.iter(f"{SVG}text")] == [
        *("Main", "->", "safety", "Ready", "RetryUntilSuccessful", "Again", "num_attempts = 3"),
        *("Drive", "<&> 充電", "rq1", "takes at most 30 s", "on violation fail", "Rest", "Rest", "Sleep", "msec = 1 s"),
    ]
    assert len(root.findall(f".//{SVG}ellipse")) == 1
    assert [element.get("id") for element in root.iter(f"{SVG}g") if element.get("id")] == [f"n{at}" for at in range(6)]


def workspace_texts(workspace: Workspace) -> list[tuple[str, str]]:
    return [(path, file.text) for path, file in workspace.files.items()]


def test_of_a_quality_with_a_long_name_the_last_part_is_drawn() -> None:
    text = "BehaviorTree Main\n    A satisfices performance-efficiency.resource-utilization, security.integrity\n"
    drawing = place(figures(Workspace.of({"a.btq": text}), "a.btq", with_qualities=True)[0])
    lines = [[line for _, line in note.lines] for note in drawing.boxes[0].notes]
    assert lines == [["resource-utilization"], ["security.integrity"]]


def test_dot() -> None:
    found = figures(Workspace.of({"a.btq": MISSION}), "a.btq", with_qualities=True)
    assert draw(found, "dot", "right").splitlines()[:12] == [
        "digraph mission {",
        "  graph [rankdir=LR, ordering=out, fontname=Helvetica];",
        "  node [fontname=Helvetica, fontsize=12];",
        "  edge [arrowhead=none];",
        "  subgraph cluster_0 {",
        '    label="Main";',
        '    "n0" [label="->", shape=box, tooltip="->"];',
        '    "n0.0" [label="safety", shape=box, style="rounded,dashed", color="#2f7d4f", fontsize=10,'
        ' tooltip="satisfices safety"];',
        '    "n0" -> "n0.0" [style=dashed];',
        '    "n1" [label="Ready", shape=ellipse, tooltip="Ready"];',
        '    "n0" -> "n1";',
        '    "n2" [label="RetryUntilSuccessful\\nAgain\\nnum_attempts = 3", shape=hexagon,'
        ' tooltip="Retry Again (num_attempts = 3)"];',
    ]


def test_mermaid() -> None:
    text = 'BehaviorTree Main\n    ->\n        Condition "a \\"b\\" #1\\\\n"\n        SubTree Rest\n'
    text += "BehaviorTree Rest\n    A satisfices safety\n"
    assert draw(figures(Workspace.of({"a.btq": text}), "a.btq", with_qualities=True), "mermaid") == (
        "flowchart TB\n"
        '  subgraph tree0["Main"]\n'
        "    direction TB\n"
        '    t0n0["-#gt;"]\n'
        '    t0n1(["a #quot;b#quot; #35;1#92;n"])\n'
        "    t0n0 --- t0n1\n"
        '    t0n2[["Rest"]]\n'
        "    t0n0 --- t0n2\n"
        "  end\n"
        '  subgraph tree1["Rest"]\n'
        "    direction TB\n"
        '    t1n0["A"]\n'
        '    t1n0q0(["safety"]):::quality\n'
        "    t1n0 -.- t1n0q0\n"
        "  end\n"
        "  classDef quality stroke:#2f7d4f,stroke-dasharray:6 3;\n"
        "  classDef requirement stroke:#a8650f;\n"
    )


@pytest.mark.parametrize(("form", "direction"), [("png", "down"), ("svg", "up")])
def test_what_there_is_not(form: str, direction: str) -> None:
    with pytest.raises(ValueError, match="expected one of"):
        draw((), form, direction)


# ---- the command ----------------------------------------------------------------------------------------------------


def test_the_command(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    mission = tmp_path / "a.btq"
    mission.write_text(MISSION, encoding="utf-8")
    assert main(["graph", str(mission)]) == 0
    printed = capfd.readouterr().out
    assert printed == draw(figures(Workspace.of({"a.btq": MISSION}), "a.btq"))
    target = tmp_path / "docs" / "a.mmd"
    assert main(["graph", str(mission), "--format", "mermaid", "--qualities", "-o", str(target)]) == 0
    assert target.read_text(encoding="utf-8") == draw(
        figures(Workspace.of({"a.btq": MISSION}), "a.btq", with_qualities=True), "mermaid"
    )


@pytest.mark.parametrize(("ending", "form"), [("svg", "svg"), ("gv", "dot"), ("MMD", "mermaid"), ("txt", "svg")])
def test_the_file_s_ending_says_the_form(ending: str, form: str, tmp_path: Path) -> None:
    mission, target = tmp_path / "a.btq", tmp_path / f"a.{ending}"
    mission.write_text(MISSION, encoding="utf-8")
    assert main(["graph", str(mission), "-o", str(target)]) == 0
    assert target.read_text(encoding="utf-8") == draw(figures(Workspace.of({"a.btq": MISSION}), "a.btq"), form)
    assert main(["graph", str(mission), "-o", str(target), "--format", "dot"]) == 0
    assert target.read_text(encoding="utf-8").startswith("digraph")


def test_no_other_form_is_written_under_its_name(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.btq").write_text(MISSION)
    assert main(["graph", str(tmp_path / "a.btq"), "-o", str(tmp_path / "a.png")]) == 2
    message = "btq graph: cannot write .png; choose one of svg, dot, mermaid with --format, or another file name\n"
    assert (capfd.readouterr().err, (tmp_path / "a.png").exists()) == (message, False)


@pytest.mark.parametrize("command", ["graph", "trace"])
def test_a_mission_is_not_overwritten(command: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    mission = tmp_path / "a.btq"
    mission.write_text("BehaviorTree Main\n    Go\n")
    assert main([command, str(mission), "-o", str(mission)]) == 2
    message = f"btq {command}: -o {mission} may overwrite a mission; choose another file name\n"
    assert (capfd.readouterr().err, mission.read_text()) == (message, "BehaviorTree Main\n    Go\n")


def test_what_the_command_cannot_draw(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.btq").write_text("signal battery : %\n")
    assert main(["graph", str(tmp_path / "a.btq")]) == 2
    assert capfd.readouterr().err.endswith("a.btq has no trees\n")
    (tmp_path / "b.btq").write_text(MISSION)
    assert main(["graph", str(tmp_path)]) == 2
    assert capfd.readouterr().err.endswith("b.btq: expected one file to draw, found more\n")
    (tmp_path / "a.btq").write_text('include "b.btq"\nscenario "s"\n    expect mission succeeds\n')
    assert main(["graph", str(tmp_path / "a.btq")]) == 2
    assert capfd.readouterr().err.endswith("a.btq has no trees\n")
    assert main(["graph", str(tmp_path)]) == 0  # scenarios are beside the one mission
    assert capfd.readouterr().out.startswith("<svg")
    assert main(["graph", str(tmp_path / "none.btq")]) == 2
    assert main(["graph", str(tmp_path / "b.btq"), "-o", str(tmp_path / "b.btq" / "c")]) == 2
    assert "cannot be written" in capfd.readouterr().err


def test_what_cannot_be_read_is_told_and_the_rest_is_drawn(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    mission = tmp_path / "a.btq"
    mission.write_text("BehaviorTree A\n    -> ((\n        B\n    C satisfies none\n", encoding="utf-8")
    assert main(["graph", str(mission)]) == 1
    printed = capfd.readouterr()
    assert printed.out.startswith("<svg")
    assert printed.err == (
        f"{mission}:2:8: error[unclosed-bracket] missing `)` for this `(`\n"
        "Found 1 error\n"
        "btq graph: the picture shows only what could be read\n"
    )
    mission.write_text("BehaviorTree A\n    C satisfies none\n", encoding="utf-8")  # understood, whatever it lacks
    assert main(["graph", str(mission)]) == 0


def test_every_prefix_of_a_mission_can_be_drawn() -> None:
    ends = random.Random(1).sample(range(len(MISSION)), 40)
    for end in ends:
        drawn = draw(figures(Workspace.of({"a.btq": MISSION[:end]}), "a.btq", with_qualities=True))
        assert ElementTree.fromstring(drawn).tag == f"{SVG}svg"


# ---- folding --------------------------------------------------------------------------------------------------------


def shown(text: str, *folded: str) -> list[str]:
    """Each box of the first tree: its name, and what is written on it."""
    figure = foldable(figures(Workspace.of({"main.btq": text}), "main.btq")[0], folded)
    below = [box.parent for box in figure.boxes]
    assert all(parent is None or parent < number for number, parent in enumerate(below))
    return [f"{box.name}: {', '.join((box.title, *box.lines))}" for box in figure.boxes]


def test_a_folded_subtree_is_one_box_that_says_how_much_it_hides() -> None:
    assert shown(MISSION) == [
        "Main/->: ->",
        "Main/->/Ready: Ready",
        "Main/->/RetryUntilSuccessful Again: RetryUntilSuccessful, Again, num_attempts = 3",
        "Main/->/RetryUntilSuccessful Again/Drive ToDock: Drive, ToDock",
        "Main/->/Rest: Rest",
    ]
    assert shown(MISSION, "Main/->/RetryUntilSuccessful Again", "Main/->/Ready", "Main/no such node") == [
        "Main/->: ->",
        "Main/->/Ready: Ready",
        "Main/->/RetryUntilSuccessful Again: RetryUntilSuccessful, Again, num_attempts = 3, … 1 node",
        "Main/->/Rest: Rest",
    ]
    assert shown(MISSION, "Main/->", "Main/->/RetryUntilSuccessful Again") == ["Main/->: ->, … 4 nodes"]


def test_an_edit_elsewhere_leaves_a_fold_where_it_is() -> None:
    before = "BehaviorTree Main\n    ->\n        ?\n            A\n        ?\n            B\n"
    after = before.replace("    ->\n", "    ->\n        Retry (num_attempts = 2)\n            Z\n")
    assert shown(before, "Main/->/?#2")[-1] == "Main/->/?#2: ?, … 1 node"
    assert shown(after, "Main/->/?#2")[-1] == "Main/->/?#2: ?, … 1 node"


def test_folded_notes_are_one_line_that_names_the_first() -> None:
    text = "QualityReq soon\n    takes at most 30 s\nBehaviorTree Main\n    ->\n"
    text += "        A satisfies soon\n        B satisfices safety.fail-safe, security satisfies soon\n        C\n"

    def notes(*chosen: str, more: int = 0) -> list[tuple[str, ...]]:
        workspace = Workspace.of({"main.btq": text + "        Wait\n" * more})
        root = ElementTree.fromstring(picture(workspace, "main.btq", chosen).svg)
        groups = (group for group in root.iter(f"{SVG}g") if "note" in (group.get("class") or "").split())
        return [tuple(line.text or "" for line in group if line.tag != f"{SVG}rect") for group in groups]

    shown = [
        ("soon; takes at most 30 s", "soon", "takes at most 30 s"),
        ("satisfices safety.fail-safe", "safety.fail-safe"),
        ("satisfices security", "security"),
        ("soon; takes at most 30 s", "soon", "takes at most 30 s"),
    ]
    folded = [
        ("soon; takes at most 30 s", "soon"),
        ("satisfices safety.fail-safe; satisfices security; soon; takes at most 30 s", "fail-safe +2"),
    ]
    assert (notes(), notes(more=56), notes("+notes", more=57)) == (shown, shown, shown)
    assert (notes("-notes"), notes(more=57)) == (folded, folded)


def test_a_picture_tells_where_its_nodes_stand() -> None:
    workspace = Workspace.of({"main.btq": MISSION})
    whole = places(workspace, "main.btq")
    assert [MISSION[span.start : span.end] for span in whole.values()] == [
        *("->", "Ready", "Retry", "Drive", "Rest", "Sleep")
    ]
    assert picture(workspace, "main.btq").places == whole
    folded = picture(workspace, "main.btq", {"Main/->"})
    assert folded.places == {key: whole[key] for key in ("n0", "n5")}
    root = ElementTree.fromstring(folded.svg)
    boxes = {box.get("id"): box for box in root.iter(f"{SVG}g") if "box" in (box.get("class") or "")}
    assert {key: (box.get("data-parent"), box.get("data-hidden")) for key, box in boxes.items()} == {
        "n0": ("", "4"),
        "n5": ("", "0"),
    }
    title = boxes["n0"].findtext(f"{SVG}title")
    assert title == "->; folded: Ready, Retry Again (num_attempts = 3), Drive ToDock, Rest"
