" Indentation: one level deeper behind a line that has a block by its nature, as deep as before otherwise.  How far a
" line comes back only its writer knows: what a node's parent is, is said by nothing else.
if exists('b:did_indent')
  finish
endif
let b:did_indent = 1

setlocal autoindent
setlocal indentexpr=BtqIndent(v:lnum)
setlocal indentkeys=!^F,o,O,0)
let b:undo_indent = 'setlocal autoindent< indentexpr< indentkeys<'

if exists('*BtqIndent')
  finish
endif

function BtqIndent(line) abort
  let above = prevnonblank(a:line - 1)
  if above == 0
    return 0
  endif
  if getline(a:line) =~# '^\s*)'
    call cursor(a:line, 1)
    let opener = searchpair('(', '', ')', 'bnW')
    return opener > 0 ? indent(opener) : indent(above)
  endif
  let text = substitute(getline(above), '\s#.*$\|"[^"]*"', '', 'g')
  if text =~# '(\s*$' || text =~# g:btq#words#opener
    return indent(above) + shiftwidth()
  endif
  return indent(above)
endfunction
