"""The lexical form, language.md §2, sentence by sentence.

Tokens are written `KIND text` with `|` between; blanks are left out, `>>` and `<<` are INDENT and DEDENT, and `NL` is
the end of a line.
"""

from __future__ import annotations

import pytest
from syntax_asserts import assert_fix, assert_invariants, assert_parse, escaped, show_problems, written

from btq_lang.grammar.claim_words import HAPPENINGS, VERB_WORDS
from btq_lang.grammar.clauses import EXPERIMENTS
from btq_lang.grammar.conditions import FUNCTIONS, HEADS
from btq_lang.grammar.item_words import ITEM_WORDS
from btq_lang.lexer import Lexer, tokens
from btq_lang.parser import parse
from btq_lang.syntax.tokens import BLANK, DEDENT, DIRECTIONS, INDENT, NAMES, NEWLINE, NODE_CLAUSES, SYMBOLS, Token


def assert_lex(text: str, expected: str, *problems: str) -> None:
    """The tokens of a text, and what the lexer finds wrong with it."""
    text = written(text)
    assert_invariants(parse(text))
    assert " | ".join(show_token(token) for token in tokens(text) if token.kind != BLANK) == expected
    lexer = Lexer(text)
    while lexer.open_line():
        lexer.scan()
    assert show_problems(text, sorted(lexer.problems, key=lambda problem: problem.span)) == "\n".join(problems)


def show_token(token: Token) -> str:
    short = {INDENT: ">>", DEDENT: "<<", NEWLINE: "NL"}.get(token.kind)
    return short or f"{NAMES[token.kind]} {escaped(token.text)}".rstrip()


def assert_value(source: str, expected: str, *problems: str) -> None:
    """The tokens after `a =` in brackets; columns count from there."""
    shift = len("X (a = ")
    moved = [f"1:{int(problem[2:].split(' ', 1)[0]) + shift} {problem.split(' ', 1)[1]}" for problem in problems]
    assert_lex(f"X (a = {source})", f"NAME X | OPEN ( | NAME a | OPERATOR = | {expected} | CLOSE ) | NL", *moved)


# ---- lines ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_a_line_ends_with_any_of_the_three_line_ends(end: str) -> None:
    assert_lex(f"a{end}b{end}", "NAME a | NL | NAME b | NL")
    assert [token.text for token in tokens(f"a{end}b{end}") if token.kind == NEWLINE] == [end, end]


@pytest.mark.parametrize("character", ["\f", "\v", "\x1c", "\x85", "\u2028", "\u2029"])
def test_nothing_else_ends_a_line(character: str) -> None:
    shown = repr(character)
    problem = f"1:3 syntax-error «{character}» unexpected {shown}"
    lexer = Lexer(f"a {character} b")
    assert lexer.open_line()
    lexer.scan()
    assert lexer.raws == ["a", "b", ""]
    assert show_problems(lexer.text, lexer.problems) == problem


def test_a_byte_order_mark_is_skipped() -> None:
    assert_lex("\ufeffa\n  b", "NAME a | NL | >> | NAME b | NL | <<")


def test_a_comment_may_follow_a_byte_order_mark() -> None:
    assert_lex("\ufeff# a\nb", "COMMENT # a | NAME b | NL")


def test_a_byte_order_mark_inside_a_file_is_an_error() -> None:
    assert_lex("a\n\ufeffb", "NAME a | NL | NAME b | NL", "2:1 syntax-error «\ufeff» unexpected '\\ufeff'")


def test_the_last_line_needs_no_line_end() -> None:
    assert_lex("a", "NAME a | NL")
    assert_lex("", "")
    assert_lex(" \n\t\n", "")


# ---- indentation ----------------------------------------------------------------------------------------------------


def test_deeper_lines_open_a_block_and_lines_further_left_close_blocks() -> None:
    assert_lex("a\n b\n  c\nd", "NAME a | NL | >> | NAME b | NL | >> | NAME c | NL | << | << | NAME d | NL")


def test_any_run_of_tabs_and_spaces_indents() -> None:
    assert_lex("a\n \t b\n \t b\n \t  c", "NAME a | NL | >> | NAME b | NL | NAME b | NL | >> | NAME c | NL | << | <<")


def test_blank_lines_and_comment_lines_open_and_close_nothing() -> None:
    text = "a\n  b\n\n \n# x\n      # y\n\t/* z */\n  c"
    expected = "NAME a | NL | >> | NAME b | NL | COMMENT # x | COMMENT # y | COMMENT /* z */ | NAME c | NL | <<"
    assert_lex(text, expected)


def test_a_comment_before_code_is_not_part_of_its_indentation() -> None:
    assert_lex("a\n  /* x */ b\n  c", "NAME a | NL | COMMENT /* x */ | >> | NAME b | NL | NAME c | NL | <<")


