// The overview of a mission beside its text: what is demanded of which node, how it is held, and what is missing.
// One invariant: the page is the one that `btq trace --format html` writes, in the editor's colours; a place in it leads to
// the text.
import { randomBytes } from "node:crypto";
import * as vscode from "vscode";

import { isOurs } from "./documents";
import { iconPath } from "./treeView";
import type { Ask } from "./xml";

export class OverviewView {
  private panel: vscode.WebviewPanel | undefined;
  private document: vscode.TextDocument | undefined;

  constructor(
    private readonly context: vscode.ExtensionContext,
    private readonly ask: Ask,
  ) {
    context.subscriptions.push(
      // Requirements may be in any other mission.  While somebody types, tables that jump would only disturb.
      vscode.workspace.onDidSaveTextDocument((document) => {
        if (isOurs(document)) void this.draw();
      }),
      vscode.window.onDidChangeActiveColorTheme(() => this.draw()),
    );
  }

  /** The overview of the active editor's mission, beside it; rejects with the reason if it cannot. */
  async show(): Promise<void> {
    const editor = vscode.window.activeTextEditor;
    const document = editor?.document;
    if (!isOurs(document)) {
      void vscode.window.showInformationMessage("Open a mission first: its overview is shown beside it.");
      return;
    }
    const page = await this.asked(document);
    this.document = document;
    if (!this.panel) {
      const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
      this.panel = vscode.window.createWebviewPanel("btq.overview", "Overview", place, {
        enableScripts: true,
        enableFindWidget: true,
        retainContextWhenHidden: true,
        localResourceRoots: [],
      });
      this.panel.iconPath = iconPath(this.context);
      this.panel.webview.onDidReceiveMessage(({ go }: { readonly go: string }) => this.go(go));
      this.panel.onDidDispose(() => (this.panel = undefined));
    }
    this.panel.title = `Overview of ${document.uri.path.split("/").pop()}`;
    this.panel.webview.html = inEditor(page);
    // Never over the text: both may have come into one column.
    const isOverText = this.panel.viewColumn === editor?.viewColumn;
    this.panel.reveal(isOverText ? vscode.ViewColumn.Beside : undefined, true);
    await leaveHalf(this.panel.viewColumn);
  }

  /** Draw again, if an overview is shown. */
  async draw(): Promise<void> {
    if (!this.panel || !this.document) return;
    try {
      const page = await this.asked(this.document);
      if (this.panel) this.panel.webview.html = inEditor(page);
    } catch {
      // What was shown stays: why the server is silent is said by the status item.
    }
  }

  private async asked(document: vscode.TextDocument): Promise<string> {
    return String(await this.ask("btq.server.overview", { uri: document.uri.toString() }));
  }

  /** Go to a place as the page has it, `path:line:column`; its paths are as seen from the first folder. */
  private async go(place: string): Promise<void> {
    const [, path, line, column] = /^(.+):(\d+):(\d+)$/.exec(place) ?? [];
    if (path === undefined) return;
    const folder = vscode.workspace.workspaceFolders?.[0]?.uri ?? vscode.Uri.file("/");
    const isAbsolute = /^(\/|[A-Za-z]:[\\/])/.test(path);
    const uri = isAbsolute ? vscode.Uri.file(path) : vscode.Uri.joinPath(folder, path);
    const at = new vscode.Position(Number(line) - 1, Number(column) - 1);
    const viewColumn = vscode.window.visibleTextEditors[0]?.viewColumn ?? vscode.ViewColumn.One;
    await vscode.window.showTextDocument(uri, { selection: new vscode.Range(at, at), viewColumn });
  }
}

/** Share the pane evenly where a column has more than half of it. */
async function leaveHalf(column: vscode.ViewColumn | undefined): Promise<void> {
  const { orientation, groups } = (await vscode.commands.executeCommand("vscode.getEditorLayout")) as Layout;
  const [own, whole] = [groups[(column ?? 0) - 1]?.size ?? 0, groups.reduce((sum, { size }) => sum + (size ?? 0), 0)];
  const isFlat = orientation === 0 && groups.every(({ groups }) => groups === undefined);
  if (isFlat && own > whole / 2) await vscode.commands.executeCommand("workbench.action.evenEditorWidths");
}

interface Layout {
  /** 0: columns beside each other. */
  readonly orientation: number;
  readonly groups: readonly { readonly size?: number; readonly groups?: unknown }[];
}

/** The page in the editor's theme, with places that can be followed, and as it was scrolled and filtered before. */
function inEditor(page: string): string {
  const { kind } = vscode.window.activeColorTheme;
  const isDark = kind === vscode.ColorThemeKind.Dark || kind === vscode.ColorThemeKind.HighContrast;
  const nonce = randomBytes(16).toString("hex");
  const policy = `default-src 'none'; style-src 'unsafe-inline'; script-src 'nonce-${nonce}'`;
  return page
    .replaceAll("(prefers-color-scheme: dark)", isDark ? "(min-width: 0)" : "(max-width: 0)")
    .replace("<head>", () => `<head><meta http-equiv="Content-Security-Policy" content="${policy}">`)
    .replace("</head>", () => `<style>:root { color-scheme: ${isDark ? "dark" : "light"}; }\n${STYLE}</style></head>`)
    .replace("</body>", () => `<script>${SCRIPT}</script></body>`)
    .replaceAll("<script>", `<script nonce="${nonce}">`);
}

const STYLE = `
:root { --ink: var(--vscode-editor-foreground); --ground: var(--vscode-editor-background);
  --soft: var(--vscode-descriptionForeground); --raised: var(--vscode-editorWidget-background);
  --line: color-mix(in srgb, var(--vscode-editor-foreground) 25%, transparent); --accent: var(--vscode-textLink-foreground); }
html { font-size: calc(var(--vscode-font-size) * 1.1); }
body { padding: 0; font: var(--vscode-font-size)/1.45 var(--vscode-font-family); }
code { color: inherit; background: none; font-family: var(--vscode-editor-font-family); }
.at { cursor: pointer; text-decoration: underline; text-decoration-color: var(--line); text-underline-offset: .15em; }
.at:hover { color: var(--accent); }
`;

const SCRIPT = `
"use strict";
(() => {
  const editor = acquireVsCodeApi();
  const follow = (event) => {
    const at = event.target.closest?.(".at");
    if (!at || (event.type === "keydown" && event.key !== "Enter")) return;
    // A row of the table would take the click for itself.
    event.stopPropagation();
    event.preventDefault();
    editor.postMessage({ go: at.title });
  };
  for (const at of document.querySelectorAll(".at")) {
    at.tabIndex = 0;
    at.setAttribute("role", "link");
  }
  addEventListener("click", follow, true);
  addEventListener("keydown", follow, true);
  const { elements } = document.querySelector(".filter");
  const NAMES = ["text", "way", "of"];
  const before = editor.getState();
  if (before) {
    for (const name of NAMES) elements[name].value = before[name];
    elements.text.dispatchEvent(new Event("input", { bubbles: true }));
    scrollTo({ top: before.top, behavior: "instant" });
  }
  const keep = () => editor.setState({ top: scrollY, ...Object.fromEntries(NAMES.map((name) => [name, elements[name].value])) });
  addEventListener("scroll", keep);
  addEventListener("input", keep);
  addEventListener("reset", () => setTimeout(keep));
})();
`;
