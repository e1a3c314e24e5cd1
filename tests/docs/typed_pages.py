#!/usr/bin/python3
"""Types what pages tell to type, in the order in which it stands, in a clean copy of the models, and compares what is said.

usage: typed_pages.py [--update] PROGRAM ROOT PAGE...

With --update a block that shows something else than the program says becomes what it says; shorten it with "…" by hand.

Of a page these blocks count:
  ```toml   whose first line is "# NAME.toml" is the file NAME.toml; with "# NAME.toml, continued" it is added to that file.
            Any other is a piece of a file, which is not written.
  ```csv    the same, with "# NAME.csv".
  ```diff   lines of the file written last that are replaced for the next ```sh block only.
  ```sh     commands. Each ends with exit code 0, unless what is shown holds an error; what is left out is told with its reason.
  ```python a script, run by the Python of this test.
  ```text   directly after ```sh or ```python: what these commands say, on both streams. A line "…" stands for any lines, "…" within a line
            for any text, as times of computing differ. Spaces at the ends of lines do not count.
Pages that are named together are typed one after the other in the same folder.
"""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

LEFT_OUT = {
    "tools/run": "it builds; its last command, which simulates, is typed instead",
    "tools/test": "it builds and runs all tests, this one among them",
    "tools/docs": "it needs Sphinx",
    "tools/setup": "it installs",
    "sudo apt ": "it installs",
    "tools/make_figures": "it takes minutes",
    "git ": "it needs a network",
    "cmake ": "it builds, or installs",
    "npm ": "it needs a network",
    "tools/editors/": "it needs taplo",
    "mpirun ": "it takes as many processors",
    "srun ": "it needs a cluster",
    "xdg-open ": "it opens a window",
    "steplap explore ": "it serves a page until somebody ends it; tests/tools/pages/explore_test.py does",
}
NEEDS = {"steplap plot": "gnuplot"}
PYTHON = f"{sys.executable} - <<'END'\n"


def blocks(text):
    """Language and text of each fenced block, and the line at which it begins."""
    found, inside = [], None
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            if inside is None:
                inside = (line[3:].strip(), [], number)
            else:
                found.append((inside[0], "".join(inside[1]), inside[2]))
                inside = None
        elif inside is not None:
            inside[1].append(line + "\n")
    return found


def commands(text):
    """A backslash at the end of a line goes on in the next; a comment is no command."""
    joined = re.sub(r"\\\n", " ", text)
    return [line for line in joined.splitlines() if line.strip() and not line.startswith("#")]


def pattern(shown):
    lines = [re.escape(line.rstrip()) if line.strip() != "…" else "…" for line in shown.rstrip("\n").split("\n")]
    expression = "\n".join(lines) + "\n"
    expression = re.sub(r"(?m)^…\n", lambda _: r"(?:.*\n)*?", expression)
    return re.compile(expression.replace("…", ".*"))


def replaced(text, difference):
    """'-' lines become the '+' lines that follow them; each old line stands in the text once."""
    old = None
    for line in difference.splitlines():
        if line.startswith("-"):
            old = line[1:] + "\n"
        elif line.startswith("+"):
            assert old is not None and text.count(old) == 1, f"'{old}' does not stand once in the file"
            text = text.replace(old, line[1:] + "\n")
    return text


