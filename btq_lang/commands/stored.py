"""The store of `btq verify`: where the command line asks to keep verdicts."""

from __future__ import annotations

from argparse import Namespace
from typing import TYPE_CHECKING

from btq_lang.workspace.loader import shown

if TYPE_CHECKING:
    from btq_lang.evidence.store.sets import Keeping

_NAMES = ("--label", "--label-by", "--robot", "--robot-by")


def opened(options: Namespace, problems: list[str]) -> Keeping | None:
    """The store that a command line names, without what killed writers left; errors are appended to the problems."""
    if options.store is None:
        values = vars(options)
        named = [each for each in _NAMES if values[each.strip("-").replace("-", "_")] is not None]
        problems += [f"{each} goes with --store DIR" for each in named]
        return None
    from btq_lang.evidence.store.engine import NoEngine, imported
    from btq_lang.evidence.store.sets import Keeping, tidy

    try:
        imported()
        tidy(options.store)
    except NoEngine as error:
        problems.append(str(error))
    except NotADirectoryError:
        problems.append(f"{shown(options.store)}: expected a folder, found a file")
    except OSError as error:
        problems.append(f"{shown(options.store)}: cannot be read: {error.strerror or error}")
    return Keeping(options.store, options.label, options.label_by, options.robot, options.robot_by)
