"""The page's own style sheet, its script, and texts with code in them."""

from __future__ import annotations

import re
from html import escape
from typing import Final


def coded(text: str) -> str:
    """A text for the page, with what is between backticks as code."""
    return _CODE.sub(r"<code>\1</code>", escape(text))


_CODE: Final = re.compile("`([^`]*)`")

TRACE_STYLE: Final = """\
.filter { display: flex; flex-wrap: wrap; gap: .5rem 1rem; align-items: end; padding: .75rem; margin: .5rem 0;
  background: var(--raised); border: 1px solid var(--line); border-radius: 6px; }
.filter[hidden] { display: none; }
.filter label { display: grid; font-size: .85rem; color: var(--soft); }
.filter input, .filter select, .filter button { font: inherit; color: var(--ink); background: var(--ground);
  border: 1px solid var(--line); border-radius: 4px; padding: .3rem .5rem; }
.filter input { min-width: 16rem; }
.beside { display: grid; gap: 2rem; grid-template-columns: minmax(0, 11fr) minmax(0, 9fr); align-items: start; }
.beside .trees { position: sticky; top: 0; max-height: 100vh; overflow-y: auto; }
.below .trees { display: flex; flex-wrap: wrap; gap: 0 2rem; align-items: start; }
.below .trees > h2, .below .trees > p { width: 100%; }
.below .gaps { columns: 22rem; }
.below figure { flex: 0 1 max(var(--wide) + 2px, 14rem); min-width: 0; max-width: 100%; }
@media (max-width: 1100px) { .beside { grid-template-columns: minmax(0, 1fr); }
  .beside .trees { position: static; max-height: none; } }
tr.row { cursor: pointer; }
tr.row > th:first-child { width: 44%; border-left: 4px solid transparent; }
.at { white-space: nowrap; }
.chip { display: inline-block; margin-top: .3rem; padding: 0 .5rem; border: 1px dashed var(--line);
  border-radius: .9rem; font-size: .85rem; }
.way { font-weight: 600; white-space: nowrap; }
.way::before { content: "\\25CB\\00A0"; }
.way.enforced { color: var(--enforced); } .way.enforced::before { content: "\\25CF\\00A0"; }
.way.monitored { color: var(--monitored); } .way.monitored::before { content: "\\25D0\\00A0"; }
.way.reviewed { color: var(--reviewed); }
.way.none { color: var(--missing); }
.key { padding: 0 .5rem; margin-right: .35rem; border: 1.5px dashed #a8650f; border-radius: 3px; }
.key.enforced { border-style: solid; border-width: 2.5px; } .key.reviewed { border-style: dotted; }
.key.quality { border-color: #2f7d4f; border-radius: 99px; }
figure { margin: 0 0 1rem; content-visibility: auto; contain-intrinsic-size: auto 20rem; }
.given { display: inline-block; }
svg.tree { display: block; max-width: 100%; height: auto; }
svg a { text-decoration: none; }
.note, .box[data-notes] { cursor: pointer; }
.near > th, .near > td, .chosen > th, .chosen > td, tr:target > th, tr:target > td { background: var(--chosen); }
tr.chosen > th:first-child, tr:target > th:first-child { border-left-color: var(--accent); }
.box.near .outline, .note.near .outline { stroke: var(--accent); stroke-width: 2.5; }
.box.chosen .outline, .note.chosen .outline, .box:target .outline { stroke: var(--accent); stroke-width: 3.5; }
.box.chosen .outline, .box:target .outline { fill: var(--chosen); }
.choosing .box:not(.chosen):not(.near), .choosing .note:not(.chosen):not(.near) { opacity: .45; }
.incomplete { padding: .5rem .75rem; border-left: 4px solid var(--missing); background: var(--raised); }
.live { position: absolute; left: -99rem; }
.sortable thead button { font: inherit; color: inherit; background: none; border: 0; padding: 0; cursor: pointer;
  text-align: inherit; white-space: nowrap; }
.sortable thead button::after { content: "\\00A0\\2195"; color: var(--soft); }
[aria-sort="ascending"] button::after { content: "\\00A0\\2191"; color: var(--ink); }
[aria-sort="descending"] button::after { content: "\\00A0\\2193"; color: var(--ink); }
@media (max-width: 700px) { .tables > section > table, .tables > section > table > :not(thead),
  .tables > section > table > tbody > tr > * { display: block; width: auto; }
  .tables > section > table > tbody > tr { display: block; border-bottom: 1px solid var(--line); padding: .3rem 0; }
  .tables > section > table > tbody > tr[hidden] { display: none; }
  .tables > section > table > thead { display: none; }
  .tables > section > table > tbody > tr > * { border-bottom: 0; padding: .2rem .5rem; }
  tr.row > td:empty { display: none; } tr.row > td::before { color: var(--soft); font-size: .9rem; }
  #requirements td:nth-of-type(1)::before { content: "Holds for"; }
  #requirements td:nth-of-type(2)::before { content: "How"; }
  #requirements td:nth-of-type(3)::before { content: "Evidence"; }
  #concerns td:nth-of-type(1)::before { content: "Concern of"; }
  #concerns td:nth-of-type(2)::before { content: "Requirements "; }
  tr.row > th:first-child { width: auto; } .filter input { min-width: 0; } }
@media print { .filter { display: none; } .beside { display: block; }
  .beside .trees { position: static; max-height: none; overflow: visible; } figure { content-visibility: visible; }
  svg.tree { max-width: 100%; height: auto; } .choosing .box, .choosing .note { opacity: 1 !important; } }
"""

