" How a mission is edited: comments, words, indentation by four blanks, and `:make` for `btq check`.
if exists('b:did_ftplugin')
  finish
endif
let b:did_ftplugin = 1

setlocal commentstring=#\ %s
setlocal comments=:#,://,s1:/*,mb:*,ex:*/
setlocal formatoptions-=t formatoptions+=croql
setlocal expandtab shiftwidth=4 softtabstop=4
" A hyphen joins words: performance-efficiency is one name.
setlocal iskeyword+=-
setlocal suffixesadd=.btq,.xml
setlocal include=^\\s*include\\s\\+[\"']

if executable('btq')
  setlocal makeprg=btq\ check\ --output-format\ concise\ %:S
  setlocal errorformat=%f:%l:%c:\ %trror[%m,%f:%l:%c:\ %tarning[%m,%f:%l:%c:\ %tnfo[%m,%f:%l:%c:\ %tint[%m,%-G%.%#
endif

if has('nvim')
  command! -buffer -bang BtqPreview lua require('btq.preview').run('<bang>' == '!')
endif

let b:undo_ftplugin = 'setlocal commentstring< comments< formatoptions< expandtab< shiftwidth< softtabstop<'
      \ . ' iskeyword< suffixesadd< include< makeprg< errorformat<'
      \ . (has('nvim') ? ' | delcommand -buffer BtqPreview' : '')
