"""Every request that the server answers, at random places of XML: nothing raises, every place is in the document, and
every edit makes of the XML what it says."""

from __future__ import annotations

import random
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from lsp_editor import Editor, Message
from seeds import seeds

from btq_lang.btcpp.opening import file_of
from btq_lang.btcpp.recognition import is_mission
from btq_lang.checks import check
from btq_lang.projects.files import Files
from btq_lang.server import make_server
from btq_lang.util.text import Edit, LineIndex, Position, Span, apply_edits

CAPABILITIES: Message = {
    "textDocument": {
        "completion": {"completionItem": {"snippetSupport": True}},
        "definition": {"linkSupport": True},
        "semanticTokens": {"tokenTypes": [], "tokenModifiers": [], "formats": [], "requests": {}},
    },
    "workspace": {"workspaceEdit": {"documentChanges": False}},
}
AT_A_PLACE = (
    *("hover", "definition", "declaration", "implementation", "typeDefinition", "references", "documentHighlight"),
    *("prepareRename", "rename", "completion", "signatureHelp", "linkedEditingRange", "prepareCallHierarchy"),
    "onTypeFormatting",
)
OF_A_DOCUMENT = (
    *("documentSymbol", "foldingRange", "documentLink", "codeLens", "formatting", "diagnostic"),
    *("semanticTokens/full", "semanticTokens/full/delta"),
)
OF_A_RANGE = ("codeAction", "inlayHint", "rangeFormatting", "semanticTokens/range")
ASKED_OTHERWISE = (
    *("textDocument/didOpen", "textDocument/didChange", "textDocument/didClose", "textDocument/selectionRange"),
    *("completionItem/resolve", "callHierarchy/incomingCalls", "callHierarchy/outgoingCalls", "workspace/symbol"),
    *("workspace/willRenameFiles", "workspace/diagnostic"),
)
MORE: Message = {
    "context": {"includeDeclaration": True, "diagnostics": [], "triggerKind": 1, "isRetrigger": False},
    "newName": "another",
    "ch": "\n",
    "options": {"tabSize": 4, "insertSpaces": True},
    "previousResultId": "1",
}
NOT_IN_XML = {
    *("textDocument/signatureHelp", "textDocument/linkedEditingRange", "textDocument/onTypeFormatting"),
    *("textDocument/formatting", "textDocument/rangeFormatting", "textDocument/foldingRange"),
    *("textDocument/selectionRange", "textDocument/inlayHint", "workspace/willRenameFiles"),
    "textDocument/typeDefinition",
}
COMMANDS = ("btq.server.nodePath", "btq.server.xml", "btq.server.picture", "btq.server.overview")
REFUSED, LATER = -32803, -32802

