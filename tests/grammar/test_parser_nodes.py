"""Nodes, their attributes and what is attached to them, language.md §3: each production as it should be, and broken."""

from __future__ import annotations

import pytest
from syntax_asserts import assert_fix, assert_parse

from btq_lang.parser import parse
from btq_lang.syntax.tree import shape

END = "found the end of the line"


def assert_node(line: str, tree: str, *problems: str) -> None:
    """One node in a tree, followed by another; the columns of problems count from the node."""
    moved = [f"2:{int(problem[2:].split(' ', 1)[0]) + 2} {problem.split(' ', 1)[1]}" for problem in problems]
    block = "".join(f"  {shown}\n" for shown in [*tree.splitlines(), "Z"])
    assert_parse(f"BehaviorTree t\n  {line}\n  Z\n", f"tree t\n{block}", *moved)


# ---- Node: Kind [ Label ] [ Attributes ] { NodeClause } -------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "tree"),
    [
        ("->", "->"),
        ("R?", "R?"),
        ("→ a", "→ as a"),
        ("MoveBase", "MoveBase"),
        ("'Move Base'", "'Move Base'"),
        ("-> BatteryCheck", "-> as BatteryCheck"),
        ("->BatteryCheck", "-> as BatteryCheck"),
        ("-> 'Battery check'", "-> as 'Battery check'"),
        ("MoveBase ToShelf", "MoveBase as ToShelf"),
        ("MoveBase(a=1)", "MoveBase (a=1)"),
        ("? ()", "?"),
        (
            "MoveBase ToShelf (a = 1) satisfices b satisfies c tags d",
            "MoveBase as ToShelf (a=1)\n  satisfices b\n  satisfies c\n  tags d",
        ),
        ("Action MoveBase", "Action MoveBase"),
        ("Action MoveBase ToShelf", "Action MoveBase as ToShelf"),
        ("Condition 'Battery low?' x", "Condition 'Battery low?' as x"),
        ("Control X", "Control X"),
        ("Decorator X (a = b)", "Decorator X (a=b)"),
        ("SubTree PickPlace", "SubTree PickPlace"),
        ("SubTree (ID = PickPlace)", "SubTree (ID=PickPlace)"),
        ("SubTree satisfies a", "SubTree\n  satisfies a"),
        ("Action", "Action"),
    ],
)
def test_node(line: str, tree: str) -> None:
    assert_node(line, tree)


def test_children_and_clauses_in_the_block_of_a_node() -> None:
    text = """
        BehaviorTree t
            -> a
                satisfices b
                satisfies c, d tags e
                X
                    tags f
                Y
                    Z
    """
    tree = """
        tree t
          -> as a
            satisfices b
            satisfies c, d
            tags e
            X
              tags f
            Y
              Z
    """
    assert_parse(text, tree)


def test_clauses_in_brackets_on_the_line_and_in_the_block_keep_their_order() -> None:
    text = "BehaviorTree t\n  X (satisfies a) satisfies b\n    satisfies c\n"
    assert_parse(text, "tree t\n  X\n    satisfies a\n    satisfies b\n    satisfies c")


def test_the_name_and_the_id_of_a_node_wherever_they_stand() -> None:
    (tree,) = parse(
        "BehaviorTree t\n  X a\n  X (name = a)\n  SubTree (ID = b name = 'c d')\n  Action\n  X a (name = b)"
    ).trees
    nodes = tree.walk()
    said = [(node.id and node.id.text, node.name and node.name.text, node.head.text) for node in nodes]
    assert said == [("X", "a", "X"), ("X", "a", "X"), ("b", "c d", "b"), (None, None, "Action"), ("X", "a", "X")]


@pytest.mark.parametrize("word", ["satisfices", "satisfies", "tags"])
def test_these_words_are_never_a_label_without_quotes(word: str) -> None:
    assert_node(f"X {word} a", f"X\n  {word} a")
    assert_node(f"X '{word}'", f"X as '{word}'")
    assert_node(f"X (a = 1) {word} b", f"X (a=1)\n  {word} b")
    assert_node(f"Action {word} a", f"Action\n  {word} a")
    assert_node(f"Action '{word}' a", f"Action '{word}' as a")


