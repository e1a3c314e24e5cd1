// Geometry of bodies: edges, intersections with a line, nearest point.
steplap.forms = (() => {
  const { add, minus, scaled, dot, length, apply } = steplap.geometry;
  const cross = (a, b) => a[0] * b[1] - a[1] * b[0];
  const sides = 24; // number of sides of a polygon that replaces a circle

  // Returns the edges of a body in its axes, as pairs of points.
  function edgesOf(body) {
    if (body.edges) return body.edges;
    const edges = [], ring = (points) => points.forEach((p, i) => edges.push([p, points[(i + 1) % points.length]]));
    if (body.outline.length > 2) ring(body.outline);
    if (body.outline.length === 2) edges.push(body.outline);
    for (const points of [...body.polygons, ...(body.holes || [])]) ring(points);
    for (const [x, y, r] of body.circles)
      ring(Array.from(
        { length: sides }, (_, k) => [x + r * Math.cos((2 * Math.PI * k) / sides), y + r * Math.sin((2 * Math.PI * k) / sides)]));
    for (const [x0, y0, x1, y1] of body.segments) edges.push([[x0, y0], [x1, y1]]);
    body.edges = edges;
    return edges;
  }
  // Returns the distances from p, in ascending order, at which the line along the unit vector d crosses the body's outline.
  function crossings(body, pose, p, d) {
    const found = [];
    for (const edge of edgesOf(body)) {
      const [a, b] = edge.map((q) => apply(pose, q)), e = minus(b, a), below = cross(d, e);
      if (Math.abs(below) < 1e-12 * length(e)) continue;
      const s = cross(minus(a, p), e) / below, on = cross(minus(a, p), d) / below;
      if (on >= -1e-9 && on <= 1 + 1e-9 && s > -1e-9) found.push(Math.max(0, s));
    }
    return found.sort((x, y) => x - y);
  }
  // Returns the point on the body's outline nearest to p, in the body's axes; null for a body without outline.
  function nearest(body, p) {
    let best = null;
    for (const [a, b] of edgesOf(body)) {
      const e = minus(b, a), s = Math.min(1, Math.max(0, dot(minus(p, a), e) / (dot(e, e) || 1))), q = add(a, scaled(e, s));
      if (!best || length(minus(p, q)) < length(minus(p, best))) best = q;
    }
    return best;
  }
  function isWithin(ring, p) {
    let is = false;
    ring.forEach((a, i) => {
      const b = ring[(i + 1) % ring.length];
      if (a[1] > p[1] !== b[1] > p[1] && p[0] < a[0] + ((b[0] - a[0]) * (p[1] - a[1])) / (b[1] - a[1])) is = !is;
    });
    return is;
  }
  // Returns true if p is within the outline, including holes.
  function isInside(body, p) {
    const within = (ring) => isWithin(ring, p);
    return (body.outline.length > 2 && within(body.outline)) || body.polygons.some(within) ||
      body.circles.some(([x, y, r]) => length(minus(p, [x, y])) <= r * (1 + 1e-6));
  }
  const isSolidAt = (body, p) => isInside(body, p) && !(body.holes || []).some((hole) => isWithin(hole, p));
  return { edgesOf, crossings, nearest, isInside, isSolidAt };
})();
