// The moving machine: bodies of one run, drawn from drawing.json and the poses. symbols.js draws elements. Symbols have a constant size on
// the screen (this.u) at any zoom; bodies have their true size.
steplap.Scene = (() => {
  const make = steplap.make, { add, minus, scaled, length, unit, apply } = steplap.geometry, Box = steplap.Box;
  const margin = 36; // space for symbols around the machine, pixels
  const nearby = 0.75; // a body farther away than this, relative to the size of the machine, may leave the picture
  const most = 6; // largest size of the view, relative to the machine, for including the opening instant
  const symbolSize = (width) => Math.min(11, Math.max(7, width / 70)); // size of a symbol, pixels

  class Body {
    constructor(raw, run) {
      Object.assign(this, { outline: [], circles: [], segments: [], polygons: [], holes: [], pose: [0, 0, 0] }, raw);
      this.run = run;
      const names = ['x', 'y', 'theta'].map((c) => run.channel(`${raw.name}.${c}`));
      this.channels = names.every(Boolean) && !raw.fixed ? names : null;
      // Points of the body whose displacement is examined; for a circle its centre.
      this.points = [
        ...this.outline, ...steplap.partsOf(run, raw.name), ...this.polygons.flat(), ...this.circles.map((c) => [c[0], c[1]]),
        ...this.segments.flatMap((s) => [[s[0], s[1]], [s[2], s[3]]])
      ];
      this.isPoint = !this.points.length;
      this.isLookAlone = !this.isPoint && !this.outline.length && !this.circles.length && !this.segments.length && !this.polygons.length;
      if (this.isPoint) this.points.push([0, 0]);
      this.reach = Math.max(...this.points.map(length), ...this.circles.map((c) => length(c) + c[2]));
      this.moves = this.channels || (run.poseOf && !raw.fixed);
      this.isUnrecorded = !raw.fixed && !this.channels && !run.poseOf && raw.name !== 'ground';
    }
    poseAt(t) {
      if (this.run.poseOf) return this.run.poseOf(this.name, t) || this.pose;
      return this.channels ? this.channels.map((c) => c.at(t)) : this.pose;
    }
    // Returns an upper estimate, m, of the deviation from straight motion between two recorded rows, from the recorded speeds. If it is
    // large, the motion between the rows is unknown.
    guessAt(t) {
      const [x, y] = this.channels || [], speeds = ['vx', 'vy'].map((c) => this.run.channel(`${this.name}.${c}`));
      if (!x || !speeds.every(Boolean)) return 0;
      const i = steplap.data.indexBefore(x.times, t), dt = x.times[i + 1] - x.times[i];
      if (i < 0 || i + 1 >= x.times.length || t - x.times[i] < 1e-6 * dt || x.times[i + 1] - t < 1e-6 * dt) return 0;
      const off = [x, y].map((place, k) => {
        const [v0, v1] = [i, i + 1].map((row) => speeds[k].at(x.times[row]));
        return Math.abs(place.rest[i + 1] - place.rest[i] - 0.5 * dt * (v0 + v1)) + 0.125 * dt * Math.abs(v1 - v0);
      });
      return length(off);
    }
    extend(box, pose) {
      for (const p of this.points) box.take(apply(pose, p));
      for (const c of this.circles) box.take(apply(pose, c), c[2]);
    }
  }

  class Scene {
    constructor(run) {
      this.run = run;
      this.bodies = new Map(run.drawing.bodies.map((b) => [b.name, new Body(b, run)]));
      this.ground = new Body({ name: 'ground', fixed: true, ...run.drawing.ground }, run);
      this.limbs = new Map();
      this.yokes = new Set();
      for (const e of run.drawing.elements)
        if (e.kind === 'step_lap_joint') {
          this.limbs.set(e.limb, e);
          this.yokes.add(e.active_part);
        }
      // In results of earlier versions an element has one symbol instead of shapes.
      this.elements =
        run.drawing.elements.filter((e) => e.symbol !== 'hidden')
          .map((e) => (e.shapes ? e : {...e, shapes: [{ type: e.symbol, at: e.at, direction: e.direction, quantity: 'force' }] }));
      this.byName = new Map(run.drawing.elements.map((e) => [e.name, e]));
      this.view = { zoom: 1, shift: [0, 0] };
      this.withValues = false;
      this.trailsOf = new Set();
      this.moved = new Set();
      this.still = this.boxOf((name) => this.reference(name));
      this.size = Math.max(...this.still.span) || 1;
      this.build();
    }

    // --- reference poses and magnified motion ----------------------------------------------------------
    body(name) { return this.bodies.get(name) || this.ground; }
    reference(name) { return this.body(name).pose; }
    poseAt(name, t) { return this.body(name).poseAt(t); }
    placed(place, poseOf) { return apply(poseOf(place.body), place.point); }
    isHeld(name) { return name === 'ground' || this.body(name).fixed; }
    boxOf(pose) {
      const box = new Box();
      for (const body of this.bodies.values()) body.extend(box, pose(body.name));
      for (const e of this.elements)
        for (const a of e.at)
          if (e.symbol !== 'contact' || a === e.at[0]) box.take(this.placed(a, pose));
      const own = new Box();
      if (!this.ground.isPoint) this.ground.extend(own, [0, 0, 0]);
      if (own.isEmpty) return box.isEmpty ? box.take([-1, -1]).take([1, 1]) : box;
      if (box.isEmpty) return own;
      // Only parts of long tracks and floors near contacts are shown.
      const reach = 0.35 * Math.max(...box.span), low = [...box.low], high = [...box.high];
      for (const end of [own.low, own.high]) box.take(end.map((v, i) => Math.min(Math.max(v, low[i] - reach), high[i] + reach)));
      return box;
    }

    // Returns true if the pose at t is interpolated and may be visibly wrong.
    isGuessed(t) { return [...this.bodies.values()].some((body) => body.guessAt(t) > 0.05 * this.size); }

    // --- view -----------------------------------------------------------------------------------------
    // Returns the poses at some times of the run, for choices that depend on the whole motion.
    samples() {
      const count = this.bodies.size > 200 ? 8 : 60;
      return Array.from({ length: count + 1 }, (_, k) => this.look((this.run.end * k) / count, this.seenFrom, this.magnification));
    }
    // Chooses the reference body, the magnification, and the part of the plane that is shown.
    choose(seenFrom, magnification) {
      this.seenFrom = seenFrom;
      this.magnification = magnification;
      this.poses = this.samples();
      const still = this.boxOf(this.look(0, seenFrom, magnification)), reach = nearby * Math.max(...still.span);
      const near = new Box().take(still.low, reach).take(still.high, reach), box = new Box().take(still.low).take(still.high);
      for (const pose of this.poses)
        for (const body of this.bodies.values()) {
          const own = new Box();
          body.extend(own, pose(body.name));
          for (const corner of [own.low, own.high]) box.take(near.nearest(corner));
        }
      this.takeOpening(box, Math.max(...still.span));
      // Extra space for springs under a body.
      const isBelow = (s) => s.type === 'spring' && this.isTied(s) && this.isHeld(s.at[1].body) && Math.abs(s.direction[1]) > 0.7;
      const isCarried = this.elements.some((e) => e.shapes.some((s) => isBelow(s) && !this.wheelsOf(s.at[1].body).length));
      if (isCarried) box.take([box.middle[0], box.low[1] - 0.12 * this.size]);
      this.trails = null;
      return box;
    }
    // Extends the view to include the machine at the instant at which the page opens.
    takeOpening(box, size) {
      if (this.opening === undefined) return;
      const own = new Box(), pose = this.look(this.opening, this.seenFrom, this.magnification);
      for (const body of this.bodies.values()) body.extend(own, pose(body.name));
      if (!own.isEmpty && Math.max(...box.joined(own).span) < most * size) box.take(own.low).take(own.high);
    }
    // Returns the space for symbols at the sides, top and bottom. The arrow of a load is drawn in front of all bodies that it moves.
    margins(width) {
      const drives = this.elements.flatMap((e) => e.shapes.filter((s) => s.type === 'arrow').map((s) => s.direction || [0, 0]));
      const loads = this.causes().filter(({ shape }) => shape && shape.type === 'arrow');
      const ways = [...drives, ...loads.map((load) => (load.along ? unit(load.along(load.peakAt)) : load.shape.direction))];
      return [0, 1].map((i) => (ways.some((d) => Math.abs(d[i]) > 0.3) ? Math.max(margin, 5.5 * symbolSize(width)) : margin));
    }
    // Fits a box of size `span` around `middle` into a picture of the given size in pixels.
    fit(middle, span, width, tallest, margins = this.margins(width)) {
      this.width = width;
      this.u = symbolSize(width);
      const foot = this.footHeight(),
            scale =
              Math.min((width - 2 * margins[0]) / Math.max(span[0], 1e-9), (tallest - 2 * margins[1] - foot) / Math.max(span[1], 1e-9));
      this.height = Math.max(Math.min(200, tallest), span[1] * scale + 2 * margins[1] + foot);
      this.middle = middle;
      this.fittedScale = scale;
      this.svg.setAttribute('viewBox', `0 0 ${width} ${this.height}`);
      this.setView(this.view);
      this.placeLens();
      this.fitSymbols();
      this.spreadNames();
    }
    // Takes over the view and the positions of names from another picture of the same machine.
    fitLike(other) {
      this.choose(other.seenFrom, other.magnification);
      for (const name of ['width', 'u', 'height', 'middle', 'fittedScale']) this[name] = other[name];
      this.svg.setAttribute('viewBox', `0 0 ${this.width} ${this.height}`);
      this.setView(other.view);
      this.placeLens();
      this.fitSymbols();
      for (const [name, mark] of this.marks) {
        const same = other.marks.get(name);
        if (same) Object.assign(mark, { wanted: same.wanted, places: same.places });
      }
    }
    setView(view) {
      this.view = view;
      this.scale = this.fittedScale * view.zoom;
      this.centre = add(this.middle, view.shift);
    }
    get midHeight() { return 0.5 * (this.height - this.footHeight()); }
    toScreen(p) { return [this.width / 2 + (p[0] - this.centre[0]) * this.scale, this.midHeight - (p[1] - this.centre[1]) * this.scale]; }
    // Converts a point of the screen to the plane.
    toPlane(x, y) { return [this.centre[0] + (x - this.width / 2) / this.scale, this.centre[1] - (y - this.midHeight) / this.scale]; }

    // --- building -----------------------------------------------------------------------------------
    build() {
      this.svg = make('svg', { role: 'img', tabindex: '0', 'aria-label': `Drawing of ${this.run.name}` });
      this.updaters = [];
      this.marks = new Map();
      for (const name of ['ground', 'body', 'ghost', 'trail', 'element', 'force', 'name', 'text', 'legend']) {
        this[`${name}Layer`] = make('g', { class: `${name}s` });
        this.svg.append(this[`${name}Layer`]);
      }
      for (const body of [this.ground, ...this.bodies.values()]) this.buildBody(body);
      this.buildRoads();
      this.buildSymbols();
      this.buildLegend();
      this.buildLens();
    }
    shapesOf(body) {
      const path = (points, isClosed) => make('path', { d: 'M' + points.map((p) => p.join(' ')).join('L') + (isClosed ? 'Z' : '') });
      const shapes = [];
      const rings = [body.outline, ...body.holes].map((ring) => 'M' + ring.map((p) => p.join(' ')).join('L') + 'Z');
      if (body.outline.length > 2) shapes.push(make('path', { d: rings.join(''), 'fill-rule': 'evenodd' }));
      if (body.outline.length === 2) {
        shapes.push(path(body.outline, false));
        shapes[0].classList.add('line');
      }
      for (const corners of body.polygons) shapes.push(path(corners, true));
      for (const [x, y, r, isRing] of body.circles) {
        shapes.push(make('circle', { cx: x, cy: y, r, class: isRing ? 'ring' : 'round' }));
        if (!isRing && body !== this.ground)
          shapes.push(make('path', { d: `M${x} ${y}l${r} 0`, class: 'spoke' })); // a spoke shows the rotation
      }
      for (const [from, to] of this.strutsOf(body)) shapes.push(make('path', { d: `M${from.join(' ')}L${to.join(' ')}`, class: 'strut' }));
      for (const [x0, y0, x1, y1, thickness] of body.segments) shapes.push(this.bar([x0, y0], [x1, y1], thickness));
      return shapes;
    }
    // Returns lines from the outline to points outside it at which contacts and joints act: outriggers, feet, brackets.
    strutsOf(body) {
      if (body.outline.length < 3) return [];
      const struts = [], least = 0.01 * body.reach;
      for (const e of this.elements)
        for (const shape of e.shapes)
          for (const place of shape.at) {
            if (place.body !== body.name || shape.direction === undefined || steplap.forms.isInside(body, place.point)) continue;
            // the second point of a contact defines a line, not a part of the body
            if (shape.type === 'contact' && place !== shape.at[0]) continue;
            if (!['contact', 'spring'].includes(shape.type) || (shape.type === 'spring' && this.isTied(shape))) continue;
            const from = steplap.forms.nearest(body, place.point), far = length(minus(place.point, from));
            if (far > least && far < 2 * body.reach && !struts.some(([, to]) => length(minus(to, place.point)) < least))
              struts.push([from, place.point]);
          }
      return struts;
    }
    // Returns true for a body that encloses others, such as a tank, and is drawn behind them.
    isAround(body) {
      if (body.outline.length < 3 || this.bodies.size > 40) return false;
      const box = new Box(), isWithin = (inner) => [0, 1].every((i) => inner.low[i] > box.low[i] && inner.high[i] < box.high[i]);
      body.extend(box, body.pose);
      return [...this.bodies.values()].some((other) => {
        const inner = new Box();
        other.extend(inner, other.pose);
        return other !== body && !other.isPoint && isWithin(inner);
      });
    }
    // Returns true for a spring along an axis whose end points coincide in the reference pose. It is drawn between outlines (springs.js).
    isTied(shape) {
      const [a, b] = shape.at.map((place) => this.placed(place, (name) => this.reference(name)));
      const d = shape.direction && steplap.geometry.turn(shape.direction, this.reference(shape.at[1].body)[2]);
      return Boolean(d) && Math.abs(steplap.geometry.dot(d, minus(a, b))) < 0.04 * this.size;
    }
    bar(from, to, thickness) {
      if (!(thickness > 0)) return make('path', { d: `M${from.join(' ')}L${to.join(' ')}`, class: 'edge' });
      const r = 0.5 * thickness, d = minus(to, from), n = length(d) > 0 ? scaled([-d[1], d[0]], r / length(d)) : [0, r];
      const arc = (p) => `A${r} ${r} 0 0 0 ${p.join(' ')}`;
      return make('path', { d: `M${add(from, n).join(' ')}${arc(minus(from, n))}L${minus(to, n).join(' ')}${arc(add(to, n))}Z` });
    }
    buildBody(body) {
      const isGround = body === this.ground, joint = this.limbs.get(body.name);
      const group = make('g', { class: isGround ? 'floor' : ['body', ...this.kindsOf(body)].join(' '), 'data-body': body.name },
        make('title', {}, body.label || body.name), ...this.shapesOf(body), ...this.looksShapes(body));
      (isGround ? this.groundLayer : this.bodyLayer).append(group);
      // The centre of gravity is marked if the geometry of the body does not show it.
      const isShown = isGround || body.fixed || body.isLookAlone || body.is_outline_given || body.circles.length || body.polygons.length;
      const centre = isShown ? null : this.centreMark(body);
      if (!isGround) this.addGhost(body);
      if (!isGround && !body.isLookAlone) this.addName(body); // wheels get no name
      const since = joint && this.run.events.find((e) => e[1] === joint.name && (e[4] === 'slip' || e[4] === 'apart'));
      this.updaters.push((t, pose) => {
        const [x, y, angle] = pose(body.name), c = this.scale * Math.cos(angle), s = this.scale * Math.sin(angle);
        const [sx, sy] = this.toScreen([x, y]);
        group.setAttribute('transform', `matrix(${c} ${- s} ${- s} ${- c} ${sx} ${sy})`);
        if (centre) centre.setAttribute('transform', `translate(${sx} ${sy}) scale(${0.5 * this.u})`);
        this.showName(body, pose);
        if (joint) group.classList.toggle('slipped', Boolean((since && t >= since[0]) || this.run.modeAt(joint.name, t) >= 2));
      });
    }
    // Returns the style classes of a body.
    kindsOf(body) {
      const { name } = body, kinds = {
        fixed: body.fixed,
        unrecorded: body.isUnrecorded,
        around: this.isAround(body),
        limb: this.limbs.has(name),
        yoke: this.yokes.has(name),
        tank: this.isTank(name)
      };
      return Object.keys(kinds).filter((kind) => kinds[kind]);
    }
    // Returns the symbol of a centre of gravity: a circle with two filled quadrants.
    centreMark(body) {
      const mark = make('g', { class: 'centre', 'data-centre': body.name }, make('title', {}, body.label || body.name),
        make('circle', { r: 1 }), make('path', { d: 'M0 0V-1A1 1 0 0 1 1 0ZM0 0V1A1 1 0 0 1 -1 0Z' }));
      this.bodyLayer.append(mark);
      return mark;
    }
    hasMoved(name, t) {
      if (!this.moved.has(name)) return false;
      const since = this.run.events.find((e) => e[1] === name && ['slip', 'apart', 'open', 'break'].includes(e[4]));
      return !since || t >= since[0];
    }
    // --- trails of centres of gravity -------------------------------------------------------------------
    setTrails(names) {
      this.trailsOf = new Set(names);
      this.trailLayer.replaceChildren();
      this.trails = null;
    }
    buildTrails() {
      const count = 300;
      this.trails = [...this.trailsOf].filter((name) => this.bodies.has(name)).map((name) => {
        const path = make('path', { class: 'trail', 'data-trail': name });
        this.trailLayer.append(path);
        return { name, path, points: [] };
      });
      for (let k = 0; k <= count; ++k) {
        const pose = this.look((this.run.end * k) / count, this.seenFrom, this.magnification);
        for (const trail of this.trails) trail.points.push(pose(trail.name));
      }
    }
    showTrails(t, pose) {
      if (!this.trails) {
        this.trailLayer.replaceChildren();
        this.buildTrails();
      }
      for (const { name, path, points } of this.trails) {
        const past = points.slice(0, 1 + Math.floor(((points.length - 1) * Math.min(t, this.run.end)) / this.run.end));
        path.setAttribute('d', this.poly([...past, pose(name)]));
      }
    }
    poly(points) { return 'M' + points.map((p) => this.toScreen(p).map((v) => v.toFixed(2)).join(' ')).join('L'); }

    show(t) {
      const pose = this.look(t, this.seenFrom, this.magnification);
      this.settleNames(pose);
      for (const update of this.updaters) update(t, pose);
      if (this.trailsOf.size) this.showTrails(t, pose);
      this.showLegend(t);
    }
  }

  // Gives all pictures of similar size the same scale, and the same part of the plane if they show the same place.
  Scene.fitAll = (scenes, seenFrom, magnification, widths, tallest) => {
    const boxes = scenes.map((scene) => scene.choose(seenFrom, magnification));
    const whole = boxes.reduce((a, b) => a.joined(b));
    const span = [0, 1].map((i) => Math.max(...boxes.map((b) => b.span[i])));
    const isSamePlace = [0, 1].every((i) => whole.span[i] <= 1.4 * span[i] + 0.2 * Math.max(...span));
    const width = Math.min(...widths), sizes = boxes.map((b) => Math.max(...b.span)), all = scenes.map((scene) => scene.margins(width)),
          margins = [0, 1].map((i) => Math.max(...all.map((m) => m[i])));
    const isAlike = Math.max(...sizes) < 5 * Math.min(...sizes);
    if (!isAlike) scenes.forEach((scene, k) => scene.fit(boxes[k].middle, boxes[k].span, width, tallest));
    else
      scenes.forEach(
        (scene, k) => scene.fit(isSamePlace ? whole.middle : boxes[k].middle, isSamePlace ? whole.span : span, width, tallest, margins));
  };
  return Scene;
})();
