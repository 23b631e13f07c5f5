// The scenarios of missions in VS Code's Test Explorer.
// One invariant: the server says which there are and runs them; nothing here reads a mission.
import * as vscode from "vscode";
import type { Range } from "vscode-languageclient/node";

import type { Ask } from "./xml";

/** As `Ask`, of a request that may be cancelled. */
export type AskUntil = (token: vscode.CancellationToken, ...asked: Parameters<Ask>) => Promise<unknown>;

interface Listed {
  uri: string;
  scenarios: { title: string; range: Range }[];
}

interface Result {
  title: string;
  outcome: "passed" | "failed" | "unknown" | "error";
  message: string;
  failures: { range: Range; message: string }[];
  text: string;
}

export class Scenarios {
  private readonly controller = vscode.tests.createTestController("btq", "btq");
  private readonly timers = new Map<string, NodeJS.Timeout>();

  constructor(
    context: vscode.ExtensionContext,
    private readonly ask: Ask,
    private readonly askUntil: AskUntil,
  ) {
    const files = vscode.workspace.createFileSystemWatcher("**/*.{btq,qualitybtcpp}");
    context.subscriptions.push(
      this.controller,
      files,
      files.onDidCreate(() => this.soon()),
      files.onDidChange(() => this.soon()),
      files.onDidDelete(() => this.soon()),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (document.languageId === "btq") this.soon(document.uri);
      }),
    );
    this.controller.refreshHandler = () => this.list();
    this.controller.createRunProfile("Run", vscode.TestRunProfileKind.Run, (asked) => this.run(asked), true);
  }

  /** Lists the scenarios of a document, or of all, when nothing has changed for a moment. */
  soon(uri?: vscode.Uri): void {
    const key = uri?.toString() ?? "";
    clearTimeout(this.timers.get(key));
    this.timers.set(
      key,
      // Without a server there is nothing to list.
      setTimeout(() => this.list(uri).catch(() => undefined), PAUSE),
    );
  }

  /** Runs the scenario of a document that has a title. */
  async runTitle(uri: string, title: string): Promise<void> {
    await this.list(vscode.Uri.parse(uri));
    const scenario = this.controller.items.get(vscode.Uri.parse(uri).toString())?.children.get(title);
    if (scenario) await this.run(new vscode.TestRunRequest([scenario]));
  }

  private async list(uri?: vscode.Uri): Promise<void> {
    const files = (await this.ask("btq.server.scenarios", uri ? { uri: uri.toString() } : null)) as Listed[];
    const items = files.map((file) => this.item(file));
    if (!uri) this.controller.items.replace(items);
    else if (items[0]) this.controller.items.add(items[0]);
    else this.controller.items.delete(uri.toString());
  }

  /** A file with its scenarios; those that are listed already are the same items, with their last results. */
  private item({ uri, scenarios }: Listed): vscode.TestItem {
    const place = vscode.Uri.parse(uri);
    const known = this.controller.items.get(place.toString());
    const file = known ?? this.controller.createTestItem(place.toString(), vscode.workspace.asRelativePath(place), place);
    file.children.replace(
      scenarios.map(({ title, range }) => {
        const scenario = file.children.get(title) ?? this.controller.createTestItem(title, title, place);
        scenario.range = asRange(range);
        return scenario;
      }),
    );
    return file;
  }

  private async run(asked: vscode.TestRunRequest): Promise<void> {
    const run = this.controller.createTestRun(asked);
    const excluded = new Set(asked.exclude);
    const files = new Map<vscode.TestItem, vscode.TestItem[]>();
    for (const item of asked.include ?? all(this.controller.items)) {
      if (excluded.has(item)) continue;
      const file = item.parent ?? item;
      const scenarios = item.parent ? [item] : all(item.children);
      files.set(file, [...(files.get(file) ?? []), ...scenarios.filter((scenario) => !excluded.has(scenario))]);
    }
    for (const scenarios of files.values()) scenarios.forEach((scenario) => run.enqueued(scenario));
    for (const [file, scenarios] of files) {
      if (!run.token.isCancellationRequested) await this.runFile(run, file, scenarios);
    }
    run.end();
  }

  private async runFile(run: vscode.TestRun, file: vscode.TestItem, scenarios: vscode.TestItem[]): Promise<void> {
    scenarios.forEach((scenario) => run.started(scenario));
    const titles = scenarios.map(({ id }) => id);
    try {
      const answer = await this.askUntil(run.token, "btq.server.runScenarios", { uri: file.id }, ...titles);
      const results = answer as Result[];
      // Of two with one title the last that is shown counts.
      results.sort((one, other) => Number(other.outcome === "passed") - Number(one.outcome === "passed"));
      for (const result of results) {
        const scenario = file.children.get(result.title);
        if (scenario) show(run, scenario, result);
      }
    } catch (error) {
      const message = new vscode.TestMessage(error instanceof Error ? error.message : String(error));
      if (!run.token.isCancellationRequested) scenarios.forEach((scenario) => run.errored(scenario, message));
    }
  }
}

/** Shows what came of a scenario: messages at the lines that expect something else, and the run as output. */
function show(run: vscode.TestRun, scenario: vscode.TestItem, { outcome, failures, text }: Result): void {
  run.appendOutput(`${text.replaceAll("\n", "\r\n")}\r\n`, undefined, scenario);
  const messages = failures.map(({ range, message }) => {
    const shown = new vscode.TestMessage(message);
    if (scenario.uri) shown.location = new vscode.Location(scenario.uri, asRange(range));
    return shown;
  });
  if (outcome === "passed") run.passed(scenario);
  else if (outcome === "failed") run.failed(scenario, messages);
  else run.errored(scenario, messages);
}

function all(items: vscode.TestItemCollection): vscode.TestItem[] {
  return [...items].map(([, item]) => item);
}

/** Lines and columns count in VS Code as in the protocol. */
function asRange({ start, end }: Range): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}

const PAUSE = 300;
