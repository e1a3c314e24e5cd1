#!/usr/bin/python3
"""Every relative link of every Markdown page leads to a file that exists, and every anchor to a heading of that page.

usage: links.py ROOT
Anchors are made from headings as GitHub makes them: small letters, no punctuation, hyphens for spaces, -1 for a second one.
"""
import pathlib
import re
import sys
import urllib.parse

LEFT_OUT = {"build", "out", ".git", "node_modules"}


def without_code(text):
    """Fenced blocks and code spans may hold what looks like a link."""
    text = re.sub(r"^(```+|~~~+).*?^\1\s*$", "", text, flags=re.M | re.S)
    return re.sub(r"(`+)(?:(?!\1).)+?\1", "code", text)


def anchor(heading):
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    text = re.sub(r"[^\w\- ]", "", text.strip().lower())
    return text.replace(" ", "-")


def anchors(path):
    text = re.sub(r"^(```+|~~~+).*?^\1\s*$", "", path.read_text(), flags=re.M | re.S)
    found, times = set(re.findall(r'<a (?:id|name)="([^"]+)"', text)), {}
    for heading in re.findall(r"^#{1,6} +(.+?) *#*$", text, flags=re.M):
        name = anchor(heading)
        found.add(name if name not in times else f"{name}-{times[name]}")
        times[name] = times.get(name, 0) + 1
    return found


def links(text):
    text = without_code(text)
    yield from re.findall(r"\]\(<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\)", text)
    yield from re.findall(r"^\[[^\]]+\]:\s+(\S+)", text, flags=re.M)
    yield from re.findall(r"<(?:img|a|source)\b[^>]*?(?:src|href|srcset)=\"([^\"]+)\"", text)


def broken(root):
    for page in sorted(root.rglob("*.md")):
        if LEFT_OUT & set(page.relative_to(root).parts):
            continue
        for link in links(page.read_text()):
            if re.match(r"[a-z][a-z+.-]*:", link):
                continue
            path, _, place = urllib.parse.unquote(link).partition("#")
            target = (page.parent / path).resolve() if path else page
            if not target.exists():
                yield f"{page.relative_to(root)}: '{link}': there is no such file"
            elif place and (target.suffix != ".md" or place not in anchors(target)):
                yield f"{page.relative_to(root)}: '{link}': there is no such heading"


def check_itself():
    """A test that finds nothing has to be able to find something."""
    assert anchor("The paper's `[[core]]`: *what* it is") == "the-papers-core-what-it-is"
    assert list(links("a [b](c.md#d) `[e](f.md)` ![g](h.png)\n```\n[i](j.md)\n```\n")) == ["c.md#d", "h.png"]


if __name__ == "__main__":
    check_itself()
    found = list(broken(pathlib.Path(sys.argv[1]).resolve()))
    print("\n".join(found) or "every link leads somewhere")
    sys.exit(1 if found else 0)