@pytest.mark.parametrize("word", ["satisfices", "satisfies", "tags", "xml", "input", "Action", "->", "BehaviorTree"])
def test_a_quoted_word_is_never_a_keyword_or_symbol(word: str) -> None:
    assert_node(f"'{word}'", f"'{word}'")
    assert_node(f"'{word}' a", f"'{word}' as a")
    assert_node(f"'{word}' ('{word}' = '{word}')", f"'{word}' ('{word}'='{word}')")


@pytest.mark.parametrize(
    "word", ["and", "true", "BehaviorTree", "Root", "QualityReq", "signal", "parameters", "keeps", "on"]
)
def test_there_are_no_reserved_words(word: str) -> None:
    assert_node(word, word)
    assert_node(f"{word} {word}", f"{word} as {word}")
    assert_node(f"{word} ({word} = {word})", f"{word} ({word}={word})")


@pytest.mark.parametrize("word", ["input", "output", "inout"])
def test_behind_the_first_node_a_port_word_is_a_node(word: str) -> None:
    assert_parse(f"BehaviorTree t\n  X\n    {word} a\n  {word} b", f"tree t\n  X\n    {word} as a\n  {word} as b")


@pytest.mark.parametrize(
    ("line", "tree", "problem"),
    [
        ("-> a b", "-> as a", "1:6 syntax-error «b» expected the end of the line, found `b`"),
        ("X 3", "X", "1:3 syntax-error «3» expected the end of the line, found `3`"),
        ("X ->", "X", "1:3 syntax-error «->» expected the end of the line, found `->`"),
        ("-> ->", "->", "1:4 syntax-error «->» expected the end of the line, found `->`"),
        ("X {a}", "X", "1:3 syntax-error «{a}» expected the end of the line, found `{a}`"),
        ("X (a = 1) b", "X (a=1)", "1:11 syntax-error «b» a node's label goes before its brackets"),
        ("X a = 1", "X as a", "1:3 syntax-error «a = 1» attributes go in brackets: `(key = value)`"),
        ("X = 1", "", "1:1 syntax-error «X = 1» attributes go in brackets: `(key = value)`"),
        ("X (a) = 1)", "X", "1:10 syntax-error «)» unexpected `)`: no bracket is open"),
        (
            "X (a = 1) (b = 2)",
            "X (a=1)",
            "1:11 syntax-error «(» all attributes of a node go in one pair of brackets",
        ),
        (
            "X satisfies a (b = 1) c",
            "X\n  satisfies a(b=1)",
            "1:23 syntax-error «c» expected `,` or the end of the line, found `c`",
        ),
        (
            "X satisfices a b",
            "X\n  satisfices a",
            "1:16 syntax-error «b» expected `,` or the end of the line, found `b`",
        ),
        (
            "takes at most 3 s",
            "takes as at",
            "1:1 syntax-error «takes» unexpected clause `takes` in a tree; clauses go in a requirement",
        ),
        (
            "on violation fail",
            "on as violation",
            "1:1 syntax-error «on» unexpected clause `on` in a tree; clauses go in a requirement",
        ),
        ("X: a", "", "1:1 syntax-error «X: a» attributes go in brackets: `(key = value)`"),
        ("X, Y", "X", "1:2 syntax-error «,» expected the end of the line, found `,`"),
        ("Action Action", "Action Action", None),
        ("X.Y", "X", "1:2 syntax-error «.» expected the end of the line, found `.`"),
    ],
)
def test_what_is_left_of_a_line(line: str, tree: str, problem: str | None) -> None:
    assert_node(line, tree, *([problem] if problem else []))


def test_attributes_can_be_put_in_brackets() -> None:
    fixed = "BehaviorTree t\n  X (a = 1 b = {c}) # d"
    assert_fix("BehaviorTree t\n  X a = 1 b = {c} # d", "Put brackets around them", fixed, safe=True)


NO_NODE = "expected a node: its kind, or a symbol: -> ? || …"