TREES = """\
<?xml version="1.0"?>
<!-- trees of a robot -->
<root BTCPP_format="4" main_tree_to_execute="Main">
  <include path="other.xml"/>
  <BehaviorTree ID="Main">
    <Sequence name="all &lt;of&gt; it">
      <Script code="tries := 1; far := 'a &amp; b'"/>
      <SubTree ID="Dock" station="{shelf}" note='say "no"'/>
      <SubTree _autoremap="true" ID="Other"/>
      <Timeot msec="1000">
        <Pick from="{shelf}" to="{@hand}" _skipIf="tries &gt;= 3 &amp;&amp; tries &lt; 5"></Pick>
      </Timeot>
      <Weird thing="1"><description>text</description></Weird>
      <Action ID="Pick" from="🤖 {shelf}" nowhere="2"/>
    </Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Dock">
    <Fallback>
      <Precondition if="station == 'a'" else="FAILURE"><AlwaysSuccess/></Precondition>
      <Delay delay_msec="{station}" />
    </Fallback>
  </BehaviorTree>
  <TreeNodesModel>
    <Action ID="Pick">
      <input_port name="from" type="std::string" default="{=}">where &amp; how</input_port>
      <output_port name="to"/>
    </Action>
    <SubTree ID="Dock"><input_port name="station"/></SubTree>
    <Other><x/></Other>
  </TreeNodesModel>
</root>
"""
OTHER = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Other"><Pick from="{shelf}"/></BehaviorTree>
</root>
"""
PIECES = ("<", ">", "/>", '"', "'", "🤖", "x", "", "{", "}", "&", "&lt;", "\r\n", '<SubTree ID="Dock"/>', "<!--", "-->")
GOLDEN = sorted((Path(__file__).parents[1] / "btcpp" / "golden").glob("*.xml"))


def test_every_request_is_asked() -> None:
    """A new feature of the server is to be asked here too."""
    served = {name for name in make_server().protocol.fm.features if name.startswith(("textDocument/", "workspace/"))}
    named = (f"textDocument/{each}" for each in (*AT_A_PLACE, *OF_A_DOCUMENT, *OF_A_RANGE))
    notified = {name for name in served if "/did" in name or name == "workspace/executeCommand"}
    assert served - notified - {*ASKED_OTHERWISE} == {*named}


def test_every_word(tmp_path: Path) -> None:
    """Of XML that is sound; what is made of all of a document, or needs brackets and blocks, has no answer in XML."""
    asked = Asked(tmp_path, random.Random(0))
    asked.about(TREES, places=0)
    for word in re.finditer(r"\w+", TREES):
        asked.at(word.start())
    asked.end()
    assert {name for name, often in asked.answered.items() if not often} == NOT_IN_XML


@pytest.mark.parametrize("seed", seeds(4))
def test_written_and_damaged_xml(tmp_path: Path, seed: int) -> None:
    chance = random.Random(seed)
    texts = [TREES, *(path.read_bytes().decode() for path in chance.sample(GOLDEN, 3))]
    asked = Asked(tmp_path, chance)
    for text in texts:
        for damage in (0, 0, 1, 1, 2, 3):
            asked.about(damaged(chance, text, damage), places=3)
    asked.end()


@pytest.mark.scheduled
@pytest.mark.parametrize("seed", seeds(2))
def test_xml_of_others(shared: Path, tmp_path: Path, seed: int) -> None:
    chance = random.Random(seed)
    paths = sorted((shared / "corpus").rglob("*.xml"))
    asked = Asked(tmp_path, chance)
    for path in chance.sample(paths, 12):
        text = path.read_bytes().decode(errors="replace").removeprefix("\ufeff")
        for damage in (0, 1):
            asked.about(damaged(chance, text, damage), places=2)
    asked.end()


def damaged(chance: random.Random, text: str, often: int) -> str:
    for _ in range(often):
        start = chance.randrange(len(text) + 1)
        text = text[:start] + chance.choice(PIECES) + text[min(start + chance.choice((0, 0, 1, 5)), len(text)) :]
    return text


class Asked:
    """An editor that sends every request about a document.

    Attributes:
        answered: how many of its answers had something in them, by request.
    """

    def __init__(self, root: Path, chance: random.Random) -> None:
        (root / "other.xml").write_text(OTHER, encoding="utf-8")
        (root / "main.btq").write_text('include "trees.xml"\nBehaviorTree Start\n    SubTree Dock\n', encoding="utf-8")
        self.editor = Editor(root, capabilities=CAPABILITIES)
        self.chance = chance
        self.text = ""
        self.answered: Counter[str] = Counter()

    def about(self, text: str, places: int) -> None:
        """Ask everything about a text: about the document, and at some places of it."""
        self.text = text
        if "trees.xml" in self.editor.versions:
            self.editor.change("trees.xml", text)
        else:
            self.editor.open("trees.xml", text)
        document = self.editor.document("trees.xml")
        for name in OF_A_DOCUMENT:
            self.ask(f"textDocument/{name}", **document, **MORE)
        for command in COMMANDS[1:]:
            self.ask("workspace/executeCommand", command=command, arguments=[document["textDocument"]])
        self.ask("workspace/symbol", query="")
        self.ask("workspace/diagnostic", previousResultIds=[])
        moves = {"oldUri": self.editor.uri("other.xml"), "newUri": self.editor.uri("moved/other.xml")}
        self.ask("workspace/willRenameFiles", files=[moves])
        words = [match.start() for match in re.finditer(r"\w+", text)]
        for _ in range(places):
            self.at(self.chance.choice(words) if words else 0)
            self.at(self.chance.randrange(len(text) + 1))

    def at(self, offset: int) -> None:
        document = self.editor.document("trees.xml")
        lines = LineIndex(self.text)
        start = self.place(lines, offset)
        end = self.place(lines, min(offset + self.chance.choice((0, 1, 60)), len(self.text)))
        for name in AT_A_PLACE:
            answer = self.ask(f"textDocument/{name}", **document, position=start, **MORE)
            if answer and name == "completion":
                for item in answer["items"][:3]:
                    self.ask("completionItem/resolve", **item)
            if answer and name == "prepareCallHierarchy":
                self.ask("callHierarchy/incomingCalls", item=answer[0])
                self.ask("callHierarchy/outgoingCalls", item=answer[0])
            if answer and name == "rename":
                self.renamed(answer)
        for name in OF_A_RANGE:
            answer = self.ask(f"textDocument/{name}", **document, range={"start": start, "end": end}, **MORE)
            if answer and name == "codeAction":
                for action in answer:
                    self.mended(action)
        self.ask("textDocument/selectionRange", **document, positions=[start])
        at_place = {"textDocument": document["textDocument"], "position": start}
        self.ask("workspace/executeCommand", command=COMMANDS[0], arguments=[at_place])

    def place(self, lines: LineIndex, offset: int) -> Message:
        return dict(zip(("line", "character"), lines.position(offset, "utf-16"), strict=True))

    def ask(self, method: str, **params: Any) -> Any:
        """The result of a request; it may be refused, but not fail."""
        answer = self.editor.ask(method, **params)
        if "error" in answer:
            allowed = (REFUSED, LATER) if "semanticTokens" in method else (REFUSED,)
            assert answer["error"]["code"] in allowed, (method, params, answer, self.text)
            return None
        result = answer["result"]
        self.answered[method] += bool(result)
        for uri, range_ in ranges(result, self.editor.uri("trees.xml")):
            self.assert_in(uri, range_)
        return result

    def assert_in(self, uri: str, range_: Message) -> None:
        """A range begins before it ends, and both are places of its document."""
        lines = LineIndex(self.text_of(uri))
        start, end = (Position(each["line"], each["character"]) for each in (range_["start"], range_["end"]))
        assert start <= end, range_
        for each in (start, end):
            assert lines.position(lines.offset(each, "utf-16"), "utf-16") == each, (uri, range_, lines.text)

    def text_of(self, uri: str) -> str:
        name = uri.removeprefix(self.editor.root.as_uri() + "/")
        return self.text if name == "trees.xml" else (self.editor.root / name).read_text("utf-8")

    def edited(self, edit: Message) -> dict[str, str]:
        """The texts after an edit, by file name."""
        texts: dict[str, str] = {}
        for uri, edits in edit["changes"].items():
            text = self.text_of(uri)
            lines = LineIndex(text)
            made = []
            for each in edits:
                places = (each["range"]["start"], each["range"]["end"])
                span = Span(*(lines.offset(Position(at["line"], at["character"]), "utf-16") for at in places))
                made.append(Edit(span, each["newText"]))
            texts[uri.removeprefix(self.editor.root.as_uri() + "/")] = apply_edits(text, made)
        return texts

    def mended(self, action: Message) -> None:
        """A quick fix leaves XML that can be read; one that silences a rule silences it, and nothing appears."""
        texts = self.edited(action["edit"])
        for name, text in texts.items():
            assert name.endswith(".btq") or file_of(name, text).is_understood, (action, text)
        before, after = self.found({}), self.found(texts)
        if action["kind"] == "source.fixAll.btq":
            assert after.total() < before.total(), (action, self.text)
        elif action["title"].startswith("Silence"):
            (rule,) = (each["code"] for each in action["diagnostics"])
            assert after <= before, (action, self.text)
            assert after[rule] < before[rule], (action, self.text)

    def renamed(self, edit: Message) -> None:
        """After a rename nothing is found that was not before; the name in a message may be the new one."""
        before, after = self.found({}), self.found(self.edited(edit))
        assert after <= before, (edit, before, after, self.text)

    def found(self, texts: dict[str, str]) -> Counter[str]:
        """The rules that a check of the folder reports, with some files changed; other XML is not reported on."""
        files = Files()
        files.folders = (str(self.editor.root),)
        path = str(self.editor.root / "trees.xml")
        files.overlay = {path: self.text, **{str(self.editor.root / name): text for name, text in texts.items()}}
        if not is_mission(files.overlay[path]):
            return Counter()
        groups, _ = files.groups([str(self.editor.root), path], with_xml=True, for_checks=True)
        return Counter(each.rule for group in groups for path in group.given for each in check(group.workspace, path))

    def end(self) -> None:
        """Nothing was logged."""
        assert self.editor.close() == ""


def ranges(result: Any, uri: str) -> Iterator[tuple[str, Message]]:
    """The ranges in a result, each with the document that it is in."""
    if isinstance(result, list):
        for each in result:
            yield from ranges(each, uri)
    elif isinstance(result, dict) and {"start", "end"} <= result.keys() and isinstance(result["start"], dict):
        yield uri, result
    elif isinstance(result, dict):
        own = result.get("uri", uri)
        for key, each in result.items():
            if key == "changes":
                for changed, edits in each.items():
                    yield from ranges(edits, changed)
            else:
                yield from ranges(each, result["targetUri"] if key.startswith("target") and key != "target" else own)
