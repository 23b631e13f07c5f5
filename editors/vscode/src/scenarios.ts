// The scenarios of missions in VS Code's Test Explorer.
// One invariant: the server says which there are and runs them; nothing here reads a mission.
import * as vscode from "vscode";
import type { Position, Range } from "vscode-languageclient/node";

import type { Ask } from "./xml";

/** As `Ask`, of a request that may be cancelled. */
export type AskUntil = (token: vscode.CancellationToken, ...asked: Parameters<Ask>) => Promise<unknown>;

interface Listed {
  uri: string;
  scenarios: { title: string; range: Range }[];
}

/** What scenarios have met of all that can happen to the nodes of a file. */
interface Covered {
  uri: string;
  nodes: { position: Position; node: string; outcomes: { outcome: string; scenarios: number }[] }[];
  /** The trees that none of them runs. */
  unused: { position: Position; tree: string }[];
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
    const { Coverage } = vscode.TestRunProfileKind;
    const profile = this.controller.createRunProfile("Coverage", Coverage, (asked) => this.run(asked, []), true);
    profile.loadDetailedCoverage = async (_, file) => (file instanceof CoveredFile ? file.details : []);
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

  /** Runs the scenarios of a document that have a title. */
  async runTitle(uri: string, title: string): Promise<void> {
    await this.list(vscode.Uri.parse(uri));
    const file = this.controller.items.get(vscode.Uri.parse(uri).toString());
    const scenarios = file ? all(file.children).filter(({ label }) => label === title) : [];
    if (scenarios.length) await this.run(new vscode.TestRunRequest(scenarios));
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
      withIds(scenarios).map(([id, { title, range }]) => {
        const scenario = file.children.get(id) ?? this.controller.createTestItem(id, title, place);
        scenario.range = asRange(range);
        return scenario;
      }),
    );
    return file;
  }

  /** Runs what is asked for; `covered`: where to put what it meets, if that is to be shown. */
  private async run(asked: vscode.TestRunRequest, covered?: Covered[]): Promise<void> {
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
      if (!run.token.isCancellationRequested) await this.runFile(run, file, scenarios, covered);
    }
    for (const file of covered ? coveredFiles(covered) : []) run.addCoverage(file);
    run.end();
  }

  private async runFile(
    run: vscode.TestRun,
    file: vscode.TestItem,
    scenarios: vscode.TestItem[],
    covered: Covered[] | undefined,
  ): Promise<void> {
    scenarios.forEach((scenario) => run.started(scenario));
    const asked = [{ uri: file.id }, ...new Set(scenarios.map(({ label }) => label))] as const;
    try {
      let results: Result[];
      if (covered) {
        const answer = await this.askUntil(run.token, "btq.server.coverScenarios", ...asked);
        const { results: ran, coverage } = answer as { results: Result[]; coverage: Covered[] };
        covered.push(...coverage);
        results = ran;
      } else {
        results = (await this.askUntil(run.token, "btq.server.runScenarios", ...asked)) as Result[];
      }
      const byId = new Map(withIds(results));
      for (const scenario of scenarios) {
        const result = byId.get(scenario.id);
        if (result) show(run, scenario, result);
      }
    } catch (error) {
      const message = new vscode.TestMessage(error instanceof Error ? error.message : String(error));
      if (!run.token.isCancellationRequested) scenarios.forEach((scenario) => run.errored(scenario, message));
    }
  }
}

/** Scenarios of a file with their ids: several may have one title, and whoever asks for it gets all of these. */
function withIds<T extends { title: string }>(scenarios: readonly T[]): [string, T][] {
  const counts = new Map<string, number>();
  return scenarios.map((scenario) => {
    const count = (counts.get(scenario.title) ?? 0) + 1;
    counts.set(scenario.title, count);
    return [`${count} ${scenario.title}`, scenario];
  });
}

class CoveredFile extends vscode.FileCoverage {
  constructor(
    uri: vscode.Uri,
    readonly details: vscode.StatementCoverage[],
  ) {
    const { statementCoverage, branchCoverage } = vscode.FileCoverage.fromDetails(uri, details);
    super(uri, statementCoverage, branchCoverage);
  }
}

/** The coverage of each file by all scenarios: a node is a statement, each of its outcomes a branch. */
function coveredFiles(covered: readonly Covered[]): CoveredFile[] {
  const byFile = new Map<string, Covered[]>();
  for (const file of covered) byFile.set(file.uri, [...(byFile.get(file.uri) ?? []), file]);
  return [...byFile].map(([uri, parts]) => new CoveredFile(vscode.Uri.parse(uri), statements(parts)));
}

/** The nodes of a file, as scenarios of several files have met them; a tree that none of them runs is one that is missed. */
function statements(parts: readonly Covered[]): vscode.StatementCoverage[] {
  const byPlace = new Map<string, [vscode.Position, Map<string, number>]>();
  const outcomesAt = ({ line, character }: Position): Map<string, number> => {
    const key = `${line}:${character}`;
    const [, outcomes] = byPlace.get(key) ?? [undefined, new Map<string, number>()];
    byPlace.set(key, [new vscode.Position(line, character), outcomes]);
    return outcomes;
  };
  for (const { position, node, outcomes } of parts.flatMap(({ nodes }) => nodes)) {
    const counts = outcomesAt(position);
    for (const { outcome, scenarios } of outcomes) {
      const label = `${node} ${outcome}`;
      counts.set(label, (counts.get(label) ?? 0) + scenarios);
    }
  }
  const [first, ...others] = parts.map(({ unused }) => unused);
  for (const { position, tree } of first ?? []) {
    if (others.every((unused) => unused.some((other) => other.tree === tree))) outcomesAt(position);
  }
  return [...byPlace.values()].map(([at, counts]) => {
    const place = new vscode.Range(at, at);
    const branches = [...counts].map(([label, count]) => new vscode.BranchCoverage(count, place, label));
    return new vscode.StatementCoverage([...counts.values()].some(Boolean), at, branches);
  });
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
