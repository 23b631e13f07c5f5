"""The style sheet of the page, and its words for what has no name."""

from __future__ import annotations

from typing import Final

from btq_lang.render.chart import CHART_STYLE

NO_NAME: Final = "(none)"
DOTTED: Final = "a dotted line is where the first run of a label begins"
REPORT_STYLE: Final = f"""{CHART_STYLE}\
main {{ max-width: 90rem; padding-bottom: 3rem; }}
h3 {{ display: block; margin-top: 1.5rem; }}
.tiles {{ display: flex; flex-wrap: wrap; gap: .75rem; list-style: none; padding: 0; margin: .75rem 0; }}
.tiles li {{ flex: 1 1 9rem; padding: .5rem .8rem; background: var(--raised); border: 1px solid var(--line);
  border-radius: 6px; border-left: 5px solid var(--enforced); }}
.tiles li.bad {{ border-left-color: var(--missing); }}
.tiles strong {{ display: block; font-size: 1.6rem; line-height: 1.2; }}
.tiles .bad strong {{ color: var(--missing); }}
.tiles strong::after {{ content: " \\2714"; font-size: 1rem; color: var(--enforced); }}
.tiles .bad strong::after {{ content: " \\2716"; color: var(--missing); }}
.worse {{ font-weight: 700; color: var(--missing); white-space: nowrap; }}
.worse::before {{ content: "\\2716\\00A0"; }}
@media (min-width: 701px) {{ .changes th {{ width: 12rem; }} .changes td:last-child {{ width: 40%; }}
  .parts tbody th {{ width: 26%; }} .robots tbody th {{ width: 12%; }} thead th {{ white-space: nowrap; }} }}
td small {{ display: block; }}
.last {{ background: var(--raised); }}
.trend {{ width: 15rem; max-width: 100%; }}
.measures {{ display: grid; gap: 1rem 2rem; grid-template-columns: repeat(auto-fill, minmax(min(100%, 24rem), 1fr)); }}
.measures figure {{ margin: 0; max-width: 34rem; }} .measures figcaption p {{ margin: .15rem 0; }}
.share {{ display: block; height: .35rem; margin-top: .2rem; background: var(--missing); border-radius: 2px; }}
details {{ margin: .5rem 0; }} summary {{ color: var(--accent); cursor: pointer; }}
tr:target > th, tr:target > td {{ background: var(--chosen); }}
@media (max-width: 700px) {{ header, main {{ padding-left: .8rem; padding-right: .8rem; }}
  main table, main tbody, main tr, main th, main td {{ display: block; }}
  main thead {{ display: none; }} main caption {{ display: block; }}
  main tr {{ border-bottom: 1px solid var(--line); padding: .3rem 0; }}
  main tbody th, main tbody td {{ border: 0; padding: .15rem .3rem; }}
  .parts tbody th, .robots tbody th {{ font-weight: 600; }}
  main td[data-of]::before {{ content: attr(data-of) ": "; color: var(--soft); }}
  .tiles li {{ flex: 1 1 40%; }} }}
@media print {{ .tiles li, .last {{ background: none; }} }}
"""
