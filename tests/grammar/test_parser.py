"""Files and their items, language.md §3: each production as it should be, and broken.

The trees of nodes are in test_parser_nodes, requirements in test_parser_requirements, classic files in
test_parser_classic.
"""

from __future__ import annotations

import gc

import pytest
from syntax_asserts import assert_fix, assert_parse, dump

from btq_lang.parser import parse
from btq_lang.syntax.tree import Model, Root, SkippedLines, Tree, is_name, quote, unquote

# ---- File -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["", "\n", "  \n\t\n", "# only a comment", "\ufeff", "\ufeff\n"])
def test_a_file_may_be_empty(text: str) -> None:
    assert parse(text).entries == ()
    assert_parse(text, "")


def test_items_in_any_order() -> None:
    text = """
        BehaviorTree a
            X
        include "b.btq"
        BehaviorTree c
            Y
        signal d : m
    """
    tree = """
        tree a
          X
        include "b.btq"
        tree c
          Y
        signal d : m
    """
    parsed = assert_parse(text, tree)
    assert [tree.name.text for tree in parsed.trees if tree.name] == ["a", "c"]


def test_an_entry_begins_where_its_first_line_begins() -> None:
    parsed = parse("# c\n\nRoot a\n    BehaviorTree a\n        X\n# d\nsignal b : m\n")
    assert [(entry.start, entry.item.start, entry.in_root) for entry in parsed.entries] == [
        (5, 0, False),
        (12, 4, True),
        (45, 0, False),
    ]


def test_offsets_count_from_the_item_so_that_it_can_move() -> None:
    item = "BehaviorTree a\n    X (b = 1) satisfies QualityReq c keeps d\n"
    here, there = parse(item), parse(f"# moved\n\n{item}")
    assert [entry.item for entry in here.entries] == [entry.item for entry in there.entries]
    wrong = "BehaviorTree a\n    X (b = )\n"
    here, there = parse(wrong), parse(f"# moved\n\n{wrong}")
    assert here.entries[0].diagnostics == there.entries[0].diagnostics
    assert [problem.span.start + 9 for problem in here.diagnostics] == [
        problem.span.start for problem in there.diagnostics
    ]


def test_the_garbage_collector_is_left_as_it_was() -> None:
    assert gc.isenabled()
    parse("BehaviorTree a\n    X\n")
    assert gc.isenabled()
    gc.disable()
    try:
        parse("BehaviorTree a\n    X\n")
        assert not gc.isenabled()
    finally:
        gc.enable()


# ---- lines that are not items ---------------------------------------------------------------------------------------

END = "found the end of the line"
EXPECTED_ITEM = "expected an item: BehaviorTree, QualityReq, include, signal, …"


