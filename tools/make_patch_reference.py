#!/usr/bin/env python3
"""Computes reference values of the friction limit surface to 50 digits.

Writes a table of polygons (with holes), tractions and twists with the exact dissipation h and its gradient (f_x, f_y, m), for
tests/elements/step_lap/patch_reference_test.cpp:

    python3 tools/make_patch_reference.py > tests/data/patch_reference.csv

Inputs are doubles, printed so that they are read back exactly; outputs are exact for these doubles. They are computed with the edge formulas of
docs/explanation/limit_surface.md in 160 digits, of which cancellation (up to |c|^3/area for a centre c, 1e24 here) leaves enough. Every
twist about a point within 20 radii is also checked against the integral that defines h,
    h = integral of w |v + omega z x (r - reference)|,
by Gauss-Legendre quadrature over the triangles (centre, edge). Requires mpmath.
"""
import math
import random
import sys

from mpmath import mp, mpf

mp.dps = 160
CHECK_DIGITS = 1e-15


def edges(rings):
    for ring in rings:
        for i, a in enumerate(ring):
            yield a, ring[(i + 1) % len(ring)]


def exact(rings):
    return [[(mpf(x), mpf(y)) for x, y in ring] for ring in rings]


def moments(rings):
    """Returns area, centroid, and second moments about the centroid."""
    area = sx = sy = mpf(0)
    for (ax, ay), (bx, by) in edges(rings):
        c = ax * by - ay * bx
        area += c / 2
        sx += c * (ax + bx) / 6
        sy += c * (ay + by) / 6
    gx, gy = sx / area, sy / area
    xx = xy = yy = mpf(0)
    for (ax, ay), (bx, by) in edges(rings):
        ax, ay, bx, by = ax - gx, ay - gy, bx - gx, by - gy
        c = ax * by - ay * bx
        xx += c * (ax * ax + ax * bx + bx * bx) / 12
        yy += c * (ay * ay + ay * by + by * by) / 12
        xy += c * (2 * ax * ay + ax * by + bx * ay + 2 * bx * by) / 24
    return area, gx, gy, xx, xy, yy


def integrals_about(rings, traction, cx, cy):
    """Returns the integrals of w|r| and w r/|r| with r measured from c and w = traction[0] + traction[1:].r."""
    w, bx, by = traction
    distance = gx = gy = mpf(0)
    for (ax, ay), (ex, ey) in edges(rings):
        ax, ay, ex, ey = ax - cx, ay - cy, ex - cx, ey - cy
        length = mp.hypot(ex - ax, ey - ay)
        tx, ty = (ex - ax) / length, (ey - ay) / length
        d, s1 = ax * ty - ay * tx, ax * tx + ay * ty
        s2 = s1 + length
        if abs(d) < mpf(10) ** -120:
            continue
        r1, r2 = mp.hypot(d, s1), mp.hypot(d, s2)
        lam = mp.asinh(s2 / abs(d)) - mp.asinh(s1 / abs(d))
        ds_rho, d_rho = s2 * r2 - s1 * r1, r2 - r1
        distance += w * d / 6 * (ds_rho + d * d * lam)
        outward, along = w * d * d * lam / 2, w * d * d_rho / 2
        bm, bt = bx * ty - by * tx, bx * tx + by * ty
        distance += d / 4 * (bm * d * (ds_rho + d * d * lam) / 2 + bt * (r2**3 - r1**3) / 3)
        outward += d / 3 * d * (bm * d * lam + bt * d_rho)
        along += d / 3 * (bm * d * d_rho + bt * (ds_rho - d * d * lam) / 2)
        gx += outward * ty + along * tx
        gy += -outward * tx + along * ty
    return distance, gx, gy


