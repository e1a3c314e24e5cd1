// Draws the elements between bodies: springs, ropes, contacts with their half-planes, joints, motors, loads, forces with their values. Each
// type of shape in drawing.json (mbd/run/sketch.h) has one method of Symbols.
steplap.Symbols = (() => {
  const make = steplap.make, { turn, add, minus, scaled, dot, length, unit, seenIn } = steplap.geometry;
  const path = (points, isClosed) => 'M' + points.map((p) => `${p[0].toFixed(2)} ${p[1].toFixed(2)}`).join('L') + (isClosed ? 'Z' : '');
  const across = (d) => [-d[1], d[0]];
  const flipped = (d) => [d[0], -d[1]]; // converts a direction between plane and screen
  const along = (a, b, k) => add(a, scaled(minus(b, a), k));
  const arrowHead = (tip, d, size) => path(
    [
      add(tip, add(scaled(d, -size), scaled(across(d), 0.45 * size))), tip, add(tip, add(scaled(d, -size), scaled(across(d), -0.45 * size)))
    ],
    true);

  const larger = 2; // a body this many times larger than a text is not hidden by the text
  const near = 60; // largest distance, pixels, from an element to a text that must not cover small parts
  const mostParts = 200; // largest number of bodies for which texts avoid small parts
  const isApart = ([x, y], [width, height], [qx, qy, w, h]) =>
    Math.abs(qy - y) >= 0.5 * (h + height) || Math.abs(qx - x) >= 0.5 * (w + width);
  // Returns the shifts of a text of this width from its position, pixels: above, below, beside; nearest first.
  steplap.waysAround = (width) => {
    const rows = Array.from({ length: 14 }, (_, k) => (k % 2 ? 1 : -1) * (16 + 18 * Math.floor(k / 2))),
          columns = [0, 0.6, -0.6, 1.2, -1.2].map((k) => k * width);
    const found = [...columns.flatMap((dx) => rows.map((dy) => [dx, dy])), ...columns.slice(1).map((dx) => [dx, 0])];
    return found.sort((a, b) => length(a) - length(b));
  };

  class Symbols {
    constructor(scene) {
      this.scene = scene;
      this.wanted = []; // requested values that have no position yet
      this.shownValues = { shown: 0, all: 0 };
      this.springs = []; // placed springs { element, shape }, with their positions
      this.pieces = new Map(); // drawn parts by the name of their element
      this.taken = []; // pixels occupied in the reference pose
      this.pins = scene.elements.flatMap((e) => e.shapes.filter((s) => s.type === 'pin' && s.at.length > 1));
      this.planes = (scene.run.drawing.planes || []).map((plane) => ({...plane, feet: [] }));
      for (const element of scene.elements)
        for (const shape of element.shapes) {
          if (!this.planes[shape.plane]) continue;
          const own = shape.type === 'faces' && shape.at.length === 2
            ? scene.body(shape.at[0].body).points.map((point) => ({ body: shape.at[0].body, point }))
            : null;
          this.planes[shape.plane].feet.push(...(own || shape.at.slice(0, -1)));
        }
      this.frictions = scene.elements.filter((e) => e.shapes.some((shape) => shape.type === 'friction')).length;
      this.planes.forEach((plane) => this.halfPlane(plane));
      this.sheets();
      this.roads();
      for (const element of scene.elements)
        for (const shape of element.shapes) {
          const draw = Symbols.types[shape.type] || (shape.at.length ? Symbols.types.neutral : null);
          if (draw && (shape.at.length || shape.type === 'friction')) draw.call(this, element, shape);
        }
      this.loadsWithoutElement();
    }
    get u() { return this.scene.u; }
    screen(place, pose) { return this.scene.toScreen(this.scene.placed(place, pose)); }
    ends(shape, pose) {
      const at = shape.at.map((a) => this.screen(a, pose));
      return at.length > 1 ? at : [at[0], at[0]];
    }
    // Returns the direction of a shape on the screen; the x axis if it has none.
    direction(shape, pose) {
      const last = shape.at[shape.at.length - 1];
      return flipped(turn(shape.direction || [1, 0], pose(last.body)[2]));
    }
    update(f) { this.scene.updaters.push(f); }
    channel(element, shape) { return shape.quantity ? this.scene.run.channel(`${element.name}.${shape.quantity}`) : undefined; }
    piece(element, attributes, layer = this.scene.elementLayer, name = 'path') {
      const node = make(name, { class: 'symbol', 'data-element': element.name, ...attributes }, make('title', {}, element.name));
      layer.append(node);
      this.pieces.set(element.name, [...(this.pieces.get(element.name) || []), node]);
      return node;
    }
    // Colours elements from the instant at which they lifted, opened or broke.
    showMoved(t) {
      for (const name of this.scene.moved)
        for (const node of this.pieces.get(name) || [])
          if (!node.classList.contains('force')) node.classList.toggle('moved', this.scene.hasMoved(name, t));
    }
    // Returns the length of a force arrow in pixels. All scenes have the same scale.
    arrowLength(force) { return (8 * this.u * Math.abs(force)) / (this.scene.largestForce || 1); }
    // Draws an arrow whose tip (or, if `isPulling`, start) is at the point of action, optionally with its value. `where` returns { at, d,
    // force }: position and direction on the screen, and the force, N.
    force(element, shape, where, isPulling = false) {
      const channel = this.channel(element, shape);
      if (!channel) return;
      const arrow = this.piece(element, { class: 'force' }, this.scene.forceLayer);
      const text = this.value(element);
      this.update((t, pose) => {
        const { at, d, force } = where(t, pose, channel);
        const size = this.arrowLength(force), tip = isPulling ? add(at, scaled(d, size)) : at,
              tail = isPulling ? at : minus(at, scaled(d, size));
        arrow.setAttribute('d', size > 0.5 ? path([tail, tip]) + arrowHead(tip, d, Math.min(0.7 * this.u, size)) : 'M0 0');
        this.showValue(text,
          Math.abs(force) > 1e-6 * this.scene.largestForce ? steplap.data.quantity(Math.abs(force), channel.unit, 4) : '',
          isPulling ? tip : tail, isPulling ? d : scaled(d, -1), Math.abs(force));
      });
    }
    value(element) {
      const text = make('text', { class: 'value-text', 'data-value-of': element.name });
      this.scene.textLayer.append(text);
      return text;
    }
    // Requests a text at the tip of an arrow along d, or as near as possible. All requested texts are placed together.
    showValue(text, content, at, d, weight = Infinity) {
      text.textContent = '';
      if (this.scene.withValues && content) this.wanted.push({ text, content, at, d, weight });
    }
    // Places the requested values, the largest first. Values without room are omitted, and the legend shows their number (legend.js).
    placeValues() {
      const all = this.wanted.sort((a, b) => b.weight - a.weight);
      let shown = 0;
      for (const { text, content, at, d } of all) {
        const width = 6.9 * content.length, side = Math.abs(d[0]) < 0.5 ? 0 : Math.sign(d[0]);
        const x = at[0] + side * (0.6 * this.u + 0.5 * width), y = at[1] + (side ? 0 : d[1] > 0 ? 10 : -9);
        const place = this.room([x, y], [width, 12],
          [[0, 0], [0, -14], [0, 14], [0.7 * width, 0], [-0.7 * width, 0], [0, -28], [0, 28], [0.7 * width, 14], [-0.7 * width, 14]]);
        if (!place) continue;
        ++shown;
        text.textContent = content;
        this.write(text, place);
      }
      this.shownValues = { shown, all: all.length };
      this.wanted = [];
    }
    write(text, { at: [x, y], size: [, height] }) {
      text.setAttribute('x', x.toFixed(1));
      text.setAttribute('y', (y + 0.32 * height).toFixed(1));
    }
    // Centres a text near a position without covering marks, texts and small parts. Omits it if there is no such position.
    put(text, at, size, ways = steplap.waysAround(size[0])) {
      const place = this.room(at, size, ways);
      if (place) this.write(text, place);
      else text.textContent = '';
    }

    isFree(at, size) { return this.scene.takenTexts.every((other) => isApart(at, size, other)); }
    // Returns true if the text covers no small part. It may cover a body that is much larger than the text.
    isClearOfParts(at, [width, height]) {
      return this.scene.partBoxes.every(
        ([x, y, w, h]) => (w > larger * width && h > larger * height) || isApart(at, [width, height], [x, y, w, h]));
    }
    onPicture([x, y], [width, height]) {
      const { scene } = this, half = 0.5 * width + 2;
      return [
        Math.min(Math.max(x, half), Math.max(half, scene.width - half)),
        Math.min(Math.max(y, 0.5 * height + 1), scene.height - scene.footHeight() - 0.5 * height)
      ];
    }
    take(at, size) {
      this.scene.takenTexts.push([...at, ...size]);
      return { at, size };
    }
    // Returns the first of the shifted positions that is inside the picture and covers no mark or text, if possible also no small part;
    // null if there is none.
    room(at, size, shifts) {
      const free = shifts.map((shift) => this.onPicture(add(at, shift), size)).filter((place) => this.isFree(place, size));
      const place = free.find((p) => length(minus(p, at)) < near && this.isClearOfParts(p, size)) || free[0];
      return place ? this.take(place, size) : null;
    }

    // --- half-planes --------------------------------------------------------------------------------------
    // Draws a half-plane as far as contacts touch it, hatched on the solid side. Nothing is drawn if a body's outline shows it.
    halfPlane(plane) {
      const scene = this.scene;
      if (scene.body(plane.body).is_outline_given || !plane.feet.length) return;
      const line = make('path', { class: 'plane', 'data-plane-of': plane.body }), hatch = make('path', { class: 'hatch' });
      scene.groundLayer.append(line, hatch);
      const tangent = across(plane.normal);
      plane.fit = () => {
        plane.range = plane.ends ? [-plane.ends[1], -plane.ends[0]] : [Infinity, -Infinity];
        if (plane.ends) return;
        for (const pose of scene.poses)
          for (const foot of plane.feet) {
            const s = dot(tangent, minus(seenIn(pose(plane.body), scene.placed(foot, pose)), plane.point));
            plane.range = [Math.min(plane.range[0], s), Math.max(plane.range[1], s)];
          }
      };
      this.update((t, pose) => {
        const middle = this.screen(plane, pose), d = flipped(turn(tangent, pose(plane.body)[2])),
              down = scaled(flipped(turn(plane.normal, pose(plane.body)[2])), -1);
        // limits the line to the picture, because a floor may be very long
        const centre = dot(d, minus([scene.width / 2, scene.height / 2], middle)), reach = scene.width + scene.height;
        const beyond = plane.ends ? 0 : 3 * this.u, from = Math.max(plane.range[0] * scene.scale - beyond, centre - reach),
              to = Math.min(plane.range[1] * scene.scale + beyond, centre + reach);
        if (!(to > from)) {
          line.setAttribute('d', 'M0 0');
          hatch.setAttribute('d', 'M0 0');
          return;
        }
        const at = (s) => add(middle, scaled(d, s)), slant = scaled(add(scaled(d, -0.7), down), 0.8 * this.u);
        let strokes = '';
        for (let s = Math.ceil(from / (0.9 * this.u)) * 0.9 * this.u; s < to; s += 0.9 * this.u)
          strokes += path([at(s), add(at(s), slant)]);
        line.setAttribute('d', path([at(from), at(to)]));
        hatch.setAttribute('d', strokes || 'M0 0');
      });
    }
    fit() {
      for (const plane of this.planes)
        if (plane.fit) plane.fit();
      this.placeSprings();
    }

    // Draws the corners of step-lap joints, where sheets overlap.
    sheets() {
      const { scene } = this;
      // Only strips along the mitre are drawn; whole sheets would cross the windows of the core.
      const span = (ring) => new steplap.Box().joined(ring.reduce((box, p) => box.take(p), new steplap.Box())).span;
      for (const sheet of steplap.data.corners(scene.run).filter((s) => Math.max(...span(s.limb_sheet)) < 0.5 * scene.body(s.limb).reach))
        for (const [name, owner, ring] of [['yoke', sheet.active_part, sheet.yoke], ['limb', sheet.limb, sheet.limb_sheet]]) {
          const outline = make('path', { class: `sheet ${name}`, 'data-sheet': sheet.name });
          scene.bodyLayer.append(outline);
          this.update((t, pose) => outline.setAttribute('d', path(ring.map((point) => this.screen({ body: owner, point }, pose)), true)));
        }
    }

    // --- springs, ropes ---------------------------------------------------------------------------------------
    // Draws a spring from b to a, at the position chosen by springs.js.
    spring(element, shape) {
      const bar = this.piece(element, { class: `symbol spring ${shape.style || ''}` }), own = { element, shape };
      this.springs.push(own);
      const drawn = {
        '': zigzag,
        both: (a, b, u) => shifted(a, b, 0.7 * u, zigzag, 0.6 * u) + shifted(a, b, -0.7 * u, dashpot, 0.6 * u) + yokes(a, b, 0.7 * u),
        damper: dashpot,
        tie: plates,
        cylinder
      }[shape.style || ''] ||
        zigzag;
      this.update((t, pose) => {
        const [a, b] = this.springEnds(own, pose);
        bar.setAttribute('d', drawn(a, b, this.u) + this.anchor(own, a, b));
      });
      const channel = this.channel(element, shape);
      if (!channel) return;
      const text = this.value(element);
      this.update((t, pose) => {
        const [a, b] = this.springEnds(own, pose);
        this.showValue(text, steplap.data.quantity(channel.at(t), channel.unit, 4), add(along(a, b, 0.5), [1.1 * this.u, 0]), [1, 0]);
      });
    }
    rope(element, shape) {
      const line = this.piece(element, { class: 'symbol rope' }), tension = this.channel(element, shape), text = this.value(element);
      this.update((t, pose) => {
        const centres = shape.at.map((a) => this.screen(a, pose)), force = tension ? tension.at(t) : 1;
        const points = shape.sizes ? this.tangent(centres, shape.sizes) : centres;
        line.setAttribute('d', path(points));
        line.classList.toggle('slack', !(force > 0));
        this.showValue(text, tension ? steplap.data.quantity(force, tension.unit, 4) : '', along(points[0], points[1], 0.5), [1, 0]);
      });
      for (const pulley of shape.at.slice(1, -1)) this.dot(element, pulley, 'pulley', 0.6);
    }

    // Returns the points at which a rope leaves two wheels. A radius is positive if counter-clockwise rotation winds up the rope
    // (elements/machinery/wound_rope.h).
    tangent([a, b], [ra, rb]) {
      const d = scaled(flipped(minus(b, a)), 1 / this.scene.scale), square = dot(d, d), c = ra + rb,
            length = Math.sqrt(Math.max(0, square - c * c));
      if (!(square > 0)) return [a, b];
      const n = scaled([c * d[0] - length * d[1], c * d[1] + length * d[0]], this.scene.scale / square);
      return [add(a, flipped(scaled(n, ra))), minus(b, flipped(scaled(n, rb)))];
    }

    // --- contacts ---------------------------------------------------------------------------------------------
    // A contact: a wedge at the touching point, filled while it is pressed, a tick of the line below it, and the force on the touching
    // body.
    contact(element, shape) {
      const tick = this.piece(element, { class: 'surface' }), wedge = this.piece(element, { class: 'contact' }),
            force = this.channel(element, shape);
      const hasLine = shape.plane !== undefined && !this.scene.body(this.planes[shape.plane].body).is_outline_given;
      const places = (pose) => {
        const [a, b] = this.ends(shape, pose), n = shape.direction ? this.direction(shape, pose) : unit(minus(a, b));
        return { a, n, foot: minus(a, scaled(n, dot(n, minus(a, b)))) };
      };
      this.update((t, pose) => {
        const { a, n, foot } = places(pose), w = 0.75 * this.u;
        wedge.setAttribute('d',
          path(
            [a, add(a, add(scaled(n, 1.1 * w), scaled(across(n), 0.6 * w))), add(a, add(scaled(n, 1.1 * w), scaled(across(n), -0.6 * w)))],
            true));
        wedge.classList.toggle('closed', Boolean(force) && force.at(t) > 0);
        if (!hasLine) tick.setAttribute('d', path([add(foot, scaled(across(n), 1.4 * w)), minus(foot, scaled(across(n), 1.4 * w))]));
      });
      this.force(element, shape, (t, pose, channel) => {
        const { a, n } = places(pose);
        return { at: add(a, scaled(n, 0.85 * this.u)), d: n, force: channel.at(t) };
      }, true);
    }
    // Draws a contact between outlines: the force on a, at the middle of the touching edge. The true line of action is not recorded; on an
    // unevenly loaded face it is nearer to the end with more load.
    faces(element, shape) {
      const places = shape.at.slice(0, -1), frame = shape.at[shape.at.length - 1];
      const corners = (own, pose) => own.map((place) => this.screen(place, pose));
      const outline = (name) => {
        const body = this.scene.body(name);
        return (body.outline.length ? body.outline : body.polygons.flat()).map((point) => ({ body: name, point }));
      };
      const of = { a: places.length > 2 ? places : outline(places[0].body), b: shape.direction ? [] : outline(frame.body) };
      this.force(element, shape, (t, pose, channel) => {
        const a = corners(of.a, pose), origin = this.screen(frame, pose);
        const found = shape.direction ? steplap.geometry.lowest(this.direction(shape, pose), origin, a)
                                      : steplap.geometry.facing(a, corners(of.b, pose));
        return found ? { at: found.at, d: found.n, force: channel.at(t) } : { at: origin, d: [0, -1], force: 0 };
      }, true);
    }
    // Draws a contact of a circle with a circle or an edge: a dot while it is closed, and the force on a.
    touching(element, shape, where) {
      const dot = this.dotOf(element, 'touch'), force = this.channel(element, shape);
      this.update((t, pose) => {
        const { at } = where(pose), isClosed = Boolean(force) && force.at(t) > 0;
        dot.setAttribute('cx', at[0]);
        dot.setAttribute('cy', at[1]);
        dot.setAttribute('r', isClosed ? 0.3 * this.u : 0);
      });
      this.force(element, shape, (t, pose, channel) => {
        const { at, n } = where(pose);
        return { at, d: n, force: channel.at(t) };
      }, true);
    }
    touch(element, shape) {
      if (shape.style === 'gear') return;
      const [ra, rb, isInside] = shape.sizes;
      this.touching(element, shape, (pose) => {
        const [a, b] = this.ends(shape, pose), away = unit(minus(a, b)), n = isInside ? scaled(away, -1) : away;
        return { at: add(b, scaled(away, rb * this.scene.scale)), n, ra };
      });
    }
    // Draws the contact of a circle with an edge: a segment, or a road of several, whose further points follow the thickness in `sizes`.
    edge_touch(element, shape) {
      const frame = shape.at[1].body, thickness = shape.sizes[5],
            ends = steplap.endsOfEdge(shape.sizes).map((point) => ({ body: frame, point }));
      this.touching(element, shape, (pose) => {
        const a = this.screen(shape.at[0], pose), places = ends.map((end) => this.screen(end, pose));
        let nearest = places[0], least = Infinity;
        for (let i = 1; i < places.length; i += 1) {
          const from = places[i - 1], d = minus(places[i], from), s = Math.min(1, Math.max(0, dot(d, minus(a, from)) / (dot(d, d) || 1)));
          const place = add(from, scaled(d, s)), away = length(minus(a, place));
          if (away < least) {
            least = away;
            nearest = place;
          }
        }
        const n = unit(minus(a, nearest));
        return { at: add(nearest, scaled(n, 0.5 * thickness * this.scene.scale)), n };
      });
    }
    // Writes the state of friction, between the contacts on which it acts.
    friction(element, shape) {
      const { scene } = this, names = element.contacts || [];
      const places =
        element.contacts ? names.map((name) => scene.byName.get(name)).filter((e) => e && e.at.length).map((e) => e.at[0]) : element.at;
      const rate = scene.run.channel(`${element.name}.slip_rate`), force = this.channel(element, shape);
      if (!places.length || !scene.run.channel(`${element.name}.mode`) || this.frictions > 30) return; // more texts would be illegible
      const subject =
        // name of the moving part
        element.contacts || element.shapes.some((other) => other.type === 'faces') ? places[0].body : element.name;
      const text = make('text', { class: 'state-text', 'data-element': element.name });
      scene.textLayer.append(text);
      this.update((t, pose) => {
        const sum = places.map((p) => scene.placed(p, pose)).reduce(add);
        const [x, y] = scene.toScreen(scaled(sum, 1 / places.length)), m = scene.run.modeAt(element.name, t);
        const state = m === 2 ? 'slides' : 'slid';
        const arrow = m === 2 && rate ? (rate.at(t) >= 0 ? ' →' : ' ←') : '';
        const hasMoved = m !== 2 && scene.hasMoved(element.name, t), isSaid = m === 2 || hasMoved; // sticking friction needs no text
        const isFelt = scene.withValues && force && Math.abs(force.at(t)) > 1e-6 * scene.largestForce; // smaller forces are rounding errors
        text.textContent = !isSaid
          ? ''
          : `${steplap.words.sentence(subject, state)}${arrow}${isFelt ? `, ${steplap.data.quantity(force.at(t), force.unit, 4)}` : ''}`;
        text.setAttribute('class', 'state-text slips');
        if (isSaid) this.put(text, [x, y], [8.4 * text.textContent.length, 18]);
      });
    }

    // --- joints -------------------------------------------------------------------------------------------------
    dotOf(element, kind) { return this.piece(element, { class: `dot ${kind}` }, this.scene.elementLayer, 'circle'); }
    dot(element, place, kind, size) {
      const circle = this.dotOf(element, kind);
      this.update((t, pose) => {
        const [x, y] = this.screen(place, pose);
        circle.setAttribute('cx', x);
        circle.setAttribute('cy', y);
        circle.setAttribute('r', size * this.u);
      });
    }
    // Draws a pin; on a fixed body with a bearing block.
    pin(element, shape) {
      const held = shape.at.find((place) => this.scene.isHeld(place.body));
      if (held && held.body === 'ground') {
        const block = this.piece(element, { class: 'bearing' });
        this.update((t, pose) => {
          const [x, y] = this.screen(held, pose), w = 1.1 * this.u;
          const foot = [-1, -0.5, 0, 0.5, 1].map((k) => path([[x + k * w, y + 1.3 * w], [x + (k - 0.35) * w, y + 1.7 * w]])).join('');
          block.setAttribute('d',
            path([[x, y], [x - 0.8 * w, y + 1.3 * w], [x + 0.8 * w, y + 1.3 * w]], true) +
              path([[x - 1.2 * w, y + 1.3 * w], [x + 1.2 * w, y + 1.3 * w]]) + foot);
        });
      }
      this.dot(element, shape.at[0], 'pin', 0.42);
    }
    bushing(element, shape) {
      this.dot(element, shape.at[0], 'bushing', 0.75);
      this.dot(element, shape.at[0], 'pin', 0.35);
    }
    weld(element, shape) {
      if (shape.at.every((place) => this.scene.body(place.body).is_outline_given)) return; // the outlines show the connection
      const square = this.piece(element, { class: 'symbol weld' });
      this.update((t, pose) => {
        const [x, y] = this.screen(shape.at[0], pose), h = 0.32 * this.u;
        square.setAttribute('d', `M${x - h} ${y - h}h${2 * h}v${2 * h}h${- 2 * h}Z`);
      });
    }
    // Draws a guide: a dashed line along the free direction, with a block at the guided marker.
    rail(element, shape) {
      if (shape.style === 'limit' && shape.sizes) {
        this.stops(element, shape);
        return;
      }
      if (shape.style === 'brake') return; // a brake is described by a text
      if (this.scene.wheelsOf(shape.at[0].body).length) return; // the wheels show the guide
      if (shape.style === 'skate') {
        this.blade(element, shape);
        return;
      }
      if (shape.at.length > 1 && this.scene.body(shape.at[0].body).is_outline_given && this.hasEdge(shape)) {
        this.rollers(element, shape);
        return;
      }
      const line = this.piece(element, { class: 'symbol rail' }), block = this.piece(element, { class: 'symbol block' });
      this.update((t, pose) => {
        const [a, b] = this.ends(shape, pose), d = this.direction(shape, pose), way = dot(d, minus(a, b)), reach = 4 * this.u;
        const from = minus(a, scaled(d, way)); // start of the line; next to b if the slide runs along b
        line.setAttribute('d', path([add(from, scaled(d, Math.min(0, way) - reach)), add(from, scaled(d, Math.max(0, way) + reach))]));
        const on = a, x = scaled(d, 0.9 * this.u), y = scaled(across(d), 0.45 * this.u);
        block.setAttribute('d', path([add(add(on, x), y), add(minus(on, x), y), minus(minus(on, x), y), minus(add(on, x), y)], true));
      });
    }
    // Draws a skate, or a wheel seen from above: a block along its direction.
    blade(element, shape) {
      const block = this.piece(element, { class: 'symbol block' });
      this.update((t, pose) => {
        const on = this.screen(shape.at[0], pose), d = this.direction(shape, pose), x = scaled(d, 1.1 * this.u),
              y = scaled(across(d), 0.35 * this.u);
        block.setAttribute('d', path([add(add(on, x), y), add(minus(on, x), y), minus(minus(on, x), y), minus(add(on, x), y)], true));
      });
    }
    rod(element, shape) {
      const line = this.piece(element, { class: 'symbol rod' });
      this.update((t, pose) => line.setAttribute('d', path(this.ends(shape, pose))));
      for (const place of shape.at) this.dot(element, place, 'pin', 0.3);
    }
    // Draws the symbol of element kinds that define none.
    neutral(element, shape) {
      const line = this.piece(element, { class: 'symbol neutral' });
      this.update((t, pose) => {
        const points = shape.at.map((a) => this.screen(a, pose)), w = 0.5 * this.u;
        line.setAttribute('d',
          points.map(([x, y]) => path([[x - w, y], [x, y - w], [x + w, y], [x, y + w]], true)).join('') +
            (points.length > 1 ? path(points) : ''));
      });
    }

    // --- what drives, stops, loads ---------------------------------------------------------------------------------
    arc(element, shape) {
      const load = this.scene.loadOf(element, shape);
      if (load) this.acting(load);
      if (load !== undefined) return;
      const style = shape.style || '', symbol = this.piece(element, { class: `symbol arc ${style}` }),
            channel = this.channel(element, shape), text = this.value(element);
      const drawn = { spring: spiral, limit: stops, brake: shoes }[style] || turning, place = this.jointOf(shape);
      this.update((t, pose) => {
        const at = this.screen(place, pose), turned = -pose(shape.at[0].body)[2];
        symbol.setAttribute('d', drawn(at, this.u, turned, false));
        this.showValue(
          text, channel ? steplap.data.quantity(channel.at(t), channel.unit, 4) : '', add(at, [1.9 * this.u, -1.2 * this.u]), [1, 0]);
      });
    }
    // Returns the point at which a torque between two bodies is drawn: the pin between them or, relative to the ground, any pin of the
    // body.
    jointOf(shape) {
      const [a, b] = shape.at, holds = (pin, name) => pin.at.some((place) => place.body === name);
      const between = b && this.pins.find((pin) => holds(pin, a.body) && holds(pin, b.body));
      const found = between || (b && b.body === 'ground' ? this.pins.find((pin) => holds(pin, a.body)) : null);
      return found ? found.at[0] : a;
    }
    // Returns the point in front of the body along the arrow.
    frontOf(shape) {
      const { scene } = this, place = shape.at[0], body = scene.body(place.body), rest = (name) => scene.reference(name);
      if (body.isPoint) return place;
      const d = turn(shape.direction || [1, 0], rest(shape.at[shape.at.length - 1].body)[2]),
            way = (p) => dot(d, turn(p, rest(place.body)[2]));
      const farthest = Math.max(...body.points.map(way)), front = body.points.filter((p) => way(p) > farthest - 0.02 * body.reach);
      return { body: place.body, point: scaled(front.reduce(add), 1 / front.length) };
    }
    // Draws an arrow; without a value if the results do not contain it.
    arrow(element, shape) {
      const load = this.scene.loadOf(element, shape);
      if (load) this.acting(load);
      if (load !== undefined || shape.style === 'load') return;
      const symbol = this.piece(element, { class: 'symbol drive' }), place = this.frontOf(shape);
      this.update((t, pose) => {
        const at = this.screen(place, pose), d = this.direction(shape, pose), tip = add(at, scaled(d, 4.5 * this.u));
        symbol.setAttribute('d', path([at, tip]) + arrowHead(tip, d, 0.9 * this.u));
      });
    }
  }

  // --- lines between two points of the screen, from b to a ---------------------------------------------------------
  function zigzag(a, b, u) {
    const d = minus(a, b), n = scaled(unit(across(d)), 0.55 * u), points = [b, add(b, scaled(d, 0.15))];
    for (let k = 0; k < 8; ++k) points.push(add(add(b, scaled(d, 0.2 + (0.6 * k) / 7)), scaled(n, k % 2 ? -1 : 1)));
    return path([...points, add(b, scaled(d, 0.85)), a]);
  }
  function dashpot(a, b, u) {
    const d = unit(minus(a, b)), n = scaled(across(d), 0.5 * u), m = along(b, a, 0.5), back = scaled(d, -0.9 * u),
          front = scaled(d, 0.9 * u);
    return path([b, add(m, back)]) + path([add(add(m, front), n), add(add(m, back), n), minus(add(m, back), n), minus(add(m, front), n)]) +
      path([add(m, scaled(n, 0.75)), minus(m, scaled(n, 0.75))]) + path([m, a]);
  }
  function shifted(a, b, by, draw, u) {
    const n = scaled(unit(across(minus(a, b))), by), p = add(along(b, a, 0.9), n), q = add(along(b, a, 0.1), n);
    return draw(p, q, u);
  }
  function yokes(a, b, w) {
    const n = scaled(unit(across(minus(a, b))), w);
    return [[b, 0.1], [a, 0.9]]
      .map(([end, k]) => {
        const m = along(b, a, k);
        return path([add(m, n), minus(m, n)]) + path([m, end]);
      })
      .join('');
  }
  function plates(a, b, u) {
    const n = scaled(unit(across(minus(a, b))), 0.6 * u);
    return path([a, b]) + path([add(a, n), minus(a, n)]) + path([add(b, n), minus(b, n)]);
  }
  function cylinder(a, b, u) {
    const n = scaled(unit(across(minus(a, b))), 0.6 * u), m = along(b, a, 0.6);
    return path([add(b, n), add(m, n), minus(m, n), minus(b, n)], true) + path([m, a]);
  }
  // --- about a point ------------------------------------------------------------------------------------------------
  const onCircle = (at, r, angle) => add(at, [r * Math.cos(angle), r * Math.sin(angle)]);
  const arcPath = (at, r, from, to) => {
    const p = onCircle(at, r, from), q = onCircle(at, r, to);
    return `M${p.map((v) => v.toFixed(2)).join(' ')}A${r} ${r} 0 ${Math.abs(to - from) > Math.PI ? 1 : 0} ${to > from ? 1 : 0} ${
      q.map((v) => v.toFixed(2)).join(' ')}`;
  };
  function turning(at, u, turned, isClockwise) {
    const r = 1.7 * u, sign = isClockwise ? 1 : -1, end = turned + sign * 2.4, d = scaled(across([Math.cos(end), Math.sin(end)]), sign);
    return arcPath(at, r, turned - sign * 2.0, end) + arrowHead(add(onCircle(at, r, end), scaled(d, 0.35 * r)), d, 0.6 * r);
  }
  function spiral(at, u, turned) {
    const points = [];
    for (let k = 0; k <= 40; ++k) points.push(onCircle(at, u * (0.5 + k / 35), turned + (4 * Math.PI * k) / 40));
    return path(points);
  }
  function stops(at, u, turned) {
    return arcPath(at, 1.5 * u, turned - 0.9, turned + 0.9) +
      [-0.9, 0.9].map((w) => path([onCircle(at, 1.1 * u, turned + w), onCircle(at, 1.9 * u, turned + w)])).join('');
  }
  function shoes(at, u, turned) {
    return arcPath(at, 1.1 * u, turned - 0.6, turned + 0.6) + arcPath(at, 1.1 * u, turned + Math.PI - 0.6, turned + Math.PI + 0.6);
  }

  steplap.arrowPath = (from, tip, size) => path([from, tip]) + arrowHead(tip, unit(minus(tip, from)), size);
  Symbols.prototype.turning = turning;
  Symbols.types = {};
  for (const type of ['spring', 'rope', 'contact', 'touch', 'faces', 'edge_touch', 'friction', 'pin', 'bushing', 'weld', 'rail', 'rod',
         'neutral', 'arc', 'arrow'])
    Symbols.types[type] = Symbols.prototype[type];
  Symbols.types.joint = () => {}; // sheets are drawn instead

  Object.assign(steplap.Scene.prototype, {
    buildSymbols() {
      this.takenTexts = [];
      this.partBoxes = [];
      // Converts a box to its centre and size, with a margin of 4 pixels. Texts must not cover names, centres of bodies or other texts.
      const middleAndSize = ([x0, y0, x1, y1]) => [0.5 * (x0 + x1), 0.5 * (y0 + y1), x1 - x0 + 4, y1 - y0];
      const all = this.bodies.size > mostParts ? [] : [...this.bodies.values()];
      this.updaters.push((t, pose) => {
        this.takenTexts = [
          ...[...this.nameBoxes(pose), ...this.lensBoxes()].map(middleAndSize),
          ...all.map((body) => [...this.toScreen(pose(body.name)), 4, 4])
        ];
        this.partBoxes = all.map((body) => middleAndSize(this.boxOnScreen(body, pose)));
      });
      this.symbols = new Symbols(this);
      this.updaters.push((t, pose) => {
        this.symbols.showMoved(t);
        this.showHappenings(t, pose);
        this.symbols.placeValues();
      });
    },
    fitSymbols() { this.symbols.fit(); },
    // Returns the largest force that is drawn as an arrow.
    ownLargestForce() {
      let largest = 0;
      for (const e of this.elements)
        for (const shape of e.shapes)
          if (['contact', 'touch', 'edge_touch', 'faces'].includes(shape.type)) {
            const extreme = this.run.summary.extremes[`${e.name}.${shape.quantity}`];
            if (extreme) largest = Math.max(largest, Math.abs(extreme.min), Math.abs(extreme.max));
          }
      return largest;
    },
  });
  return Symbols;
})();
