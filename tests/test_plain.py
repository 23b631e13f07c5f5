"""The short cuts of the parser change nothing: with and without them the same tree and the same diagnostics.

Three readers of one language are held against each other: the usual one, whose `lines` and `patterns` read what is
spelt as usual; the one made of characters alone, which is what gets compiled; and the full one, which cuts every line
into tokens.  The texts are the examples, made-up missions, and thousands of torn ones.
"""

from __future__ import annotations

import copy
import pickle
import random
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from missions import mission

from btq_lang import lexer, lines, nodes, parser, patterns, plain, scan, syntax, token_list
from btq_lang.parser import Parsed, parse

ROOT = Path(__file__).resolve().parents[1]
EXAMPLES = sorted(path for path in (ROOT / "examples").rglob("*") if path.suffix in (".btq", ".qualitybtcpp"))
CLASSIC, SHORT = mission(30, 7, "classic"), mission(30, 7, "short")

Reader = Callable[[str], Parsed]
patterns.expect(1_000_000)  # the usual reader takes no short cuts before it has read enough


def parse_by_characters(text: str) -> Parsed:
    """As the compiled parser reads: no patterns."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (lexer, nodes, plain, scan):
            patch.setattr(module, "COMPILED", True)
        return parse(text)


def parse_in_full(text: str) -> Parsed:
    """Every line is cut into tokens, character by character."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (lexer, nodes, plain, scan):
            patch.setattr(module, "COMPILED", True)
        patch.setattr(parser, "plain_head", lambda *_: (None, 0))
        for short_cut in ("plain_model", "plain_port"):
            patch.setattr(parser, short_cut, lambda *_: None)
        for short_cut in ("plain_node", "plain_clauses"):
            patch.setattr(nodes, short_cut, lambda *_: (None, 0))
        for short_cut in ("plain_requirement", "plain_clause_line"):
            patch.setattr(nodes, short_cut, lambda *_: None)
        return parse(text)


READERS = pytest.mark.parametrize("reader", [parse_by_characters, parse_in_full])


def assert_alike(text: str, reader: Reader) -> None:
    usual, other = parse(text), reader(text)
    assert usual.diagnostics == other.diagnostics, text
    assert usual.entries == other.entries, text


@READERS
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_examples_read_alike(path: Path, reader: Reader) -> None:
    assert_alike(path.read_bytes().decode("utf-8"), reader)


@READERS
@pytest.mark.parametrize("spelling", ["classic", "short"])
@pytest.mark.parametrize("seed", range(3))
def test_missions_read_alike(spelling: str, seed: int, reader: Reader) -> None:
    assert_alike(mission(300, seed, spelling), reader)  # type: ignore[arg-type]  # one of the two spellings


@pytest.mark.parametrize("text", [CLASSIC, SHORT], ids=["classic", "short"])
def test_tokens_are_cut_alike(text: str) -> None:
    assert parse(text).tokens == parse_by_characters(text).tokens


