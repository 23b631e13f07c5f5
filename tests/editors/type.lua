-- A person who types a text in another Neovim: `nvim --headless -l type.lua`, with what to do as JSON in BTQ_TYPE:
-- `command` starts that Neovim with an empty file, `text` is typed there, and `pause` are the milliseconds of thinking
-- before Enter, Tab, a blank and a quote that closes.  A person looks at what Enter has begun the line with, deletes what
-- does not belong there, and types what is missing.  It prints how many lists opened.  `level` is what Tab writes there,
-- `findings` how many diagnostics there are at last.
local todo = vim.json.decode(vim.env.BTQ_TYPE)
local LEVEL = todo.level or 4 -- blanks that Tab writes where a line begins
local other = vim.fn.jobstart(todo.command, { rpc = true, env = vim.empty_dict() })

local function ask(method, ...)
  return vim.rpcrequest(other, 'nvim_' .. method, ...)
end

local function think()
  if todo.pause > 0 then
    vim.wait(todo.pause)
  end
end

local function press(key)
  ask('input', key == '<' and '<lt>' or key)
end

local served = "return #(vim.lsp.get_clients({ bufnr = 0 })) > 0 and vim.lsp.get_clients()[1].initialized or false"
if not todo.findings then -- XML has no server until one has typed its root element
  assert(vim.wait(20000, function()
    return ask('exec_lua', served, {}) == true
  end, 50), 'no server')
end
ask('exec_lua', [[
  btq_lists = 0
  vim.api.nvim_create_autocmd('CompleteChanged', { callback = function() btq_lists = btq_lists + 1 end })
]], {})
press('i')
for number, line in ipairs(vim.split(todo.text, '\n', { plain = true })) do
  local begun = ''
  if number > 1 then
    think()
    press('<CR>')
    begun = ask('get_current_line')
    -- A comment goes on by itself; the blanks of an empty line go when one leaves it.
    while not vim.startswith(line, begun) and (line ~= '' or begun:find('%S')) do
      think()
      press('<BS>')
      begun = ask('get_current_line')
    end
    while not begun:find('%S') and vim.startswith(line, begun .. (' '):rep(LEVEL)) do
      think()
      press('<Tab>')
      begun = ask('get_current_line')
    end
  end
  local quoted = false
  for key in line:sub(#begun + 1):gmatch('.') do
    if key == ' ' or key == '"' and quoted then
      think()
    end
    if key == '"' then
      quoted = not quoted
    end
    press(key)
  end
end
press('<Esc>')
assert(not todo.findings or vim.wait(20000, function()
  return ask('exec_lua', 'return #vim.diagnostic.get(0)', {}) == todo.findings
end, 50), 'other findings')
io.stdout:write(tostring(ask('exec_lua', 'return btq_lists', {})) .. '\n')
ask('command', 'write')
ask('command', 'stopinsert')
vim.rpcnotify(other, 'nvim_command', 'qall!')
vim.fn.jobwait({ other }, 10000)