def reference_values(rings, traction, point, nu):
    """Returns h, f_x, f_y, and m about `point`. `traction`: value at the centroid and gradient."""
    vx, vy, omega = (mpf(c) for c in nu)
    px, py = (mpf(c) for c in point)
    area, gx, gy, xx, xy, yy = moments(rings)
    w, bx, by = (mpf(c) for c in traction)
    if omega == 0:
        speed = mp.hypot(vx, vy)
        ux, uy = vx / speed, vy / speed
        force = w * area
        first_x, first_y = bx * xx + by * xy, bx * xy + by * yy  # about the centroid
        mx, my = force * (gx - px) + first_x, force * (gy - py) + first_y
        return speed * force, force * ux, force * uy, mx * uy - my * ux
    cx, cy = px - vy / omega, py + vx / omega
    there = w + bx * (cx - gx) + by * (cy - gy)
    distance, dx, dy = integrals_about(rings, (there, bx, by), cx, cy)
    sign = mp.sign(omega)
    fx, fy = -sign * dy, sign * dx
    # The moment about c is ±distance; it is transferred to the point.
    return abs(omega) * distance, fx, fy, sign * distance + (cx - px) * fy - (cy - py) * fx


GAUSS = {}


def gauss(n):
    """Returns nodes and weights of Gauss-Legendre quadrature on [0, 1]."""
    if n not in GAUSS:
        rule = []
        for i in range(n):
            z = mp.cos(mp.pi * (i + mpf(3) / 4) / (n + mpf(1) / 2))
            for _ in range(6):
                p, q = mpf(1), mpf(0)
                for k in range(1, n + 1):
                    p, q = ((2 * k - 1) * z * p - (k - 1) * q) / k, p
                slope = n * (z * p - q) / (z * z - 1)
                z -= p / slope
            rule.append(((1 + z) / 2, 1 / ((1 - z * z) * slope * slope)))
        GAUSS[n] = rule
    return GAUSS[n]


def check_by_quadrature(rings, traction, point, nu):
    """Compares with the integral that defines h, in 30 digits, over triangles from the centre of rotation."""
    with mp.workdps(30):
        _, gx, gy, *_ = moments(rings)
        vx, vy, omega = (mpf(c) for c in nu)
        px, py = (mpf(c) for c in point)
        cx, cy = px - vy / omega, py + vx / omega
        total = [mpf(0)] * 4
        for (ax, ay), (bx, by) in edges(rings):
            twice = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
            if abs(twice) < 1e-25:
                continue  # the centre is on the line of the edge, so the triangle is degenerate
            # The integrand varies fastest at the foot of the centre on the edge. The edge is divided there, and around it in intervals that
            # grow with the distance.
            ex, ey = bx - ax, by - ay
            square = ex * ex + ey * ey
            foot, width = ((cx - ax) * ex + (cy - ay) * ey) / square, abs(twice) / square
            steps = [0] + [side * width * 3**k for k in range(12) for side in (-1, 1)]
            cuts = [0] + sorted(c for c in (foot + s for s in steps) if 0 < c < 1) + [1]
            for lo, hi in zip(cuts, cuts[1:]):
                for s, ws in gauss(24):
                    s, ws = lo + (hi - lo) * s, ws * (hi - lo)
                    for k, wk in gauss(3):
                        x, y = cx + k * (ax + s * ex - cx), cy + k * (ay + s * ey - cy)
                        ux, uy = vx - omega * (y - py), vy + omega * (x - px)
                        speed = mp.hypot(ux, uy)
                        w = traction[0] + traction[1] * (x - gx) + traction[2] * (y - gy)
                        f = w * twice * ws * wk * k
                        total[0] += f * speed
                        total[1] += f * ux / speed
                        total[2] += f * uy / speed
                        total[3] += f * ((x - px) * uy - (y - py) * ux) / speed
        value = reference_values(rings, traction, point, nu)
        error = max(abs(a - b) for a, b in zip(total, value)) / (abs(value[0]) + abs(value[1]))
        if error > CHECK_DIGITS:
            sys.exit(f"quadrature disagrees by {mp.nstr(error, 5)} for the twist {nu}")


def star(rng, n, low, high):
    angles = sorted(rng.uniform(0, 6.2831853) for _ in range(n))
    radii = [rng.uniform(low, high) for _ in range(n)]
    return [(r * float(mp.cos(a)), r * float(mp.sin(a))) for a, r in zip(angles, radii)]