@pytest.mark.parametrize(
    ("line", "note"),
    [
        ("->", "a node goes in the block of a BehaviorTree, indented"),
        ("MoveBase", "a node goes in the block of a BehaviorTree, indented"),
        ("MoveBase (a = 1)", "a node goes in the block of a BehaviorTree, indented"),
        ("takes at most 3 s", "a clause goes in the block of a QualityReq, indented"),
        ("on violation fail", "a clause goes in the block of a QualityReq, indented"),
        ("satisfies r", "write it after a node, or indented in the block of a node or BehaviorTree"),
        ("input a : string", "a port goes in the block of a model or BehaviorTree, indented"),
        ('"BehaviorTree" a', "a word in quotes is a name, not a keyword; remove the quotes"),
        ("'xml' '<a/>'", "a word in quotes is a name, not a keyword; remove the quotes"),
        ("3 s", None),
        ("= a", None),
    ],
)
def test_a_line_that_begins_no_item_is_passed_over_with_its_block(line: str, note: str | None) -> None:
    first = line.split(" ", 1)[0] if line != "3 s" else line
    text = f"signal a : m\n{line}\n    Action X\n    Y (b = \n        Z\nsignal c : m\n"
    problem = f"2:1 syntax-error «{first}» {EXPECTED_ITEM}, found `{first}`"
    parsed = assert_parse(text, "signal a : m\nskipped\nsignal c : m", problem)
    assert parsed.diagnostics[0].notes == ((note,) if note else ())


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("BehaviourTree a", "BehaviorTree a"),
        ("behaviortree a", "BehaviorTree a"),
        ("BehaviorTre", "BehaviorTree"),
        ("BehaviorTrees (a = 1)", "BehaviorTree (a = 1)"),
        ("Signal a : m", "signal a : m"),
        ("singal a : m", "signal a : m"),
        ("QualityReg a", "QualityReq a"),
        ("inculde 'a'", "include 'a'"),
        ("root a", "Root a"),
    ],
)
def test_a_misspelt_item_is_read_as_the_one_that_was_meant(written: str, meant: str) -> None:
    word, right = written.split(" ")[0], meant.split(" ")[0]
    problem = f"1:1 syntax-error «{word}» unknown word `{word}`; did you mean `{right}`?"
    assert_parse(written, dump(parse(meant)), problem)
    assert_fix(written, f"Replace `{word}` with `{right}`", meant)


def test_a_misspelt_model_is_passed_over() -> None:
    problem = "1:1 syntax-error «Conditon» unknown word `Conditon`; did you mean `Condition`?"
    assert_parse("Conditon a\n  input b\nsignal c : m", "skipped\nsignal c : m", problem)
    assert_fix("Conditon a\n  input b\n", "Replace `Conditon` with `Condition`", "Condition a\n  input b\n")


def test_lines_that_are_indented_for_no_reason_are_one_diagnostic() -> None:
    text = "    include 'a'\n    include 'b'\n    BehaviorTree a\n        X\ninclude 'c'\n"
    tree = "include 'a'\ninclude 'b'\ntree a\n  X\ninclude 'c'"
    assert_parse(text, tree, "1:5 syntax-error «include» unexpected indentation: no block is open above this line")


NO_BLOCK = "unexpected indentation: the line above opens no block"


@pytest.mark.parametrize(
    "item",
    [
        "include 'a'",
        "qualities iso25010-2011",
        "quality a",
        "xml '<a/>'",
        "signal a : m",
        "context a : b",
        "apply a to b",
    ],
)
def test_an_item_without_a_block_has_none(item: str) -> None:
    text = f"{item}\n    foo\n        bar (\n    baz )\nsignal b : m\n"
    assert_parse(text, f"{dump(parse(item))}\nsignal b : m", f"2:5 syntax-error «foo» {NO_BLOCK}")


def test_an_indented_item_below_another_is_still_an_item() -> None:
    text = "signal a : m\n    signal b : m\n    signal c : m\nBehaviorTree d\n    X\n"
    problem = "2:5 syntax-error «signal» unexpected indentation: no block is open above this line"
    assert_parse(text, "signal a : m\nsignal b : m\nsignal c : m\ntree d\n  X", problem)


# ---- Include --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ['include "a.btq"', "include 'a.xml' (ros_pkg = \"p\")", "include 'a b'(c=d)"])
def test_include(text: str) -> None:
    assert_parse(text, text.replace(" = ", "=").replace("'(", "' ("))


@pytest.mark.parametrize(
    ("text", "tree", "problem"),
    [
        ("include", "include MISSING", f"1:8 syntax-error «» expected a file in quotes, {END}"),
        ("include a/b.btq", "include MISSING", "1:9 syntax-error «a» expected a file in quotes, found `a`"),
        ("include 'a' 'b'", "include 'a'", "1:13 syntax-error «'b'» expected the end of the line, found `'b'`"),
        (
            "include 'a' (satisfies b)",
            "include 'a'",
            "1:14 syntax-error «satisfies b» only `key = value` pairs are allowed in these brackets",
        ),
    ],
)
def test_broken_include(text: str, tree: str, problem: str) -> None:
    assert_parse(f"{text}\nsignal a : m", f"{tree}\nsignal a : m", problem)


