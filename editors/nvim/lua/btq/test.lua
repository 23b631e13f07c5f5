-- `:BtqTest`: the scenarios of a mission are run; what they do not meet is a diagnostic, which the server publishes.
-- One invariant: the server says which scenarios there are and runs them; nothing here reads a mission.
local M = {}

local server = require('btq.server')
local cancel = {} -- what is still asked for, by buffer

--- Run all scenarios of the current buffer, or with `nearest` the one at the cursor, else above it, else below.
function M.run(which)
  local buffer = vim.api.nvim_get_current_buf()
  local client = server.of(buffer)
  if not client then
    return
  end
  if which ~= 'nearest' then
    return M.titled(client, buffer)
  end
  local line = vim.fn.line('.') - 1
  server.ask(client, buffer, 'btq.server.scenarios', { { uri = vim.uri_from_bufnr(buffer) } }, function(files)
    local nearest
    for _, scenario in ipairs(files[1] and files[1].scenarios or {}) do
      if not nearest or scenario.range.start.line <= line then
        nearest = scenario.title
      end
    end
    M.titled(client, buffer, nearest)
  end)
end

--- Run the scenario of a buffer with a title, or all; what still runs there is cancelled.
function M.titled(client, buffer, title)
  if cancel[buffer] then
    cancel[buffer]()
  end
  local arguments = { { uri = vim.uri_from_bufnr(buffer) }, title }
  cancel[buffer] = server.ask(client, buffer, 'btq.server.runScenarios', arguments, function(results)
    cancel[buffer] = nil
    server.renew(client, buffer)
    M.tell(results)
  end)
end

--- Say how many scenarios have which outcome.
function M.tell(results)
  local numbers = {}
  for _, result in ipairs(results) do
    numbers[result.outcome] = (numbers[result.outcome] or 0) + 1
  end
  local counts = {}
  for _, outcome in ipairs({ 'passed', 'failed', 'unknown', 'error' }) do
    if numbers[outcome] then
      table.insert(counts, ('%d %s'):format(numbers[outcome], outcome))
    end
  end
  local level = numbers.passed == #results and vim.log.levels.INFO or vim.log.levels.WARN
  vim.notify('btq: scenarios: ' .. table.concat(counts, ', '), level)
end

return M