def polygons(rng):
    square = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
    yield "square", [square], (1.0, 0.0, 0.0)
    yield "square_linear", [square], (1.0, 0.75, -0.5)
    r, l, w = 0.5**0.5, 0.5**0.5, 0.005  # overlap of a mitred corner, a band
    yield "strip", [[(-0.25 + s * r + q * r, 1.15 + s * r - q * r)
                     for s, q in ((0, -w), (0, w), (l, w), (l, -w))]], (29125000.0, 0.0, 0.0)
    yield "triangle", [[(2.0, 1.0), (3.5, 1.25), (2.25, 2.0)]], (0.5, 0.0, 0.0)
    yield "ell", [[(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]], (2.0, 0.0, 0.0)
    hole = [(-0.25, -0.125), (-0.25, 0.25), (0.125, 0.25), (0.125, -0.125)]
    yield "holed", [square, hole], (1.0, 0.0, 0.0)
    yield "holed_linear", [square, hole], (1.0, -0.25, 1.0)
    for i in range(6):
        yield f"star{i}", [star(rng, 4 + 2 * i, 0.4, 1.0)], (1.0, 0.0, 0.0)
    yield "star_linear", [star(rng, 9, 0.5, 1.0)], (1.0, 0.5, 0.25)


def centres(rng, rings, gx, gy, radius):
    """Yields centres of rotation with a name for their position; coordinates are doubles."""
    for k in range(3):
        yield "inside", gx + 0.2 * radius * rng.uniform(-1, 1), gy + 0.2 * radius * rng.uniform(-1, 1)
    sides = list(edges(rings))
    for (ax, ay), (bx, by) in rng.sample(sides, 2):
        yield "edge", 0.75 * ax + 0.25 * bx, 0.75 * ay + 0.25 * by
        yield "vertex", ax, ay
        length = ((bx - ax) ** 2 + (by - ay) ** 2) ** 0.5
        for side in (-1e-9, 1e-9):
            yield "near_edge", (ax + bx) / 2 + side * (by - ay) / length, (ay + by) / 2 - side * (bx - ax) / length
        yield "on_line", 1.5 * bx - 0.5 * ax, 1.5 * by - 0.5 * ay
    # 5.9 and 6.1 are on both sides of the change from the closed form to the expansion.
    for far in (1, 1.5, 3, 5, 5.9, 6.1, 8, 12, 30, 100, 1e3, 1e4, 1e6, 1e8):
        a = rng.uniform(0, 6.2831853)
        yield "far", gx + far * radius * float(mp.cos(a)), gy + far * radius * float(mp.sin(a))


def main():
    rng = random.Random(7)
    print("name,where,rings,traction,traction_x,traction_y,point_x,point_y,v_x,v_y,omega,h,f_x,f_y,m")
    for name, doubles, traction in polygons(rng):
        rings = exact(doubles)
        _, gx, gy, *_ = (float(c) for c in moments(rings))
        radius = max(((x - gx) ** 2 + (y - gy) ** 2) ** 0.5 for x, y in doubles[0])
        text = "|".join(";".join(f"{x!r} {y!r}" for x, y in ring) for ring in doubles)
        rows = [("translation", (rng.uniform(-1, 1), rng.uniform(-1, 1), 0.0)) for _ in range(2)]
        for where, cx, cy in centres(rng, doubles, gx, gy, radius):
            omega = rng.choice([-1.0, 1.0])
            if where == "far" and rng.random() < 0.5:
                omega *= 10 ** rng.uniform(-6, 2)
            rows.append((where, (omega * (cy - gy), -omega * (cx - gx), omega)))
        for where, nu in rows:
            if nu[2] != 0 and math.hypot(nu[0], nu[1]) < 20 * radius * abs(nu[2]):
                check_by_quadrature(rings, traction, (gx, gy), nu)
            values = reference_values(rings, traction, (gx, gy), nu)
            print(",".join([name, where, text] + [repr(c) for c in (*traction, gx, gy, *nu)]
                           + [mp.nstr(v, 50) for v in values]))


if __name__ == "__main__":
    main()
