// The XML of a mission as it stands in the editor, saved or not, in a document beside it that cannot be edited.
import { execFile } from "node:child_process";
import path from "node:path";
import * as vscode from "vscode";

const SCHEME = "btq-xml";

export class XmlView implements vscode.TextDocumentContentProvider {
  private readonly changed = new vscode.EventEmitter<vscode.Uri>();
  readonly onDidChange = this.changed.event;

  constructor(
    context: vscode.ExtensionContext,
    private readonly commandLine: () => Promise<string[]>,
  ) {
    let timer: NodeJS.Timeout | undefined;
    context.subscriptions.push(
      this.changed,
      vscode.workspace.registerTextDocumentContentProvider(SCHEME, this),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (document.languageId !== "btq") return;
        clearTimeout(timer);
        timer = setTimeout(() => {
          // Any mission may be included by the one that is shown.
          for (const { uri } of vscode.workspace.textDocuments) if (uri.scheme === SCHEME) this.changed.fire(uri);
        }, 400);
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
    const document = await vscode.workspace.openTextDocument(vscode.Uri.parse(uri.query, true));
    const [program, ...args] = await this.commandLine();
    if (program === undefined) return "<!-- there is no Python to write it -->\n";
    const { fsPath } = document.uri;
    const words = [...args, "build", "-", "--stdin-filename", fsPath];
    return new Promise((resolve) => {
      const child = execFile(program, words, { cwd: path.dirname(fsPath) }, (error, xml, complaint) =>
        resolve(error ? `<!--\n${complaint.replaceAll("--", "- -")}\n-->\n` : xml),
      );
      child.stdin?.on("error", () => undefined); // it ended before it read: the complaint says why
      child.stdin?.end(document.getText());
    });
  }
}