# A click or Enter on a row, a note or a node selects its key (`r1`, `q2`); Escape or the same click deselects it.
SCRIPT: Final = """\
"use strict";
(() => {
  const all = (selector) => [...document.querySelectorAll(selector)];
  const parts = all("[data-note], [data-notes]");
  const keysOf = (part) => (part.dataset.note || part.dataset.notes).split(" ");
  const withKeys = (keys) => parts.filter((part) => keysOf(part).some((key) => keys.includes(key)));
  const live = document.querySelector(".live");
  let chosen = "";
  const mark = (name, keys) => {
    for (const part of parts) part.classList.toggle(name, keysOf(part).some((key) => keys.includes(key)));
  };
  const choose = (keys) => {
    chosen = keys.join(" ") === chosen ? "" : keys.join(" ");
    const now = chosen ? chosen.split(" ") : [];
    mark("chosen", now);
    document.body.classList.toggle("choosing", now.length > 0);
    const found = now.length ? withKeys(now) : [];
    const nodes = found.filter((part) => part.matches(".box")).length;
    live.textContent = now.length ? `${nodes} ${nodes === 1 ? "node" : "nodes"} highlighted` : "";
    return found;
  };
  const show = (part) => part && part.scrollIntoView({ block: "nearest", inline: "nearest" });
  for (const part of parts) {
    part.addEventListener("mouseenter", () => mark("near", keysOf(part)));
    part.addEventListener("mouseleave", () => mark("near", []));
    part.addEventListener("click", (event) => {
      const link = event.target.closest("a");
      const own = part.dataset.note;
      if (link && link.closest("td")) return;
      if (link && link.closest("svg") && part.matches(".box")) return;
      event.preventDefault();
      event.stopPropagation();
      const found = choose(keysOf(part));
      show(found.find((other) => own && part.matches("tr") ? other.matches(".box") : other.matches("tr")));
    });
  }
  for (const box of all(".box[data-notes]")) {
    box.setAttribute("tabindex", "0");
    box.setAttribute("role", "button");
    box.addEventListener("keydown", (event) => {
      if (event.key === "Enter") box.dispatchEvent(new MouseEvent("click"));
    });
  }
  document.addEventListener("keydown", (event) => { if (event.key === "Escape" && chosen) choose(chosen.split(" ")); });
  for (const table of all("table.sortable")) {
    const body = table.tBodies[0], written = [...body.rows];
    const heads = [...table.tHead.rows[0].cells];
    const keyOf = (row, at) => row.cells[at].dataset.value ?? row.cells[at].textContent;
    const compare = (one, other) => {
      return isNaN(one) || isNaN(other) ? one.localeCompare(other, "en") : one - other;
    };
    const sort = (head, at) => {
      const before = head.getAttribute("aria-sort");
      const order = at ? ["descending", "ascending", "none"] : ["ascending", "descending", "none"];
      const next = order[(order.indexOf(before) + 1) % order.length];
      for (const each of heads) each.setAttribute("aria-sort", each === head ? next : "none");
      const sign = next === "ascending" ? 1 : -1;
      const isLast = (row) => keyOf(row, at) === "";
      const sorted = next === "none" ? written : [...written].sort((one, other) =>
        isLast(one) - isLast(other) || sign * compare(keyOf(one, at), keyOf(other, at)));
      body.append(...sorted);
      live.textContent = next === "none" ? "in the order of the mission" : `by ${head.textContent}, ${next}`;
    };
    heads.forEach((head, at) => {
      const button = document.createElement("button");
      button.append(...head.childNodes);
      head.append(button);
      head.setAttribute("aria-sort", "none");
      button.addEventListener("click", () => sort(head, at));
    });
  }
  const form = document.querySelector(".filter");
  const rows = all("tr.row"), gaps = all(".gaps li");
  const filter = () => {
    const text = form.elements.text.value.trim().toLowerCase();
    const way = form.elements.way.value, of = form.elements.of.value;
    for (const row of rows) {
      row.hidden = !((!text || row.textContent.toLowerCase().includes(text))
        && (!way || row.dataset.way.includes(way)) && (!of || row.dataset.of === of));
    }
    for (const gap of gaps) gap.hidden = !gap.textContent.toLowerCase().includes(text);
    live.textContent = `${rows.filter((row) => !row.hidden).length} rows`;
  };
  form.hidden = false;
  form.addEventListener("input", filter);
  form.addEventListener("reset", () => setTimeout(filter));
  form.addEventListener("submit", (event) => event.preventDefault());
})();
"""
