// Places springs in the picture. Usually a spring is drawn between its ends, next to other springs. A spring along an axis whose ends
// coincide is drawn from the outline of its body to the next outline beyond, or to an anchor.
(() => {
  const { add, minus, scaled, dot, length, unit, seenIn } = steplap.geometry;
  const across = (d) => [-d[1], d[0]];
  const flipped = (d) => [d[0], -d[1]];
  const path = (points) => 'M' + points.map((p) => `${p[0].toFixed(2)} ${p[1].toFixed(2)}`).join('L');
  const least = 3, free = 4; // in sizes of symbols: shortest spring; length of a spring that ends at an anchor
  const lanes = [0, 2, -2, 4, -4, 6, -6];

  // Returns the distance between two nearly parallel line segments; infinite for other segments.
  function gapBetween([a, b], [c, d]) {
    const e = unit(minus(b, a)), f = unit(minus(d, c));
    if (Math.abs(dot(e, f)) < 0.8) return Infinity;
    const s = [c, d].map((p) => dot(e, minus(p, a))).sort((x, y) => x - y), size = length(minus(b, a));
    const apart = Math.max(0, s[0] - size, -s[1]), aside = Math.abs(dot(across(e), minus(c, a)));
    return Math.hypot(apart, aside);
  }

  Object.assign(steplap.Symbols.prototype, {
    placeSprings() {
      const { scene } = this, rest = (name) => scene.reference(name);
      this.taken = [];
      this.stretches = [];
      for (const spring of this.springs) {
        const { shape } = spring;
        spring.lane = 0;
        spring.tied = null;
        const [a, b] = this.ends(shape, rest);
        const d = shape.direction ? this.direction(shape, rest) : null, way = d ? dot(d, minus(a, b)) : length(minus(a, b));
        if (d && Math.abs(way) < least * this.u) this.tieSpring(spring, a, d, rest);
        else this.chooseLane(spring, a, d ? minus(a, scaled(d, way)) : b);
      }
      for (const element of scene.elements)
        for (const shape of element.shapes)
          if (!['friction', 'spring', 'faces'].includes(shape.type))
            for (const place of shape.at) this.taken.push(this.screen(place, rest));
      this.drawnAt = this.taken.map((p) => scene.toPlane(...p));
    },
    occupy(a, b) {
      this.stretches.push([a, b]);
      const count = Math.max(1, Math.round(length(minus(b, a)) / 8));
      for (let k = 0; k <= count; ++k) this.taken.push(add(a, scaled(minus(b, a), k / count)));
    },
    isClear(a, b) {
      return this.stretches.every((other) => gapBetween([a, b], other) >= 1.7 * this.u);
    },
    // Places a spring of non-zero length next to the springs that were placed before.
    chooseLane(spring, a, b) {
      const n = unit(across(minus(a, b))), shifted = (k) => [a, b].map((p) => add(p, scaled(n, k * this.u)));
      spring.lane = lanes.find((k) => this.isClear(...shifted(k))) || 0;
      this.occupy(...shifted(spring.lane));
    },
    // Places a spring whose ends coincide. If the body has wheels, the spring is drawn on their axle.
    tieSpring(spring, a, d, rest) {
      if (this.tieToAxle(spring, a, d, rest)) return;
      const { scene } = this, [placeA, placeB] = spring.shape.at, { u } = this, found = [];
      const upright = Math.abs(d[1]) > Math.abs(d[0]), down = upright ? (d[1] > 0 ? 1 : -1) : d[0] > 0 ? -1 : 1;
      const bodyA = scene.body(placeA.body), bodyB = scene.body(placeB.body), n = across(d);
      // Stops are drawn at the middle of the edge.
      const isStopped =
        scene.elements.some((e) => e.shapes.some((s) => s.type === 'rail' && s.style === 'limit' && s.at[0].body === placeA.body));
      lanes.forEach((lane, order) => {
        for (const side of [down, -down]) {
          const start = add(a, scaled(n, lane * u)), e = scaled(d, side), out = this.leaves(bodyA, rest, start, e, false);
          if (out === null && order > 0) continue; // the end would be next to the same body
          const from = add(start, scaled(e, out || 0)),
                hit = placeB.body === 'ground' ? null : this.leaves(bodyB, rest, add(from, scaled(e, 0.8 * u)), e, true);
          const isMet = hit !== null && hit > 0.8 * u && hit < 30 * u, to = add(from, scaled(e, isMet ? hit + 0.8 * u : free * u));
          const isSeen = to[0] > 3 && to[1] > 3 && to[0] < scene.width - 3 && to[1] < scene.height - scene.footHeight() - 3;
          const cost = order + (isStopped && order === 0 ? 30 : 0) + (isMet ? 0 : 8) + (side === down ? 0 : 0.5) + (isSeen ? 0 : 20) +
            (this.isClear(from, to) ? 0 : 40);
          found.push({ from, to, isMet, cost });
        }
      });
      const best = found.reduce((x, y) => (y.cost < x.cost ? y : x)), plane = (p, body) => seenIn(rest(body), scene.toPlane(...p));
      spring.tied = {
        a: { body: placeA.body, point: plane(best.from, placeA.body) },
        b: { body: placeB.body, point: plane(best.to, placeB.body) },
        isAnchored: !best.isMet
      };
      this.occupy(best.from, best.to);
    },
    tieToAxle(spring, a, d, rest) {
      const { scene } = this, [placeA, placeB] = spring.shape.at;
      const axles = scene.wheelsOf(placeB.body).map((point) => this.screen({ body: placeB.body, point }, rest));
      const far = (p) => Math.abs(dot(across(d), minus(p, a))), axle = axles.sort((p, q) => far(p) - far(q))[0];
      if (!axle || Math.abs(d[1]) < 0.7) return false;
      const n = across(d), lane = lanes.find((k) => this.isClear(add(a, scaled(n, k * this.u)), [a[0] + n[0] * k * this.u, axle[1]])) || 0;
      const to = [a[0] + n[0] * lane * this.u, axle[1]], edge = this.leaves(scene.body(placeA.body), rest, to, [0, -1], true);
      const from = add(to, [0, -Math.max(least * this.u, edge || 0)]), plane = (p, body) => seenIn(rest(body), scene.toPlane(...p));
      const ends = { a: { body: placeA.body, point: plane(from, placeA.body) }, b: { body: placeB.body, point: plane(to, placeB.body) } };
      spring.tied = {...ends, isAnchored: false };
      this.occupy(from, to);
      return true;
    },
    // Returns the distance in pixels from a point of the screen along e to the last intersection with the body's outline (the first one if
    // `isFirst`); null if there is none.
    leaves(body, pose, place, e, isFirst) {
      const found = steplap.forms.crossings(body, pose(body.name), this.scene.toPlane(...place), flipped(e));
      return found.length ? (isFirst ? found[0] : found[found.length - 1]) * this.scene.scale : null;
    },
    // Returns the ends of the spring on the screen, at a and at b.
    springEnds(spring, pose) {
      const { shape, tied, lane } = spring;
      if (tied) return [this.screen(tied.a, pose), this.screen(tied.b, pose)];
      let [a, b] = this.ends(shape, pose);
      if (shape.direction) {
        const axis = this.direction(shape, pose);
        b = minus(a, scaled(axis, dot(axis, minus(a, b))));
      }
      const shift = scaled(unit(across(minus(a, b))), (lane || 0) * this.u);
      return [add(a, shift), add(b, shift)];
    },
    // Draws the end of a spring that meets no outline as a plate, which is hatched if fixed.
    anchor(spring, a, b) {
      if (!spring.tied || !spring.tied.isAnchored) return '';
      const { u } = this, e = unit(minus(b, a)), n = scaled(across(e), 0.9 * u);
      const strokes = this.scene.isHeld(spring.tied.b.body) ? [-1, -0.4, 0.2, 0.8]
                                                                .map((k) => {
                                                                  const p = add(b, scaled(n, k));
                                                                  return path([p, add(p, add(scaled(e, 0.6 * u), scaled(n, 0.5)))]);
                                                                })
                                                                .join('')
                                                            : '';
      return path([add(b, n), minus(b, n)]) + strokes;
    },
    // Returns points along all springs in the reference pose, in pixels.
    occupied() { return this.drawnAt.map((p) => this.scene.toScreen(p)); },

    // Draws the stops of a slide where they touch the outline of the stopped body.
    stops(element, shape) {
      const { scene } = this, symbol = this.piece(element, { class: 'symbol stop' }), body = scene.body(shape.at[0].body);
      const rest = (name) => scene.reference(name);
      this.update((t, pose) => {
        const { u } = this, d = this.direction(shape, pose), d0 = this.direction(shape, rest), a0 = this.screen(shape.at[0], rest),
                  b0 = this.screen(shape.at[1], rest);
        const [a, b] = this.ends(shape, pose), side = dot(across(d), minus(a, b));
        let text = '';
        [-1, 1].forEach((sign, i) => {
          const stop = shape.sizes[i];
          if (stop === null || stop === undefined) return;
          const reach = this.leaves(body, rest, a0, scaled(d0, sign), false) || 0;
          const factor = scene.factorOf(shape.at[0].body, scene.seenFrom, scene.magnification);
          const along = dot(d0, minus(a0, b0)) + stop * factor * scene.scale + sign * reach;
          const at = add(add(b, scaled(d, along)), scaled(across(d), side)), n = scaled(across(d), 1.3 * u),
                back = scaled(d, 0.7 * sign * u);
          if (!(Math.abs(at[0]) < 3 * scene.width && Math.abs(at[1]) < 3 * scene.height)) return;
          text += path([add(at, n), minus(at, n)]) +
            [-1, -0.5, 0, 0.5]
              .map((k) => {
                const p = add(at, scaled(n, k));
                return path([p, add(p, add(back, scaled(n, 0.4)))]);
              })
              .join('');
        });
        symbol.setAttribute('d', text || 'M0 0');
      });
    },
    // Returns true if the lower edge of the body (the left one for a vertical slide), under which rollers are drawn, is straight.
    hasEdge(shape) {
      const { scene } = this, body = scene.body(shape.at[0].body), d = this.direction(shape, (name) => scene.reference(name)),
                    isUpright = Math.abs(d[1]) > Math.abs(d[0]);
      const points = body.outline.map((point) => steplap.geometry.apply(body.pose, point)), height = (p) => (isUpright ? p[0] : p[1]),
            way = (p) => (isUpright ? p[1] : p[0]);
      const low = Math.min(...points.map(height)), near = 0.02 * body.reach, at = points.filter((p) => height(p) < low + near).map(way),
            span = Math.max(...at) - Math.min(...at);
      return points.some((p, i) => {
        const q = points[(i + 1) % points.length];
        return height(p) < low + near && height(q) < low + near && Math.abs(way(p) - way(q)) > 0.9 * span && span > 0;
      });
    },
    // Draws rollers under the edge of a sliding body, and the line on which they roll, hatched if fixed.
    rollers(element, shape) {
      const { scene } = this, rest = (name) => scene.reference(name), [placeA, placeB] = shape.at, body = scene.body(placeA.body);
      const line = this.piece(element, { class: 'symbol track' }),
            rolls = [0, 1].map(() => this.piece(element, { class: 'dot roller' }, scene.elementLayer, 'circle'));
      this.update((t, pose) => {
        const { u } = this, d = this.direction(shape, rest), isUpright = Math.abs(d[1]) > Math.abs(d[0]);
        const down = isUpright ? [-1, 0] : [0, 1], n = scaled(across(d), Math.sign(dot(across(d), down)) || 1);
        const points = body.points.map((point) => this.screen({ body: body.name, point }, rest));
        const low = Math.max(...points.map((p) => dot(n, p))), ends = points.filter((p) => dot(n, p) > low - 2).map((p) => dot(d, p));
        const first = Math.min(...ends), last = Math.max(...ends), r = 0.4 * u, plane = (p, who) => seenIn(rest(who), scene.toPlane(...p));
        const put = (s, h) => add(scaled(d, s), scaled(n, h));
        [0.22, 0.78].forEach((k, i) => {
          const [x, y] = this.screen({ body: body.name, point: plane(put(first + k * (last - first), low + r), body.name) }, pose);
          rolls[i].setAttribute('cx', x);
          rolls[i].setAttribute('cy', y);
          rolls[i].setAttribute('r', r);
        });
        const reach = 2 * u, ground = [first - reach,
          last + reach].map((s) => this.screen({ body: placeB.body, point: plane(put(s, low + 2 * r), placeB.body) }, pose));
        let text = path(ground);
        if (scene.isHeld(placeB.body)) {
          const e = unit(minus(ground[1], ground[0])), out = scaled(across(e), Math.sign(dot(across(e), n)) || 1),
                size = length(minus(ground[1], ground[0]));
          for (let s = 0.4 * u; s < size; s += u)
            text += path([add(ground[0], scaled(e, s)), add(ground[0], add(scaled(e, s - 0.5 * u), scaled(out, 0.7 * u)))]);
        }
        line.setAttribute('d', text);
      });
    },
    // Draws ground edges on which wheels roll, hatched on the far side, as far as they are visible. A flat road is drawn as a line, because
    // its ends are not part of the machine.
    roads() {
      const { scene } = this, done = new Set();
      for (const element of scene.elements)
        for (const shape of element.shapes) {
          if (shape.type !== 'edge_touch' || shape.at[1].body !== 'ground' || shape.sizes[5] > 0) continue;
          const ends = steplap.endsOfEdge(shape.sizes), key = ends.join(' ');
          if (done.has(key)) continue;
          done.add(key);
          const hatch = steplap.make('path', { class: 'hatch road', 'data-plane-of': 'ground' });
          scene.groundLayer.append(hatch);
          this.update((t, pose) => {
            const { u } = this, places = ends.map((point) => this.screen({ body: 'ground', point }, pose));
            const wheel = this.screen(shape.at[0], (name) => scene.reference(name)), reach = scene.width + scene.height;
            const whole = unit(minus(places[places.length - 1], places[0])),
                  side = dot(across(whole), minus(wheel, places[0])) > 0 ? -1 : 1;
            let text = '', passed = 0;
            for (let i = 1; i < places.length; i += 1) {
              const from = places[i - 1], to = places[i], d = unit(minus(to, from)), size = length(minus(to, from));
              const n = scaled(across(d), side), centre = dot(d, minus([scene.width / 2, scene.height / 2], from));
              const first = Math.max(0, centre - reach), last = Math.min(size, centre + reach),
                    next = (s) => Math.ceil((passed + s) / u) * u - passed;
              if (shape.style === 'flat' && last > first) text += path([add(from, scaled(d, first)), add(from, scaled(d, last))]);
              for (let s = next(first); s < last; s += u)
                text += path([add(from, scaled(d, s)), add(from, add(scaled(d, s - 0.6 * u), scaled(n, 0.8 * u)))]);
              passed += size;
            }
            hatch.setAttribute('d', text || 'M0 0');
          });
        }
    },
  });
})();
