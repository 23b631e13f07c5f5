"""VS Code's workbench in a headless Chromium, driven as a person does: keys, menus, and what stands on the screen.

One invariant: nothing sleeps; every step waits for what a person would wait for.  It does not know btq.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import socket
import subprocess
import urllib.parse
import urllib.request
import zipfile
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from chromium import CHROMIUM

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

# Without a network, without a graphics card, without motion, and with nothing of its own to say.
FLAGS = [
    *("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update"),
    "--force-prefers-reduced-motion",  # a list that slides open takes as much of a processor again
]
_LOOK = 50  # milliseconds between two looks at the page: with each frame, as is usual, the page draws all the time
_WAIT = 40_000  # milliseconds; what takes longer on the busiest machine is broken
# Keys for what tests do all the time: the palette takes a second of a processor each time.
_CLOSE_ALL, _SHOW_PROBLEMS, _KILL_TERMINALS = "Control+Alt+F5", "Control+Alt+F6", "Control+Alt+F7"
_KEYBINDINGS = [
    {"key": "ctrl+alt+f5", "command": "workbench.action.closeAllEditors"},
    {"key": "ctrl+alt+f6", "command": "workbench.panel.markers.view.focus"},
    {"key": "ctrl+alt+f7", "command": "workbench.action.terminal.killAll"},
]


class Workbench:
    """One window.  Its files are in `folder`, and `programs` is on its PATH."""

    def __init__(self, page: Page, origin: str, folder: Path, machine_settings: Path, programs: Path) -> None:
        self.page, self.origin, self.folder, self.programs = page, origin, folder, programs
        self._machine_settings = machine_settings
        self._written: list[Path] = []
        self._settings = 0  # how often they have been written

    # ---- what a person does ----

    def write(self, name: str, text: str) -> Path:
        """A file on the disk, as another program would write it."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="")
        self._written.append(path)
        return path

    def clean(self) -> None:
        """No file of a test is left to the next one."""
        for path in self._written:
            path.unlink(missing_ok=True)
        self._written.clear()

    @contextmanager
    def empty_window(self) -> Iterator[Workbench]:
        """Another window, in which no folder is open."""
        assert self.page.context.browser is not None, "a page of a browser"
        page = self.page.context.browser.new_page(viewport=self.page.viewport_size)
        page.set_default_timeout(_WAIT)
        page.goto(f"{self.origin}/?ew=true")
        page.wait_for_selector(".monaco-workbench .part.editor", timeout=_WAIT)
        try:
            yield Workbench(page, self.origin, self.folder, self._machine_settings, self.programs)
        finally:
            page.goto("about:blank")
            page.close()

    def open(self, name: str) -> None:
        """Open a file by its path, in an editor alone."""
        self.keys("Control+p")
        box = self._quick_input()
        box.fill(str(self.folder / name))
        # The list of recent files is there first, and has the name perhaps in another row.
        self.see(f".quick-input-list .monaco-list-row.focused:has-text({_quoted(Path(name).name)})")
        self.keys("Enter")
        self.gone(".quick-input-widget")
        self.see(f".tab.active:has-text({_quoted(Path(name).name)})")
        self.focus()

    def close_all(self) -> None:
        """No editor is open, and nothing is asked about what was not saved."""
        self.command("View: Revert and Close Editor") if self.page.locator(".tab.dirty").count() else None
        self.keys(_CLOSE_ALL)
        self.gone(".tab")
        self.no_more("iframe.webview")  # their pages last a little longer

    def focus(self) -> None:
        self.page.locator(".editor-instance .view-lines .view-line").first.click()

    def focus_nothing(self) -> None:
        """Out of a page in an editor, which would keep the keys for itself."""
        self.page.locator(".part.statusbar").click(position={"x": 400, "y": 10})

    def command(self, title: str) -> None:
        """Run a command of the palette.

        What the palette has is settled when it opens: who is early, before an extension is awake, asks again.
        """
        from playwright.sync_api import TimeoutError as Timeout

        row = self.page.locator(f".quick-input-list .monaco-list-row.focused:has-text({_quoted(title)})").first
        for _ in range(8):
            self.keys("F1")
            self._quick_input().fill(f">{title}")
            with suppress(Timeout):
                row.wait_for(state="attached", timeout=_WAIT / 8)
                self.keys("Enter")
                return
            self.keys("Escape")
        raise AssertionError(f"no command {title}")

    def choose(self, label: str) -> None:
        """Take an entry of the list that is open."""
        self._quick_input().fill(label)
        self.see(f".quick-input-list .monaco-list-row.focused:has-text({_quoted(label)})")
        self.keys("Enter")

    def log_level(self, channel: str, level: str) -> None:
        self.command("Developer: Set Log Level...")
        self.choose(channel)
        self.choose(level)

    def choose_empty(self, folder: Path) -> None:
        """Answer the dialog that asks for a folder with one that is empty."""
        box = self._quick_input()
        rows = self.page.locator(".quick-input-list .monaco-list-row")
        # It writes the folder that it begins with when that is read, over whatever was typed before.
        self.until(lambda: box.input_value() != "" and rows.count() > 0, lambda: "the dialog shows nothing")
        box.fill(f"{folder}/")
        self.until(lambda: rows.all_inner_texts() == [".."], lambda: f"not empty: {rows.all_inner_texts()}")
        self.page.locator(".quick-input-action a, .quick-input-action .monaco-button").first.click()
        self.gone(".quick-input-widget")

    def answer_path(self, path: Path) -> None:
        """Answer the dialog that asks where to save."""
        from playwright.sync_api import TimeoutError as Timeout

        box = self._quick_input()
        # It writes what it proposes when the folder is read, over whatever was typed before.
        self.until(lambda: box.input_value() != "", lambda: "the dialog proposes nothing")
        box.fill(str(path))
        accept = self.page.locator(".quick-input-action a, .quick-input-action .monaco-button").first

        def is_taken() -> bool:  # while it reads the folder a click is lost
            with suppress(Timeout):
                accept.click(timeout=_WAIT / 40)
            return not box.is_visible()

        self.until(is_taken, lambda: f"the dialog stays: {box.input_value()}")

    def cursor(self, line: int, column: int) -> None:
        self.keys("Control+g")
        self._quick_input().fill(f":{line}:{column}")
        self.keys("Enter")
        self.at(line, column)

    def keys(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)

    def type(self, text: str) -> None:
        self.page.keyboard.type(text)

    def save(self) -> None:
        self.keys("Control+s")
        self.gone(".tab.active.dirty")

    def settings(self, **values: object) -> None:
        """The machine's settings are these and no others, and the window has read them.

        It says so in its title, which is one of them; a change that it misses is written again.
        """
        from playwright.sync_api import TimeoutError as Timeout

        self._settings += 1
        title = f"settings {self._settings}"
        for _ in range(8):
            self._machine_settings.write_text(json.dumps({**values, "window.title": title}))
            with suppress(Timeout):
                self.page.wait_for_function(
                    "title => document.title === title", arg=title, timeout=_WAIT / 8, polling=_LOOK
                )
                return
        raise AssertionError(f"the settings are not read: {self.page.title()}")

    # ---- what a person sees ----

    def see(self, selector: str) -> Locator:
        """Wait until it is there."""
        found = self.page.locator(selector).first
        found.wait_for(state="attached", timeout=_WAIT)
        return found

    def no_more(self, selector: str) -> None:
        """Wait until it is not there."""
        self.page.locator(selector).first.wait_for(state="detached", timeout=_WAIT)

    def gone(self, selector: str) -> None:
        """Wait until none is seen; of selectors as style sheets have them."""
        self.page.wait_for_function(
            "selector => ![...document.querySelectorAll(selector)].some(each => each.offsetParent !== null)",
            arg=selector,
            timeout=_WAIT,
            polling=_LOOK,
        )

    def at(self, line: int, column: int) -> None:
        """Wait until the status bar says that the cursor is there."""
        self.see(f".statusbar-item:has-text('Ln {line}, Col {column}')")

    def problems(self, *texts: str) -> list[str]:
        """Wait until the Problems view has exactly these findings, each somewhere in its row; the rows."""
        self.keys(_SHOW_PROBLEMS)
        rows = self.page.locator(".markers-panel .monaco-list-row:has(.marker-icon)")
        self.until(
            lambda: rows.count() == len(texts) and all(map(str.__contains__, rows.all_inner_texts(), texts)),
            lambda: f"Problems: {rows.all_inner_texts()}",
        )
        return [re.sub(r"\s+", " ", row) for row in rows.all_inner_texts()]

    def problems_of(self, name: str, count: int) -> list[str]:
        """Wait until the Problems view has so many findings in a file, open or not; their rows."""
        self.keys(_SHOW_PROBLEMS)
        self.see(f".markers-panel .monaco-list-row:has-text({_quoted(name)}):has-text('{count}')")
        rows = self.page.locator(".markers-panel .monaco-list-row:has(.marker-icon)").all_inner_texts()
        return [re.sub(r"\s+", " ", row) for row in rows]

    def no_problems_of(self, name: str) -> None:
        """Wait until the Problems view does not name the file."""
        self.keys(_SHOW_PROBLEMS)
        self.no_more(f".markers-panel .monaco-list-row:has-text({_quoted(name)})")

    def run_task(self, title: str) -> None:
        """Run the task of a command and wait until it has ended; no terminal shows how another one did."""
        self.keys(_KILL_TERMINALS)
        self.gone(".single-terminal-tab")
        self.command(title)
        self.task_ends()

    def task_ends(self) -> None:
        """Wait until the task in the terminal that is shown has ended."""
        self.see(".single-terminal-tab .codicon-error, .single-terminal-tab .codicon-check")

    def on_disk(self, name: str, text: str) -> None:
        """Wait until the file has this text."""
        path = self.folder / name
        self.until(
            lambda: path.exists() and path.read_text(encoding="utf-8") == text,
            lambda: f"{name}: {path.read_text(encoding='utf-8') if path.exists() else 'not there'}",
        )

    def suggestions(self) -> list[str]:
        """What is proposed at the cursor, from the first row that is seen."""
        self.keys("Control+Space")
        self.see(".suggest-widget.visible .monaco-list-row")
        return [row.split("\n")[0] for row in self.page.locator(".suggest-widget .monaco-list-row").all_inner_texts()]

    def fixes(self) -> None:
        """Open the list of fixes at the cursor.

        It closes again when the findings of the file are told anew just then: one asks once more, as a person would.
        """
        from playwright.sync_api import TimeoutError as Timeout

        rows = self.page.locator(".action-widget .monaco-list-row")
        for _ in range(10):
            self.keys("Control+.")
            with suppress(Timeout):
                rows.first.wait_for(timeout=_WAIT / 10)
                return
        raise AssertionError("no fixes are offered")

    def text(self) -> list[str]:
        """The lines of the active editor that are on the screen."""
        lines = self.page.locator(".editor-group-container.active .view-lines .view-line")
        placed = [
            (float(re.sub(r"[^\d.]", "", line.evaluate("e => e.style.top"))), line.inner_text()) for line in lines.all()
        ]
        return [text.replace("\xa0", " ").rstrip() for _, text in sorted(placed)]

    def blanks(self) -> int:
        """How many blanks the line of the cursor begins with, when the screen has followed the last key."""
        text = self.page.evaluate(
            """async () => {
                await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
                const editor = document.querySelector('.editor-group-container.active .monaco-editor');
                const top = editor.querySelector('.cursors-layer .cursor').style.top;
                const lines = [...editor.querySelectorAll('.view-lines .view-line')];
                return lines.find(line => line.style.top === top).textContent;
            }"""
        )
        return len(text) - len(text.lstrip(" \xa0"))

    def seen(self) -> str:
        """What stands on the screen, for who reads why a test failed."""
        parts = (".tab", ".quick-input-widget", ".notification-toast", ".markers-panel", ".part.statusbar")
        found = ((part, self.page.locator(f"{part}:visible").all_inner_texts()) for part in parts)
        return "\n".join(f"{part}: {texts}" for part, texts in found)

    def shot(self, path: Path) -> None:
        self.page.screenshot(path=str(path))

    def until(self, condition: Callable[[], bool], otherwise: Callable[[], str]) -> None:
        """Wait for what only Python can see."""
        for _ in range(_WAIT // 50):
            if condition():
                return
            self.page.wait_for_timeout(50)
        raise AssertionError(otherwise())

    def _quick_input(self) -> Locator:
        box = self.page.locator(".quick-input-widget input:visible").first
        box.wait_for(timeout=_WAIT)
        return box


class Windows:
    """One window for many tests, and another once it was closed."""

    def __init__(self, make: Callable[[], AbstractContextManager[Workbench]]) -> None:
        self._make = make
        self._stack = ExitStack()
        self._current: Workbench | None = None

    def __enter__(self) -> Windows:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def current(self) -> Workbench:
        if self._current is None:
            self._current = self._stack.enter_context(self._make())
        return self._current

    def close(self) -> None:
        self._current = None
        self._stack.close()


def _quoted(text: str) -> str:
    """As a selector has it."""
    return json.dumps(text, ensure_ascii=False)


@contextmanager
def workbench(
    *,
    store: Path,
    node: Path,
    vsix: Path,
    scratch: Path,
    files: Path | None,
    settings: dict[str, Any],
    programs: Path,
    size: tuple[int, int] = (1400, 900),
) -> Iterator[Workbench]:
    """A server with the package installed, and one window on a folder.

    Args:
        store: where VS Code was installed.
        scratch: an empty folder for all that it writes.
        files: a folder whose files the window's folder begins with.
        settings: of the machine: those of the user reach a window late now and then.
        programs: a folder that goes before all others on its PATH.
        size: of the window: each key takes less of a processor in a small one.
    """
    from playwright.sync_api import sync_playwright

    folder = scratch / "missions"
    shutil.copytree(files, folder) if files else folder.mkdir()
    extension = scratch / "extensions" / "btq.btq-0.1.0"
    with zipfile.ZipFile(vsix) as archive:
        archive.extractall(scratch / "unpacked")
    extension.parent.mkdir()
    shutil.move(scratch / "unpacked" / "extension", extension)
    shutil.copytree(Path(__file__).parent / "python_extension", extension.with_name("ms-python.python-1.0.0"))
    machine = scratch / "user" / "Machine" / "settings.json"
    machine.parent.mkdir(parents=True)
    machine.write_text(json.dumps(settings))
    user = scratch / "user" / "User" / "keybindings.json"
    user.parent.mkdir()
    user.write_text(json.dumps(_KEYBINDINGS))
    with _server(store, node, scratch, programs) as origin, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS, env={**_home(scratch)})
        page = browser.new_page(viewport={"width": size[0], "height": size[1]})
        page.set_default_timeout(_WAIT)
        page.goto(f"{origin}/?folder={urllib.parse.quote(str(folder))}")
        page.wait_for_selector(".monaco-workbench .part.editor", timeout=_WAIT)
        page.wait_for_selector(".explorer-folders-view .monaco-list-row, .explorer-folders-view .monaco-list-rows")
        try:
            yield Workbench(page, origin, folder, machine, programs)
        finally:
            page.goto("about:blank")  # ends the extension host and its server at once; closing waits for hours
            browser.close()


