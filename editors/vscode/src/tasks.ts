// The tasks `btq: check` and `btq: build`: the same commands as on a build server, for all folders of the window.
// One invariant: a problem appears in the Problems view once: what the server shows there, a task leaves to it.
import * as vscode from "vscode";

type Command = "check" | "build";

interface Definition extends vscode.TaskDefinition {
  readonly command: Command;
  readonly arguments?: string[];
}

const DETAILS: Record<Command, string> = {
  check: "finds mistakes in all missions",
  build: "writes the XML that BehaviorTree.CPP loads",
};

export class Tasks implements vscode.TaskProvider {
  constructor(
    private readonly commandLine: () => Promise<string[]>,
    private readonly isServed: () => boolean,
  ) {}

  async provideTasks(): Promise<vscode.Task[]> {
    const line = await this.commandLine();
    const commands = Object.keys(DETAILS) as Command[];
    return commands.flatMap((command) => this.taskOf({ type: "btq", command }, line) ?? []);
  }

  async resolveTask(task: vscode.Task): Promise<vscode.Task | undefined> {
    return this.taskOf(task.definition as Definition, await this.commandLine(), task.scope);
  }

  /** Run a command on all folders, in a terminal. */
  async run(command: Command): Promise<void> {
    const task = this.taskOf({ type: "btq", command }, await this.commandLine());
    if (task) await vscode.tasks.executeTask(task);
  }

  private taskOf(
    definition: Definition,
    [program, ...args]: string[],
    scope?: vscode.Task["scope"],
  ): vscode.Task | undefined {
    if (program === undefined) return undefined;
    const { command } = definition;
    const words = [...args, command, ...(command === "check" ? checking() : []), ...(definition.arguments ?? folders())];
    const task = new vscode.Task(
      definition,
      scope ?? vscode.TaskScope.Workspace,
      command,
      "btq",
      new vscode.ProcessExecution(program, words),
      this.isServed() ? [] : "$btq",
    );
    task.detail = DETAILS[command];
    task.group = vscode.TaskGroup.Build;
    task.presentationOptions = { reveal: vscode.TaskRevealKind.Always, clear: true };
    return task;
  }
}

/** A line a finding, and none of the rules that are off in the editor. */
function checking(): string[] {
  const rules = vscode.workspace.getConfiguration("btq").get<Record<string, string>>("rules", {});
  const off = Object.keys(rules).filter((rule) => rules[rule] === "off");
  return ["--output-format", "concise", ...(off.length ? ["--ignore", off.join(",")] : [])];
}

/** The folders of a window that has several; where there is one, a task runs in it. */
function folders(): string[] {
  const { workspaceFolders = [] } = vscode.workspace;
  return workspaceFolders.length > 1 ? workspaceFolders.map(({ uri }) => uri.fsPath) : [];
}
