#!/usr/bin/python3
"""The complete reference of elements and commands is made, its links hold, and the short pages name every kind, event and command.

usage: reference_pages.py PROGRAM ROOT
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import links


def named(text):
    return set(re.findall(r"`([^`\n]+)`", re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)))


def missing(short, complete_names, what):
    absent = [name for name in complete_names if name not in named(short)]
    return [f"docs/reference/{what} does not name {', '.join(absent)}"] if absent else []


def unknown(short, pattern, complete_names, what):
    """Names in the first column of tables that are none of the program's."""
    first = {name for row in re.findall(r"^(?:\| *)?(`.*?) \|", short, flags=re.M) for name in named(row)}
    strange = sorted(name for name in first if re.fullmatch(pattern, name) and name not in complete_names)
    return [f"docs/reference/{what} names what there is not: {', '.join(strange)}"] if strange else []


def broken_links(folder, root):
    for page in sorted(folder.glob("*.md")):
        for link in links.links(page.read_text()):
            path, _, place = link.partition("#")
            target = page if not path else folder / path if (folder / path).exists() else (root / "docs/reference" / path).resolve()
            if re.match(r"[a-z][a-z+.-]*:", link):
                continue
            if not target.exists() or (place and place not in links.anchors(target)):
                yield f"{page.name}: '{link}' leads nowhere"


def main():
    program, root = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory(prefix="steplap_reference_") as folder:
        folder = pathlib.Path(folder)
        subprocess.run([sys.executable, str(root / "tools/site/reference_pages"), program, str(folder)], check=True)
        models, commands = (folder / "models.md").read_text(), (folder / "command_line.md").read_text()
        faults = list(broken_links(folder, root))
        # Anchors into the short pages hold in the complete ones, which replace them.
        for name in ("models.md", "command_line.md"):
            lost = links.anchors(root / "docs/reference" / name) & used_anchors(root, name) - links.anchors(folder / name)
            faults += [f"{name}: the complete page has no heading '{place}'" for place in sorted(lost)]
    table = json.loads(subprocess.run([program, "elements", "--json"], check=True, capture_output=True, text=True).stdout)
    kinds = [row["kind"] for row in table["results"][0]["tables"]["kinds"]]
    events = re.findall(r"^\| ([^|]+) \| [^|]+ \|$", models[models.index("## Events"):], flags=re.M)
    events = [event for event in events if event not in ("event", "---")]
    assert len(kinds) > 50 and len(events) > 15
    drawn = re.findall(r"^## \[\[element\]\].*\n.*\n\n!\[.*\]\(pictures/(\w+)\.svg\)", models, flags=re.M)
    elements = [row["kind"] for row in table["results"][0]["tables"]["kinds"] if row["role"] == "element"]
    faults += [f"models.md has no picture of {kind}" for kind in elements if kind not in drawn]
    faults += [f"models.md has no example of {kind}" for kind in elements if f"\nkind = '{kind}'\n" not in models]
    short = (root / "docs/reference/models.md").read_text()
    faults += missing(short, kinds + events, "models.md") + unknown(short, r"[a-z_]+", kinds + events, "models.md")
    top = commands[:commands.index("## steplap ")]
    names = re.findall(r"^\| \[`(\w+)`\]", top, flags=re.M)
    codes = re.findall(r"^\| ([\d, ]+) \|", top, flags=re.M)
    assert len(names) > 15 and len(codes) > 6
    short = (root / "docs/reference/command_line.md").read_text()
    faults += missing(short, names, "command_line.md") + unknown(short, r"[a-z_]+", names, "command_line.md")
    faults += [f"docs/reference/command_line.md lacks the exit code {code}" for code in codes if f"| {code} |" not in short]
    print("\n".join(faults) or "the complete reference is made, and the short pages name all of it")
    sys.exit(1 if faults else 0)


def used_anchors(root, name):
    """Anchors by which other pages link to a page of the reference."""
    found = set()
    for page in root.rglob("docs/**/*.md"):
        for link in links.links(page.read_text()):
            path, _, place = link.partition("#")
            if place and pathlib.Path(path).name == name:
                found.add(place)
    return found


if __name__ == "__main__":
    assert named("a `b` c `d`") == {"b", "d"} and missing("`a`", ["a", "b"], "x") and not missing("`a`", ["a"], "x")
    assert unknown("| `a`, `c` | b |\n", "[a-z]+", ["a"], "x") and not unknown("| `a` | `c` |\n", "[a-z]+", ["a"], "x")
    assert unknown("`a`, `c` | b\n", "[a-z]+", ["a"], "x") and not unknown("`a` | `c`\n", "[a-z]+", ["a"], "x")
    main()
