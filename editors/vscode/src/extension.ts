// What VS Code starts: the language client, its commands, the task, and what the status bar says.
// One invariant: whatever goes wrong with the server is said once, with a button that helps, and the rest goes on working.
import { execFile } from "node:child_process";
import * as vscode from "vscode";
import {
  ExecuteCommandRequest,
  LanguageClient,
  type Location,
  type MessageSignature,
  type Position,
  State,
  TransportKind,
} from "vscode-languageclient/node";

import { completion, watchTyping } from "./completion";
import { convert } from "./conversion";
import { isOurs, isTrees, SELECTOR } from "./documents";
import { explore } from "./explore";
import { OverviewView } from "./overview";
import { activeInterpreter, onInterpreterChange } from "./pythonExtension";
import { type AskUntil, Scenarios } from "./scenarios";
import { findServer, NoPython, type Server } from "./server";
import { Tasks } from "./tasks";
import { TreeView } from "./treeView";
import { type Ask, XmlView } from "./xml";

let client: LanguageClient | undefined;
let server: Server | undefined;
let turn: Promise<void> = Promise.resolve();
/** Starts that are asked for and whose predecessor is not yet stopped. */
let waiting = 0;

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const log = vscode.window.createOutputChannel("btq", { log: true });
  const status = vscode.languages.createLanguageStatusItem("btq.server", { language: "btq" });
  status.name = "btq";
  status.command = { command: "btq.showLog", title: "Show Log" };

  const line = (): Promise<string[]> => commandLine(context);
  const askUntil: AskUntil = async (token, command, ...parameters) => {
    await turn; // a request during the start gets an answer
    if (!client?.isRunning()) throw new Error("The btq server is not running.");
    return client.sendRequest(ExecuteCommandRequest.type, { command, arguments: parameters }, token);
  };
  const ask: Ask = (...asked) => askUntil(NEVER, ...asked);
  const xml = new XmlView(context, ask);
  const tree = new TreeView(context, ask);
  const overview = new OverviewView(context, ask);
  const scenarios = new Scenarios(context, ask, askUntil);
  const judged = (): void => {
    tree.soon();
    void overview.draw();
  };
  const tasks = new Tasks(line, () => {
    return (client?.isRunning() ?? false) && vscode.workspace.getConfiguration("btq").get("checkClosedFiles", true);
  });

  // One start at a time, in the order asked for: two servers would answer everything twice.
  let isWanted = false;
  const restart = (): Promise<void> => {
    isWanted = true;
    waiting += 1;
    turn = turn.then(() => start(context, log, status, judged));
    scenarios.soon();
    return turn;
  };
  const again = async (): Promise<void> => (isWanted ? restart() : undefined);
  // The first document for btq is enough; other XML does not start the server.
  const begin = async (document: vscode.TextDocument): Promise<void> => {
    if (!isWanted && isOurs(document)) await restart();
  };

  context.subscriptions.push(
    log,
    status,
    watchTyping(),
    vscode.commands.registerCommand("btq.restartServer", restart),
    vscode.commands.registerCommand("btq.showLog", () => log.show()),
    vscode.commands.registerCommand("btq.chooseInterpreter", chooseInterpreter),
    vscode.commands.registerCommand("btq.newProject", () => newProject(context)),
    vscode.commands.registerCommand("btq.check", () => tasks.run("check")),
    // What the server's code lenses run: positions come as the protocol has them.
    vscode.commands.registerCommand("btq.showReferences", async (uri: string, at: Position, places: Location[]) => {
      const converter = client?.protocol2CodeConverter;
      if (!converter) return;
      const found = places.map(({ uri, range }) => new vscode.Location(vscode.Uri.parse(uri), converter.asRange(range)));
      const here = converter.asPosition(at);
      await vscode.commands.executeCommand("editor.action.showReferences", vscode.Uri.parse(uri), here, found);
    }),
    vscode.commands.registerCommand("btq.runScenario", ({ uri }: { uri: string }, title: string) =>
      orSay(() => scenarios.runTitle(uri, title))(),
    ),
    vscode.commands.registerCommand("btq.explore", (document: { uri: string }, requirement: string) =>
      orSay(() => explore(ask, document, requirement))(),
    ),
    vscode.commands.registerCommand("btq.build", () => tasks.run("build")),
    vscode.commands.registerCommand("btq.showTree", () => tree.show()),
    vscode.commands.registerCommand("btq.showRun", orSay(() => tree.showRun())),
    vscode.commands.registerCommand("btq.saveTree", orSay(() => tree.save())),
    vscode.commands.registerCommand("btq.showXml", () => xml.show()),
    vscode.commands.registerCommand("btq.convert", orSay(() => convert(ask, log))),
    vscode.commands.registerCommand("btq.openOverview", orSay(() => overview.show())),
    vscode.commands.registerCommand("btq.copyNodePath", orSay(() => copyNodePath(ask))),
    vscode.tasks.registerTaskProvider("btq", tasks),
    vscode.workspace.onDidSaveTextDocument(async (document) => {
      if (document.languageId === "btq" && vscode.workspace.getConfiguration("btq", document).get("buildOnSave")) {
        await buildSaved(document, await line(), log);
      }
    }),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (["btq.interpreter", "btq.importStrategy", "btq.server"].some((name) => change.affectsConfiguration(name))) {
        void again();
      }
    }),
    vscode.workspace.onDidGrantWorkspaceTrust(again),
    vscode.workspace.onDidOpenTextDocument(begin),
    vscode.workspace.onDidChangeTextDocument(({ document }) => begin(document)),
    vscode.window.onDidChangeActiveTextEditor(offer),
    vscode.workspace.onDidChangeTextDocument(({ document }) => {
      if (document === vscode.window.activeTextEditor?.document) offer(vscode.window.activeTextEditor);
    }),
  );
  offer(vscode.window.activeTextEditor);
  await onInterpreterChange(context, again);
  await openNewMission(context);
  if (vscode.workspace.textDocuments.some(isOurs) || (await hasMissions())) await restart();
}

