#!/usr/bin/python3
"""The documentation builds as a site without a warning, and the site needs no network: neither its pages nor its search.

usage: site.py PROGRAM ROOT FOLDER

The reference in the site is the complete one, made by tools/site/reference_pages.
"""
import json
import os
import pathlib
import re
import subprocess
import sys

import snowballstemmer

stem = snowballstemmer.stemmer("porter").stemWord  # the stemmer of the site's search

# Questions as they are typed, each with the page that answers it among the first two that the search shows.
QUESTIONS = {
    "how do I model a strap that only pulls": "cookbook/strap",
    "what does OPEN mean": "reference/verdicts",
    "which units": "reference/model_files",
    "why is my box sinking": "common_mistakes",
    "how sure is the number": "explanation/trust",
    "wheel over a bump": "cookbook/bump",
    "hinge, pin": "reference/models",
}
SHOWN = 2


def as_list(pages):
    return pages if isinstance(pages, list) else [pages]


def answers(search, stopwords, question):
    """Returns the pages in the order of the site's search: every word must be on the page, and words in headings count more."""
    words = [stem(word) for word in re.findall(r"\w+", question.lower()) if word not in stopwords]
    pages = {kind: [{*as_list(search[kind].get(word, []))} for word in words] for kind in ("terms", "titleterms")}
    found = set.intersection(*(text | heading for text, heading in zip(pages["terms"], pages["titleterms"])))
    headed = set.union(*pages["titleterms"])
    return [search["docnames"][n] for n in sorted(found, key=lambda n: (n not in headed, search["titles"][n].lower()))]


def build(program, root, folder):
    subprocess.run([sys.executable, str(root / "tools/site/reference_pages"), program, str(folder / "reference")], check=True)
    command = [sys.executable, "-m", "sphinx", "-b", "html", "-c", "docs", "-d", str(folder / "doctrees"), "-W", "--keep-going", "-q", "-E", ".", str(folder / "html")]
    outcome = subprocess.run(command, cwd=root, capture_output=True, text=True,
                             env={**os.environ, "STEPLAP_REFERENCE": str(folder / "reference")})
    return outcome.stdout + outcome.stderr if outcome.returncode else ""


def loaded_from_elsewhere(text):
    """What a browser would fetch: scripts, styles, images, fonts; not links that somebody may follow."""
    found = re.findall(r"<(?:script|img|iframe|source)\b[^>]*?src=\"((?:https?:)?//[^\"]+)", text)
    found += re.findall(r"<link\b(?=[^>]*rel=\"(?:stylesheet|preload|icon|shortcut icon)\")[^>]*?href=\"((?:https?:)?//[^\"]+)", text)
    return found + re.findall(r"url\([\"']?((?:https?:)?//[^)\"']+)", text)


def faults(folder):
    html = folder / "html"
    for path in html.rglob("*"):
        if path.suffix in (".html", ".css"):
            yield from (f"{path.relative_to(html)} loads {what}" for what in loaded_from_elsewhere(path.read_text()))
    index = (html / "searchindex.js").read_text()
    search = json.loads(index[index.index("(") + 1:index.rindex(")")])
    stopwords = json.loads(re.search(r"stopwords = (\[.*?\])", (html / "_static/language_data.js").read_text(), flags=re.S)[1])
    for question, page in QUESTIONS.items():
        shown = answers(search, stopwords, question)[:SHOWN]
        if f"docs/{page}" not in shown:
            yield f"the search for '{question}' shows {shown} before docs/{page}"
    for page, part in (("models", "unilateral_contact"), ("command_line", "--require-hold")):
        if part not in (html / f"docs/reference/{page}.html").read_text():
            yield f"docs/reference/{page} in the site is not the complete one: '{part}' is missing"
    if "“" in (html / "docs/reference/model_files.html").read_text():
        yield "quotes are made curly: copied, they are errors in TOML"
    target = re.search(r"url=([^\"]+)", (html / "index.html").read_text())[1]
    if not (html / target).exists():
        yield f"index.html leads to {target}, which is not there"


def main():
    assert loaded_from_elsewhere('<script src="https://a/b.js"></script><a href="https://c">') == ["https://a/b.js"]
    root, folder = pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve()
    said = build(sys.argv[1], root, folder)
    found = [said] if said else list(faults(folder))
    print("\n".join(found) or "the site is whole and needs no network")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
