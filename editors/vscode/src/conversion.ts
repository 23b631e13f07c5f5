// XML as a mission: the server writes what `btq import` does, beside the XML, and both are open then.
import * as vscode from "vscode";

import { isTrees } from "./documents";
import type { Ask } from "./xml";

/** Convert the XML of the active editor; rejects with the reason if that cannot be done. */
export async function convert(ask: Ask, log: vscode.LogOutputChannel): Promise<void> {
  const document = vscode.window.activeTextEditor?.document;
  if (!isTrees(document)) {
    void vscode.window.showInformationMessage("Open BehaviorTree.CPP's XML first: the mission is written beside it.");
    return;
  }
  await document.save(); // what is written is what `btq import` makes of the file
  const { files, said } = (await ask("btq.server.import", { uri: document.uri.toString() })) as Converted;
  log.info(said);
  for (const file of files) {
    await vscode.window.showTextDocument(vscode.Uri.parse(file), { viewColumn: vscode.ViewColumn.Beside });
  }
}

interface Converted {
  readonly files: readonly string[];
  readonly said: string;
}