def test_a_dedent_to_a_column_of_no_block_is_one_diagnostic() -> None:
    text = """
        BehaviorTree t
            ->
                A
                B
              C
              D
                E
            F
    """
    tree = """
        tree t
          ->
            A
            B
            C
            D
            E
          F
    """
    problem = "5:1 inconsistent-indentation «      » an indentation of 6 spaces matches no open block"
    parsed = assert_parse(text, tree, problem)
    assert parsed.diagnostics[0].notes == ("btq reads the line as if indented by 8 spaces",)
    assert_fix(
        "BehaviorTree t\n    A\n  B\n",
        "Indent it by 4 spaces",
        "BehaviorTree t\n    A\n    B\n",
    )


@pytest.mark.parametrize(
    ("line", "title", "mended"),
    [
        (" " * 9 + "D", "Indent it by 8 spaces", " " * 8 + "D"),
        (" " * 10 + "D", "Indent it by 12 spaces", " " * 12 + "D"),
        (" " * 7 + "D", "Indent it by 8 spaces", " " * 8 + "D"),
        ("\t\t\tD", "Indent it by 12 spaces", " " * 12 + "D"),
        ("\tD", "Indent it by 4 spaces", "    D"),
    ],
)
def test_a_column_of_no_block_is_taken_for_the_nearer_one(line: str, title: str, mended: str) -> None:
    blocks = "BehaviorTree t\n    A\n        B\n            C\n"
    assert_fix(f"{blocks}{line}\n", title, f"{blocks}{mended}\n")


def test_the_adopted_column_may_open_blocks() -> None:
    text = "BehaviorTree t\n    ->\n        A\n      B\n         C\n      D\n"
    tree = """
        tree t
          ->
            A
            B
              C
            D
    """
    assert_parse(text, tree, "4:1 inconsistent-indentation «      » an indentation of 6 spaces matches no open block")


def test_tabs_and_spaces_that_cannot_be_compared_are_one_diagnostic() -> None:
    text = "BehaviorTree t\n\t->\n\t\tA\n        B\n        C\n\t\tD\n"
    tree = """
        tree t
          ->
            A
          B
          C
            D
    """
    message = "tabs and spaces are mixed: 8 spaces cannot be compared with 1 tab"
    assert_parse(text, tree, f"4:1 inconsistent-indentation «        » {message}")


def test_an_item_at_a_column_of_no_block_is_still_an_item() -> None:
    text = """
        BehaviorTree t
            ->
                A
          BehaviorTree u
            B
    """
    tree = """
        tree t
          ->
            A
        tree u
          B
    """
    assert_parse(text, tree, "4:1 inconsistent-indentation «  » an indentation of 2 spaces matches no open block")


def test_an_item_at_a_column_of_no_block_in_a_root() -> None:
    text = """
        Root t
            BehaviorTree t
                    A
                BehaviorTree u
                    B
    """
    tree = """
        root t
          tree t
            A
          tree u
            B
    """
    assert_parse(text, tree, "4:1 inconsistent-indentation «        » an indentation of 8 spaces matches no open block")


# ---- brackets -------------------------------------------------------------------------------------------------------


def test_line_ends_and_indentation_mean_nothing_in_brackets() -> None:
    text = """
        a (
                b
            c
                    )
        d
    """
    assert_lex(text, "NAME a | OPEN ( | NAME b | NAME c | CLOSE ) | NL | NAME d | NL")


UNCLOSED = "unclosed-bracket «(» missing `)` for this `(`"


@pytest.mark.parametrize(
    "line",
    [
        "BehaviorTree b",
        'BehaviorTree "b c"',
        "BehaviorTree ID = b",
        "BehaviorTree",
        "BehaviorTree # b",
        "BehaviorTree (a = 1)",
        "Root b",
        "Root",
        "Root ()",
        "TreeNodesModel",
        "include 'b.btq'",
        "signal b : m",
        "context b : c",
        "apply b to c",
        "quality b",
        "qualities iso25010-2011",
        "QualityReq b",
    ],
)
def test_a_top_level_line_ends_forgotten_brackets(line: str) -> None:
    text = f"BehaviorTree a\n    X (b = 1\n{line}\n"
    parsed = parse(text)
    assert_invariants(parsed)
    assert show_problems(text, parsed.diagnostics) == f"2:7 {UNCLOSED}"
    assert len(parsed.entries) == 2
    assert [related.message for related in parsed.diagnostics[0].related] == ["the brackets end before this line"]


@pytest.mark.parametrize(
    "line",
    [
        "BehaviorTree = b",
        "include = b",
        "signal = b",
        "signal b = c",
        'include "b" = c',
        "QualityReq ID = b description = c",
        "context",
        "behaviortree b",
        "Action b",
        "xml 'b'",
    ],
)
def test_other_lines_at_the_margin_do_not(line: str) -> None:
    text = f"X (b = 1\n{line}\n)\nY"
    lexer = Lexer(text)
    assert lexer.open_line()
    lexer.scan()
    assert (lexer.problems, lexer.raws[-2:]) == ([], [")", "\n"])


