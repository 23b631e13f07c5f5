"""The rules: one row a rule, one page a rule (`<name>.md` beside this file), which is its documentation and its test.

The table knows names, severities and one line each; what a rule finds is found elsewhere, mostly in `checks/`.
"""

from __future__ import annotations

import os.path
from enum import Enum

from btq_lang.util.record import Record


class Severity(Enum):
    """The severity of a finding, most severe first.  ERROR: the file cannot be built, or the engine refuses it."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"
    HINT = "hint"


class Tag(Enum):
    """How an editor may mark the place besides underlining it (LSP's DiagnosticTag)."""

    UNNECESSARY = 1
    DEPRECATED = 2


class Rule(Record):
    """A rule's name, its default severity, and a one-line summary of what it finds."""

    name: str
    severity: Severity
    summary: str


def by_subject() -> dict[str, list[Rule]]:
    """The rules by what they are about."""
    subjects: dict[str, list[Rule]] = {}
    rules: list[Rule] = []
    for row in _TABLE:
        if isinstance(row, Rule):
            rules.append(row)
        else:
            rules = subjects.setdefault(row, [])
    return subjects


def page(rule: str) -> str:
    """The page of a rule, in Markdown.

    Raises:
        KeyError: the rule does not exist.
    """
    with open(page_path(rule), encoding="utf-8") as file:
        return file.read()


def page_path(rule: str) -> str:
    """The file of a rule's page.

    Raises:
        KeyError: the rule does not exist.
    """
    return f"{os.path.abspath(os.path.dirname(__file__))}/{RULES[rule].name}.md"


_E, _W, _H = Severity.ERROR, Severity.WARNING, Severity.HINT

_TABLE: tuple[str | Rule, ...] = (  # a string is the subject of the rules below it
    "Text",
    Rule("syntax-error", _E, "text that the grammar does not allow at this place"),
    Rule("inconsistent-indentation", _E, "indentation that matches no open block, or mixes tabs and spaces"),
    Rule("unclosed-bracket", _E, "a `(` without its `)`"),
    Rule("unclosed-string", _E, "a string without its closing quote"),
    Rule("unclosed-comment", _E, "a `/*` without its `*/`"),
    Rule("misplaced-comment", _E, "a comment sign inside a word or value that should be quoted"),
    Rule("unknown-escape", _H, "a backslash before a character that it does not escape"),
    Rule(
        "string-over-items", _H, "a string that continues past the start of another item: a quote is probably missing"
    ),
    Rule("unknown-unit", _E, "a unit that btq does not know"),
    Rule("nested-too-deep", _E, "more nested levels than the engine reads"),
    Rule("clause-after-children", _E, "satisfices, satisfies or tags after a node's children"),
    Rule("clause-as-node", _W, "the first word of a requirement clause, used as a node"),
    Rule("second-root", _E, "a Root beside or inside another"),
    Rule("duplicate-attribute", _E, "two values for one attribute"),
    Rule("tree-root-count", _E, "a tree without exactly one node at its top"),
    Rule("useless-ignore", _W, "a comment `btq: ignore` that cannot silence anything"),
    "XML",
    Rule("xml-syntax", _E, "XML that the engine cannot read"),
    Rule("xml-root", _E, "a document element that is not `root`"),
    Rule("xml-not-well-formed", _W, "XML that the engine reads although it is not well-formed"),
    Rule("xml-ignored", _W, "text, elements or attributes in XML that the engine ignores"),
    Rule("refused-element", _E, "models, a port of a tree or an include that the engine refuses"),
    "Nodes and their ports",
    Rule("unknown-node", _W, "a node kind that neither the engine nor any model defines"),
    Rule("no-models", _H, "many nodes with ports, and no model for any of them"),
    Rule("not-an-engine-node", _W, "a word of the classic syntax, or of another engine, that is not a node"),
    Rule("newer-engine-node", _E, "a built-in node that the project's engine version does not have"),
    Rule("category-mismatch", _W, "a node used as another category than its model declares"),
    Rule("unknown-port", _E, "a port that the node does not have"),
    Rule("missing-port", _E, "a required port without a value"),
    Rule("unknown-attribute", _W, "an `_attribute` that the engine ignores silently"),
    Rule("invalid-literal", _E, "a value that the port's type does not accept"),
    Rule("trailing-text-in-number", _W, "text after a number that the engine drops silently"),
    Rule("version-3-file", _W, "XML for version 3 of the engine in a project that does not say so"),
    Rule("version-4-file", _E, "XML for version 4 of the engine in a project whose engine is version 3"),
    Rule("old-entry", _W, "`${key}`, which is an entry only to version 3 of the engine"),
    Rule("json-in-braces", _W, "JSON in braces, which the engine reads as the name of an entry"),
    Rule("key-in-braces", _W, "the name of an entry in braces, where the node reads the name from that entry"),
    Rule("number-for-text", _E, "a number that a SubTree passes to a string port below it"),
    Rule("entry-with-two-types", _E, "a blackboard entry that is connected to ports of two types"),
    Rule("quantity-on-unitless-port", _E, "a quantity on a port whose unit is unknown or has another dimension"),
    Rule("misspelt-type", _W, "a port type that is very close to a C++ type"),
    Rule("literal-for-output", _W, "a literal value at an output port"),
    Rule("count-of-nothing", _W, "a count or a time that makes a Repeat, a Retry or a Timeout do nothing"),
    Rule("child-count", _E, "more or fewer children than the node accepts"),
    Rule("switch-cases", _E, "a Switch whose cases and children do not match"),
    Rule("parallel-threshold", _E, "a Parallel threshold that its children cannot reach"),
    Rule("duplicate-instance-name", _H, "two nodes of one tree with the same name"),
    Rule("forbidden-name", _E, "a name that the engine refuses"),
    Rule(
        "classic-placeholder", _H, "a ScriptAction or ScriptCondition without code, used as a placeholder for a skill"
    ),
    Rule("placeholder-clash", _E, "a placeholder whose node ID is already in use"),
    "Nodes in C++",
    Rule("undeclared-port-in-cpp", _W, "a port that C++ code reads or writes, and its node does not provide"),
    Rule("unused-port-in-cpp", _W, "a port that a node in C++ provides, and its code never names"),
    Rule("stale-model", _W, "a model that says otherwise of a node than the C++ that registers it"),
    Rule("unseen-in-cpp", _H, "C++ code from which btq cannot see which nodes or ports there are"),
    "Trees and files",
    Rule("unknown-tree", _E, "a SubTree whose tree does not exist"),
    Rule("duplicate-tree", _E, "two trees with one ID"),
    Rule("recursive-tree", _E, "a tree that contains itself"),
    Rule("unused-tree", _W, "a tree without any reference"),
    Rule("unreachable-tree", _H, "a tree that only unused trees refer to"),
    Rule("unknown-main-tree", _W, "several trees that could be the main tree"),
    Rule("tree-named-like-node", _E, "a tree whose ID is the name of a node"),
    Rule("missing-include", _E, "an included file that does not exist"),
    Rule("include-with-errors", _E, "an included file that has errors"),
    Rule("cyclic-include", _E, "a file that includes itself: the engine crashes"),
    Rule("duplicate-definition", _E, "two definitions of one name"),
    "Scripts",
    Rule("script-error", _E, "a script that the engine refuses"),
    Rule("empty-script", _E, "a script without any statement"),
    Rule("script-version", _W, "a script that engine versions read differently"),
    Rule("unread-argument", _W, "an argument of a SubTree that nothing in its tree reads"),
    Rule("unset-entry", _W, "a blackboard entry that is read where nothing can have written it"),
    Rule("uncreated-entry", _W, "an assignment with `=` to a blackboard entry that nothing creates"),
    Rule("misspelt-entry", _W, "a blackboard entry that appears once, with a name very close to another one"),
    "Requirements and qualities",
    Rule("unknown-requirement", _E, "a reference to a requirement that is not defined"),
    Rule("conflicting-requirement", _E, "one requirement ID with two different texts"),
    Rule("unknown-hazard", _E, "a reference to a hazard that is not declared"),
    Rule("cyclic-refinement", _E, "a requirement that refines itself"),
    Rule("approval-outdated", _W, "an approval of a requirement that means something else now"),
    Rule(
        "approval-missing", _W, "a requirement without an approval that changes outdate, in a project that requires it"
    ),
    Rule("unused-requirement", _W, "a requirement without any reference"),
    Rule("named-twice", _H, "a requirement, a quality or a tag that one node has twice"),
    Rule("empty-text", _W, "an empty name"),
    Rule("unused-parameter", _W, "a parameter that no clause of its requirement names"),
    Rule("requirement-without-text", _W, "a requirement that demands nothing, or nothing that can be violated"),
    Rule("duplicate-clause", _E, "a second clause of a kind that a requirement may contain only once"),
    Rule("qualifier-of-all", _W, "a clause about all claims of its requirement, on the line of one of them"),
    Rule("clause-without-odds", _W, "a confidence or a window in a requirement without a required probability"),
    Rule("unknown-quality", _W, "a quality name that no edition of ISO/IEC 25010 defines"),
    Rule("old-quality-name", _H, "an alias or a name of another edition"),
    Rule("ambiguous-quality", _W, "a quality name that has several meanings"),
    Rule("prose-constraint", _H, "SuccessIf or FailureIf followed by prose that no tool can check"),
    Rule("subtraction-without-blanks", _H, "`a-b` read as one name where `a` and `b` exist"),
    "What requirements demand",
    Rule("unit-mismatch", _E, "two values that measure different things"),
    Rule("number-without-unit", _E, "a number without a unit where a quantity is required"),
    Rule("unknown-signal", _E, "an undeclared name in a condition or a bound"),
    Rule("cyclic-context", _E, "a context that refers to itself"),
    Rule("unmatched-path", _E, "a subject or a selector that matches no node"),
    Rule("ambiguous-path", _E, "a path that matches several nodes"),
    Rule("wrong-argument", _E, "an argument that the requirement does not accept, or a missing one"),
    Rule("ambiguous-application", _E, "two values of one requirement for one node, and neither is more specific"),
    Rule(
        "impossible-odds", _E, "an impossible probability or confidence, or an impossible number of runs or activations"
    ),
    Rule("impossible-bound", _W, "a bound that nothing can keep, or nothing can violate"),
    Rule("uses-of-gauge", _W, "`uses` of a signal that is neither a counter nor a level"),
    Rule("requirement-without-subject", _W, "a clause that applies to no node"),
    Rule("limit-too-small", _E, 'a limit that the engine reads as "no limit"'),
    Rule("limit-on-synchronous-node", _W, "a limit on a node that nothing can interrupt"),
    Rule("dead-bound", _W, "a bound that a Timeout around the node, or a tighter bound, makes ineffective"),
    Rule("timeout-never-succeeds", _W, "a Timeout shorter than its child's shortest success"),
    Rule("budget-exceeded", _W, "children that may take more time than their parent allows"),
    Rule("goal-beyond-bound", _W, "a goal that is worse than the bound"),
    Rule("attempts-mismatch", _W, "`tries at most` that does not match the attempts of Retry and Repeat"),
    Rule("contradicting-bounds", _W, "two bounds on one node that cannot both hold"),
    Rule("odds-beyond-children", _W, "a required probability that the requirements of the children do not guarantee"),
    Rule("window-too-small", _W, "a required probability, or a failure rate, that a window of this size cannot show"),
    Rule("rate-without-confidence", _H, "a failure rate that is judged only by its value"),
    Rule("swallowed-failure", _W, "`on violation fail` where a parent continues after the failure"),
    Rule("not-enforced", _W, "`on violation fail` or `halt` where the engine cannot enforce it"),
    Rule("guard-never-renewed", _W, "a guard on a value that no node writes while the guarded node runs"),
    Rule("signal-never-written", _W, "a signal whose entry no port and no script writes"),
    Rule("unused-signal", _H, "a signal that no clause uses"),
    Rule("unused-context", _H, "a context that no condition names"),
    Rule(
        "signal-may-be-unset",
        _W,
        "an enforced condition (a guard) on a signal without an initial value, or on an entry that nothing writes",
    ),
    "Scenarios",
    Rule(
        "impossible-step",
        _E,
        "a step of a scenario that its nodes cannot do, or that does not tell which port it is about",
    ),
    Rule("ambiguous-given", _E, "two givens for one node, and neither is more specific"),
    Rule("expects-nothing", _W, "a scenario that does not say what is expected"),
    Rule("undecidable-expectation", _W, "a scenario that expects of its one run what only many runs can show"),
    "Traps of the engine",
    Rule("reactive-multiple-async", _W, "a reactive node with more than one asynchronous child"),
    Rule("explicit-in-reactive", _E, "an explicit form in XML where the engine requires the node's own tag"),
    Rule(
        "one-shot-monitor",
        _W,
        "a precondition `_failureIf` or `_successIf` on a long-running node: it is checked only when the node starts",
    ),
    Rule("while-skip-is-success", _W, "`_while` halts the node and the parent continues as if it had succeeded"),
    Rule("memory-lost", _W, "a node that needs its memory, below one that resets it before it ticks it again"),
    Rule("last-success-lost", _W, "a node that fails after its last child, even if that succeeds"),
    Rule(
        "stateful-condition",
        _W,
        "an action that is the condition of an IfThenElse or WhileDoElse, and not started again",
    ),
    Rule("unset-without-effect", _W, "the removal of an entry that belongs to another tree, and so stays"),
    Rule(
        "unnoticed-update",
        _W,
        "a copy into an entry whose updates a node waits for; up to 4.6 it does not count as one",
    ),
    Rule("isolated-node", _E, "a SubTree that does not pass the entries that nodes of Nav2 need to be created"),
    Rule("shared-server", _W, "two nodes of Nav2 that may call one action server at the same time"),
    Rule("default-instead", _W, "a value that a node never reads, so that its default counts"),
    Rule(
        "error-code-not-collected", _H, "an error code in an entry that neither a node nor the result of a goal reads"
    ),
    Rule("foreign-error-code", _W, "a condition that looks for the error codes of other actions than its entry has"),
    "What logs show, in editors",
    Rule("requirement-violated", _W, "a requirement that robots have violated, by the logs of the project"),
    Rule("never-exercised", _H, "a requirement about something that no run in the logs of the project did"),
    "Another version",
    Rule("target-breaks", _E, "what the engine or the distribution of `--target` refuses"),
    Rule("target-differs", _W, "what means something else in the engine or the distribution of `--target`"),
    "Parameters of Nav2",
    Rule("yaml-syntax", _E, "a parameter file that is not YAML"),
    Rule("nav2-distribution", _H, "a parameter file of Nav2 that does not tell for which distribution it is"),
    Rule("nav2-parameter", _W, "a parameter of bt_navigator that is misspelt, refused or not read"),
    Rule("unknown-library", _E, "a library of nodes that Nav2 does not have in the distribution"),
    Rule("library-loaded-twice", _E, "a library of nodes that bt_navigator loads twice"),
    Rule("unloaded-node", _E, "a node in a tree of which bt_navigator does not load the library"),
    Rule("missing-nav2-tree", _E, "a tree or a folder that bt_navigator does not find"),
    Rule("skipped-tree-file", _W, "a file in a search directory that bt_navigator skips"),
    Rule("refused-tree-file", _E, "a file that keeps bt_navigator from loading trees"),
    "Traps of the engine",
    Rule("skipped-condition", _W, "a condition of IfThenElse or WhileDoElse that may be skipped: the engine throws"),
    Rule("unreachable-child", _W, "a child that can never run"),
    Rule(
        "condition-without-recheck",
        _H,
        "a condition that cannot interrupt a running node, because the Fallback above it does not check it again",
    ),
)

RULES = {row.name: row for row in _TABLE if isinstance(row, Rule)}

# btq cannot read a file reliably after these mistakes, so neither a selection nor a comment silences them.
UNREADABLE = frozenset(
    (
        *("syntax-error", "inconsistent-indentation", "unclosed-bracket", "unclosed-string", "unclosed-comment"),
        *("misplaced-comment", "unknown-unit", "xml-syntax", "xml-root", "yaml-syntax"),
    )
)
