"""What every test of the lexer and the parser asserts, and how it writes down what it expects.

`assert_parse(text, tree, *problems)` is the one entry: whatever a test is about, the text also goes through
`assert_invariants`, the promises that hold for every text.  A tree is written as an outline, `dump` shows how; a
problem as `line:column rule «the text it points at» message`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import singledispatch
from textwrap import dedent, indent

from btq_lang.diagnostics.model import Diagnostic, Fix
from btq_lang.diagnostics.rules import RULES
from btq_lang.parser import Parsed, parse
from btq_lang.syntax.tokens import DEDENT, INDENT, QUANTITY, STRING, Token
from btq_lang.syntax.tree import (
    Amount,
    AnyEvent,
    Apply,
    Approval,
    Average,
    Because,
    Between,
    Binary,
    Bound,
    Bounded,
    Call,
    Claim,
    Clause,
    Comparison,
    Condition,
    Confidence,
    Context,
    EachEvent,
    Entry,
    Event,
    Every,
    FromUntil,
    Goal,
    Hazard,
    HazardClause,
    HazardSeverity,
    How,
    Include,
    Item,
    Meta,
    Mission,
    Mitigates,
    Model,
    Models,
    Negative,
    Node,
    NodeClause,
    NodeRuns,
    Not,
    Odds,
    OnViolation,
    Operand,
    Pair,
    Path,
    Port,
    Priority,
    Qualities,
    QualityDecl,
    QualityPath,
    Refines,
    ReqRef,
    Requirement,
    Root,
    SatisficedQuality,
    Satisfies,
    ScopeClause,
    Selector,
    Signal,
    SkippedLines,
    Source,
    Subject,
    Sum,
    Table,
    Tags,
    Tree,
    Verbatim,
    Window,
    Word,
)
from btq_lang.util.text import Edit, LineIndex, apply_edits

MISSING = "MISSING"


def assert_parse(text: str, tree: str | None = None, *problems: str) -> Parsed:
    """Parse a text: its outline and all its problems are exactly these, and the invariants hold.

    Args:
        text: the file; a common indentation and the line end before it are not part of it.
        tree: its outline, or None where a test is not about the tree.
        problems: what is wrong with it, in order.
    """
    text = written(text)
    parsed = parse(text)
    assert_invariants(parsed)
    if len(parsed.diagnostics) == 1:  # fixing one of several mistakes on a line reveals the next
        assert_safe_fixes(parsed)
    assert_same(show_problems(text, parsed.diagnostics), "\n".join(problems))
    if tree is not None:
        assert_same(dump(parsed), dedent(tree).strip("\n"))
    return parsed


def assert_same(found: str, expected: str) -> None:
    """Equal, or both shown in full."""
    assert found == expected, f"\n---- found:\n{found}\n---- expected:\n{expected}"


def assert_fix(text: str, title: str, fixed: str, *, safe: bool = False) -> None:
    """The text has one problem, one of its fixes has this title, and applying it makes this of the text."""
    text = written(text)
    parsed = parse(text)
    assert_invariants(parsed)
    assert len(parsed.diagnostics) == 1
    (fix,) = (fix for fix in parsed.diagnostics[0].fixes if fix.title == title)
    assert (apply_fix(text, fix), fix.safe) == (written(fixed), safe)


def written(text: str) -> str:
    """A text as a test writes it: without the line end in front and the indentation that all its lines share."""
    return dedent(text[1:]) if text.startswith("\n") else text


# ---- invariants -----------------------------------------------------------------------------------------------------


def assert_invariants(parsed: Parsed) -> None:
    """What holds for every text (architecture: invariants)."""
    assert_tokens(parsed)
    assert_entries(parsed)
    assert_diagnostics(parsed)
    assert parsed.diagnostics or not any(map(_is_cut_off, parsed.tokens)), "a string without an end and nothing said"


def _is_cut_off(token: Token) -> bool:
    return token.kind == STRING and (len(token.text) == 1 or token.text[0] != token.text[-1])


def assert_tokens(parsed: Parsed) -> None:
    """No character is lost or repeated, and every block that opens is closed."""
    at = depth = 0
    for token in parsed.tokens:
        assert token.start == at
        at = token.end
        depth += (token.kind == INDENT) - (token.kind == DEDENT)
        assert depth >= 0
    assert depth == 0
    assert "".join(token.text for token in parsed.tokens) == parsed.text


def assert_entries(parsed: Parsed) -> None:
    """Items follow each other; what is in an item lies in it, at the offset it claims."""
    starts = [entry.start for entry in parsed.entries]
    before = 0
    for entry, end in zip(parsed.entries, [*starts[1:], len(parsed.text)], strict=False):
        assert before <= entry.start <= end <= len(parsed.text)
        before = entry.start
        assert_nested(entry.item, entry.start, end, parsed.text)


def assert_nested(item: Item, start: int, end: int, text: str) -> None:
    """An item lies between two offsets, and every part in the one around it, those of a list in their order."""
    base = start
    left: list[tuple[object, int, int]] = [(item, start, end)]
    while left:
        part, start, end = left.pop()
        if isinstance(part, Word):
            assert start <= base + part.start <= base + part.end <= end
            assert text[base + part.start : base + part.end] == part.raw
        elif isinstance(part, tuple):
            for element in part:
                left.append((element, start, end))
                if (bounds := extent(element)) is not None:
                    start = base + bounds[1]
        elif hasattr(part, "__slots__"):
            if (bounds := extent(part)) is not None:
                assert start <= base + bounds[0] <= base + bounds[1] <= end
                start, end = base + bounds[0], base + bounds[1]
            left += [(getattr(part, name), start, end) for name in part.__slots__]


def extent(part: object) -> tuple[int, int] | None:
    """The span of a part, its block included; None if it is not a part, or has no span."""
    if isinstance(part, Node):
        return part.start, part.block_end
    if isinstance(part, Word | Pair | Path | QualityPath):
        return part.span.start, part.span.end
    if isinstance(part, tuple) or part is None or isinstance(part, str | int):
        return None
    own = (part.start, part.end) if hasattr(part, "start") and hasattr(part, "end") else None
    inner = [bounds for piece in pieces(part) if (bounds := extent(piece)) is not None]
    if isinstance(part, Tree | Model | Models) or own is None:  # their `end` is that of their first line
        inner += [own] if own is not None else []
        return (min(start for start, _ in inner), max(end for _, end in inner)) if inner else None
    return own


def pieces(part: object) -> Iterator[object]:
    for name in getattr(part, "__slots__", ()):
        value = getattr(part, name)
        yield from value if isinstance(value, tuple) else (value,)


def assert_diagnostics(parsed: Parsed) -> None:
    """A diagnostic has a rule, lies in the text, and each of its fixes can be applied; a safe one mends it."""
    size = len(parsed.text)
    for diagnostic in parsed.diagnostics:
        assert diagnostic.rule in RULES
        assert 0 <= diagnostic.span.start <= diagnostic.span.end <= size
        assert "\n" not in diagnostic.message
        for related in diagnostic.related:
            assert 0 <= related.place.span.start <= related.place.span.end <= size
        for fix in diagnostic.fixes:
            assert all(0 <= change.place.span.start <= change.place.span.end <= size for change in fix.changes)
            assert apply_fix(parsed.text, fix) != parsed.text


def assert_safe_fixes(parsed: Parsed) -> None:
    """A safe fix removes its diagnostic and adds none."""
    before = [diagnostic.rule for diagnostic in parsed.diagnostics]
    for diagnostic in parsed.diagnostics:
        for fix in diagnostic.fixes:
            if fix.safe:
                after = [left.rule for left in parse(apply_fix(parsed.text, fix)).diagnostics]
                after.append(diagnostic.rule)
                assert sorted(after) == sorted(before), fix.title


def apply_fix(text: str, fix: Fix) -> str:
    return apply_edits(text, [Edit(change.place.span, change.text) for change in fix.changes])


# ---- problems as text -----------------------------------------------------------------------------------------------


def show_problems(text: str, diagnostics: Sequence[Diagnostic]) -> str:
    """One line a diagnostic; lines and columns count from 1."""
    lines = LineIndex(text)
    shown = []
    for diagnostic in diagnostics:
        line, column = lines.position(diagnostic.span.start)
        pointed = text[diagnostic.span.start : diagnostic.span.end]
        shown.append(f"{line + 1}:{column + 1} {diagnostic.rule} «{escaped(pointed)}» {diagnostic.message}")
    return "\n".join(shown)


def escaped(text: str) -> str:
    return text.replace("\n", "\\n").replace("\r", "\\r")


# ---- the tree as an outline -----------------------------------------------------------------------------------------


def dump(parsed: Parsed) -> str:
    """The tree of a file, one line for each item, node, port and requirement's clause.

    Words stand as they are written, but a quantity without blanks; what is missing is MISSING; in conditions brackets
    show what belongs together: `(and a (b < 3s))`, `(+ a b)`.
    """
    return "\n".join(indent(show_item(entry.item), "  " * entry.in_root) for entry in parsed.entries if shown(entry))


def shown(entry: Entry) -> bool:
    """The empty item after the last one only carries diagnostics."""
    return not (isinstance(entry.item, SkippedLines) and entry.item.start == entry.item.end)


def words(*parts: object) -> str:
    """The parts that say something, with blanks between."""
    return " ".join(str(part) for part in parts if part is not None and part != "")


def block(head: str, *parts: str) -> str:
    return "\n".join([head, *(indent(part, "  ") for part in parts)])


def show(word: Word | None) -> str:
    if word is None:
        return MISSING
    return "".join(word.raw.split()) if word.kind == QUANTITY else escaped(word.raw)


def show_optional(word: Word | None, before: str = "") -> str:
    return "" if word is None else f"{before}{show(word)}"


@singledispatch
def show_item(item: Item | Port | Meta | Node) -> str:
    raise TypeError(f"{type(item).__name__} has no outline")


@show_item.register
def _(item: Include) -> str:
    return words("include", show(item.path), show_pairs(item.attributes))


@show_item.register
def _(item: Qualities) -> str:
    return words("qualities", show(item.edition))


@show_item.register
def _(item: QualityDecl) -> str:
    parent = f": {show_quality(item.parent)}" if item.parent else ""
    return words("quality", show(item.name), parent, show_optional(item.text))


@show_item.register
def _(item: Hazard) -> str:
    head = words("hazard", show(item.name), show_optional(item.text))
    return block(head, *map(show_clause, item.clauses))


@show_item.register
def _(item: Models) -> str:
    return block("models", *(show_item(model) for model in item.models))


@show_item.register
def _(item: Model) -> str:
    head = words("model", show(item.category), show(item.name), show_pairs(item.attributes), show_optional(item.text))
    return block(head, *(show_item(part) for part in item.body))


@show_item.register
def _(item: Meta) -> str:
    return words("metadata", show_pairs(item.attributes))


@show_item.register
def _(item: Port) -> str:
    return words(
        show(item.direction),
        show_optional(item.name),
        show_optional(item.type, ": "),
        show_optional(item.default, "= "),
        show_pairs(item.attributes),
        show_optional(item.text),
    )


@show_item.register
def _(item: Verbatim) -> str:
    return words("xml", show(item.text))


@show_item.register
def _(item: Signal) -> str:
    return words(
        "signal",
        show(item.name),
        ":",
        show(item.unit),
        show_optional(item.source, "from "),
        show_optional(item.behaviour),
        show_optional(item.fresh, "fresh within "),
        f"initially {show_amount(item.initially)}" if item.initially else "",
    )


@show_item.register
def _(item: Context) -> str:
    return words("context", show(item.name), ":", show_condition(item.condition))


@show_item.register
def _(item: Requirement) -> str:
    return block(f"requirement {show_requirement_head(item)}", *map(show_clause, item.clauses))


@show_item.register
def _(item: Apply) -> str:
    targets = ", ".join(map(show_selector, item.targets)) or MISSING
    exceptions = ", ".join(map(show_selector, item.exceptions))
    uses = ", ".join(map(show_use, item.uses)) or MISSING
    return words("apply", uses, "to", targets, f"except {exceptions}" if exceptions else "")


@show_item.register
def _(item: Root) -> str:
    return words("root", show_optional(item.name), show_pairs(item.attributes) or ("()" if item.bracketed else ""))


@show_item.register
def _(item: Tree) -> str:
    head = words("tree", show_optional(item.name), show_pairs(item.attributes))
    clauses = map(show_node_clause, item.clauses)
    return block(head, *map(show_item, item.ports), *clauses, *map(show_item, item.children))


@show_item.register
def _(item: Node) -> str:
    head = words(
        show_optional(item.category),
        show_optional(item.kind),
        show_optional(item.label, "as "),
        show_pairs(item.attributes),
    )
    return block(head, *map(show_node_clause, item.clauses), *map(show_item, item.children))


@show_item.register
def _(item: SkippedLines) -> str:
    return "skipped"


def show_pairs(pairs: tuple[Pair, ...]) -> str:
    return f"({' '.join(f'{show(pair.key)}={show(pair.value)}' for pair in pairs)})" if pairs else ""


def show_selector(selector: Selector) -> str:
    path = show_path(selector.path) if selector.path else ""
    if selector.tag:
        return words("every node tagged", show(selector.tag))
    if selector.every:
        return words("every", show(selector.every), f"under {path}" if path else "")
    return path or MISSING


# ---- qualities and requirements -------------------------------------------------------------------------------------


def show_node_clause(clause: NodeClause) -> str:
    if isinstance(clause, Tags):
        return words("tags", ", ".join(map(show, clause.names)) or MISSING)
    if isinstance(clause, Satisfies):
        return words("satisfies", ", ".join(map(show_use, clause.uses)) or MISSING)
    return words("satisfices", ", ".join(map(show_concern, clause.qualities)) or MISSING)


def show_concern(quality: SatisficedQuality) -> str:
    inner = " ".join(f"[{show_use(requirement)}]" for requirement in quality.requirements)
    return words(show_quality(quality.path), inner)


def show_quality(path: QualityPath | None) -> str:
    return ".".join(map(show, path.names)) if path else MISSING


def show_use(use: Requirement | ReqRef) -> str:
    """A requirement defined in place is `{…}`."""
    if isinstance(use, Requirement):
        return "{" + "; ".join([show_requirement_head(use), *map(show_clause, use.clauses)]) + "}"
    arguments = ", ".join(f"{show(argument.name)}={show_bounded(argument.value)}" for argument in use.arguments)
    return show(use.name) + (f"({arguments})" if arguments else "")


def show_requirement_head(requirement: Requirement) -> str:
    parameters = ", ".join(
        words(show(parameter.name), ":", show(parameter.unit), f"= {show_bounded(default)}" if default else "")
        for parameter in requirement.parameters
        for default in (parameter.default,)
    )
    return words(
        "classic" if requirement.classic else "",
        show(requirement.name) + (f"({parameters})" if parameters else ""),
        f": {' and '.join(map(show_quality, requirement.qualities))}" if requirement.quality else "",
        show_optional(requirement.text),
    )


@singledispatch
def show_clause(clause: Clause | HazardClause) -> str:
    raise TypeError(f"{type(clause).__name__} has no outline")


@show_clause.register
def _(clause: Claim) -> str:
    verb = clause.verb.raw
    parts = [show_subject(clause.subject) if clause.subject else "", verb, "every" if clause.every else ""]
    if clause.bound or verb not in ("needs", "keeps", "never", "leaves", "succeeds", "follows", "followed"):
        parts.append(show_bound(clause.bound))
    if clause.condition or verb in ("needs", "keeps", "never", "leaves"):
        parts.append(show_condition(clause.condition))
    if clause.resource or verb == "uses":
        parts.append(f"of {show(clause.resource)}")
    if clause.per or clause.form or (verb == "runs" and not clause.every):
        parts.append(f"per {show_path(clause.per) if isinstance(clause.per, Path) else show(clause.per)}")
    if clause.of is not None:
        parts.append(f"of {show_path(clause.of)}")
    if clause.event or (verb in ("starts", "ends", "follows") and not clause.form):
        parts += ["after" if verb in ("starts", "ends") else "", show_event(clause.event)]
    return words(*parts)


@show_clause.register
def _(_: Average) -> str:
    return "on average"


@show_clause.register
def _(clause: ScopeClause) -> str:
    return words(show(clause.word), show_condition(clause.condition))


@show_clause.register
def _(clause: FromUntil) -> str:
    return words("from", show_event(clause.first), "until", show_event(clause.last))


@show_clause.register
def _(clause: Odds) -> str:
    return words("odds", clause.relation, show(clause.value), show_optional(clause.experiments, "of "))


@show_clause.register
def _(clause: Confidence) -> str:
    return words("confidence", show(clause.value))


@show_clause.register
def _(clause: Window) -> str:
    return words("over last", show(clause.size), show_optional(clause.experiments))


@show_clause.register
def _(clause: OnViolation) -> str:
    return words("on violation", show(clause.action))


@show_clause.register
def _(clause: Goal) -> str:
    return words("goal", show_bounded(clause.value))


@show_clause.register
def _(clause: Because) -> str:
    return words("because", show(clause.text))


@show_clause.register
def _(clause: How) -> str:
    return words(
        "verified by", ", ".join(words(show(way.method), show_optional(way.id)) for way in clause.ways) or MISSING
    )


@show_clause.register
def _(clause: Source) -> str:
    return words("source", show(clause.text))


@show_clause.register
def _(clause: Refines) -> str:
    return words("refines", ", ".join(map(show, clause.names)) or MISSING)


@show_clause.register
def _(clause: Mitigates) -> str:
    return words("mitigates", ", ".join(map(show, clause.names)) or MISSING)


@show_clause.register
def _(clause: Priority) -> str:
    return words("priority", show(clause.tag))


@show_clause.register
def _(clause: HazardSeverity) -> str:
    return words("severity", show(clause.tag))


@show_clause.register
def _(clause: Approval) -> str:
    return words("approved by", show(clause.by), "on", show(clause.on), show_optional(clause.of, "of "))


def show_subject(subject: Subject) -> str:
    """In angle brackets, so that it is seen where it ends."""
    if isinstance(subject, Mission):
        inner = "mission"
    elif isinstance(subject, Every):
        inner = f"every {show(subject.name)}"
    elif isinstance(subject, Sum):
        inner = f"sum of {', '.join(map(show_path, subject.paths)) or MISSING}"
    elif isinstance(subject, Between):
        inner = f"from {show_event(subject.first)} to {show_event(subject.last)}"
    elif isinstance(subject, EachEvent):
        inner = f"each {show_event(subject.event)}"
    else:
        inner = show_path(subject)
    return f"<{inner}>"


def show_path(path: Path | None) -> str:
    return "/".join(map(show, path.names)) if path else MISSING


def show_event(event: Event | AnyEvent | None) -> str:
    if event is None:
        return MISSING
    if isinstance(event, AnyEvent):
        return " or ".join(map(show_event, event.atoms))
    if event.happening == "when":
        return words("when", show_condition(event.condition))
    return words(show_path(event.path) if event.path else "(mission)", event.happening)


def show_bound(bound: Bound | None) -> str:
    if bound is None:
        return MISSING
    if bound.relation == "between":
        return words("between", show_bounded(bound.value), show_amount(bound.upper))
    return words(bound.relation, show_bounded(bound.value))


def show_bounded(value: Bounded | None) -> str:
    if not isinstance(value, Table):
        return show_amount(value)
    cases = [words(show_amount(case.value), f"if {show_condition(case.condition)}") for case in value.cases]
    cases += [words(show_amount(value.otherwise), "else")] if value.otherwise else []
    return f"[{', '.join(cases)}]"


def show_amount(amount: Amount | None) -> str:
    if amount is None:
        return MISSING
    return ("-" if amount.negative else "") + show(amount.word)


@singledispatch
def show_condition(condition: Condition | None) -> str:
    return MISSING


@show_condition.register
def _(condition: Operand) -> str:
    return show(condition.word)


@show_condition.register
def _(condition: Call) -> str:
    return f"({show(condition.function)} {show(condition.signal)})"


@show_condition.register
def _(condition: NodeRuns) -> str:
    return f"(node {show_path(condition.path)})"


@show_condition.register
def _(condition: Negative) -> str:
    return f"(- {show_condition(condition.operand)})"


@show_condition.register
def _(condition: Not) -> str:
    return f"(not {show_condition(condition.operand)})"


@show_condition.register
def _(condition: Binary) -> str:
    return f"({condition.operator} {show_condition(condition.left)} {show_condition(condition.right)})"


@show_condition.register
def _(condition: Comparison) -> str:
    operands = list(map(show_condition, condition.operands))
    signs = [sign for pair in zip(operands, [*condition.operators, ""], strict=True) for sign in pair if sign]
    return f"({' '.join(signs)})"
