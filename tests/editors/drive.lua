-- What a test does in Neovim: `nvim … FILE -S drive.lua`, with BTQ_SCRIPT the Lua that does it.  That returns a value,
-- which is printed as JSON on the last line; an error is printed with its trace, and the exit code is 1.
local M = {}

local clients = vim.lsp.get_clients or vim.lsp.get_active_clients

function M.wait(condition, what)
  assert(vim.wait(20000, condition, 20), 'waited in vain for ' .. what)
end

function M.client()
  for _, client in pairs(clients()) do
    if client.name == 'btq' and (client.initialized or client.server_capabilities) then
      return client
    end
  end
end

--- Diagnostics of a buffer as `line:first-last code`, lines and columns from 1 in bytes, when there are `count` of them.
function M.diagnostics(count, buffer)
  buffer = buffer or vim.api.nvim_get_current_buf()
  M.wait(function()
    return #vim.diagnostic.get(buffer) == count
  end, count .. ' diagnostics')
  return vim.tbl_map(function(each)
    return ('%d:%d-%d %s'):format(each.lnum + 1, each.col + 1, each.end_col, each.code)
  end, vim.diagnostic.get(buffer))
end

--- The answer of the server to a request at the cursor.
function M.ask(method, extra)
  local client = M.client()
  local params = vim.lsp.util.make_position_params(0, client.offset_encoding)
  params = vim.tbl_extend('force', params, extra or {})
  local answers, failed = vim.lsp.buf_request_sync(0, method, params, 20000)
  assert(answers, method .. ': ' .. tostring(failed))
  for _, answer in pairs(answers) do
    assert(not answer.err and not answer.error, vim.inspect(answer))
    return answer.result
  end
end

function M.lines(buffer)
  return vim.api.nvim_buf_get_lines(buffer or 0, 0, -1, true)
end

--- The cursor on the `nth` place where this stands.
function M.to(text, nth)
  vim.fn.cursor(1, 1)
  for _ = 1, nth or 1 do
    assert(vim.fn.search('\\V\\C' .. text, 'cW') > 0, text .. ' is not there')
    if _ < (nth or 1) then
      vim.cmd('normal! l')
    end
  end
end

function M.format()
  if vim.lsp.buf.format then
    vim.lsp.buf.format({ timeout_ms = 20000 })
  else
    vim.lsp.buf.formatting_sync(nil, 20000)
  end
end

local ok, answer = xpcall(function()
  return assert(loadstring(vim.env.BTQ_SCRIPT, 'the test'))(M)
end, debug.traceback)
io.stdout:write('\n' .. (ok and vim.fn.json_encode(answer == nil and vim.NIL or answer) or tostring(answer)) .. '\n')
for _, client in pairs(clients()) do
  if vim.fn.has('nvim-0.11') == 1 then
    client:stop()
  else
    client.stop()
  end
end
vim.wait(5000, function()
  return #clients() == 0
end, 20)
vim.cmd(ok and 'qall!' or 'cquit 1')
