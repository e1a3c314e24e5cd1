// A map of the utilisation over two values, filled from coarse to fine.
steplap.ValueMap = class ValueMap {
  // `ask(x, y, cells)` returns a promise of the server's results for some cells, in their order. `onChoose(x, y)` is called when the user
  // selects a pair.
  constructor({ canvas, text, what, ask, onChoose }) {
    Object.assign(this, { canvas, text, what, ask, onChoose, cells: new Map(), generation: 0, cursor: null });
    canvas.addEventListener('click', (event) => {
      const box = canvas.getBoundingClientRect();
      this.choose(this.cellAt((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height));
    });
    canvas.addEventListener('keydown', (event) => {
      const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
      if (!this.axes) return;
      if (event.key in moves) this.point(moves[event.key].map((d, i) => Math.min(ValueMap.count - 1, Math.max(0, this.cursor[i] + d))));
      else if (event.key === 'Enter' || event.key === ' ') this.choose(this.cursor);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
    canvas.addEventListener('pointermove', (event) => {
      if (this.axes) {
        const box = canvas.getBoundingClientRect();
        this.point(this.cellAt((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height));
      }
    });
    what.addEventListener('change', () => this.draw());
  }
  static get count() { return 24; } // cells per side
  static get atOnce() { return 100; } // cells per request
  // Returns the order in which cells are computed: first every fourth cell of every fourth row, then those between.
  static order() {
    const list = [], seen = new Set(), n = ValueMap.count;
    for (const step of [8, 4, 2, 1])
      for (let j = step >> 1; j < n; j += step)
        for (let i = step >> 1; i < n; i += step)
          if (!seen.has(j * n + i)) {
            seen.add(j * n + i);
            list.push([i, j]);
          }
    return list;
  }
  cellAt(x, y) {
    const n = ValueMap.count, inside = (v) => Math.min(n - 1, Math.max(0, Math.floor(v * n)));
    return [inside(x), inside(1 - y)];
  }
  valueAt(axis, k) {
    const v = axis.least + ((axis.most - axis.least) * (k + 0.5)) / ValueMap.count;
    return axis.isWhole ? Math.round(v) : v;
  }
  choose([i, j]) {
    if (this.axes) this.onChoose(this.valueAt(this.axes[0], i), this.valueAt(this.axes[1], j));
  }

  // Fills the map until it is complete, stopped or restarted. An axis is { path, label, unit, least, most, isWhole }.
  async start(axes) {
    const generation = ++this.generation;
    this.axes = axes;
    this.cells.clear();
    this.names = new Set();
    this.cursor = this.cursor || [ValueMap.count >> 1, ValueMap.count >> 1];
    let left = ValueMap.order();
    this.draw();
    while (left.length && generation === this.generation) {
      const some = left.slice(0, ValueMap.atOnce),
            answer = await this.ask(axes[0].path, axes[1].path, some.map(([i, j]) => [this.valueAt(axes[0], i), this.valueAt(axes[1], j)]));
      if (generation !== this.generation || !answer) return;
      answer.cells.forEach((cell, k) => {
        this.cells.set(some[k].join(), cell);
        for (const name of Object.keys(cell.shares || {})) this.names.add(name);
      });
      left = left.slice(answer.cells.length);
      if (!answer.cells.length) await new Promise((resolve) => setTimeout(resolve, 60)); // waits, because the server was busy with a run
      this.offer();
      this.draw();
    }
  }
  stop() { ++this.generation; }
  get isWhole() { return this.cells.size === ValueMap.count ** 2; }
  // Updates the list of quantities to choose from: verdict, largest utilisation, or that of one limit.
  offer() {
    const had = this.what.value, wanted = ['verdict', 'nearest limit', ...this.names];
    if (this.what.options.length === wanted.length) return;
    this.what.replaceChildren(...wanted.map((name) => steplap.make('option', { value: name }, name)));
    this.what.value = wanted.includes(had) ? had : 'verdict';
  }
  // Returns the selected utilisation of a cell; undefined if it has none.
  shareOf(cell) {
    const shares = cell.shares || {};
    if (this.what.value in shares) return shares[this.what.value];
    return Math.max(...Object.values(shares).filter((v) => v !== null));
  }
  colourOf(cell) {
    const style = getComputedStyle(document.documentElement), named = (name) => style.getPropertyValue(`--${name}`).trim();
    if (cell.error) return null;
    if (this.what.value === 'verdict' || !this.what.value)
      return named({ hold: 'good', inspect: 'warn-bar', reject: 'bad' }[cell.verdict] || 'plain');
    const share = this.shareOf(cell);
    if (!Number.isFinite(share)) return named('plain');
    // light to dark green up to the limit, orange to red beyond it
    if (share <= 1) return `hsl(165 70% ${Math.round(88 - 56 * Math.max(0, share))}%)`;
    return `hsl(${Math.round(32 - 32 * Math.min(1, share - 1))} 85% ${Math.round(58 - 24 * Math.min(1, share - 1))}%)`;
  }
  draw() {
    const n = ValueMap.count, context = this.canvas.getContext('2d'), size = this.canvas.width / n;
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    for (const [key, cell] of this.cells) {
      const [i, j] = key.split(',').map(Number), colour = this.colourOf(cell), x = i * size, y = (n - 1 - j) * size;
      context.fillStyle = context.strokeStyle = colour || '#888';
      if (colour) context.fillRect(x, y, size, size);
      else {
        context.beginPath();
        context.moveTo(x + 2, y + 2);
        context.lineTo(x + size - 2, y + size - 2);
        context.stroke();
      } // no valid model, or no run
      if (this.what.value !== 'verdict' && this.what.value && !cell.error && this.shareOf(cell) > 1) {
        context.fillStyle = '#0008';
        context.fillRect(x + size / 2 - 1, y + size / 2 - 1, 2, 2);
      } // told by more than its colour
    }
    if (this.axes && this.here) this.cross(context, size);
    this.tell();
  }
  // Draws a cross at the values of the sliders.
  cross(context, size) {
    const n = ValueMap.count, place = this.axes.map((a, k) => ((this.here[k] - a.least) / (a.most - a.least)) * n * size), x = place[0],
          y = n * size - place[1];
    context.lineWidth = 3;
    context.strokeStyle = '#fff';
    for (let pass = 0; pass < 2; ++pass) {
      context.beginPath();
      context.moveTo(x - 7, y);
      context.lineTo(x + 7, y);
      context.moveTo(x, y - 7);
      context.lineTo(x, y + 7);
      context.stroke();
      context.lineWidth = 1.4;
      context.strokeStyle = '#000';
    }
  }
  setHere(values) {
    this.here = values;
    if (this.axes) this.draw();
  }
  point(cell) {
    this.cursor = cell;
    this.tell();
  }
  tell() {
    if (!this.axes) return;
    const n = ValueMap.count ** 2, [x, y] = this.axes, quantity = (axis, k) => steplap.data.quantity(this.valueAt(axis, k), axis.unit, 3),
          cell = this.cells.get(this.cursor.join());
    const found = !cell ? 'not computed yet'
                        : cell.error ||
        `${cell.verdict}, ${this.what.value && this.what.value !== 'verdict' ? this.what.value : 'nearest limit'}: ${
          steplap.numbers.percent(this.shareOf(cell))}`;
    this.text.textContent = `${x.label} ${quantity(x, this.cursor[0])}, ${y.label} ${quantity(y, this.cursor[1])}: ${found}. ${
      this.cells.size < n ? `${this.cells.size} of ${n} runs.` : ''} Errors are not estimated here.`;
    this.canvas.setAttribute('aria-label',
      `Map of ${x.label} from ${steplap.data.quantity(x.least, x.unit, 3)} to ${steplap.data.quantity(x.most, x.unit, 3)} and ${
        y.label} from ${steplap.data.quantity(y.least, y.unit, 3)} to ${
        steplap.data.quantity(y.most, y.unit, 3)}. Arrows look around, Enter takes the pair.`);
  }
};
