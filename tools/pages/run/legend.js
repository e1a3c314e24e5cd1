// Legend of the picture: scale bar, magnification of the motion, standpoint.
(() => {
  const make = steplap.make;
  const strip = 24; // height of the legend at the foot of the picture, pixels

  Object.assign(steplap.Scene.prototype, {
    footHeight() { return strip; },
    buildLegend() {
      this.scaleBar = make('path', { class: 'scale-bar' });
      this.scaleText = make('text', { class: 'note-text scale-text' });
      this.motionText = make('text', { class: 'note-text motion-text', tabindex: '0', role: 'button' });
      this.seenText = make('text', { class: 'note-text seen-text' });
      this.legendLayer.append(make('title', {}, ''), this.scaleBar, this.scaleText, this.motionText, this.seenText);
      const toggle = (event) => {
        event.stopPropagation();
        this.toggleMagnification();
      };
      this.motionText.addEventListener('click', toggle);
      for (const name of ['pointerdown', 'dblclick']) this.motionText.addEventListener(name, (event) => event.stopPropagation());
      this.motionText.addEventListener('keydown', (event) => {
        if (event.key === 'Enter' || event.key === ' ') {
          event.preventDefault();
          toggle(event);
        }
      });
    },
    // Switches between true scale and magnification, as the page's selection field does.
    toggleMagnification() {
      const choice = document.getElementById('magnification');
      if (!choice) return;
      choice.value = this.magnification === 1 && this.isUsuallyMagnified(this.seenFrom) ? 'usual' : '1';
      choice.dispatchEvent(new Event('change'));
    },
    showLegend(t = 0) {
      const wanted = Math.min(130, 0.25 * this.width) / this.scale, power = 10 ** Math.floor(Math.log10(wanted));
      const size = power *
        (wanted / power >= 5      ? 5
            : wanted / power >= 2 ? 2
                                  : 1),
            width = size * this.scale, y = this.height - 9, left = 10;
      this.scaleBar.setAttribute(
        'd', `M${left} ${y - 4}V${y + 4}M${left} ${y}H${(left + width).toFixed(1)}M${(left + width).toFixed(1)} ${y - 4}V${y + 4}`);
      this.put(this.scaleText, steplap.data.quantity(size, 'm', 3), left + width + 6, y + 4, 'start');
      const motion = this.motionNote(this.width < 520);
      this.put(this.motionText, motion, this.width - 10, y + 4, 'end');
      const from = this.standpointText(this.seenFrom);
      const room = this.width - (left + width + 70) - 6.6 * motion.length - 40;
      const { shown, all } = this.symbols.shownValues, values = shown < all ? `${shown} of ${all} values; closer for more` : '';
      const guess = this.isGuessed(t) ? 'between instants that are written: not the motion' : '';
      const hidden = this.namesLeftOut(), names = hidden ? `${hidden} name${hidden > 1 ? 's' : ''} left out; closer for more` : '';
      const note = [guess, values, from, names].find((text) => text && 6.6 * text.length < room) || '';
      this.put(this.seenText, note, left + width + 70 + 0.5 * Math.max(0, room), y + 4, 'middle');
    },
    // Returns the note that names the magnified bodies and their factors.
    motionNote(isNarrow) {
      const isChoice = Boolean(document.getElementById('magnification')), plain = (f) => steplap.data.plain(f, 3);
      const offer = `true scale${isNarrow ? '' : ' – enlarge motion'}`;
      if (this.magnification === 1) return isChoice && this.isUsuallyMagnified(this.seenFrom) ? offer : '';
      const end = isNarrow || !isChoice ? '' : ' – show true scale';
      if (this.magnification !== 'usual') return `motion × ${plain(this.magnification)}${end}`;
      const byFactor = new Map();
      const named = [...this.usualFactors(this.seenFrom)].filter(([name]) => !this.body(name).isLookAlone);
      for (const [name, factor] of named) byFactor.set(factor, [...(byFactor.get(factor) || []), name]);
      const factors = [...byFactor].filter(([f]) => f > 1).sort((a, b) => b[0] - a[0]);
      if (!factors.length) return '';
      if (factors.length === 1 && byFactor.size === 1) return `motion × ${plain(factors[0][0])}${end}`;
      const listed = (names) => (names.length > 2 ? `${names[0]} and ${names.length - 1} others` : names.join(', '));
      const whole = `motion: ${factors.map(([f, names]) => `${listed(names)} × ${plain(f)}`).join('; ')}${end}`;
      if (6.6 * whole.length < this.width - 260) return whole;
      const largest = plain(factors[0][0]);
      return `motion × ${factors.length > 1 ? `${plain(factors[factors.length - 1][0])} to ${largest}` : largest}${end}`;
    },
    put(text, content, x, y, anchor) {
      text.textContent = content;
      text.setAttribute('x', x.toFixed(1));
      text.setAttribute('y', y.toFixed(1));
      text.setAttribute('text-anchor', anchor);
    },
  });
})();
