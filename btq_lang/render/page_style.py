"""The style sheet that all pages share, light, dark and for paper: without network, fonts or other files."""

from __future__ import annotations

from typing import Final

PAGE_STYLE: Final = """\
:root { color-scheme: light dark; --ink: #14181c; --soft: #55606b; --ground: #ffffff; --raised: #f5f7f9;
  --line: #d3dae1; --accent: #0b5cad; --chosen: #d9ebff; --enforced: #1b6b3a; --monitored: #0b5cad;
  --reviewed: #8a4b00; --missing: #b3261e; }
@media screen and (prefers-color-scheme: dark) { :root { --ink: #eef1f4; --soft: #a7b2bd; --ground: #16191d;
  --raised: #1f242a; --line: #3a434d; --accent: #7cb8ff; --chosen: #1d3f63; --enforced: #79d39c;
  --monitored: #7cb8ff; --reviewed: #efb266; --missing: #ff8f86; } }
* { box-sizing: border-box; }
html { scroll-padding-top: 1rem; }
body { margin: 0; color: var(--ink); background: var(--ground); line-height: 1.45;
  font: 15px/1.45 system-ui, "Segoe UI", Helvetica, Arial, sans-serif; }
header, main { padding: 0 1.5rem; }
h1 { font-size: 1.45rem; margin: 1.25rem 0 .25rem; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 1.5rem 0 .5rem; }
h3 { font-size: 1rem; margin: 1rem 0 .25rem; display: inline-block; overflow-wrap: anywhere; max-width: 100%; }
a { color: var(--accent); text-underline-offset: .15em; }
.skip { position: absolute; left: -99rem; }
.skip:focus { left: 1rem; top: .5rem; background: var(--ground); padding: .25rem .5rem; }
nav ul { display: flex; flex-wrap: wrap; gap: .25rem 1rem; list-style: none; padding: 0; margin: .5rem 0; }
table { border-collapse: collapse; width: 100%; }
caption { text-align: left; color: var(--soft); font-size: .9rem; padding-bottom: .35rem; }
th, td { text-align: left; vertical-align: top; padding: .5rem .6rem; border-bottom: 1px solid var(--line);
  font-weight: normal; overflow-wrap: anywhere; }
thead th { font-weight: 600; border-bottom: 2px solid var(--line); overflow-wrap: normal; }
th p { margin: .15rem 0; }
td ul, th ul, .gaps { list-style: none; margin: 0; padding: 0; }
td li + li { margin-top: .25rem; }
.name { font-weight: 600; }
code { font: .88em ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
small { color: var(--soft); }
.missing { color: var(--missing); }
.numbers td { text-align: right; font-variant-numeric: tabular-nums; }
.numbers thead th:not(:first-child) { text-align: right; }
.numbers th, .numbers td { overflow-wrap: normal; } .numbers td { white-space: nowrap; }
@media (max-width: 700px) { header, main { padding: 0 .8rem; }
  .numbers th, .numbers td { padding: .3rem .4rem; font-size: .85rem; }
  .numbers th:first-child { position: sticky; left: 0; min-width: 9rem; overflow-wrap: anywhere;
    background: var(--ground); } }
.verdict { font-weight: 700; white-space: nowrap; }
.verdict::before { content: "\\25CB\\00A0"; }
.verdict.violated { color: var(--missing); } .verdict.violated::before { content: "\\2716\\00A0"; }
.verdict.satisfied { color: var(--enforced); } .verdict.satisfied::before { content: "\\2714\\00A0"; }
.verdict.undecided, .verdict.unknown, .verdict.never-exercised, .verdict.open { color: var(--reviewed); }
.empty { color: var(--soft); }
.legend { margin: .25rem 0; font-size: .85rem; }
.scroll { overflow: auto; border: 1px solid var(--line); border-radius: 6px; background:
  linear-gradient(to right, var(--ground) 40%, transparent) left / 2.5rem 100% no-repeat local,
  linear-gradient(to left, var(--ground) 40%, transparent) right / 2.5rem 100% no-repeat local,
  linear-gradient(to right, rgb(110 120 130 / .6), transparent) left / .9rem 100% no-repeat,
  linear-gradient(to left, rgb(110 120 130 / .6), transparent) right / .9rem 100% no-repeat, var(--ground); }
.scroll caption { padding: .35rem .6rem; }
.scroll::-webkit-scrollbar { height: .7rem; } .scroll::-webkit-scrollbar-track { background: var(--raised); }
.scroll::-webkit-scrollbar-thumb { background: var(--soft); border-radius: .35rem; }
:focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
@media print { @page { margin: 14mm; } body { font-size: 10.5pt; } nav, .skip { display: none; }
  tr, figure { break-inside: avoid; } thead { display: table-header-group; }
  .scroll { overflow: visible; border: 0; } a { color: inherit; text-decoration: none; } }
@media (prefers-reduced-motion: no-preference) { html { scroll-behavior: smooth; } }
"""
