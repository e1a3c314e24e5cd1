# The documentation as a site: Sphinx reads the Markdown pages as they are. `tools/docs` builds it.
# The root of the project is the source folder, so that every relative link means the same here and on GitHub.
import os
import pathlib
import re

from sphinx.search.en import SearchEnglish

root = pathlib.Path(__file__).resolve().parent.parent

project = "steplap"
author = "the steplap authors"
copyright = "the steplap authors, MIT licence"
version = release = re.search(r"project\(steplap\s+VERSION\s+([0-9.]+)", (root / "CMakeLists.txt").read_text()).group(1)

extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
root_doc = "docs/index"
include_patterns = ["docs/**.md", "README.md", "CHANGELOG.md", "KNOWN_ISSUES.md", "CONTRIBUTING.md", "THIRD_PARTY.md", "tools/bench/peers/README.md"]
exclude_patterns = ["build", "out", ".git", "tests", "models", "mbd", "elements", "transformer", "tools/pages"]

myst_heading_anchors = 4  # anchors are those that GitHub makes
# A block of TOML in a page may be a piece of a file, and a page may begin a section with a heading of the third level.
suppress_warnings = ["myst.header"]

html_theme = "furo"
html_title = "steplap"
html_theme_options = {"footer_icons": []}
html_show_sphinx = False
html_show_sourcelink = False
html_copy_source = False
html_extra_path = ["site/index.html"]  # leads from the top of the site to docs/index.html
pygments_style = "tango"
pygments_dark_style = "monokai"
# The search requires every word of a question on the page. Without question words a whole sentence finds pages by its nouns and verbs.
SearchEnglish.stopwords = SearchEnglish.stopwords | {"can", "do", "does", "how", "i", "my", "what", "which", "why"}
smartquotes = False  # a curly quote that is copied from a page is an error in TOML

# The complete reference of elements and of the command line, made by tools/site/reference_pages, replaces the short pages of the same name.
complete = pathlib.Path(os.environ.get("STEPLAP_REFERENCE", root / "build/reference"))
made_pages = [name for name in ("models", "command_line") if (complete / f"{name}.md").exists()]


def read_complete_page(app, name, source):
    folder, _, page = name.rpartition("/")
    if folder == "docs/reference" and page in made_pages:
        pictures = os.path.relpath(complete / "pictures", root / "docs/reference")
        source[0] = (complete / f"{page}.md").read_text().replace("](pictures/", f"]({pictures}/")


def setup(app):
    app.connect("source-read", read_complete_page)
    app.connect("env-get-outdated", lambda *_: {f"docs/reference/{page}" for page in made_pages})
