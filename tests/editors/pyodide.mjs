// Runs a Python program in Pyodide, Python for browsers: node pyodide.mjs PYODIDE FOLDER PROGRAM
// FOLDER has the package btq_lang; what the program prints is printed, and what it raises ends with code 1.
const [pyodide, folder, program] = process.argv.slice(2);
const { loadPyodide } = await import(`${pyodide}/pyodide.mjs`);
const python = await loadPyodide();
python.mountNodeFS("/btq", folder);
python.runPython('import sys; sys.path.insert(0, "/btq"); sys.dont_write_bytecode = True');
python.runPython(program);