/** Whether a file of the open folders is in the language: the server reports on closed files, too. */
async function hasMissions(): Promise<boolean> {
  return (await vscode.workspace.findFiles("**/*.{btq,qualitybtcpp}", undefined, 1)).length > 0;
}

/** Of requests that nobody cancels. */
const NEVER = new vscode.CancellationTokenSource().token;

let isOffered = false;

/** Offers the commands for trees where the active editor has XML with some. */
function offer(editor: vscode.TextEditor | undefined): void {
  const hasTrees = isTrees(editor?.document);
  if (hasTrees !== isOffered) void vscode.commands.executeCommand("setContext", "btq.inXml", (isOffered = hasTrees));
}

/** Says nothing of requests that fail because the server is being stopped: their answers are nobody's loss. */
class Client extends LanguageClient {
  override handleFailedRequest<T>(
    type: MessageSignature,
    token: vscode.CancellationToken | undefined,
    error: unknown,
    defaultValue: T,
    showNotification = true,
    throwOnCancel?: boolean,
  ): T {
    const shows = showNotification && this.isRunning();
    return super.handleFailedRequest(type, token, error, defaultValue, shows, throwOnCancel);
  }
}

export async function deactivate(): Promise<void> {
  await turn;
  await client?.dispose();
}

async function start(
  context: vscode.ExtensionContext,
  log: vscode.LogOutputChannel,
  status: vscode.LanguageStatusItem,
  judged: () => void,
): Promise<void> {
  await client?.dispose().catch((error: unknown) => log.warn(`the server did not stop: ${error}`));
  client = undefined;
  waiting -= 1;
  await vscode.commands.executeCommand("setContext", "btq.serverRuns", false);
  status.text = "btq";
  status.detail = "starting";
  status.busy = true;
  status.severity = vscode.LanguageStatusSeverity.Information;
  try {
    server = await findServer(context.extensionPath, await activeInterpreter());
    log.info(`starting ${server.origin}: ${[server.command, ...server.args].join(" ")}`);
    client = new Client(
      "btq",
      "btq",
      { command: server.command, args: server.args, transport: TransportKind.stdio },
      {
        documentSelector: SELECTOR,
        outputChannel: log,
        synchronize: { configurationSection: "btq" },
        diagnosticCollectionName: "btq",
        // A setting that asks for another server is nothing to tell the one that is about to stop, nor is a file that is
        // opened meanwhile: the next one hears of all that are open.
        middleware: {
          ...completion,
          didOpen: async (document, next) => (waiting ? undefined : next(document)),
          workspace: { didChangeConfiguration: async (sections, next) => (waiting ? undefined : next(sections)) },
        },
      },
    );
    client.registerFeature({
      // The server sends clickable lenses only to clients that announce a command for them.
      fillClientCapabilities: (capabilities) => (capabilities.experimental = { commands: ["btq.showReferences", "btq.runScenario", "btq.explore"] }),
      initialize: () => undefined,
      getState: () => ({ kind: "static" }),
      clear: () => undefined,
    });
    client.onDidChangeState(({ newState }) => {
      status.busy = newState === State.Starting;
      status.severity =
        newState === State.Stopped ? vscode.LanguageStatusSeverity.Error : vscode.LanguageStatusSeverity.Information;
      status.detail = newState === State.Stopped ? "stopped" : server?.origin;
    });
    client.onNotification("$/btq/judged", judged);
    await client.start();
    const version = client.initializeResult?.serverInfo?.version;
    status.text = version ? `btq ${version}` : "btq";
    await vscode.commands.executeCommand("setContext", "btq.serverRuns", true);
  } catch (error) {
    status.busy = false;
    status.severity = vscode.LanguageStatusSeverity.Error;
    status.detail = error instanceof NoPython ? "no Python found" : "did not start";
    log.error(String(error));
    void explain(error);
  }
}

