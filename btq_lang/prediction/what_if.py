"""`--what-if`: a change of a mission or of a skill, as it is typed.

    Retry Dock num_attempts = 5      an attribute of a node: its kind, its name or path, or both
    MoveBase takes x 0.8             a skill: its durations, by a factor
    MoveBase takes 12 s to 20 s      or others
    Dock succeeds 97 %               and how often it succeeds

One invariant: a change of an attribute has the effect that the same edit of the file has.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.btcpp.document import escape
from btq_lang.btcpp.opening import with_source
from btq_lang.checks import check
from btq_lang.diagnostics.rules import Severity
from btq_lang.prediction.changed import SkillChange
from btq_lang.prediction.predicting import Predictor, Recipe
from btq_lang.requirements import nodes
from btq_lang.requirements.simulation import is_condition, is_skill
from btq_lang.syntax.tree import unquote
from btq_lang.util.record import replace
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Edit, Span
from btq_lang.workspace.project_simulation import read_simulation
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


class WrongChange(Exception):
    """A what-if cannot be understood; the message says what was expected."""


def changed_by(predictor: Predictor, text: str) -> Recipe:
    """What a prediction follows from after the change that a text says.

    Args:
        predictor: of the mission without it.

    Raises:
        WrongChange: it cannot be understood, or names what the mission lacks.
    """
    recipe = predictor.recipe
    for pattern, read in ((_TAKES, _takes), (_SUCCEEDS, _succeeds)):
        if match := pattern.fullmatch(text.strip()):
            path = unquote(match["path"]) if match["path"].startswith('"') else match["path"]
            _require_skill(recipe, path)
            change = read(path, match["value"])
            if change.factor != 1 and predictor.assumes(change):
                raise WrongChange(f"`{path}` is assumed to take no time; expected a duration such as `takes 12 s`")
            return replace(recipe, changes=(*recipe.changes, change))
    match = _ATTRIBUTE.fullmatch(text.strip())
    if match is None:
        raise WrongChange(f"expected {_EXPECTED}")
    edited = _with_attribute(recipe, _nodes(recipe, match["node"]), match["key"], match["value"])
    return replace(recipe, workspace=edited)


# ---- skills ----


def _takes(path: str, value: str) -> SkillChange:
    if (factor := _FACTOR.fullmatch(value)) is not None:
        return SkillChange(path, factor=float(factor[1]))
    low, _, high = value.partition(" to ")
    takes = [low.strip(), high.strip()] if high else value
    settings, complaints = read_simulation({"skills": {path: {"takes": takes}}})
    if complaints:
        raise WrongChange(
            f"expected a duration such as `12 s` or `12 s to 20 s`, or a factor such as `x 0.8`, not `{value}`"
        )
    return SkillChange(path, takes=settings.skills[0].takes)


def _succeeds(path: str, value: str) -> SkillChange:
    settings, complaints = read_simulation({"skills": {path: {"succeeds": value}}})
    if complaints:
        raise WrongChange(f"expected a percentage from 0 to 100 such as `97 %`, not `{value}`")
    return SkillChange(path, succeeds=settings.skills[0].succeeds)


def _require_skill(recipe: Recipe, path: str) -> None:
    named = _named(recipe, path)
    if any(is_skill(node) and is_condition(node) for node in named):
        raise WrongChange(f"`{path}` is a condition; expected an action, or an attribute of a node")
    if not any(map(is_skill, named)):
        raise WrongChange(f"`{path}` is not an action of the program")


# ---- attributes ----


def _nodes(recipe: Recipe, words: str) -> list[ResolvedNode]:
    """The nodes that a kind and a name, or one of them, lead to; `Retry Dock`: else the one around `Dock`."""
    parts = [unquote(word) if word.startswith('"') else word for word in _WORD.findall(words)]
    kinds, path = parts[:-1], parts[-1]
    named = _named(recipe, path)
    own = [node for node in named if all(kind in (*node.kinds, node.category) for kind in kinds)]
    if own:
        return own
    around = [
        next((above for above in node.ancestors() if set(kinds) <= {*above.kinds, above.category}), None)
        for node in named
    ]
    ones = [*dict.fromkeys(node for node in around if node is not None)]
    if not ones:
        raise WrongChange(f"no `{' '.join(kinds)}` is named `{path}` or around it")
    return ones


def _named(recipe: Recipe, path: str) -> list[ResolvedNode]:
    """The written nodes of a name or path."""
    store = recipe.workspace.store
    named = [target.node for target in store.ask(nodes.find, recipe.path, tuple(path.split("/")))]
    if not named:
        likely = near(path, store.ask(nodes.node_names, recipe.path), 1) if "/" not in path else []
        raise WrongChange(f"no node is named `{path}`{did_you_mean(likely)}")
    return [*dict.fromkeys(named)]


def _with_attribute(recipe: Recipe, changed: Iterable[ResolvedNode], key: str, value: str) -> Workspace:
    """The workspace in which nodes have an attribute.

    Raises:
        WrongChange: the mission has more errors then.
    """
    workspace = recipe.workspace
    edits: dict[str, list[Edit]] = {}
    for node in changed:
        in_file = edits.setdefault(node.path, [])
        in_file.append(_edit(workspace, node, key, value))
    for path, in_file in edits.items():
        text = workspace.files[path].source
        for edit in sorted(set(in_file), key=lambda each: each.span.start, reverse=True):
            text = text[: edit.span.start] + edit.text + text[edit.span.end :]
        workspace = with_source(workspace, path, text)
    before = [*_errors(recipe.workspace, edits)]
    for message in _errors(workspace, edits):
        if message not in before:
            raise WrongChange(message)
        before.remove(message)
    return workspace


def _errors(workspace: Workspace, paths: Iterable[str]) -> Iterator[str]:
    for path in paths:
        for each in check(workspace, path):
            if each.effective_severity is Severity.ERROR:
                yield each.message


def _edit(workspace: Workspace, node: ResolvedNode, key: str, value: str) -> Edit:
    """The edit of the file on the disk."""
    file = workspace.files[node.path]
    start = file.start_of(node.item)
    if file.is_foreign:
        at = file.on_disk(node.place.span.shifted(start)).start
        return _edit_of_xml(file.source, file.source.rfind("<", 0, at + 1), key, value)
    pairs = node.node.attributes
    for pair in pairs:
        if pair.key.text == key and pair.value is not None:
            return Edit(pair.value.span.shifted(start), value)
    if pairs:
        end = pairs[-1].span.end + start
        return Edit(Span(end, end), f" {key} = {value}")
    word = node.node.label or node.node.kind or node.node.category
    assert word is not None, "a node has a kind or a category"
    return Edit(Span(word.end + start, word.end + start), f" ({key} = {value})")


def _edit_of_xml(xml: str, begin: int, key: str, value: str) -> Edit:
    tag = _TAG.match(xml, begin)
    assert tag is not None, "an element begins there"
    quoted = f'"{escape(unquote(value) if value.startswith(chr(34)) else value)}"'
    for attribute in _XML_ATTRIBUTE.finditer(xml, tag.end("name"), tag.end()):
        if attribute["key"] == key:
            return Edit(Span(*attribute.span("value")), quoted)
    return Edit(Span(tag.end("name"), tag.end("name")), f" {key}={quoted}")


_EXPECTED: Final = (
    "an attribute of a node such as `Retry Dock num_attempts = 5`, or what an action takes or how often it succeeds,"
    " such as `MoveBase takes x 0.8` or `Dock succeeds 97 %`"
)
_NAME: Final = r'(?P<path>"[^"]+"|[^\s"]+)'
_TAKES: Final = re.compile(rf"{_NAME}\s+takes\s+(?P<value>.+)")
_SUCCEEDS: Final = re.compile(rf"{_NAME}\s+succeeds\s+(?P<value>.+)")
_FACTOR: Final = re.compile(r"[x×*]\s*([0-9]+(?:\.[0-9]+)?)")
_ATTRIBUTE: Final = re.compile(r"(?P<node>\S.*?)\s+(?P<key>[A-Za-z_]\w*)\s*=(?!=)\s*(?P<value>\S.*)")
_WORD: Final = re.compile(r'"[^"]+"|[^\s"]+')
_TAG: Final = re.compile(r"""<(?P<name>[^\s/>"']+)(?:[^>"']|"[^"]*"|'[^']*')*>""")
_XML_ATTRIBUTE: Final = re.compile(r"""(?P<key>[^\s=/>"']+)\s*=\s*(?P<value>"[^"]*"|'[^']*')""")
