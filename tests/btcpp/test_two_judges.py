"""XML with lxml and without it: the same tree, diagnostics and edits, whatever the file."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest
from lxml import etree
from seeds import SEED, share_of
from xml_damage import damaged_xml, own_texts
from xml_judges import judged_by

from btq_lang.btcpp import strict
from btq_lang.btcpp.exact_edits import exact_edits
from btq_lang.btcpp.opening import file_of
from btq_lang.btcpp.reader import read
from btq_lang.checks import check
from btq_lang.util.text import Edit, Span
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

PATH = "tree.xml"
CASES = 5_000
LIMITS = (1, 45, 110, 114)  # codes of what lxml reports as too large or too deep


def answer(xml: str) -> tuple[object, ...]:
    """All that btq makes of an XML file: the mission, its places, what is wrong with it, edits of words."""
    file = file_of(PATH, xml)
    origin = file.origin
    assert origin is not None
    places = list(origin.places.pieces)
    edits = [exact_edits(file, Edit(Span(start, end), "Other")) for start, end, *_ in places[::5]]
    findings = check(Workspace({PATH: file}, Project()), PATH)
    return file.text, places, origin.diagnostics, origin.is_complete, origin.defines, edits, findings


def differing(texts: Iterable[str]) -> list[str]:
    """The texts of which btq makes something else without lxml."""
    texts = list(texts)
    answers = {}
    for judge in ("lxml", "expat"):
        with judged_by(judge):
            answers[judge] = [answer(text) for text in texts]
    return [text for text, one, other in zip(texts, *answers.values(), strict=True) if one != other]


def test_files_of_the_corpus(shared: Path) -> None:
    texts = [path.read_bytes().decode("utf-8", "replace") for path in sorted((shared / "corpus").rglob("*.xml"))]
    assert len(texts) > 480
    assert differing(share_of(texts, 4)) == []


def test_damaged_files() -> None:
    assert differing(damaged_xml(SEED, case, own_texts()) for case in share_of(range(CASES), 10)) == []


@pytest.mark.scheduled
def test_damaged_files_of_the_corpus(shared: Path) -> None:
    texts = [path.read_bytes().decode("utf-8", "replace") for path in sorted((shared / "corpus").rglob("*.xml"))]
    short = tuple(text for text in texts if len(text) < 6_000)
    assert differing(damaged_xml(SEED, case, short) for case in range(CASES)) == []


def test_what_lxml_refuses_is_reported_and_nothing_else() -> None:
    """lxml with its own tree, which checks prefixes too."""
    read_by_engine = refused = 0
    for case in share_of(range(CASES), 2):
        text = damaged_xml(SEED, case, own_texts())
        done = read(text)
        if done.document is not None:
            read_by_engine += 1
            refused += bool(done.problems)
            assert bool(done.problems) == is_refused(text), (case, text)
    assert (read_by_engine > 600, refused > 200) == (True, True)


def is_refused(text: str) -> bool:
    data = text.encode("utf-8", "replace")
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, encoding="utf-8")
    try:
        etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        return error.code not in LIMITS
    return not strict.judge()(text)