def test_an_unquoted_path_can_be_quoted() -> None:
    assert_fix("include ../a-b/c.btq (d = 1)", "Put quotes around it", 'include "../a-b/c.btq" (d = 1)')


# ---- Qualities, QualityDecl -----------------------------------------------------------------------------------------


def test_qualities() -> None:
    assert_parse("qualities iso25010-2011", "qualities iso25010-2011")
    message = "expected iso25010-2023 or iso25010-2011, found the end of the line"
    assert_parse("qualities", "qualities MISSING", f"1:10 syntax-error «» {message}")


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("quality gentle", "quality gentle"),
        ("quality 'very gentle'", "quality 'very gentle'"),
        ("quality gentle : safety", "quality gentle : safety"),
        ("quality gentle : safety.'fail safe' 'no bumps'", "quality gentle : safety.'fail safe' 'no bumps'"),
        ("quality gentle : safety <fail-safe>", "quality gentle : safety.fail-safe"),
        ("quality gentle 'no bumps'", "quality gentle 'no bumps'"),
    ],
)
def test_quality_declaration(text: str, tree: str) -> None:
    assert_parse(text, tree)


@pytest.mark.parametrize(
    ("text", "tree", "problem"),
    [
        (
            "quality",
            "quality MISSING",
            f"1:8 syntax-error «» expected the name of the quality, {END}",
        ),
        ("quality : a", "quality MISSING", "1:9 syntax-error «:» expected the name of the quality, found `:`"),
        ("quality a :", "quality a", f"1:12 syntax-error «» expected a quality, {END}"),
        (
            "quality a : b.",
            "quality a : b",
            f"1:15 syntax-error «» expected a sub-characteristic, {END}",
        ),
        ("quality a : b <c", "quality a : b.c", f"1:17 syntax-error «» expected `>`, {END}"),
        ("quality a 'b' : c", "quality a 'b'", "1:15 syntax-error «:» expected the end of the line, found `:`"),
    ],
)
def test_broken_quality_declaration(text: str, tree: str, problem: str) -> None:
    assert_parse(f"{text}\nsignal a : m", f"{tree}\nsignal a : m", problem)


# ---- Models, Model, Port, Meta --------------------------------------------------------------------------------------


@pytest.mark.parametrize("category", ["Action", "Condition", "Control", "Decorator", "SubTree"])
def test_model(category: str) -> None:
    text = f"""
        {category} MoveBase "drives" # c
            input station : string = "charger" "where to"
            output done
            inout : geometry_msgs::msg::Pose (a = "b")
            input
            input "text"
            metadata (color = "red" x = 1)
            xml "<a/>"
    """
    tree = f"""
        model {category} MoveBase "drives"
          input station : string = "charger" "where to"
          output done
          inout : geometry_msgs::msg::Pose (a="b")
          input
          input "text"
          metadata (color="red" x=1)
          xml "<a/>"
    """
    assert_parse(text, tree)


def test_model_with_attributes() -> None:
    assert_parse("Action 'a b' (c = d) 'e'", "model Action 'a b' (c=d) 'e'")


@pytest.mark.parametrize(
    ("port", "tree"),
    [
        ("input a : 'std::vector<int>'", "input a : 'std::vector<int>'"),
        ("input a:double=-1.5", "input a : double = -1.5"),
        ("input a = {=}", "input a = {=}"),
        ("input a : Time = 30 s", "input a : Time = 30s"),
        ("input input : input", "input input : input"),
        ("output : 'x'", "output : 'x'"),
    ],
)
def test_port(port: str, tree: str) -> None:
    assert_parse(f"Action A\n  {port}", f"model Action A\n  {tree}")
    assert_parse(f"BehaviorTree A\n  {port}\n  X", f"tree A\n  {tree}\n  X")


