// What the picture says of itself: a bar of its scale, how far motion is magnified, from where it is seen.
(() => {
  const make = steplap.make;
  const strip = 24; // pixels at the foot of the picture

  Object.assign(steplap.Scene.prototype, {
    footHeight() { return strip; },
    buildLegend() {
      this.scaleBar = make('path', { class: 'scale-bar' });
      this.scaleText = make('text', { class: 'note-text scale-text' });
      this.motionText = make('text', { class: 'note-text motion-text', tabindex: '0', role: 'button' });
      this.seenText = make('text', { class: 'note-text seen-text' });
      this.legendLayer.append(make('title', {}, ''), this.scaleBar, this.scaleText, this.motionText, this.seenText);
      const toggle = (event) => { event.stopPropagation(); this.toggleMagnification(); };
      this.motionText.addEventListener('click', toggle);
      for (const name of ['pointerdown', 'dblclick']) this.motionText.addEventListener(name, (event) => event.stopPropagation());
      this.motionText.addEventListener('keydown', (event) => { if (event.key === 'Enter' || event.key === ' ') { event.preventDefault(); toggle(event); } });
    },
    // True scale and back, by the choice that the page has for it.
    toggleMagnification() {
      const choice = document.getElementById('magnification');
      if (!choice) return;
      choice.value = String(this.magnification !== 1 ? 1 : this.usualMagnification(this.seenFrom));
      choice.dispatchEvent(new Event('change'));
    },
    showLegend(t = 0) {
      const wanted = Math.min(130, 0.25 * this.width) / this.scale, power = 10 ** Math.floor(Math.log10(wanted));
      const size = power * (wanted / power >= 5 ? 5 : wanted / power >= 2 ? 2 : 1), width = size * this.scale, y = this.height - 9, left = 10;
      this.scaleBar.setAttribute('d', `M${left} ${y - 4}V${y + 4}M${left} ${y}H${(left + width).toFixed(1)}M${(left + width).toFixed(1)} ${y - 4}V${y + 4}`);
      this.put(this.scaleText, steplap.data.quantity(size, 'm', 3), left + width + 6, y + 4, 'start');
      const canChoose = Boolean(document.getElementById('magnification')), usual = canChoose ? this.usualOf() : 1;
      const isNarrow = this.width < 520 || !canChoose, factor = steplap.data.plain(this.magnification, 3);
      const motion = this.magnification !== 1 ? `motion × ${factor}${isNarrow ? '' : ' – show true scale'}` : usual !== 1 ? `true scale${isNarrow ? '' : ` – magnify × ${usual}`}` : '';
      this.put(this.motionText, motion, this.width - 10, y + 4, 'end');
      const from = this.seenFrom && this.seenFrom !== 'ground' ? `seen from ${this.seenFrom}` : '';
      const room = this.width - (left + width + 70) - 6.6 * motion.length - 40;
      const { shown, all } = this.symbols.shownValues, values = shown < all ? `${shown} of ${all} values; closer for more` : '';
      const guess = this.isGuessed(t) ? 'between instants that are written: not the motion' : '';
      const note = [guess, values, from].find((text) => text && 6.6 * text.length < room) || '';
      this.put(this.seenText, note, left + width + 70 + 0.5 * Math.max(0, room), y + 4, 'middle');
    },
    usualOf() {
      if (!this.usuals) this.usuals = new Map();
      if (!this.usuals.has(this.seenFrom)) this.usuals.set(this.seenFrom, this.usualMagnification(this.seenFrom));
      return this.usuals.get(this.seenFrom);
    },
    put(text, content, x, y, anchor) {
      text.textContent = content;
      text.setAttribute('x', x.toFixed(1)); text.setAttribute('y', y.toFixed(1)); text.setAttribute('text-anchor', anchor);
    },
  });
})();
