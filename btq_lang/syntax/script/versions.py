"""Scripts that engines before 4.9 refuse, or read differently from 4.9 and later.

One invariant: a script without problems here is read alike by all the given versions, and a fix adds brackets,
blanks or `;` only, so that the newest engine reads the script as before.

Source: BehaviorTree.CPP 4.6.2 and 4.8.4, include/behaviortree_cpp/scripting/operators.hpp, an operator grammar whose
groups "cannot be mixed", and quirks of its ranks, which were found by running it. 4.9.0 replaced it.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations, pairwise, zip_longest
from typing import Final, TypeGuard

from btq_lang.catalog.versions import NEW_SCRIPTS, SCRIPT_RANKS
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.script import tree
from btq_lang.util.record import Record
from btq_lang.util.text import Span


def version_problems(script: tree.Script, versions: Iterable[str]) -> list[Diagnostic]:
    """The differences between `versions`, statement by statement."""
    targets = _targets(versions)
    if not targets.old:
        return []
    problems: list[Diagnostic] = _separators(script, targets)
    scopes: list[tree.Expression] = list(reversed(script.statements))
    while scopes:
        members = _scope(scopes.pop(), scopes)
        problems += _mixed(members, script.text, targets)
        for node, parent in members:
            problems += _node(node, parent, script.text, targets)
    return problems


class _Targets(Record):
    """The versions to support, by their grammar."""

    early: tuple[str, ...]  # before 4.7
    middle: tuple[str, ...]  # 4.7 and 4.8
    old: tuple[str, ...]  # both
    total: int  # how many versions, the newest included


def _targets(versions: Iterable[str]) -> _Targets:
    engines = tuple(versions)
    old = tuple(version for version in engines if not NEW_SCRIPTS.holds(version))
    early = tuple(version for version in old if not SCRIPT_RANKS.holds(version))
    return _Targets(early, tuple(version for version in old if SCRIPT_RANKS.holds(version)), old, len(engines))


def _node(node: tree.Expression, parent: tree.Expression | None, text: str, targets: _Targets) -> Iterable[Diagnostic]:
    """The problems of a single operator or name."""
    if isinstance(node, tree.ScriptBinary):
        rank = tree.RANK[node.operator]
        if node.operator == "||" and isinstance(node.right, tree.ScriptBinary) and node.right.operator == "&&":
            yield _one_rank(node, node.right, text, targets)
        elif rank >= tree.RANK["+"] and not (_is_sum_or_product(parent, rank) and parent.left is node):
            yield from _chain(node, text, targets)
        if node.operator == "..":
            yield from _glued_number(node, text, targets)
    elif isinstance(node, tree.Ternary) and isinstance(parent, tree.Ternary):
        yield _refused(
            _brackets([node]), node, "a `?:` as the last part of another without brackets", targets.old, targets
        )
    elif isinstance(node, tree.Assign) and isinstance(parent, tree.Assign):
        yield _refused(_brackets([node]), node, "two assignments in one without brackets", targets.old, targets)
    elif isinstance(node, tree.Name) and node.name.startswith(("true", "false")):
        yield _refused(None, node, "a name that begins with `true` or `false`", targets.old, targets)
    elif isinstance(node, tree.ScriptText) and not node.value.isascii():
        yield _refused(None, node, "a string with characters outside ASCII", targets.old, targets)


# ---- operators with another precedence in older engines ----


def _one_rank(node: tree.ScriptBinary, conjunction: tree.ScriptBinary, text: str, targets: _Targets) -> Diagnostic:
    """`a || b && c`: the two have equal precedence up to 4.8, and are read from left to right."""
    first: tree.Expression = conjunction
    while isinstance(first, tree.ScriptBinary) and first.operator == "&&":
        first = first.left
    other = f"({text[node.start : first.end]}){text[first.end : node.end]}"
    return _misread(_brackets([conjunction]), node, other, targets.old, text)


def _chain(top: tree.ScriptBinary, text: str, targets: _Targets) -> Iterable[Diagnostic]:
    """`a - b + c`, read from the right by 4.7 and 4.8; `a .. b + c`, where `..` binds less tightly up to 4.6."""
    chain = [top]
    while _is_sum_or_product(left := chain[-1].left, tree.RANK[top.operator]):
        chain.append(left)
    chain.reverse()
    pairs = list(pairwise(chain))
    # From the right a + b - c is the same number, and a - b + c is not.
    from_right = [left for left, node in pairs if left.operator in ("-", "/") and node.operator != ".."]
    if from_right and targets.middle:
        starts = [node.right.start for node in chain[:-1]]
        pieces = (text[start:end] for start, end in zip([top.start, *starts], [*starts, top.end], strict=True))
        yield _misread(_brackets(from_right), top, "(".join(pieces) + ")" * len(starts), targets.middle, text)
    loose = [(left, node) for left, node in pairs if left.operator == ".." and node.operator != ".."]
    if loose and targets.early:
        left, node = loose[0]
        other = f"{text[left.start : left.right.start]}({text[left.right.start : node.end]})"
        yield _misread(_brackets([left for left, _ in loose]), node, other, targets.early, text)


def _is_sum_or_product(node: tree.Expression | None, rank: int) -> TypeGuard[tree.ScriptBinary]:
    return isinstance(node, tree.ScriptBinary) and tree.RANK[node.operator] == rank


# ---- operators that older engines do not mix ----

_ARITHMETIC, _TEXT, _COMPARISON, _BITS = "arithmetic", "text", "comparison", "bits"
_GROUP: Final = {
    **dict.fromkeys(("+", "-", "*", "/"), _ARITHMETIC),
    "..": _TEXT,
    **dict.fromkeys(("&", "|", "^", "~", "!"), _BITS),
}
_Members = list[tuple[tree.Expression, tree.Expression | None]]


def _scope(root: tree.Expression, scopes: list[tree.Expression]) -> _Members:
    """The expressions not separated by brackets, each with its parent; separated ones are added to `scopes`.

    The middle of `a ? b : c` is separate, as if it were in brackets.
    """
    members: _Members = []
    stack: _Members = [(root, None)]
    while stack:
        node, parent = stack.pop()
        if isinstance(node, tree.ScriptGroup):
            scopes.append(node.inner)
            continue
        members.append((node, parent))
        for child in reversed(tree.children(node)):
            if isinstance(node, tree.Ternary) and child is node.then:
                scopes.append(child)
            else:
                stack.append((child, node))
    return members


def _mixed(members: _Members, text: str, targets: _Targets) -> Iterable[Diagnostic]:
    """`a + b == c`, `!a && b == c`: operators of two groups; only `&&`, `||`, `?:` and assignments combine with all."""
    firsts = {group: node for node, _ in reversed(members) if (group := _group(node))}
    if len(firsts) < 2:
        return
    pairs = list(combinations(sorted(firsts, key=lambda group: _place(firsts[group])), 2))
    early = [pair for pair in pairs if targets.early and set(pair) != {_ARITHMETIC, _TEXT}]
    middle = [pair for pair in pairs if targets.middle and _COMPARISON not in pair]
    if both := [pair for pair in early if pair in middle]:
        refusals = [(both[0], targets.old)]
    else:
        refusals = [(early[0], targets.early)] if early else []
        refusals += [(middle[0], targets.middle)] if middle else []
    for pair, refusing in refusals:
        first, second = (_symbol(firsts[group]) for group in pair)
        mixture = f"`{first}` beside `{second}` without brackets"
        yield _refused(_brackets(_to_separate(members)), members[0][0], mixture, refusing, targets)


def _group(node: tree.Expression | None) -> str | None:
    if isinstance(node, tree.ScriptComparison):
        return _COMPARISON
    return _GROUP.get(node.operator) if isinstance(node, tree.Unary | tree.ScriptBinary) else None


def _to_separate(members: _Members) -> list[tree.Expression]:
    """The operators to put in brackets so that one group is left: the comparisons, if there are any."""
    groups = [(node, group, _group(parent)) for node, parent in members if (group := _group(node))]
    outermost = {group for _, group, above in groups if not above}
    kept = outermost if len(outermost) == 1 else {_COMPARISON}
    return [node for node, group, above in groups if (group != above if above else group not in kept)]


def _symbol(node: tree.Expression) -> str:
    if isinstance(node, tree.ScriptComparison):
        return node.operators[0]
    return node.operator if isinstance(node, tree.Unary | tree.ScriptBinary) else ""


def _place(node: tree.Expression) -> int:
    """The approximate place of its operator: after its first operand."""
    return node.start if isinstance(node, tree.Unary) else tree.children(node)[0].end


# ---- between statements ----


def _separators(script: tree.Script, targets: _Targets) -> list[Diagnostic]:
    """Check separators: up to 4.8, exactly one `;` between two statements and none after the last; later any number."""
    problems: list[Diagnostic] = []
    text, statements = script.text, script.statements
    for before, after in zip_longest(statements, statements[1:]):
        end = len(text) if after is None else after.start
        count = text.count(";", before.end, end)
        if after is not None and count == 0:
            fix = Fix("Add the `;`", (FixEdit(Place(Span(before.end, before.end)), ";"),), safe=True)
            problems.append(_refused(fix, after, "a statement without a `;` before it", targets.old, targets))
        elif count > (after is not None):
            first = text.index(";", before.end)
            if after is not None:
                first = text.index(";", first + 1)
            span = Span(first, text.rindex(";", first, end) + 1)
            fix = Fix("Remove it", (FixEdit(Place(span), ""),), safe=True)
            excess = "a `;` after the last statement" if after is None else "more than one `;` between statements"
            problems.append(_refused(fix, span, excess, targets.old, targets))
    return problems


def _glued_number(node: tree.ScriptBinary, text: str, targets: _Targets) -> Iterable[Diagnostic]:
    """`2..'x'`, which older engines read as an invalid number."""
    last = node.left
    while not isinstance(last, tree.ScriptGroup) and (inside := tree.children(last)):
        last = inside[-1]
    if isinstance(last, tree.Number) and text.startswith("..", last.end) and last.raw[:2] not in ("0x", "0X"):
        fix = Fix("Put a space between them", (FixEdit(Place(Span(last.end, last.end)), " "),), safe=True)
        yield _refused(fix, last, "a number with `..` at its end", targets.old, targets)


# ---- wording ----


def _refused(
    fix: Fix | None, place: tree.Expression | Span, what: str, refusing: tuple[str, ...], targets: _Targets
) -> Diagnostic:
    severity = Severity.ERROR if len(refusing) == targets.total else None  # no supported engine would load it
    message = f"{_listed(refusing)} {'refuses' if len(refusing) == 1 else 'refuse'} {what}"
    fixes = () if fix is None else (fix,)
    return Diagnostic("script-version", Span(place.start, place.end), message, fixes=fixes, severity=severity)


def _misread(fix: Fix, node: tree.Expression, other: str, misreading: tuple[str, ...], text: str) -> Diagnostic:
    verb = "reads" if len(misreading) == 1 else "read"
    shown = " ".join(text[node.start : node.end].split())
    message = f"{_listed(misreading)} {verb} `{shown}` as `{' '.join(other.split())}`"
    return Diagnostic("script-version", Span(node.start, node.end), message, fixes=(fix,))


def _brackets(nodes: Iterable[tree.Expression]) -> Fix:
    """Put each of these in brackets; they may be nested."""
    inserted: dict[int, str] = {}
    for node in nodes:
        inserted[node.start] = inserted.get(node.start, "") + "("
        inserted[node.end] = inserted.get(node.end, "") + ")"
    changes = tuple(FixEdit(Place(Span(offset, offset)), inserted[offset]) for offset in sorted(inserted))
    return Fix("Add the brackets", changes, safe=True)


def _listed(versions: tuple[str, ...]) -> str:
    return versions[0] if len(versions) == 1 else f"{', '.join(versions[:-1])} and {versions[-1]}"
