// The part of the classic spelling that bench/missions.py writes, for tree-sitter.
module.exports = grammar({
  name: 'btq_classic',
  externals: $ => [$._newline, $._indent, $._dedent],
  extras: $ => [/\s/, $.comment],
  word: $ => $.word,
  rules: {
    mission: $ => seq('Root', $._name, $._newline, $._indent, repeat1($.tree), $._dedent),
    tree: $ => seq('BehaviorTree', 'ID', '=', $._name, $._newline, $._indent, $.node, $._dedent),
    node: $ => seq(choice($.symbol, $.word), optional($.attributes), $._newline,
      optional(seq($._indent, repeat1($.node), $._dedent))),
    attributes: $ => seq('(', repeat(choice($.pair, $.satisfices, $.satisfies)), ')'),
    pair: $ => seq(choice($.word, 'ID'), '=', choice($.string, $.word, $.number, $.braced)),
    satisfices: $ => seq('satisfices', list($.quality)),
    quality: $ => seq('Quality', '=', $.word, repeat(seq('.', $.word)), optional(seq('(', list($.requirement), ')'))),
    satisfies: $ => seq('satisfies', list($.requirement)),
    requirement: $ => seq('QualityReq', 'ID', '=', $._name, optional(seq('description', '=', $.string))),
    _name: $ => choice($.word, $.string),
    symbol: $ => token(prec(1, choice('->', '?', '||', 'All||', 'R->', 'R?', 'M->', 'A->', 'A?'))),
    word: $ => /[\p{L}_](?:[\p{L}\p{N}_-])*/,
    number: $ => /-?\d+(\.\d+)?([eE][+-]?\d+)?/,
    string: $ => /"([^"\\]|\\(.|\n))*"/,
    braced: $ => /\{[^{}"'\r\n]*\}/,
    comment: $ => token(choice(/#[^\n]*/, /\/\/[^\n]*/, /\/\*[^*]*\*+([^/*][^*]*\*+)*\//)),
  },
});

function list(rule) {
  return seq(rule, repeat(seq(',', rule)));
}
