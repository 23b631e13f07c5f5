"""Which XML is BehaviorTree.CPP's, and what it defines, mostly recognized by its text alone.

One invariant: no file that the engine loads trees or models from is passed over.  Many other files are called .xml, and
some of them have the document element `root` too.  Whether the XML is well-formed is not known here.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.btcpp.document import unescape


def may_be_mission(head: str) -> bool:
    """Whether a file that begins with a text, or is that text, may be XML of the engine."""
    rest = head[_prolog(head) :]
    return rest[:2] in ("", "<", "<!", "<?") or rest.startswith("<root") or "<root".startswith(rest)


def is_mission(xml: str) -> bool:
    """Whether a text is XML of the engine: its document element is `root`, and names a version or a main tree, or
    contains trees, models or includes."""
    return _ROOT.match(xml, _prolog(xml)) is not None


def defined_in(xml: str) -> frozenset[str]:
    """The names that a text may define as trees or models, and perhaps some more."""
    models = xml.find("<TreeNodesModel")
    matches = [*_TREE.finditer(xml), *(_ID.finditer(xml, models) if models >= 0 else ())]
    return frozenset(unescape(match[1] if match[1] is not None else match[2]) for match in matches)


def included_in(xml: str) -> tuple[str, ...]:
    """The paths that a text includes; none of a ROS package."""
    return tuple(unescape(match[2]) for match in _INCLUDE.finditer(xml) if "ros_pkg" not in match[0])


def _prolog(xml: str) -> int:
    """Where the document element begins."""
    match = _PROLOG.match(xml)
    return match.end() if match is not None else 0


def listed_trees(xml: str) -> tuple[tuple[str, ...], str | None] | None:
    """The trees of a file as Nav2 lists them before it registers the file: the IDs, in order, and the one that it names
    as the main tree; None if it cannot be parsed.

    Source: nav2_behavior_tree/src/behavior_tree_engine.cpp, `parseTreeInfo`, which reads with tinyxml2.
    """
    from btq_lang.btcpp.reader import read  # few files are listed

    document = read(xml).document
    if document is None:
        return None
    listed = (each.get("ID") for each in document.root.elements if each.tag == "BehaviorTree")
    return tuple(each for each in listed if each is not None), document.root.get("main_tree_to_execute")


_PROLOG: Final = re.compile(r"(?:[^<]+|<\?.*?\?>|<!--.*?-->|<!(?!--)[^>]*>)*", re.DOTALL)
_VALUE: Final = r"""\bID\s*=\s*(?:"([^"]*)"|'([^']*)')"""
_ID: Final = re.compile(_VALUE)
_TREE: Final = re.compile(rf"<BehaviorTree\b[^>]*?{_VALUE}")
_INCLUDE: Final = re.compile(r"""<include\b[^>]*?\bpath\s*=\s*(["'])(.*?)\1[^>]*>""")
_ROOT: Final = re.compile(
    r"<root(?=[\s/>])(?:[^>]*\s(?:BTCPP_format|main_tree_to_execute)\s*="
    r"|.*?<(?:BehaviorTree\b|TreeNodesModel\b|include\s[^>]*\bpath\s*=))",
    re.DOTALL,
)
