// The environment chosen in Microsoft's Python extension, where that is installed; its API, as far as it is used here.
import * as vscode from "vscode";

interface PythonApi {
  readonly environments: {
    getActiveEnvironmentPath(): { readonly path: string };
    resolveEnvironment(environment: {
      readonly path: string;
    }): Promise<{ readonly executable: { readonly uri?: vscode.Uri } } | undefined>;
    readonly onDidChangeActiveEnvironmentPath: vscode.Event<unknown>;
  };
}

/** The interpreter of the chosen environment, or undefined. */
export async function activeInterpreter(): Promise<string | undefined> {
  const environments = (await api())?.environments;
  const resolved = await environments?.resolveEnvironment(environments.getActiveEnvironmentPath());
  return resolved?.executable.uri?.fsPath;
}

export async function onInterpreterChange(context: vscode.ExtensionContext, then: () => unknown): Promise<void> {
  const python = await api();
  if (python) context.subscriptions.push(python.environments.onDidChangeActiveEnvironmentPath(then));
}

async function api(): Promise<PythonApi | undefined> {
  const extension = vscode.extensions.getExtension<PythonApi>("ms-python.python");
  try {
    const found = await extension?.activate();
    return found?.environments ? found : undefined;
  } catch {
    return undefined; // it reports its own trouble; ours continues without it
  }
}
