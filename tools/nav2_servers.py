"""Writes `btq_lang/catalog/nav2/servers.py`, the parameters of Nav2's other nodes, from a clone of navigation2.

python tools/nav2_servers.py CLONE
"""

from __future__ import annotations

import re
import sys
import tarfile
from io import BytesIO
from pathlib import Path
from subprocess import run
from textwrap import wrap
from typing import Final

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from btq_lang.catalog.nav2 import DISTRIBUTIONS  # noqa: E402  # of this checkout

TABLE: Final = ROOT / "btq_lang/catalog/nav2/servers.py"
# The nodes, and the folders with their sources.
FOLDERS: Final = {
    "amcl": "nav2_amcl",
    "behavior_server": "nav2_behaviors",
    "collision_monitor": "nav2_collision_monitor",
    "controller_server": "nav2_controller",
    "costmap_filter_info_server": "nav2_map_server/src/costmap_filter_info",
    "docking_server": "nav2_docking/opennav_docking",
    "lifecycle_manager": "nav2_lifecycle_manager",
    "map_saver": "nav2_map_server/src/map_saver",
    "map_server": "nav2_map_server/src/map_server",
    "planner_server": "nav2_planner",
    "route_server": "nav2_route",
    "smoother_server": "nav2_smoother",
    "velocity_smoother": "nav2_velocity_smoother",
    "waypoint_follower": "nav2_waypoint_follower",
}


def table_file(clone: Path) -> str:
    """The text of the module with the table."""
    of: dict[str, dict[str, str]] = {server: {} for server in FOLDERS}
    for distribution in DISTRIBUTIONS:
        texts = _texts(clone, distribution)
        for server, folder in FOLDERS.items():
            own = [text for path, text in texts.items() if path.startswith(f"{folder}/")]
            used = {header for text in own for header in _INCLUDED.findall(text)}
            shared = [text for path, text in texts.items() if path.endswith(tuple(used) or "\0")]
            for name in {found.partition(".")[0] for text in (*own, *shared) for found in _READ.findall(text)}:
                of[server][name] = of[server].get(name, "") + distribution[0]
    return _HEAD + "".join(_rows(server, names) for server, names in of.items()) + "}\n"


def _rows(server: str, names: dict[str, str]) -> str:
    by_letters: dict[str, list[str]] = {}
    for name in sorted(names):
        by_letters.setdefault(names[name], []).append(name)
    rows = "".join(_row(letters, group) for letters, group in sorted(by_letters.items()))
    return f'    "{server}": {{\n{rows}    }},\n'


def _row(letters: str, names: list[str]) -> str:
    row = f'        "{letters}": "{" ".join(names)}",\n'
    if len(row) <= 121:
        return row
    *lines, last = wrap(" ".join(names), 105)
    parts = "".join(f'            "{line}"\n' for line in (*(f"{line} " for line in lines), last))
    return f'        "{letters}": (\n{parts}        ),\n'


def _texts(clone: Path, branch: str) -> dict[str, str]:
    """The C++ files of a branch, without tests and plugins."""
    git = ["git", "-C", str(clone)]
    folders = run([*git, "ls-tree", "--name-only", branch], capture_output=True, check=True, text=True).stdout.split()
    tops = {each.partition("/")[0] for each in (*FOLDERS.values(), "nav2_util")}.intersection(folders)
    command = [*git, "archive", branch, "--", *(f":(glob){each}/**/*.[ch]pp" for each in sorted(tops))]
    found = {}
    with tarfile.open(fileobj=BytesIO(run(command, capture_output=True, check=True).stdout)) as archive:
        for member in archive:
            content = archive.extractfile(member) if not _LEFT_OUT(member.name) else None
            if content is not None:
                found[member.name] = content.read().decode()
    return found


_LEFT_OUT: Final = re.compile(r"/(?:test|plugins)/").search
_READ: Final = re.compile(
    r"(?:declare_parameter(?:_if_not_declared)?|declare_or_get_parameter|get_parameter(?:_or)?|add_parameter)(?:<[^;()]*>)?"
    r'\(\s*(?:\w+(?:\(\))?,\s*)?(?:rclcpp::ParameterValue\()?"([^"]+)"'
)
_INCLUDED: Final = re.compile(r'#include "\w+(/twist_(?:publisher|subscriber)\.hpp)"')
_HEAD: Final = '''"""The parameters of Nav2's other nodes; `tools/nav2_servers.py` writes this file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

# By node: the first letters of the distributions that read them, and their names, of `a.b` only `a`; without those of
# the plugins that a node loads.
SERVERS: Final[Mapping[str, Mapping[str, str]]] = {
'''

if __name__ == "__main__":
    TABLE.write_text(table_file(Path(sys.argv[1])), encoding="utf-8")
    print(TABLE)
