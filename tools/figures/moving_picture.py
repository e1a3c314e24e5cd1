#!/usr/bin/python3
"""Draws the motion of a transformer on its trailer as one animated SVG file, from the results of a run.

usage: moving_picture.py RESULT OUTPUT.svg

RESULT is the folder of a run of models/layouts/single_phase_two_limb.toml. Bodies have the positions of trajectory.csv, in true scale and relative
to the trailer. Wheels and dashes of the road are added and move with the trailer's travel. A limb is red while its step-lap joint slips. The file
contains no script, so that a page can show it as an image.
"""
import csv
import json
import math
import pathlib
import sys

SLOWER = 5          # duration of the animation divided by that of the run
PAUSE = 1.2         # time for which the last frame is shown, s
FRAMES = 60         # number of frames
SCALE = 58          # pixels per metre
WHEEL = 0.36        # radius of the wheels on twelve axle lines, m
ROAD = -1.3         # height of the road in the layouts, m
WIDTH, HEIGHT = 740, 372
MOVING = ["trailer", "tank", "active part", "rear limb", "front limb"]
COLOURS = {"trailer": "trailer", "tank": "tank", "active part": "core", "front limb": "limb", "rear limb": "limb"}


def read_run(folder):
    """Returns times, the poses (x, y, theta) of each body, and for each joint whether it slips."""
    with open(folder / "trajectory.csv") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    names = [name.split(" [")[0] for name in rows[0]]
    table = [[float(value) for value in row] for row in rows[1:]]
    column = lambda name: [row[names.index(name)] for row in table]
    poses = {body: list(zip(*(column(f"{body}.{what}") for what in ("x", "y", "theta")))) for body in MOVING}
    slips = {limb: [mode > 1.5 for mode in column(limb.replace("limb", "joint") + ".mode")] for limb in ("front limb", "rear limb")}
    return column("t"), poses, slips


def number(value):
    """Formats a number with two decimals, without trailing zeros."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def place(x, y):
    return f"{number(WIDTH / 2 + SCALE * x)},{number(260 - SCALE * y)}"


def polygon(points, style):
    return f'<polygon class="{style}" points="{" ".join(place(x, y) for x, y in points)}"/>'


def keyframes(name, shares, values):
    """Returns a CSS animation through `values` at `shares` of its duration; constant values are written once."""
    lines, last = [], None
    for i, (share, value) in enumerate(zip(shares, values)):
        is_kept = value == last and i + 1 < len(values) and values[i + 1] == value
        if not is_kept:
            lines.append(f"{number(100 * share)}%{{{value}}}")
        last = value
    return f"@keyframes {name}{{{''.join(lines)}100%{{{values[-1]}}}}}"


def move(pose, start, trailer, trailer_start):
    """Returns the SVG transform from a body's initial pose, in which its outline is drawn, to a later pose (y downwards)."""
    x = SCALE * (pose[0] - trailer[0] - start[0] + trailer_start[0])
    y = -SCALE * (pose[1] - start[1])
    return f"transform:translate({number(x)}px,{number(y)}px) rotate({number(math.degrees(start[2] - pose[2]))}deg)"


