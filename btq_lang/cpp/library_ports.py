"""The ports that classes of the engine and of behaviortree_ros2 provide.

One invariant: a class that is not known has no list at all, for it may provide any port.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.cpp_classes import ENGINE, NUMBERED_TAGS, ROS_PORTS, TAGS
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.cpp.model import CppPort, Place

if TYPE_CHECKING:
    from btq_lang.cpp.sources import Bound


def library_ports(bound: Bound, place: Place) -> dict[str, CppPort] | None:
    """The ports of a class that is not in the sources, by name, each at a place; None if they are not known."""
    name = bound.name.rpartition("::")[2]
    if name in ROS_PORTS:
        key, text = ROS_PORTS[name]
        return {key: CppPort(key, "input", "std::string", "", "", text, place)}
    numbered = NUMBERED_TAGS.get(name)
    tag = numbered.format(bound.meanings.get("0")) if numbered is not None else TAGS.get(name)
    if name not in ENGINE or (tag is not None and tag not in BUILTINS):
        return None
    ports = {}
    for port in BUILTINS[tag].ports if tag is not None else ():
        of_item = name == "LoopNode" and port.name == "value"
        type_ = bound.meanings.get("0", port.type) if of_item else port.type
        ports[port.name] = CppPort(port.name, port.direction, type_, port.default, port.default or "", port.doc, place)
    return ports
