// The tree beside the text: drawn by the server, following the edits and the cursor; a click goes to the node.
// One invariant: what is drawn was said by the server, and the page is the one that `btq preview` serves, too.
import { randomBytes } from "node:crypto";
import { readFile } from "node:fs/promises";
import path from "node:path";
import * as vscode from "vscode";

import { isOurs } from "./documents";
import type { Ask } from "./xml";

interface Picture {
  readonly svg: string;
  /** The place of each node, by the id of its group in the picture; in the order of the text. */
  readonly nodes: Record<string, { readonly line: number; readonly character: number }>;
}

/** The names of the nodes that are folded, and whether notes are; the key of a node; a picture. */
type FromPage = { readonly draw: string[] } | { readonly go: string } | { readonly save: string };

interface Run {
  readonly run: number;
  readonly said: string;
}

/** The tab of a page beside a mission: the mission's own icon. */
export function iconPath({ extensionUri }: vscode.ExtensionContext): { light: vscode.Uri; dark: vscode.Uri } {
  const icon = (theme: string): vscode.Uri => vscode.Uri.joinPath(extensionUri, "images", `file-${theme}.svg`);
  return { light: icon("light"), dark: icon("dark") };
}

export class TreeView {
  private panel: vscode.WebviewPanel | undefined;
  private document: vscode.TextDocument | undefined;
  private picture: Picture | undefined;
  private folded: string[] = [];
  /** Whether the page has had its first picture. */
  private drawn = Promise.resolve();
  private hasDrawn: () => void = () => undefined;
  private timer: NodeJS.Timeout | undefined;

  constructor(
    private readonly context: vscode.ExtensionContext,
    private readonly ask: Ask,
  ) {
    context.subscriptions.push(
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        // Requirements may be in any other mission.
        if (this.panel && isOurs(document)) this.soon();
      }),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => {
        if (textEditor.document === this.document) this.mark(textEditor.selection.active);
      }),
      vscode.window.onDidChangeActiveTextEditor((editor) => {
        if (this.panel && isOurs(editor?.document)) void this.show();
      }),
    );
  }

  /** Draw the mission of the active editor, beside it. */
  async show(): Promise<void> {
    const document = vscode.window.activeTextEditor?.document;
    if (!isOurs(document)) {
      void vscode.window.showInformationMessage("Open a mission first: its tree is drawn beside it.");
      return;
    }
    if (document !== this.document) this.folded = [];
    this.document = document;
    if (!this.panel) {
      this.drawn = new Promise((resolve) => (this.hasDrawn = resolve));
      const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
      this.panel = vscode.window.createWebviewPanel("btq.tree", "Tree", place, {
        enableScripts: true,
        retainContextWhenHidden: true,
        localResourceRoots: [],
      });
      this.panel.iconPath = iconPath(this.context);
      const page = await readFile(path.join(this.context.extensionPath, "python/btq_lang/preview/page.html"), "utf8");
      this.panel.webview.onDidReceiveMessage((message: FromPage) => this.asks(message));
      this.panel.webview.html = page.replaceAll("NONCE", randomBytes(16).toString("hex"));
      this.panel.onDidDispose(() => (this.panel = undefined), undefined, this.context.subscriptions);
    } else {
      await this.draw();
    }
    this.panel.title = `Tree of ${document.uri.path.split("/").pop()}`;
  }

  /** Show a run of the logs in the picture: the last, the worst of a requirement, or any, as the user chooses. */
  async showRun(): Promise<void> {
    const document = vscode.window.activeTextEditor?.document ?? this.document;
    if (!isOurs(document)) {
      void vscode.window.showInformationMessage("Open a mission first: a run is shown in its tree.");
      return;
    }
    const uri = document.uri.toString();
    const found = (await this.ask("btq.server.runs", { uri })) as readonly Run[];
    const items = found.map(({ run, said }) => ({ label: `Run ${run}`, description: said, run }));
    const other = { label: "Another run…", description: "by its number", run: 0 };
    const chosen = await vscode.window.showQuickPick([...items, other], { title: "Show Run" });
    const typed = chosen?.run === 0 ? await vscode.window.showInputBox({ title: "The number of the run" }) : chosen?.run;
    if (typed === undefined) return;
    const run = await this.ask("btq.server.run", { uri }, Number(typed));
    if (document !== this.document || !this.panel) await this.show();
    await this.drawn;
    this.panel?.reveal(undefined, false); // its keys step through the run
    await this.panel?.webview.postMessage({ run });
  }

  /** Write the picture to a file: as it is shown, or of the active editor's mission if that is another. */
  async save(): Promise<void> {
    const document = vscode.window.activeTextEditor?.document ?? this.document;
    if (!isOurs(document)) return;
    const folded = document === this.document && this.panel ? this.folded : ["+notes"];
    await this.write(document, (await this.asked(document, folded)).svg);
  }

  private async write(document: vscode.TextDocument, svg: string): Promise<void> {
    const defaultUri = document.uri.with({ path: document.uri.path.replace(/\.\w+$/, ".svg") });
    const target = await vscode.window.showSaveDialog({ defaultUri, filters: { SVG: ["svg"] } });
    if (target) await vscode.workspace.fs.writeFile(target, new TextEncoder().encode(svg));
  }

  private async asks(message: FromPage): Promise<void> {
    if ("go" in message) await this.go(message.go);
    else if ("save" in message && this.document) await this.write(this.document, message.save);
    else if ("draw" in message) {
      this.folded = message.draw;
      await this.draw();
    }
  }

  /** Draw again shortly, if a tree is shown. */
  soon(): void {
    clearTimeout(this.timer);
    if (this.panel) this.timer = setTimeout(() => void this.draw(), 200);
  }

  private async draw(): Promise<void> {
    const { document } = this;
    if (!document || !this.panel) return;
    try {
      this.picture = await this.asked(document, this.folded);
      await this.panel?.webview.postMessage({ svg: this.picture.svg, title: document.uri.path.split("/").pop() });
      const editor = vscode.window.visibleTextEditors.find((one) => one.document === document);
      if (editor) this.mark(editor.selection.active);
      this.hasDrawn();
    } catch (error) {
      await this.panel.webview.postMessage({ trouble: error instanceof Error ? error.message : String(error) });
    }
  }

  private async asked(document: vscode.TextDocument, folded: string[]): Promise<Picture> {
    return (await this.ask("btq.server.picture", { uri: document.uri.toString() }, ...folded)) as Picture;
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
