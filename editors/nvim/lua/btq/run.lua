-- `:BtqRun`: a run of the logs in the page of `:BtqPreview`, whose keys step through it: n and p, N and P for the ends.
-- One invariant: the server says which runs there are and what happened in one; nothing here reads a log.
local M = {}

--- The server of a buffer.
local function server(buffer)
  for _, client in pairs((vim.lsp.get_clients or vim.lsp.buf_get_clients)(vim.fn.has('nvim-0.10') == 1 and { bufnr = buffer } or buffer)) do
    if client.name == 'btq' then
      return client
    end
  end
end

--- Ask the server for a command's result, and act on it; an error is a message.
local function ask(client, buffer, command, arguments, act)
  local function answer(err, result)
    if err then
      return vim.notify('btq: ' .. err.message, vim.log.levels.WARN)
    end
    act(result)
  end
  local parameters = { command = command, arguments = arguments }
  if vim.fn.has('nvim-0.11') == 1 then
    client:request('workspace/executeCommand', parameters, answer, buffer)
  else
    client.request('workspace/executeCommand', parameters, answer, buffer)
  end
end

--- Show the run with a number; without one choose among the last and the worst.
function M.run(number)
  local buffer = vim.api.nvim_get_current_buf()
  local client = server(buffer)
  if not client then
    return vim.notify('btq: no server; run :checkhealth btq', vim.log.levels.WARN)
  end
  local document = { uri = vim.uri_from_bufnr(buffer) }
  local function show(chosen)
    ask(client, buffer, 'btq.server.run', { document, chosen }, function(run)
      require('btq.preview').send(buffer, { run = run })
    end)
  end
  if number then
    return show(number)
  end
  ask(client, buffer, 'btq.server.runs', { document }, function(runs)
    local function title(run)
      return 'run ' .. run.run .. ': ' .. run.said
    end
    vim.ui.select(runs, { prompt = 'Show run', format_item = title }, function(run)
      if run then
        show(run.run)
      end
    end)
  end)
end

return M
