"""What a script does: the values of its expressions, and what it writes.

Source: facts about BehaviorTree.CPP 4.6 to 4.10, seen in runs of the engine.
"""

from __future__ import annotations

import re
from math import inf, nan
from typing import Final

from btq_lang.simulator.blackboard import UNTYPED, Board, BoardEntry, Unknown, Value, copied, parsed, whole
from btq_lang.simulator.errors import EngineError
from btq_lang.syntax.script.tree import (
    Assign,
    Bool,
    Expression,
    Name,
    Number,
    Script,
    ScriptBinary,
    ScriptComparison,
    ScriptText,
    Ternary,
    Unary,
    ungrouped,
)


def run_script(script: Script, board: Board, has_real_truth: bool) -> Value | None:
    """Run the statements of a script; the value of the last one, None if that is an empty entry.

    Args:
        has_real_truth: `true` is a real number (since 4.9), rather than a whole one.

    Raises:
        EngineError: as in the engine; the effects of earlier statements stay.
    """
    value: Value | None = None
    try:
        for statement in script.statements:
            value = evaluate(statement, board, has_real_truth)
    except EngineError as error:
        raise EngineError(f"Error in script [{script.text}]\n{error}") from None
    return value


def holds(script: Script, board: Board, has_real_truth: bool) -> bool:
    """Whether the value of a script is true.

    Raises:
        EngineError: also where the value is neither a real number nor 0 or 1.
    """
    value = run_script(script, board, has_real_truth)
    if value is None:
        raise EngineError("Any::cast failed because it is empty")
    return truth(value)


def truth(value: Value) -> bool:
    """A value as a condition.

    Raises:
        EngineError: it is a text, or a whole number other than 0 and 1.
    """
    if isinstance(value, Unknown):
        return bool(value)
    if isinstance(value, float):
        return value != 0
    if isinstance(value, str):
        raise EngineError("[Any::convert]: no known safe conversion between [std::string] and [bool]")
    if value not in (0, 1):
        raise EngineError("Implicit casting to bool is not allowed")
    return value == 1


def evaluate(node: Expression, board: Board, has_real_truth: bool) -> Value | None:
    """The value of an expression; None: that of an empty entry."""
    node = ungrouped(node)
    if isinstance(node, Number):
        return node.value
    if isinstance(node, ScriptText):
        return node.value
    if isinstance(node, Bool):
        return float(node.value) if has_real_truth else int(node.value)
    if isinstance(node, Name):
        entry = board.entry(node.name)
        if entry is None:
            raise EngineError(f"Variable not found: {node.name}")
        return entry.value
    if isinstance(node, ScriptComparison):
        return _compared(node, board, has_real_truth)
    if isinstance(node, ScriptBinary):
        left = evaluate(node.left, board, has_real_truth)
        right = evaluate(node.right, board, has_real_truth)
        return combined(node.operator, _set(left, "left", node.operator), _set(right, "right", node.operator))
    if isinstance(node, Unary):
        operand = evaluate(node.operand, board, has_real_truth)
        if operand is None or isinstance(operand, str):
            raise EngineError("Invalid operator for std::string" if operand else "ExprUnaryArithmetic: undefined")
        return _negated(node.operator, operand)
    if isinstance(node, Ternary):
        condition = evaluate(node.condition, board, has_real_truth)
        is_true = bool(condition) if isinstance(condition, Unknown) else _real(condition) != 0
        branch = node.then if is_true else node.otherwise
        return evaluate(branch, board, has_real_truth)
    assert isinstance(node, Assign), "the last kind of expression; brackets are gone"
    return _assigned(node, board, has_real_truth)


def _set(value: Value | None, side: str, operator: str) -> Value:
    if value is None:
        raise EngineError(f"The {side} operand of the operator [{operator}] is not initialized")
    return value


def _compared(node: ScriptComparison, board: Board, has_real_truth: bool) -> float:
    """A chain of comparisons, which ends at the first that is false."""
    left = evaluate(node.operands[0], board, has_real_truth)
    for operator, operand in zip(node.operators, node.operands[1:], strict=True):
        right = evaluate(operand, board, has_real_truth)
        if not compared(_set(left, "left", operator), operator, _set(right, "right", operator)):
            return 0.0
        left = right
    return 1.0


def compared(first: Value, operator: str, second: Value) -> bool:
    """Whether a comparison of two values holds.

    Raises:
        EngineError: a text is compared with a number, and cannot be read as one.
    """
    if isinstance(first, Unknown):
        return first.compared(operator, second)
    if isinstance(second, Unknown):
        return second.compared(_TURNED.get(operator, operator), first)
    if isinstance(first, str) and isinstance(second, str):
        return _is_true(operator, first == second, first >= second, first <= second)
    low, high = as_number(first), as_number(second)
    return _is_true(operator, abs(low - high) <= EPSILON, low >= high, low <= high)


def _is_true(operator: str, is_same: bool, is_at_least: bool, is_at_most: bool) -> bool:
    """Whether a comparison holds; `is_same`: within the engine's tolerance, which only `==` and `!=` have."""
    if operator == "==":
        return is_same
    if operator == "!=":
        return not is_same
    if operator == "<":
        return not is_at_least
    if operator == ">":
        return not is_at_most
    return is_at_most if operator == "<=" else is_at_least


