"""All problems of a script, for the versions of the engine that it must support.

One invariant: diagnostics depend only on the script, the versions and whether a value is expected; keys are unknown
here, so other rules report those that are never written.
"""

from __future__ import annotations

from btq_lang.catalog.versions import NEW_SCRIPTS, VERSIONS
from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.script import mistakes
from btq_lang.syntax.script.tree import Assign, Expression, Number, Script, ScriptText, Ternary, ungrouped
from btq_lang.syntax.script.versions import version_problems
from btq_lang.util.text import Span


def check_script(
    script: Script, *, versions: tuple[str, ...] = VERSIONS, expects_value: bool = False
) -> tuple[Diagnostic, ...]:
    """The diagnostics of a script, in the order of the text; spans and fixes count from its start.

    Args:
        versions: the engines that it must support, such as `4.8` or `4.6.2`.  `script-version` names those that refuse
            the script or read it differently from 4.9 and later.
        expects_value: the engine uses it as a condition: `_skipIf`, the code of a ScriptCondition.

    Raises:
        ValueError: a version is not numbers separated by points.
    """
    is_old = not any(NEW_SCRIPTS.holds(version) for version in versions)
    problems = [each for each in script.problems if not (is_old and is_in_double_quotes(script.text, each.span))]
    if script.complete:
        problems += version_problems(script, versions)
        if expects_value and script.statements:
            problems += _value_problems(script.statements[-1], script.text)
    return tuple(sorted(problems, key=lambda problem: problem.span))


def is_in_double_quotes(text: str, span: Span) -> bool:
    """Whether a place in a script is a string in double quotes, which engines before 4.9 accept."""
    return text[span.start : span.end].startswith('"') and text[span.start + 1 : span.end].endswith('"')


def _value_problems(node: Expression, text: str) -> list[Diagnostic]:
    """Check the last statement, which gives the value: for a condition the engine accepts only 0 and 1."""
    node = ungrouped(node)
    if isinstance(node, Ternary):
        return _value_problems(node.then, text) + _value_problems(node.otherwise, text)
    span = Span(node.start, node.end)
    if isinstance(node, ScriptText):
        return [
            mistakes.error(span, "a condition must evaluate to 0 or 1: with a string, the engine fails at the tick")
        ]
    if isinstance(node, Number) and node.value not in (0, 1):
        return [
            mistakes.error(span, f"a condition must evaluate to 0 or 1: with {node.raw}, the engine fails at the tick")
        ]
    if isinstance(node, Assign):
        return [_assignment_as_condition(node, text)]
    return []


def _assignment_as_condition(node: Assign, text: str) -> Diagnostic:
    start = text.index(node.operator, node.target.end)
    span = Span(start, start + len(node.operator))
    fixes: tuple[Fix, ...] = (replace_fix("Compare with `==`", span, "=="),) if node.operator == "=" else ()
    message = f"this condition ends in an assignment: `{node.operator}` changes the entry"
    if node.operator == "=":
        message += "; to compare, write `==`"
    return Diagnostic("script-error", span, message, fixes=fixes, severity=Severity.WARNING)