@pytest.mark.parametrize("line", ["3 s", "{a}", "(a = 1)", "= a", ": a"])
def test_a_line_that_is_no_node_is_passed_over_with_its_block(line: str) -> None:
    first = {"3": "3 s", "(": "(", "{": "{a}"}.get(line[0], line[0])
    text = f"BehaviorTree t\n  {line}\n    X (\n      Y\n    ) (\n  Z\n"
    assert_parse(text, "tree t\n  Z", f"2:3 syntax-error «{first}» {NO_NODE}, found `{first}`")


# ---- clauses before children, xml, requirements ---------------------------------------------------------------------


@pytest.mark.parametrize("clause", ["satisfices a", "satisfies a, b", "tags a"])
def test_clauses_behind_children_belong_to_the_node_around_them(clause: str) -> None:
    text = f"""
        BehaviorTree t
            ->
                X
                    Y
                {clause}
                Z
    """
    tree = f"""
        tree t
          ->
            {clause}
            X
              Y
            Z
    """
    word = clause.split(" ", maxsplit=1)[0]
    parsed = assert_parse(text, tree, f"5:9 clause-after-children «{word}» clauses go before children")
    assert parsed.diagnostics[0].notes == (f'a node of this name goes in quotes: "{word}"',)
    fixed = f"""
        BehaviorTree t
            ->
                {clause}
                X
                    Y
                Z
    """
    assert_fix(text, "Move it before the children", fixed)


def test_a_clause_behind_the_node_of_a_tree() -> None:
    text = "BehaviorTree t\n  X\n  tags a"
    assert_parse(text, "tree t\n  tags a\n  X", "3:3 clause-after-children «tags» clauses go before children")
    assert_fix(text, "Move it before the children", "BehaviorTree t\n  tags a\n  X\n")
    assert_fix(text, "Move it to `X`", "BehaviorTree t\n  X\n      tags a")


def test_a_clause_line_moves_with_its_requirement() -> None:
    text = "BehaviorTree t\n  X\n    Y\n    satisfies QualityReq a\n      keeps b\n      # c\n      keeps d\n    Z\n"
    tree = "tree t\n  X\n    satisfies {a; keeps b; keeps d}\n    Y\n    Z"
    assert_parse(text, tree, "4:5 clause-after-children «satisfies» clauses go before children")
    fixed = "BehaviorTree t\n  X\n    satisfies QualityReq a\n      keeps b\n      # c\n      keeps d\n    Y\n    Z\n"
    assert_fix(text, "Move it before the children", fixed)


def test_xml_is_no_node() -> None:
    assert_parse("BehaviorTree t\n  X\n    xml '<a/>'\n    Y\n", "tree t\n  X\n    xml '<a/>'\n    Y")
    parsed = assert_parse("BehaviorTree t\n  X\n    xml\n    Y\n", "tree t\n  X\n    xml MISSING\n    Y",
                          f"3:8 syntax-error «» expected one XML element in quotes, {END}")  # fmt: skip
    assert parsed.diagnostics[0].notes == ('a node of this name goes in quotes: "xml"',)


def test_a_requirement_without_satisfies() -> None:
    text = """
        BehaviorTree t
            X
                QualityReq a : b "c"
                    keeps d
                Y
    """
    tree = """
        tree t
          X
            satisfies {a : b "c"; keeps d}
            Y
    """
    problem = "3:9 syntax-error «QualityReq» a requirement at a node begins with `satisfies`"
    assert_parse(text, tree, problem)
    assert_fix("BehaviorTree t\n  X\n    QualityReq a keeps b\n", "Write `satisfies QualityReq`",
               "BehaviorTree t\n  X\n    satisfies QualityReq a keeps b\n")  # fmt: skip


@pytest.mark.parametrize("line", ["tags a", "satisfies a", "satisfices a"])
def test_a_clause_line_without_a_definition_has_no_block(line: str) -> None:
    text = f"BehaviorTree t\n  X\n    {line}\n      Action Y\n      Z\n    V\n"
    tree = f"tree t\n  X\n    {line}\n    V"
    problem = "4:7 syntax-error «Action Y» unexpected indentation: the line above opens no block"
    assert_parse(text, tree, problem)


