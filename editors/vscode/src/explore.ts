// How a requirement can be violated: what a code lens and a code action of the server ask.
// One invariant: the server explores; a run that it finds is opened as the scenario that it writes.
import * as vscode from "vscode";
import { LSPErrorCodes, ResponseError } from "vscode-languageclient/node";

import type { Ask } from "./xml";

interface Explored {
  clauses: { answer: "yes" | "no" | "not found"; message: string }[];
  /** The runs as text, for people. */
  text: string;
  /** The same as a file that does not exist; null: no scenario says what happens in them. */
  scenarios: { uri: string; text: string } | null;
  problem: string;
}

/** Says whether a requirement can be violated, and opens a run for each mission where it can be. */
export async function explore(ask: Ask, document: { uri: string }, requirement: string): Promise<void> {
  let answers: Explored[];
  try {
    answers = (await ask("btq.server.explore", document, requirement)) as Explored[];
  } catch (error) {
    // The next key was pressed.
    if (!(error instanceof ResponseError && error.code === LSPErrorCodes.ContentModified)) throw error;
    vscode.window.setStatusBarMessage(`btq: ${error.message}`, 4000);
    return;
  }
  const violated = answers.filter(({ clauses }) => clauses.some(({ answer }) => answer === "yes"));
  for (const answer of violated) await open(answer);
  const messages = answers.flatMap(({ clauses, problem }) => [...clauses.map(({ message }) => message), problem]);
  const message = messages.filter(Boolean).join("\n");
  if (violated.length) void vscode.window.showWarningMessage(message);
  else void vscode.window.showInformationMessage(message);
}

async function open({ scenarios, text }: Explored): Promise<void> {
  if (!scenarios) {
    await vscode.window.showTextDocument(await vscode.workspace.openTextDocument({ content: text }));
    return;
  }
  // Untitled, and beside the mission when it is saved.
  const document = await vscode.workspace.openTextDocument(vscode.Uri.parse(scenarios.uri).with({ scheme: "untitled" }));
  const editor = await vscode.window.showTextDocument(document, vscode.ViewColumn.Beside);
  const all = new vscode.Range(0, 0, document.lineCount, 0);
  await editor.edit((edit) => edit.replace(all, scenarios.text));
}
