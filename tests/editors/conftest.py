"""The fixtures of `editor_fixtures.py`: mypy can check only one module `conftest`."""

from editor_fixtures import *  # noqa: F403