def test_the_usual_reader_takes_the_short_cuts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Else the other tests compare nothing: of the lines of a mission nearly all are read by patterns."""
    by_characters = []
    plain_node = nodes.plain_node

    def counted(text: str, start: int, blanks: str, base: int) -> object:
        by_characters.append(start)
        return plain_node(text, start, blanks, base)

    monkeypatch.setattr(nodes, "plain_node", counted)
    parse(mission(1_000, 1, "classic"))
    assert len(by_characters) < 50
    assert lines.read_lines is nodes.read_lines


def test_a_small_file_is_read_before_patterns_are_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patterns, "_expected", 0)
    for pattern in ("read_head", "read_line", "_ATTRIBUTE", "_TOKEN"):
        monkeypatch.setattr(patterns, pattern, patterns._nothing)
    parse(SHORT)
    assert patterns.read_line is patterns._nothing
    parse(mission(1_000, 1, "short"))
    assert patterns.read_line is not patterns._nothing


@pytest.mark.skipif(scan.COMPILED, reason="of a compiled class nothing is made without its values")
def test_what_is_made_without_its_values_passes_for_any_other() -> None:
    tree = parse(CLASSIC).trees[0]
    assert {type(part).__name__ for part in syntax.walk(tree.children)} >= {"Node", "Pair", "Word"}
    same = pickle.loads(pickle.dumps(tree))
    assert same == copy.deepcopy(tree) == tree
    assert type(same.children[0]) is syntax.Node


# ---- torn texts -----------------------------------------------------------------------------------------------------

PIECE = re.compile(r"\r\n|\n|[ \t]+|\"[^\"]*\"|[\w-]+|.")
STRANGE = (
    *(
        " ",
        "  ",
        "\t",
        "\n",
        "\r\n",
        "\r",
        "\n\n",
        "\n    ",
        "\n  ",
        "\x0b",
        "\xa0",
        "\ufeff",
        "\\",
        "\n#\n",
        " // c\n",
    ),
    *("(", ")", "=", "==", " = ", ",", ", ", "{", "}", "{x}", '"', "'", '""', "'a b'", "-", "?", "!", "#", "//", "/*"),
    *("*/", "/* c */", "->", "R?", "M->", "All||", "→", "ä", "é1", "٣", "x", "1", "-1", "0.5", "1e3", "30 s", "6 m/s"),
    *("A?", "Foo-bar", "Ready?", "done!", "a.b", "Quality", "Quality = ", "QualityReq", "QualityReq ID = ", "ID"),
    *(
        "satisfices ",
        "satisfies ",
        "tags ",
        "satisficesx",
        "parameters ",
        "description = ",
        "xml ",
        "input ",
        "Action ",
    ),
    *("SubTree ", "BehaviorTree ", "Root", "TreeNodesModel", "takes ", "mission ", 'a = "b"', "a = b,", "(a = 1)"),
)


def torn(text: str, draw: random.Random) -> str:
    """The text with one to three pieces or lines missing, doubled, exchanged or replaced by something strange."""
    for _ in range(draw.randint(1, 3)):
        pieces = PIECE.findall(text) if draw.random() < 0.7 else text.splitlines(keepends=True)
        if not pieces:
            return text
        at = draw.randrange(len(pieces))
        kind = draw.randrange(6)
        if kind == 0:
            del pieces[at]
        elif kind == 1:
            pieces.insert(at, pieces[at])
        elif kind == 2:
            pieces.insert(at, draw.choice(STRANGE))
        elif kind == 3:
            pieces[at] = draw.choice(STRANGE)
        elif kind == 4:
            other = draw.randrange(len(pieces))
            pieces[at], pieces[other] = pieces[other], pieces[at]
        else:
            pieces[at] = pieces[at].replace("    ", draw.choice(("\t", "  ", "   ", "     ")))
        text = "".join(pieces)
    return text


@READERS
@pytest.mark.parametrize("text", [CLASSIC, SHORT], ids=["classic", "short"])
def test_torn_missions_read_alike(text: str, reader: Reader) -> None:
    draw = random.Random(f"{len(text)}")
    for _ in range(1_000):
        assert_alike(torn(text, draw), reader)


@READERS
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_torn_examples_read_alike(path: Path, reader: Reader) -> None:
    draw = random.Random(path.name)
    text = path.read_bytes().decode("utf-8")
    for _ in range(60):
        assert_alike(torn(text, draw), reader)


@READERS
@pytest.mark.parametrize("newline", ["\r\n", "\r"])
@pytest.mark.parametrize("text", [CLASSIC, SHORT], ids=["classic", "short"])
def test_other_line_ends_read_alike(text: str, newline: str, reader: Reader) -> None:
    text = text.replace("\n", newline)
    assert_alike(text, reader)
    draw = random.Random(newline)
    for _ in range(100):
        assert_alike(torn(text, draw), reader)


@READERS
def test_every_prefix_reads_alike(reader: Reader) -> None:
    for text in (CLASSIC, SHORT):
        for end in range(0, len(text), 7):
            assert_alike(text[:end], reader)


CLAUSE_WORDS = (
    *("takes at most", "tries at least", "needs", "keeps", "never", "leaves", "succeeds", "succeeds within", "while"),
    *("when", "in at least", "of activations", "of runs", "over last", "activations", "on violation", "fail", "log"),
    *(
        "goal",
        "because",
        '"so"',
        '"so" # c',
        "verified by",
        "monitor",
        "test",
        "30 s",
        "6 m/s",
        "3 %",
        "5",
        "0.5",
        "-1",
    ),
    *("1.", ".5", "1e3", "speed", "a-b", "node", "not", "and", "max", "true", "<=", "==", "<", "+", "(", "x", "ready?"),
    *("every", "mission", "from", "per 1 s", "1", "bool", "min", "if", "else", "# c", "", " ", "\t", "²", "é", "R?"),
)
HEADS = (
    *(
        "QualityReq r",
        'QualityReq r "T"',
        "QualityReq r : a.b",
        'QualityReq r-1 : a "T"',
        "QualityReq",
        "QualityReq r :",
    ),
    *(
        'QualityReq r "T" goal 3 s',
        "QualityReq r : a.",
        'QualityReq r : a "T',
        'QualityReq r "T\\n"',
        "QualityReq R? : a",
    ),
    *(
        "QualityReq ID = r",
        "QualityReq ID",
        'QualityReq "r" : a',
        "QualityReq r: a",
        "QualityReq  r : a",
        "QualityReq r a",
    ),
)


@READERS
def test_random_clauses_read_alike(reader: Reader) -> None:
    draw = random.Random(4)
    for _ in range(3_000):
        lines = [" ".join(draw.choices(CLAUSE_WORDS, k=draw.randint(1, 4))) for _ in range(draw.randint(0, 3))]
        at_node = draw.random() < 0.5
        head = draw.choice(HEADS[:4] if draw.random() < 0.5 else HEADS)
        opening = f"BehaviorTree T\n  A\n    satisfies {head}\n" if at_node else f"{head}\n"
        assert_alike(opening + "".join(f"      {line}\n" for line in lines) + "signal x : s\n", reader)


def test_the_usual_reader_reads_plain_clauses_without_tokens(monkeypatch: pytest.MonkeyPatch) -> None:
    scanned = []
    scan_line = lexer.Lexer.scan

    def counted(self: lexer.Lexer) -> None:
        scan_line(self)
        scanned.append(" ".join(self.raws[:-1]))

    monkeypatch.setattr(lexer.Lexer, "scan", counted)
    parsed = parse(mission(1_000, 1, "short"))
    assert parsed.diagnostics == ()
    assert [
        line for line in scanned if line.split()[0] not in ("Action", "Condition", "input", "signal", "context")
    ] == []


# ---- pieces of items ------------------------------------------------------------------------------------------------


def pieces_by_lexer(text: str) -> list[tuple[int, int, str]]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(token_list, "COMPILED", True)
        return token_list.pieces(text)


@pytest.mark.parametrize("spelling", ["classic", "short"])
def test_pieces_are_cut_alike(spelling: str) -> None:
    items = re.split(r"\n(?=\S)", mission(300, 1, spelling))  # type: ignore[arg-type]  # one of the two spellings
    at_once = 0
    for item in items:
        read = patterns.read_pieces(item)
        at_once += read is not None
        assert token_list.pieces(item) == (pieces_by_lexer(item) if read is None else read) == pieces_by_lexer(item)
    assert at_once > 0.9 * len(items)


@pytest.mark.parametrize("text", [CLASSIC, SHORT], ids=["classic", "short"])
def test_torn_pieces_are_cut_alike(text: str) -> None:
    draw = random.Random(len(text))
    at_once = 0
    for _ in range(6_000):
        at = draw.randrange(len(text))
        part = torn(text[at : at + draw.randint(1, 80)], draw)
        read = patterns.read_pieces(part)
        at_once += read is not None
        assert read is None or read == pieces_by_lexer(part), part
    assert at_once > 1_000
