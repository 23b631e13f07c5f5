-- The language server of btq in Neovim's built-in client, from 0.7 on.
-- One invariant: one server for each project, whatever the version of Neovim.
local M = {}

local MARKERS = { 'btq.toml', 'pyproject.toml', '.git' }

--- The command that starts the server: `vim.g.btq_cmd`, else `btq-lsp` of the active virtual environment, else of the PATH.
function M.command()
  if vim.g.btq_cmd then
    return vim.g.btq_cmd
  end
  local environment = vim.env.VIRTUAL_ENV
  if environment then
    for _, place in ipairs({ '/bin/btq-lsp', '/Scripts/btq-lsp.exe' }) do
      if vim.fn.executable(environment .. place) == 1 then
        return { environment .. place }
      end
    end
  end
  return { 'btq-lsp' }
end

--- The command line of btq's other commands: `vim.g.btq_program`, else `btq` beside the server, else that of the PATH.
function M.program()
  if vim.g.btq_program then
    return vim.deepcopy(vim.g.btq_program)
  end
  local beside, is_ours = M.command()[1]:gsub('btq%-lsp(%.?%a*)$', 'btq%1')
  return { is_ours == 1 and vim.fn.executable(beside) == 1 and beside or 'btq' }
end

--- What the client can do, and the commands that the server's code lenses run.
local function capabilities()
  local known = vim.lsp.protocol.make_client_capabilities()
  known.experimental = { commands = { 'btq.showReferences', 'btq.runScenario', 'btq.explore' } }
  return known
end

--- What the client does by itself: a code lens with nothing to open has no command, and Neovim would warn about that.
local COMMANDS = { [''] = function() end }

--- Start the server for every mission that is opened from now on.
function M.setup()
  vim.lsp.commands['btq.showReferences'] = function(command, context)
    local client = vim.lsp.get_client_by_id(context.client_id)
    local places = vim.lsp.util.locations_to_items(command.arguments[3], client.offset_encoding)
    vim.fn.setqflist({}, ' ', { title = command.title, items = places })
    vim.cmd('botright copen')
  end
  vim.lsp.commands['btq.runScenario'] = function(command, context)
    local buffer = vim.uri_to_bufnr(command.arguments[1].uri)
    require('btq.test').titled(vim.lsp.get_client_by_id(context.client_id), buffer, command.arguments[2])
  end
  vim.lsp.commands['btq.explore'] = function(command, context)
    local buffer = vim.uri_to_bufnr(command.arguments[1].uri)
    require('btq.explore').ask(vim.lsp.get_client_by_id(context.client_id), buffer, command.arguments)
  end
  local starts_by_itself = vim.lsp.config and vim.lsp.enable -- 0.11 and newer
  if starts_by_itself then
    vim.lsp.config('btq', {
      cmd = M.command(),
      capabilities = capabilities(),
      commands = COMMANDS,
      filetypes = { 'btq' },
      root_markers = MARKERS,
    })
    vim.lsp.enable('btq')
  end
  local group = vim.api.nvim_create_augroup('btq', { clear = true })
  vim.api.nvim_create_autocmd('BufWritePost', {
    group = group,
    pattern = { 'btq.toml', 'pyproject.toml' },
    desc = 'tell the server of btq that a project file has changed: on Linux Neovim watches no files',
    callback = function(event)
      local changes = { { uri = vim.uri_from_fname(vim.fn.fnamemodify(event.match, ':p')), type = 2 } }
      for _, client in pairs((vim.lsp.get_clients or vim.lsp.get_active_clients)()) do
        if client.name == 'btq' then
          M.notify(client, 'workspace/didChangeWatchedFiles', { changes = changes })
        end
      end
    end,
  })
  vim.api.nvim_create_autocmd('FileType', {
    group = group,
    pattern = 'btq',
    desc = 'start the language server of btq',
    callback = function(event)
      if M.found() and not starts_by_itself then
        M.attach(event.buf)
      end
    end,
  })
  vim.api.nvim_create_autocmd('FileType', {
    group = group,
    pattern = 'xml',
    desc = 'start the language server of btq for XML of BehaviorTree.CPP',
    callback = function(event)
      M.watch(event.buf)
    end,
  })
end