def standing(outline, pose):
    """Returns the corners of a body's outline in a pose."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return [(pose[0] + c * x - s * y, pose[1] + s * x + c * y) for x, y in outline]


STYLE = """
text{font:13px system-ui,sans-serif;fill:#24292f}.small{font-size:11px;fill:#57606a}
.tank{fill:#eaf1f8;stroke:#6b8299;stroke-width:3}.core{fill:#9aa7b4;stroke:#57606a}.limb{fill:#3b7dd8;stroke:#1f4e8c}
.trailer{fill:#d9b44a;stroke:#8a6d1d}.wheel{fill:#333a42;stroke:#111}.spoke{stroke:#c9d1d9;stroke-width:3}
.road{stroke:#8b949e;stroke-width:4}.dash{stroke:#fff;stroke-width:2}.time{stroke:#b6bec7;stroke-width:6;stroke-linecap:round}
.slipped{stroke:#d1242f;stroke-width:6;stroke-linecap:round}.now{fill:#24292f}
@media(prefers-color-scheme:dark){text{fill:#e6edf3}.small{fill:#9198a1}.now{fill:#e6edf3}.tank{fill:#1c2733}.dash{stroke:#0d1117}}
@media(prefers-reduced-motion:reduce){*{animation-play-state:paused!important;animation-delay:-4s!important}}
"""


def picture(folder):
    times, poses, slips = read_run(folder)
    bodies = {body["name"]: body for body in json.loads((folder / "drawing.json").read_text())["bodies"]}
    end = times[-1]
    duration = SLOWER * end + PAUSE
    chosen = sorted({round(i * (len(times) - 1) / FRAMES) for i in range(FRAMES + 1)})
    shares = [SLOWER * times[i] / duration for i in chosen]
    trailer = poses["trailer"]
    way = [pose[0] - trailer[0][0] for pose in trailer]
    style, shapes = [STYLE], []

    def animate(name, values, timing="linear"):
        style.append(keyframes(name, shares, values))
        style.append(f".{name}{{animation:{name} {number(duration)}s {timing} infinite;transform-box:view-box}}")

    # The road's dashes have period 1 m and the spokes a third of a turn, so both end as they began.
    dash = way[-1] / max(1, round(way[-1] / 0.5))
    turn = 120 * max(1, round(math.degrees(way[-1] / WHEEL) / 120)) / way[-1]
    animate("pass", [f"transform:translate({number(-SCALE * way[i])}px,0)" for i in chosen])
    animate("turn", [f"transform:rotate({number(turn * way[i])}deg)" for i in chosen])
    road = 260 - SCALE * ROAD
    shapes.append(f'<line class="road" x1="0" x2="{WIDTH}" y1="{number(road)}" y2="{number(road)}"/><g class="pass">')
    dashes = range(-1, math.ceil((WIDTH / SCALE + way[-1]) / dash) + 1)
    shapes.append("".join(f'<line class="dash" x1="{number(SCALE * dash * i)}" x2="{number(SCALE * dash * (i + 0.5))}" '
                          f'y1="{number(road)}" y2="{number(road)}"/>' for i in dashes) + "</g>")
    wheels = []
    for i in range(12):
        x, y = WIDTH / 2 + SCALE * (i - 5.5) * 0.88, road - SCALE * WHEEL - 2
        spokes = "".join(f'<line class="spoke" x2="{number(SCALE * WHEEL * 0.7 * math.cos(a))}" y2="{number(SCALE * WHEEL * 0.7 * math.sin(a))}"/>'
                         for a in (math.pi / 2 + k * 2 * math.pi / 3 for k in range(3)))
        wheels.append(f'<g transform="translate({number(x)},{number(y)})"><circle class="wheel" r="{number(SCALE * WHEEL)}"/><g class="turn">{spokes}</g></g>')
    for index, name in enumerate(MOVING):
        outline = standing(bodies[name]["outline"], bodies[name]["pose"])
        x, y = place(*bodies[name]["pose"][:2]).split(",")
        animate(f"b{index}", [move(poses[name][i], poses[name][0], trailer[i], trailer[0]) for i in chosen])
        style.append(f".b{index}{{transform-origin:{x}px {y}px}}")
        colour = ""
        if name in slips and any(slips[name]):
            values = ["fill:#d1242f" if any(slips[name][max(0, i - 1):i + 1]) else "fill:#3b7dd8" for i in chosen]
            style.append(keyframes(f"c{index}", shares, values))
            style.append(f".c{index}{{animation:c{index} {number(duration)}s step-end infinite}}")
            colour = f" c{index}"
        shapes.append(f'<g class="b{index}">{polygon(outline, COLOURS[name] + colour)}</g>')
        if name == "trailer":
            shapes += wheels
    shapes.append(clock(times, slips, shares, chosen, animate))
    slid = slide_text(times, poses, slips)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{slid}">'
            f"<title>{slid}</title><style>{''.join(style)}</style>{''.join(shapes)}</svg>\n")


def slide_text(times, poses, slips):
    """Returns a sentence that describes the picture."""
    first = next(t for t, is_slipping in zip(times, slips["front limb"]) if is_slipping)
    relative = [b[0] - a[0] for a, b in zip(poses["active part"], poses["front limb"])]
    moved = 1000 * (relative[-1] - relative[0])
    return f"The trailer brakes. The front limb slips out of its joints from {first:.2f} s on; at {times[-1]:g} s it has moved {moved:.0f} mm."


def clock(times, slips, shares, chosen, animate):
    """Draws the time axis below the road, red while something slips, with a dot that moves along it."""
    left, right, y = 60, WIDTH - 60, HEIGHT - 14
    at = lambda t: left + (right - left) * t / times[-1]
    slipping = [t for i, t in enumerate(times) if any(s[i] for s in slips.values())]
    animate("dot", [f"transform:translate({number(at(times[i]))}px,0)" for i in chosen])
    return (f'<line class="time" x1="{left}" x2="{right}" y1="{y}" y2="{y}"/>'
            f'<line class="slipped" x1="{number(at(slipping[0]))}" x2="{number(at(slipping[-1]))}" y1="{y}" y2="{y}"/>'
            f'<circle class="now dot" r="6" cy="{y}"/>'
            f'<text class="small" x="{left - 12}" y="{y + 4}" text-anchor="end">0 s</text>'
            f'<text class="small" x="{right + 12}" y="{y + 4}">{times[-1]:g} s</text>'
            f'<text x="14" y="20">Braked with 0.8 g, clamped with 18 kPa</text><text class="small" x="14" y="37">true scale, {SLOWER} times slower</text>')


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    pathlib.Path(sys.argv[2]).write_text(picture(pathlib.Path(sys.argv[1])))