# ---- Attributes -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("attributes", "shown"),
    [
        ("()", ""),
        ("( )", ""),
        ("(a = 1)", " (a=1)"),
        ("(a=1 b=2)", " (a=1 b=2)"),
        ("(a = 1, b = 2,)", " (a=1 b=2)"),
        ("(a = 1\n  b = 2)", " (a=1 b=2)"),
        ("(\n   a\n  =\n      1 # c\n)", " (a=1)"),
        ("('a b' = 'c d')", " ('a b'='c d')"),
        ("(a = 'x'b = {y}c = z)", " (a='x' b={y} c=z)"),
        ("(ID = a name = b)", " (ID=a name=b)"),
        ("(_skipIf = 'a' _onSuccess = 'b := 1')", " (_skipIf='a' _onSuccess='b := 1')"),
        ("(a = 1 a = 2)", " (a=1 a=2)"),
        (
            "(satisfies = 1 parameters = 2 Quality = 3 QualityReq = 4)",
            " (satisfies=1 parameters=2 Quality=3 QualityReq=4)",
        ),
        ("(parameters a = 1, b = 2)", " (a=1 b=2)"),
        ("(c = 0 parameters a = 1, b = 2 d = 3)", " (c=0 a=1 b=2 d=3)"),
        ("(parameters a = 1 parameters b = 2)", " (a=1 b=2)"),
    ],
)
def test_attributes(attributes: str, shown: str) -> None:
    assert_parse(f"BehaviorTree t\n  X {attributes}\n  Z", f"tree t\n  X{shown}\n  Z")


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        ('"a b"', '"a b"'),
        ("a", "a"),
        ("true", "true"),
        ("6", "6"),
        ("-1.5", "-1.5"),
        ("30 s", "30s"),
        ("{a}", "{a}"),
        ("{=}", "{=}"),
        ("a-b", "a-b"),
        ("Ready?", "Ready?"),
        ("satisfies", "satisfies"),
    ],
)
def test_value(value: str, shown: str) -> None:
    assert_node(f"X (a = {value} b = 1)", f"X (a={shown} b=1)")
    assert_node(f"X (a={value},b=1)", f"X (a={shown} b=1)")
    assert_node(f"X (a={value})", f"X (a={shown})")


EXPECTED_ATTRIBUTE = "expected an attribute: key = value"
SATISFYS = "unknown word `satisfys`; did you mean `satisfies`?"
EXPECTED_VALUE = "expected a value: a string, a name, a number, a quantity or {key}"


