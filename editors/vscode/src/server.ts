// Which server is started, and by which Python: the setting, the chosen environment, `btq-lsp` on the PATH, our own copy.
// One invariant: what is returned was asked and answered, so a start that fails is a fault and not a missing part.
import { execFile } from "node:child_process";
import { existsSync } from "node:fs";
import path from "node:path";
import * as vscode from "vscode";

export interface Server {
  readonly command: string;
  readonly args: string[];
  /** For people: where it is from. */
  readonly origin: string;
  /** The command line of btq's other commands. */
  readonly btq: string[];
}

export class NoPython extends Error {}

interface Interpreter {
  readonly path: string;
  readonly version: string;
  readonly recent: boolean;
  readonly hasBtq: boolean;
}

/** Raises NoPython where nothing can run a server. */
export async function findServer(extensionPath: string, active: string | undefined): Promise<Server> {
  const settings = vscode.workspace.getConfiguration("btq");
  const bundled = path.join(extensionPath, "python", "run_btq.py");
  const [command, ...args] = settings.get<string[]>("server.command", []);
  const setting = settings.get<string>("interpreter", "");
  if (command) {
    const beside = path.join(path.dirname(command), process.platform === "win32" ? "btq.exe" : "btq");
    const python = existsSync(beside) ? undefined : await firstRecent([setting, active, ...NAMES]);
    const btq = existsSync(beside) ? [beside] : python ? [python.path, bundled] : ["btq"];
    return { command, args, origin: "the setting btq.server.command", btq };
  }
  const strategy = settings.get<string>("importStrategy");
  const chosen = await firstRecent([setting, active]);
  if (setting && chosen?.path !== setting) {
    throw new NoPython(`The setting btq.interpreter names ${setting}, which is not Python 3.10 or newer.`);
  }
  if (strategy === "fromEnvironment") {
    if (chosen?.hasBtq) {
      return {
        command: chosen.path,
        args: ["-c", SERVE],
        origin: `btq of ${chosen.path}`,
        btq: [chosen.path, "-m", "btq_lang"],
      };
    }
    const installed = onPath("btq-lsp");
    if (installed && !setting) {
      return { command: installed, args: [], origin: installed, btq: [onPath("btq") ?? "btq"] };
    }
  }
  const python = chosen ?? (await firstRecent(NAMES));
  if (!python) {
    throw new NoPython("btq requires Python 3.10 or newer to check missions, and found none.");
  }
  return {
    command: python.path,
    args: [bundled, "lsp"],
    origin: `the copy in the extension, Python ${python.version}`,
    btq: [python.path, bundled],
  };
}

// `py` is Windows' launcher; the Store's `python` that only advertises fails when run, like any other that is not Python.
const NAMES = process.platform === "win32" ? ["python", "py", "python3"] : ["python3", "python"];
// A package that lies in the opened folder is not what is installed, and must not be run for looking at a file.  Python
// has a flag for that (-P) from 3.11 on only, and -I would also forget PYTHONPATH, which ROS needs.
const ELSEWHERE = "import sys; sys.path[:] = [path for path in sys.path if path]";
const SERVE = `${ELSEWHERE}; from btq_lang.server import main; sys.exit(main(sys.argv[1:]))`;
const QUESTION = `
${ELSEWHERE}
from importlib.util import find_spec
ours = sys.version_info >= (3, 10) and bool(find_spec("btq_lang") and find_spec("pygls"))
print("%d.%d" % sys.version_info[:2], sys.version_info >= (3, 10), ours)
`;

async function firstRecent(candidates: readonly (string | undefined)[]): Promise<Interpreter | undefined> {
  for (const candidate of candidates) {
    const interpreter = candidate ? await ask(candidate) : undefined;
    if (interpreter?.recent) return interpreter;
  }
  return undefined;
}

function ask(candidate: string): Promise<Interpreter | undefined> {
  return new Promise((resolve) =>
    execFile(candidate, ["-c", QUESTION], { timeout: 20_000 }, (error, answer) => {
      const [version, recent, ours] = error ? [] : answer.trim().split(" ");
      resolve(version ? { path: candidate, version, recent: recent === "True", hasBtq: ours === "True" } : undefined);
    }),
  );
}

function onPath(name: string): string | undefined {
  const suffixes = process.platform === "win32" ? [".exe", ".cmd"] : [""];
  for (const folder of (process.env.PATH ?? "").split(path.delimiter)) {
    for (const suffix of suffixes) {
      const file = path.join(folder, name + suffix);
      if (folder && existsSync(file)) return file;
    }
  }
  return undefined;
}
