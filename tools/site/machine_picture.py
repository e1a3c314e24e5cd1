"""Draws a machine as SVG from the drawing.json of a run, for the cookbook and the reference of elements."""
import json
import math
import pathlib
import re
import subprocess
import tempfile
import tomllib

WIDTH, HEIGHT, MARGIN = 300, 150, 22
INK, BODY, LINE, LOAD = "#222", "#dbe7f3", "#1f6fb2", "#c0392b"


def drawing_of(program, model):
    """Returns the contents of drawing.json for a model file, with the initial poses of its run."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "simulate", model, "-q", "--no-estimate", "--end", "2e-3", "--output-step", "1e-3", "-o", folder], capture_output=True)
        results = pathlib.Path(folder) / model.stem
        drawing = json.loads((results / "drawing.json").read_text())
        lines = (results / "trajectory.csv").read_text().splitlines()
        row = dict(zip(lines[0].split(","), next(line for line in lines[1:] if not line.startswith("#")).split(",")))
    for body in drawing["bodies"]:
        if f"{body['name']}.x [m]" in row:
            body["pose"] = [float(row[f"{body['name']}.{part}"]) for part in ("x [m]", "y [m]", "theta [rad]")]
    drawing["loads"] = loads_of(tomllib.loads(model.read_text()))
    return drawing


def sign_of(value):
    """Returns the sign (-1, 0 or 1) of a number, which may have a unit."""
    number = float(re.match(r"[-+.\d]+(?:e[-+]?\d+)?", str(value).strip())[0])
    return (number > 0) - (number < 0)


def loads_of(model):
    """Returns the direction of each load by its name; None for a couple."""
    peaks = {signal["name"]: signal.get("peak", 1) for signal in model.get("signal", [])}
    found = {}
    for element in model["element"]:
        if element["kind"] == "load":
            if "force" in element:
                found[element["name"]] = [sign_of(part) for part in element["force"]]
            for axis, direction in (("force_x", (1, 0)), ("force_y", (0, 1))):
                if axis in element:
                    found[element["name"]] = [part * sign_of(peaks[element[axis]]) for part in direction]
        elif element["kind"] == "force":
            found[element["name"]] = [1, 0]
    return found


class Picture:
    def __init__(self, drawing):
        self.drawing = drawing
        self.poses = {body["name"]: body["pose"] for body in drawing["bodies"]} | {"ground": [0.0, 0.0, 0.0]}
        points = [self.place(body["name"], corner) for body in drawing["bodies"] for corner in body["outline"] if body["is_outline_given"]]
        points += [self.place(at["body"], at["point"]) for element in drawing["elements"] for shape in element["shapes"] for at in shape["at"]
                   if at["body"] != "ground" or shape["type"] in ("spring", "rope", "rod")]
        points += [(x + sign * size, y + sign * size) for x, y, size in self.circles() for sign in (-1, 1)]
        xs, ys = [x for x, _ in points], [y for _, y in points]
        self.scale = min((WIDTH - 2 * MARGIN) / max(max(xs) - min(xs), 1e-9), (HEIGHT - 2 * MARGIN) / max(max(ys) - min(ys), 1e-9))
        self.middle = ((max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2)
        self.lines = []

    def place(self, body, point):
        x, y, angle = self.poses[body]
        return x + math.cos(angle) * point[0] - math.sin(angle) * point[1], y + math.sin(angle) * point[0] + math.cos(angle) * point[1]

    def pixel(self, place):
        return (round(WIDTH / 2 + self.scale * (place[0] - self.middle[0]), 1), round(HEIGHT / 2 - self.scale * (place[1] - self.middle[1]), 1))

    def circles(self):
        """Returns centre and radius of wheels, drums and pitch circles."""
        found = [(body["name"], circle[:2], circle[2]) for body in self.bodies() for circle in body["circles"]]
        found += [(at["body"], at["point"], radius) for element in self.drawing["elements"] for shape in element["shapes"] if shape["type"] == "touch"
                  for at, radius in zip(shape["at"], shape["sizes"])]
        return sorted({(*self.place(body, centre), radius) for body, centre, radius in found})

    def bodies(self):
        return [*self.drawing["bodies"], {"name": "ground", **self.drawing["ground"]}]

    def straight_part(self, shape):
        """Returns the ends of a rope between two wheels. A radius is positive if counter-clockwise rotation winds the rope up; 0: a point."""
        (ax, ay), (bx, by) = (self.place(at["body"], at["point"]) for at in shape["at"])
        radius_a, radius_b = shape["sizes"]
        length = math.hypot(bx - ax, by - ay) or 1
        ux, uy, along = (bx - ax) / length, (by - ay) / length, (radius_a + radius_b) / length
        across = math.sqrt(max(0.0, 1 - along * along))
        nx, ny = along * ux - across * uy, along * uy + across * ux
        return self.pixel((ax + radius_a * nx, ay + radius_a * ny)), self.pixel((bx - radius_b * nx, by - radius_b * ny))

    def line(self, a, b, extra=f'stroke="{LINE}" stroke-width="2"'):
        self.lines.append(f'<path d="M{a[0]} {a[1]}L{b[0]} {b[1]}" {extra}/>')

    def spring(self, a, b):
        length = math.hypot(b[0] - a[0], b[1] - a[1]) or 1
        along, across = ((b[0] - a[0]) / length, (b[1] - a[1]) / length), (-(b[1] - a[1]) / length, (b[0] - a[0]) / length)
        places = [a] + [(a[0] + along[0] * length * t + across[0] * 4 * side, a[1] + along[1] * length * t + across[1] * 4 * side)
                        for t, side in zip([0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8], [0, 1, -1, 1, -1, 1, 0])] + [b]
        self.lines.append('<path d="M' + "L".join(f"{x:.1f} {y:.1f}" for x, y in places) + f'" fill="none" stroke="{LINE}" stroke-width="1.5"/>')

    def shape(self, element, shape):
        pixels = [self.pixel(self.place(at["body"], at["point"])) for at in shape["at"]]
        kind = shape["type"]
        if kind == "rope" and shape.get("sizes"):
            self.line(*self.straight_part(shape))
        elif kind in ("rope", "rod"):
            for a, b in zip(pixels, pixels[1:]):
                self.line(a, b)
        elif kind == "spring" and len(pixels) == 2:
            self.spring(*pixels)
        elif kind == "bushing":
            self.lines.append(f'<rect x="{pixels[0][0] - 8}" y="{pixels[0][1]}" width="16" height="8" fill="{LINE}"/>')
        elif kind in ("contact", "faces"):
            x, y = pixels[0]
            if kind == "contact":
                self.lines.append(f'<path d="M{x} {y}l-5 8h10z" fill="{LINE}"/>')
            elif element["shapes"][0]["at"][1]["body"] == "ground":
                low = max(self.pixel(self.place(shape["at"][0]["body"], corner))[1] for corner in self.outline(shape["at"][0]["body"]))
                self.lines.append(f'<path d="M8 {low}H{WIDTH - 8}" stroke="{INK}" stroke-width="1.5"/>')
        elif kind == "pin":
            self.lines.append(f'<circle cx="{pixels[0][0]}" cy="{pixels[0][1]}" r="4" fill="#fff" stroke="{INK}" stroke-width="1.5"/>')
        elif kind == "weld":
            self.lines.append(f'<path d="M{pixels[0][0]} {pixels[0][1] - 14}v28" stroke="{INK}" stroke-width="4"/>')
        elif kind == "rail":
            x, y = shape["direction"]
            self.line((pixels[0][0] - 40 * x, pixels[0][1] + 40 * y), (pixels[0][0] + 40 * x, pixels[0][1] - 40 * y),
                      'stroke="#888" stroke-dasharray="6 3"')
        elif kind == "arc":
            x, y = pixels[0]
            self.lines.append(f'<path d="M{x + 16} {y}A16 16 0 1 0 {x} {y + 16}" fill="none" stroke="{LOAD}" stroke-width="2" marker-end="url(#a)"/>')
        elif kind == "edge_touch" and shape.get("style") == "flat":
            self.lines.append(f'<path d="M8 {pixels[1][1]}H{WIDTH - 8}" stroke="{INK}" stroke-width="1.5"/>')
        elif kind == "arrow" and self.direction_of(element, shape):
            x, y = self.direction_of(element, shape)
            a, b = pixels[0], (round(pixels[0][0] + 30 * x, 1), round(pixels[0][1] - 30 * y, 1))
            self.line(a, b, f'stroke="{LOAD}" stroke-width="2" marker-end="url(#a)"')

    def direction_of(self, element, shape):
        return self.drawing["loads"].get(element["name"]) or shape.get("direction")

    def sheet(self, body, corners, style):
        pixels = "L".join(f"{x} {y}" for x, y in (self.pixel(self.place(body, corner)) for corner in corners))
        self.lines.append(f'<path d="M{pixels}z" {style}/>')

    def outline(self, name):
        return next((body["outline"] for body in self.drawing["bodies"] if body["name"] == name), [])

    def text(self):
        for body in self.drawing["bodies"]:
            corners = [self.pixel(self.place(body["name"], corner)) for corner in body["outline"]] if body["is_outline_given"] else []
            if corners:
                self.lines.append(f'<path d="M{"L".join(f"{x} {y}" for x, y in corners)}z" fill="{BODY}" stroke="{INK}"/>')
        for x, y, radius in self.circles():
            self.lines.append(f'<circle cx="{self.pixel((x, y))[0]}" cy="{self.pixel((x, y))[1]}" r="{radius * self.scale:.1f}" fill="{BODY}" stroke="{INK}"/>')
        for body in self.bodies():
            for x1, y1, x2, y2, thickness in body["segments"]:
                ends = [self.pixel(self.place(body["name"], end)) for end in ([x1, y1], [x2, y2])]
                self.line(*ends, f'stroke="{INK}" stroke-width="{max(1.5, round(thickness * self.scale, 1))}" stroke-linecap="round"')
        for sheets in self.drawing["sheets"]:
            self.sheet(sheets["active_part"], sheets["yoke"], f'fill="#888" fill-opacity="0.3" stroke="{INK}"')
            self.sheet(sheets["limb"], sheets["limb_sheet"], f'fill="{LINE}" fill-opacity="0.3" stroke="{LINE}"')
        for element in self.drawing["elements"]:
            for shape in element["shapes"]:
                self.shape(element, shape)
        if len(self.drawing["bodies"]) <= 4:
            for body in self.drawing["bodies"]:
                x, y = self.pixel(self.place(body["name"], [0.0, 0.0]))
                self.lines.append(f'<text x="{x}" y="{y - 6}" text-anchor="middle" stroke="#fff" stroke-width="3" paint-order="stroke">{body["name"]}</text>')
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
                f'font-size="11" fill="{INK}">\n<defs><marker id="a" markerWidth="8" markerHeight="8" refX="7" refY="4" orient="auto">'
                f'<path d="M0 1 7 4 0 7z" fill="{LOAD}"/></marker></defs>\n<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>')
        return "\n".join([head, *self.lines, "</svg>"]) + "\n"


def picture_of(program, model):
    return Picture(drawing_of(program, model)).text()