/** The command, which shows why the server refuses, and offers help if none runs. */
function orSay(command: () => Promise<void>): () => Promise<void> {
  const show = "Show Log";
  const restart = "Restart Server";
  return async () => {
    try {
      await command();
    } catch (error) {
      const buttons = client?.isRunning() ? [] : [restart, show];
      const text = error instanceof Error ? error.message : String(error);
      const answer = await vscode.window.showErrorMessage(text, ...buttons);
      if (answer === restart) await vscode.commands.executeCommand("btq.restartServer");
      if (answer === show) await vscode.commands.executeCommand("btq.showLog");
    }
  };
}

/** Shows why no server runs, and offers help. */
async function explain(error: unknown): Promise<void> {
  const choose = "Choose Python…";
  const get = "Get Python";
  const show = "Show Log";
  const buttons = error instanceof NoPython ? [choose, get] : [show, choose];
  const text = error instanceof NoPython ? error.message : `The btq server did not start: ${String(error)}`;
  const answer = await vscode.window.showErrorMessage(text, ...buttons);
  if (answer === choose) await chooseInterpreter();
  if (answer === get) await vscode.env.openExternal(vscode.Uri.parse("https://www.python.org/downloads/"));
  if (answer === show) await vscode.commands.executeCommand("btq.showLog");
}

async function chooseInterpreter(): Promise<void> {
  const chosen = await vscode.window.showOpenDialog({
    title: "The Python, 3.10 or newer, that runs btq",
    openLabel: "Use This Python",
    canSelectMany: false,
  });
  if (chosen?.[0] !== undefined) {
    await vscode.workspace
      .getConfiguration("btq")
      .update("interpreter", chosen[0].fsPath, vscode.ConfigurationTarget.Global);
  }
}

async function copyNodePath(ask: Ask): Promise<void> {
  const editor = vscode.window.activeTextEditor;
  if (!isOurs(editor?.document)) return;
  const { line, character } = editor.selection.active;
  const textDocument = { uri: editor.document.uri.toString() };
  const path = await ask("btq.server.nodePath", { textDocument, position: { line, character } });
  if (typeof path !== "string") {
    void vscode.window.showInformationMessage("No node at the cursor.");
    return;
  }
  await vscode.env.clipboard.writeText(path);
  vscode.window.setStatusBarMessage(`$(clippy) ${path}`, 4000);
}

/** `btq init` in a folder that the user chooses; then its mission is opened. */
async function newProject(context: vscode.ExtensionContext): Promise<void> {
  const chosen = await vscode.window.showOpenDialog({
    title: "The folder of the new project",
    openLabel: "Create Here",
    defaultUri: vscode.workspace.workspaceFolders?.[0]?.uri,
    canSelectFiles: false,
    canSelectFolders: true,
    canSelectMany: false,
  });
  const folder = chosen?.[0];
  if (folder === undefined) return;
  const [command, ...args] = await commandLine(context);
  if (command === undefined) return;
  const said = await complaint(command, [...args, "init", folder.fsPath]);
  if (said) {
    void vscode.window.showErrorMessage(said);
    return;
  }
  const mission = vscode.Uri.joinPath(folder, "mission.btq");
  if (vscode.workspace.getWorkspaceFolder(folder)) {
    await vscode.window.showTextDocument(mission);
    return;
  }
  // The window of the folder starts this extension again: it opens the mission there.
  await context.globalState.update(NEW_MISSION, mission.toString());
  const isFree = !vscode.workspace.workspaceFolders?.length;
  await vscode.commands.executeCommand("vscode.openFolder", folder, { forceReuseWindow: isFree, forceNewWindow: !isFree });
}

/** Opens the mission of a project that was begun for this window. */
async function openNewMission(context: vscode.ExtensionContext): Promise<void> {
  const mission = vscode.Uri.parse(context.globalState.get(NEW_MISSION, ""));
  if (!vscode.workspace.getWorkspaceFolder(mission)) return;
  await context.globalState.update(NEW_MISSION, undefined);
  await vscode.window.showTextDocument(mission);
}

const NEW_MISSION = "newMission";

/** The XML of what was saved, beside it; what is wrong with the mission is shown already. */
async function buildSaved(
  document: vscode.TextDocument,
  [command, ...args]: string[],
  log: vscode.LogOutputChannel,
): Promise<void> {
  if (command === undefined) return;
  const said = await complaint(command, [...args, "build", document.uri.fsPath]);
  if (said) log.warn(`not built: ${said}`);
  vscode.window.setStatusBarMessage(said ? "$(warning) btq: no XML written" : "$(check) btq: XML written", 4000);
}

/** What a command says went wrong; empty: nothing. */
function complaint(command: string, words: string[]): Promise<string> {
  return new Promise((resolve) =>
    execFile(command, words, (error, _, said) => resolve(error ? said.trim() || error.message : "")),
  );
}

/** The command line of btq that belongs to the server; empty, with a message, without a Python. */
async function commandLine(context: vscode.ExtensionContext): Promise<string[]> {
  try {
    return (server ?? (await findServer(context.extensionPath, await activeInterpreter()))).btq;
  } catch (error) {
    void explain(error);
    return [];
  }
}
