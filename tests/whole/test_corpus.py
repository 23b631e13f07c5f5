"""Real behavior trees through everything: read, checked, written as .btq, and back to the same XML."""

from __future__ import annotations

import csv
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from lxml import etree
from seeds import share_of
from xml_elements import elements

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.btcpp.importing import Imported, import_xml
from btq_lang.btcpp.opening import file_of
from btq_lang.btcpp.reader import read
from btq_lang.btcpp.xsd import xsd
from btq_lang.catalog.versions import VERSIONS
from btq_lang.checks import check
from btq_lang.commands.schema import unknown_nodes
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.formatter import format_text
from btq_lang.parser import parse
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

pytestmark = pytest.mark.scheduled

# What does not come back, and why.
LOST = {
    "BehaviorTree+Groot__test_data__crossdoor_palette.xml": "a stray `/>` between models, which every reader ignores",
}

# What the engine loads, and yet is wrong: the main tree is defined nowhere; the verdict is of each tree by itself.
TRULY_WRONG = {
    "iocroblab+kautham__demos_OMPL_geo_demos_Tiago_warehouse_taskplan_tampconfig_tiago_warehouse_counterABC.xml",
}


@pytest.fixture(scope="module")
def corpus(shared: Path) -> dict[str, str]:
    """Every well-formed file by its name, as the loader reads it."""
    return {
        path.name: path.read_bytes().decode().removeprefix("\ufeff")
        for path in sorted((shared / "corpus" / "dev").iterdir())
    }


@pytest.fixture(scope="module")
def verdicts(shared: Path) -> dict[str, str]:
    """The engine's verdict on each file: OK, or LOAD or CREATE where it was refused."""
    with (shared / "corpus" / "MANIFEST.tsv").open(encoding="utf-8") as file:
        return {row["file"]: row["engine_4_10"] for row in csv.DictReader(file, delimiter="\t")}


@pytest.fixture(scope="module")
def found(corpus: dict[str, str]) -> dict[str, tuple[Diagnostic, ...]]:
    """The diagnostics of each file, by version 4 of the engine."""
    project = Project(original_engines=VERSIONS)
    return {name: check(Workspace({name: file_of(name, text)}, project), name) for name, text in corpus.items()}


@pytest.fixture(scope="module")
def imported(corpus: dict[str, str]) -> Callable[[bool], dict[str, Imported]]:
    """Those whose document element is root, by whether they stay what version 3 reads."""

    @cache
    def imported(keep_v3: bool) -> dict[str, Imported]:
        done = {name: import_xml(text, keep_v3) for name, text in corpus.items()}
        refused = {name for name, each in done.items() if not each.is_complete}
        assert len(refused) == 5
        assert all([each.rule for each in done[name].diagnostics] == ["xml-root"] for name in refused)
        return {name: each for name, each in done.items() if name not in refused}

    return imported


def test_an_import_has_no_mistake_and_is_formatted(imported: Callable[[bool], dict[str, Imported]]) -> None:
    texts = {each.text: name for keep_v3 in (True, False) for name, each in imported(keep_v3).items()}
    for text in texts:
        assert parse(text).diagnostics == (), texts[text]
    for text in share_of(texts, 2):
        assert format_text(text).edits == (), texts[text]


def test_xml_to_btq_to_the_same_xml(corpus: dict[str, str], imported: Callable[[bool], dict[str, Imported]]) -> None:
    for name, each in imported(True).items():
        workspace = Workspace.of({"main.btq": each.text})
        done = export(workspace, "main.btq", verbatim=True)
        assert (done.problems, done.repairs) == ((), ()), name
        original, back = read(corpus[name]).document, read(write(done.document)).document
        assert original is not None
        assert back is not None
        assert (elements(back) == elements(original)) is (name not in LOST), name
        assert {found.rule for found in each.diagnostics} == ({"xml-ignored"} if name in LOST else set()), name
        assert [change.message for change in each.changes if name not in LOST] == [], name


def test_what_was_version_3_can_be_built(imported: Callable[[bool], dict[str, Imported]]) -> None:
    """A translated file says that it is for version 4, and translating it again changes nothing."""
    count = 0
    for name, each in imported(False).items():
        if not any("BTCPP_format" in change.message for change in each.changes):
            continue
        count += 1
        done = export(Workspace.of({"main.btq": each.text}), "main.btq", verbatim=True)
        back = write(done.document)
        assert 'BTCPP_format="4"' in back, name
        assert import_xml(back).changes == (), name
    assert count == 79


def test_diagnostics_point_at_the_words_of_the_xml(
    corpus: dict[str, str], found: dict[str, tuple[Diagnostic, ...]]
) -> None:
    """Every place is a place of the XML, and the commonest rules point at the very word that they are about."""
    pointed = 0
    for name, text in corpus.items():
        for each in found[name]:
            assert 0 <= each.span.start <= each.span.end <= len(text), name
            for fix in each.fixes:  # of words, and in the file itself
                spans = [change.place.span for change in fix.changes if change.place.path is None]
                words = {text[span.start : span.end] for span in spans}
                assert (len(words), len(spans)) == (1, len(fix.changes)), (name, fix)
            if each.rule in ("unknown-node", "unknown-tree", "forbidden-name", "not-an-engine-node"):
                word = text[each.span.start : each.span.end]
                assert word in each.message or word == "BehaviorTree", (name, each)
                pointed += 1
    assert pointed > 200


def test_verdicts_as_the_engine_has_them(found: dict[str, tuple[Diagnostic, ...]], verdicts: dict[str, str]) -> None:
    """No error in what the engine loads; an error in what it refuses.

    The files were taken out of their folders, so what they include is not there and says nothing here.
    """
    cried_wolf, passed = [], []
    for name, diagnostics in found.items():
        errors = {each.rule for each in diagnostics if each.effective_severity is Severity.ERROR}
        if verdicts[name] == "OK" and errors - {"missing-include"}:
            cried_wolf.append(name)
        elif verdicts[name] != "OK" and not errors:
            passed.append(name)
    assert set(cried_wolf) == TRULY_WRONG
    assert passed == []


# What the checks only warn of, and an XSD cannot let pass.
REFUSED_BY_XSD = {"unknown-node", "not-an-engine-node", "xml-ignored"}

# What an XSD lets pass: another tag than that of a port, in the model of a node.
ODD_MODELS = {"ros-navigation+navigation2__nav2_behavior_tree__nav2_tree_nodes.xml"}


def test_files_without_an_error_are_valid_by_the_xsd_of_their_nodes(
    corpus: dict[str, str], found: dict[str, tuple[Diagnostic, ...]]
) -> None:
    checked = 0
    for name, text in corpus.items():
        severe = [each for each in found[name] if each.effective_severity in (Severity.ERROR, Severity.WARNING)]
        if any(each.effective_severity is Severity.ERROR for each in severe):
            continue
        file = file_of(name, text)
        schema = xsd([Workspace({name: file}, Project())], "4.10", unknown_nodes(file, found[name]))
        validator = etree.XMLSchema(etree.fromstring(schema.encode()))
        is_valid = validator.validate(etree.fromstring(text.encode()))
        is_expected = REFUSED_BY_XSD.isdisjoint(each.rule for each in severe) or name in ODD_MODELS
        assert is_valid == is_expected, (name, validator.error_log)
        checked += 1
    assert checked > 200
