"""Completions and man pages hold every command and every option, and shells and man accept them.

usage: shell_files_test.py PROGRAM tools/site/shell_files

What is asked of zsh, fish and mandoc is left out where they are not installed, which is said.
"""
import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

problems = []


def check(is_true, what):
    if not is_true:
        problems.append(what)


def tables(program):
    found = []
    for words in ([], ["study"]):
        run = subprocess.run([program, *words, "help", "--json"], capture_output=True, text=True)
        if run.returncode == 0:
            found.append(json.loads(run.stdout))
    return found


def page(folder, name):
    return gzip.decompress((folder / f"man/man1/{name}.1.gz").read_bytes()).decode()


def check_contents(program, folder):
    bash = (folder / "bash-completion/completions/steplap").read_text()
    zsh = (folder / "zsh/site-functions/_steplap").read_text()
    fish = (folder / "fish/vendor_completions.d/steplap.fish").read_text()
    count = 0
    for table in tables(program):
        is_study = table["program"] != "steplap"
        for command in table["commands"]:
            name = command["name"]
            check(f"{name}:" in zsh and re.search(rf"-a {name}\b", fish), f"{name} is missing in zsh or fish")
            line = re.search(rf'^    "{"study " if is_study else ""}{name}"\) .*$', bash, re.M)
            check(line, f"{name} is missing in bash")
            text = page(folder, "steplap-study" if is_study else f"steplap-{name}").replace("\\-", "-")
            check(command["summary"][5:25] in text, f"the page of {name} does not say what it does")
            condition = rf"__fish_seen_subcommand_from study; and __fish_seen_subcommand_from {name}'" if is_study else rf"__fish_seen_subcommand_from {name}[;']"
            options = "\n".join(row for row in fish.splitlines() if re.search(condition, row))
            for option in command["options"]:
                if option["is_positional"]:
                    continue
                for spelled in option["names"]:
                    count += 1
                    check(line and f"{spelled}" in line[0].split("'")[1].split(), f"{name} {spelled} is missing in bash")
                    check(f"{spelled}[" in zsh, f"{name} {spelled} is missing in zsh")
                    check((f"-l {spelled[2:]} " if spelled.startswith("--") else f"-s {spelled[1:]} ") in options, f"{name} {spelled} is missing in fish")
                    check(f"\\fB{spelled}\\fR" in text, f"{name} {spelled} is missing in its page")
                check(option["meaning"][:20].replace("\\", "\\e") in text, f"{name} {option['names']}: its meaning is missing in the page")
    check(count > 150, f"only {count} options were found")


def bash_offers(folder, *words):
    """What bash offers for the last of the words."""
    script = f'source "{folder}/bash-completion/completions/steplap"; compopt() {{ :; }}; COMP_WORDS=({" ".join(repr(w) for w in words)}); COMP_CWORD={len(words) - 1}; _steplap; printf "%s\\n" "${{COMPREPLY[@]}}"'
    return subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True).stdout.split()


def check_bash(folder):
    file = str(folder / "bash-completion/completions/steplap")
    check(subprocess.run(["bash", "-n", file]).returncode == 0, "bash does not accept its completions")
    said = subprocess.run(["bash", "-c", f'source "{file}" && complete -p steplap'], capture_output=True, text=True).stdout
    check("-F _steplap steplap" in said, "bash has not registered its completions")
    check(bash_offers(folder, "steplap", "sim") == ["simulate"], "bash: sim")
    check(bash_offers(folder, "steplap", "check", "--cr") == ["--cross"], "bash: check --cr")
    check(bash_offers(folder, "steplap", "check", "-q", "a.toml", "--us") == ["--uses"], "bash: an option behind a file")
    check("check" in bash_offers(folder, "steplap", "help", ""), "bash: help")
    check(bash_offers(folder, "steplap", "simulate", "--end", "--e") == [], "bash: the value of an option is no option")
    check(bash_offers(folder, "steplap", "new", "transformer", "--window-h") == ["--window-height"], "bash: new")
    if "study show" in (folder / "bash-completion/completions/steplap").read_text():
        check("export" in bash_offers(folder, "steplap", "study", "ex"), "bash: study")
        check("--findings" in bash_offers(folder, "steplap", "study", "export", "a.toml", "--"), "bash: study export")


def check_zsh(folder):
    file = folder / "zsh/site-functions/_steplap"
    check(subprocess.run(["zsh", "-n", str(file)]).returncode == 0, "zsh does not accept its completions")
    # Loaded as a completion, in a folder of its own: the function is defined and every _arguments line is one that zsh can read.
    script = f'fpath=("{file.parent}" $fpath); autoload -Uz compinit; compinit -D -u; print $_comps[steplap]'
    said = subprocess.run(["zsh", "-f", "-c", script], capture_output=True, text=True)
    check(said.stdout.strip() == "_steplap" and not said.stderr, f"zsh has not registered its completions: {said.stderr}")


def check_fish(folder, home):
    file = folder / "fish/vendor_completions.d/steplap.fish"
    environment = {**os.environ, "HOME": str(home), "XDG_CONFIG_HOME": str(home), "XDG_DATA_HOME": str(home)}
    check(subprocess.run(["fish", "-n", str(file)], env=environment).returncode == 0, "fish does not accept its completions")

    def offers(line):
        run = subprocess.run(["fish", "--no-config", "-c", f"source {file}; complete -C '{line}'"], capture_output=True, text=True, env=environment)
        check(not run.stderr, f"fish: {run.stderr}")
        return [row.split("\t")[0] for row in run.stdout.splitlines()]

    check("simulate" in offers("steplap sim"), "fish: sim")
    check("--cross" in offers("steplap check --cr"), "fish: check --cr")
    check("--cross" not in offers("steplap simulate --cr"), "fish: an option of another command")


def check_pages(folder):
    for file in sorted((folder / "man/man1").iterdir()):
        if shutil.which("man"):
            run = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", str(file)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env={**os.environ, "MANROFFSEQ": "", "MANWIDTH": "80", "LC_ALL": "C.UTF-8"})
            check(run.returncode == 0 and not run.stderr, f"man, {file.name}: {run.stderr[:300]}")
        if shutil.which("mandoc"):
            plain = file.with_suffix("")
            plain.write_bytes(gzip.decompress(file.read_bytes()))
            run = subprocess.run(["mandoc", "-Tlint", "-Wwarning", str(plain)], capture_output=True, text=True)
            # The version is no date, and the pages have none: they are the same for every build.
            said = [line for line in run.stdout.splitlines() if "missing date" not in line]
            check(not said, f"mandoc, {file.name}: {said[:3]}")
            plain.unlink()


def main(program, tool):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "shell"
        subprocess.run([tool, program, str(folder)], check=True)
        check_contents(program, folder)
        check_bash(folder)
        check_pages(folder)
        for shell, ask in (("zsh", lambda: check_zsh(folder)), ("fish", lambda: check_fish(folder, pathlib.Path(name)))):
            if shutil.which(shell):
                ask()
            else:
                print(f"{shell} is not installed: not asked")
        again = pathlib.Path(name) / "again"
        subprocess.run([tool, program, str(again)], check=True)
        for file in folder.rglob("*"):
            if file.is_file():
                check(file.read_bytes() == (again / file.relative_to(folder)).read_bytes(), f"{file.name} is another one the second time")
    if problems:
        sys.exit("\n".join(problems))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
