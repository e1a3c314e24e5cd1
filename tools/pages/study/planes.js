// Diagrams of samples in a plane: border of a map, line of a critical value, curves of a sweep, or any two columns.
study.planes = (() => {
  const { make, data, charts } = study;
  const { colours, cycle, axis, safe } = charts;
  const section = document.getElementById('plane');
  const k_most = 6000; // largest number of points that browsers draw quickly
  const range = (n) => Array.from({ length: n }, (_, i) => i);
  const select = (label, columns, chosen) => {
    const element = make('select', {}, ...columns.map((c) => make('option', { value: c.name }, c.head)));
    if (chosen) element.value = chosen.name;
    return { element, label: make('label', {}, `${label} `, element), get column() { return data.named(element.value); } };
  };
  const looks = [
    { name: 'holds', marker: { size: 5, color: colours.blue, opacity: 0.55 } },
    { name: 'failure', marker: { size: 7, color: colours.vermillion, symbol: 'x-thin', line: { color: colours.vermillion, width: 1.6 } } },
    { name: 'run failed', marker: { size: 7, color: study.charts.ink, symbol: 'square-open' } }
  ];

  // Thins out points, each kind by the same fraction, if there are too many for a browser.
  function thinned(places) {
    const most = Math.floor(k_most / 3);
    let left = k_most - places.reduce((sum, p) => sum + Math.min(p.length, most), 0);
    return places.map((p) => {
      const share = Math.min(p.length, most + Math.max(0, left));
      left -= share - Math.min(p.length, most);
      return range(share).map((k) => p[Math.floor(k * p.length / share)]);
    });
  }
  // Plots all samples by their outcome; prints how many were omitted.
  function cloud(x, y, fate, names = looks.map((l) => l.name)) {
    const places = [[], [], []];
    let unplaced = 0;
    for (let i = 0; i < data.shown; ++i) {
      if (isFinite(x.values[i]) && isFinite(y.values[i])) places[fate(i)].push(i);
      else ++unplaced;
    }
    const drawn = thinned(places), count = drawn.reduce((sum, p) => sum + p.length, 0);
    const traces = drawn
                     .map((list, k) => ({
                       type: 'scatter',
                       mode: 'markers',
                       name: `${names[k]} (${places[k].length})`,
                       x: list.map((i) => x.values[i]),
                       y: list.map((i) => y.values[i]),
                       customdata: list,
                       marker: looks[k].marker,
                       hovertemplate: `${safe(x.name)} %{x:.6g}<br>${safe(y.name)} %{y:.6g}<extra></extra>`
                     }))
                     .filter((t) => t.x.length);
    const each =
      drawn.map((list, k) => (places[k].length ? `${list.length} of ${places[k].length} "${names[k]}"` : '')).filter(Boolean).join(', ');
    const parts = [`Drawn: ${count} of ${data.samples.total} samples${
      count < data.samples.total ? `: ${each}${data.shown < data.samples.total ? ', of those that this page holds' : ''}` : ''}.`];
    if (unplaced)
      parts.push(`${unplaced} have no value of one of the two and have no place here${
        unplaced && [...data.status].some((s) => s) ? ' (runs that failed have none: choose variables for both axes to see where they are)'
                                                    : ''}.`);
    return { traces, note: `${parts.join(' ')} A click on a point shows the sample.` };
  }
  function start(title) {
    section.hidden = false;
    section.querySelector('h2').textContent = title;
    const box = make('div', { class: 'charts one' });
    return box;
  }

  // --- map -------------------------------------------------------------------------------------------
  const pairs = () => data.findings.filter((f) => f.role === 'border' && f.place && f.value !== null);
  function map() {
    const [x, y] = (data.about.settings.variables || []).map(data.named), g = data.columns.find((c) => c.role === 'border');
    if (!x || !y || !g) return scatter();
    const box = start('The border'),
          { traces, note } = cloud(x, y,
            (i) => (data.status[i] ? 2
                : g.values[i] < 0  ? 1
                                   : 0),
            ['not negative', 'negative', 'run failed']);
    for (const t of traces) t.marker = {...t.marker, size: 4, opacity: 0.6 };
    const borders = new Map();
    for (const f of pairs()) {
      const border = borders.get(f.place) || borders.set(f.place, { x: [], y: [] }).get(f.place);
      border[f.variable === x.name ? 'x' : 'y'].push(f.value * (f.variable === x.name ? x : y).factor);
    }
    for (const [k, border] of borders)
      traces.push({
        type: 'scatter',
        mode: 'lines',
        name: `border ${k}`,
        ...border,
        line: { color: study.charts.ink, width: 2.4 },
        hovertemplate: `${safe(x.name)} %{x:.6g}<br>${safe(y.name)} %{y:.6g}<extra>border ${k}</extra>`
      });
    const type = data.about.settings.logarithmic ? { type: 'log' } : {};
    section.append(
      make('p', { class: 'note' }, `Where ${g.is || g.name} is zero; on one side it is negative, on the other it is not.`), box);
    charts.add(box, { name: 'map', traces, note, height: 520, layout: { xaxis: axis(x.head, type), yaxis: axis(y.head, type) } });
  }

  // --- critical value --------------------------------------------------------------------------------
  function critical() {
    const x = data.named(data.about.settings.variable), g = data.columns.find((c) => c.role === 'border');
    if (!x || !g) return scatter();
    const found = data.findings.filter((f) => f.role === 'critical' && f.value !== null),
          order = range(data.shown).filter((i) => isFinite(g.values[i])).sort((a, b) => x.values[a] - x.values[b]);
    const { traces, note } = cloud(x, g,
      (i) => (data.status[i] ? 2
          : g.values[i] < 0  ? 1
                             : 0),
      ['not negative', 'negative', 'run failed']),
                         box = start('The critical value');
    traces.unshift({
      type: 'scatter',
      mode: 'lines',
      showlegend: false,
      hoverinfo: 'skip',
      x: order.map((i) => x.values[i]),
      y: order.map((i) => g.values[i]),
      line: { color: colours.grey, width: 1 }
    });
    const line = (where) =>
      ({ type: 'line', x0: where, x1: where, y0: 0, y1: 1, yref: 'paper', line: { color: colours.green, width: 1.6, dash: 'dash' } });
    section.append(box);
    charts.add(box, {
      name: 'critical',
      traces,
      note: `Dashed: ${found.length} critical value${found.length === 1 ? '' : 's'}. ${note}`,
      height: 400,
      layout: {
        xaxis: axis(x.head),
        yaxis: axis(g.is || g.head, { zeroline: true, zerolinewidth: 1.5, zerolinecolor: study.charts.ink }),
        shapes: found.map((f) => line(f.value * x.factor))
      }
    });
  }

  // --- design ----------------------------------------------------------------------------------------
  // Words at the top of the picture, in the shaded stretches and in those between them, so that it says by itself where limits hold.
  function stretchWords(from, to, reach, claim) {
    const word = (low, high, text) => ({ x: 0.5 * (low + high), y: 1, yref: 'paper', yanchor: 'top', showarrow: false, text });
    const borders = [reach[0], ...from.flatMap((x, i) => [x, to[i]]), reach[1]], words = [];
    for (let i = 0; i + 1 < borders.length; ++i)
      if (borders[i + 1] - borders[i] > 0.08 * (reach[1] - reach[0])) // there is room
        words.push(word(borders[i], borders[i + 1], i % 2 ? `<b>${claim}</b>` : 'not here'));
    return words;
  }
  // Marks an end of a stretch with its value, unless the range ends there.
  function borderMark(f, factor) {
    return {
      x: f.value * factor,
      y: 0,
      ax: 0,
      ay: 60,
      yanchor: 'top',
      arrowhead: 2,
      arrowcolor: colours.green,
      font: { size: 14 },
      text: `<b>${safe(study.answers.quantity(f))}</b>${f.interval ? `<br>${safe(study.answers.interval(f))}` : ''}`
    };
  }
  // Plots the values tried with their margins. Intervals in which all limits hold are shaded.
  function design() {
    const points = new Map(), ends = (role) => data.findings.filter((f) => f.role === role && f.value !== null);
    for (const f of data.findings.filter((one) => one.method === 'design' && one.place))
      points.set(f.subject,
        {...points.get(f.subject), [f.role === 'margin' ? 'margin' : 'value']: f.value, ...(f.status ? { doubt: f.status } : {}) });
    const from = ends('holds from'), to = ends('holds to'), x = data.named(data.findings.find((f) => f.role === 'value')?.variable);
    if (!x || !points.size) return scatter();
    const tried = [...points.values()].sort((a, b) => a.value - b.value),
          isSure = data.about.settings.beta === '' && data.about.settings.p === '';
    const trace = (name, list, look) => ({
      type: 'scatter',
      mode: 'markers',
      name: `${name} (${list.length})`,
      x: list.map((p) => p.value * x.factor),
      y: list.map((p) => p.margin),
      marker: look,
      hovertemplate: `${safe(x.name)} %{x:.6g}<br>margin %{y:.4g}<extra></extra>`
    });
    const traces = [
      {
        type: 'scatter',
        mode: 'lines',
        showlegend: false,
        hoverinfo: 'skip',
        x: tried.map((p) => p.value * x.factor),
        y: tried.map((p) => p.margin),
        line: { color: colours.grey, width: 1 }
      },
      trace('holds', tried.filter((p) => p.margin >= 0), {...looks[0].marker, size: 9 }),
      trace('does not hold', tried.filter((p) => p.margin < 0 && !p.doubt), {...looks[1].marker, size: 9 }),
      trace('no trusted result', tried.filter((p) => p.doubt), {...looks[2].marker, size: 9 })
    ].filter((t) => t.x.length);
    const shade = (f, i) => ({
      type: 'rect',
      layer: 'below',
      x0: f.value * x.factor,
      x1: to[i].value * x.factor,
      y0: 0,
      y1: 1,
      yref: 'paper',
      fillcolor: `${colours.green}22`,
      line: { color: colours.green, width: 1 }
    });
    const box = start(`Where ${isSure ? 'all limits hold' : 'the target is reached'}`), scaled = (f) => f.value * x.factor;
    const reach = [Math.min(...tried.map(scaled)), Math.max(...tried.map(scaled))];
    section.append(box);
    charts.add(box, {
      name: 'design',
      title: data.notes[0] || '',
      traces,
      height: 420,
      note: `Shaded: ${isSure ? 'all limits hold' : 'the probability of failure is at most the target'}. The ${
        points.size} values that were tried are drawn.`,
      layout: {
        xaxis: axis(x.head),
        yaxis: axis(isSure ? 'margin of the worst limit (0: just held)' : 'reliability index less the target (0: just reached)',
          { zeroline: true, zerolinewidth: 1.5, zerolinecolor: study.charts.ink }),
        shapes: from.map(shade),
        annotations: [
          ...stretchWords(from.map(scaled), to.map(scaled), reach, isSure ? 'all limits hold' : 'rare enough'),
          ...[...from, ...to].filter((f) => f.status !== 'the end of the range').map((f) => borderMark(f, x.factor))
        ]
      }
    });
  }

  // --- sweep -----------------------------------------------------------------------------------------
  function sweep() {
    const varying = data.variables.filter((v) => v.varies);
    if (!varying.length || !data.outputs.length) return scatter();
    const box = start('Curves'), ofX = select('Along', varying, varying[0]), ofY = select('shown', data.outputs, data.outputs[0]);
    section.append(make('div', { class: 'controls' }, ofX.label, ofY.label), box);
    const build = () => {
      charts.clear(box);
      curves(box, ofX.column, ofY.column, varying);
      if (varying.length === 2) field(box, varying, ofY.column);
    };
    for (const s of [ofX, ofY]) s.element.addEventListener('change', build);
    build();
  }
  function curves(box, x, y, varying) {
    const others = varying.filter((v) => v !== x), groups = new Map(), most = 12;
    for (let i = 0; i < data.shown; ++i) {
      const key = others.map((v) => v.values[i]).join(' ');
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push(i);
    }
    const lines = [...groups.values()]
                    .filter((g) => g.length > 1 && new Set(g.map((i) => x.values[i])).size > 1)
                    .map((g) => g.sort((a, b) => x.values[a] - x.values[b]));
    const drawn = lines.length <= most ? lines : range(most).map((k) => lines[Math.floor(k * (lines.length - 1) / (most - 1))]);
    const holes = drawn.reduce((sum, g) => sum + g.filter((i) => !isFinite(y.values[i])).length, 0);
    const traces = drawn.map((g, k) => ({
      type: 'scatter',
      mode: 'lines+markers',
      marker: { size: 5 },
      line: { color: cycle[k % cycle.length], width: 1.4 },
      name: safe(others.map((v) => `${v.name} ${v.text(g[0])}${v.unit ? ` ${data.pretty(v.unit)}` : ''}`).join(', ')),
      x: g.map((i) => x.values[i]),
      y: g.map((i) => (isFinite(y.values[i]) ? y.values[i] : null)),
      customdata: g,
      connectgaps: false,
      hovertemplate: `${safe(x.name)} %{x:.6g}<br>${safe(y.name)} %{y:.6g}<extra></extra>`
    }));
    charts.add(box, {
      name: 'sweep',
      traces,
      height: 400,
      note: `${drawn.length} of ${lines.length} curve${lines.length === 1 ? '' : 's'} drawn${
        holes ? `; ${holes} points have no value: gaps` : ''}. A click on a point shows the sample.`,
      layout: { xaxis: axis(x.head), yaxis: axis(y.head) }
    });
  }
  // Draws a coloured field of z over a full grid of x and y.
  function field(box, [x, y], z) {
    const levels = (c) => [...new Set(c.values)].sort((a, b) => a - b), xs = levels(x), ys = levels(y);
    if (xs.length < 3 || ys.length < 3 || xs.length * ys.length !== data.shown) return;
    const rows = ys.map(() => xs.map(() => null));
    for (let i = 0; i < data.shown; ++i)
      rows[ys.indexOf(y.values[i])][xs.indexOf(x.values[i])] = isFinite(z.values[i]) ? z.values[i] : null;
    charts.add(box, {
      name: 'contour',
      title: z.head,
      height: 420,
      traces: [{
        type: 'contour',
        x: xs,
        y: ys,
        z: rows,
        colorscale: 'Viridis',
        connectgaps: false,
        contours: { coloring: 'heatmap', showlabels: true },
        colorbar: { thickness: 14 },
        hovertemplate: `${safe(x.name)} %{x:.6g}<br>${safe(y.name)} %{y:.6g}<br>${safe(z.name)} %{z:.6g}<extra></extra>`
      }],
      layout: { xaxis: axis(x.head), yaxis: axis(y.head) }
    });
  }

  // --- any two columns -------------------------------------------------------------------------------
  function scatter() {
    const all = data.columns.filter((c) => c.role !== 'cost' && (c.varies || c.role !== 'variable'));
    if (all.length < 2 || data.shown < 2) return;
    const weights = (name) =>
      data.findings.filter((f) => f.role === 'importance' && f.place === 1 && f.variable === name).reduce((sum, f) => sum + f.value, 0);
    const varying = all.filter((c) => c.role === 'variable').sort((a, b) => weights(b.name) - weights(a.name));
    const axes = [...varying, ...all.filter((c) => c.role !== 'variable')], box = start('Samples in a plane');
    const ofX = select('Across', all, axes[0]), ofY = select('up', all, axes[1]);
    const which = make('select', { id: 'limit-choice' }, make('option', { value: '' }, 'any limit state'),
      ...data.limits.map((l) => make('option', { value: l.name }, l.name)));
    section.append(make('div', { class: 'controls' }, ofX.label, ofY.label,
                     ...(data.limits.length > 1 ? [make('label', {}, 'failures of ', which)] : [])),
      box);
    const build = () => {
      const x = ofX.column, y = ofY.column, limits = which.value ? [data.named(which.value)] : data.limits;
      const { traces, note } = cloud(x, y, (i) => data.fate(i, limits), [data.limits.length ? 'holds' : 'sample', 'failure', 'run failed']);
      const points = new Map();
      for (const f of data.findings.filter((one) => one.role === 'design point'))
        points.set(f.subject, {...points.get(f.subject), [f.variable]: f.value });
      const marks = [...points].filter(([, p]) => p[x.name] !== undefined && p[y.name] !== undefined);
      if (marks.length)
        traces.push({
          type: 'scatter',
          mode: 'markers',
          name: 'design point',
          x: marks.map(([, p]) => p[x.name] * x.factor),
          y: marks.map(([, p]) => p[y.name] * y.factor),
          text: marks.map(([name]) => safe(name)),
          hovertemplate: '%{text}<extra></extra>',
          marker: { symbol: 'star', size: 14, color: colours.orange, line: { color: study.charts.ink, width: 1 } }
        });
      charts.clear(box);
      charts.add(box, { name: 'scatter', traces, note, height: 460, layout: { xaxis: axis(x.head), yaxis: axis(y.head) } });
    };
    for (const element of [ofX.element, ofY.element, which]) element.addEventListener('change', build);
    build();
  }
  function draw() {
    const drawings = { map, critical, design, sweep, scatter };
    if (study.kind.plane) drawings[study.kind.plane]();
  }
  return { draw };
})();
