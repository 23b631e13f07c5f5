-- `:checkhealth btq`: whether the server is found, answers, and serves the buffers that are open.
local M = {}

local health = vim.health or require('health')
local report = {
  start = health.start or health.report_start,
  ok = health.ok or health.report_ok,
  warn = health.warn or health.report_warn,
  error = health.error or health.report_error,
  info = health.info or health.report_info,
}

function M.check()
  report.start('btq')
  if vim.fn.has('nvim-0.7') == 0 then
    report.error('this plug-in requires Neovim 0.7 or newer')
  end
  local command = require('btq').command()
  if vim.fn.executable(command[1]) ~= 1 then
    report.error(command[1] .. ' not found', {
      'python3 -m pip install /path/to/btq',
      "or set its path: let g:btq_cmd = ['/path/to/btq-lsp']",
    })
    return
  end
  local answer = vim.fn.systemlist(vim.list_extend(vim.deepcopy(command), { '--version' }))
  if vim.v.shell_error ~= 0 then
    report.error(table.concat(command, ' ') .. ' does not start', answer)
    return
  end
  report.ok(vim.fn.exepath(command[1]) .. ': ' .. (answer[1] or ''))
  local clients = (vim.lsp.get_clients or vim.lsp.get_active_clients)({ name = 'btq' })
  local serving = 0
  for _, client in pairs(clients) do
    if client.name == 'btq' then -- 0.7 does not filter
      serving = serving + 1
      report.info(('server %d serves %s'):format(client.id, client.config.root_dir or 'single files'))
    end
  end
  if serving == 0 then
    report.info('no server runs: open a mission to start one')
  end
end

return M