def test_a_type_of_several_words_is_one() -> None:
    parsed = parse("Action A\n    input b : geometry_msgs :: /* a message */ Pose\n    input c : a::b\n")
    model = parsed.entries[0].item
    assert isinstance(model, Model)
    assert [port.type and port.type.text for port in model.ports] == ["geometry_msgs::Pose", "a::b"]
    assert model.ports[0].type is not None
    assert model.ports[0].type.raw == "geometry_msgs :: /* a message */ Pose"


@pytest.mark.parametrize(
    ("port", "tree", "problem"),
    [
        ("input a :", "input a", f"2:12 syntax-error «» expected the port's type, {END}"),
        ("input a : b::", "input a : b", f"2:16 syntax-error «» expected the rest of the type, {END}"),
        (
            "input a =",
            "input a",
            "2:12 syntax-error «» expected a value: a string, a name, a number, a quantity or {key}, "
            "found the end of the line",
        ),
        ("input a b", "input a", "2:11 syntax-error «b» expected `:` and the port's type, found `b`"),
        ("input a = 1 : int", "input a = 1", "2:15 syntax-error «:» expected the end of the line, found `:`"),
        (
            "input a : b = 30 s (c = 2)",
            "input a : b = 30",
            "2:20 syntax-error «s» expected the end of the line, found `s`",
        ),
        ("input 'a' : int", "input 'a' : int", "2:9 syntax-error «'a'» a port's name takes no quotes"),
        *(
            (f"input a : {type_} = 1", f"input a : {type_} = 1", f"2:13 syntax-error «{type_}» this type needs quotes")
            for type_ in ("std::vector<int>", "std::map<int, double>", "unsigned int", "Pose*", "const A&", "int[]")
        ),
    ],
)
def test_broken_port(port: str, tree: str, problem: str) -> None:
    assert_parse(f"Action A\n  {port}\n  output z\n", f"model Action A\n  {tree}\n  output z", problem)
    assert_parse(f"BehaviorTree A\n  {port}\n  X\n", f"tree A\n  {tree}\n  X", problem)


@pytest.mark.parametrize(
    ("head", "tree", "problem"),
    [
        ("Action", "Action MISSING", f"1:7 syntax-error «» expected the node's ID, {END}"),
        ("Action (ID = A)", "Action MISSING", "1:8 syntax-error «(» expected the node's ID, found `(`"),
        ("Action 'a' 'b' (c = 1)", "Action 'a' 'b'", "1:16 syntax-error «(» expected the end of the line, found `(`"),
        ("Action A B", "Action A", "1:10 syntax-error «B» expected the end of the line, found `B`"),
    ],
)
def test_broken_model(head: str, tree: str, problem: str) -> None:
    assert_parse(f"{head}\n  input a\n", f"model {tree}\n  input a", problem)


def test_what_stands_in_a_model_and_is_no_port() -> None:
    text = """
        Action A
            ->
                B
            input a
                b
            metadata
            output c
    """
    parsed = assert_parse(
        text,
        "model Action A\n  input a\n  metadata\n  output c",
        "2:5 syntax-error «->» expected a port (input, output or inout), metadata or xml, found `->`",
        f"5:9 syntax-error «b» {NO_BLOCK}",
        '6:13 syntax-error «» expected attributes in brackets: metadata (key = "value"), found the end of the line',
    )
    assert len(parsed.entries) == 1


def test_models() -> None:
    text = """
        TreeNodesModel
            Action A
                input a
            xml "<B/>"
            SubTree C
        TreeNodesModel
    """
    tree = """
        models
          model Action A
            input a
          xml "<B/>"
          model SubTree C
        models
    """
    assert_parse(text, tree)


