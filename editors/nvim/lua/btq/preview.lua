-- `:BtqPreview`: the trees of a mission in the browser, following what is typed and the cursor; a click there leads here.
-- One invariant: the program that serves the page receives everything over its standard input, so that nothing but this
-- Neovim can tell it anything, and it ends with the buffer or with Neovim.
local M = {}

local PAUSE = 150 -- milliseconds without a key, after which the text is sent
local jobs = {} -- the program that serves the page, by buffer

--- Show the trees of the current buffer; with `stop` end showing them.
function M.run(stop)
  local buffer = vim.api.nvim_get_current_buf()
  if jobs[buffer] then
    vim.fn.jobstop(jobs[buffer])
    jobs[buffer] = nil
  end
  if stop then
    return
  end
  local file = vim.api.nvim_buf_get_name(buffer)
  if vim.fn.filereadable(file) == 0 then
    return vim.notify('btq: save this mission first to show its trees', vim.log.levels.WARN)
  end
  local command = require('btq').program()
  if vim.fn.executable(command[1]) ~= 1 then
    return vim.notify('btq: ' .. command[1] .. ' not found; see :help btq_program', vim.log.levels.WARN)
  end
  vim.list_extend(command, { 'preview', file, '--follow', '--open' })
  local job
  job = vim.fn.jobstart(command, {
    on_stdout = M.lines(function(line)
      M.printed(buffer, line)
    end),
    on_stderr = M.lines(function(line)
      vim.notify(line, vim.log.levels.WARN)
    end),
    on_exit = function()
      if jobs[buffer] == job then
        jobs[buffer] = nil
      end
    end,
  })
  jobs[buffer] = job
  M.follow(buffer, job)
end

--- Tell the program of a buffer something; without one it is started.
function M.send(buffer, message)
  if not jobs[buffer] then
    M.run(false)
  end
  if jobs[buffer] then
    vim.fn.chansend(jobs[buffer], vim.fn.json_encode(message) .. '\n')
  end
end

--- Tell the program of the buffer's text and of the cursor, now and whenever they change.
function M.follow(buffer, job)
  local line, typed = nil, 0
  local function send(message)
    pcall(vim.fn.chansend, job, vim.fn.json_encode(message) .. '\n') -- it may just have ended
  end
  local function cursor()
    local now = vim.fn.line('.')
    if now ~= line then
      line = now
      send({ line = line })
    end
  end
  local function text()
    send({ text = table.concat(vim.api.nvim_buf_get_lines(buffer, 0, -1, true), '\n') .. '\n' })
  end
  local group = vim.api.nvim_create_augroup('btq_preview_' .. buffer, { clear = true })
  local function on(events, act)
    vim.api.nvim_create_autocmd(events, { group = group, buffer = buffer, callback = act })
  end
  on({ 'CursorMoved', 'CursorMovedI' }, cursor)
  on({ 'TextChanged', 'TextChangedI', 'TextChangedP' }, function()
    typed = typed + 1
    local mine = typed
    vim.defer_fn(function()
      if mine == typed and vim.api.nvim_buf_is_loaded(buffer) then
        text()
      end
    end, PAUSE)
  end)
  on('BufReadPost', text)
  on('BufUnload', function()
    vim.schedule(function() -- a reload unloads, too, and has loaded again by then
      if not vim.api.nvim_buf_is_loaded(buffer) then
        vim.fn.jobstop(job)
      end
    end)
  end)
  text()
  cursor()
end

--- What the program prints: the address of the page, and the place of a clicked node.
function M.printed(buffer, said)
  local line, column = said:match(':(%d+):(%d+)$')
  if not line then
    return vim.notify('btq: ' .. said)
  end
  local window = vim.fn.bufwinid(buffer)
  if window == -1 then
    vim.cmd('buffer ' .. buffer)
  else
    vim.api.nvim_set_current_win(window)
  end
  vim.cmd("normal! m'")
  vim.fn.setcursorcharpos(tonumber(line), tonumber(column))
  vim.cmd('normal! zv')
end

--- A job's callback that hands on whole lines: a line may come in pieces.
function M.lines(act)
  local rest = ''
  return function(_, pieces)
    pieces[1] = rest .. pieces[1]
    rest = table.remove(pieces)
    for _, line in ipairs(pieces) do
      act(line)
    end
  end
end

return M
