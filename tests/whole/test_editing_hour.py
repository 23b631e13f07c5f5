"""An hour of editing, key by key: after every key the server answers as a new one would of the same texts.

The usual run compares after one key in forty, of other keys with another seed, and
`--every-key` after each (some minutes).
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from lsp_editor import Editor, Message
from seeds import share_of
from typist import Typist

from btq_lang.ide.colours import colours
from btq_lang.ide.completion import complete
from btq_lang.ide.hints import code_lenses, inlay_hints
from btq_lang.ide.hover import hover, signature_help
from btq_lang.ide.navigation import find_references, goto_definition, highlights, prepare_calls
from btq_lang.ide.on_type import linked_ranges
from btq_lang.ide.outline import document_symbols, workspace_symbols
from btq_lang.ide.rename import prepare_rename
from btq_lang.ide.structure import document_links, folding_ranges, selection_range
from btq_lang.lsp.session import Session
from btq_lang.util.text import Span

HERE = Path(__file__).parent
HOUR = (HERE.parent / "recordings" / "an_hour.keys").read_text(encoding="utf-8")
KEYS, SHARE = 2_332, 40


@pytest.fixture
def hospital(tmp_path: Path) -> Path:
    return Path(shutil.copytree(HERE.parents[1] / "examples" / "hospital", tmp_path / "hospital"))


def test_after_every_key_it_is_what_a_new_server_says(hospital: Path, request: pytest.FixtureRequest) -> None:
    numbers = range(1, KEYS + 1)
    sample = set(numbers if request.config.getoption("--every-key") else share_of(numbers, SHARE))
    typist = Typist(hospital)
    keys = compared = 0
    for keys, line in enumerate(typist.play(HOUR), 1):
        if keys in sample:
            compared += 1
            new = Session()
            new.folders = (str(hospital),)
            new.open.update(typist.texts)
            told = {path: new.diagnostics(path) for path in new.reload()}
            assert typist.told == told, (keys, line)
            assert answers(typist.session, typist) == answers(new, typist), (keys, line)
    assert keys == KEYS
    assert compared == len(sample)


def answers(session: Session, typist: Typist) -> Mapping[str, object]:
    """The server's results for the current file, and at the cursor."""
    path, offset = typist.path, typist.cursor
    workspace = session.workspace_of(path)
    if workspace is None:
        return {}
    at = workspace, path, offset
    whole = Span(0, len(typist.texts[path]))
    asked = (hover, complete, signature_help, goto_definition, find_references, highlights, linked_ranges)
    return {
        **{feature.__name__: feature(*at) for feature in (*asked, selection_range, prepare_rename, prepare_calls)},
        "symbols": document_symbols(workspace, path),
        "tokens": colours(workspace, path, "utf-16").data,
        "folds": folding_ranges(workspace, path),
        "links": document_links(workspace, path),
        "hints": inlay_hints(workspace, path, whole),
        "lenses": code_lenses(workspace, path),
        "names": workspace_symbols(workspace, "o"),
    }


# ---- the same over the protocol, for a part of the hour ----

PULLS: Message = {"textDocument": {"diagnostic": {}}}
PLAYED, EVERY = 600, 100


def test_a_process_answers_as_a_new_one(hospital: Path) -> None:
    typist, editor = Typist(hospital), Editor(hospital, capabilities=PULLS)
    known: dict[str, str] = {}
    result = ""
    data: list[int] = []
    for keys, line in enumerate(typist.play(HOUR), 1):
        for name, text in open_texts(typist, hospital).items():
            if name not in known:
                editor.open(name, text)
            elif known[name] != text:
                editor.change(name, text)
            known[name] = text
        name = Path(typist.path).relative_to(hospital).as_posix()
        delta = {**editor.document(name), "previousResultId": result}
        made = editor.request("textDocument/semanticTokens/full/delta", **delta)
        result = made["resultId"]
        data = made["data"] if "data" in made else patched(data, made["edits"])
        if keys % EVERY == 0:
            new = Editor(hospital, capabilities=PULLS)
            for other, text in known.items():
                new.open(other, text)
            place = position(typist.texts[typist.path], typist.cursor)
            assert said(editor, name, place) == said(new, name, place), (keys, line)
            assert data == new.request("textDocument/semanticTokens/full", **editor.document(name))["data"]
            assert new.close() == ""
        if keys == PLAYED:
            break
    assert editor.close() == ""


def open_texts(typist: Typist, folder: Path) -> dict[str, str]:
    return {Path(path).relative_to(folder).as_posix(): text for path, text in typist.texts.items()}


def position(text: str, offset: int) -> Message:
    """In UTF-16, as the protocol has it where nothing else was agreed."""
    before = text[:offset].split("\n")
    return {"line": len(before) - 1, "character": len(before[-1].encode("utf-16-le")) // 2}


def patched(data: list[int], edits: list[Message]) -> list[int]:
    for edit in reversed(edits):
        start = edit["start"]
        data = [*data[:start], *edit.get("data", ()), *data[start + edit["deleteCount"] :]]
    return data


def said(editor: Editor, name: str, place: Message) -> dict[str, Any]:
    """What an editor asks when a key was hit."""
    document = editor.document(name)
    at = {**document, "position": place}
    report = editor.request("textDocument/diagnostic", **document)
    return {
        "diagnostics": report["items"],
        **{
            method: editor.request(f"textDocument/{method}", **document)
            for method in ("documentSymbol", "foldingRange", "documentLink", "codeLens")
        },
        **{
            method: editor.request(f"textDocument/{method}", **at)
            for method in ("hover", "completion", "definition", "documentHighlight", "signatureHelp")
        },
    }
