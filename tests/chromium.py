"""A browser without a window."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from html import unescape
from pathlib import Path
from typing import Any

ARTIFACTS = Path(__file__).parent / "artifacts"


# The shell starts with a quarter of the work of a browser that can have a window.
CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"))), None
)


FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run", "--disable-extensions")
DARK = "--blink-settings=preferredColorScheme=0"


def chromium(folder: Path, *arguments: str) -> str:
    """What the browser prints; its profile is in the folder."""
    assert CHROMIUM is not None
    command = (CHROMIUM, *FLAGS, "--allow-file-access-from-files", f"--user-data-dir={folder / 'profile'}", *arguments)
    environment = {**os.environ, "HOME": str(folder)}
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=120, env=environment).stdout


def seen_in(folder: Path, page: str, script: str, width: int) -> Any:
    """What a script returns in a page that is as wide as a window of so many pixels."""
    acting = f"<script>document.body.dataset.seen = JSON.stringify((() => {{ {script} }})());</script>"
    (folder / "framed.html").write_text(page.replace("</body>", f"{acting}</body>"), encoding="utf-8")
    copying = "<script>onload = () => document.body.dataset.seen = frames[0].document.body.dataset.seen;</script>"
    frame = _framed(folder, "framed.html", width, 1200, copying)
    dom = chromium(folder, "--window-size=1500,1200", "--dump-dom", frame)
    found = re.search(r'<body[^>]* data-seen="([^"]*)"', dom)
    assert found is not None, dom[-2000:]
    return json.loads(unescape(found[1]))


def keep_screenshots(folder: Path, name: str, page: str, width: int, height: int) -> None:
    """Keep pictures of a page in `ARTIFACTS`, light and dark."""
    ARTIFACTS.mkdir(exist_ok=True)
    (folder / "shot.html").write_text(page, encoding="utf-8")
    frame = _framed(folder, "shot.html", width, height)
    for scheme, flags in (("light", ()), ("dark", (DARK,))):
        target = ARTIFACTS / f"{name}-{width}-{scheme}.png"
        target.unlink(missing_ok=True)
        chromium(folder, *flags, f"--window-size={width},{height}", f"--screenshot={target}", frame)
        assert target.read_bytes().startswith(b"\x89PNG")


def _framed(folder: Path, page: str, width: int, height: int, script: str = "") -> str:
    """The address of a page that shows another in a frame: a window without one is at least 500 pixels wide."""
    frame = folder / f"frame-of-{page}"
    shown = f'<iframe src="{page}" width="{width}" height="{height}" style="border: 0"></iframe>'
    frame.write_text(f'<body style="margin: 0">{shown}{script}</body>', encoding="utf-8")
    return frame.as_uri()


BROAD = "return document.documentElement.scrollWidth - innerWidth;"