def test_a_top_level_line_inside_a_closed_string_does_not() -> None:
    text = "BehaviorTree a\n    X (b = '\nBehaviorTree b\n')\n    Y"
    hint = "2:12 string-over-items «'» this string runs past a line that looks like the start of an item"
    assert_parse(text, "tree a\n  X (b='\\nBehaviorTree b\\n')\n  Y", hint)


def test_a_top_level_line_in_the_column_of_a_root_ends_forgotten_brackets() -> None:
    text = """
        Root a
          BehaviorTree a
            X (b = 1
          BehaviorTree b
            Y
    """
    tree = """
        root a
          tree a
            X (b=1)
          tree b
            Y
    """
    assert_parse(text, tree, f"3:7 {UNCLOSED}")


def test_the_brackets_of_a_root_end_at_its_first_item() -> None:
    text = """
        Root a (BTCPP_format = 4
          BehaviorTree a
            X
    """
    tree = """
        root a (BTCPP_format=4)
          tree a
            X
    """
    assert_parse(text, tree, f"1:8 {UNCLOSED}")


def test_behind_a_root_block_its_column_means_nothing() -> None:
    expected = "NAME Root | NL | >> | NAME a | NL | << | NAME X | OPEN ( | NAME BehaviorTree | NAME c | CLOSE ) | NL"
    assert_lex("Root\n  a\nX (\n  BehaviorTree c\n  )", expected)


def test_a_line_further_left_ends_the_brackets() -> None:
    text = """
        BehaviorTree t
            ->
                X (a = 1
                   b = 2
            Y
    """
    tree = """
        tree t
          ->
            X (a=1 b=2)
          Y
    """
    assert_parse(text, tree, f"3:11 {UNCLOSED}")


def test_a_line_further_left_ends_only_the_brackets_opened_further_right() -> None:
    text = """
        BehaviorTree t
            X (
                satisfices Quality = a
                    (QualityReq ID = "r"
                b = 1
            )
            Y
    """
    tree = """
        tree t
          X (b=1)
            satisfices a [{classic "r"}]
          Y
    """
    assert_parse(text, tree, f"4:13 {UNCLOSED}")


def test_a_line_that_is_not_comparable_is_not_further_left() -> None:
    assert_lex("a\n    X (b\n\tc)", "NAME a | NL | >> | NAME X | OPEN ( | NAME b | NAME c | CLOSE ) | NL | <<")


def test_a_line_that_begins_with_a_closing_bracket_never_ends_the_brackets_early() -> None:
    # Here `b` ends them; the missing `)` before it is not a second mistake.
    expected = "NAME a | NL | >> | NAME X | OPEN ( | CLOSE | NL | << | NAME b | NL | ERROR ) | NL"
    assert_lex("a\n    X (\nb\n)", expected, f"2:7 {UNCLOSED}")
    assert_lex("a\n    X (b\n)\nc", "NAME a | NL | >> | NAME X | OPEN ( | NAME b | CLOSE ) | NL | << | NAME c | NL")


def test_comments_further_left_do_not_end_the_brackets() -> None:
    text = "a\n    X (b\n# BehaviorTree c\n/* d */\n    e)"
    expected = "NAME a | NL | >> | NAME X | OPEN ( | NAME b | COMMENT # BehaviorTree c | COMMENT /* d */ | NAME e"
    assert_lex(text, f"{expected} | CLOSE ) | NL | <<")


def test_brackets_open_at_the_end_of_the_file() -> None:
    assert_lex("a ((b\n", "NAME a | OPEN ( | OPEN ( | NAME b | CLOSE | CLOSE | NL", f"1:3 {UNCLOSED}")


def test_forgotten_brackets_can_be_closed() -> None:
    assert_fix("BehaviorTree a\n  X (b = 1 # c\n", "Add `)`", "BehaviorTree a\n  X (b = 1) # c\n")


def test_a_closing_bracket_too_many_is_one_diagnostic() -> None:
    assert_parse("BehaviorTree a\n  X (b = 1))\n  Y\n", "tree a\n  X (b=1)\n  Y",
                 "2:12 syntax-error «)» unexpected `)`: no bracket is open")  # fmt: skip


