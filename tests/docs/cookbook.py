#!/usr/bin/python3
"""Each recipe of the cookbook shows what its model says, has a drawing and a place in the list; drawings are those of the present models.

usage: cookbook.py PROGRAM ROOT
The commands of the pages are typed by typed_pages.py.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

LONGEST = 26  # lines of a recipe's model that are shown


def tables(text):
    return [re.sub(r"\s+#.*", "", table).split() for table in re.split(r"(?m)^(?=\[[\[a-z])", text)]


def faults_of(page, root, listed):
    text = page.read_text()
    shown = re.search(r"```toml\n(.*?)```", text, flags=re.S)
    command = re.search(r"^steplap simulate (\S+\.toml)", text, flags=re.M)
    if not shown or not command:
        yield "it shows no model, or runs none"
        return
    model = tables((root / command[1]).read_text())
    for table in tables(shown[1]):
        if table and table not in model:
            yield f"'{' '.join(table)[:60]} …' is not in {command[1]}"
    if shown[1].count("\n") > LONGEST:
        yield f"it shows more than {LONGEST} lines"
    for part in (f"]({page.stem}.svg)", "**Check by hand.**", "**What usually goes wrong.**"):
        if part not in text:
            yield f"it lacks {part}"
    if f"]({page.name})" not in listed:
        yield "docs/cookbook/index.md does not list it"


def main():
    program, root = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    folder = root / "docs/cookbook"
    listed = (folder / "index.md").read_text()
    pages = [page for page in sorted(folder.glob("*.md")) if page.stem != "index"]
    assert len(pages) >= 25, len(pages)
    faults = [f"{page.name}: {fault}" for page in pages for fault in faults_of(page, root, listed)]
    with tempfile.TemporaryDirectory(prefix="steplap_cookbook_") as made:
        subprocess.run([sys.executable, str(root / "tools/site/cookbook_pictures"), program, made], check=True)
        for picture in pathlib.Path(made).glob("*.svg"):
            kept = folder / picture.name
            if not kept.exists() or kept.read_text() != picture.read_text():
                faults.append(f"{picture.name} is not what the model gives now: tools/site/cookbook_pictures {program}")
    print("\n".join(faults) or f"{len(pages)} recipes show what their models say")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    assert tables('[[a]]\nb = 1 # c\n\n[[d]]\n') == [[], ["[[a]]", "b", "=", "1"], ["[[d]]"]]
    main()
