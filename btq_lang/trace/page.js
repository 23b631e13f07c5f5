"use strict";
(() => {
  const all = (selector) => [...document.querySelectorAll(selector)];
  const parts = all("[data-note], [data-notes]").filter((part) => !part.closest("#overview"));
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
  for (const box of all(".trees .box[data-notes]")) {
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
  const overview = document.querySelector("#overview");
  const within = (selector) => [...overview.querySelectorAll(selector)];
  const buttons = within(".by-quality button"), marks = within("[data-note], [data-notes]");
  const filterBy = (button) => {
    const keys = button.dataset.keys.split(" ");
    const isStrong = (part) => keysOf(part).some((key) => keys.includes(key));
    overview.classList.toggle("filtering", button.dataset.keys !== "");
    for (const each of buttons) each.setAttribute("aria-pressed", each === button);
    for (const part of marks) part.classList.toggle("strong", isStrong(part));
    for (const row of within("tr[data-keys]")) row.classList.toggle("strong", row.dataset.keys === button.dataset.keys);
    const strong = marks.filter((part) => part.matches(".box.strong"));
    const nodes = `${strong.length} ${strong.length === 1 ? "node" : "nodes"}`;
    live.textContent = button.dataset.keys ? `${button.textContent}: ${nodes}` : "all nodes";
    for (const frame of within(".scroll")) {
      const box = frame.querySelector(".box.strong"), edges = frame.getBoundingClientRect();
      const place = box && box.getBoundingClientRect();
      if (place && (place.right > edges.right || place.left < edges.left)) {
        frame.scrollLeft += place.left - edges.left - (edges.width - place.width) / 2;
      }
    }
  };
  for (const group of within(".by-quality")) group.hidden = false;
  for (const button of buttons) button.addEventListener("click", () => filterBy(button));
  const form = document.querySelector(".filter");
  const rows = all("tr.row"), gaps = all(".gaps li");
  const filter = () => {
    const text = form.elements.text.value.trim().toLowerCase();
    const way = form.elements.way.value, of = form.elements.of.value;
    for (const row of rows) {
      row.hidden = !((!text || row.textContent.toLowerCase().includes(text))
        && (!way || row.dataset.way.includes(way)) && (!of || row.dataset.of.split(" ").includes(of)));
    }
    for (const gap of gaps) gap.hidden = !gap.textContent.toLowerCase().includes(text);
    live.textContent = `${rows.filter((row) => !row.hidden).length} rows`;
  };
  const folded = all("details:not([open])");
  addEventListener("beforeprint", () => { for (const each of folded) each.open = true; });
  addEventListener("afterprint", () => { for (const each of folded) each.open = false; });
  form.hidden = false;
  form.addEventListener("input", filter);
  form.addEventListener("reset", () => setTimeout(filter));
  form.addEventListener("submit", (event) => event.preventDefault());
})();
