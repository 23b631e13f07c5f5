-- Starts the language server for missions; `vim.g.btq_no_lsp = true` leaves that to the user.
if vim.g.loaded_btq then
  return
end
vim.g.loaded_btq = true

if not vim.g.btq_no_lsp then
  require('btq').setup()
end
