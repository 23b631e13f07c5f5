"""What a value at the cursor measures: what the verb demands, or the signal or parameter that it is compared with."""

from __future__ import annotations

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.units import parse_unit
from btq_lang.catalog.verbs import VERBS, measured
from btq_lang.ide.clause_words import is_window, last_index
from btq_lang.ide.meaning import entry_at
from btq_lang.ide.place import CursorPlace
from btq_lang.syntax.tokens import NAME
from btq_lang.syntax.tree import Claim, Requirement, Signal, is_name
from btq_lang.util.record import Record
from btq_lang.workspace.workspace import Workspace


class MeasuredValue(Record):
    """What a value measures.

    Attributes:
        unit: the unit, or one of its dimension; None if it is unknown.
        is_certain: whether a value of another dimension is wrong; else what follows may make it right.
    """

    unit: str | None = None
    is_certain: bool = False

    def fits(self, unit: str) -> bool:
        """Whether a value in a unit may be meant; one without a unit may."""
        if self.unit is None or not unit:
            return True
        own, other = parse_unit(self.unit), parse_unit(unit)
        return self.unit == unit if own is None or other is None else own.dimension == other.dimension


def measured_at(workspace: Workspace, path: str, place: CursorPlace) -> MeasuredValue:
    """What a value measures at a place of a clause, of a signal, or of a requirement's argument."""
    declared = _of_argument(workspace, path, place) or _of_first_value(workspace, path, place)
    if declared is not None:
        return MeasuredValue(declared, is_certain=True)
    words = [word.text for word in place.words]
    if words[-1:] == ["goal"] or words[-2:-1] == ["goal"]:
        return _of_goal(workspace, path, place)
    unit = "s" if is_window(words) else measured(words)
    if unit is not None:
        return MeasuredValue(unit, is_certain=True)
    parameters = parameters_at(place)
    for word in reversed(place.words):
        if word.text in ("*", "/", "and", "or"):
            return MeasuredValue()
        if word.kind == NAME and (unit := parameters.get(word.text) or _signal_unit(workspace, path, word.text)):
            return MeasuredValue(unit)
    return MeasuredValue()


def parameters_at(place: CursorPlace) -> dict[str, str]:
    """The parameters of the requirement around a place, with their units: `QualityReq slow(limit : m/s)`."""
    line = next((line for line in (place.words, place.parent) if any(word.text == "QualityReq" for word in line)), ())
    texts = [word.text for word in line]
    opened = texts.index("(") + 1 if "(" in texts else len(texts)
    closed = texts.index(")", opened) if ")" in texts[opened:] else len(texts)
    units: dict[str, str] = {}
    for parameter in "".join(texts[opened:closed]).split(","):
        name, colon, remainder = parameter.partition(":")
        if colon and is_name(name):
            units[name] = remainder.partition("=")[0]
    return units


def _of_argument(workspace: Workspace, path: str, place: CursorPlace) -> str | None:
    """The unit of the parameter whose argument or default is being written."""
    words = [word.text for word in place.group] if place.callee else []
    equals = last_index(words, "=")
    if equals < 1 or next((word for word in reversed(words[equals:]) if word in ("if", "else", ",")), "") == "if":
        return None  # operands of a condition are not arguments
    if place.is_of_parameters:
        return parameters_at(place).get(words[last_index(words[:equals], ":") - 1])
    item = workspace.scope(path).target(Kind.REQUIREMENT, place.callee)
    parameters = item.parameters if isinstance(item, Requirement) else ()
    return next((one.unit.text for one in parameters if one.unit and one.name.text == words[equals - 1]), None)


def _of_first_value(workspace: Workspace, path: str, place: CursorPlace) -> str | None:
    """The unit of the signal whose value before the first reading is being written."""
    words = place.words
    if len(words) < 2 or words[0].text != "signal" or "initially" not in (words[-1].text, words[-2].text):
        return None
    return _signal_unit(workspace, path, words[1].text)


def _of_goal(workspace: Workspace, path: str, place: CursorPlace) -> MeasuredValue:
    """The unit of a goal: that of the bound of its claim, perhaps on another line."""
    entry = entry_at(workspace, path, place.span.start)
    clauses = entry.item.clauses if entry is not None and isinstance(entry.item, Requirement) else ()
    verbs = {clause.verb.raw for clause in clauses if isinstance(clause, Claim)} | {word.text for word in place.words}
    is_of_time = any(verb in VERBS and VERBS[verb].limits for verb in verbs)
    return MeasuredValue("s", is_certain=True) if is_of_time else MeasuredValue()


def _signal_unit(workspace: Workspace, path: str, name: str) -> str | None:
    item = workspace.scope(path).target(Kind.SIGNAL, name)
    return item.unit.text if isinstance(item, Signal) and item.unit is not None else None
