// Numbers of bodies in the picture. A number stands on its body, or beside it where there is no body; never on another one. Where it
// stands off its body a line leads to it.
(() => {
  const make = steplap.make, { add, minus, scaled, dot, length, seenIn, apply } = steplap.geometry;
  const apart = 20; // pixels between two numbers
  const rings = [24, 36, 50, 66, 84, 104, 130, 160]; // about the centre of the body, pixels

  const ringOf = (r) => [...Array(12).keys()].map((k) => [r * Math.sin((k * Math.PI) / 6), -r * Math.cos((k * Math.PI) / 6)]);

  Object.assign(steplap.Scene.prototype, {
    addNumber(body, number) {
      const leader = make('path', { class: 'leader' }), element = make('g', { 'data-number-of': body.name }, make('circle', { r: 9, class: 'number-mark' }), make('text', { class: 'number-text' }, number));
      this.textLayer.append(leader, element);
      this.marks.set(body.name, { shift: [0, 0], now: [0, 0], places: [[0, 0]], element, leader });
    },
    showNumber(body, [x, y], pose) {
      const mark = this.marks.get(body.name);
      if (!mark) return;
      const at = [x + mark.now[0], y + mark.now[1]];
      mark.element.setAttribute('transform', `translate(${at[0]} ${at[1]})`);
      const own = seenIn(pose(body.name), this.toPlane(...at)), nearest = steplap.forms.isSolidAt(body, own) ? null : steplap.forms.nearest(body, own) || [0, 0];
      const end = nearest && this.toScreen(apply(pose(body.name), nearest));
      mark.leader.setAttribute('d', end && length(minus(end, at)) > 14 ? `M${at.map((v) => v.toFixed(1)).join(' ')}L${end.map((v) => v.toFixed(1)).join(' ')}` : 'M0 0');
    },
    // Lines of a body: bars, what its outline is if it has two points, struts; [from, to, half of the width in pixels].
    linesOf(body) {
      if (!body.lines)
        body.lines = [...body.segments.map(([x0, y0, x1, y1, thickness]) => [[x0, y0], [x1, y1], 0.5 * (thickness || 0)]), ...(body.outline.length === 2 ? [[...body.outline, 0]] : []), ...this.strutsOf(body).map(([a, b]) => [a, b, 0])];
      return body.lines;
    },
    isOnLine(body, p) {
      return this.linesOf(body).some(([a, b, half]) => {
        const e = minus(b, a), s = Math.min(1, Math.max(0, dot(minus(p, a), e) / (dot(e, e) || 1)));
        return length(minus(p, add(a, scaled(e, s)))) <= half + 6 / this.scale;
      });
    },
    isAtEdge(body, p) {
      const edge = steplap.forms.nearest(body, p);
      return Boolean(edge) && length(minus(p, edge)) < 4 / this.scale;
    },
    // Names, in the order in which they are drawn. Of 'exact' only what is painted counts, of others a margin about it as well.
    bodiesAt(point, pose, exact) {
      const found = [];
      for (const body of this.bodies.values()) {
        const p = pose(body.name), own = seenIn(p, point);
        if (length(own) <= 1.5 * body.reach + 9 / this.scale && (steplap.forms.isSolidAt(body, own) || this.isOnLine(body, own) || (body.name !== exact && this.isAtEdge(body, own)))) found.push(body.name);
      }
      return found;
    },
    // 0: on its body alone; 1: on none; 2: on its own, which is seen before the others; 3: on another.
    rankOf(name, screen, pose) {
      const at = this.bodiesAt(this.toPlane(...screen), pose, name), own = at.indexOf(name);
      if (!at.length) return 1;
      // What stands around another body is translucent: it hides nothing of what is within, whichever is drawn first.
      const isWithin = (inner, outer) => this.isBehind(outer) && this.body(inner).reach < this.body(outer).reach;
      const isHidden = at.some((other, i) => other !== name && (i > own ? !isWithin(name, other) : isWithin(other, name)));
      return own < 0 || isHidden ? 3 : at.length > 1 ? 2 : 0;
    },
    isBehind(name) {
      if (!this.behind) this.behind = new Set([...this.bodies.values()].filter((body) => this.isAround(body)).map((body) => body.name));
      return this.behind.has(name);
    },
    // Where the number of each body stands: on it where it has room, off symbols and other numbers, else beside it.
    spreadMarks() {
      const taken = [], symbols = this.symbols.occupied(), rest = (name) => this.reference(name);
      for (const [name, mark] of [...this.marks].sort((a, b) => this.body(a[0]).reach - this.body(b[0]).reach)) {
        const [x, y] = this.toScreen(this.reference(name)), body = this.body(name), extent = body.reach * this.fittedScale;
        const first = extent > 22 ? [[0, 0]] : ringOf(extent + 14);
        mark.places = [...first, ...rings.flatMap(ringOf)];
        const isSeen = (p) => this.isNumberSeen([x + p[0], y + p[1]]), isApart = (p) => taken.every((q) => Math.max(Math.abs(q[0] - x - p[0]), Math.abs(q[1] - y - p[1])) > apart);
        const isClear = (p) => symbols.every((q) => Math.hypot(q[0] - x - p[0], q[1] - y - p[1]) > 15);
        const seen = mark.places.filter(isSeen).map((p) => ({ p, rank: this.rankOf(name, [x + p[0], y + p[1]], rest) }));
        const free = seen.filter(({ p }) => isApart(p) && isClear(p)), wanted = extent > 30 ? [[0, 2], [1]] : [[0, 1, 2]];
        const best = [...wanted.map((ranks) => free.find(({ rank }) => ranks.includes(rank))), seen.find(({ p, rank }) => rank < 3 && isApart(p)), seen.find(({ rank }) => rank < 3), seen.find(({ p }) => isApart(p))].find(Boolean);
        mark.shift = best ? best.p : [0, 0];
        taken.push([x + mark.shift[0], y + mark.shift[1]]);
      }
    },
    isNumberSeen([x, y]) { return x > 11 && x < this.width - 11 && y > 11 && y < this.height - 34; },
    // Bodies pass each other: a number that would lie on another, or on another body, goes aside for as long.
    settleMarks(pose) {
      const settled = [];
      for (const [name, mark] of this.marks) {
        const [x, y] = this.toScreen(pose(name)), placed = (p) => [x + p[0], y + p[1]];
        const isApart = (p) => settled.every((q) => Math.max(Math.abs(q[0] - x - p[0]), Math.abs(q[1] - y - p[1])) > apart - 1);
        const isOwn = (p) => this.rankOf(name, placed(p), pose) < 3;
        const ways = [mark.shift, ...mark.places.filter((p) => this.isNumberSeen(placed(p)))];
        mark.now = ways.find((p) => isApart(p) && isOwn(p)) || ways.find(isApart) || mark.shift;
        settled.push(placed(mark.now));
      }
    },
  });
})();
