// The task `btq: check`: the same command as on a build server, its findings in the Problems view.
import * as vscode from "vscode";

interface CheckDefinition extends vscode.TaskDefinition {
  readonly arguments?: string[];
}

export class CheckTasks implements vscode.TaskProvider {
  constructor(private readonly commandLine: () => Promise<string[]>) {}

  async provideTasks(): Promise<vscode.Task[]> {
    const task = checkTask({ type: "btq", command: "check" }, await this.commandLine());
    return task ? [task] : [];
  }

  async resolveTask(task: vscode.Task): Promise<vscode.Task | undefined> {
    return checkTask(task.definition as CheckDefinition, await this.commandLine(), task.scope);
  }
}

/** Run the check and wait for its end; its exit code, undefined where it could not run. */
export async function runCheck(commandLine: string[]): Promise<number | undefined> {
  const task = checkTask({ type: "btq", command: "check" }, commandLine);
  if (!task) return undefined;
  const execution = await vscode.tasks.executeTask(task);
  return new Promise((resolve) => {
    const listener = vscode.tasks.onDidEndTaskProcess((ended) => {
      if (ended.execution === execution) {
        listener.dispose();
        resolve(ended.exitCode);
      }
    });
  });
}

function checkTask(
  definition: CheckDefinition,
  [command, ...args]: string[],
  scope?: vscode.Task["scope"],
): vscode.Task | undefined {
  if (command === undefined) return undefined;
  const words = [...args, "check", "--output-format", "concise", ...(definition.arguments ?? [])];
  const task = new vscode.Task(
    definition,
    scope ?? vscode.TaskScope.Workspace,
    "check",
    "btq",
    new vscode.ProcessExecution(command, words),
    "$btq",
  );
  task.group = vscode.TaskGroup.Build;
  task.presentationOptions = { reveal: vscode.TaskRevealKind.Always, clear: true };
  return task;
}
