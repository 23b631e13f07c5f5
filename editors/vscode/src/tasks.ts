// The tasks `btq: check` and `btq: build`: the same commands as on a build server, what they find in the Problems view.
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
  constructor(private readonly commandLine: () => Promise<string[]>) {}

  async provideTasks(): Promise<vscode.Task[]> {
    const line = await this.commandLine();
    const commands = Object.keys(DETAILS) as Command[];
    return commands.flatMap((command) => taskOf({ type: "btq", command }, line) ?? []);
  }

  async resolveTask(task: vscode.Task): Promise<vscode.Task | undefined> {
    return taskOf(task.definition as Definition, await this.commandLine(), task.scope);
  }
}

/** Run a command on the whole folder, in a terminal. */
export async function runTask(command: Command, commandLine: string[]): Promise<void> {
  const task = taskOf({ type: "btq", command }, commandLine);
  if (task) await vscode.tasks.executeTask(task);
}

function taskOf(
  definition: Definition,
  [program, ...args]: string[],
  scope?: vscode.Task["scope"],
): vscode.Task | undefined {
  if (program === undefined) return undefined;
  const { command } = definition;
  const words = [...args, command, ...(command === "check" ? ["--output-format", "concise"] : [])];
  const task = new vscode.Task(
    definition,
    scope ?? vscode.TaskScope.Workspace,
    command,
    "btq",
    new vscode.ProcessExecution(program, [...words, ...(definition.arguments ?? [])]),
    "$btq",
  );
  task.detail = DETAILS[command];
  task.group = vscode.TaskGroup.Build;
  task.presentationOptions = { reveal: vscode.TaskRevealKind.Always, clear: true };
  return task;
}