# ---- symbols and names ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("symbol", SYMBOLS)
def test_symbols(symbol: str) -> None:
    assert_lex(symbol, f"SYMBOL {symbol} | NL")
    assert_lex(f"{symbol}a", f"SYMBOL {symbol} | NAME a | NL")
    assert_lex(f"{symbol}(a)", f"SYMBOL {symbol} | OPEN ( | NAME a | CLOSE ) | NL")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("R?", "SYMBOL R?"),
        ("A?", "SYMBOL A?"),
        ("R?b", "SYMBOL R? | NAME b"),
        ("M?", "NAME M?"),
        ("BR?", "NAME BR?"),
        ("R", "NAME R"),
        ("R ->", "NAME R | SYMBOL ->"),
        ("R-", "NAME R | OPERATOR -"),
        ("R-a", "NAME R-a"),
        ("Ra->", "NAME Ra | SYMBOL ->"),
        ("A->b", "SYMBOL A-> | NAME b"),
        ("All", "NAME All"),
        ("Alle", "NAME Alle"),
        ("All|| ||", "SYMBOL All|| | SYMBOL ||"),
        ("R?=3", "SYMBOL R? | OPERATOR = | NUMBER 3"),
        ("->->", "SYMBOL -> | SYMBOL ->"),
    ],
)
def test_the_longest_match_wins_and_a_symbol_before_a_name(text: str, expected: str) -> None:
    assert_lex(text, f"{expected} | NL")


@pytest.mark.parametrize(
    "name",
    ["a", "_", "_skipIf", "a1", "a-b", "a-1", "a-_b", "rq-1-a", "Größe", "名前", "Ready?", "Go!", "a-b?", "x²"],
)
def test_names(name: str) -> None:
    assert_lex(name, f"NAME {name} | NL")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a-", "NAME a | OPERATOR -"),
        ("a--b", "NAME a | OPERATOR - | OPERATOR - | NAME b"),
        ("a - b", "NAME a | OPERATOR - | NAME b"),
        ("a -b", "NAME a | OPERATOR - | NAME b"),
        ("a- b", "NAME a | OPERATOR - | NAME b"),
        ("a.b", "NAME a | OPERATOR . | NAME b"),
        ("a/b", "NAME a | OPERATOR / | NAME b"),
        ("a??", "NAME a? | SYMBOL ?"),
        ("a!b", "NAME a! | NAME b"),
        ("x!=3", "NAME x | OPERATOR != | NUMBER 3"),
        ("x?=3", "NAME x | SYMBOL ? | OPERATOR = | NUMBER 3"),
        ("x? =3", "NAME x? | OPERATOR = | NUMBER 3"),
        ("std::vector", "NAME std | OPERATOR :: | NAME vector"),
        ("a<=b", "NAME a | OPERATOR <= | NAME b"),
        ("a==b", "NAME a | OPERATOR == | NAME b"),
        ("a = = b", "NAME a | OPERATOR = | OPERATOR = | NAME b"),
    ],
)
def test_where_a_name_ends(text: str, expected: str) -> None:
    assert_lex(text, f"{expected} | NL")


# ---- numbers --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", ["6", "-1", "0.25", "1e3", "1E-3", "-2.5e+10", "007"])
def test_numbers(number: str) -> None:
    assert_value(number, f"NUMBER {number}")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a -1", "NAME a | OPERATOR - | NUMBER 1"),
        ("3 -1", "NUMBER 3 | OPERATOR - | NUMBER 1"),
        ("3-1", "NUMBER 3 | OPERATOR - | NUMBER 1"),
        ("3 s -1", "QUANTITY 3 s | OPERATOR - | NUMBER 1"),
        ("'a' -1", "STRING 'a' | OPERATOR - | NUMBER 1"),
        ("(a) -1", "OPEN ( | NAME a | CLOSE ) | OPERATOR - | NUMBER 1"),
        ("{a} -1", "BRACED {a} | NUMBER -1"),
        ("a = -1", "NAME a | OPERATOR = | NUMBER -1"),
        ("a < -1 s", "NAME a | OPERATOR < | QUANTITY -1 s"),
        ("a, -1", "NAME a | OPERATOR , | NUMBER -1"),
        ("(-1)", "OPEN ( | NUMBER -1 | CLOSE )"),
        ("(a\n-1)", "OPEN ( | NAME a | NUMBER -1 | CLOSE )"),
        ("-1", "NUMBER -1"),
        ("- 1", "OPERATOR - | NUMBER 1"),
        ("1.", "NUMBER 1 | OPERATOR ."),
        (".5", "OPERATOR . | NUMBER 5"),
        ("1.2.3", "NUMBER 1.2 | OPERATOR . | NUMBER 3"),
        ("+1", "OPERATOR + | NUMBER 1"),
    ],
)
def test_what_a_minus_belongs_to_and_where_a_number_ends(text: str, expected: str) -> None:
    assert_lex(text, f"{expected} | NL")


def test_after_a_keyword_the_parser_reads_the_sign() -> None:
    assert_parse("context a : b > 1 and -2 < x", "context a : (and (b > 1) ((- 2) < x))")
    assert_parse("QualityReq a keeps -5 degC <= t", "requirement a\n  keeps ((- 5degC) <= t)")
    assert_parse("signal a : degC initially -5 degC", "signal a : degC initially -5degC")


