// Langium as one of the tools that bench/parse.py drives: requests and answers as bench/worker.py has them, a JSON
// value a line.  The second argument is `shipped` or `mended`.

import { readFileSync, writeFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

// Chevrotain checks grammars with it, and Node has it from version 21 on; no parse calls it.
Object.groupBy ??= (values, key) => {
    const groups = {};
    for (const value of values) (groups[key(value)] ??= []).push(value);
    return groups;
};

const LIBRARY = await load();

if (LIBRARY === undefined) {
    answer({ missing: 'run `npm install` in bench/parsers/langium' });
} else {
    const parse = await parser(process.argv[2] === 'mended');
    answer({ version: LIBRARY.version, form: process.argv[2] });
    for await (const line of createInterface({ input: process.stdin })) {
        const request = JSON.parse(line);
        const text = readFileSync(request.path, 'utf8');
        answer(request.do === 'resident' ? memory(parse, text) : time(parse, text, request.repeat));
    }
}

function answer(value) {
    process.stdout.write(JSON.stringify(value) + '\n');
}

function time(parse, text, repeat) {
    const seconds = [];
    let nodes = 0;
    for (let round = 0; round < repeat; round++) {
        globalThis.gc();
        const start = process.hrtime.bigint();
        const result = parse(text);
        seconds.push(Number(process.hrtime.bigint() - start) / 1e9);
        if (round === 0) nodes = count(result);
    }
    return { seconds, nodes };
}

function memory(parse, text) {
    globalThis.gc();
    writeFileSync('/proc/self/clear_refs', '5');
    const before = resident('VmRSS');
    const nodes = count(parse(text));
    return { nodes, bytes: resident('VmHWM') - before };
}

function resident(field) {
    const status = readFileSync('/proc/self/status', 'utf8');
    return 1024 * Number(status.match(new RegExp(`${field}:\\s*(\\d+)`))[1]);
}

function count(result) {
    if (result.lexerErrors.length || result.parserErrors.length) {
        throw new Error(JSON.stringify([...result.lexerErrors, ...result.parserErrors][0]));
    }
    const stack = result.value.trees.map(tree => tree.top);
    let nodes = 0;
    while (stack.length) {
        nodes++;
        for (const child of stack.pop().children) stack.push(child);
    }
    return nodes;
}

async function load() {
    try {
        const [core, grammar] = await Promise.all([import('langium'), import('langium/grammar')]);
        const manifest = new URL('./node_modules/langium/package.json', import.meta.url);
        return { ...core, ...grammar, version: JSON.parse(readFileSync(manifest, 'utf8')).version };
    } catch (error) {
        if (error.code === 'ERR_MODULE_NOT_FOUND') return undefined;
        throw error;
    }
}

async function parser(mended) {
    const { createServicesForGrammar, IndentationAwareLexer, IndentationAwareTokenBuilder } = LIBRARY;

    // As shipped, every INDENT and DEDENT counts the lines, and every DEDENT looks for line ends, from the start of the
    // file: quadratic.  Mended, a DEDENT stands at the line's start and has no line number, as nobody asks for it.
    class Mended extends IndentationAwareTokenBuilder {
        getLineNumber() {
            return 1;
        }
        dedentMatcher(text, offset, tokens, groups) {
            if (!this.isStartOfLine(text, offset)) return null;
            const { currIndentLevel } = this.matchWhitespace(text, offset, tokens, groups);
            while (this.indentationStack.at(-1) > currIndentLevel) {
                tokens.push(this.createIndentationTokenInstance(this.dedentTokenType, text, '', offset));
                this.indentationStack.pop();
            }
            return null;
        }
    }

    const builder = new (mended ? Mended : IndentationAwareTokenBuilder)({ ignoreIndentationDelimiters: [['(', ')']] });
    const services = await createServicesForGrammar({
        grammar: readFileSync(fileURLToPath(new URL('./classic.langium', import.meta.url)), 'utf8'),
        module: { parser: { TokenBuilder: () => builder, Lexer: services => new IndentationAwareLexer(services) } },
    });
    return text => services.parser.LangiumParser.parse(text);
}
