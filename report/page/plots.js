// Time histories in dygraphs: zoom and pan linked over all of them and with the time of the drawing.
steplap.Plots = (() => {
  const make = steplap.make;
  const colours = ['#0072b2', '#d55e00', '#007a5a', '#a8487c', '#e69f00', '#3a3a3a', '#56b4e9'];
  const dashes = [null, [8, 3], [3, 3], [10, 3, 2, 3]];
  const eventStyles = [
    { roles: ['slip', 'apart'], colour: '#d55e00', dash: [], name: 'slips' },
    { roles: ['stick'], colour: '#007a5a', dash: [6, 3], name: 'sticks' },
    { roles: ['open', 'close'], colour: '#8a8a8a', dash: [2, 3], name: 'opens or closes' }];

  // A figure for each plot of the models; without any, one for each kind of channel that says most.
  function figuresOf(runs) {
    const figures = new Map();
    for (const run of runs)
      for (const plot of run.drawing.plots)
        if (!figures.has(plot.name)) figures.set(plot.name, plot);
    if (figures.size) return [...figures.values()];
    const kinds = [['theta', 'Angles'], ['slide', 'Slides'], ['friction', 'Friction forces'], ['force', 'Forces of elements'], ['couple', 'Couples of elements'],
      ['p_req', 'Pressures that the joints need'], ['margin', 'Margins of the joints'], ['reaction', 'Reactions of drives'], ['x', 'Horizontal positions'], ['y', 'Vertical positions']];
    for (const [ending, title] of kinds) {
      // One axis has one unit: what has another gets a figure of its own.
      const units = new Map();
      for (const r of runs) for (const name of r.matching([`*.${ending}`])) {
        const unit = r.channel(name).unit;
        if (!units.has(unit)) units.set(unit, new Set());
        units.get(unit).add(name);
      }
      for (const [unit, names] of units) {
        const name = units.size > 1 ? `${title}, ${unit || 'shares'}` : title;
        if (figures.size < 6) figures.set(name, { name, title: '', channels: [...names].slice(0, 7), bounds: [] });
      }
    }
    return [...figures.values()];
  }

  class Plot {
    constructor(owner, figure, runs) {
      this.owner = owner;
      this.figure = figure;
      this.series = [];
      for (const run of runs) {
        for (const name of run.matching(figure.channels)) this.addSeries(run, name, runs, 1, false);
        for (const name of run.matching(figure.bounds || [])) for (const sign of [1, -1]) this.addSeries(run, name, runs, sign, true);
      }
      this.runs = runs;
      this.box = make('div', { class: 'plot', 'data-plot': figure.name });
      const caption = figure.title ? `${figure.name}: ${figure.title}` : figure.name;
      const of = steplap.data.runs.length > 1 ? ` (${runs.map((r) => r.name).join(', ')})` : '';
      const name = () => `${figure.name}${of}`;
      this.box.append(make('h3', {}, caption + of), steplap.save.buttons({ CSV: () => steplap.save.file(`${name()}.csv`, 'text/csv', this.csv()),
        SVG: () => steplap.save.svg(this.paperDrawing(), name()), PNG: () => steplap.save.png(this.paperDrawing(), name()) }));
      this.values = make('div', { class: 'values' });
      this.area = make('div', { class: 'graph' });
      this.cursor = make('div', { class: 'cursor' });
      this.box.append(this.values, this.area);
      this.area.addEventListener('dblclick', () => setTimeout(() => this.owner.zoomOut())); // back to the scale of all
    }
    addSeries(run, name, runs, sign, isBound) {
      const channel = run.channel(name);
      const prior = this.series.find((s) => s.name === name && s.isBound === isBound);
      const colour = isBound ? '#6b6b6b' : prior ? prior.colour : colours[new Set(this.series.filter((s) => !s.isBound).map((s) => s.name)).size % colours.length];
      const label = (isBound ? (sign > 0 ? '+' : '−') : '') + name + (runs.length > 1 ? `, ${run.name}` : '');
      this.series.push({ run, name, channel, sign, isBound, colour, label, dash: isBound ? [2, 3] : dashes[Math.max(runs.indexOf(run), this.series.filter((s) => s.run === run && !s.isBound).length % dashes.length)] });
    }
    draw() {
      if (!this.series.length) { this.area.textContent = 'No such channel in this run.'; return; }
      const [low, high] = this.owner.rangeOf(this.figure, this.owner.full);
      const scale = steplap.data.scaleFor(this.series[0].channel.unit, Math.max(Math.abs(low), Math.abs(high)));
      this.scale = scale;
      this.keys();
      const labels = ['t'], options = {};
      this.series.forEach((s, i) => {
        const id = `s${i}`;
        labels.push(id);
        options[id] = { color: s.colour, strokePattern: s.dash, strokeWidth: s.isBound ? 1.2 : 1.8, connectSeparatedPoints: true };
      });
      this.graph = new Dygraph(this.area, this.rows(scale.factor), {
        labels, series: options, legend: 'never', xlabel: 't [s]', ylabel: `${scale.unit ? '[' + this.escaped(scale.unit) + ']' : '[–]'}`,
        dateWindow: this.owner.window, valueRange: this.valueRange(), gridLineColor: '#dddddd', axisLineColor: '#8a8a8a', axisLabelFontSize: 12, xLabelHeight: 17, yLabelWidth: 17, highlightCircleSize: 0, yRangePad: 9,
        axes: { y: { axisLabelWidth: 62, pixelsPerLabel: 34, axisLabelFormatter: (v) => this.tick(v) }, x: { pixelsPerLabel: 70, axisLabelFormatter: (v) => this.tick(v) } },
        drawCallback: (g, isInitial) => { if (!isInitial) this.owner.follow(this, g.xAxisRange()); this.place(); },
        underlayCallback: (context, rect, g) => this.marks(context, rect, g),
        clickCallback: (event, x) => this.owner.onTime(timeAt(this, event, x)),
      });
      this.area.append(this.cursor);
      this.show(this.owner.t);
    }
    // What the other runs show of this figure has the same scale.
    valueRange() {
      const [low, high] = this.owner.rangeOf(this.figure, this.owner.window).map((v) => v * this.scale.factor);
      if (!(low <= high)) return null;
      const room = 0.05 * (high - low) || 0.1 * Math.abs(high) || 1;
      return [low - room, high + room];
    }
    escaped(text) { return text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`); }
    tick(v) { return steplap.data.plain(Math.abs(v) < 1e-12 ? 0 : v, 6); }
    // One row for each time of any series; gaps are bridged by dygraphs.
    rows(factor) {
      const shared = this.series.every((s) => s.channel.times === this.series[0].channel.times);
      const value = (s, i) => { const v = s.sign * s.channel.value(i) * factor; return isFinite(v) ? v : NaN; };
      if (shared) return Array.from(this.series[0].channel.times, (t, i) => [t, ...this.series.map((s) => value(s, i))]);
      const rows = new Map();
      this.series.forEach((s, k) => {
        for (let i = 0; i < s.channel.length; ++i) {
          const t = s.channel.times[i];
          if (!rows.has(t)) rows.set(t, [t, ...this.series.map(() => null)]);
          rows.get(t)[k + 1] = value(s, i);
        }
      });
      return [...rows.values()].sort((a, b) => a[0] - b[0]);
    }
    keys() {
      this.values.replaceChildren();
      for (const s of this.series) {
        if (s.isBound && s.sign < 0) continue;
        const line = make('line', { x1: 0, y1: 4.5, x2: 30, y2: 4.5, stroke: s.colour, 'stroke-width': 2.2, 'stroke-dasharray': (s.dash || []).join(' ') });
        s.readout = make('span');
        this.values.append(make('span', { class: 'key', title: s.run.meaning(s.name) }, make('svg', { viewBox: '0 0 30 9' }, line), (s.isBound ? '±' : '') + s.label.replace(/^\+/, '') + ' ', s.readout));
      }
    }
    marks(context, rect, g) {
      for (const run of this.runs)
        for (const [t, , , , role] of run.events) {
          const style = eventStyles.find((s) => s.roles.includes(role));
          const x = style && g.toDomXCoord(t);
          if (!style || x < rect.x || x > rect.x + rect.w) continue;
          context.save();
          context.strokeStyle = style.colour; context.globalAlpha = 0.75; context.lineWidth = 1; context.setLineDash(style.dash);
          context.beginPath(); context.moveTo(x, rect.y); context.lineTo(x, rect.y + rect.h); context.stroke();
          context.restore();
        }
    }
    // The curves as they are shown, in their own units: a column each, a row for each time that any of them has.
    csv() {
      const [from, to] = this.graph.xAxisRange(), curves = this.series.filter((s) => !s.isBound || s.sign > 0);
      const cell = (text) => (/[",\n\r]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
      const heads = ['t [s]', ...curves.map((s) => cell(`${s.name} [${s.channel.unit || '1'}]${this.runs.length > 1 ? `, ${s.run.name}` : ''}`))];
      const rows = new Map();
      curves.forEach((s, k) => {
        for (let i = 0; i < s.channel.length; ++i) {
          const t = s.channel.times[i];
          if (t < from || t > to) continue;
          if (!rows.has(t)) rows.set(t, curves.map(() => ''));
          rows.get(t)[k] = String(s.channel.value(i));
        }
      });
      const lines = [...rows].sort((a, b) => a[0] - b[0]).map(([t, values]) => [t, ...values].join(','));
      return [heads.join(','), ...lines].join('\n') + '\n';
    }
    paperDrawing() { this.drawForPaper(); return this.paper; }
    drawForPaper() {
      if (!this.graph) return;
      const keys = this.series.filter((s) => !s.isBound || s.sign > 0), width = 345, top = 16 + 10 * keys.length, height = 159 + top, left = 50, w = width - left - 6, h = height - top - 30;
      const [t0, t1] = this.graph.xAxisRange(), [y0, y1] = this.graph.yAxisRange();
      const x = (t) => left + (w * (t - t0)) / (t1 - t0), y = (v) => top + (h * (y1 - v)) / (y1 - y0);
      const svg = make('svg', { viewBox: `0 0 ${width} ${height}`, class: 'on-paper' });
      const line = (x0, ya, x1, yb, style) => svg.append(make('line', { x1: x0, y1: ya, x2: x1, y2: yb, ...style }));
      const text = (content, attributes) => svg.append(make('text', { 'font-size': 8, fill: '#1a1a1a', ...attributes }, content));
      for (const v of ticksBetween(y0, y1, 5)) {
        line(left, y(v), left + w, y(v), { stroke: '#dddddd' });
        text(this.tick(v), { x: left - 4, y: y(v) + 3, 'text-anchor': 'end' });
      }
      for (const t of ticksBetween(t0, t1, 8)) {
        line(x(t), top, x(t), top + h, { stroke: '#eeeeee' });
        text(this.tick(t), { x: x(t), y: top + h + 11, 'text-anchor': 'middle' });
      }
      for (const run of this.runs)
        for (const [t, , , , role] of run.events) {
          const style = eventStyles.find((s) => s.roles.includes(role));
          if (style && t >= t0 && t <= t1) line(x(t), top, x(t), top + h, { stroke: style.colour, 'stroke-width': 0.6, 'stroke-dasharray': style.dash.join(' ') });
        }
      for (const s of this.series) {
        let path = '', isDown = false;
        for (let i = 0; i < s.channel.length; ++i) {
          const t = s.channel.times[i], v = s.sign * s.channel.value(i) * this.scale.factor;
          if (t < t0 || t > t1 || !isFinite(v)) { isDown = false; continue; }
          path += `${isDown ? 'L' : 'M'}${x(t).toFixed(1)} ${y(v).toFixed(1)}`;
          isDown = true;
        }
        svg.append(make('path', { d: path || 'M0 0', fill: 'none', stroke: s.colour, 'stroke-width': s.isBound ? 0.8 : 1.2, 'stroke-dasharray': (s.dash || []).map((d) => 0.6 * d).join(' ') }));
      }
      svg.append(make('rect', { x: left, y: top, width: w, height: h, fill: 'none', stroke: '#8a8a8a' }));
      text('t [s]', { x: left + w / 2, y: height - 4, 'text-anchor': 'middle' });
      text(`[${this.scale.unit || '–'}]`, { x: 9, y: top + h / 2, 'text-anchor': 'middle', transform: `rotate(-90 9 ${top + h / 2})` });
      text(this.box.querySelector('h3').textContent, { x: left, y: 9, 'font-size': 9, 'font-weight': 600 });
      keys.forEach((s, k) => {
        line(left, 16 + 10 * k, left + 18, 16 + 10 * k, { stroke: s.colour, 'stroke-width': 1.2, 'stroke-dasharray': (s.dash || []).map((d) => 0.6 * d).join(' ') });
        text((s.isBound ? '±' : '') + s.label.replace(/^\+/, ''), { x: left + 22, y: 18.5 + 10 * k });
      });
      if (this.paper) this.paper.remove();
      this.paper = svg;
      this.box.append(svg);
    }
    place() {
      if (!this.graph) return;
      const [low, high] = this.graph.xAxisRange(), t = this.owner.t;
      this.cursor.style.display = t >= low && t <= high ? '' : 'none';
      this.cursor.style.left = `${this.graph.toDomXCoord(t)}px`;
    }
    show(t) {
      if (!this.graph) return;
      this.place();
      for (const s of this.series) if (s.readout) s.readout.textContent = steplap.data.quantity(s.channel.at(t), s.channel.unit, 5);
    }
  }
  // Round numbers from low to high, about `count` of them.
  function ticksBetween(low, high, count) {
    const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
    const step = power * [1, 2, 5, 10].find((m) => m * power >= raw), ticks = [];
    for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; ++k) ticks.push(k * step);
    return ticks;
  }
  const timeAt = (plot, event, x) => plot.graph.toDataXCoord(event.offsetX) || x;

  return class Plots {
    constructor(grid, onTime) {
      this.grid = grid; this.onTime = onTime; this.t = 0; this.plots = []; this.extra = [];
      this.full = [0, Math.max(...steplap.data.runs.map((r) => r.end))];
      this.window = this.full; this.isFollowing = false;
      this.figures = figuresOf(steplap.data.runs);
      this.layout = 'beside';
      document.getElementById('event-key').textContent = `Vertical lines: ${eventStyles.map((s, i) => `${s.name} (${['solid', 'dashed', 'dotted'][i]})`).join(', ')}.`;
    }
    // Least and largest value that any run shows in a figure within a window of time.
    rangeOf(figure, [from, to]) {
      let low = Infinity, high = -Infinity;
      for (const plot of this.plots) {
        if (plot.figure !== figure) continue;
        for (const s of plot.series)
          for (let i = Math.max(0, steplap.data.indexBefore(s.channel.times, from)); i < s.channel.length; ++i) {
            const v = s.sign * s.channel.value(i);
            if (isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
            if (s.channel.times[i] > to) break;
          }
      }
      return [low, high];
    }
    build() {
      for (const plot of this.plots) if (plot.graph) plot.graph.destroy();
      const runs = steplap.data.runs, isBeside = this.layout === 'beside' && runs.length > 1;
      this.grid.style.setProperty('--columns', isBeside ? Math.min(runs.length, 3) : 2);
      this.plots = [];
      for (const figure of [...this.figures, ...this.extra])
        for (const some of isBeside ? runs.map((r) => [r]) : [runs]) this.plots.push(new Plot(this, figure, some));
      this.grid.replaceChildren(...this.plots.map((p) => p.box));
      for (const plot of this.plots) plot.draw();
    }
    add(channel) { this.extra.push({ name: channel, title: '', channels: [channel.replace(/[*?]/g, '?')], bounds: [] }); this.build(); }
    // Zoom and pan of one are those of all.
    follow(source, range) {
      if (this.isFollowing || (range[0] === this.window[0] && range[1] === this.window[1])) return;
      this.isFollowing = true;
      this.window = [...range];
      for (const plot of this.plots) if (plot.graph) plot.graph.updateOptions({ dateWindow: this.window, valueRange: plot.valueRange() });
      this.isFollowing = false;
    }
    zoomOut() {
      this.isFollowing = true;
      this.window = [...this.full];
      for (const plot of this.plots) if (plot.graph) plot.graph.updateOptions({ dateWindow: this.window, valueRange: plot.valueRange() });
      this.isFollowing = false;
    }
    // What is printed are drawings of the same window: canvases would be pictures of the screen's size.
    preparePrint() { for (const plot of this.plots) plot.drawForPaper(); }
    show(t) { this.t = t; for (const plot of this.plots) plot.show(t); }
  };
})();
