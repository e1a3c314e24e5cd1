// The moving machine: bodies, elements and joints of one run, drawn from drawing.json and the poses.
steplap.Scene = (() => {
  const make = steplap.make;
  const margin = 14;

  const turn = (p, angle) => {
    const c = Math.cos(angle), s = Math.sin(angle);
    return [c * p[0] - s * p[1], s * p[0] + c * p[1]];
  };
  const add = (a, b) => [a[0] + b[0], a[1] + b[1]];
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];
  const scaled = (a, k) => [k * a[0], k * a[1]];
  const length = (a) => Math.hypot(a[0], a[1]);
  const unit = (a) => (length(a) > 0 ? scaled(a, 1 / length(a)) : [0, 1]);
  const apply = (pose, p) => add([pose[0], pose[1]], turn(p, pose[2]));
  // Pose of b as the frame a sees it.
  const relative = (a, b) => [...turn([b[0] - a[0], b[1] - a[1]], -a[2]), b[2] - a[2]];

  class Body {
    constructor(raw, run) {
      Object.assign(this, raw);
      const names = ['x', 'y', 'theta'].map((c) => run.channel(`${raw.name}.${c}`));
      this.channels = names.every(Boolean) && !raw.fixed ? names : null;
    }
    poseAt(t) { return this.channels ? this.channels.map((c) => c.at(t)) : this.pose; }
  }

  class Scene {
    // `width`: of the drawing's own coordinates; texts look the larger the smaller it is.
    constructor(run, width) {
      this.run = run;
      this.width = width;
      this.bodies = new Map(run.drawing.bodies.map((b) => [b.name, new Body(b, run)]));
      this.limbs = new Set(run.drawing.sheets.map((s) => s.limb));
      this.elements = run.drawing.elements.filter((e) => e.symbol !== 'hidden');
      this.byName = new Map(run.drawing.elements.map((e) => [e.name, e]));
      this.frame();
      this.build();
    }

    // --- what is seen: reference poses, magnified differences ----------------------------------------
    frame() {
      const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
      const take = (p) => { for (const i of [0, 1]) { low[i] = Math.min(low[i], p[i]); high[i] = Math.max(high[i], p[i]); } };
      for (const body of this.bodies.values()) for (const p of body.outline) take(apply(body.pose, p));
      for (const e of this.elements) for (const a of e.at) take(this.placed(a, (n) => this.reference(n)));
      if (!isFinite(low[0])) { take([-1, -1]); take([1, 1]); }
      this.stillLow = low; this.stillHigh = high;
      const spans = [high[0] - low[0], high[1] - low[1]];
      this.size = Math.max(...spans, 1e-6);
      this.symbolSize = Math.min(this.size, Math.max(1.6 * Math.min(...spans), 0.25 * this.size));
    }
    reference(name) { const body = this.bodies.get(name); return body ? body.pose : [0, 0, 0]; }
    poseAt(name, t) { const body = this.bodies.get(name); return body ? body.poseAt(t) : [0, 0, 0]; }
    placed(place, poseOf) { return apply(poseOf(place.body), place.point); }

    // Largest displacement of any outline against the reference, seen from a body.
    largestDisplacement(seenFrom) {
      let largest = 0;
      const r0 = this.reference(seenFrom);
      for (let k = 0; k <= 120; ++k) {
        const t = (this.run.end * k) / 120, r = this.poseAt(seenFrom, t);
        for (const body of this.bodies.values()) {
          if (!body.channels) continue;
          const a = relative(r0, body.pose), b = relative(r, body.poseAt(t));
          for (const p of body.outline) largest = Math.max(largest, length(minus(apply(b, p), apply(a, p))));
        }
      }
      return largest;
    }
    // The vehicle that a drive moves, or the body from which least is seen to move, where that is much less
    // than from the ground.
    usualStandpoint() {
      const wanted = this.run.drawing.seen_from;
      if (wanted) return wanted;
      let best = 'ground', least = 0.3 * this.largestDisplacement('ground');
      if (this.bodies.size < 2 || this.bodies.size > 12) return best; // nothing moves against itself
      const drive = this.elements.find((e) => e.kind === 'prescribed_motion' && e.at.length > 1 && e.at[1].body === 'ground');
      if (drive && this.largestDisplacement(drive.at[0].body) < least) return drive.at[0].body;
      for (const name of this.bodies.keys()) {
        const d = this.largestDisplacement(name);
        if (d < least) { best = name; least = d; }
      }
      return best;
    }
    // 1, 2, 5, 10 …: the largest displacement becomes some twentieth of the picture.
    usualMagnification(seenFrom) {
      const wanted = (0.06 * this.size) / Math.max(this.largestDisplacement(seenFrom), 1e-12);
      if (!(wanted > 1.5)) return 1;
      const power = 10 ** Math.floor(Math.log10(wanted));
      return Math.min(1e5, power * (wanted / power >= 5 ? 5 : wanted / power >= 2 ? 2 : 1));
    }
    // Poses as drawn at time t.
    look(t, seenFrom, magnification) {
      const r0 = this.reference(seenFrom), r = this.poseAt(seenFrom, t);
      const cache = new Map();
      return (name) => {
        if (cache.has(name)) return cache.get(name);
        const a = relative(r0, this.reference(name)), b = relative(r, this.poseAt(name, t));
        const drawn = a.map((v, i) => v + magnification * (b[i] - v));
        const pose = [...apply(r0, drawn), drawn[2] + r0[2]];
        cache.set(name, pose);
        return pose;
      };
    }

    // --- building -----------------------------------------------------------------------------------
    // Room for all that moves, at the magnification chosen.
    fit(seenFrom, magnification) {
      const low = [...this.stillLow], high = [...this.stillHigh];
      for (let k = 0; k <= 60; ++k) {
        const pose = this.look((this.run.end * k) / 60, seenFrom, magnification);
        for (const body of this.bodies.values())
          for (const p of body.outline) {
            const q = apply(pose(body.name), p);
            for (const i of [0, 1]) { low[i] = Math.min(low[i], q[i]); high[i] = Math.max(high[i], q[i]); }
          }
      }
      for (const i of [0, 1]) { low[i] -= 0.05 * this.size; high[i] += 0.05 * this.size; } // for symbols
      const span = [high[0] - low[0], high[1] - low[1]];
      this.scale = (this.width - 2 * margin) / Math.max(span[0], 0.9 * span[1], 1e-6);
      const height = Math.max(240, span[1] * this.scale + 2 * margin);
      const middle = 0.5 * (low[0] + high[0]);
      this.toScreen = (p) => [this.width / 2 + (p[0] - middle) * this.scale, height - margin - (p[1] - low[1]) * this.scale];
      this.svg.setAttribute('viewBox', `0 0 ${this.width} ${height}`);
      this.spreadMarks();
    }
    build() {
      this.svg = make('svg', { role: 'img', 'aria-label': `Drawing of ${this.run.name}` });
      this.updaters = [];
      this.marks = new Map();
      const layers = ['bodies', 'elements', 'texts'].map((name) => make('g', { class: name }));
      [this.bodyLayer, this.elementLayer, this.textLayer] = layers;
      this.svg.append(...layers);
      let number = 0;
      for (const body of this.bodies.values()) this.buildBody(body, ++number);
      for (const element of this.elements) this.buildElement(element);
    }
    // Marks of bodies whose centres lie together are set apart, as far as need be; small bodies keep theirs.
    spreadMarks() {
      const extent = (name) => { const points = this.bodies.get(name).outline; return Math.max(...points.map(length)); };
      const taken = [];
      for (const [name, mark] of [...this.marks].sort((a, b) => extent(a[0]) - extent(b[0]))) {
        const [x, y] = this.toScreen(this.reference(name));
        const isFree = ([dx, dy]) => taken.every((p) => Math.hypot(p[0] - x - dx, p[1] - y - dy) > 24);
        const ring = (r) => [...Array(8).keys()].map((k) => [r * Math.cos((k * Math.PI) / 4), r * Math.sin((k * Math.PI) / 4)]);
        mark.shift = [[0, 0], ...ring(26), ...ring(50), ...ring(76)].find(isFree) || [0, 0];
        taken.push([x + mark.shift[0], y + mark.shift[1]]);
      }
    }
    buildBody(body, number) {
      const isLine = body.outline.length < 3;
      const shape = make('path', { class: `body${isLine ? ' line' : ''}${this.limbs.has(body.name) ? ' limb' : ''}`, 'data-body': body.name,
        d: 'M' + body.outline.map((p) => p.join(' ')).join('L') + (isLine ? '' : 'Z') }, make('title', {}, body.label || body.name));
      this.bodyLayer.append(shape);
      const mark = this.bodies.size <= 40 ? make('g', {}, make('circle', { r: 10, class: 'number-mark' }), make('text', { class: 'number-text' }, number)) : null;
      if (mark) {
        this.textLayer.append(mark);
        this.marks.set(body.name, { shift: [0, 0], element: mark });
      }
      const joint = this.run.drawing.elements.find((e) => e.kind === 'step_lap_joint' && e.limb === body.name);
      const since = joint && this.run.events.find((e) => e[1] === joint.name && (e[4] === 'slip' || e[4] === 'apart'));
      this.updaters.push((t, pose) => {
        const [x, y, angle] = pose(body.name), c = this.scale * Math.cos(angle), s = this.scale * Math.sin(angle);
        const [sx, sy] = this.toScreen([x, y]);
        shape.setAttribute('transform', `matrix(${c} ${-s} ${-s} ${-c} ${sx} ${sy})`);
        if (mark) {
          const [dx, dy] = this.marks.get(body.name).shift;
          mark.setAttribute('transform', `translate(${sx + dx} ${sy + dy})`);
        }
        if (joint) shape.classList.toggle('slipped', Boolean((since && t >= since[0]) || this.run.modeAt(joint.name, t) >= 2));
      });
    }
    buildElement(element) {
      const builders = { spring: this.spring, contact: this.contact, friction: this.friction, pin: this.pin, rail: this.rail,
        rod: this.rod, weld: this.weld, arrow: this.arrow };
      if (builders[element.symbol]) builders[element.symbol].call(this, element);
    }
    path(element, attributes) {
      const path = make('path', { class: 'symbol', 'data-element': element.name, ...attributes }, make('title', {}, element.name));
      this.elementLayer.append(path);
      return path;
    }
    ends(element, pose) {
      const at = element.at.map((a) => this.placed(a, pose));
      return at.length > 1 ? at : [at[0], at[0]];
    }
    // In ground axes, as drawn.
    direction(element, pose) {
      const last = element.at[element.at.length - 1];
      return element.direction && last ? turn(element.direction, pose(last.body)[2]) : null;
    }
    poly(points) { return 'M' + points.map((p) => this.toScreen(p).map((v) => v.toFixed(2)).join(' ')).join('L'); }

    // A zigzag from b to a. One along a fixed axis is drawn at a, as long as the distance along the axis and
    // at least so long that it can be seen.
    spring(element) {
      if (!element.at.length) return;
      const path = this.path(element), reference = (name) => this.reference(name);
      const along = (pose) => {
        const [a, b] = this.ends(element, pose), axis = this.direction(element, pose);
        return axis[0] * (a[0] - b[0]) + axis[1] * (a[1] - b[1]);
      };
      const still = element.direction ? along(reference) : 0;
      const least = Math.max(0, 0.05 * this.symbolSize - Math.abs(still)) * (still < 0 ? -1 : 1);
      this.updaters.push((t, pose) => {
        let [a, b] = this.ends(element, pose);
        const axis = this.direction(element, pose);
        if (axis) b = minus(a, scaled(axis, along(pose) + least));
        const d = minus(a, b), n = scaled(unit([-d[1], d[0]]), 0.012 * this.symbolSize);
        const points = [b, add(b, scaled(d, 0.15))];
        for (let k = 0; k < 8; ++k) points.push(add(add(b, scaled(d, 0.2 + 0.08 * k)), scaled(n, k % 2 ? -1 : 1)));
        points.push(add(b, scaled(d, 0.85)), a);
        path.setAttribute('d', this.poly(points));
      });
    }
    // A wedge at a on the line of b, filled while it presses; the force as a line along the normal.
    contact(element) {
      if (!element.at.length) return;
      const surface = this.path(element, { class: 'surface' }), wedge = this.path(element, { class: 'contact' }), bar = this.path(element, { class: 'force' });
      const force = this.run.channel(`${element.name}.force`);
      const extreme = this.run.summary.extremes[`${element.name}.force`];
      const largest = extreme ? Math.max(Math.abs(extreme.min), Math.abs(extreme.max), 1e-30) : 1;
      this.updaters.push((t, pose) => {
        const [a, b] = this.ends(element, pose), n = this.direction(element, pose) || unit(minus(a, b));
        const along = [-n[1], n[0]], w = 0.022 * this.symbolSize, foot = minus(a, scaled(n, n[0] * (a[0] - b[0]) + n[1] * (a[1] - b[1])));
        const f = force ? force.at(t) : 0;
        wedge.setAttribute('d', this.poly([a, add(add(a, scaled(n, 1.3 * w)), scaled(along, 0.7 * w)), add(add(a, scaled(n, 1.3 * w)), scaled(along, -0.7 * w))]) + 'Z');
        wedge.classList.toggle('closed', f > 0);
        surface.setAttribute('d', this.poly([add(foot, scaled(along, 1.6 * w)), add(foot, scaled(along, -1.6 * w))]));
        bar.setAttribute('d', f > 0 ? this.poly([add(a, scaled(n, 1.3 * w)), add(a, scaled(n, 1.3 * w + 0.1 * this.symbolSize * (f / largest)))]) : 'M0 0');
      });
    }
    // What friction does, in words, between the contacts it sits on.
    friction(element) {
      const places = (element.contacts || []).map((name) => this.byName.get(name)).filter((e) => e && e.at.length).map((e) => e.at[0]);
      const rate = this.run.channel(`${element.name}.slip_rate`);
      if (!places.length || !this.run.channel(`${element.name}.mode`)) return;
      const text = make('text', { class: 'state-text', 'data-element': element.name });
      this.textLayer.append(text);
      this.updaters.push((t, pose) => {
        const sum = places.map((p) => this.placed(p, pose)).reduce(add);
        const [x, y] = this.toScreen(scaled(sum, 1 / places.length)), m = this.run.modeAt(element.name, t);
        const state = m === 1 ? 'sticks' : m === 2 ? 'slips' : 'free';
        const arrow = m === 2 && rate ? (rate.at(t) >= 0 ? ' →' : ' ←') : '';
        text.textContent = `${element.name}: ${state}${arrow}`;
        text.setAttribute('class', `state-text ${state}`);
        const marks = [...this.marks.keys()].map((name) => { const q = this.toScreen(pose(name)), d = this.marks.get(name).shift; return [q[0] + d[0], q[1] + d[1]]; });
        const isFree = (dy) => marks.every((q) => Math.abs(q[1] - y - dy) > 18 || Math.abs(q[0] - x) > 16 + 4 * text.textContent.length);
        text.setAttribute('x', x); text.setAttribute('y', y + ([18, 40, -14, 62, 84].find(isFree) || 18));
      });
    }
    pin(element) {
      if (!element.at.length) return;
      const circle = make('circle', { r: 5, class: 'symbol', style: 'fill:#fff', 'data-element': element.name }, make('title', {}, element.name));
      this.elementLayer.append(circle);
      this.updaters.push((t, pose) => {
        const [x, y] = this.toScreen(this.ends(element, pose)[0]);
        circle.setAttribute('cx', x); circle.setAttribute('cy', y);
      });
    }
    rail(element) {
      if (!element.at.length) return;
      const path = this.path(element, { class: 'symbol', 'stroke-dasharray': '6 4' });
      this.updaters.push((t, pose) => {
        const [a, b] = this.ends(element, pose), d = scaled(this.direction(element, pose) || [1, 0], 0.07 * this.symbolSize);
        path.setAttribute('d', this.poly([minus(b, d), add(b, d)]) + this.poly([a, add(a, scaled(d, 1e-3))]));
      });
    }
    rod(element) {
      if (element.at.length < 2) return;
      const path = this.path(element);
      this.updaters.push((t, pose) => path.setAttribute('d', this.poly(this.ends(element, pose))));
    }
    weld(element) {
      if (!element.at.length) return;
      const path = this.path(element, { class: 'symbol', style: 'fill:#1a1a1a' });
      this.updaters.push((t, pose) => {
        const [x, y] = this.toScreen(this.ends(element, pose)[0]);
        path.setAttribute('d', `M${x - 4} ${y - 4}h8v8h-8Z`);
      });
    }
    arrow(element) {
      if (!element.at.length) return;
      const path = this.path(element);
      this.updaters.push((t, pose) => {
        const a = this.ends(element, pose)[0], d = scaled(this.direction(element, pose) || [1, 0], 0.06 * this.symbolSize);
        const tip = add(a, d), back = scaled(d, -0.3), side = [-back[1] * 0.6, back[0] * 0.6];
        path.setAttribute('d', this.poly([a, tip]) + this.poly([add(add(tip, back), side), tip, minus(add(tip, back), side)]));
      });
    }

    show(t, seenFrom, magnification) {
      const pose = this.look(t, seenFrom, magnification);
      for (const update of this.updaters) update(t, pose);
    }
  }
  Scene.geometry = { turn, add, minus, scaled, length, unit, apply, relative };
  return Scene;
})();
