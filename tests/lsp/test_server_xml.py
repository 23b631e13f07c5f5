"""XML in an editor: what the language server says of documents that are BehaviorTree.CPP's XML, and of no others."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from lsp_editor import Editor, Message, part
from seeds import seeds

from btq_lang import build, open_workspace
from btq_lang.btcpp.recognition import is_mission
from btq_lang.checks import check
from btq_lang.projects.files import Files
from btq_lang.util.text import Edit, LineIndex, Position, Span, apply_edits

DOCK = """<root BTCPP_format="4">
  <BehaviorTree ID="Dock">
    <Timeout msec="1000">
      <SubTree ID="Home"/>
    </Timeout>
  </BehaviorTree>
  <BehaviorTree ID="Home">
    <Action ID="Pick" from="{shelf}"/>
  </BehaviorTree>
</root>
"""


@pytest.fixture
def editor(tmp_path: Path) -> Iterator[Editor]:
    editor = Editor(tmp_path)
    yield editor
    assert editor.close() == ""


@pytest.fixture
def foreign(tmp_path: Path) -> Iterator[Editor]:
    """An editor that sends the server an XML file, which a mission includes."""
    (tmp_path / "dock.xml").write_text(DOCK, encoding="utf-8")
    (tmp_path / "main.btq").write_text('include "dock.xml"\nBehaviorTree Main\n    SubTree Dock\n', encoding="utf-8")
    (tmp_path / "other.btq").write_text("BehaviorTree Other\n    Pick\n", encoding="utf-8")
    editor = Editor(tmp_path)
    editor.open("dock.xml", DOCK)
    yield editor
    assert editor.close() == ""


def test_xml_is_checked_as_it_is_typed(foreign: Editor) -> None:
    assert foreign.diagnostics("dock.xml") == []
    foreign.change("dock.xml", DOCK.replace("Timeout", "Timeot"))
    assert foreign.diagnostics("dock.xml") == [("unknown-node", 2, 5, 11)]
    foreign.change("dock.xml", DOCK.replace('ID="Dock"', 'ID="Station"'))
    assert foreign.diagnostics("dock.xml") == []
    assert foreign.diagnostics("main.btq") == [("unknown-tree", 2, 12, 16)]
    foreign.change("dock.xml", DOCK[:-9])
    assert [found[0] for found in foreign.diagnostics("dock.xml")] == ["xml-syntax"]


@pytest.mark.parametrize(
    "text",
    [
        "<project><name/></project>",
        "<project><na",
        "",
        "<root><item/></root>",
        "<root",
        "<BehaviorTree ID='T'/>",
        '<Root BTCPP_format="4"><BehaviorTree ID="T"/></Root>',
    ],
)
@pytest.mark.parametrize("capabilities", [{}, {"textDocument": {"diagnostic": {}}}], ids=["push", "pull"])
def test_nothing_is_published_for_xml_that_is_not_the_engines(tmp_path: Path, text: str, capabilities: Message) -> None:
    editor = Editor(tmp_path, capabilities=capabilities)
    editor.open("pom.xml", text)
    editor.change("pom.xml", f"{text} ")
    pulled = editor.request("textDocument/diagnostic", **editor.document("pom.xml"))
    assert pulled == {"kind": "full", "items": []}
    assert editor.request("textDocument/documentSymbol", **editor.document("pom.xml")) == []
    assert editor.kept == []
    assert editor.close() == ""


def test_xml_that_a_mission_includes_is_reported_on(editor: Editor) -> None:
    editor.open("pom.xml", "<project><name/></project>")
    editor.open("main.btq", 'include "pom.xml"\n')
    assert editor.diagnostics("pom.xml") == [("xml-root", 0, 1, 8)]


def test_xml_that_stops_being_the_engines_is_left_alone(foreign: Editor) -> None:
    foreign.open("alone.xml", DOCK.replace("Timeout", "Timeot"))
    assert foreign.diagnostics("alone.xml") == [("unknown-node", 2, 5, 11)]
    foreign.change("alone.xml", "<project/>")
    assert foreign.diagnostics("alone.xml") == []
    foreign.change("alone.xml", "<project>")
    foreign.change("alone.xml", DOCK.replace('msec="1000"', ""))
    assert foreign.published("alone.xml")["version"] == 4


def test_closed_xml_is_no_longer_reported_on(foreign: Editor) -> None:
    text = DOCK.replace("Timeout", "Timeot")
    for at_the_disk in (text, DOCK):
        (foreign.root / "alone.xml").write_text(at_the_disk, encoding="utf-8")
        foreign.open("alone.xml", text)
        assert foreign.diagnostics("alone.xml") == [("unknown-node", 2, 5, 11)]
        foreign.shut("alone.xml")
        assert foreign.diagnostics("alone.xml") == []


def test_open_xml_counts_instead_of_the_disk(foreign: Editor) -> None:
    """For a mission that includes it, and for XML that looks for its trees there."""
    user = DOCK.replace("Home", "Base").replace("Dock", "Other").replace("Base", "Dock", 1)
    foreign.open("user.xml", user)
    assert foreign.diagnostics("user.xml") == []
    foreign.open("main.btq", 'include "dock.xml"\nBehaviorTree Main\n    SubTree Dock\n')
    assert foreign.diagnostics("main.btq") == []
    foreign.change("dock.xml", part((1, 20), (1, 24), "Dok"))
    assert foreign.diagnostics("main.btq") == [("unknown-tree", 2, 12, 16)]
    assert foreign.diagnostics("user.xml") == [("unknown-tree", 3, 19, 23)]
    foreign.change("dock.xml", part((1, 22), (1, 22), "c"))
    assert foreign.diagnostics("main.btq") == []
    assert foreign.diagnostics("user.xml") == []


@pytest.mark.parametrize(("encoding", "column"), [("utf-8", 36), ("utf-16", 34), ("utf-32", 33)])
def test_columns_of_xml_are_counted_as_agreed(tmp_path: Path, encoding: str, column: int) -> None:
    editor = Editor(tmp_path, capabilities={"general": {"positionEncodings": [encoding]}})
    tree = '<BehaviorTree ID="🤖"><Sequence name="🤖"/></BehaviorTree>'
    editor.open("main.xml", f'<root BTCPP_format="4">\n{tree}\n</root>\n')
    found = editor.diagnostics("main.xml")
    pulled = editor.request("textDocument/diagnostic", **editor.document("main.xml"))["items"]
    assert [each["code"] for each in pulled] == [each[0] for each in found]
    place = {"start": {"line": 1, "character": 22 + column - 33}, "end": {"line": 1, "character": 30 + column - 33}}
    assert [each["range"] for each in pulled if each["code"] == "child-count"] == [place]
    assert editor.close() == ""


def test_a_tag_is_typed_key_by_key(foreign: Editor) -> None:
    """While the text is not well-formed its mistake is shown where it is, and nothing else; then all is as before."""
    foreign.change("dock.xml", DOCK.replace("Timeout", "Timeot"))
    said = '<Sleep msec="5"/>'
    shown = []
    for at, key in enumerate(said):
        foreign.change("dock.xml", part((7, 4 + at), (7, 4 + at), key))
        pulled = foreign.request("textDocument/diagnostic", **foreign.document("dock.xml"))["items"]
        shown.append([(each["code"], each["range"]["start"]["line"]) for each in pulled])
    assert shown[:-1] == [[("xml-syntax", 7)]] * (len(said) - 1)
    assert shown[-1] == [("unknown-node", 2), ("tree-root-count", 7)]


SOME = 12  # files of the corpus, of about 500: each is checked by two programs, and after each edit again
PIECES = (
    "<",
    ">",
    "/>",
    '"',
    "🤖",
    "x",
    "",
    '<Sequnce name="🤖"/>',
    '<SubTree ID="Nowhere"/>',
    "<!-- -->",
    "\n",
    "&amp;",
)


@pytest.mark.parametrize("seed", seeds(3))
def test_the_server_finds_in_xml_what_the_command_line_does(shared: Path, tmp_path: Path, seed: int) -> None:
    """In files that others wrote, and after edits in them."""
    chance = random.Random(seed)
    editor = Editor(tmp_path)
    files = Files()
    files.folders = (str(tmp_path),)
    compared = 0
    corpus = sorted((shared / "corpus" / "dev").iterdir())
    for number, path in enumerate(chance.sample(corpus, SOME)):
        text = path.read_bytes().decode().removeprefix("\ufeff")
        name = f"{number}/{path.name}"
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_bytes(text.encode())
        editor.open(name, text)
        for _ in range(4):
            compared += assert_same(editor, name, text, files)
            start = chance.randrange(len(text) + 1)
            end = min(start + chance.choice((0, 0, 1, 9)), len(text))
            if "\r" in text[max(start - 1, 0) : end + 1]:
                continue
            lines, piece = LineIndex(text), chance.choice(PIECES)
            places = [lines.position(at, "utf-16") for at in (start, end)]
            editor.change(name, part((places[0][0], places[0][1]), (places[1][0], places[1][1]), piece))
            text = text[:start] + piece + text[end:]
    assert compared > 20
    assert editor.close() == ""


def assert_same(editor: Editor, name: str, text: str, files: Files) -> int:
    """Compare what the server reports with what `btq check` does; return the number of diagnostics.

    Of what is not the engine's, `btq check` reports that, because somebody named the file, and the server nothing.
    """
    path = str(editor.root / name)
    files.overlay[path] = text
    (group,), problems = files.groups([path], with_xml=True, for_checks=True)
    del files.overlay[path]
    assert problems == ()
    pulled = editor.request("textDocument/diagnostic", **editor.document(name))["items"]
    lines = LineIndex(text)
    wanted = []
    for each in check(group.workspace, path) if is_mission(text) else ():
        start, end = (lines.position(at, "utf-16") for at in each.span)
        wanted.append((each.rule, tuple(start), tuple(end), "\n".join((each.message, *each.notes))))
    shown = [
        (each["code"], *(tuple(each["range"][end].values()) for end in ("start", "end")), each["message"])
        for each in pulled
    ]
    assert shown == [(rule, (start[0], start[1]), (end[0], end[1]), message) for rule, start, end, message in wanted], (
        name,
        text,
    )
    return len(wanted)


def test_what_stands_in_xml_is_explained_and_found(foreign: Editor) -> None:
    shown = foreign.request("textDocument/hover", **foreign.at("dock.xml", 2, 6))
    assert shown["contents"]["value"].startswith("**Timeout** (Decorator)")
    assert shown["range"] == {"start": {"line": 2, "character": 5}, "end": {"line": 2, "character": 12}}
    assert foreign.request("textDocument/hover", **foreign.at("dock.xml", 9, 7)) is None
    called, defined = (
        {"start": {"line": line, "character": start}, "end": {"line": line, "character": start + 4}}
        for line, start in ((3, 19), (6, 20))
    )
    uri = foreign.uri("dock.xml")
    here = foreign.at("dock.xml", 3, 21)
    assert foreign.request("textDocument/definition", **here) == [{"uri": uri, "range": defined}]
    context = {"includeDeclaration": False}
    assert foreign.request("textDocument/references", **here, context=context) == [{"uri": uri, "range": called}]
    highlighted = foreign.request("textDocument/documentHighlight", **here)
    assert [each["range"] for each in highlighted] == [called, defined]
    (home,) = foreign.request("textDocument/prepareCallHierarchy", **here)
    (caller,) = foreign.request("callHierarchy/incomingCalls", item=home)
    assert (caller["from"]["name"], caller["fromRanges"]) == ("Dock", [called])
    lenses = foreign.request("textDocument/codeLens", **foreign.document("dock.xml"))
    assert [lens["command"]["title"] for lens in lenses] == ["1 call", "1 call"]


def test_requirements_that_a_build_has_described(editor: Editor) -> None:
    """In the hover of the node, and counted above it."""
    text = (Path(__file__).parents[1] / "btcpp" / "golden" / "descriptions.xml").read_text("utf-8")
    editor.open("built.xml", text)
    lenses = editor.request("textDocument/codeLens", **editor.document("built.xml"))
    assert [(lens["range"]["start"]["line"], lens["command"]["title"]) for lens in lenses] == [
        *((3, "main tree"), (3, "1 quality"), (6, "3 requirements, 2 qualities")),
        *((10, "2 requirements, 2 qualities"), (13, "1 requirement")),
    ]
    shown = editor.request("textDocument/hover", **editor.at("built.xml", 13, 8))["contents"]["value"]
    assert shown.endswith("Written by `btq build`:\n\n* inline (energy): Little; takes at most 3 s")
    other = editor.request("textDocument/hover", **editor.at("built.xml", 14, 8))["contents"]["value"]
    assert "btq build" not in other


def test_requirements_in_a_side_file(tmp_path: Path) -> None:
    """They count instead of what is described, unless the file is damaged, or the XML is not that of the build."""
    mission = tmp_path / "main.btq"
    pick = "    Action Pick\n        satisfies QualityReq quick takes at most 3 s\n"
    mission.write_text(f"Root Main\nBehaviorTree Main\n{pick}", encoding="utf-8")
    files = build(open_workspace(str(mission)), str(mission)).files
    xml, side = (files[str(tmp_path / name)] for name in ("main.xml", "main.qreq.json"))
    (tmp_path / "main.xml").write_text(xml, encoding="utf-8")
    editor = Editor(tmp_path, capabilities={"workspace": {"codeLens": {"refreshSupport": True}}})
    editor.open("main.xml", xml)

    def shown() -> tuple[list[tuple[int, str]], str]:
        lenses = editor.request("textDocument/codeLens", **editor.document("main.xml"))
        hover = editor.request("textDocument/hover", **editor.at("main.xml", 4, 17))["contents"]["value"]
        titles = [(lens["range"]["start"]["line"], lens["command"]["title"]) for lens in lenses]
        return titles, hover.rpartition("Written by `btq build`:\n\n")[2]

    main, counts = (3, "main tree"), (4, "1 requirement")
    assert shown() == ([main, counts], "* quick: takes at most 3 s")
    editor.write("main.qreq.json", side)
    assert shown() == ([main, counts], "* quick: takes at most 3 s (monitored)")
    assert [each["method"] for each in editor.asked].count("workspace/codeLens/refresh") == 1
    for damaged in (side[:-30], "\0"):
        editor.write("main.qreq.json", damaged)
        assert shown() == ([main, (2, "main.qreq.json cannot be read"), counts], "* quick: takes at most 3 s")
    editor.write("main.qreq.json", side.replace("3 s", "4 s"))
    assert shown() == ([main, counts], "* quick: takes at most 4 s (monitored)")
    editor.change("main.xml", f"{xml}<!-- mine -->\n")
    other = (2, "main.qreq.json belongs to other XML than this")
    assert shown() == ([main, other, counts], "* quick: takes at most 3 s")
    editor.change("main.xml", xml)
    assert shown() == ([main, counts], "* quick: takes at most 4 s (monitored)")
    (tmp_path / "main.qreq.json").unlink()
    assert shown() == ([main, counts], "* quick: takes at most 3 s")
    assert editor.close() == ""


def test_entries_in_xml_are_coloured(foreign: Editor) -> None:
    """Nothing else is; while the XML cannot be read, the editor keeps what it has."""
    asked = foreign.document("dock.xml")
    tokens = foreign.request("textDocument/semanticTokens/full", **asked)
    assert tokens["data"][:3] == [7, 29, 5]
    assert len(tokens["data"]) == 5
    foreign.change("dock.xml", DOCK[:-9])
    refused = foreign.ask("textDocument/semanticTokens/full/delta", **asked, previousResultId=tokens["resultId"])
    assert refused["error"] == {"code": -32802, "message": "this XML cannot be read"}
    foreign.change("dock.xml", DOCK.replace("<root", "\n<root"))
    moved = foreign.request("textDocument/semanticTokens/full/delta", **asked, previousResultId=tokens["resultId"])
    assert moved["edits"] == [{"start": 0, "deleteCount": 5, "data": [8, *tokens["data"][1:]]}]


def test_commands_for_xml(foreign: Editor) -> None:
    """A path, the picture with places in the XML, the overview, and the conversion of what is saved."""

    def run(command: str, *arguments: Message) -> Any:
        return foreign.ask("workspace/executeCommand", command=f"btq.server.{command}", arguments=[*arguments])

    document = foreign.document("dock.xml")["textDocument"]
    assert run("nodePath", foreign.at("dock.xml", 3, 21))["result"] == "Dock/Timeout/Home"
    picture = run("picture", document)["result"]
    assert [place["line"] for place in picture["nodes"].values()] == [2, 3, 7]
    assert run("overview", document)["result"].startswith("<!DOCTYPE html>")
    for command in ("xml", "build"):
        assert run(command, document)["error"]["message"] == "this is not a .btq file of the open folders"
    foreign.change("dock.xml", f"{DOCK}<!-- -->\n")
    assert run("import", document)["error"]["message"] == "save this document to a file first"
    foreign.change("dock.xml", DOCK)
    done = run("import", document)["result"]
    assert done["files"] == [foreign.uri("dock.btq")]
    assert done["said"].startswith("1 file imported\n")
    assert (foreign.root / "dock.btq").read_text("utf-8").startswith("Root (BTCPP_format = 4)\n\nBehaviorTree Dock\n")
    assert "dock.btq: already exists" in run("import", document)["error"]["message"]
    mission = foreign.document("main.btq")["textDocument"]
    assert run("import", mission)["error"]["message"] == "this is a .btq file already"


def test_the_outline_of_xml(foreign: Editor) -> None:
    outline = foreign.request("textDocument/documentSymbol", **foreign.document("dock.xml"))
    dock = outline[1]
    assert [dock["name"], dock["children"][0]["name"], dock["children"][0]["children"][0]["name"]] == [
        *("Dock", "Timeout", "Home")
    ]

    def check(symbols: list[Message], around: Message | None) -> None:
        for one in symbols:
            inner, outer = one["selectionRange"], one["range"]
            assert order(outer["start"]) <= order(inner["start"]) <= order(inner["end"]) <= order(outer["end"])
            assert around is None or order(around["start"]) <= order(outer["start"])
            assert around is None or order(outer["end"]) <= order(around["end"])
            check(one["children"], outer)

    check(outline, None)


def order(place: Message) -> tuple[int, int]:
    return place["line"], place["character"]


def test_what_is_found_in_xml_is_mended(foreign: Editor) -> None:
    """By exact edits of the XML; a comment goes before the element."""
    text = DOCK.replace("Timeout", "Timeot")
    foreign.open("alone.xml", text)
    place = {"start": {"line": 2, "character": 6}, "end": {"line": 2, "character": 6}}
    asked = {**foreign.document("alone.xml"), "range": place, "context": {"diagnostics": []}}
    actions = foreign.request("textDocument/codeAction", **asked)
    assert [(each["title"], each.get("isPreferred")) for each in actions] == [
        ("Replace `Timeot` with `Timeout`", True),
        ("Silence `unknown-node` at this element", None),
    ]
    made = [applied(text, each["edit"]["changes"][foreign.uri("alone.xml")]) for each in actions]
    ignored = "<!-- btq: ignore[unknown-node] -->\n    <Timeot"
    assert made == [text.replace("Timeot", "Timeout"), text.replace("<Timeot", ignored)]


@pytest.mark.parametrize(("encoding", "start", "end"), [("utf-8", 18, 20), ("utf-16", 16, 18), ("utf-32", 15, 17)])
def test_xml_is_completed(tmp_path: Path, encoding: str, start: int, end: int) -> None:
    """While it is not well-formed, too: the range is that of the word in the XML."""
    editor = Editor(tmp_path, capabilities={"general": {"positionEncodings": [encoding]}})
    editor.open(
        "dock.xml", DOCK.replace("    <Timeout", '    <A b="🤖"/><Do\n    <Timeout').replace("Action ID", "Dock ID")
    )
    found = editor.request("textDocument/completion", **editor.at("dock.xml", 2, end))
    dock = next(item for item in found["items"] if item["label"] == "Dock")
    place = {"start": {"line": 2, "character": start}, "end": {"line": 2, "character": end}}
    assert dock["textEdit"] == {"range": place, "newText": "Dock"}
    resolved = editor.request("completionItem/resolve", **dock)
    assert resolved["documentation"]["value"].startswith("`Dock`: a custom node")
    assert editor.close() == ""


def applied(text: str, edits: list[Message]) -> str:
    """A text after edits of the protocol."""
    lines = LineIndex(text)
    made = []
    for each in edits:
        places = (Position(*order(each["range"][end])) for end in ("start", "end"))
        made.append(Edit(Span(*(lines.offset(place, "utf-16") for place in places)), each["newText"]))
    return apply_edits(text, made)


def test_what_xml_is_not_served_with(foreign: Editor) -> None:
    options = {"tabSize": 4, "insertSpaces": True}
    assert foreign.request("textDocument/formatting", **foreign.document("dock.xml"), options=options) is None
    for method in ("signatureHelp", "linkedEditingRange"):
        assert foreign.request(f"textDocument/{method}", **foreign.at("dock.xml", 3, 21)) is None
    place = {"start": {"line": 3, "character": 21}, "end": {"line": 3, "character": 21}}
    context: dict[str, list[Message]] = {"diagnostics": []}
    asked = {**foreign.document("dock.xml"), "range": place, "context": context}
    assert foreign.request("textDocument/codeAction", **asked) == []


def test_names_in_xml_are_renamed(foreign: Editor) -> None:
    """In every file that names the thing, open or not; not in one that cannot be read."""
    main = (foreign.root / "main.btq").read_text("utf-8")
    foreign.open("main.btq", main)
    for name, line, character in (("dock.xml", 1, 21), ("main.btq", 2, 13)):
        assert (
            foreign.request("textDocument/prepareRename", **foreign.at(name, line, character))["placeholder"] == "Dock"
        )
        edit = foreign.request("textDocument/rename", **foreign.at(name, line, character), newName="Station")
        assert applied(DOCK, edit["changes"][foreign.uri("dock.xml")]) == DOCK.replace("Dock", "Station")
        assert applied(main, edit["changes"][foreign.uri("main.btq")]) == main.replace("Dock", "Station")
    edit = foreign.request("textDocument/rename", **foreign.at("other.btq", 1, 5), newName="Grab")
    assert edit["changes"].keys() == {foreign.uri(name) for name in ("dock.xml", "other.btq")}
    foreign.change("dock.xml", DOCK[:-9])
    refused = foreign.ask("textDocument/rename", **foreign.at("main.btq", 2, 13), newName="Station")
    assert refused["error"] == {"code": -32803, "message": "cannot rename `Dock`: it is not defined"}


@pytest.mark.parametrize("name", ["trees.xml", "trees.tree"])
def test_xml_under_any_name_is_renamed_in(editor: Editor, name: str) -> None:
    editor.open(name, DOCK)
    edit = editor.request("textDocument/rename", **editor.at(name, 3, 21), newName="another")
    assert applied(DOCK, edit["changes"][editor.uri(name)]) == DOCK.replace("Home", "another")