def test_broken_models() -> None:
    text = """
        TreeNodesModel A
            input a
                b
            Action B
            xml
    """
    assert_parse(
        text,
        "models\n  model Action B\n  xml MISSING",
        "1:16 syntax-error «A» expected the end of the line, found `A`",
        "2:5 syntax-error «input» expected a node model: Action, Condition, Control, Decorator or SubTree and its ID, "
        "found `input`",
        f"5:8 syntax-error «» expected one XML element in quotes, {END}",
    )


# ---- Signal, Context ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("signal a : m", "signal a : m"),
        ("signal a:m/s^2", "signal a : m/s^2"),
        ("signal a : % from {b}", "signal a : % from {b}"),
        ("signal a : 1", "signal a : 1"),
        ("signal a : 1 from {b}", "signal a : 1 from {b}"),
        ("signal a : 1/s level", "signal a : 1/s level"),
        ("signal a : bool initially true", "signal a : bool initially true"),
        ("signal a : text initially 'x'", "signal a : text initially 'x'"),
        ("signal a : Wh counter fresh within 5 s", "signal a : Wh counter fresh within 5s"),
        ("signal a : degC from {@b} gauge initially -5 degC", "signal a : degC from {@b} gauge initially -5degC"),
        ("signal from : m from {from}", "signal from : m from {from}"),
        ("signal signal : m", "signal signal : m"),
        ("signal level : m level", "signal level : m level"),
    ],
)
def test_signal(text: str, tree: str) -> None:
    assert_parse(text, tree)


@pytest.mark.parametrize(
    ("text", "tree", "problem"),
    [
        ("signal", "MISSING : MISSING", f"1:7 syntax-error «» expected the signal's name, {END}"),
        ("signal 'a' : m", "MISSING : MISSING", "1:8 syntax-error «'a'» expected the signal's name, found `'a'`"),
        ("signal a", "a : MISSING", f"1:9 syntax-error «» expected `:` and the signal's unit, {END}"),
        ("signal a m", "a : MISSING", "1:10 syntax-error «m» expected `:` and the signal's unit, found `m`"),
        ("signal a :", "a : MISSING", f"1:11 syntax-error «» expected a unit: s, m/s, %, 1, bool, text, …, {END}"),
        ("signal a : from {b}", "a : from from {b}"[:8], "1:12 unknown-unit «from» unknown unit `from`"),
        (
            "signal a : meter/sek from {b}",
            "a : meter/sek from {b}",
            "1:12 unknown-unit «meter/sek» unknown unit `meter/sek`; did you mean `m/s`?",
        ),
        ("signal a : 'm/s'", "a : 'm/s'", "1:12 syntax-error «'m/s'» a unit takes no quotes"),
        ("signal a : m from b", "a : m", "1:19 syntax-error «b» expected a blackboard entry: `{key}`, found `b`"),
        (
            "signal a : m level from {b}",
            "a : m level",
            "1:20 syntax-error «from» expected the end of the line, found `from`",
        ),
        ("signal a : m fresh 5 s", "a : m", "1:20 syntax-error «5 s» expected `within`, found `5 s`"),
        ("signal a : m fresh within 5", "a : m", "1:27 syntax-error «5» expected a duration: 5 s, found `5`"),
        ("signal a : m initially", "a : m", f"1:23 syntax-error «» expected a value with its unit: 30 s, {END}"),
        (
            "signal a : m initially 5 meterz",
            "a : m initially 5",
            "1:26 unknown-unit «meterz» unknown unit `meterz`; did you mean `m`?",
        ),
    ],
)
def test_broken_signal(text: str, tree: str, problem: str) -> None:
    assert_parse(f"{text}\nsignal z : m", f"signal {tree}\nsignal z : m", problem)


def test_a_quoted_unit_can_be_unquoted() -> None:
    assert_fix("signal a : 'm/s' level", "Write `m/s`", "signal a : m/s level", safe=True)


def test_context() -> None:
    assert_parse("context near : humans > 0", "context near : (humans > 0)")
    assert_parse("context a : b", "context a : b")