@contextmanager
def _server(store: Path, node: Path, scratch: Path, programs: Path) -> Iterator[str]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    config = scratch / "config.yaml"
    config.write_text(f"bind-addr: 127.0.0.1:{port}\nauth: none\ncert: false\n")
    places = ("--config", config, "--user-data-dir", scratch / "user", "--extensions-dir", scratch / "extensions")
    # A login shell is asked for the environment, and sets a PATH of its own before it reads this.
    (scratch / ".profile").write_text(f'PATH="{programs}:$PATH"\n')
    flags = (
        *("--disable-telemetry", "--disable-update-check", "--disable-workspace-trust"),
        *("--disable-getting-started-override", "--reconnection-grace-time", "5"),
    )
    entry = store / "vscode/node_modules/code-server/out/node/entry.js"
    command = [str(node), str(entry), *map(str, places), *flags]
    env = {**_home(scratch), "PATH": f"{programs}:{os.environ['PATH']}", "SHELL": "/bin/bash"}
    origin = f"http://127.0.0.1:{port}"
    for _ in range(6):
        with (scratch / "server.log").open("ab") as log:
            process = subprocess.Popen(command, stdout=log, stderr=log, env=env, cwd=scratch)
        try:
            if _answers(f"{origin}/healthz", process):
                yield origin
                return
        finally:
            process.terminate()
            process.wait(30)
    raise AssertionError("the server does not start")


def _answers(url: str, process: subprocess.Popen[bytes]) -> bool:
    """Wait for the server; False: it has ended, as it does where a busy machine does not start all of it in 10 s."""
    for _ in range(600):
        with suppress(OSError), urllib.request.urlopen(url, timeout=5):
            return True
        with suppress(subprocess.TimeoutExpired):
            process.wait(0.1)
            return False
    raise AssertionError("the server does not answer")


def _home(scratch: Path) -> dict[str, str]:
    return {**os.environ, "HOME": str(scratch), "XDG_CONFIG_HOME": str(scratch), "XDG_CACHE_HOME": str(scratch)}
