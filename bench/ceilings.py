"""The trees of a mission as JSON and as XML: inputs for the parsers in C that nobody can hope to overtake.

Both say what the classic spelling says, comments left out.
"""

from __future__ import annotations

import json
from xml.sax.saxutils import quoteattr

from missions import Mission, Step


def as_json(made: Mission) -> str:
    trees = [{"ID": name, "top": _object(top)} for name, top in made.trees]
    return json.dumps({"main": made.trees[0][0], "trees": trees})


def _object(step: Step) -> dict[str, object]:
    made: dict[str, object] = {"kind": step.kind}
    if step.label:
        made["name"] = step.label
    if step.values:
        made["attributes"] = {key: value.strip('"') for key, value, _ in step.values}
    if step.mark and step.mark.concerns:
        made["satisfices"] = [concern for concern, _ in step.mark.concerns]
    if step.mark and step.mark.requirement:
        requirement = step.mark.requirement
        made["satisfies"] = {"ID": requirement.id}
        if step.mark.defines:
            made["satisfies"] = {"ID": requirement.id, "description": requirement.description}
    if step.children:
        made["children"] = [_object(child) for child in step.children]
    return made


def as_xml(made: Mission) -> str:
    lines = [f"<root BTCPP_format={quoteattr('4')} main_tree_to_execute={quoteattr(made.trees[0][0])}>"]
    for name, top in made.trees:
        lines.append(f"  <BehaviorTree ID={quoteattr(name)}>")
        _elements(top, "    ", lines)
        lines.append("  </BehaviorTree>")
    lines.append("</root>")
    return "\n".join(lines) + "\n"


def _elements(step: Step, indent: str, lines: list[str]) -> None:
    attributes = {key: value.strip('"') for key, value, _ in step.values}
    if step.label:
        attributes["name"] = step.label
    if step.mark:
        attributes["_description"] = _description(step)
    tag = {"action": "Action", "condition": "Condition", "subtree": "SubTree"}.get(step.role)
    if tag:
        attributes["ID"] = step.kind
    else:
        tag = _TAGS.get(step.kind, step.kind)
    start = " ".join([tag, *(f"{key}={quoteattr(value)}" for key, value in attributes.items())])
    if not step.children:
        lines.append(f"{indent}<{start}/>")
        return
    lines.append(f"{indent}<{start}>")
    for child in step.children:
        _elements(child, indent + "  ", lines)
    lines.append(f"{indent}</{tag}>")


def _description(step: Step) -> str:
    assert step.mark is not None
    words = [concern for concern, _ in step.mark.concerns]
    if step.mark.requirement:
        words.append(step.mark.requirement.id)
        if step.mark.defines:
            words.append(step.mark.requirement.description)
    return " ".join(words)


_TAGS = {
    "->": "Sequence",
    "?": "Fallback",
    "||": "Parallel",
    "R->": "ReactiveSequence",
    "R?": "ReactiveFallback",
    "M->": "SequenceWithMemory",
    "Retry": "RetryUntilSuccessful",
}
