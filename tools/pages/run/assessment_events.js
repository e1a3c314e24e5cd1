// Table rows and small curves for the events of an assessment.
steplap.events = (() => {
  const make = steplap.make, { table } = steplap.tables, { one, percent, isKnown } = steplap.numbers, A = steplap.assessment;

  // One row per model; data common to the event are in the first row.
  const heads = [
    'event', 'time', 'peaks, with their bandwidth', 'model', 'verdict', 'joints', 'least margin', 'slid', 'slid in all', 'overlap left',
    'probability of slip', 'feet lifted', 'load of allowed', 'clearance left'
  ];
  const numeric = [6, 7, 8, 9, 12];
  const number = (text, value) => ({ text: text === '–' ? '' : text, value });
  const verdictCell = (m) => ({
    text: A.outcomes[m.verdict] || String(m.verdict),
    class: m.verdict in A.outcomes ? m.verdict : 'open',
    full: [m.reason, m.trust].filter((t) => t).join(' ')
  });
  function clearanceText(m) {
    const worst = m.clearances.filter((c) => isKnown(c.left)).sort((a, b) => (b.share ?? -b.left) - (a.share ?? -a.left))[0];
    return worst ? one(worst.left, worst.unit || 'm') : '';
  }
  const peaksOf = (e) => (e.peaks.length ? make('span', { title: e.peaks.map((p) => A.peakText(p)).join('; ') },
                                             ...e.peaks.map((p) => make('span', { class: 'peak' }, A.peakText(p, true))))
                                         : '');
  function rowsOf(e) {
    const common = [String(e.number), A.timeText(e), peaksOf(e)];
    if (!e.models.length) return [[...common, '–', { text: 'not run', class: 'open' }, ...Array(9).fill('')]];
    return e.models.map(
      (m, k) => [...(k ? [String(e.number), '', ''] : common), m.model, verdictCell(m), m.joints.length ? A.slipText(m) : '',
        number(A.marginText(m), m.margin), number(A.slidText(m.slid), m.slid), number(A.slidText(m.slidTotal), m.slidTotal),
        number(percent(m.overlap), m.overlap), m.probability ? A.chanceText(m.probability) : '',
        m.lifted.length   ? m.lifted.join(', ')
          : m.feet.length ? 'none'
                          : '',
        number(percent(m.share), m.share), clearanceText(m)]);
  }
  function tableOf(events) {
    const box = table(heads, events.flatMap(rowsOf), numeric);
    box.firstChild.classList.add('events-table');
    return box;
  }

  // Draws the recorded window, scaled to the event: x solid, y dashed, z dotted.
  function curve(e) {
    const f = e.figure || {}, times = A.list(f.times),
          named = ['x', 'y', 'z'].filter((axis) => A.list(f[axis]).length === times.length && times.length > 1);
    if (!named.length) return null;
    const w = 300, h = 96, left = 44, right = 4, top = 6, bottom = 18,
          size = Math.max(1e-9, ...named.flatMap((axis) => f[axis].filter(isKnown).map(Math.abs)));
    const t0 = times[0], t1 = times[times.length - 1], x = (t) => left + ((w - left - right) * (t - t0)) / (t1 - t0 || 1),
          y = (v) => top + ((h - top - bottom) * (size - v)) / (2 * size);
    const svg = make('svg', { viewBox: `0 0 ${w} ${h}`, role: 'img', 'aria-label': `Event ${e.number}: recorded acceleration` });
    svg.append(make('line', { class: 'zero', x1: left, x2: w - right, y1: y(0), y2: y(0) }));
    for (const axis of named) {
      let path = '', isDown = false;
      times.forEach((t, i) => {
        if (!isKnown(f[axis][i])) {
          isDown = false;
          return;
        }
        path += `${isDown ? 'L' : 'M'}${x(t).toFixed(1)} ${y(f[axis][i]).toFixed(1)}`;
        isDown = true;
      });
      svg.append(make('path', { class: axis, d: path || 'M0 0' }));
    }
    svg.append(make('rect', { class: 'box', x: left, y: top, width: w - left - right, height: h - top - bottom }));
    const text = (content, at) => svg.append(make('text', at, content));
    text(one(size, 'm/s^2'), {
      x: left - 3,
      y: top + 8,
      'text-anchor': 'end',
      textLength: Math.min(left - 4, 6 * one(size, 'm/s^2').length),
      lengthAdjust: 'spacingAndGlyphs'
    });
    text('0', { x: left - 3, y: y(0) + 3, 'text-anchor': 'end' });
    text(one(t0, 's'), { x: left, y: h - 5 });
    text(one(t1, 's'), { x: w - right, y: h - 5, 'text-anchor': 'end' });
    for (const { worst_time: t } of e.models.filter((m) => isKnown(m.worst_time) && m.worst_time >= t0 && m.worst_time <= t1))
      svg.append(
        make('line', { class: 'worst-instant', x1: x(t), x2: x(t), y1: top, y2: h - bottom }, make('title', {}, 'a limit is nearest')));
    const m = e.models.find((q) => q.slipping.length);
    return make('figure', { class: 'curve', 'data-event': e.number }, svg,
      make('figcaption', {},
        `Event ${e.number}, ${A.timeText(e)}: ${
          named.map((axis) => `${axis} ${{ x: 'full', y: 'dashed', z: 'dotted' }[axis]}`).join(', ')}. ${
          m ? `${m.model} ${A.slipText(m)}.` : ''}`));
  }
  const curves = (events) => make('div', { class: 'curves' }, ...events.map(curve).filter((c) => c));

  // Returns all details of one event.
  function details(e) {
    const box = make('div', {});
    const peaks =
      e.peaks.map((p) => [String(p.axis), A.acceleration(p.value, p.unit), one(p.bandwidth, 'Hz'), one(p.velocity_change, 'm/s')]);
    if (peaks.length) box.append(table(['axis', 'peak', 'read up to', 'velocity change'], peaks, [1, 2, 3]));
    const drawing = curve(e);
    if (drawing) box.append(make('div', { class: 'curves' }, drawing));
    for (const m of e.models) {
      box.append(make('h3', {}, `${m.model}: ${A.outcomes[m.verdict] || m.verdict}`),
        make('p', {},
          `${m.reason ? `${m.reason} ` : ''}${m.trust ? `Numerical error: ${m.trust} ` : ''}Probability of slip: ${
            A.chanceText(m.probability)}.`));
      if (m.joints.length)
        box.append(table(['joint', 'slips', 'margin', 'at', 'slid', 'slid in all', 'overlap left'],
          m.joints.map(
            (j) => [j.name,
              { text: j.came_apart ? 'comes apart'
                  : j.slips        ? 'slips'
                                   : 'holds',
                class: j.slips || j.came_apart ? 'reject' : 'hold' },
              A.margin(j), one(j.at, 's'), A.slidText(j.slid), A.slidText(j.slid_total), percent(j.overlap_left)]),
          [2, 3, 4, 5, 6]));
      if (m.feet.length)
        box.append(table(['foot', 'lifts', 'from', 'height'],
          m.feet.map((f) => [f.name, f.lifts ? 'lifts' : 'stays', one(f.from, 's'), one(f.height, 'm')]), [2, 3]));
      if (m.reactions.length)
        box.append(table(['reaction', 'largest', 'allowed', 'share'],
          m.reactions.map((r) => [r.name, one(r.value, r.unit), one(r.allowed, r.unit), percent(r.share)]), [1, 2, 3]));
      if (m.clearances.length)
        box.append(table(['clearance', 'left', 'limit'],
          m.clearances.map((c) => [c.name, one(c.left, c.unit || 'm'), one(c.allowed, c.unit || 'm')]), [1, 2]));
      if (m.findings.length) box.append(make('ul', {}, ...m.findings.map((f) => make('li', {}, f))));
    }
    return box;
  }
  // Builds the details only when the reader opens them, because a voyage may have hundreds of events.
  function fold(e) {
    const box = make('details', { class: 'event', 'data-event': e.number },
      make('summary', {},
        `Event ${e.number}, ${A.timeText(e)}: ${
          e.models.map((m) => `${m.model} ${A.outcomes[m.verdict] || m.verdict}`).join('; ') || 'not run'}`));
    box.addEventListener('toggle', () => {
      if (box.open && box.children.length === 1) box.append(details(e));
    });
    return box;
  }
  return { tableOf, curve, curves, fold, details };
})();