@pytest.mark.parametrize(
    ("line", "tree", "problem"),
    [
        ("X (a)", "X", f"1:4 syntax-error «a» {EXPECTED_ATTRIBUTE}, found `a`"),
        ("X (a b = 1)", "X (b=1)", f"1:4 syntax-error «a» {EXPECTED_ATTRIBUTE}, found `a`"),
        ("X (3 b = 1)", "X (b=1)", f"1:4 syntax-error «3» {EXPECTED_ATTRIBUTE}, found `3`"),
        ("X (= 1 b = 1)", "X (b=1)", f"1:4 syntax-error «=» {EXPECTED_ATTRIBUTE}, found `=`"),
        ("X (, b = 1)", "X (b=1)", f"1:4 syntax-error «,» {EXPECTED_ATTRIBUTE}, found `,`"),
        ("X (a = 1,, b = 1)", "X (a=1 b=1)", f"1:10 syntax-error «,» {EXPECTED_ATTRIBUTE}, found `,`"),
        ("X ((a = 1) b = 1)", "X (b=1)", f"1:4 syntax-error «(» {EXPECTED_ATTRIBUTE}, found `(`"),
        ("X (a : 1 b = 1)", "X (a=1 b=1)", "1:6 syntax-error «:» expected `=` between key and value, found `:`"),
        (
            "X (a = charging station b = 1)",
            "X (a=charging b=1)",
            f"1:17 syntax-error «station» {EXPECTED_ATTRIBUTE}, found `station`",
        ),
        ("X (a =)", "X (a=MISSING)", f"1:7 syntax-error «)» {EXPECTED_VALUE}, found `)`"),
        ("X (a =, b = 1)", "X (a=MISSING b=1)", f"1:7 syntax-error «,» {EXPECTED_VALUE}, found `,`"),
        ("X (a = = 1 b = 1)", "X (a=MISSING b=1)", f"1:8 syntax-error «=» {EXPECTED_VALUE}, found `=`"),
        ("X (a = (1) b = 1)", "X (a=MISSING b=1)", f"1:8 syntax-error «(» {EXPECTED_VALUE}, found `(`"),
        ("X (a == 1 b = 1)", "X (a=1 b=1)", "1:6 syntax-error «==» expected `=` between key and value, found `==`"),
        ("X (a: 1)", "X (a=1)", "1:5 syntax-error «:» expected `=` between key and value, found `:`"),
        ("X (a = 1 satisfys r)", "X (a=1)\n  satisfies r", f"1:10 syntax-error «satisfys» {SATISFYS}"),
        ("X satisfys r, s", "X\n  satisfies r, s", f"1:3 syntax-error «satisfys» {SATISFYS}"),
        ("X (a = {@b)", "X (a={@b)", "1:8 syntax-error «{» missing `}` for this `{`"),
        ("X (a = {b c = {d)", "X (a={b c={d)", "1:8 syntax-error «{» missing `}` for this `{`"),
        ("X 3", "X", "1:3 syntax-error «3» expected the end of the line, found `3`"),
        ("X {b}", "X", "1:3 syntax-error «{b}» expected the end of the line, found `{b}`"),
        ("X (a = b = 1)", "X (a=b)", f"1:10 syntax-error «=» {EXPECTED_ATTRIBUTE}, found `=`"),
        ("X (parameters)", "X", "1:14 syntax-error «)» expected `key = value` after `parameters`, found `)`"),
        (
            "X (parameters a b = 1)",
            "X (b=1)",
            "1:15 syntax-error «a» expected `key = value` after `parameters`, found `a`",
        ),
        (
            "X (parameters satisfies a, b = 1)",
            "X (b=1)",
            "1:15 syntax-error «satisfies» expected `key = value` after `parameters`, found `satisfies`",
        ),
    ],
)
def test_broken_attributes(line: str, tree: str, problem: str) -> None:
    assert_node(line, tree, problem)


@pytest.mark.parametrize(
    "value",
    ["map/frame", "/map", "a.b", "1.2.3", "-x", "->", "a->b", "1.5.", ".5", "*", "a:b", "a<b", "a^2", "x[0]", "[b]"],
)
def test_a_value_that_is_no_word_needs_quotes(value: str) -> None:
    text = f"X (a = {value} b = 1)"
    assert_node(text, f"X (a={value} b=1)", f"1:8 syntax-error «{value}» this value needs quotes")
    fixed = f'BehaviorTree t\n  X (a = "{value}" b = 1)'
    assert_fix(f"BehaviorTree t\n  {text}", "Put quotes around it", fixed, safe=True)


@pytest.mark.parametrize(
    ("value", "title", "meant", "safe"),
    [("+1", "Write `1`", "1", True), ("@level", "Write the entry `{@level}`", "{@level}", False)],
)
def test_a_value_that_means_something_else_than_text(value: str, title: str, meant: str, safe: bool) -> None:
    before, after = (f"BehaviorTree t\n  X (a = {each} b = 1)" for each in (value, meant))
    assert_fix(before, title, after, safe=safe)


def test_what_is_only_the_start_of_a_value_has_no_fix() -> None:
    (problem,) = parse("BehaviorTree t\n  Script (code = @count := (@count + 1))\n").diagnostics
    assert (problem.message, problem.fixes) == ("this value needs quotes", ())