@pytest.mark.parametrize(
    ("text", "tree", "problem"),
    [
        ("context", "MISSING : MISSING", f"1:8 syntax-error «» expected the context's name, {END}"),
        ("context a b", "a : MISSING", "1:11 syntax-error «b» expected `:` and a condition, found `b`"),
        (
            "context a :",
            "a : MISSING",
            f"1:12 syntax-error «» expected a condition: a signal, a context, a value, …, {END}",
        ),
        ("context a : b c", "a : b", "1:15 syntax-error «c» expected the end of the line, found `c`"),
    ],
)
def test_broken_context(text: str, tree: str, problem: str) -> None:
    assert_parse(f"{text}\nsignal z : m", f"context {tree}\nsignal z : m", problem)


# ---- Apply ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        "apply a to b",
        "apply a, 'b c' to d, e/f, every g",
        "apply a to every b under c/d except e, every f",
        "apply a to every node tagged b",
        "apply a to every 'node', every node, every node under b",
        "apply 'to' to to",
    ],
)
def test_apply(text: str) -> None:
    assert_parse(text, text)


def test_apply_with_arguments() -> None:
    text = "apply a(b = 1 m/s, c = 2 s if d else -3 s) to e"
    assert_parse(text, "apply a(b=1m/s, c=[2s if d, -3s else]) to e")


@pytest.mark.parametrize(
    ("text", "tree", "problem"),
    [
        ("apply", "MISSING to MISSING", f"1:6 syntax-error «» expected a requirement, {END}"),
        ("apply to b", "MISSING to MISSING", "1:7 syntax-error «to» expected a requirement, found `to`"),
        ("apply a", "a to MISSING", f"1:8 syntax-error «» expected `to`, {END}"),
        ("apply a b", "a to MISSING", "1:9 syntax-error «b» expected `to`, found `b`"),
        ("apply a, to b", "a to MISSING", "1:10 syntax-error «to» expected a requirement, found `to`"),
        ("apply a to", "a to MISSING", f"1:11 syntax-error «» expected a node, or `every` and a node, {END}"),
        ("apply a to b,", "a to b", f"1:14 syntax-error «» expected a node, or `every` and a node, {END}"),
        ("apply a to every", "a to MISSING", "1:12 syntax-error «every» no selector names all nodes"),
        ("apply a to b c", "a to b", "1:12 syntax-error «b c» a path is written with `/`: `b/c`"),
        ("apply a to b c, d", "a to b, d", "1:12 syntax-error «b c» a path is written with `/`: `b/c`"),
        ("apply a to b c except d", "a to b except d", "1:12 syntax-error «b c» a path is written with `/`: `b/c`"),
        ("apply a to b except", "a to b", f"1:20 syntax-error «» expected a node, or `every` and a node, {END}"),
        ("apply a(b) to c", "a(b=MISSING) to c", "1:10 syntax-error «)» expected `=`, found `)`"),
        ("apply a() to c", "a to c", "1:9 syntax-error «)» expected a parameter's name, found `)`"),
        ("apply a(b = 1 c = 2) to d", "a(b=1) to d", "1:15 syntax-error «c» expected `,` or `)`, found `c`"),
    ],
)
def test_broken_apply(text: str, tree: str, problem: str) -> None:
    assert_parse(f"{text}\nsignal z : m", f"apply {tree}\nsignal z : m", problem)


# ---- Root -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("Root", "root"),
        ("Root a", "root a"),
        ("Root 'a b'", "root 'a b'"),
        ("Root a ()", "root a ()"),
        ("Root (BTCPP_format = '4')", "root (BTCPP_format='4')"),
        ("Root a (BTCPP_format = 4, b = 'c')", "root a (BTCPP_format=4 b='c')"),
    ],
)
def test_root(text: str, tree: str) -> None:
    parsed = assert_parse(text, tree)
    assert isinstance(root := parsed.entries[0].item, Root)
    assert root.bracketed == ("(" in text)


