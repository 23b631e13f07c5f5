// The tree beside the text: drawn by the server, following the edits and the cursor; a click goes to the node.
// One invariant: what is drawn was said by the server and stands in a page that loads nothing and runs one script of ours.
import { randomBytes } from "node:crypto";
import * as vscode from "vscode";

import type { Ask } from "./xml";

interface Picture {
  readonly svg: string;
  /** Where each node stands, by the id of its group in the picture; in the order of the text. */
  readonly nodes: Record<string, { readonly line: number; readonly character: number }>;
}

type FromPage = { readonly go: string } | { readonly ready: true };

export class TreeView {
  private panel: vscode.WebviewPanel | undefined;
  private document: vscode.TextDocument | undefined;
  private picture: Picture | undefined;
  private timer: NodeJS.Timeout | undefined;

  constructor(
    private readonly context: vscode.ExtensionContext,
    private readonly ask: Ask,
  ) {
    context.subscriptions.push(
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        // Requirements may stand in any other mission.
        if (document.languageId === "btq") this.soon();
      }),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => {
        if (textEditor.document === this.document) this.mark(textEditor.selection.active);
      }),
      vscode.window.onDidChangeActiveTextEditor((editor) => {
        if (editor?.document.languageId === "btq" && this.panel) void this.show();
      }),
    );
  }

  /** Draw the mission of the active editor, beside it. */
  async show(): Promise<void> {
    const document = vscode.window.activeTextEditor?.document;
    if (document?.languageId !== "btq") {
      void vscode.window.showInformationMessage("Open a mission first: its tree is drawn beside it.");
      return;
    }
    this.document = document;
    if (!this.panel) {
      const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
      this.panel = vscode.window.createWebviewPanel("btq.tree", "Tree", place, {
        enableScripts: true,
        retainContextWhenHidden: true,
        localResourceRoots: [],
      });
      this.panel.webview.html = page(randomBytes(16).toString("hex"));
      this.panel.webview.onDidReceiveMessage((message: FromPage) => ("go" in message ? this.go(message.go) : this.draw()));
      this.panel.onDidDispose(() => (this.panel = undefined), undefined, this.context.subscriptions);
    } else {
      await this.draw();
    }
    this.panel.title = `Tree of ${document.uri.path.split("/").pop()}`;
  }

  /** Write the picture to a file. */
  async save(): Promise<void> {
    const document = vscode.window.activeTextEditor?.document ?? this.document;
    if (document?.languageId !== "btq") return;
    const { svg } = await this.asked(document);
    const defaultUri = document.uri.with({ path: document.uri.path.replace(/\.\w+$/, ".svg") });
    const target = await vscode.window.showSaveDialog({ defaultUri, filters: { SVG: ["svg"] } });
    if (target) await vscode.workspace.fs.writeFile(target, new TextEncoder().encode(svg));
  }

  private soon(): void {
    clearTimeout(this.timer);
    if (this.panel) this.timer = setTimeout(() => void this.draw(), 200);
  }

  private async draw(): Promise<void> {
    const { document } = this;
    if (!document || !this.panel) return;
    try {
      this.picture = await this.asked(document);
      await this.panel.webview.postMessage({ svg: this.picture.svg });
      const editor = vscode.window.visibleTextEditors.find((one) => one.document === document);
      if (editor) this.mark(editor.selection.active);
    } catch (error) {
      await this.panel.webview.postMessage({ trouble: error instanceof Error ? error.message : String(error) });
    }
  }

  private async asked(document: vscode.TextDocument): Promise<Picture> {
    return (await this.ask("btq.server.picture", { uri: document.uri.toString() })) as Picture;
  }

  /** The node that the cursor is in: the last that begins before it. */
  private mark(cursor: vscode.Position): void {
    const before = Object.entries(this.picture?.nodes ?? {}).filter(([, at]) => at.line <= cursor.line);
    void this.panel?.webview.postMessage({ here: before.at(-1)?.[0] });
  }

  private async go(key: string): Promise<void> {
    const at = this.picture?.nodes[key];
    if (!at || !this.document) return;
    const selection = new vscode.Range(at.line, at.character, at.line, at.character);
    const viewColumn = vscode.window.visibleTextEditors.find((one) => one.document === this.document)?.viewColumn;
    await vscode.window.showTextDocument(this.document, { selection, viewColumn: viewColumn ?? vscode.ViewColumn.One });
  }
}