def test_brackets_that_a_square_one_closes() -> None:
    assert_node("X (a = 4]", "X (a=4)", "1:9 syntax-error «]» expected `)`, found `]`")
    assert_fix("BehaviorTree t\n  X (a = 4] tags b", "Write `)`", "BehaviorTree t\n  X (a = 4) tags b", safe=True)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('X (a = "x"\n  Y (b = 1)', 'X (a = "x")\n  Y (b = 1)'),
        ("X (a = 1,\n     b = 2\n  Y", "X (a = 1,\n     b = 2)\n  Y"),
        ("X (\n    a =\n      1\n    satisfies b\n  Y", "X (\n    a =\n      1\n    satisfies b)\n  Y"),
    ],
)
def test_a_bracket_is_closed_where_the_attributes_end(before: str, after: str) -> None:
    assert_fix(f"BehaviorTree t\n  {before}\n", "Add `)`", f"BehaviorTree t\n  {after}\n")


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('X (a = "home) satisfies r', 'X (a = "home") satisfies r'),
        ('X (_skipIf = "(@a > 3.0))', 'X (_skipIf = "(@a > 3.0)")'),
    ],
)
def test_a_string_is_closed_before_the_bracket_behind_it(before: str, after: str) -> None:
    assert_fix(f"BehaviorTree t\n  {before}\n", 'Close it with "', f"BehaviorTree t\n  {after}\n")


def test_an_unknown_compound_unit_in_a_value() -> None:
    problem = "1:10 unknown-unit «m/sek» unknown unit `m/sek`; did you mean `m/s`?"
    assert_node("X (a = 3 m/sek b = 1)", "X (a=3 m/sek b=1)", problem)
    assert_node("X (a = 3 sek b = 1)", "X (a=3 b=1)", "1:10 unknown-unit «sek» unknown unit `sek`; did you mean `s`?")
    assert_fix("BehaviorTree t\n  X (a = 3 sek)", "Replace `sek` with `s`", "BehaviorTree t\n  X (a = 3 s)")


def test_each_line_of_brackets_has_its_own_diagnostic() -> None:
    text = """
        BehaviorTree t
            X (
                a = ,
                b = 30sek
                c d
                e = 1
            )
            Y
    """
    assert_parse(
        text,
        "tree t\n  X (a=MISSING b=30sek e=1)\n  Y",
        f"3:13 syntax-error «,» {EXPECTED_VALUE}, found `,`",
        "4:15 unknown-unit «sek» unknown unit `sek`; did you mean `s`?",
        f"5:9 syntax-error «c» {EXPECTED_ATTRIBUTE}, found `c`",
    )


def test_forgotten_brackets_are_one_diagnostic_whatever_they_swallow() -> None:
    text = """
        BehaviorTree t
            ->
                X (a = 1
                Y (b = 2)
                Z c
            V
    """
    assert_parse(text, "tree t\n  ->\n    X (a=1)\n  V", "3:11 unclosed-bracket «(» missing `)` for this `(`")


