// Operations on points [x, y] and poses [x, y, angle].
steplap.geometry = (() => {
  const turn = (p, angle) => {
    const c = Math.cos(angle), s = Math.sin(angle);
    return [c * p[0] - s * p[1], s * p[0] + c * p[1]];
  };
  const add = (a, b) => [a[0] + b[0], a[1] + b[1]];
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];
  const scaled = (a, k) => [k * a[0], k * a[1]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1];
  const length = (a) => Math.hypot(a[0], a[1]);
  const unit = (a) => (length(a) > 0 ? scaled(a, 1 / length(a)) : [0, 1]);
  const apply = (pose, p) => add([pose[0], pose[1]], turn(p, pose[2]));
  const seenIn = (pose, p) => turn(minus(p, [pose[0], pose[1]]), -pose[2]);
  // Returns the pose of b relative to a.
  const relative = (a, b) => [...turn([b[0] - a[0], b[1] - a[1]], -a[2]), b[2] - a[2]];
  // Returns the point of `corners` with the smallest height above the line through `origin` with normal n, projected onto the line; the
  // middle one of several at equal height. `ends` limits the line along [n_y, -n_x].
  const lowest = (n, origin, corners, ends = [-Infinity, Infinity]) => {
    if (!corners.length) return null;
    const along = [n[1], -n[0]], height = (p) => dot(n, minus(p, origin));
    const first = corners.reduce((least, p) => (height(p) < height(least) ? p : least));
    const touching =
      corners.filter((p) => height(p) - height(first) <= 0.02 * Math.abs(dot(along, minus(p, first)))).map((p) => dot(along, p));
    const low = Math.max(Math.min(...touching), ends[0]), high = Math.min(Math.max(...touching), ends[1]);
    return { gap: height(first), n, at: add(scaled(n, dot(n, origin)), scaled(along, 0.5 * (low + high))) };
  };
  // Returns the contact point of two touching convex outlines, and the direction of the force of the second on the first.
  const facing = (first, second) => {
    let best = null;
    for (const [own, other, sign] of [[second, first, 1], [first, second, -1]]) {
      if (own.length < 3 || !other.length) return null;
      const middle = scaled(own.reduce(add), 1 / own.length);
      own.forEach((p, i) => {
        const q = own[(i + 1) % own.length], d = unit(minus(q, p));
        if (length(minus(q, p)) === 0) return;
        const n = dot([d[1], -d[0]], minus(p, middle)) > 0 ? [d[1], -d[0]] : [-d[1], d[0]], along = [n[1], -n[0]];
        const found = lowest(n, p, other, [dot(along, p), dot(along, q)].sort((x, y) => x - y));
        if (!best || found.gap > best.gap) best = {...found, n: scaled(n, sign) };
      });
    }
    return best;
  };
  return { lowest, facing, turn, add, minus, scaled, dot, length, unit, apply, seenIn, relative };
})();

// Bounding box of points.
steplap.Box = class Box {
  constructor() {
    this.low = [Infinity, Infinity];
    this.high = [-Infinity, -Infinity];
  }
  take(p, reach = 0) {
    for (const i of [0, 1]) {
      this.low[i] = Math.min(this.low[i], p[i] - reach);
      this.high[i] = Math.max(this.high[i], p[i] + reach);
    }
    return this;
  }
  nearest(p) { return p.map((v, i) => Math.min(Math.max(v, this.low[i]), this.high[i])); }
  get isEmpty() { return !(this.low[0] <= this.high[0] && this.low[1] <= this.high[1]); }
  get span() { return [this.high[0] - this.low[0], this.high[1] - this.low[1]]; }
  get middle() { return [0.5 * (this.low[0] + this.high[0]), 0.5 * (this.low[1] + this.high[1])]; }
  joined(other) {
    const box = new Box();
    for (const b of [this, other])
      if (!b.isEmpty) box.take(b.low).take(b.high);
    return box;
  }
};

// Returns the ends of an edge on which wheels roll, in order. `sizes` contains radius, x, y, x, y, thickness, and x, y of further points of
// a road.
steplap.endsOfEdge = (sizes) => {
  const numbers = [...sizes.slice(1, 5), ...sizes.slice(6)], ends = [];
  for (let i = 0; i + 1 < numbers.length; i += 2) ends.push([numbers[i], numbers[i + 1]]);
  return ends;
};
