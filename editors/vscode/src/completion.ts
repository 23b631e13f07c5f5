// Tells a list that VS Code opens by itself from one that somebody asks for: it requests both alike, so the server could
// not keep the first from a complete word without keeping the second, too.  Only the time tells: VS Code requests a
// list as soon as a letter is typed.
import * as vscode from "vscode";
import type { CompletionMiddleware } from "vscode-languageclient/node";

const SOON = 100; // milliseconds: nobody presses Ctrl+Space so soon after a letter

/** The letter that was typed last, until a list is requested because of it. */
let typed: { document: vscode.TextDocument; end: vscode.Position; time: number } | undefined;

export function watchTyping(): vscode.Disposable {
  return vscode.workspace.onDidChangeTextDocument(({ document, contentChanges: [change, ...others] }) => {
    if (!["btq", "xml"].includes(document.languageId) || change === undefined) return;
    const isLetter = change.text.length === 1 && others.length === 0;
    typed = isLetter ? { document, end: change.range.start.translate(0, 1), time: Date.now() } : undefined;
  });
}

export const completion: CompletionMiddleware = {
  provideCompletionItem: (document, position, context, token, next) => {
    const isTyped = typed?.document === document && typed.end.isEqual(position) && Date.now() - typed.time < SOON;
    typed = undefined;
    if (!isTyped || context.triggerKind !== vscode.CompletionTriggerKind.Invoke) {
      return next(document, position, context, token);
    }
    // Of the kinds that the protocol has, this one says that nobody asks.
    const triggerKind = vscode.CompletionTriggerKind.TriggerForIncompleteCompletions;
    return next(document, position, { ...context, triggerKind }, token);
  },
};
