// The XML of a mission as it is in the editor, saved or not, in a document beside it that cannot be edited.
import * as vscode from "vscode";

import { isOurs } from "./documents";

const SCHEME = "btq-xml";

/** Asks the server a command; rejects with the reason why not. */
export type Ask = (command: string, ...parameters: unknown[]) => Promise<unknown>;

export class XmlView implements vscode.TextDocumentContentProvider {
  private readonly changed = new vscode.EventEmitter<vscode.Uri>();
  readonly onDidChange = this.changed.event;

  constructor(
    context: vscode.ExtensionContext,
    private readonly ask: Ask,
  ) {
    let timer: NodeJS.Timeout | undefined;
    context.subscriptions.push(
      this.changed,
      vscode.workspace.registerTextDocumentContentProvider(SCHEME, this),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (!isOurs(document)) return;
        clearTimeout(timer);
        timer = setTimeout(() => {
          // Any mission may be included by the one that is shown.
          for (const { uri } of vscode.workspace.textDocuments) if (uri.scheme === SCHEME) this.changed.fire(uri);
        }, 300);
      }),
    );
  }

  async show(): Promise<void> {
    const editor = vscode.window.activeTextEditor;
    if (editor?.document.languageId !== "btq") {
      void vscode.window.showInformationMessage("Open a mission first: its XML is shown beside it.");
      return;
    }
    const { uri } = editor.document;
    const document = await vscode.workspace.openTextDocument(
      vscode.Uri.from({ scheme: SCHEME, path: `${uri.path}.xml`, query: uri.toString() }),
    );
    await vscode.languages.setTextDocumentLanguage(document, "xml");
    await vscode.window.showTextDocument(document, { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true });
  }

  async provideTextDocumentContent(uri: vscode.Uri): Promise<string> {
    try {
      return String(await this.ask("btq.server.xml", { uri: uri.query }));
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      return `<!-- ${reason.replaceAll("--", "- -")} -->\n`;
    }
  }
}