# ---- NodeClause -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("clause", "shown"),
    [
        ("satisfices a", "satisfices a"),
        ("satisfices a, b.c, 'd e'", "satisfices a, b.c, 'd e'"),
        ("satisfices performance <time-behavior>", "satisfices performance.time-behavior"),
        ("satisfices a <b>.c", "satisfices a.b.c"),
        ("satisfices Quality = a", "satisfices a"),
        ("satisfices Quality = a, Quality = b", "satisfices a, b"),
        ("satisfices Quality = a Quality = b", "satisfices a, b"),
        ("satisfices a, Quality = b, c", "satisfices a, b, c"),
        ("satisfices Quality", "satisfices Quality"),
        ("satisfices Quality, a", "satisfices Quality, a"),
        ("satisfices Quality = a ( )", "satisfices a"),
        ("satisfices Quality = a (QualityReq b 'c')", "satisfices a [{b 'c'}]"),
        ("satisfices Quality = a (QualityReq b, QualityReq c QualityReq d)", "satisfices a [{b}] [{c}] [{d}]"),
        (
            "satisfices Quality = a (QualityReq b keeps c takes at most 3 s, QualityReq d)",
            "satisfices a [{b; keeps c; takes <= 3s}] [{d}]",
        ),
        ("satisfies a", "satisfies a"),
        ("satisfies a, 'b c', d", "satisfies a, 'b c', d"),
        ("satisfies a(b = 3 s), c", "satisfies a(b=3s), c"),
        ("satisfies a (b = 3 s if x else d, e = -1)", "satisfies a(b=[3s if x, d else], e=-1)"),
        ("satisfies QualityReq a", "satisfies {a}"),
        ("satisfies QualityReq a, b", "satisfies {a}, b"),
        ("satisfies QualityReq a QualityReq b", "satisfies {a}, {b}"),
        ("satisfies QualityReq a keeps b, c", "satisfies {a; keeps b}, c"),
        ("satisfies QualityReq a : b, c", "satisfies {a : b}, c"),
        ("satisfies QualityReq a : b 'd', c", "satisfies {a : b 'd'}, c"),
        ("satisfies QualityReq a : b 'd', QualityReq c : b", "satisfies {a : b 'd'}, {c : b}"),
        (
            "satisfies QualityReq a : b.c 'd' keeps e in at least 9 % of runs",
            "satisfies {a : b.c 'd'; keeps e; odds >= 9% of runs}",
        ),
        ("satisfies tags", "satisfies tags"),
        ("tags a", "tags a"),
        ("tags a, 'b c', d-e", "tags a, 'b c', d-e"),
    ],
)
def test_node_clause(clause: str, shown: str) -> None:
    """On the node's line, on a line of its own, and in brackets before, between and after attributes."""
    assert_node(f"X {clause}", f"X\n  {shown}")
    assert_node(f"X {clause} tags z", f"X\n  {shown}\n  tags z")
    assert_node(f"X ({clause})", f"X\n  {shown}")
    assert_node(f"X ({clause}, b = 1)", f"X (b=1)\n  {shown}")
    assert_node(f"X (a = 1 {clause} b = 2)", f"X (a=1 b=2)\n  {shown}")
    assert_node(f"X (a = 1, {clause}, parameters b = 2)", f"X (a=1 b=2)\n  {shown}")
    assert_node(f"X ({clause}, satisfies z)", f"X\n  {shown}\n  satisfies z")
    assert_node(f"X ({clause} tags z)", f"X\n  {shown}\n  tags z")
    assert_parse(f"BehaviorTree t\n  {clause} tags y\n  X\n    {clause}\n    Z",
                 f"tree t\n  {shown}\n  tags y\n  X\n    {shown}\n    Z")  # fmt: skip


@pytest.mark.parametrize(
    ("clause", "shown", "column", "message"),
    [
        ("satisfices", "satisfices MISSING", 11, "expected a quality"),
        ("satisfices a,", "satisfices a", 14, "expected a quality"),
        ("satisfices a.", "satisfices a", 14, "expected a sub-characteristic"),
        ("satisfices a <", "satisfices a", 15, "expected a sub-characteristic"),
        ("satisfices a <b", "satisfices a.b", 16, "expected `>`"),
        ("satisfices Quality =", "satisfices MISSING", 21, "expected a quality"),
        ("satisfies", "satisfies MISSING", 10, "expected a requirement: its ID, or QualityReq and a definition"),
        ("satisfies a,", "satisfies a", 13, "expected another requirement after the comma"),
        ("satisfies QualityReq", "satisfies {MISSING}", 21, "expected the requirement's ID"),
        ("satisfies QualityReq ID =", "satisfies {classic MISSING}", 26, "expected the requirement's ID"),
        ("satisfies QualityReq a :", "satisfies {a}", 25, "expected a quality"),
        ("tags", "tags MISSING", 5, "expected a tag"),
        ("tags a,", "tags a", 8, "expected a tag"),
    ],
)
def test_broken_node_clause(clause: str, shown: str, column: int, message: str) -> None:
    assert_node(f"X {clause}", f"X\n  {shown}", f"1:{column + 2} syntax-error «» {message}, {END}")
    if not clause.endswith(","):  # in brackets a comma may end a list
        assert_node(f"X ({clause})", f"X\n  {shown}", f"1:{column + 3} syntax-error «)» {message}, found `)`")


