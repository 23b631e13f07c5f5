"""A check ends when a message arrives: the next one uses what it has found out."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable
from functools import partial
from io import BytesIO
from itertools import count

import pytest

from btq_lang.lsp.editor import Server
from btq_lang.lsp.protocol import Messages
from btq_lang.workspace.queries import Cancelled


@pytest.mark.parametrize("pulls", [False, True])
def test_a_check_ends_when_an_edit_waits(pulls: bool) -> None:
    class Checking(Server):
        pulls = False

    async def edit() -> Counter[str]:
        server, path = Checking(), "/p/main.btq"
        server.session.edit(path, "BehaviorTree Main\n    Sequnce\n        Dock\n")
        looks = 0

        def has_message() -> bool:
            nonlocal looks
            looks += 1
            if looks == 5:  # in the middle of the check
                edited = "BehaviorTree Main\n    Fallbck\n        Dock\n"
                asyncio.get_running_loop().call_soon(lambda: server.session.edit(path, edited))
            return looks == 5

        server.has_message = has_message
        messages: Counter[str] = Counter()
        check = server.session.check

        def checked(path: str, is_cancelled: Callable[[], bool]) -> None:
            try:
                check(path, is_cancelled)
                messages.update(each.message for each in server.session.diagnostics(path))
            except Cancelled:
                messages["cancelled"] += 1
                raise

        server.session.check = checked  # type: ignore[method-assign]  # to see what each check says
        if pulls:
            await server.schedule.check(path)
        else:
            server.schedule.check_soon((path,))
            assert server.schedule.task is not None
            await server.schedule.task
        return messages

    assert asyncio.run(edit()) == {"cancelled": 1, "unknown node `Fallbck`; did you mean `Fallback`?": 1}


def test_the_time_of_an_interrupted_check_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Else a long check that keystrokes interrupt would be taken for a short one."""
    monkeypatch.setattr("btq_lang.lsp.session.perf_counter", partial(next, count()))  # a second later each time
    session, path = Server().session, "/p/main.btq"
    session.edit(path, "BehaviorTree Main\n    Dock\n")
    with pytest.raises(Cancelled):
        session.check(path, lambda: True)
    session.check(path, lambda: False)
    assert session.check_seconds == {path: 2}
    session.edit(path, "BehaviorTree Main\n    Pick\n")
    session.check(path, lambda: False)
    assert session.check_seconds == {path: 1}


def test_a_message_that_is_not_yet_handled_is_known() -> None:
    async def read() -> list[bool]:
        bodies = [f'{{"method": "textDocument/{method}"}}'.encode() for method in ("hover", "didChange")]
        reader = Messages(BytesIO(b"".join(b"Content-Length: %d\r\n\r\n%s" % (len(each), each) for each in bodies)))
        said = []
        for _ in bodies:
            await reader.readline()
            said.append(reader.has_message)
            await reader.readline()
            await reader.readexactly(0)
            said.append(reader.has_message)
        return said

    assert asyncio.run(read()) == [True, False, True, False]
