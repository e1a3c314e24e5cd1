// Draws the loads at the instant shown: acceleration, speed or travel of a drive as an arrow with its value. The arrow is filled while the
// load acts; before and after it is hollow and shows the largest value of the run.
(() => {
  const make = steplap.make, { add, minus, scaled, length } = steplap.geometry;
  const g = 9.80665; // m/s²
  const acting = 0.02; // of the largest value; smaller ones count as zero
  const least = 0.25; // of the largest arrow; shortest visible arrow
  const onCentre = 1e-6; // of the machine's size: only at its centre of gravity the motion of a body equals its channels

  const inG = (a) => `${steplap.data.plain(a / g, 2)}\u00a0g`;
  const quantities = {
    acceleration: { channels: ['ax', 'ay'], text: inG },
    velocity: { channels: ['vx', 'vy'], text: (v) => steplap.data.quantity(v, 'm/s', 3) },
    position: { channels: ['x', 'y'], isFromStart: true, text: (x) => steplap.data.quantity(x, 'm', 3) },
  };
  // Returns { at(t), peak, isBackward, text } of a drive along one axis against the ground; null if the results do not contain it.
  function motionOf(scene, element, shape) {
    const quantity = quantities[element.as], axis = Math.abs((shape.direction || [1, 0])[1]) > 0.7 ? 1 : 0, [driven, base] = shape.at;
    const channel = quantity && scene.run.channel(`${driven.body}.${quantity.channels[axis]}`);
    if (!channel || length(driven.point) > onCentre * scene.size || !base || !scene.isHeld(base.body)) return null;
    const sign = Math.sign((shape.direction || [1, 0])[axis]) || 1, start = quantity.isFromStart ? channel.at(0) : 0;
    const reaction = scene.run.channel(`${element.name}.reaction`), isReleased = (t) => Boolean(reaction) && reaction.at(t) === 0;
    const at = (t) => (isReleased(t) ? 0 : sign * (channel.at(t) - start));
    let largest = 0;
    for (const t of channel.times) if (Math.abs(at(t)) > Math.abs(largest)) largest = at(t);
    return { at, peak: Math.abs(largest), isBackward: largest < 0, text: quantity.text };
  }

  Object.assign(steplap.Symbols.prototype, {
    // Draws the load of a drive. Returns false if its value is unknown.
    driven(element, shape, symbol) {
      const { scene } = this, motion = motionOf(scene, element, shape);
      if (!motion) return false;
      if (!(motion.peak > 1e-9)) { symbol.remove(); return true; }
      const place = this.frontOf(shape), text = make('text', { class: 'load-text', 'data-load': element.name });
      symbol.classList.add('load');
      scene.textLayer.append(text);
      this.update((t, pose) => {
        const value = motion.at(t), isActing = Math.abs(value) > acting * motion.peak;
        const size = 4.5 * this.u * (isActing ? Math.max(least, Math.abs(value) / motion.peak) : 1);
        const from = this.screen(place, pose), d = this.direction(shape, pose), far = add(from, scaled(d, size));
        const isBackward = isActing ? value < 0 : motion.isBackward;
        const [tail, tip] = isBackward ? [far, from] : [from, far], ahead = scaled(d, isBackward ? -1 : 1);
        symbol.setAttribute('d', broadArrow(tail, tip, ahead, this.u));
        symbol.classList.toggle('acting', isActing);
        const name = element.signal || element.name;
        const words = isActing ? ` ${motion.text(Math.abs(value))}` : `, ${motion.text(motion.peak)} at most`;
        text.textContent = `${name}${words}`;
        const width = 8.2 * text.textContent.length, middle = scaled(add(tail, tip), 0.5);
        const ways = [-16, 18, -32, 34, -48, 50, -66, 68];
        this.put(text, middle, [width, 14], ways.map((dy) => [0, dy]));
      });
      return true;
    },
  });
  // Outline of a broad arrow, closed so that it can be filled.
  function broadArrow(tail, tip, d, u) {
    const n = [-d[1], d[0]], head = minus(tip, scaled(d, 0.9 * u));
    const at = (p, k) => add(p, scaled(n, k * u)).map((v) => v.toFixed(1)).join(' ');
    return `M${at(tail, 0.22)}L${at(head, 0.22)}L${at(head, 0.6)}L${at(tip, 0)}L${at(head, -0.6)}L${at(head, -0.22)}L${at(tail, -0.22)}Z`;
  }
})();
