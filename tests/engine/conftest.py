"""The fixtures of `engine_fixtures.py`: mypy can check only one module `conftest`."""

from engine_fixtures import *  # noqa: F403
