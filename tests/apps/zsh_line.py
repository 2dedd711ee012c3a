# SPDX-License-Identifier: Apache-2.0
"""Prints a line as an interactive zsh completes it by a tab; completion functions are those of the folder.

usage: zsh_line.py LINE
"""
import os
import pty
import sys
import tempfile

START = """PS1='READY> '; unset zle_bracketed_paste; fpath=($PWD $fpath); autoload -U compinit; compinit -u -D
show() { print -r -- "<<<$BUFFER>>>"; exit }; zle -N show; bindkey '^T' show; bindkey '^I' complete-word
"""


def read_until(terminal, end):
    text = ""
    while end not in text:
        text += os.read(terminal, 65536).decode(errors="replace")
    return text


with tempfile.TemporaryDirectory() as home:
    with open(os.path.join(home, ".zshrc"), "w", encoding="utf-8") as start:
        start.write(START)
    child, terminal = pty.fork()
    if child == 0:
        os.environ.update(TERM="dumb", ZDOTDIR=home)
        os.execvp("zsh", ["zsh", "-d", "-i"])
    read_until(terminal, "READY> ")
    os.write(terminal, sys.argv[1].encode() + b"\t\x14")  # the tab, and the key of `show`
    print(read_until(terminal, ">>>").split("<<<")[1].split(">>>")[0], end="")