# ---- units ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "quantity",
    [
        "30 s",
        "30s",
        "30\ts",
        "3 %",
        "3%",
        "-1.5 m",
        "5 W*h",
        "1 m/s^2",
        "1 m^-1",
        "10 N/cm^2",
        "2 1/s",
        "1e3 Hz",
        "5 µm",
    ],
)
def test_quantities(quantity: str) -> None:
    assert_value(quantity, f"QUANTITY {quantity}")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1 per 1 s", "NUMBER 1 | NAME per | QUANTITY 1 s"),
        (
            "(n = 6 name = 'x')",
            "OPEN ( | NAME n | OPERATOR = | NUMBER 6 | NAME name | OPERATOR = | STRING 'x' | CLOSE )",
        ),
        ("(n = 6 m = 3)", "OPEN ( | NAME n | OPERATOR = | NUMBER 6 | NAME m | OPERATOR = | NUMBER 3 | CLOSE )"),
        ("(n = 6 m=3)", "OPEN ( | NAME n | OPERATOR = | NUMBER 6 | NAME m | OPERATOR = | NUMBER 3 | CLOSE )"),
        ("6 m == x", "QUANTITY 6 m | OPERATOR == | NAME x"),
        ("6 min(x)", "NUMBER 6 | NAME min | OPEN ( | NAME x | CLOSE )"),
        ("6 min (x)", "NUMBER 6 | NAME min | OPEN ( | NAME x | CLOSE )"),
        ("6 min", "QUANTITY 6 min"),
        ("10 m/speed", "QUANTITY 10 m | OPERATOR / | NAME speed"),
        ("10 m/ s", "QUANTITY 10 m | OPERATOR / | NAME s"),
        ("10 m /s", "QUANTITY 10 m | OPERATOR / | NAME s"),
        ("10 m*speed", "QUANTITY 10 m | OPERATOR * | NAME speed"),
        ("6 m-base", "NUMBER 6 | NAME m-base"),
        ("6 m!", "NUMBER 6 | NAME m!"),
        ("6 m!= x", "QUANTITY 6 m | OPERATOR != | NAME x"),
        ("6 m_s", "NUMBER 6 | NAME m_s"),
        ("6 m2", "NUMBER 6 | NAME m2"),
        ("6 %-2", "QUANTITY 6 % | OPERATOR - | NUMBER 2"),
        ("6 1", "NUMBER 6 | NUMBER 1"),
        ("6 1*s", "NUMBER 6 | NUMBER 1 | OPERATOR * | NAME s"),
        ("6 bool", "NUMBER 6 | NAME bool"),
        ("6 text", "NUMBER 6 | NAME text"),
        ("A/h", "NAME A | OPERATOR / | NAME h"),
        ("m/s", "NAME m | OPERATOR / | NAME s"),
        ("(6\nm)", "OPEN ( | NUMBER 6 | NAME m | CLOSE )"),
    ],
)
def test_a_word_after_a_number_is_a_unit_or_the_next_token(text: str, expected: str) -> None:
    assert_lex(text, f"{expected} | NL")


def test_no_word_of_the_grammar_is_a_unit() -> None:
    every = VERB_WORDS | HEADS | HAPPENINGS | FUNCTIONS | EXPERIMENTS | NODE_CLAUSES | DIRECTIONS | set(ITEM_WORDS)
    others = {
        "per",
        "of",
        "at",
        "to",
        "by",
        "and",
        "or",
        "not",
        "if",
        "else",
        "most",
        "least",
        "than",
        "last",
        "except",
    }
    for word in sorted((every | others) - {"min"}):
        assert_lex(f"6 {word}", f"NUMBER 6 | NAME {word} | NL")


@pytest.mark.parametrize(
    ("source", "expected", "wrong", "message"),
    [
        ("30sek", "QUANTITY 30sek", "sek", "unknown unit `sek`; did you mean `s`?"),
        ("30Xyzzy", "QUANTITY 30Xyzzy", "Xyzzy", "unknown unit `Xyzzy`"),
        ("30_a", "QUANTITY 30_a", "_a", "unknown unit `_a`"),
        ("0x1F", "QUANTITY 0x1F", "x1F", "unknown unit `x1F`"),
        ("30m²", "QUANTITY 30m²", "m²", "unknown unit `m²`; did you mean `m^2`?"),
        ("30 °C", "QUANTITY 30 °C", "°C", "unknown unit `°C`; did you mean `degC`?"),
        ("3 degC/s", "QUANTITY 3 degC/s", "degC/s", "unknown unit `degC/s`; did you mean `K/s`?"),
    ],
)
def test_an_unknown_unit_is_one_diagnostic(source: str, expected: str, wrong: str, message: str) -> None:
    assert_value(source, expected, f"1:{source.index(wrong) + 1} unknown-unit «{wrong}» {message}")
    problem = f"2:{source.index(wrong) + 10} unknown-unit «{wrong}» {message}"
    assert_parse(f"BehaviorTree a\n  X (a = {source} b = 1)", f"tree a\n  X (a={source.replace(' ', '')} b=1)", problem)


