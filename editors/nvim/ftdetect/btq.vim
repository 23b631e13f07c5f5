autocmd BufRead,BufNewFile *.btq,*.qualitybtcpp set filetype=btq
