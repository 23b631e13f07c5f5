-- `:BtqConvert`: XML as a mission: the server writes what `btq import` does, beside the XML, and both are open then.
local M = {}

function M.run()
  vim.cmd('update') -- what is written is what `btq import` makes of the file
  local asked = { command = 'btq.server.import', arguments = { { uri = vim.uri_from_bufnr(0) } } }
  local answers, failed = vim.lsp.buf_request_sync(0, 'workspace/executeCommand', asked, 10000)
  if not answers then
    return vim.notify('btq: ' .. failed, vim.log.levels.WARN)
  end
  for _, answer in pairs(answers) do
    local refused = answer.error or answer.err
    if refused then
      return vim.notify('btq: ' .. refused.message, vim.log.levels.WARN)
    end
    for _, file in ipairs(answer.result.files) do
      vim.cmd('vsplit ' .. vim.fn.fnameescape(vim.uri_to_fname(file)))
    end
  end
end

return M