def test_an_unknown_unit_can_be_replaced() -> None:
    assert_fix("context a : b < 30sek", "Replace `sek` with `s`", "context a : b < 30 s")
    assert_fix("context a : b < 30 °C", "Replace `°C` with `degC`", "context a : b < 30 degC")


# ---- strings --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "string", ['""', "''", '"a"', "'a'", '"it\'s"', "'\"'", r'"\""', r"'\''", r'"\\"', r'"\n\t"', '"#//"']
)
def test_strings(string: str) -> None:
    assert_value(string, f"STRING {string}")


@pytest.mark.parametrize(
    ("source", "text"),
    [
        (r'"a\"b"', 'a"b'),
        (r"'a\'b'", "a'b"),
        (r'"a\\b"', "a\\b"),
        (r'"a\nb\tc"', "a\nb\tc"),
        ('"a\r\nb\rc\nd"', "a\nb\nc\nd"),
        (r'"\\n"', r"\n"),
    ],
)
def test_what_a_string_says(source: str, text: str) -> None:
    (tree,) = assert_parse(f"BehaviorTree {source}").trees
    assert tree.name is not None
    assert tree.name.text == text


def test_an_unknown_escape_stands_for_itself_with_one_hint_a_string() -> None:
    text = r'include "a\d\n\\\e"'
    parsed = assert_parse(text, r'include "a\d\n\\\e"',
                          r"1:11 unknown-escape «\d» unknown escape `\d`; the backslash is kept")  # fmt: skip
    (include,) = (entry.item for entry in parsed.entries)
    assert getattr(include, "path").text == "a\\d\n\\\\e"  # noqa: B009  # whatever item it is
    assert_fix(text, "Write `\\\\`", r'include "a\\d\n\\\\e"', safe=True)


def test_a_backslash_at_the_end_of_a_line_is_no_escape() -> None:
    problem = "1:11 unknown-escape «\\» unknown escape `\\`; the backslash is kept"
    assert_parse('include "a\\\nb"', 'include "a\\\\nb"', problem)


def test_a_string_may_run_over_lines() -> None:
    assert_lex('a "b\n  c\n" d\ne', 'NAME a | STRING "b\\n  c\\n" | NAME d | NL | NAME e | NL')


def test_a_string_with_a_closing_quote_is_closed_whatever_the_columns_between() -> None:
    text = """
        BehaviorTree a
            ->
                X (a = "b
        c
            d")
                Y
    """
    assert_parse(text, 'tree a\n  ->\n    X (a="b\\nc\\n    d")\n    Y')


def test_a_string_without_a_closing_quote_ends_at_the_end_of_its_line() -> None:
    text = """
        BehaviorTree a
            X "b c
            Y
    """
    problem = '2:7 unclosed-string «"b c» missing closing " for this string'
    assert_parse(text, 'tree a\n  X as "b c\n  Y', problem)
    assert_fix(text, 'Close it with "', 'BehaviorTree a\n    X "b c"\n    Y\n')


def test_a_bracket_that_an_unclosed_string_swallowed_is_closed() -> None:
    text = """
        BehaviorTree a
            X (a = "b)
            Y
    """
    assert_parse(text, 'tree a\n  X (a="b))\n  Y', '2:12 unclosed-string «"b)» missing closing " for this string')
    assert_fix(text, 'Close it with "', 'BehaviorTree a\n    X (a = "b")\n    Y\n')


def test_each_kind_of_quote_is_looked_for_alone() -> None:
    assert_lex("a 'b\nc \"d\ne\n\"", "NAME a | STRING 'b | NL | NAME c | STRING \"d\\ne\\n\" | NL",
               "1:3 unclosed-string «'b» missing closing ' for this string")  # fmt: skip


def test_an_escaped_quote_does_not_close() -> None:
    assert_lex(r'a "b\"', r'NAME a | STRING "b\" | NL', r'1:3 unclosed-string «"b\"» missing closing " for this string')


def test_a_string_over_items_shows_both_places() -> None:
    text = 'include "a\nBehaviorTree b\n    X (c = "d")\n'
    parsed = parse(text)
    (problem,) = parsed.diagnostics
    assert (problem.rule, problem.span) == ("unclosed-string", (8, 9))
    assert [text[place.place.span.start : place.place.span.end] for place in problem.related] == ["BehaviorTree b"]


def test_a_string_over_indented_items_is_no_hint() -> None:
    assert_parse('include "a\n  BehaviorTree b\nc"', 'include "a\\n  BehaviorTree b\\nc"')


