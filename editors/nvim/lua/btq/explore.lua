-- `:BtqExplore`, and what the server's code lens and code action run: how a requirement can be violated.
-- One invariant: the server explores; a run that it finds is opened as the scenario that it writes.
local M = {}

local server = require('btq.server')

--- Explore the requirement at the cursor.
function M.run()
  local buffer = vim.api.nvim_get_current_buf()
  local client = server.of(buffer)
  if not client then
    return
  end
  local place = vim.lsp.util.make_range_params(0, client.offset_encoding)
  place.context = { diagnostics = {}, only = { 'btq.explore' } }
  server.request(client, 'textDocument/codeAction', place, function(_, actions)
    if not actions or not actions[1] then
      return vim.notify('btq: no requirement at the cursor that can be explored', vim.log.levels.WARN)
    end
    M.ask(client, buffer, actions[1].command.arguments)
  end, buffer)
end

--- Ask how a requirement can be violated, and open a run for each mission where it can be.
function M.ask(client, buffer, arguments)
  server.ask(client, buffer, 'btq.server.explore', arguments, function(answers)
    local level, messages = vim.log.levels.INFO, {}
    for _, answer in ipairs(answers) do
      local is_violated = false
      for _, clause in ipairs(answer.clauses) do
        is_violated = is_violated or clause.answer == 'yes'
        table.insert(messages, clause.message)
      end
      if answer.problem ~= '' then
        table.insert(messages, answer.problem)
      end
      if is_violated then
        level = vim.log.levels.WARN
        M.open(answer)
      end
    end
    vim.notify('btq: ' .. table.concat(messages, '\n'), level)
  end)
end

--- Open the scenarios of a mission in a buffer that is not written yet, or the run as text if no scenario says it.
function M.open(answer)
  local has_scenarios = type(answer.scenarios) == 'table'
  vim.cmd('botright vnew')
  local text = has_scenarios and answer.scenarios.text or answer.text
  vim.api.nvim_buf_set_lines(0, 0, -1, false, vim.split(text:gsub('\n$', ''), '\n'))
  if has_scenarios then
    vim.api.nvim_buf_set_name(0, vim.uri_to_fname(answer.scenarios.uri))
    vim.bo.filetype = 'btq'
  else
    vim.bo.buftype = 'nofile'
  end
end

return M