def test_a_root_holds_items() -> None:
    text = """
        # before
        Root a
            # inside
            include 'b'
            BehaviorTree a
                X
            QualityReq c
                takes at most 3 s
        signal d : m
    """
    tree = """
        root a
          include 'b'
          tree a
            X
          requirement c
            takes <= 3s
        signal d : m
    """
    assert_parse(text, tree)


def test_a_second_root_is_one_diagnostic_and_is_read() -> None:
    text = """
        Root a
            BehaviorTree a
                X
            Root b
                BehaviorTree b
                    Y
            signal c : m
        Root d
            BehaviorTree d
                Z
    """
    tree = """
        root a
          tree a
            X
          root b
          tree b
            Y
          signal c : m
        root d
          tree d
            Z
    """
    assert_parse(text, tree, "4:5 second-root «Root» unexpected Root inside another Root",
                 "8:1 second-root «Root» unexpected second Root in this file")  # fmt: skip


@pytest.mark.parametrize(
    ("text", "tree", "problem"),
    [
        ("Root a b", "root a", "1:8 syntax-error «b» expected the end of the line, found `b`"),
        ("Root a (b)", "root a ()", "1:9 syntax-error «b» expected an attribute: key = value, found `b`"),
        (
            "Root a (satisfies b)",
            "root a ()",
            "1:9 syntax-error «satisfies b» only `key = value` pairs are allowed in these brackets",
        ),
        ("Root = a", "root a", "1:6 syntax-error «=» unexpected `=`"),
    ],
)
def test_broken_root(text: str, tree: str, problem: str) -> None:
    assert_parse(f"{text}\n  BehaviorTree a\n    X", f"{tree}\n  tree a\n    X", problem)


# ---- Tree -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("BehaviorTree", "tree"),
        ("BehaviorTree a", "tree a"),
        ("BehaviorTree '3 Waypoints'", "tree '3 Waypoints'"),
        ("BehaviorTree ID = a", "tree a"),
        ("BehaviorTree ID='a b'", "tree 'a b'"),
        ("BehaviorTree ID", "tree ID"),
        ("BehaviorTree (ID = a _description = 'b')", "tree (ID=a _description='b')"),
        ("BehaviorTree a (b = {c})", "tree a (b={c})"),
        ("BehaviorTree BehaviorTree", "tree BehaviorTree"),
        ("BehaviorTree Root", "tree Root"),
    ],
)
def test_tree(text: str, tree: str) -> None:
    assert_parse(text, tree)


@pytest.mark.parametrize(
    ("text", "tree", "problem"),
    [
        ("BehaviorTree ID =", "tree", f"1:18 syntax-error «» expected the tree's ID, {END}"),
        ("BehaviorTree ID = 3", "tree", "1:19 syntax-error «3» expected the tree's ID, found `3`"),
        ("BehaviorTree a b", "tree a", "1:16 syntax-error «b» expected the end of the line, found `b`"),
        ("BehaviorTree: a", "tree a", "1:13 syntax-error «:» unexpected `:`"),
        ("BehaviorTree = a", "tree", "1:14 syntax-error «=» expected the end of the line, found `=`"),
        ("BehaviorTree 3 Waypoints", "tree", "1:14 syntax-error «3» expected the end of the line, found `3`"),
        (
            "BehaviorTree a satisfies b",
            "tree a",
            "1:16 syntax-error «satisfies» expected the end of the line, found `satisfies`",
        ),
        (
            "BehaviorTree a (satisfies b)",
            "tree a",
            "1:17 syntax-error «satisfies b» only `key = value` pairs are allowed in these brackets",
        ),
    ],
)
def test_broken_tree(text: str, tree: str, problem: str) -> None:
    assert_parse(f"{text}\n  X\n", f"{tree}\n  X", problem)


