"""The documentation site: it is built without a warning, and every rule, node, quality and word has its place in it."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from html import unescape
from pathlib import Path

import pytest
from chromium import CHROMIUM, FLAGS

from btq_lang.catalog.language import PHRASES
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.qualities import qualities
from btq_lang.diagnostics.rules import RULES

pytest.importorskip("material", reason="MkDocs is not installed: pip install -e '.[docs]'")
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)]
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    run = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert (run.returncode, run.stdout + run.stderr) == (0, "")
    return folder


def text(site: Path, page: str) -> str:
    """What a page says, without its marks."""
    html = (site / page / "index.html").read_text(encoding="utf-8")
    (article,) = re.findall(r"<article.*?</article>", html, re.DOTALL)
    plain = re.sub(r"<[^>]+>", "", article)
    for name, sign in (("&lt;", "<"), ("&gt;", ">"), ("&quot;", '"'), ("&#39;", "'"), ("&amp;", "&")):
        plain = plain.replace(name, sign)
    return plain


def test_every_rule_has_a_page(site: Path) -> None:
    index = text(site, "rules")
    assert [rule.name for rule in RULES.values() if rule.name not in index] == []
    assert [rule.summary for rule in RULES.values() if rule.summary.replace("`", "") not in index] == []
    assert [name for name in RULES if name not in text(site, f"rules/{name}")] == []


def test_every_node_has_a_page_with_its_ports(site: Path) -> None:
    for kind in BUILTINS.values():
        page = text(site, f"nodes/{kind.tag}")
        assert [port.name for port in kind.ports if port.name not in page] == []


def test_every_quality_and_every_word_is_there(site: Path) -> None:
    page = text(site, "qualities")
    assert [each.id for each in qualities() if each.id not in page] == []
    words = text(site, "words")
    assert [each.form for each in PHRASES if each.form not in words] == []


def test_missions_are_coloured(site: Path) -> None:
    html = (site / "index.html").read_text(encoding="utf-8")
    for kind, word in (("kd", "QualityReq"), ("kd", "satisfies"), ("k", "-&gt;"), ("m", "30 s"), ("k", "Action")):
        assert f'<span class="{kind}">{word}</span>' in html


def test_every_block_is_a_block(site: Path) -> None:
    pages = {page.relative_to(site).as_posix(): page.read_text(encoding="utf-8") for page in site.rglob("*.html")}
    assert [
        name for name, html in pages.items() if "```" in html or "\\|" in re.sub(r"(?s)<pre>.*?</pre>", "", html)
    ] == []


def test_nothing_is_asked_of_another_server(site: Path) -> None:
    asked = [
        (page.relative_to(site).as_posix(), link)
        for page in site.rglob("*.html")
        for link in re.findall(r'<(?:script|img|link)[^>]+(?:src|href)="(https?://[^"]+)"', page.read_text("utf-8"))
    ]
    assert asked == []


# Material puts tables into boxes when the page has been loaded.
ON_A_PHONE = """<script>
addEventListener("load", () => setTimeout(() => {
  const style = (element) => getComputedStyle(element);
  const tables = [...document.querySelectorAll(".md-typeset__scrollwrap")].map((box) => ({
    scrolls: box.scrollWidth > box.clientWidth && style(box).overflowX === "auto",
    shadows: style(box).backgroundAttachment,
    over: style(box.querySelector("table")).backgroundColor,
  }));
  document.body.dataset.seen = JSON.stringify({ page: document.documentElement.scrollWidth, tables });
}, 200));
</script></body>"""


@pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium: only a browser can tell")
@pytest.mark.parametrize(("page", "wide"), [("index.html", 1), ("evidence/index.html", 1), ("nodes/index.html", 5)])
def test_a_wide_table_scrolls_in_its_box_on_a_phone(site: Path, page: str, wide: int) -> None:
    """The page itself does not, and shadows show where there is more."""
    assert CHROMIUM is not None
    html = (site / page).read_text(encoding="utf-8")
    phone = (site / page).with_name("phone.html")
    phone.write_text(html.replace("</body>", ON_A_PHONE), encoding="utf-8")
    command = [CHROMIUM, *FLAGS, "--window-size=390,844", "--virtual-time-budget=5000", "--dump-dom", phone.as_uri()]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    phone.unlink()
    (attribute,) = re.findall(r'data-seen="([^"]*)"', printed)
    seen = json.loads(unescape(attribute))
    assert seen["page"] <= 390
    assert [table["scrolls"] for table in seen["tables"]].count(True) == wide
    for table in seen["tables"]:
        assert (table["shadows"], table["over"]) == ("local, local, scroll, scroll", "rgba(0, 0, 0, 0)")
