// Draws the loads (causes.js) at the time shown: an arrow, or an arc for a rotation, with its value. It is filled while the load acts;
// before and after, only the outline and the largest value of the run are shown.
(() => {
  const make = steplap.make, { add, minus, scaled, dot, length } = steplap.geometry;
  const acting = 0.02; // smaller values, relative to the largest, count as zero
  const least = 0.25; // shortest arrow, relative to the largest
  const longest = 4.5; // longest arrow, in sizes of symbols
  const corner = [22, 26]; // start of an arrow of gravity, in pixels from the corner of the picture

  Object.assign(steplap.Symbols.prototype, {
    // Draws initial velocities and gravity, which belong to no element.
    loadsWithoutElement() {
      for (const load of this.scene.causes())
        if (!load.shape || !this.scene.byName.has(load.element.name)) this.acting(load);
    },
    // Creates an arrow or an arc with its text.
    acting(load) {
      const isArc = load.shape && load.shape.type === 'arc', style = (load.shape && load.shape.style) || 'drive';
      const symbol = this.piece(load.element, { class: isArc ? `symbol arc load ${style}` : 'symbol drive load' });
      const text = make('text', { class: 'load-text', 'data-load': load.element.name }),
            place = isArc ? this.jointOf(load.shape) : this.loadPlace(load);
      this.scene.textLayer.append(text);
      this.update((t, pose) => {
        const value = load.at(t), isActing = Math.abs(value) > acting * load.peak, isBackward = isActing ? value < 0 : load.isBackward;
        symbol.classList.toggle('acting', isActing);
        text.textContent = this.loadText(load, value, isActing);
        const at = load.isField ? corner : this.screen(place, pose), share = isActing ? Math.max(least, Math.abs(value) / load.peak) : 1;
        const middle = isArc ? this.bend(symbol, at, load, pose, isBackward)
                             : this.broaden(symbol, at, load, share, isActing ? t : load.peakAt, pose, isBackward);
        const width = 8.2 * text.textContent.length;
        this.put(text, middle, [width, 14], load.isField ? [[0.5 * width + this.u, 0]] : undefined);
      });
    },
    loadText({ element, text, peak, isField }, value, isActing) {
      if (isField) return element.name;
      return `${element.signal || element.name}${isActing ? ` ${text(Math.abs(value))}` : `, ${text(peak)} at most`}`;
    },
    // Returns the position of an arrow: in front of the body for drives and motors, at the point of action for forces.
    loadPlace({ shape, along }) { return !shape ? null
                                    : along     ? shape.at[0]
                                                : this.frontOf(shape); },
    bend(symbol, at, load, pose, isBackward) {
      symbol.setAttribute('d', this.turning(at, this.u, -pose(load.shape.at[0].body)[2], isBackward));
      return at;
    },
    // Returns the middle of the arrow.
    broaden(symbol, at, load, share, t, pose, isBackward) {
      const { shape, along, isField } = load, size = longest * this.u * share;
      const d = along ? this.forceDirection(along(t)) : this.direction(shape, pose);
      // An arrow of an external force is drawn as pushing if it points towards the centre of gravity, otherwise as pulling.
      const isPush = along && !isField && dot(d, minus(at, this.screen({ body: shape.at[0].body, point: [0, 0] }, pose))) < -1;
      const far = isPush ? minus(at, scaled(d, size)) : add(at, scaled(d, size)), isTurned = isPush || isBackward;
      const [tail, tip] = isTurned ? [far, at] : [at, far];
      symbol.setAttribute('d', broadArrow(tail, tip, scaled(d, isBackward ? -1 : 1), this.u));
      return scaled(add(tail, tip), 0.5);
    },
    forceDirection(force) {
      const d = [force[0], -force[1]];
      return length(d) > 0 ? scaled(d, 1 / length(d)) : [0, 1];
    },
  });
  // Returns the closed outline of a broad arrow.
  function broadArrow(tail, tip, d, u) {
    const n = [-d[1], d[0]], head = minus(tip, scaled(d, 0.9 * u));
    const at = (p, k) => add(p, scaled(n, k * u)).map((v) => v.toFixed(1)).join(' ');
    return `M${at(tail, 0.22)}L${at(head, 0.22)}L${at(head, 0.6)}L${at(tip, 0)}L${at(head, -0.6)}L${at(head, -0.22)}L${at(tail, -0.22)}Z`;
  }
})();
