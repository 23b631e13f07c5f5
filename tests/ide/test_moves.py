"""Files that are renamed or moved take their includes with them."""

from __future__ import annotations

from feature_asserts import check_moved

FILES = """//- missions/main.btq
include "../lib/skills.btq"
include "local.btq"
//- missions/local.btq
include 'nowhere.btq'
//- lib/skills.btq
Action Pick
"""


def test_a_file_is_renamed() -> None:
    check_moved(
        FILES, {"lib/skills.btq": "lib/hands.btq"}, FILES.replace('include "../lib/skills', 'include "../lib/hands')
    )


def test_a_file_is_moved_away_from_what_it_includes() -> None:
    after = FILES.replace("../lib/skills.btq", "lib/skills.btq").replace("local.btq", "missions/local.btq", 1)
    check_moved(FILES, {"missions/main.btq": "main.btq"}, after)


def test_a_folder_is_moved() -> None:
    check_moved(FILES, {"missions": "robot/missions"}, FILES.replace("../lib/skills", "../../lib/skills"))
    check_moved(FILES, {"lib": "common/lib"}, FILES.replace("../lib/skills", "../common/lib/skills"))


def test_what_nobody_includes() -> None:
    check_moved(FILES, {"missions/other.btq": "main.btq"}, FILES)
