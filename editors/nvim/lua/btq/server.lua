-- The server of a buffer, and its commands, in every version of Neovim.
local M = {}

--- The server of a buffer; if there is none, a message says so.
function M.of(buffer)
  for _, client in pairs((vim.lsp.get_clients or vim.lsp.buf_get_clients)(vim.fn.has('nvim-0.10') == 1 and { bufnr = buffer } or buffer)) do
    if client.name == 'btq' then
      return client
    end
  end
  vim.notify('btq: no server; run :checkhealth btq', vim.log.levels.WARN)
end

--- Send a request; returns its number.
function M.request(client, method, parameters, act, buffer)
  local _, number
  if vim.fn.has('nvim-0.11') == 1 then
    _, number = client:request(method, parameters, act, buffer)
  else
    _, number = client.request(method, parameters, act, buffer)
  end
  return number
end

--- Ask the server for a command's result, and act on it; an error is a message. Returns a function that cancels it.
function M.ask(client, buffer, command, arguments, act)
  local is_cancelled = false
  local function answer(err, result)
    if is_cancelled then
      return
    end
    if err then
      return vim.notify('btq: ' .. err.message, vim.log.levels.WARN)
    end
    act(result)
  end
  local number = M.request(client, 'workspace/executeCommand', { command = command, arguments = arguments }, answer, buffer)
  return function()
    is_cancelled = true
    if vim.fn.has('nvim-0.11') == 1 then
      client:cancel_request(number)
    else
      client.cancel_request(number)
    end
  end
end

--- Ask for a buffer's diagnostics again, where Neovim asks for them by itself, from 0.10 on: up to 0.12 it does so only
--- after an edit, whatever the server tells it.
function M.renew(client, buffer)
  local provider = client.server_capabilities.diagnosticProvider
  if provider and vim.lsp.diagnostic.on_diagnostic then
    local parameters = { identifier = provider.identifier, textDocument = { uri = vim.uri_from_bufnr(buffer) } }
    M.request(client, 'textDocument/diagnostic', parameters, nil, buffer)
  end
end

return M
