"""The ports that the base classes of Nav2's nodes provide, by distribution.

Source: `providedBasicPorts` in nav2_behavior_tree/include/nav2_behavior_tree/bt_*_node.hpp of each branch;
`tests/cpp/test_nav2_sources.py` holds them against a clone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Direction


class BasePort(Record):
    """A port that a base class provides; since: the first distribution that has it.

    None of them has a default or needs a value: names may come from the constructor, and the timeout from bt_navigator.
    """

    direction: Direction
    name: str
    type: str
    text: str = ""
    since: str = DISTRIBUTIONS[0]

    def is_in(self, distribution: str) -> bool:
        """Whether a distribution has it."""
        return DISTRIBUTIONS.index(self.since) <= DISTRIBUTIONS.index(distribution)


_NAME: Final = BasePort("input", "server_name", "std::string", "Action server name")
_TIMEOUT: Final = BasePort("input", "server_timeout", "std::chrono::milliseconds")
BASES: Final = {
    "BtActionNode": (
        _NAME,
        _TIMEOUT,
        BasePort("output", "error_code_id", "uint16_t", "The action error code", "lyrical"),
        BasePort("output", "error_msg", "std::string", "The action error message", "lyrical"),
    ),
    "BtCancelActionNode": (_NAME, _TIMEOUT),
    "BtServiceNode": (
        BasePort("input", "service_name", "std::string", "please_set_service_name_in_BT_Node"),
        _TIMEOUT,
    ),
}
NAMESPACE: Final = "nav2_behavior_tree"