# ---- blackboard entries ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("braced", ["{goal}", "{=}", "{@goal}", "{}", "{a b-c.d}", "{größe}"])
def test_blackboard_entries(braced: str) -> None:
    assert_value(braced, f"BRACED {braced}")


@pytest.mark.parametrize("source", ["{a\n      b}", "{a'b'}", '{"a"}', "{a"])
def test_what_is_no_blackboard_entry(source: str) -> None:
    (problem, *_) = parse(f"BehaviorTree t\n  X (a = {source})").diagnostics
    assert (problem.span, problem.message) == ((24, 25), "missing `}` for this `{`")
    assert problem.notes == ("a blackboard entry is written `{key}`, on one line and without quotes in it",)


def test_a_brace_can_be_added() -> None:
    assert_fix("BehaviorTree t\n  X (a = {b)", "Add `}`", "BehaviorTree t\n  X (a = {b})")
    assert_fix("BehaviorTree t\n  X (a = b})", "Add `{`", "BehaviorTree t\n  X (a = {b})")


# ---- comments -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("# a", "COMMENT # a"),
        ("  // a", "COMMENT // a"),
        ("/* a */", "COMMENT /* a */"),
        ("/**/", "COMMENT /**/"),
        ("a # b", "NAME a | COMMENT # b | NL"),
        ("a\t// b", "NAME a | COMMENT // b | NL"),
        ("a (# b\n)# c", "NAME a | OPEN ( | COMMENT # b | CLOSE ) | COMMENT # c | NL"),
        ("a (b,// c\nd)", "NAME a | OPEN ( | NAME b | OPERATOR , | COMMENT // c | NAME d | CLOSE ) | NL"),
        ("a /* b\n c */ d", "NAME a | COMMENT /* b\\n c */ | NAME d | NL"),
        ("/* a *//* b */c", "COMMENT /* a */ | COMMENT /* b */ | NAME c | NL"),
        ("/* a */# b", "COMMENT /* a */ | COMMENT # b"),
        ("a # b /* c\nd", "NAME a | COMMENT # b /* c | NL | NAME d | NL"),
        ("a # b\r\nc", "NAME a | COMMENT # b | NL | NAME c | NL"),
        ("a / b", "NAME a | OPERATOR / | NAME b | NL"),
        ("a #", "NAME a | COMMENT # | NL"),
    ],
)
def test_comments(text: str, expected: str) -> None:
    assert_lex(text, expected)


@pytest.mark.parametrize(
    ("text", "word", "sign"),
    [
        ("Weed#2", "Weed#2", "#"),
        ("a//b", "a//b", "//"),
        ("a/*b*/", "a/*b*/", "/*"),
        ("a.b#c", "a.b#c", "#"),
        ("10#x", "10#x", "#"),
        ("10 m#x", "10 m#x", "#"),
        ("http://host:80/a", "http://host:80/a", "//"),
    ],
)
def test_a_comment_sign_inside_a_word_is_an_error_that_says_quote_this(text: str, word: str, sign: str) -> None:
    column = len(text) - len(word) + 1
    message = f"`{sign}` begins a comment only after a space; put this in quotes"
    assert_lex(text, f"NAME {word} | NL", f"1:{column} misplaced-comment «{word}» {message}")


@pytest.mark.parametrize(("source", "sign"), [("#ff0000", "#"), ("//a", "//"), ("/*a*/", "/*")])
def test_a_comment_sign_behind_an_equals_sign_is_an_error_too(source: str, sign: str) -> None:
    message = f"`{sign}` begins a comment only after a space; put this in quotes"
    assert_value(source, f"NAME {source}", f"1:1 misplaced-comment «{source}» {message}")
    text = f"BehaviorTree a\n  X (color = {source} b = 1)"
    problem = f"2:14 misplaced-comment «{source}» {message}"
    assert_parse(text, f"tree a\n  X (color={source} b=1)", problem)
    assert_fix(text, "Put quotes around it", f'BehaviorTree a\n  X (color = "{source}" b = 1)', safe=True)


def test_a_word_with_a_comment_sign_can_be_quoted_or_parted() -> None:
    text = "BehaviorTree a\n  X Weed#2\n  Y"
    problem = "2:5 misplaced-comment «Weed#2» `#` begins a comment only after a space; put this in quotes"
    assert_parse(text, "tree a\n  X as Weed#2\n  Y", problem)
    assert_fix(text, "Put quotes around it", 'BehaviorTree a\n  X "Weed#2"\n  Y')
    assert_fix(text, "Put a space before `#`", "BehaviorTree a\n  X Weed #2\n  Y")


