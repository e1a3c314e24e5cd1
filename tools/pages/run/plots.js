// Time histories in dygraphs. Zoom and pan are linked between all figures and with the time of the drawing.
steplap.Plots = (() => {
  const make = steplap.make;
  const curves = 7; // number of curve colours: --curve-1 to --curve-7 in page.css
  const dashes = [null, [8, 3], [3, 3], [10, 3, 2, 3]];
  const eventStyles = [
    { roles: ['slip', 'apart', 'break'], colour: 'slips', dash: [], name: 'slips' },
    { roles: ['stick'], colour: 'good', dash: [6, 3], name: 'sticks' },
    { roles: ['open', 'close', 'strike'], colour: 'axis', dash: [2, 3], name: 'opens or closes' }
  ];
  const styleOf = (role) => eventStyles.find((s) => s.roles.includes(role));
  const resolved = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

  class Plot {
    constructor(owner, figure, runs) {
      Object.assign(this, { owner, figure, runs, series: [] });
      for (const run of runs) {
        for (const name of run.matching(figure.channels)) this.addSeries(run, name, 1, false);
        for (const name of run.matching(figure.bounds || []))
          for (const sign of [1, -1]) this.addSeries(run, name, sign, true);
      }
      this.drawn = this.series.filter((s) => !s.isZero);
      this.limits = steplap.marks.limitsOf(this.drawn);
      const of = steplap.data.runs.length > 1 ? ` (${runs.map((r) => r.name).join(', ')})` : '', name = `${figure.name}${of}`;
      this.caption = (figure.title ? `${figure.name}: ${figure.title}` : figure.name) + of;
      this.box = make('figure', { class: 'plot', 'data-plot': figure.name, 'aria-label': this.caption }, make('h3', {}, this.caption));
      this.values = make('div', { class: 'values' });
      this.area = make('div', { class: 'graph' });
      this.box.append(this.values);
      if (!this.drawn.length) return;
      this.box.append(this.area, steplap.save.buttons({
        CSV: () => steplap.save.file(`${name}.csv`, 'text/csv', this.csv()),
        SVG: () => steplap.onPaper(() => steplap.save.svg(this.paperDrawing(), name)),
        PNG: () => steplap.onPaper(() => steplap.save.png(this.paperDrawing(), name))
      }));
      this.cursor = make('div', { class: 'cursor' });
      this.eventName = make('div', { class: 'event-name', role: 'status', hidden: '' });
      this.area.addEventListener('mousemove', ({ clientX }) => {
        if (this.graph) this.nameEvents(clientX - this.area.getBoundingClientRect().left);
      });
      this.area.addEventListener('mouseleave', () => { this.eventName.hidden = true; });
      this.overlay = make('svg', { class: 'marks', 'aria-hidden': 'true' });
      this.area.addEventListener('dblclick', () => setTimeout(() => this.owner.zoomOut())); // returns to the scale of all figures
    }
    addSeries(run, name, sign, isBound) {
      const prior = this.series.find((s) => s.name === name && s.isBound === isBound),
            own = this.series.filter((s) => s.run === run && !s.isBound).length;
      const number = new Set(this.series.filter((s) => !s.isBound).map((s) => s.name)).size % curves;
      const colour = isBound ? 'bound' : prior ? prior.colour : `curve-${number + 1}`;
      const label = (isBound ? (sign > 0 ? '+' : '−') : '') + name + (this.runs.length > 1 ? `, ${run.name}` : '');
      this.series.push({
        run,
        name,
        channel: run.channel(name),
        sign,
        isBound,
        colour,
        label,
        isZero: steplap.numbers.isRounding(run, name),
        dash: isBound ? [2, 3] : dashes[Math.max(this.runs.indexOf(run), own % dashes.length)]
      });
    }
    keyText(s) { return (s.isBound ? '±' : '') + s.label.replace(/^\+/, '') + (s.isZero ? ' stays 0' : ''); }
    draw() {
      if (!this.series.length) {
        this.values.textContent = 'No such channel in this run.';
        return;
      }
      const [low, high] = this.owner.rangeOf(this.figure, this.owner.full);
      this.scale = steplap.data.scaleFor(this.series[0].channel.unit, Math.max(Math.abs(low), Math.abs(high)));
      this.keys();
      if (!this.drawn.length) return;
      const labels = ['t'], options = {};
      this.drawn.forEach((s, i) => {
        labels.push(`s${i}`);
        options[`s${i}`] = {
          color: resolved(s.colour),
          strokePattern: s.dash,
          strokeWidth: s.isBound ? 1.2 : 1.8,
          connectSeparatedPoints: true
        };
      });
      const range = this.valueRange();
      this.graph = new Dygraph(this.area, this.rows(this.scale.factor), {
        labels,
        series: options,
        legend: 'never',
        xlabel: 't [s]',
        ylabel: this.unitLabel(),
        dateWindow: this.owner.window,
        valueRange: range,
        gridLineColor: resolved('grid'),
        axisLineColor: resolved('axis'),
        axisLabelFontSize: 12,
        xLabelHeight: 17,
        yLabelWidth: 17,
        highlightCircleSize: 0,
        axes: {
          y: { axisLabelWidth: this.labelWidth(range), ticker: (a, b, pixels) => this.ticker(a, b, Math.max(3, Math.floor(pixels / 34))) },
          x: { ticker: (a, b, pixels) => this.ticker(a, b, Math.max(3, Math.floor(pixels / 70))) }
        },
        drawCallback: (g, isInitial) => {
          if (!isInitial) this.owner.follow(this, g.xAxisRange());
          this.graph = g;
          this.place();
          this.mark();
        },
        underlayCallback: (context, rect, g) => this.drawEvents(context, rect, g),
        clickCallback: (event, x) => this.owner.onTime(this.graph.toDataXCoord(event.offsetX) || x),
      });
      this.area.append(this.overlay, this.cursor, this.eventName);
      this.mark();
      this.show(this.owner.t);
    }
    // Replaces run `from` by `to` in a figure. Returns false if `to` lacks a channel; the figure must then be rebuilt.
    replaceRun(from, to) {
      if (!this.series.every((s) => s.run !== from || to.channel(s.name))) return false;
      this.runs = this.runs.map((r) => (r === from ? to : r));
      for (const s of this.series)
        if (s.run === from) Object.assign(s, { run: to, channel: to.channel(s.name) });
      this.limits = steplap.marks.limitsOf(this.drawn);
      return true;
    }
    // Redraws the present values of the series.
    refresh() {
      if (!this.graph) return;
      const [low, high] = this.owner.rangeOf(this.figure, this.owner.full);
      this.scale = steplap.data.scaleFor(this.series[0].channel.unit, Math.max(Math.abs(low), Math.abs(high)));
      this.keys();
      const valueRange = this.valueRange();
      this.graph.updateOptions({
        file: this.rows(this.scale.factor),
        dateWindow: this.owner.window,
        valueRange,
        ylabel: this.unitLabel(),
        axes: { y: { axisLabelWidth: this.labelWidth(valueRange) } }
      });
      this.show(this.owner.t);
    }
    unitLabel() { return `${this.scale.unit ? '[' + this.escaped(this.scale.unit) + ']' : '[–]'}`; }
    ticker(low, high, most) {
      const { values, step } = steplap.axes.ticks(low, high, most);
      return values.map((v) => ({ v, label: steplap.axes.label(v, step) }));
    }
    // Returns the width of the labels of the vertical axis, pixels.
    labelWidth([low, high]) { return 24 + 7.4 * Math.max(3, ...this.ticker(low, high, 6).map((tick) => tick.label.length)); }
    // Returns the value range of a figure over all runs, extended to nearby limits and by space for the labels of extremes.
    valueRange() {
      let [low, high] = this.owner.rangeOf(this.figure, this.owner.window);
      if (!(low <= high)) return [0, 1];
      for (const { value } of this.owner.limitsOf(this.figure))
        if (steplap.marks.isNear(value, low, high)) {
          low = Math.min(low, value);
          high = Math.max(high, value);
        }
      const room = 0.13 * (high - low) || 0.1 * Math.abs(high) || 1 / this.scale.factor;
      return [(low - room) * this.scale.factor, (high + room) * this.scale.factor];
    }
    zoomTo(window) {
      if (!this.graph) return;
      const valueRange = this.valueRange();
      this.graph.updateOptions({ dateWindow: window, valueRange, axes: { y: { axisLabelWidth: this.labelWidth(valueRange) } } });
    }
    escaped(text) { return text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`); }
    // Returns one row for each time of any series; dygraphs connects points across missing values.
    rows(factor) {
      const list = this.drawn, times = list[0].channel.times, value = (s, i) => {
        const v = s.sign * s.channel.value(i) * factor;
        return isFinite(v) ? v : NaN;
      };
      if (list.every((s) => s.channel.times === times)) return Array.from(times, (t, i) => [t, ...list.map((s) => value(s, i))]);
      const rows = new Map();
      list.forEach((s, k) => {
        for (let i = 0; i < s.channel.length; ++i) {
          const t = s.channel.times[i];
          if (!rows.has(t)) rows.set(t, [t, ...list.map(() => null)]);
          rows.get(t)[k + 1] = value(s, i);
        }
      });
      return [...rows.values()].sort((a, b) => a[0] - b[0]);
    }
    keys() {
      this.values.replaceChildren();
      for (const s of this.series) {
        if (s.isBound && s.sign < 0) continue;
        const line = make('line', {
          x1: 0,
          y1: 4.5,
          x2: 30,
          y2: 4.5,
          'stroke-width': 2.2,
          'stroke-dasharray': (s.dash || []).join(' '),
          style: `stroke:var(--${s.colour})`
        });
        s.readout = s.isZero ? null : make('span', { class: 'readout' });
        this.values.append(make('span', { class: 'key', title: s.run.meaning(s.name) }, make('svg', { viewBox: '0 0 30 9' }, line),
          `${this.keyText(s)} `, s.readout || ''));
      }
      const [low, high] = this.owner.rangeOf(this.figure, this.owner.full),
                  far = this.limits.filter(({ value }) => !steplap.marks.isNear(value, low, high));
      // limits of equal magnitude on both sides of zero get one label
      const texts = steplap.data.unique([far.map((f) => f.text.replace('−', ''))]);
      if (far.length) this.values.append(make('span', { class: 'key far' }, `${texts.join(', ')}: beyond this picture`));
    }
    // Returns true if events of this element are marked: the selected element, or those whose channels the figure shows.
    isMarked(element) {
      const { eventsOf } = this.owner;
      if (eventsOf === 'own') return this.series.some((s) => s.name.startsWith(`${element}.`));
      return eventsOf === 'all' || eventsOf === `of ${element}`;
    }
    // Returns the times marked by lines, with style and text.
    eventLines() {
      const of = (run) => run.events.filter(([, who, , , role]) => styleOf(role) && this.isMarked(who));
      const words = (run, [, who, what, text]) => `${who} ${what} at ${text}${this.runs.length > 1 ? `, ${run.name}` : ''}`;
      return this.runs.flatMap((run) => of(run).map((e) => ({ t: e[0], style: styleOf(e[4]), text: words(run, e) })));
    }
    // Shows the names of events near the pointer, `x` pixels from the left of the figure.
    nameEvents(x) {
      const reach = 4, mostNamed = 4; // distance in pixels; largest number of names
      const near = this.eventLines().filter(({ t }) => Math.abs(this.graph.toDomXCoord(t) - x) <= reach).map((line) => line.text);
      const more = near.length > mostNamed ? [`and ${near.length - mostNamed} more`] : [];
      this.eventName.textContent = [...near.slice(0, mostNamed), ...more].join('\n');
      this.eventName.hidden = !near.length;
      this.eventName.style.left = `${Math.min(x + 8, 0.5 * this.area.clientWidth)}px`;
    }
    drawEvents(context, rect, g) {
      const lines = this.eventLines(), isDense = lines.length > 120; // many lines would hide the curves
      for (const { t, style } of lines) {
        const x = g.toDomXCoord(t);
        if (x < rect.x || x > rect.x + rect.w) continue;
        context.save();
        context.strokeStyle = resolved(style.colour);
        context.globalAlpha = isDense ? 0.15 : 0.55;
        context.lineWidth = 1;
        context.setLineDash(style.dash);
        context.beginPath();
        context.moveTo(x, rect.y);
        context.lineTo(x, rect.y + rect.h);
        context.stroke();
        context.restore();
      }
    }
    mark() {
      if (!this.graph || !this.overlay) return;
      const area = this.graph.getArea(), g = this.graph;
      steplap.marks.draw(this.overlay, this, {
        x: (t) => g.toDomXCoord(t),
        y: (v) => g.toDomYCoord(v * this.scale.factor),
        left: area.x,
        right: area.x + area.w,
        top: area.y,
        bottom: area.y + area.h
      },
        (s) => `var(--${s.colour})`);
    }
    // Returns the visible curves in their displayed units as CSV: one column per curve, one row per time of any of them.
    csv() {
      const [from, to] = this.graph.xAxisRange(), list = this.series.filter((s) => !s.isBound || s.sign > 0);
      const cell = (text) => (/[",\n\r]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
      const heads =
        ['t [s]', ...list.map((s) => cell(`${s.name} [${s.channel.unit || '1'}]${this.runs.length > 1 ? `, ${s.run.name}` : ''}`))];
      const rows = new Map();
      list.forEach((s, k) => {
        for (let i = 0; i < s.channel.length; ++i) {
          const t = s.channel.times[i];
          if (t < from || t > to) continue;
          if (!rows.has(t)) rows.set(t, list.map(() => ''));
          rows.get(t)[k] = String(s.channel.value(i));
        }
      });
      const lines = [...rows].sort((a, b) => a[0] - b[0]).map(([t, values]) => [t, ...values].join(','));
      return [heads.join(','), ...lines].join('\n') + '\n';
    }
    paperDrawing() {
      this.drawForPaper();
      return this.paper;
    }
    drawForPaper() {
      if (!this.graph) return;
      if (this.paper) this.paper.remove();
      this.paper = steplap.paper.draw(this);
      this.box.append(this.paper);
    }
    place() {
      if (!this.graph || !this.cursor) return;
      const [low, high] = this.graph.xAxisRange(), t = this.owner.t;
      this.cursor.style.display = t >= low && t <= high ? '' : 'none';
      this.cursor.style.left = `${this.graph.toDomXCoord(t)}px`;
    }
    show(t) {
      if (!this.graph) return;
      this.place();
      for (const s of this.series)
        if (s.readout)
          s.readout.textContent =
            steplap.numbers.onScale(s.channel.at(t), this.scale, { rounding: steplap.numbers.roundingOf(s.run, s.channel.unit) });
    }
  }

  return class Plots {
    constructor(grid, onTime) {
      Object.assign(this, { grid, onTime, t: 0, plots: [], extra: [], isFollowing: false, layout: 'beside', eventsOf: 'own' });
      this.full = [0, Math.max(...steplap.data.runs.map((r) => r.end))];
      this.window = this.full;
      this.figures = steplap.figures.of(steplap.data.runs);
      document.getElementById('event-key').textContent = `Vertical lines: ${
        eventStyles.map((s, i) => `${s.name} (${['solid', 'dashed', 'dotted'][i]})`)
          .join(', ')}. A dot marks the worst value of a curve: the lowest of a margin, the largest of others.`;
    }
    // Returns minimum and maximum over all runs of a figure within a time window, including extremes between samples.
    rangeOf(figure, [from, to]) {
      let low = Infinity, high = -Infinity;
      const take = (v) => {
        if (isFinite(v)) {
          low = Math.min(low, v);
          high = Math.max(high, v);
        }
      };
      for (const plot of this.plots) {
        if (plot.figure !== figure) continue;
        for (const s of plot.drawn.length ? plot.drawn : plot.series) {
          const times = s.channel.times;
          for (let i = Math.max(0, steplap.data.indexBefore(times, from)); i < s.channel.length; ++i) {
            take(s.sign * s.channel.value(i));
            if (times[i] > to) break;
          }
          const e = steplap.marks.extremeOf(s);
          if (e && e.t >= from && e.t <= to) take(e.value);
        }
      }
      return [low, high];
    }
    limitsOf(figure) { return this.plots.filter((p) => p.figure === figure).flatMap((p) => p.limits); }
    build() {
      for (const plot of this.plots)
        if (plot.graph) plot.graph.destroy();
      const runs = steplap.data.runs, isBeside = this.layout === 'beside' && runs.length > 1;
      this.grid.style.setProperty('--columns', isBeside ? Math.min(runs.length, 3) : 2);
      this.plots = [];
      for (const figure of [...this.figures, ...this.extra])
        for (const some of isBeside ? runs.map((r) => [r]) : [runs]) this.plots.push(new Plot(this, figure, some));
      this.grid.replaceChildren(...this.plots.map((p) => p.box));
      for (const plot of this.plots) plot.draw();
    }
    add(channel) {
      this.extra.push({ name: channel, title: '', channels: [channel.replace(/[*?]/g, '?')], bounds: [] });
      this.build();
    }
    // Returns the figure that shows a channel of a run; creates it if there is none.
    figureWith(channel, run) {
      const has = (p) => p.graph && p.runs.includes(run) && p.drawn.some((s) => s.name === channel && s.run === run);
      if (!this.plots.some(has) && run.channel(channel)) this.add(channel);
      return this.plots.find(has) || this.plots.find((p) => p.series.some((s) => s.name === channel));
    }
    // Copies the time window of one figure to all others.
    follow(source, range) {
      if (this.isFollowing || (range[0] === this.window[0] && range[1] === this.window[1])) return;
      this.zoom([...range]);
    }
    zoom(window) {
      this.isFollowing = true;
      this.window = window;
      for (const plot of this.plots) plot.zoomTo(window);
      this.isFollowing = false;
    }
    zoomOut() { this.zoom([...this.full]); }
    // Draws the figures for printing as vector graphics, because canvases would print at screen resolution.
    preparePrint() {
      for (const plot of this.plots) plot.drawForPaper();
    }
    show(t) {
      this.t = t;
      for (const plot of this.plots) plot.show(t);
    }
  };
})();
