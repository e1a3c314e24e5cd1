// Draws a magnified view of a contact or joint whose slide is too small to be seen: both sides in true displacement, with the amount and
// its limit. The view occupies a free corner of the picture.
(() => {
  const make = steplap.make, { add, minus, scaled, dot, length, unit, turn, apply, seenIn, relative } = steplap.geometry;
  const seen = 10; // a slide of more pixels is visible without magnification
  const least = 1e-5; // smaller slides, relative to the size of the machine, are elastic deformations of contacts
  const shown = 0.6; // largest slide in the view, relative to its radius
  const room = 0.35; // largest part of the view that may hide bodies
  const air = 8, textHeight = 16, fieldRoom = 110; // pixels; `fieldRoom` is reserved for an arrow of gravity (loads.js)
  const radiusFor = (width) => Math.min(62, Math.max(38, 0.11 * width)); // radius of the view, pixels

  // Returns the slide to be magnified: that of the first criterion if it limits a slide, otherwise the largest one in the story.
  function decidedBy(run) {
    if (!steplap.overview) return null;
    const { utilisations, story } = steplap.overview.of(run), first = utilisations.find(steplap.overview.isJudged);
    const told = story.filter((e) => steplap.overview.isAbout(e, 'slips') && e.who.length === 1 && e.amount && e.amount.unit === 'm')
                   .sort((a, b) => Math.abs(b.amount.value) - Math.abs(a.amount.value));
    const isFirst = first && first.channel && first.channel.endsWith('.slide'),
          name = isFirst ? first.channel.slice(0, -6)
      : told.length      ? told[0].who[0]
                         : null;
    const limited = utilisations.find((u) => u.channel === `${name}.slide` && u.limit);
    return name && { name, amount: Math.abs(isFirst ? first.value : told[0].amount.value), limit: limited ? limited.limit : null };
  }
  const middleOf = (ring) => ring.reduce((box, p) => box.take(p), new steplap.Box());
  // Returns { moving: { body, point }, carrier, normal }: the sliding point, the body on which it slides, and the normal from this carrier
  // to the point, in the carrier's axes.
  function contactOf(scene, name) {
    const element = scene.byName.get(name), sheet = scene.run.drawing.sheets.find((s) => s.joint === name);
    if (sheet) {
      const rest = relative(scene.reference(sheet.active_part), scene.reference(sheet.limb)),
            ends = [middleOf(sheet.yoke), middleOf(sheet.limb_sheet)];
      const isYoke = Math.max(...ends[0].span) < Math.max(...ends[1].span), point = isYoke ? seenIn(rest, ends[0].middle) : ends[1].middle;
      return { moving: { body: sheet.limb, point }, carrier: sheet.active_part, normal: null };
    }
    const contact = element && scene.elements.find((e) => (element.contacts || [])[0] === e.name),
          shape = contact && contact.shapes.find((s) => s.type === 'contact' && s.direction);
    return shape ? { moving: shape.at[0], carrier: shape.at[shape.at.length - 1].body, normal: shape.direction } : null;
  }

  Object.assign(steplap.Scene.prototype, {
    buildLens() {
      const decided = decidedBy(this.run), contact = decided && decided.amount > least * this.size ? contactOf(this, decided.name) : null;
      if (!contact) return;
      const q = (v) => steplap.data.quantity(v, 'm', 3), names = [contact.carrier, contact.moving.body];
      this.lens = {...decided, ...contact, box: null, group: make('g', { class: 'lens', 'data-lens': decided.name }) };
      const piece = (name, attributes) => {
        const node = make(name, attributes);
        this.lens.group.append(node);
        return node;
      };
      Object.assign(this.lens, {
        leader: piece('path', { class: 'leader' }),
        sides: ['carrier', 'moving'].map((side) => piece('path', { class: `lens-${side}` })),
        marks: piece('path', { class: 'lens-marks' }),
        ghost: piece('path', { class: 'lens-ghost' }),
        arrow: piece('path', { class: 'lens-arrow' }),
        frame: piece('circle', { class: 'lens-frame' }),
        names: names.map((name) => {
          const text = piece('text', { class: 'lens-name' });
          text.textContent = name;
          return text;
        }),
        text: piece('text', { class: 'lens-text' })
      });
      this.lens.text.textContent = `slide up to ${q(decided.amount)}${decided.limit ? `, limit ${q(decided.limit)}` : ''}`;
      this.lens.width = 6.9 * this.lens.text.textContent.length; // estimated width of the text, pixels
      this.legendLayer.append(this.lens.group);
      this.updaters.push((t, pose) => this.showLens(t, pose));
    },
    // Puts the view into the corner where it hides least of the bodies at the start. Omits it if it would hide too much everywhere, or if
    // the slide is visible without it.
    placeLens() {
      const { lens } = this, r = radiusFor(this.width), rest = (name) => this.reference(name);
      if (!lens) return;
      const boxes = [...this.bodies.values()].map((body) => this.boxOnScreen(body, rest)), reach = Math.max(r, 0.5 * lens.width);
      if (this.causes().some((load) => load.isField)) boxes.push([0, 0, fieldRoom, fieldRoom]);
      const boxAt = ([x, y]) => [x - reach, y - r, x + reach, y + r + textHeight],
            low = this.height - this.footHeight() - textHeight - r - 2;
      const shared = (a, b) =>
        Math.max(0, Math.min(a[2], b[2]) - Math.max(a[0], b[0])) * Math.max(0, Math.min(a[3], b[3]) - Math.max(a[1], b[1]));
      const covered = (at) => boxes.reduce((sum, box) => sum + shared(box, boxAt(at)), 0);
      const corners = [r + air, low].flatMap((y) => [reach + air, this.width - reach - air].map((x) => [x, y]));
      const best = corners.reduce((a, b) => (covered(b) < covered(a) ? b : a));
      const isNeeded = lens.amount * this.fittedScale < seen && covered(best) < room * 4 * r * r && this.height > 4 * r;
      Object.assign(lens, { at: best, r, box: isNeeded ? boxAt(best) : null });
      lens.group.style.display = isNeeded ? '' : 'none';
    },
    lensBoxes() { return this.lens && this.lens.box ? [this.lens.box] : []; },
    // Returns the displacement of the sliding point since the start, in the carrier's axes.
    slideAt(t) {
      const { moving, carrier } = this.lens, place = (poseOf) => apply(relative(poseOf(carrier), poseOf(moving.body)), moving.point);
      return minus(place((name) => this.poseAt(name, t)), place((name) => this.reference(name)));
    },
    showLens(t, pose) {
      const { lens } = this;
      if (!lens.box) return;
      const onScreen = (d) => {
        const p = turn(d, this.reference(lens.carrier)[2]);
        return [p[0], -p[1]];
      }, { at, r } = lens, slide = onScreen(this.slideAt(t));
      const along = length(slide) > 0 ? unit(slide) : [1, 0], n = lens.normal ? unit(onScreen(lens.normal)) : [along[1], -along[0]],
            tangent = [-n[1], n[0]];
      const shift = scaled(tangent, (dot(slide, tangent) * shown * r) / lens.amount), tip = add(at, shift),
            text = (p) => p.map((v) => v.toFixed(1)).join(' ');
      const half = (sign) => `M${text(add(at, scaled(tangent, r)))}A${r} ${r} 0 0 ${sign} ${text(minus(at, scaled(tangent, r)))}Z`,
            line = (p, d) => `M${text(p)}L${text(add(p, d))}`;
      const isLeft = dot([-tangent[1], tangent[0]], n) > 0, up = scaled(n, 0.45 * r);
      lens.sides[0].setAttribute('d', half(isLeft ? 0 : 1));
      lens.sides[1].setAttribute('d', half(isLeft ? 1 : 0));
      lens.marks.setAttribute('d', line(at, scaled(up, -1)) + line(tip, up));
      lens.ghost.setAttribute('d', line(at, up));
      lens.arrow.setAttribute('d', length(shift) > 4 ? steplap.arrowPath(add(at, scaled(up, 0.5)), add(tip, scaled(up, 0.5)), 7) : 'M0 0');
      for (const [name, value] of [['cx', at[0]], ['cy', at[1]], ['r', r]]) lens.frame.setAttribute(name, value);
      const slope = (180 / Math.PI) * Math.atan(tangent[1] / tangent[0] || 0); // names are written along the contact
      lens.names.forEach((name, k) => {
        const middle = add(at, scaled(n, (k ? 0.7 : -0.7) * r));
        this.put(name, name.textContent, middle[0], middle[1] + 4, 'middle');
        name.setAttribute('transform', `rotate(${(Math.abs(tangent[0]) < 1e-9 ? 90 : slope).toFixed(1)} ${text(middle)})`);
      });
      this.put(lens.text, lens.text.textContent, at[0], at[1] + r + textHeight - 3, 'middle');
      const end = this.toScreen(this.placed(lens.moving, pose));
      lens.leader.setAttribute('d', `M${text(add(at, scaled(unit(minus(end, at)), r)))}L${text(end)}`);
    },
  });
})();