@pytest.mark.parametrize("word", ["->", "'a'", "{a}"])
def test_behind_what_is_no_word_a_blank_is_missing(word: str) -> None:
    kind = {"->": "SYMBOL", "'a'": "STRING", "{a}": "BRACED"}[word]
    at = len(word) + 1
    assert_lex(f"{word}#b c", f"{kind} {word} | COMMENT #b c | NL",
               f"1:{at} misplaced-comment «#» `#` begins a comment only after a space")  # fmt: skip
    assert_fix(
        "BehaviorTree a\n  ->// b\n    X", "Put a space before `//`", "BehaviorTree a\n  -> // b\n    X", safe=True
    )


def test_an_unclosed_comment_ends_at_the_end_of_its_line() -> None:
    text = """
        BehaviorTree a
            X /* b
            Y
    """
    assert_parse(text, "tree a\n  X\n  Y", "2:7 unclosed-comment «/*» missing closing `*/` for this comment")
    assert_fix(text, "Close it at the end of the line", "BehaviorTree a\n    X /* b */\n    Y\n")


def test_a_bracket_that_an_unclosed_comment_swallowed_is_closed() -> None:
    text = """
        BehaviorTree a
            X (a = 1 /* (b))
            Y
    """
    assert_parse(text, "tree a\n  X (a=1)\n  Y", "2:14 unclosed-comment «/*» missing closing `*/` for this comment")


def test_comments_are_tokens_wherever_they_stand() -> None:
    text = "# a\nx /* b */ ( # c\n /* d */ ) // e\n# f"
    found = [token.text for token in tokens(text) if token.text.startswith(("#", "/"))]
    assert found == ["# a", "/* b */", "# c", "/* d */", "// e", "# f"]


# ---- what begins nothing --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("character", "note"),
    [
        ("&", "write `and`"),
        ("|", "write `or`; `||` is the symbol of Parallel"),
        ("[", "attributes go in round brackets: `(key = value)`"),
        ("\xa0", "this is a no-break space: use an ordinary space"),
    ],
)
def test_a_character_that_begins_nothing_is_left_out_with_one_diagnostic_a_line(character: str, note: str) -> None:
    shown = repr(character) if character == "\xa0" else f"`{character}`"
    text = f"context a : b {character} {character} < 3\ncontext d : e"
    parsed = assert_parse(text, "context a : (b < 3)\ncontext d : e",
                          f"1:15 syntax-error «{character}» unexpected {shown}")  # fmt: skip
    assert parsed.diagnostics[0].notes == (note,)


@pytest.mark.parametrize("source", ["1;2;3", ";", "$1", "a@b", "~/maps", "C:\\maps", "50€", "a;b"])
def test_such_a_character_in_a_value_needs_quotes(source: str) -> None:
    text = f"BehaviorTree a\n  X (a = {source} b = 1)"
    parsed = parse(text)
    assert_invariants(parsed)
    assert show_problems(text, parsed.diagnostics) == f"2:10 syntax-error «{source}» this value needs quotes"
    quoted = '"' + source.replace("\\", "\\\\") + '"'
    assert_fix(text, "Put quotes around it", f"BehaviorTree a\n  X (a = {quoted} b = 1)", safe=True)


def test_there_are_no_reserved_words_for_the_lexer() -> None:
    assert_lex("satisfies and BehaviorTree Root true 'xml'",
               "NAME satisfies | NAME and | NAME BehaviorTree | NAME Root | NAME true | STRING 'xml' | NL")  # fmt: skip


@pytest.mark.parametrize(
    ("text", "fixed"),
    [
        ("context a : b ≤ 3", "context a : b <= 3"),
        ("context a : b ≥ 3", "context a : b >= 3"),
        ("context a : b ≠ 3", "context a : b != 3"),
        ("context a : b − 3", "context a : b - 3"),
        ("context a : b – 3", "context a : b - 3"),
        ("context a : b × 3", "context a : b * 3"),
        ("context a : b · 3", "context a : b * 3"),
        ("context a : b ÷ 3", "context a : b / 3"),
        ("context a ： b", "context a : b"),
        ("context a : b ≤ 3 and c ≥ 4  # ≠", "context a : b <= 3 and c >= 4  # ≠"),
        ("context a : b ≤ '≠' and c ≥ 4", "context a : b <= '≠' and c ≥ 4"),
        *((f"include {sign}b.btq{sign}", 'include "b.btq"') for sign in "“”„‟«»"),
        *((f"include {sign}b.btq{sign}", "include 'b.btq'") for sign in "‘’"),
        ("include “b≤.btq”", 'include "b≤.btq"'),
        ("include “b.btq”  # “the” stations", 'include "b.btq"  # “the” stations'),
        ("include “b #2.btq”  // “the” stations", 'include "b #2.btq"  // “the” stations'),
        ("context a : b ≤ 3 /* ≥ */", "context a : b <= 3 /* ≥ */"),
    ],
)
def test_characters_that_look_like_others(text: str, fixed: str) -> None:
    assert_fix(text, "Write plain characters", fixed)
