// Marks on curves: limits as lines, and the largest value of each curve as a dot with its value. Texts that would overlap or leave the
// figure are moved; if there is no room, only the dot is drawn, with its value in the tooltip.
steplap.marks = (() => {
  const make = steplap.make, { one, onScale, isKnown } = steplap.numbers;
  const most = 4; // largest number of dots with a value in a figure

  // Returns the limits of a figure's curves in the unit of the curves: [{ value, text }].
  function limitsOf(series) {
    const found = [];
    for (const s of series) {
      if (s.isBound || s.sign < 0) continue;
      for (const { limit, isBoth } of steplap.quantities.limitsOf(s.run).get(s.name) || [])
        for (const value of isBoth ? [limit, -limit] : [limit])
          if (!found.some((f) => Math.abs(f.value - value) <= 1e-9 * Math.abs(value)))
            found.push({ value, text: `limit ${one(value, s.channel.unit)}` });
    }
    return found;
  }
  // Returns true for limits that are close to the values of the curves, so that the axis is extended to show them.
  const isNear = (value, low, high) =>
    Math.abs(value) <= 1.6 * Math.max(Math.abs(low), Math.abs(high)) && (value >= 0 ? high > 0 || value <= high : low < 0);

  // Returns the extreme to be marked: the one that a criterion limits, the minimum of a margin, otherwise the one with the larger
  // magnitude.
  function worstEnd(s, e) {
    const u = steplap.overview.of(s.run).utilisations.find((each) => each.channel === s.name && isKnown(each.value));
    if (u && (u.value === e.min || u.value === e.max)) return u.value === e.min ? 'min' : 'max';
    if (s.name.endsWith('margin')) return 'min';
    return Math.abs(e.min) > Math.abs(e.max) ? 'min' : 'max';
  }
  function extremeOf(s) {
    const e = s.run.summary.extremes[s.name];
    if (s.isBound || !e || !isKnown(e.min) || !isKnown(e.max) || s.isZero) return null;
    const key = worstEnd(s, e);
    return isFinite(e[key]) && isKnown(e[`t_${key}`]) && e.max > e.min ? { s, t: e[`t_${key}`], value: e[key], error: e[`error_${key}`] }
                                                                       : null;
  }
  // Returns the estimated width of a text of 11 pixels height, with a margin.
  const widthOf = (text) => 6.9 * text.length + 6;
  const meet = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];

  // Draws the marks. `place`: { x(t), y(value), left, top, right, bottom } in pixels of `svg`. `colourOf(series)` returns a CSS colour.
  function draw(svg, { drawn: series, limits, scale }, place, colourOf) {
    svg.replaceChildren();
    const taken = [];
    const write = (text, spots, style) => {
      for (const [x, y, anchor] of spots) {
        const w = widthOf(text),
              from = anchor === 'end' ? x - w
          : anchor === 'middle'       ? x - w / 2
                                      : x,
              box = [from, y - 10, from + w, y + 3];
        if (box[0] < place.left || box[2] > place.right || box[1] < place.top || box[3] > place.bottom || taken.some((b) => meet(b, box)))
          continue;
        taken.push(box);
        svg.append(
          make('text', { x: x +
              (anchor === 'start'    ? 3
                  : anchor === 'end' ? -3
                                     : 0),
            y,
            'text-anchor': anchor,
            class: 'mark-text',
            style },
            text));
        return;
      }
    };
    for (const { value, text } of limits) {
      const y = place.y(value);
      if (!(y > place.top && y < place.bottom)) continue;
      svg.append(make('line', { x1: place.left, x2: place.right, y1: y, y2: y, class: 'limit-line' }));
      write(text, [[place.right, y - 4, 'end'], [place.right, y + 13, 'end'], [place.left, y - 4, 'start']], 'fill:var(--bad)');
    }
    const dots = series.map(extremeOf).filter((e) => e && place.x(e.t) >= place.left - 1 && place.x(e.t) <= place.right + 1).slice(0, most);
    for (const { s, t, value } of dots) {
      const x = place.x(t), y = place.y(value);
      if (y < place.top - 1 || y > place.bottom + 1) continue;
      svg.append(make('circle', { cx: x, cy: y, r: 3.4, class: 'extreme', style: `fill:${colourOf(s)}`, 'data-channel': s.name }));
      taken.push([x - 4, y - 4, x + 4, y + 4]);
    }
    for (const { s, t, value, error } of dots) {
      const text = onScale(value, scale, { error });
      const x = place.x(t), y = place.y(value), above = [[x, y - 7, 'middle'], [x + 4, y - 6, 'start'], [x - 4, y - 6, 'end']],
            below = [[x, y + 16, 'middle'], [x + 4, y + 15, 'start'], [x - 4, y + 15, 'end']];
      const aside = [[x + 5, y + 4, 'start'], [x - 5, y + 4, 'end']];
      if (y >= place.top - 1 && y <= place.bottom + 1)
        write(text, value >= 0 ? [...above, ...aside, ...below] : [...below, ...aside, ...above], `fill:${colourOf(s)}`);
    }
  }
  return { limitsOf, isNear, extremeOf, draw };
})();
