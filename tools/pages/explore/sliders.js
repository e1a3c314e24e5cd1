// Sliders with number fields for the varied values, and a search for further values. Numbers are SI.
steplap.Sliders = class Sliders {
  // `onChange(path, value)` is called while a slider is dragged, and with the file's value after a reset.
  constructor(box, { search, found, onChange }) {
    Object.assign(this, { box, search, foundBox: found, onChange, given: new Map(), shown: [], rows: new Map(), values: new Map() });
    search.addEventListener('input', () => this.find());
    search.addEventListener('keydown', (event) => {
      if (event.key === 'Enter') {
        event.preventDefault();
        const first = this.foundBox.querySelector('button');
        if (first) first.click();
      }
    });
  }
  static get first() { return 12; } // sliders shown initially for models with many values
  static label(slider) {
    return slider.path.replace(/^(?!simulation\.|output\.|gravity)[a-z_]+\.(?=.+\.|[^.]+$)/, '')
      .replace(/\.([a-z_0-9]+)((\.\d+)*)$/,
        (_, field, items) => `: ${field.replace(/_/g, ' ')}${items.replace(/\.(\d+)/g, (__, i) => ` ${Number(i) + 1}`)}`);
  }

  // Sets the sliders of a model that was read again. Visible sliders and changed values are kept.
  set(sliders) {
    this.given = new Map(sliders.map((s) => [s.path, s]));
    this.shown = this.shown.filter((path) => this.given.has(path));
    for (const path of [...this.values.keys()])
      if (!this.given.has(path)) this.values.delete(path);
    const groups = ['parameters', 'friction', 'pressure', 'peak', 'duration', 'gap', 'stiffness'];
    if (!this.shown.length) {
      const wanted = sliders.filter((s) => groups.includes(s.group)).sort((a, b) => groups.indexOf(a.group) - groups.indexOf(b.group));
      const parameters = wanted.filter((s) => s.group === 'parameters').length;
      // If there are too many values, some of each group are shown.
      const most = Math.max(Sliders.first, parameters), chosen = wanted.slice(0, parameters), rest = wanted.slice(parameters);
      for (let round = 0; chosen.length < most && chosen.length < wanted.length; ++round)
        for (const group of groups) {
          const s = rest.filter((r) => r.group === group)[round];
          if (s && chosen.length < most) chosen.push(s);
        }
      this.shown = chosen.map((s) => s.path);
    }
    this.groups = groups;
    this.build();
    this.find();
  }
  value(path) { return this.values.has(path) ? this.values.get(path) : this.given.get(path).value; }
  changed() { return Object.fromEntries(this.values); }

  build() {
    this.rows.clear();
    const rank = (s) => {
      const k = this.groups.indexOf(s.group);
      return k < 0 ? this.groups.length : k;
    };
    const sorted = this.shown.map((path) => this.given.get(path)).sort((a, b) => rank(a) - rank(b)), parts = [];
    let group = null;
    for (const slider of sorted) {
      if (slider.group !== group) parts.push(steplap.make('h3', {}, slider.group || 'others'));
      group = slider.group;
      parts.push(this.row(slider));
    }
    this.box.replaceChildren(...parts);
    for (const path of this.shown) this.show(path);
  }
  row(slider) {
    const make = steplap.make, id = `value-${slider.path}`, name = Sliders.label(slider);
    const range =
      make('input', { type: 'range', id, min: String(slider.least), max: String(slider.most), step: 'any', 'data-path': slider.path });
    const number = make('input', { class: 'number', inputmode: 'decimal', 'aria-label': `${name}, number`, spellcheck: 'false' });
    const least = make('input', { 'aria-label': `${name}, lower end`, inputmode: 'decimal' }),
          most = make('input', { 'aria-label': `${name}, upper end`, inputmode: 'decimal' });
    const back = make('button', { type: 'button', class: 'back', 'aria-label': `${name} as in the file` }, 'back'),
          was = make('span', { class: 'was' });
    const box = make('div', { class: 'value', 'data-value': slider.path, title: [slider.path, slider.meaning].filter(Boolean).join('\n') },
      make('label',
        { for: id
        },
        name),
      make('div', { class: 'line' }, range, number, make('span', { class: 'unit' }, steplap.data.pretty(slider.unit))),
      make('div', { class: 'ends' }, least, was, back, most));
    const put = (value) => {
      if (Number.isFinite(value)) this.change(slider, slider.is_whole ? Math.round(value) : value);
    };
    range.addEventListener('input', () => put(Number(range.value)));
    range.addEventListener('keydown', (event) => {
      const span = Number(range.max) - Number(range.min), step = slider.is_whole ? Math.max(1, Math.round(span / 100)) : span / 100,
            now = this.value(slider.path);
      const moves = {
        ArrowRight: now + step,
        ArrowUp: now + step,
        ArrowLeft: now - step,
        ArrowDown: now - step,
        PageUp: now + 10 * step,
        PageDown: now - 10 * step,
        Home: Number(range.min),
        End: Number(range.max)
      };
      if (!(event.key in moves) || event.ctrlKey || event.altKey || event.metaKey) return;
      event.preventDefault();
      put(Math.min(Number(range.max), Math.max(Number(range.min), moves[event.key])));
    });
    number.addEventListener('change', () => put(Number(number.value.replace(',', '.'))));
    for (const [end, attribute] of [[least, 'min'], [most, 'max']])
      end.addEventListener('change', () => {
        const wanted = Number(end.value.replace(',', '.')), other = Number(attribute === 'min' ? range.max : range.min);
        if (end.value.trim() !== '' && Number.isFinite(wanted) && (attribute === 'min' ? wanted < other : wanted > other))
          range[attribute] = String(wanted);
        this.show(slider.path);
      });
    back.addEventListener('click', () => this.change(slider, slider.value));
    this.rows.set(slider.path, { box, range, number, least, most, back, was });
    return box;
  }
  change(slider, value) {
    if (value === slider.value) this.values.delete(slider.path);
    else this.values.set(slider.path, value);
    this.show(slider.path);
    this.onChange(slider.path, value);
  }
  // Sets a value that was changed elsewhere, by the map or by a reset of all values.
  put(path, value) { this.change(this.given.get(path), value); }
  reset() {
    this.values.clear();
    for (const path of this.shown) this.show(path);
  }
  show(path) {
    const row = this.rows.get(path), slider = this.given.get(path);
    if (!row) return;
    const value = this.value(path), plain = (v) => {
      const known = Number(v.toPrecision(6));
      return Math.abs(known) >= 1e6 ? known.toExponential().replace('e+', 'e') : String(known);
    };
    if (value < Number(row.range.min)) row.range.min = String(value);
    if (value > Number(row.range.max)) row.range.max = String(value);
    row.range.value = String(value);
    row.range.setAttribute('aria-valuetext', steplap.data.quantity(value, slider.unit, 4));
    row.number.value = plain(value);
    row.least.value = plain(Number(row.range.min));
    row.most.value = plain(Number(row.range.max));
    const isChanged = this.values.has(path);
    row.box.classList.toggle('changed', isChanged);
    row.back.hidden = !isChanged;
    row.was.textContent =
      isChanged ? `was ${steplap.data.quantity(slider.value, slider.unit, 4)}` : steplap.data.quantity(value, slider.unit, 4);
  }
  // Adds the slider of a value found by the search.
  add(path) {
    if (!this.given.has(path)) return;
    if (!this.shown.includes(path)) {
      this.shown.push(path);
      this.build();
    }
    const { range } = this.rows.get(path);
    range.scrollIntoView({ block: 'nearest' });
    range.focus();
    if (this.onShown) this.onShown();
  }
  find() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean), most = 20;
    if (!words.length) return this.foundBox.replaceChildren();
    const text = (s) => `${s.path} ${s.path.replace(/_/g, ' ')} ${s.group} ${s.meaning}`.toLowerCase();
    const found = [...this.given.values()].filter((s) => !this.shown.includes(s.path) && words.every((w) => text(s).includes(w)));
    const buttons = found.slice(0, most).map((s) => {
      const button =
        steplap.make('button', { type: 'button', 'data-add': s.path }, `${Sliders.label(s)}, ${steplap.data.quantity(s.value, s.unit, 4)}`);
      button.addEventListener('click', () => {
        this.add(s.path);
        this.search.value = '';
        this.find();
      });
      return button;
    });
    const rest = found.length > most ? `${found.length - most} more: type more of the name.` : found.length ? '' : 'No such value.';
    this.foundBox.replaceChildren(...buttons, steplap.make('p', { class: 'note' }, rest));
  }
};