--- Attach the server to a buffer of XML, if that is BehaviorTree.CPP's or as soon as it becomes that; there is much other XML.
function M.watch(buffer)
  local function is_ours()
    if not M.has_trees(buffer) then
      return false
    end
    if M.found() then
      M.attach(buffer)
    end
    if vim.fn.has('nvim-0.11') == 1 then -- as for missions
      vim.api.nvim_set_option_value('completeopt', vim.go.completeopt .. ',noselect', { buf = buffer })
    end
    vim.api.nvim_buf_create_user_command(buffer, 'BtqPreview', function(given)
      require('btq.preview').run(given.bang)
    end, { bang = true })
    vim.api.nvim_buf_create_user_command(buffer, 'BtqRun', function(given)
      require('btq.run').run(tonumber(given.args))
    end, { nargs = '?' })
    vim.api.nvim_buf_create_user_command(buffer, 'BtqConvert', function()
      require('btq.convert').run()
    end, {})
    return true
  end
  if not is_ours() then
    local changes = { 'TextChanged', 'TextChangedI', 'TextChangedP' }
    vim.api.nvim_create_autocmd(changes, { group = 'btq', buffer = buffer, callback = is_ours }) -- true ends it
  end
end

--- Whether a buffer has XML of BehaviorTree.CPP: what begins with `<root`, and names a version or contains trees or models.
function M.has_trees(buffer)
  local text = table.concat(vim.api.nvim_buf_get_lines(buffer, 0, -1, false), '\n')
  local at = 1
  while true do -- before the root there may be declarations and comments
    at = text:find('<', at, true)
    if not at or not text:find('^<[?!]', at) then
      break
    end
    local _, last = text:find(text:find('^<!%-%-', at) and '-->' or '>', at, true)
    at = last or #text + 1
  end
  if not at or not text:find('^<root[%s/>]', at) then
    return false
  end
  local root = text:match('^<root[^>]*', at)
  if root:find('%sBTCPP_format%s*=') or root:find('%smain_tree_to_execute%s*=') then
    return true
  end
  for _, tag in ipairs({ 'BehaviorTree', 'TreeNodesModel' }) do
    if text:find('<' .. tag .. '%f[^%w_]', at) then
      return true
    end
  end
  return text:find('<include%s[^>]*%f[%w]path%s*=', at) ~= nil
end

--- Tell a server something: from 0.11 on it is the client's own function.
function M.notify(client, method, params)
  if vim.fn.has('nvim-0.11') == 1 then
    client:notify(method, params)
  else
    client.notify(method, params)
  end
end

--- Whether the server's program is there; reports it the first time that it is not, because no version of Neovim does.
function M.found()
  local program = M.command()[1]
  if vim.fn.executable(program) == 1 then
    return true
  end
  vim.notify_once('btq: ' .. program .. ' not found; run :checkhealth btq', vim.log.levels.WARN)
  return false
end

--- Attach the server of the buffer's project; for missions Neovim 0.11 and newer do it themselves.
function M.attach(buffer)
  local command = M.command()
  local file = vim.api.nvim_buf_get_name(buffer)
  local root = M.root(file)
  if vim.lsp.start then -- 0.8 and newer
    vim.lsp.start(
      { name = 'btq', cmd = command, capabilities = capabilities(), commands = COMMANDS, root_dir = root },
      { bufnr = buffer }
    )
    return
  end
  M.clients = M.clients or {} -- 0.7 does not know which clients are of one project
  local client = M.clients[root]
  if not client or vim.lsp.client_is_stopped(client) then
    client = vim.lsp.start_client({
      name = 'btq',
      cmd = command,
      capabilities = capabilities(),
      commands = COMMANDS,
      root_dir = root,
    })
    M.clients[root] = client
  end
  vim.lsp.buf_attach_client(buffer, client)
end

--- The folder of the project: the nearest above with one of the markers, else the file's own.
function M.root(file)
  local own = vim.fn.fnamemodify(file ~= '' and file or vim.fn.getcwd() .. '/x', ':p:h')
  for _, marker in ipairs(MARKERS) do
    local found = vim.fn.finddir(marker, own .. ';')
    if found == '' then
      found = vim.fn.findfile(marker, own .. ';')
    end
    if found ~= '' then
      return vim.fn.fnamemodify(vim.fn.fnamemodify(found, ':p'):gsub('/$', ''), ':h')
    end
  end
  return own
end

return M
