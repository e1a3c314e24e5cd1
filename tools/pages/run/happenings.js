// Marks elements that have lifted, broken, come apart or slipped, from that instant on, with a sign and a word. If there are many, only
// breaks and separations get a sign, because signs would hide the machine; the others are only coloured (symbols.js). Sliding friction has
// its own texts (symbols.js).
(() => {
  const make = steplap.make, { add, scaled } = steplap.geometry;
  const most = 30, mostInWords = 5; // largest number of elements with signs; with words
  const size = 16; // size of a sign, pixels
  const grave = ['break', 'apart', 'open', 'slip'];
  const past = {
    lifts: 'lifted',
    opens: 'opened',
    breaks: 'broke',
    'comes apart': 'came apart',
    slips: 'slipped',
    tips: 'tips',
    'loses an interface': 'lost an interface'
  };
  // kinds of elements whose first point belongs to the part that lifts
  const onFirst = new Set(['contact', 'faces', 'touch', 'edge_touch']);

  Object.assign(steplap.Scene.prototype, {
    // Sets the names of elements that slipped, opened or broke, and of bodies that tipped, which are coloured from that instant on. `story`
    // of the summary contains the word for each.
    setMoved(names, story = []) {
      this.moved = new Set(names || []);
      for (const { group } of this.happenings || []) group.remove();
      const wordOf = (name) => story.find((entry) => entry.what in past && (entry.who || []).includes(name));
      const found = [...this.moved]
                      .map((name) => ({ name, told: wordOf(name), place: this.happeningPlace(name) }))
                      .filter((h) => h.place && steplap.signs);
      const isFew = found.length <= mostInWords,
            isGrave = ({ name }) => this.run.events.some((e) => e[1] === name && ['break', 'apart'].includes(e[4]));
      this.happenings =
        (isFew ? found : found.filter(isGrave)).slice(0, most).map((h) => ({...h, isInWords: isFew, ...this.happeningMark(h.name) }));
    },
    // Returns the position of the sign: the element's first point or the middle of its points, or the centre of gravity of a body that
    // tips.
    happeningPlace(name) {
      const element = this.byName.get(name), shapes = element ? this.elements.find((e) => e.name === name)?.shapes || [] : [];
      if (!element) return this.bodies.has(name) ? (pose) => pose(name).slice(0, 2) : null;
      if (shapes.some((shape) => shape.type === 'friction') &&
        !this.run.events.some((e) => e[1] === name && ['break', 'apart', 'open'].includes(e[4])))
        return null; // sliding friction has its own texts
      const at = (shapes[0] && shapes[0].at.length ? shapes[0].at : element.at || []),
            places = shapes[0] && onFirst.has(shapes[0].type) ? at.slice(0, 1) : at;
      return places.length ? (pose) => scaled(places.map((p) => this.placed(p, pose)).reduce(add), 1 / places.length) : null;
    },
    happeningMark(name) {
      const text = make('text', { class: 'state-text slips' }),
            group = make('g', { class: 'happening', 'data-happened': name }, make('title', {}, name));
      group.append(text);
      this.textLayer.append(group);
      return { group, text, sign: null };
    },
    // Returns the most serious event of an element up to time t, and whether its effect lasts at t; null before the first event.
    happenedTo({ name, told }, t) {
      if (this.bodies.has(name) && !this.byName.has(name)) return told && t >= told.from ? { role: 'tip', word: 'tips' } : null;
      const own = this.run.events.filter((e) => e[1] === name && e[0] <= t), role = grave.find((r) => own.some((e) => e[4] === r));
      if (!role) return null;
      const last = own.filter((e) => ['open', 'close', 'strike', 'slip', 'stick', 'free'].includes(e[4])).pop();
      const what = { break: 'breaks', apart: 'comes apart', open: told && told.what === 'lifts' ? 'lifts' : 'opens', slip: 'slips' }[role];
      const isNow = (role === 'open' && last[4] === 'open') || (role === 'slip' && this.run.modeAt(name, t) === 2);
      return { role, word: isNow ? what : past[what] };
    },
    showHappenings(t, pose) {
      for (const h of this.happenings || []) {
        const now = this.happenedTo(h, t), { group, text } = h;
        group.style.display = now ? '' : 'none';
        text.textContent = now && h.isInWords ? steplap.words.sentence(h.name, now.word) : '';
        if (!now) continue;
        if (h.role !== now.role) {
          if (h.sign) h.sign.remove();
          h.role = now.role;
          h.sign = steplap.signs.mark(now.role, 0, 0, size);
          group.append(h.sign);
        }
        const words = text.textContent ? 8.4 * text.textContent.length + 6 : 0, width = size + words, [x, y] = this.toScreen(h.place(pose));
        const place = this.symbols.room([x, y], [width, size + 2], steplap.waysAround(width)) ||
          this.symbols.room([x, y], [size, size + 2], steplap.waysAround(size));
        const isFull = place && words > 0 && place.size[0] === width;
        if (!isFull) text.textContent = '';
        const at = place ? place.at : [x, y];
        h.sign.setAttribute('transform', `translate(${(at[0] - (isFull ? 0.5 * words : 0)).toFixed(1)} ${at[1].toFixed(1)})`);
        text.setAttribute('x', (at[0] - 0.5 * width + size + 4).toFixed(1));
        text.setAttribute('y', (at[1] + 4.5).toFixed(1));
      }
    },
  });
})();
