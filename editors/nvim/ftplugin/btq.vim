" How a mission is edited: comments, words, indentation in the characters of the file, and `:make` for `btq check`.
if exists('b:did_ftplugin')
  finish
endif
let b:did_ftplugin = 1

setlocal commentstring=#\ %s
setlocal comments=:#,://,s1:/*,mb:*,ex:*/
setlocal formatoptions-=t formatoptions+=croql
" Four blanks, or the tabs that the file is indented with: the language takes either, and no mixture.
if getline(match(getline(1, 1000), '^\s\+\S') + 1) =~# '^\t'
  setlocal noexpandtab shiftwidth=0 softtabstop=0
else
  setlocal expandtab shiftwidth=4 softtabstop=4
endif
" A hyphen joins words: performance-efficiency is one name.
setlocal iskeyword+=-
setlocal suffixesadd=.btq,.xml
setlocal include=^\\s*include\\s\\+[\"']

" With the default 'completeopt' a list that opens by itself writes its first entry into the text.
if has('nvim-0.11')
  let &l:completeopt = &g:completeopt . ',noselect'
endif

let s:program = has('nvim') ? luaeval("require('btq').program()") : get(g:, 'btq_program', ['btq'])
if executable(s:program[0])
  let s:words = map(copy(s:program), {_, word -> word =~# '^[[:alnum:]_./-]\+$' ? word : shellescape(word, 1)})
  let &l:makeprg = join(s:words) . ' check --output-format concise %:S'
  setlocal errorformat=%f:%l:%c:\ %trror%m,%f:%l:%c:\ %tarning%m,%f:%l:%c:\ %tnfo%m,%f:%l:%c:\ %tint%m,%-G%.%#
endif

function! s:tests(...)
  return 'nearest'
endfunction

if has('nvim')
  command! -buffer -bang BtqPreview lua require('btq.preview').run('<bang>' == '!')
  command! -buffer -nargs=? BtqRun lua require('btq.run').run(tonumber('<args>'))
  command! -buffer -nargs=? -complete=custom,s:tests BtqTest lua require('btq.test').run('<args>')
  command! -buffer BtqExplore lua require('btq.explore').run()
endif

let b:undo_ftplugin = 'setlocal commentstring< comments< formatoptions< expandtab< shiftwidth< softtabstop<'
      \ . ' iskeyword< suffixesadd< include< makeprg< errorformat<'
      \ . (has('nvim-0.11') ? ' completeopt<' : '')
      \ . (has('nvim') ? ' | delcommand -buffer BtqPreview | delcommand -buffer BtqRun | delcommand -buffer BtqTest'
      \ . ' | delcommand -buffer BtqExplore' : '')
