-- `:BtqRun`: a run of the logs in the page of `:BtqPreview`, whose keys step through it: n and p, N and P for the ends.
-- One invariant: the server says which runs there are and what happened in one; nothing here reads a log.
local M = {}

local server = require('btq.server')

--- Show the run with a number; without one choose among the last and the worst.
function M.run(number)
  local buffer = vim.api.nvim_get_current_buf()
  local client = server.of(buffer)
  if not client then
    return
  end
  local document = { uri = vim.uri_from_bufnr(buffer) }
  local function show(chosen)
    server.ask(client, buffer, 'btq.server.run', { document, chosen }, function(run)
      require('btq.preview').send(buffer, { run = run })
    end)
  end
  if number then
    return show(number)
  end
  server.ask(client, buffer, 'btq.server.runs', { document }, function(runs)
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