@pytest.mark.parametrize(
    ("line", "tree", "problem"),
    [
        ("X (satisfices a b = 1)", "X (b=1)\n  satisfices a", None),
        ("X (satisfices a b)", "X\n  satisfices a", f"1:17 syntax-error «b» {EXPECTED_ATTRIBUTE}, found `b`"),
        (
            "X (satisfices Quality a, b = 1)",
            "X (b=1)\n  satisfices a",
            "1:23 syntax-error «a» expected `=` after `Quality`, found `a`",
        ),
        (
            "X (satisfices Quality = a (b) c = 1)",
            "X (c=1)\n  satisfices a",
            "1:28 syntax-error «b» expected QualityReq or `)`, found `b`",
        ),
        (
            "X (satisfies a(3) c = 1)",
            "X (c=1)\n  satisfies a",
            "1:16 syntax-error «3» expected a parameter's name, found `3`",
        ),
        (
            "X (satisfies a(b) c = 1)",
            "X (c=1)\n  satisfies a(b=MISSING)",
            "1:17 syntax-error «)» expected `=`, found `)`",
        ),
        (
            "X (satisfies a(b = ) c = 1)",
            "X (c=1)\n  satisfies a(b=MISSING)",
            "1:20 syntax-error «)» expected a value with its unit: 30 s, found `)`",
        ),
    ],
)
def test_broken_node_clause_in_brackets(line: str, tree: str, problem: str | None) -> None:
    assert_node(line, tree, *([problem] if problem else []))


def test_a_requirement_with_a_block_is_the_last_of_its_line() -> None:
    text = """
        BehaviorTree t
            X
                satisfies a, QualityReq b : c "d"
                    keeps e
                    on violation fail because "f"
                tags g
                Y
    """
    tree = """
        tree t
          X
            satisfies a, {b : c "d"; keeps e; on violation fail; because "f"}
            tags g
            Y
    """
    assert_parse(text, tree)


def test_the_block_below_a_nodes_own_line_is_the_nodes() -> None:
    text = "BehaviorTree t\n  X satisfies QualityReq a\n    Y\n"
    assert_parse(text, "tree t\n  X\n    satisfies {a}\n    Y")


def test_a_clause_block_with_a_mistake() -> None:
    text = """
        BehaviorTree t
            X
                satisfies QualityReq a
                    keeps
                    Y
                        Z
                    never b
    """
    assert_parse(
        text,
        "tree t\n  X\n    satisfies {a; keeps MISSING; never b}",
        f"4:18 syntax-error «» expected a condition: a signal, a context, a value, …, {END}",
        f"5:14 syntax-error «» expected a verb after `Y` (takes, succeeds, needs, keeps, …), {END}",
        "6:17 syntax-error «Z» unexpected indentation: the line above opens no block",
    )


# ---- depth ----------------------------------------------------------------------------------------------------------


def nested(levels: int) -> str:
    return "BehaviorTree t\n" + "".join(f"{' ' * level}->\n" for level in range(1, levels + 1))


def test_as_many_levels_as_the_engine_reads_and_more() -> None:
    assert_parse(nested(256))
    problem = "258:258 nested-too-deep «->» more than 256 levels of nodes, which BehaviorTree.CPP refuses"
    parsed = assert_parse(nested(300), None, problem)
    assert len(list(parsed.trees[0].walk())) == 300
    assert parsed.diagnostics[0].notes == (
        "move a part of them into a BehaviorTree of its own and call it with SubTree",
    )


def test_deep_trees_can_be_compared() -> None:
    (tree,), (same,) = parse(nested(256)).trees, parse(nested(256)).trees
    (other,) = parse(nested(256).replace("->\n", "?\n", 256).replace("?", "->", 255)).trees
    assert (tree == same, tree == other, hash(tree.children) == hash(same.children)) == (True, False, True)
    assert (shape(tree) == shape(same), shape(tree) == shape(other)) == (True, False)


def test_the_shape_of_a_tree_knows_no_offsets_but_who_is_whose_child() -> None:
    shapes = [
        shape(parse(f"BehaviorTree t\n{block}").trees[0])
        for block in (
            " A\n  B\n  C",
            "  A (\n)\n    B # b\n\n    C",
            " A\n  B\n   C",
            " A\n  B\n  C (a = 1)",
            " A\n  B\n  xml 'C'",
        )
    ]
    assert [first == shapes[0] for first in shapes] == [True, True, False, False, False]
