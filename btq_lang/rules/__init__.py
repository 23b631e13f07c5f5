"""The rules: one row a rule, one page a rule (`<name>.md` beside this file), which is its documentation and its test.

The table knows names, severities and one line each; detection lives in the lexer, the parser and `checks/`.
"""

from __future__ import annotations

import os.path

from btq_lang.enumeration import Enum
from btq_lang.record import Record


class Severity(Enum):
    """How bad a finding is, worst first.  ERROR: the file cannot be built or the engine refuses it."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"
    HINT = "hint"


class Tag(Enum):
    """How an editor may show the place besides underlining it (LSP's DiagnosticTag)."""

    UNNECESSARY = 1
    DEPRECATED = 2


class Rule(Record):
    """A rule's name, its severity where nobody configured another, and what it finds in one line."""

    name: str
    severity: Severity
    summary: str


def page(rule: str) -> str:
    """The page of a rule, in Markdown.

    Raises:
        KeyError: there is no such rule.
    """
    with open(page_path(rule), encoding="utf-8") as file:
        return file.read()


def page_path(rule: str) -> str:
    """The file of a rule's page.

    Raises:
        KeyError: there is no such rule.
    """
    return f"{os.path.abspath(os.path.dirname(__file__))}/{RULES[rule].name}.md"


_E, _W, _H = Severity.ERROR, Severity.WARNING, Severity.HINT

_TABLE = (
    # What the lexer and the parser find.
    Rule("syntax-error", _E, "something else was expected here"),
    Rule("inconsistent-indentation", _E, "indentation that fits no open block, or mixes tabs and blanks"),
    Rule("unclosed-bracket", _E, "a `(` without its `)`"),
    Rule("unclosed-string", _E, "a string without its closing quote"),
    Rule("unclosed-comment", _E, "a `/*` without its `*/`"),
    Rule("misplaced-comment", _E, "a comment sign inside a word or value that should be quoted"),
    Rule("unknown-escape", _H, "a backslash that escapes nothing"),
    Rule("string-over-items", _H, "a string that runs past the start of another item: a quote is probably missing"),
    Rule("unknown-unit", _E, "a unit that is in no table"),
    Rule("nested-too-deep", _E, "more levels than the engine reads"),
    Rule("clause-after-children", _E, "satisfices, satisfies or tags behind a node's children"),
    Rule("clause-as-node", _W, "a word that begins a requirement's clause stands as a node"),
    Rule("second-root", _E, "a Root beside or inside another"),
    Rule("duplicate-attribute", _E, "two values for one attribute"),
    Rule("tree-root-count", _E, "a tree without exactly one node at its top"),
    Rule("useless-ignore", _W, "a comment `btq: ignore` that can silence nothing"),
    # What is wrong with XML as XML.
    Rule("xml-syntax", _E, "XML that the engine cannot read"),
    Rule("xml-root", _E, "a document element that is not `root`"),
    Rule("xml-not-well-formed", _W, "XML that the engine reads and other tools refuse"),
    Rule("xml-ignored", _W, "text or trees in XML where the engine looks for none"),
    # Nodes and their ports.
    Rule("unknown-node", _W, "a node kind that neither the engine nor any model knows"),
    Rule("no-models", _H, "many nodes with ports, and no model of any of them"),
    Rule("not-an-engine-node", _W, "a word of the published language that is no node of the engine"),
    Rule("newer-engine-node", _E, "a built-in that the target version of the engine does not have"),
    Rule("category-mismatch", _W, "a node used as another category than its model declares"),
    Rule("unknown-port", _E, "a port that the node does not provide"),
    Rule("missing-port", _E, "a port that must be given and is not"),
    Rule("unknown-attribute", _W, "an `_attribute` that the engine ignores silently"),
    Rule("invalid-literal", _E, "a value that the port's type refuses"),
    Rule("trailing-text-in-number", _W, "text behind a number that the engine drops silently"),
    Rule("number-for-text", _E, "a number that a SubTree gives to a port of text below it"),
    Rule("entry-with-two-types", _E, "a blackboard entry that ports of two types are given"),
    Rule("quantity-on-unitless-port", _E, "a quantity on a port whose unit is unknown or of another dimension"),
    Rule("misspelt-type", _W, "a port's type that is nearly one of C++"),
    Rule("literal-for-output", _W, "a value where a node puts something out"),
    Rule("count-of-nothing", _W, "a count or a time with which a Repeat, a Retry or a Timeout does nothing"),
    Rule("child-count", _E, "more or fewer children than the node takes"),
    Rule("switch-cases", _E, "a Switch whose cases and children do not match"),
    Rule("parallel-threshold", _E, "a Parallel threshold that its children cannot reach"),
    Rule("duplicate-instance-name", _H, "two nodes of one tree with the same name"),
    Rule("forbidden-name", _E, "a name that the engine refuses"),
    Rule("classic-placeholder", _H, "a ScriptAction or ScriptCondition without code that stands for a skill"),
    Rule("placeholder-clash", _E, "a placeholder whose name becomes a node ID that is taken"),
    # Trees and files.
    Rule("unknown-tree", _E, "a SubTree whose tree does not exist"),
    Rule("duplicate-tree", _E, "two trees with one ID"),
    Rule("recursive-tree", _E, "a tree that contains itself"),
    Rule("unused-tree", _W, "a tree that nothing refers to"),
    Rule("unreachable-tree", _H, "a tree that only unused trees refer to"),
    Rule("unknown-main-tree", _W, "no way to tell which tree is the mission"),
    Rule("tree-named-like-node", _E, "a tree whose ID is the name of a node"),
    Rule("missing-include", _E, "an included file that cannot be found"),
    Rule("include-with-errors", _E, "an included file that cannot be read"),
    Rule("cyclic-include", _E, "a file that includes itself: the engine crashes"),
    Rule("duplicate-definition", _E, "two definitions of one name"),
    # Scripts.
    Rule("script-error", _E, "a script that the engine refuses"),
    Rule("empty-script", _E, "a script without any statement"),
    Rule("script-version", _W, "a script that means different things in versions of the engine"),
    Rule("misspelt-entry", _W, "a blackboard entry named once, with nearly the name of another one"),
    # Requirements and qualities.
    Rule("unknown-requirement", _E, "a requirement that is defined nowhere"),
    Rule("conflicting-requirement", _E, "one requirement ID with two different texts"),
    Rule("unused-requirement", _W, "a requirement that nothing refers to"),
    Rule("named-twice", _H, "a requirement, a quality or a tag that one node has twice"),
    Rule("empty-text", _W, "a name that is empty"),
    Rule("unused-parameter", _W, "a parameter that no clause of its requirement names"),
    Rule("requirement-without-text", _W, "a requirement that says nothing, or nothing that could be violated"),
    Rule("duplicate-clause", _E, "a second clause of a kind that can be said once only"),
    Rule("clause-without-odds", _W, "a confidence or a window where nothing says how often"),
    Rule("unknown-quality", _W, "a quality name that no model of ISO/IEC 25010 has"),
    Rule("old-quality-name", _H, "an alias or a name of another edition"),
    Rule("ambiguous-quality", _W, "a quality name that means several things"),
    Rule("prose-constraint", _H, "SuccessIf or FailureIf in prose that no tool can check"),
    Rule("subtraction-without-blanks", _H, "`a-b` read as one name where `a` and `b` exist"),
    # What requirements demand.
    Rule("unit-mismatch", _E, "two values that measure different things"),
    Rule("number-without-unit", _E, "a bare number where a quantity is needed"),
    Rule("unknown-signal", _E, "a name in a condition or a bound that nothing declares"),
    Rule("cyclic-context", _E, "a context that speaks of itself"),
    Rule("unmatched-path", _E, "a subject or a selector that names no node"),
    Rule("ambiguous-path", _E, "a path that names several nodes"),
    Rule("wrong-argument", _E, "an argument that the requirement does not take, or one that is missing"),
    Rule("ambiguous-application", _E, "two values of one requirement for one node, and none more specific"),
    Rule("impossible-odds", _E, "a probability or a number of experiments that is none"),
    Rule("impossible-bound", _W, "a bound that nothing can keep, or nothing can break"),
    Rule("uses-of-gauge", _W, "`uses` of a signal that is neither a counter nor a level"),
    Rule("requirement-without-subject", _W, "a claim that is about no node"),
    Rule("limit-too-small", _E, "a limit that the engine takes for none"),
    Rule("limit-on-synchronous-node", _W, "a limit on a node that nothing can interrupt"),
    Rule("dead-bound", _W, "a bound that a Timeout around the node, or a tighter bound, makes void"),
    Rule("timeout-never-succeeds", _W, "a Timeout shorter than its child's shortest success"),
    Rule("budget-exceeded", _W, "children that may take more time than their parent"),
    Rule("goal-beyond-bound", _W, "a goal that is worse than the bound"),
    Rule("attempts-mismatch", _W, "`tries at most` against the attempts that Retry and Repeat make"),
    Rule("contradicting-bounds", _W, "two bounds on one node that cannot both hold"),
    Rule("odds-beyond-children", _W, "odds that what is demanded of the children does not ensure"),
    Rule("window-too-small", _W, "odds that no such window can show"),
    Rule("swallowed-failure", _W, "`on violation fail` where a parent goes on after the failure"),
    Rule("not-enforced", _W, "`on violation fail` or `halt` where the engine cannot be made to do it"),
    Rule("guard-never-renewed", _W, "a guard on what no node writes while the guarded one runs"),
    Rule("signal-never-written", _W, "a signal whose entry no port and no script writes"),
    Rule("unused-signal", _H, "a signal that nothing asks for"),
    Rule("unused-context", _H, "a context that no condition names"),
    Rule("signal-may-be-unset", _W, "a guard on a signal without a first value"),
    # Traps of the engine's semantics.
    Rule("reactive-multiple-async", _W, "a reactive node with more than one asynchronous child"),
    Rule("explicit-in-reactive", _E, "an explicit form in XML where the engine wants the node's own tag"),
    Rule("one-shot-monitor", _W, "_failureIf or _successIf on a long-running node, where it is checked only once"),
    Rule("while-skip-is-success", _W, "`_while` halts the node and the parent goes on as if it had succeeded"),
    Rule("skipped-condition", _W, "a condition of IfThenElse or WhileDoElse that may be skipped: the engine throws"),
    Rule("unreachable-child", _W, "a child that can never run"),
    Rule("condition-without-recheck", _H, "a condition behind a memory Fallback that cannot interrupt what runs"),
)

RULES = {rule.name: rule for rule in _TABLE}

# After these mistakes a file is not read as it stands, so nothing silences them: no selection, no comment.
UNREADABLE = frozenset(
    (
        *("syntax-error", "inconsistent-indentation", "unclosed-bracket", "unclosed-string", "unclosed-comment"),
        *("misplaced-comment", "unknown-unit", "xml-syntax", "xml-root"),
    )
)
