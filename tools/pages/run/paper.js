// Draws a figure of curves for printing and for files, over the visible time window.
steplap.paper = (() => {
  const make = steplap.make;
  const width = 345, left = 50, right = 6, rowHeight = 10;

  // Draws the axes with numbers. Returns the functions that convert times and values to positions.
  function axes(svg, plot, [t0, t1], [y0, y1], top, h) {
    const w = width - left - right;
    const x = (t) => left + (w * (t - t0)) / (t1 - t0), y = (v) => top + (h * (y1 - v)) / (y1 - y0);
    const line = (xa, ya, xb, yb, colour) => svg.append(make('line', { x1: xa, y1: ya, x2: xb, y2: yb, style: `stroke:var(--${colour})` }));
    const text = (content, attributes) => svg.append(make('text', { 'font-size': 8, style: 'fill:var(--ink)', ...attributes }, content));
    const values = steplap.axes.ticks(y0, y1, 6), times = steplap.axes.ticks(t0, t1, 8);
    for (const v of values.values) {
      line(left, y(v), left + w, y(v), 'grid');
      text(steplap.axes.label(v, values.step), { x: left - 4, y: y(v) + 3, 'text-anchor': 'end' });
    }
    for (const t of times.values) {
      line(x(t), top, x(t), top + h, 'grid');
      text(steplap.axes.label(t, times.step), { x: x(t), y: top + h + 11, 'text-anchor': 'middle' });
    }
    text('t [s]', { x: left + w / 2, y: top + h + 26, 'text-anchor': 'middle' });
    text(`[${plot.scale.unit || '–'}]`, { x: 9, y: top + h / 2, 'text-anchor': 'middle', transform: `rotate(-90 9 ${top + h / 2})` });
    return { x, y, w, text };
  }
  function pathOf(s, factor, t0, t1, x, y) {
    let path = '', isDown = false;
    for (let i = 0; i < s.channel.length; ++i) {
      const t = s.channel.times[i], v = s.sign * s.channel.value(i) * factor;
      if (t < t0 || t > t1 || !isFinite(v)) {
        isDown = false;
        continue;
      }
      path += `${isDown ? 'L' : 'M'}${x(t).toFixed(1)} ${y(v).toFixed(1)}`;
      isDown = true;
    }
    return path || 'M0 0';
  }
  const dashed = (dash) => (dash || []).map((d) => 0.6 * d).join(' ');

  function draw(plot) {
    const keys = plot.series.filter((s) => !s.isBound || s.sign > 0), top = 16 + rowHeight * keys.length, height = 159 + top,
          h = height - top - 30;
    const [t0, t1] = plot.graph.xAxisRange(), range = plot.graph.yAxisRange(), factor = plot.scale.factor;
    const svg = make('svg', { viewBox: `0 0 ${width} ${height}`, class: 'on-paper', role: 'img', 'aria-label': plot.caption });
    const { x, y, w, text } = axes(svg, plot, [t0, t1], range, top, h);
    for (const { t, style } of plot.eventLines())
      if (t >= t0 && t <= t1)
        svg.append(make('line', {
          x1: x(t),
          x2: x(t),
          y1: top,
          y2: top + h,
          'stroke-width': 0.6,
          'stroke-opacity': 0.45,
          'stroke-dasharray': style.dash.join(' '),
          style: `stroke:var(--${style.colour})`
        }));
    for (const s of plot.drawn)
      svg.append(make('path', {
        d: pathOf(s, factor, t0, t1, x, y),
        fill: 'none',
        'stroke-width': s.isBound ? 0.8 : 1.2,
        'stroke-dasharray': dashed(s.dash),
        style: `stroke:var(--${s.colour})`
      }));
    svg.append(make('rect', { x: left, y: top, width: w, height: h, fill: 'none', style: 'stroke:var(--axis)' }));
    const marks = make('g', { class: 'small' });
    steplap.marks.draw(
      marks, plot, { x, y: (v) => y(v * factor), left, right: left + w, top, bottom: top + h }, (s) => `var(--${s.colour})`);
    svg.append(marks);
    text(plot.caption, { x: left, y: 9, 'font-size': 9, 'font-weight': 600 });
    keys.forEach((s, k) => {
      const line = 16 + rowHeight * k;
      svg.append(make('line', {
        x1: left,
        x2: left + 18,
        y1: line,
        y2: line,
        'stroke-width': 1.2,
        'stroke-dasharray': dashed(s.dash),
        style: `stroke:var(--${s.colour})`
      }));
      text(plot.keyText(s), { x: left + 22, y: line + 2.5 });
    });
    return svg;
  }
  return { draw };
})();
