"""A run as the file that BehaviorTree.CPP's FileLogger2 writes, which `btq verify` and Groot2 read.

Sources: src/loggers/bt_file_logger_v2.cpp, and `WriteTreeToXML` in src/xml_parsing.cpp.
"""

from __future__ import annotations

from struct import Struct
from typing import Final
from xml.etree.ElementTree import Element, SubElement, tostring

from btq_lang.evidence.model import LoggedTree
from btq_lang.evidence.readers.btlog import MAGIC
from btq_lang.scenarios.running import START, ScenarioRun


def as_btlog(tree: LoggedTree, run: ScenarioRun) -> bytes:
    """The log of a run; entries are not in it."""
    xml = _xml(tree)
    rows = [(time - START, uid, status) for time, uid, status in run.rows]
    records = [_RECORD.pack(time & 0xFFFFFFFF, time >> 32, uid, status) for time, uid, status in rows]
    return b"".join([MAGIC, _LENGTH.pack(1, len(xml)), xml, _START.pack(START), *records])


def _xml(tree: LoggedTree) -> bytes:
    """The tree with the number of each node, and a tree of its own for each instance of a subtree."""
    root = Element("root", BTCPP_format="4", main_tree_to_execute=tree.name)
    above = {0: SubElement(root, "BehaviorTree", ID=tree.name, _fullpath="")}
    for uid, node in tree.nodes.items():
        parent = above[tree.parent[uid]]
        if tree.has_tree(uid):
            SubElement(parent, "SubTree", ID=node.kind, _fullpath=node.path, _uid=str(uid))
            above[uid] = SubElement(root, "BehaviorTree", ID=node.kind, _fullpath=node.path)
        else:
            above[uid] = SubElement(parent, node.kind, name=node.name, _uid=str(uid))
    return tostring(root)


_LENGTH: Final = Struct("<Bi")
_START: Final = Struct("<q")
_RECORD: Final = Struct("<IHHB")