function page(nonce: string): string {
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'nonce-${nonce}'">
<title>Tree</title>
<style>
body { padding: 0; }
header { position: sticky; top: 0; padding: 6px; background: var(--vscode-editor-background); }
input { font: inherit; color: var(--vscode-input-foreground); background: var(--vscode-input-background);
  border: 1px solid var(--vscode-input-border, transparent); padding: 2px 6px; width: 14em; }
#trouble { color: var(--vscode-errorForeground); padding: 0 6px; }
svg { transform-origin: 0 0; }
.box { cursor: pointer; }
/* Over the picture's own rules, which are more particular. */
svg .ground { fill: transparent !important; }
.box.here .outline, .box:focus-visible .outline { stroke: var(--vscode-focusBorder) !important; stroke-width: 3 !important; }
.box:focus { outline: none; }
.box.other { opacity: 0.25; }
</style>
</head>
<body>
<header><input id="search" type="search" placeholder="Find a node" aria-label="Find a node"></header>
<p id="trouble" role="status"></p>
<main id="tree"></main>
<script nonce="${nonce}">
const editor = acquireVsCodeApi();
const tree = document.getElementById("tree");
const search = document.getElementById("search");
let zoom = 1;
let here;
const boxes = () => [...tree.querySelectorAll(".box")];
function draw(svg) {
  // The picture follows the reader's system; here it follows the editor's theme.
  const themed = svg.replace("@media (prefers-color-scheme: dark) {", ".vscode-dark, .vscode-high-contrast {");
  tree.innerHTML = themed;
  for (const box of boxes()) {
    box.tabIndex = 0;
    box.setAttribute("role", "button");
    box.setAttribute("aria-label", box.querySelector("title")?.textContent ?? "");
  }
  scale(zoom);
  mark(here);
  find();
}
function mark(key) {
  here = key;
  for (const box of boxes()) box.classList.toggle("here", box.id === key);
  document.getElementById(key)?.scrollIntoView({ block: "nearest", inline: "nearest" });
}
function find() {
  const wanted = search.value.toLowerCase();
  for (const box of boxes()) {
    box.classList.toggle("other", wanted !== "" && !box.textContent.toLowerCase().includes(wanted));
  }
}
function scale(to) {
  zoom = Math.min(4, Math.max(0.2, to));
  const svg = tree.querySelector("svg");
  if (svg) svg.style.transform = "scale(" + zoom + ")";
}
addEventListener("message", ({ data }) => {
  document.getElementById("trouble").textContent = data.trouble ?? "";
  if (data.svg !== undefined) draw(data.svg);
  if ("here" in data) mark(data.here);
});
tree.addEventListener("click", ({ target }) => {
  const box = target.closest(".box");
  if (box) editor.postMessage({ go: box.id });
});
addEventListener("wheel", (event) => {
  if (!event.ctrlKey) return;
  event.preventDefault();
  scale(zoom * (event.deltaY < 0 ? 1.1 : 1 / 1.1));
}, { passive: false });
addEventListener("keydown", (event) => {
  const all = boxes();
  const at = all.indexOf(document.activeElement);
  if (event.target === search) {
    if (event.key === "Enter") all.find((box) => !box.classList.contains("other"))?.focus();
    return;
  }
  if (event.key === "Enter" && at >= 0) editor.postMessage({ go: all[at].id });
  else if (event.key === "ArrowDown" || event.key === "ArrowRight") all[Math.min(at + 1, all.length - 1)]?.focus();
  else if (event.key === "ArrowUp" || event.key === "ArrowLeft") all[Math.max(at - 1, 0)]?.focus();
  else if (event.key === "+") scale(zoom * 1.1);
  else if (event.key === "-") scale(zoom / 1.1);
  else if (event.key === "0") scale(1);
  else return;
  event.preventDefault();
});
search.addEventListener("input", find);
editor.postMessage({ ready: true });
</script>
</body>
</html>`;
}
