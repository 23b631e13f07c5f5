"""Parameters of bt_navigator that only other distributions read, or that one refuses, and keys around them.

Not known here: names that no distribution has (`unknown.py`).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.catalog.nav2.navigator import BOOLEAN, DOUBLE, INTEGER, NAVIGATORS, OWN_PACKAGE, PARAMETERS, STRINGS
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.nav2.parameters import NODE, Parameters
from btq_lang.nav2.yaml_reader import YamlValue
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Span


def file_findings(parameters: Parameters) -> Iterator[Diagnostic]:
    """What keeps bt_navigator from finding its parameters, in any distribution."""
    for wrong, right in parameters.misspelt:
        message = f"unknown key `{wrong.text}`{did_you_mean((right,))}"
        notes = ("no node that is given this file starts",) if right != NODE else ()
        severity = Severity.ERROR if right != NODE else None
        yield Diagnostic("nav2-parameter", wrong.span, message, notes=notes, severity=severity)
    if parameters.place is None and not parameters.misspelt:
        yield Diagnostic("nav2-parameter", Span(0, 0), "this file has no parameters of bt_navigator")


def distribution_unknown(parameters: Parameters) -> Diagnostic:
    """Says that nothing tells for which distribution a file is."""
    choices = ", ".join(f'"nav2-{distribution}"' for distribution in DISTRIBUTIONS)
    message = "the parameters of bt_navigator do not tell for which distribution of ROS 2 they are"
    notes = (f"write `nodes = [...]` with one of {choices} into btq.toml",)
    return Diagnostic("nav2-distribution", parameters.place or Span(0, 0), message, notes=notes)


def parameter_findings(parameters: Parameters, distribution: str) -> Iterator[Diagnostic]:
    """What is wrong with names and types of parameters in a distribution."""
    yield from file_findings(parameters)
    yield from _unread(parameters, distribution)
    yield from _mistyped(parameters, distribution)
    yield from _classes(parameters, distribution) if distribution[0] != "h" else ()


def _unread(parameters: Parameters, distribution: str) -> Iterator[Diagnostic]:
    shown = distribution.capitalize()
    for name, row in parameters.unread(distribution):
        parameter = PARAMETERS[row]
        notes = (parameter.instead,) if parameter.instead else ()
        key = parameters.key(name) or Span(0, 0)
        if distribution[0] in parameter.refused_in:
            message = f"bt_navigator refuses to start with `{name}` in {shown}"
            yield Diagnostic("nav2-parameter", key, message, notes=notes, severity=Severity.ERROR)
        else:
            yield Diagnostic("nav2-parameter", key, f"Nav2 does not read `{name}` in {shown}", notes=notes)


def _mistyped(parameters: Parameters, distribution: str) -> Iterator[Diagnostic]:
    for name, (_, value) in parameters.values.items():
        row = parameters.row(name)
        expected = PARAMETERS[row].type if row is not None and distribution[0] in PARAMETERS[row].of else ""
        if expected and not _may_be(expected, value):
            message = f"`{name}` must be a{'n' * (expected == INTEGER)} {expected}"
            notes = ("bt_navigator refuses to configure",)
            yield Diagnostic("nav2-parameter", value.span, message, notes=notes, severity=Severity.ERROR)


def _may_be(expected: str, value: YamlValue) -> bool:
    """Whether ROS 2 reads a value as this type; or nothing, or what a launch file puts in its place."""
    if value.text is None:
        return expected == STRINGS
    if "$(" in value.text or (value.is_plain and value.text in ("", "~", "null")):
        return True
    return expected != STRINGS and value.is_plain and _FORMS[expected].fullmatch(value.text) is not None


def _classes(parameters: Parameters, distribution: str) -> Iterator[Diagnostic]:
    """Navigators whose class the distribution does not have."""
    shown = distribution.capitalize()
    for navigator, plugin in parameters.plugins:
        class_ = NAVIGATORS[navigator][2] if navigator in NAVIGATORS else ""
        right, wrong = (
            f"{OWN_PACKAGE}{sign}{class_}" for sign in (("/", "::") if distribution[0] == "i" else ("::", "/"))
        )
        prefix = right.removesuffix(class_)
        classes = [f"{prefix}{name}" for _, _, name in NAVIGATORS.values()]
        message = ""
        if plugin.text == wrong:
            message = f"the class of this navigator is called `{right}` in {shown}"
        elif class_ and plugin.text.startswith(prefix) and plugin.text not in classes:
            message = f"Nav2 has no navigator `{plugin.text}`{did_you_mean(near(plugin.text, classes, 1))}"
        if message:
            yield Diagnostic("nav2-parameter", plugin.span, message, severity=Severity.ERROR)


_FORMS: Final = {
    INTEGER: re.compile(r"[-+]?(0[xX][0-9a-fA-F]+|\d+)"),
    DOUBLE: re.compile(r"[-+]?(\d+\.\d*|\.\d+)([eE][-+]?\d+)?|[-+]?\d+[eE][-+]?\d+|[-+]?\.(inf|Inf|INF|nan|NaN|NAN)"),
    BOOLEAN: re.compile(r"[yYnN]|yes|Yes|YES|no|No|NO|true|True|TRUE|false|False|FALSE|on|On|ON|off|Off|OFF"),
}