class Typist:
    def __init__(self, program, root, folder, updates):
        self.updates = updates  # of the present page: (line of the block, what the program says); None: none are wanted
        self.root, self.folder = root, folder
        shutil.copytree(root / "models", folder / "models")
        (folder / "tools").symlink_to(root / "tools")
        (folder / "docs").symlink_to(root / "docs")
        (folder / "build/release/bin").mkdir(parents=True)
        (folder / "build/release/bin/steplap").symlink_to(program)
        self.has_studies = (program.parent.parent / "libexec/steplap-study").exists()
        # What a terminal would add is left out; the width of the screen is that of a page.
        self.environment = {**os.environ, "PATH": f"{folder}/build/release/bin:{os.environ['PATH']}", "NO_COLOR": "1", "COLUMNS": "100"}
        self.written, self.typed = None, 0
        self.faults = []

    def reason_to_leave(self, command):
        for begin, reason in LEFT_OUT.items():
            if command.startswith(begin):
                return reason
        for begin, program in NEEDS.items():
            if command.startswith(begin) and not shutil.which(program):
                return f"there is no {program} here"
        if command.startswith(PYTHON) and not importlib.util.find_spec("pandas"):
            return "there is no pandas here"
        if command.startswith("steplap study") and not self.has_studies:
            return "the program for studies is not built"
        return None

    def last_command_of_run(self):
        script = (self.root / "tools/run").read_text()
        return script[script.rindex("\nexec ") + 6:].replace('"$@"', "").strip()

    def type_block(self, language, text, shown, place):
        said, is_complete, codes = "", True, []
        for command in commands(text) if language == "sh" else [f"{PYTHON}{text}END"]:
            reason = self.reason_to_leave(command)
            if command.startswith("tools/run"):
                command = self.last_command_of_run()
            elif reason:
                print(f"{place}: left out: {command}: {reason}")
                is_complete = False
                continue
            outcome = subprocess.run(command, shell=True, cwd=self.folder, env=self.environment, text=True,
                                     stdout=subprocess.PIPE, stderr=subprocess.STDOUT, executable="/bin/bash")
            said += outcome.stdout
            codes.append(outcome.returncode)
            self.typed += 1
            may_fail = shown is not None and re.search(r"(?<!Numerical )\berror: ", shown)
            if (outcome.returncode != 0) != bool(may_fail):
                self.faults.append(f"{place}: '{command}' ended with {outcome.returncode}:\n{outcome.stdout}")
        said = "".join(line.rstrip() + "\n" for line in said.splitlines())
        if shown is None or not is_complete or pattern(shown).fullmatch(said):
            return
        if self.updates is not None:
            self.updates.append((int(place.split(":")[1]) + text.count("\n") + 3, said))
        else:
            self.faults.append(f"{place}: the page shows\n{shown}but the program says\n{said}")

    def page(self, path):
        found = blocks(path.read_text())
        undone = None
        for i, (language, text, line) in enumerate(found):
            place = f"{path.name}:{line}"
            named = re.match(r"# (\S+\.(?:toml|csv))(, continued)?\n", text)
            if language in ("toml", "csv") and named:
                file = self.folder / named[1]
                before = file.read_text() if named[2] else ""
                file.write_text(before + (text if language == "toml" else text.split("\n", 1)[1]))
                self.written = file
            elif language == "diff":
                undone = self.written.read_text()
                self.written.write_text(replaced(undone, text))
            elif language in ("sh", "python"):
                following = found[i + 1] if i + 1 < len(found) else ("", "", 0)
                is_shown = following[0] == "text" and following[2] == line + text.count("\n") + 3
                self.type_block(language, text, following[1] if is_shown else None, place)
                if undone is not None:
                    self.written.write_text(undone)
                    undone = None


def update(path, updates):
    lines = path.read_text().splitlines(keepends=True)
    for line, said in reversed(updates):  # from the last on, so that the places of the others stay
        end = next(i for i in range(line, len(lines)) if lines[i].startswith("```"))
        lines[line:end] = [said]
    path.write_text("".join(lines))


def check_itself():
    assert pattern("a …\n…\nz\n").fullmatch("a 1 s\nb\nc\nz\n") and not pattern("a …\nz\n").fullmatch("a 1\nb\nz\n")
    assert pattern("…\nz\n").fullmatch("z\n")
    assert commands("a \\\n  b\n# c\nd\n") == ["a    b", "d"]
    assert replaced("x\ny\n", "-x\n+z\n") == "z\ny\n"


def main():
    check_itself()
    is_update = sys.argv[1:2] == ["--update"]
    if is_update:
        del sys.argv[1]
    program, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory(prefix="steplap_pages_") as folder:
        typist = Typist(program, root, pathlib.Path(folder), [] if is_update else None)
        for page in sys.argv[3:]:
            before = typist.typed
            typist.page(root / page)
            if is_update:
                update(root / page, typist.updates)
                typist.updates = []
            if typist.typed == before:
                typist.faults.append(f"{page}: nothing was typed")
        print("\n\n".join(typist.faults) or f"{typist.typed} commands do what the pages say")
        sys.exit(1 if typist.faults else 0)


if __name__ == "__main__":
    main()
