// In the place of Microsoft's Python extension, which has no package outside the marketplace: that part of its API
// (https://github.com/microsoft/vscode-python, `PythonExtension.environments`) that says which environment is active.
const vscode = require("vscode");

exports.activate = (context) => {
  const changed = new vscode.EventEmitter();
  context.subscriptions.push(
    changed,
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("python.activeEnvironment")) changed.fire(undefined);
    }),
  );
  return {
    environments: {
      getActiveEnvironmentPath: () => ({ path: vscode.workspace.getConfiguration("python").get("activeEnvironment") }),
      resolveEnvironment: async ({ path }) => (path ? { executable: { uri: vscode.Uri.file(path) } } : undefined),
      onDidChangeActiveEnvironmentPath: changed.event,
    },
  };
};
