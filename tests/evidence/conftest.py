"""The fixtures of `evidence_fixtures.py`: mypy can check only one module `conftest`."""

from evidence_fixtures import *  # noqa: F403