def as_number(value: Value) -> float:
    """A value that is compared with a number."""
    if not isinstance(value, str):
        return float(value)
    if value in ("true", "false"):
        return float(value == "true")
    return leading_number(value)


def leading_number(text: str) -> float:
    """The number with which a text begins, as `std::from_chars` reads it.

    Raises:
        EngineError: it begins with none.
    """
    match = NUMBER.match(text)
    if match is None:
        raise EngineError("Any failed string to number conversion")
    return float(match[0])


def _real(value: Value | None) -> float:
    if value is None:
        raise EngineError("Any::cast failed because it is empty")
    return leading_number(value) if isinstance(value, str) else float(value)


def combined(operator: str, left: Value, right: Value) -> Value:
    """The value of an operator's two operands.

    Raises:
        EngineError: the operator does not take such operands.
    """
    if operator not in ("&&", "||"):
        if isinstance(left, Unknown):
            return left.combined(operator, right, is_left=True)
        if isinstance(right, Unknown):
            return right.combined(operator, left, is_left=False)
    if isinstance(left, str) or isinstance(right, str):
        are_texts = isinstance(left, str) and isinstance(right, str)
        if (operator == "+" and are_texts) or operator == "..":
            return text_of(left) + text_of(right)
        raise EngineError("Operation not permitted")
    if operator in ("&&", "||"):
        try:
            both = truth(left), truth(right)
        except EngineError:
            message = "Logic operators are not allowed if one of the operands is not castable to bool"
            raise EngineError(message) from None
        return float(all(both) if operator == "&&" else any(both))
    first, second = float(left), float(right)
    if operator == "+":
        return first + second
    if operator == "-":
        return first - second
    if operator == "*":
        return first * second
    if operator == "/":
        return _quotient(first, second)
    if operator == "..":
        raise EngineError("Operation not permitted")
    try:
        bits = whole(left), whole(right)
    except EngineError:
        message = "Binary operators are not allowed if one of the operands is not an integer"
        raise EngineError(message) from None
    if operator == "&":
        return float(bits[0] & bits[1])
    return float(bits[0] | bits[1] if operator == "|" else bits[0] ^ bits[1])


def _negated(operator: str, operand: float | Unknown) -> Value:
    """The value of `-x`, `~x` or `!x`."""
    if isinstance(operand, Unknown) and operator == "!":
        return float(not operand)
    if isinstance(operand, Unknown):
        return operand.combined("-", 0, is_left=False)
    if operator == "-":
        return -float(operand)
    return float(~int(operand)) if operator == "~" else float(operand == 0)


def _quotient(left: float, right: float) -> float:
    """A quotient of IEEE 754: by zero it is infinite, or no number."""
    if right != 0:
        return left / right
    if left == 0 or left != left:
        return nan
    return inf if (left > 0) == (str(right)[0] != "-") else -inf


def text_of(value: Value) -> str:
    """A value as a text, as `std::to_string` writes it."""
    return f"{value:.6f}" if isinstance(value, float) else str(value)


def _assigned(node: Assign, board: Board, has_real_truth: bool) -> Value:
    """Write to an entry; its new value."""
    target = ungrouped(node.target)
    if not isinstance(target, Name):
        raise EngineError("Assignment left operand not a blackboard entry")
    entry = board.entry(target.name)
    if entry is None:
        if node.operator != ":=":
            raise EngineError(
                f"The blackboard entry [{target.name}] doesn't exist, yet.\n"
                "If you want to create a new one, use the operator [:=] instead of [=]"
            )
        entry = board.create(target.name)
    value = _set(evaluate(node.value, board, has_real_truth), "right", node.operator)
    if node.operator in (":=", "="):
        entry.value = _first(entry, value) if entry.value is None else _next(entry, value)
    else:
        entry.value = _changed(entry, node.operator, value)
    entry.number += 1
    return entry.value


def _first(entry: BoardEntry, value: Value) -> Value:
    """What an empty entry holds after an assignment."""
    return parsed(value, entry.type) if isinstance(value, str) and entry.type else value


def _next(entry: BoardEntry, value: Value) -> Value:
    """What an entry with a value holds after an assignment: it stays of its kind, but a text turns into a number."""
    if isinstance(entry.value, Unknown):
        return _first(entry, value)
    if isinstance(value, str) and not isinstance(entry.value, str):
        return as_number(value) if entry.type == UNTYPED else parsed(value, entry.type)
    return copied(value, entry.value)


def _changed(entry: BoardEntry, operator: str, value: Value) -> Value:
    """What an entry holds after `+=` and its like."""
    old = _set(entry.value, "left", operator)
    if isinstance(old, Unknown) or isinstance(value, Unknown):
        return combined(operator[0], old, value)
    if isinstance(value, str):
        if operator != "+=" or not isinstance(old, str):
            raise EngineError("This Assignment operator can't be used with a non-numeric type")
        return old + value
    if isinstance(old, str):
        raise EngineError("This Assignment operator can't be used with a non-numeric type")
    return copied(combined(operator[0], float(old), float(value)), old)


_TURNED: Final = {"<": ">", ">": "<", "<=": ">=", ">=": "<="}
EPSILON: Final = 2.0**-23  # of a float
NUMBER: Final = re.compile(r"-?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|-?(?:inf|nan)")