def test_the_parts_of_a_tree_in_their_order() -> None:
    text = """
        BehaviorTree a
            input b : int
            output c
            satisfices d
            satisfies e tags f
            X
            Y
    """
    tree = """
        tree a
          input b : int
          output c
          satisfices d
          satisfies e
          tags f
          X
          Y
    """
    assert_parse(text, tree)


def test_xml_may_stand_where_a_port_or_a_node_may() -> None:
    text = """
        BehaviorTree a
            xml "<b/>"
            input c
            xml "<d/>"
            satisfies e
            X
                satisfies f
                xml "<g/>"
            xml "<h/>"
    """
    tree = """
        tree a
          input c
          satisfies e
          xml "<b/>"
          xml "<d/>"
          X
            satisfies f
            xml "<g/>"
          xml "<h/>"
    """
    assert_parse(text, tree)


def test_ports_behind_clauses_are_one_diagnostic() -> None:
    text = "BehaviorTree a\n  satisfies b\n  input c : int\n  X\n"
    problem = "3:3 syntax-error «input» ports go before satisfices, satisfies and tags"
    assert_parse(text, "tree a\n  input c : int\n  satisfies b\n  X", problem)


def test_a_port_has_no_block() -> None:
    text = "BehaviorTree a\n  input b\n    Action C\n    D\n  X\n"
    assert_parse(text, "tree a\n  input b\n  X", f"3:5 syntax-error «Action C» {NO_BLOCK}")


# ---- Verbatim -------------------------------------------------------------------------------------------------------


def test_verbatim() -> None:
    assert_parse('xml \'<a b="c"/>\'\nxml "<d>\n</d>"', 'xml \'<a b="c"/>\'\nxml "<d>\\n</d>"')
    problem = "1:5 syntax-error «a» expected one XML element in quotes, found `a`"
    assert_parse("xml a\nsignal b : m", "xml MISSING\nsignal b : m", problem)


# ---- the rest of the tree's interface -------------------------------------------------------------------------------


def test_walking_a_tree_in_document_order() -> None:
    (tree,) = parse("BehaviorTree a\n  A\n    B\n      C\n    xml 'x'\n    D\n  E\n").trees
    assert [node.head.text for node in tree.walk()] == ["A", "B", "C", "D", "E"]
    assert isinstance(tree, Tree)


def test_what_stands_behind_the_last_item_is_reported() -> None:
    parsed = parse("/*")
    assert [diagnostic.rule for diagnostic in parsed.diagnostics] == ["unclosed-comment"]
    assert isinstance(parsed.entries[0].item, SkippedLines)


@pytest.mark.parametrize("text", ["", "a", 'a"b', "a\\b", "a\tb", "a\nb", "a\\", "\\n", "'", "größe", '"""', '\\\\"'])
def test_quoting_and_reading_are_each_others_inverse(text: str) -> None:
    assert unquote(quote(text)) == text
    (tree,) = assert_parse(f"BehaviorTree {quote(text)}").trees
    assert tree.name is not None
    assert tree.name.text == text


@pytest.mark.parametrize("text", ["a", "_a", "a-b", "Ready?", "Go!", "R", "Größe", "x²", "BehaviorTree", "true"])
def test_what_can_be_written_as_a_name(text: str) -> None:
    assert is_name(text)
    assert_parse(f"BehaviorTree {text}", f"tree {text}")


@pytest.mark.parametrize("text", ["", "a b", "3a", "a-", "-a", "a--b", "a?b", "a??", "²", "a.b", "->", "é" + "\u0301"])
def test_what_cannot(text: str) -> None:
    assert not is_name(text)
    tree = parse(f"BehaviorTree {text} (a = 1)")
    assert tree.diagnostics or tree.trees[0].name is None


def test_symbols_are_no_names() -> None:
    assert not is_name("R?")
    assert_parse("BehaviorTree R?", "tree", "1:14 syntax-error «R?» expected the end of the line, found `R?`")
