#!/usr/bin/python3
"""Draws the screen of Neovim with a model, checked and completed by taplo's language server, as SVG with the terminal's characters and colours.

usage: photograph_editor.py STEPLAP OUTPUT_FOLDER; requires neovim, python3-pyte, and the requirements of tools/editors/check_schema
"""
import fcntl
import html
import os
import pathlib
import pty
import select
import struct
import subprocess
import sys
import tempfile
import termios
import time

import pyte

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLUMNS, ROWS, WIDTH, HEIGHT = 100, 26, 8.4, 18
NAMED = {"black": "#222222", "red": "#c4463a", "green": "#3f7d3a", "brown": "#8a6d1c", "blue": "#31639c", "magenta": "#8a3f86", "cyan": "#1f7a7a", "white": "#d8d8d4",
         "default": ""}
MODEL = """[[body]]
name = "box"
mass = "2 t"
inertia = 330.0
position = [0.0, 0.5]
outline = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]

[[element]]
name = "floor"
kind = "polygon_contact"
a = "box"
stifness = "1 GN/m2"
static_friction = -0.4

[[element]]
name = "spring"
kind = "spring_damper"
"""


class Terminal:
    def __init__(self, command, folder, environment):
        self.screen = pyte.Screen(COLUMNS, ROWS)
        self.stream = pyte.ByteStream(self.screen)
        self.process, self.file = pty.fork()
        if self.process == 0:
            os.chdir(folder)
            os.execvpe(command[0], command, environment)
        fcntl.ioctl(self.file, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))

    def wait(self, text, seconds=60):
        """Waits until the screen shows the text and has not changed for a while."""
        end, still = time.monotonic() + seconds, 0.0
        while time.monotonic() < end:
            if select.select([self.file], [], [], 0.2)[0]:
                self.stream.feed(os.read(self.file, 1 << 16))
                still = time.monotonic()
            elif time.monotonic() - still > 1.5 and any(text in line for line in self.screen.display):
                return
        sys.exit(f"'{text}' is not on the screen:\n" + "\n".join(self.screen.display))

    def type(self, keys):
        os.write(self.file, keys.encode())

    def svg(self, title):
        def colour(value, otherwise):
            return NAMED.get(value, "#" + value if len(value) == 6 else otherwise) or otherwise

        paper, ink = "#ffffff", "#222222"
        width, height = COLUMNS * WIDTH + 20, ROWS * HEIGHT + 20
        parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" width="{width:g}" height="{height:g}">', f"<title>{html.escape(title)}</title>",
                 f'<rect width="100%" height="100%" rx="6" fill="{paper}" stroke="#bbbbbb"/>', '<g font-family="DejaVu Sans Mono, monospace" font-size="14" xml:space="preserve">']
        for y in range(ROWS):
            x = 0
            while x < COLUMNS:  # groups adjacent cells of equal style
                cell, begin = self.screen.buffer[y][x], x
                look = (cell.fg, cell.bg, cell.bold, cell.underscore, cell.reverse)
                text = ""
                while x < COLUMNS and (lambda c: (c.fg, c.bg, c.bold, c.underscore, c.reverse))(self.screen.buffer[y][x]) == look:
                    text += self.screen.buffer[y][x].data
                    x += 1
                front, back = colour(cell.fg, ink), colour(cell.bg, paper)
                if cell.reverse:
                    front, back = back, front
                left, top = 10 + begin * WIDTH, 10 + y * HEIGHT
                if back != paper:
                    parts.append(f'<rect x="{left:.1f}" y="{top}" width="{(x - begin) * WIDTH:.1f}" height="{HEIGHT}" fill="{back}"/>')
                if text.strip():
                    style = (' font-weight="bold"' if cell.bold else "") + (' text-decoration="underline"' if cell.underscore else "")
                    parts.append(f'<text x="{left:.1f}" y="{top + 13.5}" textLength="{(x - begin) * WIDTH:.1f}" fill="{front}"{style}>{html.escape(text.replace(" ", chr(0xA0)))}</text>')
        return "\n".join(parts + ["</g>", "</svg>"]) + "\n"


def main():
    program, output = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "steplap.schema.json").write_bytes(subprocess.run([program, "schema"], check=True, capture_output=True).stdout)
        (folder / "box.toml").write_text("#:schema ./steplap.schema.json\n" + MODEL, encoding="utf-8")
        server = f"let g:steplap_taplo = ['node', '{ROOT}/tools/editors/taplo_lsp.js']"
        command = ["nvim", "-u", "NONE", "--cmd", server, "--cmd", "set laststatus=0 noruler number background=light noswapfile updatetime=300 pumheight=7 completeopt=menuone,noselect",
                   "--cmd", f"luafile {ROOT}/tools/editors/steplap.lua", "--cmd", "filetype on | syntax on", "box.toml"]
        terminal = Terminal(command, folder, {**os.environ, "TERM": "xterm-256color", "XDG_STATE_HOME": name, "XDG_DATA_HOME": name, "XDG_CACHE_HOME": name, "NVIM_LOG_FILE": "/dev/null"})
        terminal.wait("was expected")
        (output / "editor_errors.svg").write_text(terminal.svg("Neovim marks a misspelt field and a friction below zero in a model"), encoding="utf-8")
        terminal.type("Go\x18\x0f")
        terminal.wait("active_part")
        (output / "editor_completion.svg").write_text(terminal.svg("Neovim offers the fields of an element"), encoding="utf-8")
        terminal.type("\x1b\x1b:qa!\r")


if __name__ == "__main__":
    main()
