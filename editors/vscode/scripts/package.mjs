// Packs btq-<version>.vsix: the extension's code in one file, and the Python server with its libraries beside it.
// Nothing compiled is taken, so the package serves every system; the same commit gives the same bytes.
import { execFileSync } from "node:child_process";
import { cpSync, readdirSync, readFileSync, rmSync, statSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

const here = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "..");
const root = path.resolve(here, "../..");
const version = JSON.parse(readFileSync(path.join(here, "package.json"), "utf8")).version;
const target = path.resolve(process.argv[2] ?? path.join(here, `btq-${version}.vsix`));
const LIMIT = 3_000_000;

const run = (command, args, options = {}) => execFileSync(command, args, { cwd: here, stdio: "inherit", ...options });

function python() {
  for (const name of [process.env.PYTHON, "python3", "python"].filter(Boolean)) {
    try {
      execFileSync(name, ["-m", "pip", "--version"], { stdio: "ignore" });
      return name;
    } catch {
      // The next name.
    }
  }
  throw new Error("no Python with pip: set PYTHON");
}

function commitTime() {
  try {
    return execFileSync("git", ["log", "-1", "--format=%ct"], { cwd: root, encoding: "utf8" }).trim();
  } catch {
    return "0"; // an unpacked archive has no history
  }
}

function install(platform, implementation, requirements) {
  run(python(), [
    ..."-m pip install --quiet --disable-pip-version-check --no-deps --no-compile --only-binary=:all:".split(" "),
    ..."--python-version 3.10 --target python/libs --platform".split(" "),
    ...[platform, "--implementation", implementation, ...requirements],
  ]);
}

for (const name of ["python/libs", "python/btq_lang", "dist", "LICENSE"]) {
  rmSync(path.join(here, name), { recursive: true, force: true });
}
const pinned = readFileSync(path.join(here, "python/requirements.txt"), "utf8").match(/^[\w.-]+==\S+/gm);
const isCompiled = (requirement) => requirement.startsWith("markupsafe==");
install("any", "py", pinned.filter((requirement) => !isCompiled(requirement)));
// MarkupSafe has no wheel for any platform.  Without its C part, one for Linux serves every system: Python's part is there.
install("manylinux2014_x86_64", "cp", pinned.filter(isCompiled));
for (const name of readdirSync(path.join(here, "python/libs/markupsafe"))) {
  if (name.startsWith("_speedups")) rmSync(path.join(here, "python/libs/markupsafe", name));
}
rmSync(path.join(here, "python/libs/bin"), { recursive: true, force: true });
cpSync(path.join(root, "btq_lang"), path.join(here, "python/btq_lang"), {
  recursive: true,
  filter: (source) => !/__pycache__|\.(so|pyd|c)$/.test(source),
});
cpSync(path.join(root, "LICENSE"), path.join(here, "LICENSE"));
run(process.execPath, ["node_modules/@vscode/vsce/vsce", "package", "--no-dependencies", "--allow-missing-repository", "--out", target], {
  env: { SOURCE_DATE_EPOCH: commitTime(), ...process.env },
});
const { size } = statSync(target);
if (size > LIMIT) throw new Error(`${target} has ${size} bytes, more than ${LIMIT}`);
console.log(`${target}: ${Math.round(size / 1000)} kB`);
