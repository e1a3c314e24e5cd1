// Places the names of bodies in the picture: on the body if there is room, otherwise next to it with a leader line, but never on another
// body or name. Names without room are omitted, and the legend shows their number (legend.js).
(() => {
  const make = steplap.make, { add, minus, scaled, dot, length, seenIn, apply } = steplap.geometry;
  const font = '12px "DejaVu Sans", Arial, sans-serif', lineHeight = 14, air = 3; // font; line height and margin, pixels
  const rings = [6, 18, 34, 54, 80, 110, 150, 200, 260]; // distances tried between a name and the box around its body, pixels
  const most = 40, mostCrowded = 16; // largest number of bodies with names; largest number with names far from the body
  const onBody = 6, beside = 12; // number of stored positions per name, on the body and next to it, for use when bodies pass each other
  const canvas = document.createElement('canvas').getContext('2d');

  const grid = (low, high, count) => Array.from({ length: count }, (_, k) => low + ((high - low) * (k + 0.5)) / count);
  const boxAt = ([x, y], { width, height }) => [x - 0.5 * width, y - 0.5 * height, x + 0.5 * width, y + 0.5 * height];
  const overlap = (a, b, gap) => a[0] < b[2] + gap && b[0] < a[2] + gap && a[1] < b[3] + gap && b[1] < a[3] + gap;
  const isIn = ([x, y], box, gap) => x > box[0] - gap && x < box[2] + gap && y > box[1] - gap && y < box[3] + gap;
  const nearestIn = (box, [x, y]) => [Math.min(Math.max(x, box[0]), box[2]), Math.min(Math.max(y, box[1]), box[3])];

  // Returns the possible layouts of a name: one line and, if it has several words, two lines.
  function layoutsOf(name) {
    const words = name.split(' '), all = [[name]];
    if (words.length > 1) {
      const cuts = words.slice(1).map((_, k) => [words.slice(0, k + 1).join(' '), words.slice(k + 1).join(' ')]);
      all.push(cuts.reduce((a, b) => (Math.max(...b.map((s) => s.length)) < Math.max(...a.map((s) => s.length)) ? b : a)));
    }
    canvas.font = font;
    const widthOf = (lines) => Math.max(...lines.map((text) => canvas.measureText(text).width));
    return all.map((lines) => ({ lines, width: widthOf(lines) + 2 * air, height: lineHeight * lines.length + 2 }));
  }

  Object.assign(steplap.Scene.prototype, {
    addName(body) {
      if (this.bodies.size > most) return;
      const leader = make('path', { class: 'leader' }), text = make('text', { class: 'name-text' });
      const element = make('g', { class: 'name', 'data-name-of': body.name }, leader, text);
      this.nameLayer.append(element);
      this.marks.set(body.name, { layouts: layoutsOf(body.name), places: [], spot: null, element, leader, text, written: null });
    },
    // Returns the box of a name in pixels; null if the name is omitted.
    nameBox(name, pose) {
      const { spot } = this.marks.get(name);
      return spot ? boxAt(add(this.toScreen(pose(name)), spot.shift), spot.layout) : null;
    },
    nameBoxes(pose) { return [...this.marks.keys()].map((name) => this.nameBox(name, pose)).filter(Boolean); },
    showName(body, pose) {
      const mark = this.marks.get(body.name), box = mark && this.nameBox(body.name, pose);
      if (!mark) return;
      mark.element.style.display = box ? '' : 'none';
      if (!box) return;
      this.writeName(mark);
      const [x, y] = [0.5 * (box[0] + box[2]), box[1] + 1];
      mark.text.setAttribute('transform', `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
      const end = mark.spot.isBeside ? this.leaderEnd(body, box, pose) : null, from = end && nearestIn(box, end);
      const isLong = end && length(minus(end, from)) > 5;
      const text = (p) => p.map((v) => v.toFixed(1)).join(' ');
      mark.leader.setAttribute('d', isLong ? `M${text(from)}L${text(end)}` : 'M0 0');
    },
    writeName(mark) {
      const { layout } = mark.spot;
      if (mark.written === layout) return;
      mark.written = layout;
      const written = layout.lines.map((line, k) => make('tspan', { x: 0, y: lineHeight * (k + 0.8) }, (k ? ' ' : '') + line));
      mark.text.replaceChildren(...written);
    },
    // Returns the end of the leader line: the point of the body nearest to the name, in pixels.
    leaderEnd(body, box, pose) {
      const middle = [0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3])], p = pose(body.name);
      return this.toScreen(apply(p, steplap.forms.nearest(body, seenIn(p, this.toPlane(...middle))) || [0, 0]));
    },

    // --- geometry of bodies and names -----------------------------------------------------------------
    // Returns the lines of a body (bars, an outline of two points, struts) as [from, to, half the line width in pixels].
    linesOf(body) {
      if (!body.lines)
        body.lines = [
          ...body.segments.map(([x0, y0, x1, y1, thickness]) => [[x0, y0], [x1, y1], 0.5 * (thickness || 0)]),
          ...(body.outline.length === 2 ? [[...body.outline, 0]] : []), ...this.strutsOf(body).map(([a, b]) => [a, b, 0])
        ];
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
    // Returns the names of bodies at a point, in the order of drawing. The body `exact` is tested without a margin, all others with one.
    bodiesAt(point, pose, exact) {
      const found = [];
      for (const body of this.bodies.values()) {
        const own = seenIn(pose(body.name), point);
        if (length(own) > 1.5 * body.reach + 9 / this.scale) continue;
        const isThere = steplap.forms.isSolidAt(body, own) || this.isOnLine(body, own) || this.isOnLook(body, own);
        if (isThere || (body.name !== exact && this.isAtEdge(body, own))) found.push(body.name);
      }
      return found;
    },
    // Returns the rank of a position for a name: 0 on its body only; 1 on no body; 2 on its body, which is drawn above others; 3 on another
    // body.
    rankOf(name, screen, pose) {
      const at = this.bodiesAt(this.toPlane(...screen), pose, name), own = at.indexOf(name);
      if (!at.length) return 1;
      // A body that encloses the name's body is translucent and hides nothing.
      const isWithin = (inner, outer) => this.isBehind(outer) && this.body(inner).reach < this.body(outer).reach;
      const isHidden = at.some((other, i) => other !== name && (i > own ? !isWithin(name, other) : isWithin(other, name)));
      return own < 0 || isHidden ? 3 : at.length > 1 ? 2 : 0;
    },
    isBehind(name) {
      if (!this.behind) this.behind = new Set([...this.bodies.values()].filter((body) => this.isAround(body)).map((body) => body.name));
      return this.behind.has(name);
    },
    // Returns true if the whole box is on the visible part of the name's body or, if `isBeside`, on no body.
    isNameClear(name, box, isBeside, pose) {
      if (box[0] < 2 || box[1] < 2 || box[2] > this.width - 2 || box[3] > this.height - this.footHeight() - 4) return false;
      if (this.lensBoxes().some((lens) => overlap(box, lens, 2))) return false;
      return grid(box[0], box[2], 5).every((x) => grid(box[1], box[3], 3).every((y) => {
        const rank = this.rankOf(name, [x, y], pose);
        return isBeside ? rank === 1 : rank === 0 || rank === 2;
      }));
    },

    // --- positions of names ---------------------------------------------------------------------------
    boxOnScreen(body, pose) {
      const box = new steplap.Box();
      body.extend(box, pose(body.name));
      const [left, bottom] = this.toScreen(box.low), [right, top] = this.toScreen(box.high);
      return [left, top, right, bottom];
    },
    // Returns candidate centres of a name on its body, nearest to the body's centre first.
    placesOn(around, { width, height }) {
      const [left, top, right, bottom] = around, middle = [0.5 * (left + right), 0.5 * (top + bottom)];
      if (right - left < width || bottom - top < height) return [];
      const columns = grid(left + 0.5 * width, right - 0.5 * width, 13), rows = grid(top + 0.5 * height, bottom - 0.5 * height, 13);
      const found = columns.flatMap((x) => rows.map((y) => [x, y]));
      return found.sort((a, b) => length(minus(a, middle)) - length(minus(b, middle)));
    },
    // Returns candidate centres of a name outside a box, nearest first.
    placesBeside(around, { width, height }) {
      const [left, top, right, bottom] = around, found = [];
      for (const gap of this.bodies.size > mostCrowded ? rings.slice(0, 4) : rings) {
        const x0 = left - gap - 0.5 * width, x1 = right + gap + 0.5 * width;
        const y0 = top - gap - 0.5 * height, y1 = bottom + gap + 0.5 * height;
        const rows = grid(y0, y1, Math.max(3, Math.round((y1 - y0) / 18)));
        const columns = grid(x0, x1, Math.max(3, Math.round((x1 - x0) / 30)));
        const sides = [...rows.flatMap((y) => [[x0, y], [x1, y]]), ...columns.flatMap((x) => [[x, y0], [x, y1]])];
        const middle = [0.5 * (left + right), 0.5 * (top + bottom)];
        found.push(...sides.sort((a, b) => length(minus(a, middle)) - length(minus(b, middle))));
      }
      return found;
    },
    // Chooses the position of each name in the reference pose, starting with the smallest body.
    spreadNames() {
      const rest = (name) => this.reference(name), taken = [], symbols = this.symbols.occupied();
      for (const [name, mark] of [...this.marks].sort((a, b) => this.body(a[0]).reach - this.body(b[0]).reach)) {
        const body = this.body(name), around = this.boxOnScreen(body, rest), origin = this.toScreen(rest(name));
        const search = (placesOf, isBeside, count) => {
          const found = [];
          for (const layout of mark.layouts)
            for (const at of placesOf.call(this, around, layout)) {
              if (found.length >= count) return found;
              const box = boxAt(at, layout);
              const isOnSymbol = symbols.some((p) => isIn(p, box, 3));
              if (this.isNameClear(name, box, isBeside, rest)) found.push({ shift: minus(at, origin), layout, isBeside, box, isOnSymbol });
            }
          return found;
        };
        mark.places = [...search(this.placesOn, false, onBody * 6), ...search(this.placesBeside, true, beside * 6)];
        const isApart = (box) => taken.every((other) => !overlap(box, other, 2));
        const isFree = ({ box, isBeside }) => isApart(box) && (!isBeside || this.isLeaderFree(body, box, rest, taken));
        mark.spot = mark.places.find((place) => !place.isOnSymbol && isFree(place)) || mark.places.find(isFree) || null;
        mark.wanted = mark.spot;
        if (mark.spot) taken.push(mark.spot.box);
      }
    },
    isLeaderFree(body, box, pose, taken) {
      const end = this.leaderEnd(body, box, pose), from = nearestIn(box, end);
      return grid(0, 1, 16).every((s) => taken.every((other) => !isIn(add(from, scaled(minus(end, from), s)), other, 1)));
    },
    // Moves names that would overlap another name or body at this pose.
    settleNames(pose) {
      const settled = [];
      for (const [name, mark] of this.marks) {
        const origin = this.toScreen(pose(name));
        const isFree = (place) => {
          const box = boxAt(add(origin, place.shift), place.layout);
          return settled.every((other) => !overlap(box, other, 1)) && this.isNameClear(name, box, place.isBeside, pose);
        };
        mark.spot = [mark.wanted, ...mark.places].find((place) => place && isFree(place)) || null;
        if (mark.spot) settled.push(boxAt(add(origin, mark.spot.shift), mark.spot.layout));
      }
    },
    namesLeftOut() { return [...this.marks.values()].filter((mark) => !mark.spot).length; },
  });
})();
