#!/usr/bin/python3
"""The moving picture of README is what a run gives now, and what GitHub shows: an SVG that moves by itself, without a script.

usage: moving_picture.py PROGRAM ROOT
If it is not: tools/make_figures
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

NEAR = 0.5  # pixels: half of what a screen shows


def numbers(text):
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", text)]


def words(text):
    return re.sub(r"-?\d+(?:\.\d+)?", "#", text)


def main():
    program, root = sys.argv[1], pathlib.Path(sys.argv[2])
    kept = (root / "docs/figures/transformer.svg").read_text()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "simulate", root / "models/layouts/single_phase_two_limb.toml", "-q", "-o", folder, "--no-estimate",
                        "--set", "core.core.pressure=18 kPa"], check=True, capture_output=True)
        made = pathlib.Path(folder) / "made.svg"
        subprocess.run([sys.executable, root / "tools/figures/moving_picture.py", f"{folder}/single_phase_two_limb", made], check=True)
        text = made.read_text()
    tags = {element.tag.split("}")[1] for element in xml.etree.ElementTree.fromstring(kept).iter()}
    assert "script" not in tags and "image" not in tags and "http" not in kept.replace("http://www.w3.org/2000/svg", ""), tags
    assert kept.count("@keyframes") >= 6 and "prefers-color-scheme:dark" in kept and "prefers-reduced-motion" in kept
    assert len(kept) < 60_000, f"{len(kept)} bytes are too many for an image at the top of a page"
    assert words(kept) == words(text), "the picture has other parts than a run gives now: tools/make_figures"
    far = max(abs(a - b) for a, b in zip(numbers(kept), numbers(text)))
    assert far <= NEAR, f"the picture is {far} pixels off what a run gives now: tools/make_figures"
    print(f"the picture is within {far} pixels of what a run gives now")


if __name__ == "__main__":
    main()
