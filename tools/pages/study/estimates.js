// Results of a study: the answer with its status, failed runs, design points, sensitivity indices, effects of omitted parts, convergence,
// and a table of all estimates.
study.estimates = (() => {
  const { make, table, data, charts } = study;
  const at = (id) => document.getElementById(id);
  const { colours, cycle, axis, safe, band } = charts;
  const minus = (text) => text.replace(/-(?=[\d.])/g, '−'), { quantity, interval } = study.answers;
  const isJudged = new Set(['probability', 'beta', 'critical', 'elasticity', 'first order', 'total', 'estimate', 'swing', 'mu*']);
  const status = (f) => ({ text: f.status, class: `words${f.status && (isJudged.has(f.role) || study.kind.isJudged) ? ' doubt' : ''}` });
  const scroll = (...content) => make('div', { class: 'scroll' }, ...content);
  const heads = ['method', 'of', 'quantity', 'value', 'interval', 'samples', ''];
  const row = (f) => [f.method, f.subject, f.quantity, { text: quantity(f), class: 'value' }, interval(f), String(f.samples), status(f)];
  // Groups findings by subject; the order is kept.
  function bySubject(list) {
    const groups = new Map();
    for (const f of list) groups.set(f.subject, [...(groups.get(f.subject) || []), f]);
    return groups;
  }
  function open(id) {
    at(id).hidden = false;
    return at(id);
  }
  function grid(section, isOne = false) {
    const box = make('div', { class: isOne ? 'charts one' : 'charts' });
    section.append(box);
    return box;
  }
  // Draws at most `most` charts and prints how many were omitted.
  function several(section, entries, draw, most = 24) {
    const box = grid(section, entries.length === 1);
    for (const entry of entries.slice(0, most)) draw(box, entry);
    if (entries.length > most)
      section.append(make('p', { class: 'note' }, `${most} of ${entries.length} are drawn; the table of all estimates has the rest.`));
  }

  // --- the answer ----------------------------------------------------------------------------------
  // Badge of a study that is not complete or not reliable, by its status.
  const standings = {
    done: ['', '', ''],
    'not met': [
      'not-met', 'NOT MET',
      'The study has ended, but the wanted accuracy was not reached, or not everything has an answer: see the remarks beside the numbers.'
    ],
    'not to be trusted':
      ['not-trusted', 'NOT TO BE TRUSTED', 'The study has ended, but its answer is not to be trusted: see the remarks beside the numbers.'],
    '':
      ['unfinished', 'NOT FINISHED', 'The study has not ended: what is here is what it had found so far. It goes on when it is run again.']
  };
  const counted = {
    bounds: 'Probabilities are given between both: with them as safe and with them as failures.',
    unsafe: 'They count as failures.',
    safe: 'They count as safe.',
    stop: 'The study stops at the first.'
  };

  function main() { return data.findings.filter((f) => !f.place && study.kind.isAnswer(f)); }
  // Converts the rows of a table to paragraphs for narrow screens, so that all details remain visible.
  function stacked(rows) {
    const element = table(heads, rows, [3, 5]);
    element.className = 'stacked';
    return make('div', { class: 'scroll' }, element);
  }
  function answer() {
    const [kind, word, sentence] = standings[data.standing] || ['not-trusted', data.standing.toUpperCase(), ''];
    const found = main(), most = 20, notes = [...data.notes], card = make('div', { class: 'card' });
    const sentences = study.kind.beginsWithSentence && notes.length ? [notes.shift()] : study.answers.list();
    if (word) card.append(make('span', { class: `badge ${kind}` }, word), make('p', {}, sentence));
    const told = sentences.length || word ? sentences : ['The study has ended.'];
    card.append(...told.map((text) => make('p', { class: 'sentence' }, text)));
    if (found.length) card.append(stacked(found.slice(0, most).map(row)));
    if (found.length > most) card.append(make('p', { class: 'note' }, `${most} of ${found.length} are here, all below.`));
    if (!data.standing && data.growth.length) {
      const last = data.growth.map((g) => [g.method, g.subject, g.quantity, data.plain(g.value.at(-1), 4),
                                     `${data.plain(g.low.at(-1), 4)} … ${data.plain(g.high.at(-1), 4)}`, String(g.samples.at(-1)),
                                     { text: 'not finished', class: 'doubt' }]);
      card.append(stacked(last));
    }
    if (notes.length) card.append(make('ul', { class: 'notes' }, ...notes.map((n) => make('li', {}, n))));
    card.append(...failures());
    at('answer').append(card);
  }
  function failures() {
    const { failed, list, more, more_runs: moreRuns } = data.reasons;
    const told = `${failed} of ${data.samples.total} samples`;
    if (!failed) return [make('p', { id: 'failed-runs' }, `Of ${data.samples.total} samples none failed to give a result.`)];
    const rows = list.map((r) => {
      const first = study.samples.button(r.first);
      return [
        r.status, { text: r.alike ? `${r.reason} (${r.alike} more alike, with other numbers)` : r.reason, class: 'words' }, String(r.count),
        first
      ];
    });
    const parts = [
      make('p', { id: 'failed-runs' }, make('strong', { class: 'doubt' }, `${told} gave no result that counts: `),
        'their runs did not reach their end, or are not to be trusted. ', study.kind.isCounted ? counted[data.about.failed] || '' : ''),
      scroll(table(['status', 'reason', 'samples', 'first'], rows, [2, 3]))
    ];
    if (more) parts.push(make('p', { class: 'note' }, `and ${more} more kinds of reasons, of ${moreRuns} samples`));
    return parts;
  }

  // --- design points -------------------------------------------------------------------------------
  function designPoints() {
    const findings = data.findings.filter((f) => f.place && f.subject.startsWith('design point'));
    if (!findings.length) return;
    const section = open('design-points');
    const box = make('div', { class: 'columns' });
    section.append(
      make('p', { class: 'note' },
        'Of all ways to fail the most likely: values of the variables, and which share of the distance each of them makes up ' +
          '(alpha², the importance).'),
      box);
    for (const [subject, list] of bySubject(findings)) {
      const beta = list.find((f) => f.role === 'beta');
      const rows = list.filter((f) => f.role === 'design point').map((f) => {
        const share = list.find((g) => g.role === 'importance' && g.variable === f.variable), size = share ? share.value : 0;
        const bar = make('span', { class: 'bar', title: `${data.plain(100 * size, 3)} %` });
        bar.style.width = `${Math.max(0, Math.min(1, size)) * 75}%`;
        return [f.variable, quantity(f), { text: `${data.plain(100 * size, 3)} %` }, { text: bar, class: 'bars' }];
      });
      box.append(
        make('div', { class: 'card', 'data-point': subject }, make('h3', {}, `${subject}${beta ? `: beta ${minus(beta.text)}` : ''}`),
          ...(beta && beta.status ? [make('p', { class: 'doubt' }, beta.status)] : []),
          scroll(table(['variable', 'value', 'importance', ''], rows, [1, 2]))));
    }
  }

  // --- indices -------------------------------------------------------------------------------------
  const errorBars = (list) => ({
    type: 'data',
    symmetric: false,
    array: list.map((f) => (f.high === null ? 0 : f.high - f.value)),
    arrayminus: list.map((f) => (f.low === null ? 0 : f.value - f.low)),
    color: study.charts.ink,
    thickness: 1.2
  });
  const barAxis = { automargin: true, autorange: 'reversed', tickfont: { size: 12 }, type: 'category' };
  const barHeight = (n) => 110 + 30 * n;
  const scaleOf = (subject) => data.named(subject) || { factor: 1, unit: '', head: subject };

  function tornado(box, [subject, list]) {
    const column = scaleOf(subject), base = list.find((f) => f.role === 'base'),
          zero = base && base.value !== null ? base.value * column.factor : 0;
    const bars = list.filter((f) => f.role === 'swing' && f.low !== null && f.high !== null),
          missing = list.filter((f) => f.role === 'swing' && (f.low === null || f.high === null));
    // Bars differ in width, so that a bar remains visible behind another one on the same side.
    const trace = (key, name, colour, width) => ({
      type: 'bar',
      orientation: 'h',
      name,
      width,
      y: bars.map((f) => safe(f.variable)),
      base: zero,
      x: bars.map((f) => f[key] * column.factor - zero),
      customdata: bars.map((f) => data.plain(f[key] * column.factor)),
      hovertemplate: `%{y}: %{customdata}<extra>${name}</extra>`,
      marker: { color: colour }
    });
    charts.add(box, {
      name: `tornado ${subject}`,
      title: `${subject}: ${data.plain(zero)}${column.unit ? ` ${data.pretty(column.unit)}` : ''} at the point`,
      height: barHeight(bars.length),
      note: missing.length ? `No result at one end: ${missing.map((f) => f.variable).join(', ')}.` : '',
      traces: [trace('low', 'at the low value', colours.sky, 0.75), trace('high', 'at the high value', colours.vermillion, 0.4)],
      layout: {
        barmode: 'overlay',
        xaxis: axis(column.head),
        yaxis: barAxis,
        shapes: [{ type: 'line', x0: zero, x1: zero, y0: 0, y1: 1, yref: 'paper', line: { color: study.charts.ink, width: 1 } }]
      }
    });
  }
  function elasticity(box, [subject, list]) {
    const all = list.filter((f) => f.role === 'elasticity'),
          bars = all.filter((f) => f.quantity.startsWith('elasticity') && f.value !== null);
    const others = all.filter((f) => !bars.includes(f)).map((f) => `${f.quantity}: ${quantity(f)}`);
    const doubts = bars.filter((f) => f.status).map((f) => `${f.variable}: ${f.status}`);
    charts.add(box, {
      name: `elasticity ${subject}`,
      title: subject,
      height: barHeight(bars.length),
      note: [...others, ...doubts].join('; '),
      traces: [{
        type: 'bar',
        orientation: 'h',
        y: bars.map((f) => safe(f.variable)),
        x: bars.map((f) => f.value),
        error_x: errorBars(bars),
        marker: { color: bars.map((f) => (f.status ? colours.grey : colours.blue)) }
      }],
      layout: { xaxis: axis('elasticity: per cent of the response for one per cent of the variable'), yaxis: barAxis }
    });
  }
  function sobol(box, [subject, list]) {
    const trace = (role, name, colour) => {
      const of = list.filter((f) => f.role === role && f.value !== null);
      return {
        type: 'bar',
        orientation: 'h',
        name,
        y: of.map((f) => safe(f.variable)),
        x: of.map((f) => f.value),
        error_x: errorBars(of),
        marker: { color: colour }
      };
    };
    const doubts = [...new Set(list.map((f) => f.status).filter(Boolean))];
    charts.add(box, {
      name: `sobol ${subject}`,
      title: subject,
      height: barHeight(1.6 * list.filter((f) => f.role === 'first order').length),
      note: doubts.join('; '),
      traces: [
        trace('first order', 'first order: by itself', colours.sky), trace('total', 'total: with all it acts together with', colours.blue)
      ],
      layout: { barmode: 'group', xaxis: axis('share of the variance'), yaxis: barAxis }
    });
  }
  function morris(box, [subject, list]) {
    const means = list.filter((f) => f.role === 'mu*' && f.value !== null), column = scaleOf(subject),
          scaled = (f) => f.value * column.factor;
    const unit = column.unit ? ` [${data.pretty(column.unit)}]` : '', bars = errorBars(means);
    for (const key of ['array', 'arrayminus']) bars[key] = bars[key].map((v) => v * column.factor);
    charts.add(box, {
      name: `morris ${subject}`,
      title: subject,
      note: [...new Set(list.map((f) => f.status).filter(Boolean))].join('; '),
      traces: [{
        type: 'scatter',
        mode: 'markers+text',
        x: means.map(scaled),
        y: means.map((f) => scaled(list.find((g) => g.role === 'sigma' && g.variable === f.variable) || { value: NaN })),
        text: means.map((f) => safe(f.variable)),
        textposition: 'top center',
        cliponaxis: false,
        error_x: bars,
        marker: { size: 9, color: colours.blue }
      }],
      layout: {
        xaxis: axis(`mu*: mean size of the effects${unit}`, { rangemode: 'tozero' }),
        yaxis: axis(`sigma: their scatter${unit}`, { rangemode: 'tozero' })
      }
    });
  }
  // Draws the probability with each change as a mark, and the present one as a line. First come variables of which half the scatter helps
  // most.
  const changes = [
    { role: 'half scatter', name: 'half its scatter', symbol: 'diamond', colour: colours.blue },
    { role: 'smaller mean', name: 'mean 10 % smaller', symbol: 'triangle-left', colour: colours.orange },
    { role: 'larger mean', name: 'mean 10 % larger', symbol: 'triangle-right', colour: colours.vermillion }
  ];
  function influence() {
    const of = (role) => data.findings.filter((f) => f.role === role && !f.place);
    const sampled = of('half scatter');
    if (!sampled.length) return;
    // Where the samples do not tell: to first order, at the design point.
    const firstOrder = (name) => data.findings.find((f) => f.place && f.role === 'half scatter' && f.variable === name);
    const halved =
      sampled.map((f) => (f.value === null ? firstOrder(f.variable) || f : f)).sort((a, b) => (a.value ?? -1) - (b.value ?? -1));
    const { method, subject } = sampled[0], now = of('probability').filter((f) => f.method === method && f.subject === subject).at(-1);
    const section = open('influence'), names = halved.map((f) => f.variable);
    const found = (role, name) =>
      (role === 'half scatter' ? halved : of(role)).find((f) => f.variable === name) || { value: null, text: '', interval: '', status: '' };
    const marks = changes.map(({ role, name, symbol, colour }) => {
      const list = names.map((v) => found(role, v)).filter((f) => f.value !== null);
      return {
        type: 'scatter',
        mode: 'markers',
        name,
        x: list.map((f) => f.value),
        y: list.map((f) => safe(f.variable)),
        error_x: errorBars(list),
        marker: { symbol: list.map((f) => (f.place ? `${symbol}-open` : symbol)), size: 13, color: colour },
        hovertemplate: `%{y}, ${name}: %{x:.3g}<extra></extra>`
      };
    });
    charts.add(grid(section, true), {
      name: 'influence',
      title: `Probability of '${subject}' if one thing were different`,
      note: 'Bars are intervals, from the failures among the samples. Open: too few failures tell, so it is of first order.',
      height: barHeight(1.4 * names.length),
      traces: marks,
      layout: {
        xaxis: axis('probability', { type: 'log' }),
        yaxis: {...barAxis, categoryorder: 'array', categoryarray: names.map(safe) },
        shapes:
          [{ type: 'line', x0: now.value, x1: now.value, y0: 0, y1: 1, yref: 'paper', line: { color: study.charts.ink, dash: 'dash' } }],
        annotations: [{
          x: Math.log10(now.value),
          y: 1,
          yref: 'paper',
          yanchor: 'top',
          xanchor: 'left',
          showarrow: false,
          text: `as it is: ${now.text}`
        }]
      }
    });
    const rows = names.map((name) => {
      const mean = data.findings.find((f) => f.subject === name && f.quantity === 'mean given failure'),
            text = (f) => (f.text ? `${f.text}${f.place ? ' (first order)' : ''}`
                : f.status ? 'not known'
                           : '–'),
            to = (role) => text(found(role, name));
      return [name, ...changes.map(({ role }) => to(role)), mean ? quantity(mean) : ''];
    });
    section.append(make('p', { class: 'note' }, `From ${now.text} the probability would change to:`),
      scroll(table(['variable', ...changes.map(({ name }) => name), 'its mean in failures'], rows, [1, 2, 3, 4])));
  }
  function indices() {
    const drawings = {
      tornado: [tornado, 'swing'],
      elasticity: [elasticity, 'elasticity'],
      sobol: [sobol, 'first order'],
      morris: [morris, 'mu*']
    };
    for (const [method, [draw, role]] of Object.entries(drawings)) {
      const list = data.findings.filter((f) => f.method === method);
      if (!list.some((f) => f.role === role)) continue;
      several(open('indices'), [...bySubject(list)], draw);
    }
  }

  // --- what the scene needs --------------------------------------------------------------------------
  function needs() {
    const list = data.findings.filter((f) => f.role === 'need');
    if (!list.length) return;
    const section = open('needs'), accuracy = data.about.settings.accuracy;
    const sizes = list.map((f) => f.value).filter((v) => v > 0), low = Math.log10(Math.min(...sizes, 1e-3)),
          high = Math.log10(Math.max(...sizes, 1));
    const isSmall = (f) => accuracy !== undefined && f.value !== null && f.value <= accuracy;
    const rows = list.map((f, i) => {
      const bar = make('span', { class: 'bar' });
      bar.style.width = f.value > 0 ? `${(2 + 98 * (Math.log10(f.value) - low) / Math.max(high - low, 1e-9)).toFixed(1)}%` : '0';
      const cells = [
        String(i + 1), f.subject, f.value === null ? '–' : `${data.plain(100 * f.value, 3)} %`,
        { text: f.value > 0 ? bar : '', class: 'bars' }, { text: f.status, class: 'words' }
      ];
      if (isSmall(f)) cells.class = 'dispensable';
      return cells;
    });
    section.append(make('p', { class: 'note' },
                     `What changes if it is left out, made rigid or fixed, the largest of all responses${
                       accuracy === undefined
                         ? ''
                         : `; green: no more than the ${data.plain(100 * accuracy, 3)} % that were asked for`}. Bars are logarithmic.`),
      make('div', { class: 'tall' }, scroll(table(['', 'simplification', 'largest change', '', ''], rows, [0, 2]))));
  }

  // --- fit -------------------------------------------------------------------------------------------
  function fit() {
    const list = data.findings.filter((f) => f.role === 'correlation' && f.value !== null);
    if (!data.histories.length && !list.length) return;
    const section = open('fit'), box = grid(section, true);
    for (const h of data.histories) {
      const about = (data.about.histories || []).find((one) => one.name === h.name) || { unit: '', channel: h.name },
            label = (text) => data.withUnit(text, about.unit);
      const shown = h.t.length < h.all ? `Drawn: ${h.t.length} of ${h.all} measured values.` : `All ${h.all} measured values are drawn.`;
      const dots = { type: 'scatter', mode: 'markers', marker: { size: 4, color: colours.blue, opacity: 0.6 } };
      charts.add(box, {
        name: `history ${h.name}`,
        title: h.name,
        note: shown,
        height: 360,
        layout: { xaxis: axis('t [s]'), yaxis: axis(label(about.channel)) },
        traces: [
          {...dots, name: 'measured', x: h.t, y: h.measured },
          { type: 'scatter', mode: 'lines', name: 'fitted', x: h.t, y: h.fitted, line: { color: colours.vermillion, width: 1.6 } }
        ]
      });
      charts.add(box, {
        name: `residuals ${h.name}`,
        title: `${h.name}: fitted minus measured`,
        note: shown,
        height: 240,
        layout: { xaxis: axis('t [s]'), yaxis: axis(label('residual')) },
        traces:
          [{...dots, x: h.t, y: h.t.map((_, i) => (h.fitted[i] === null || h.measured[i] === null ? null : h.fitted[i] - h.measured[i])) }]
      });
    }
    const pairs = list.map((f) => [f.subject.split(', '), f.value]), names = [...new Set(pairs.flatMap(([pair]) => pair))];
    const rows = names.map((a) => names.map((b) => {
      const found = pairs.find(([p]) => p.includes(a) && p.includes(b));
      return a === b ? 1 : found ? found[1] : null;
    }));
    if (names.length > 1)
      charts.add(box, {
        name: 'correlation',
        title: 'Correlation of the parameters',
        height: 120 + 45 * names.length,
        layout: { xaxis: {...barAxis, autorange: true }, yaxis: barAxis },
        traces: [{
          type: 'heatmap',
          x: names.map(safe),
          y: names.map(safe),
          z: rows,
          zmin: -1,
          zmax: 1,
          colorscale: 'RdBu',
          reversescale: true,
          text: rows.map((r) => r.map((v) => (v === null ? '' : data.plain(v, 3)))),
          texttemplate: '%{text}',
          hoverinfo: 'none',
          colorbar: { thickness: 14 }
        }]
      });
  }

  // --- convergence of estimates ---------------------------------------------------------------------
  function settled(box, title, series) {
    const values = series.flatMap((s) => s.value).filter((v) => v !== null),
          isLog = series.every((s) => s.isShare) && values.length > 0 && values.every((v) => v > 0) && Math.max(...values) < 0.5;
    const least = isLog ? Math.min(...values) / 10 : -Infinity;
    const traces = series.flatMap((s, k) => {
      const low = s.low.map((v, i) => Math.max(least, v === null ? s.value[i] : v)),
            high = s.high.map((v, i) => (v === null ? s.value[i] : v)), colour = cycle[k % cycle.length];
      return [
        band(s.samples, low, high, colour, { showlegend: false }), {
          type: 'scatter',
          mode: s.samples.length > 1 ? 'lines' : 'markers',
          name: safe(s.name),
          x: s.samples,
          y: s.value,
          line: { color: colour, width: 1.6 },
          customdata: s.low.map((v, i) => `${data.plain(v, 4)} … ${data.plain(s.high[i], 4)}`),
          hovertemplate: '%{y:.4g}, %{customdata}, after %{x} samples'
        }
      ];
    });
    charts.add(box, {
      name: `convergence ${title}`,
      title,
      traces,
      layout: {
        xaxis: axis('samples', { separatethousands: true, exponentformat: 'none', nticks: 6 }),
        yaxis: axis(data.withUnit(series[0].quantity, series[0].unit), isLog ? { type: 'log' } : {})
      }
    });
  }
  // A study of several samplings of one method keeps all of them: the number of samples begins anew with each.
  function lastSampling(g) {
    const begin = g.samples.findLastIndex((n, i) => i > 0 && n < g.samples[i - 1]);
    if (begin < 0) return g;
    const part = (list) => list.slice(begin);
    return {...g, samples: part(g.samples), value: part(g.value), low: part(g.low), high: part(g.high) };
  }
  function convergence() {
    const groups = new Map();
    for (const g of data.growth.map(lastSampling)) {
      const key = `${g.subject}: ${g.quantity}`;
      groups.set(key, [...(groups.get(key) || []), {...g, name: g.method, unit: '', isShare: true }]);
    }
    for (const r of data.running) {
      const column = data.named(r.subject), factor = r.quantity === 'mean' && column ? column.factor : 1,
            scaled = (list) => list.map((v) => (v === null ? null : v * factor));
      groups.set(`${r.subject}: ${r.quantity}`, [{
        ...r,
        name: '',
        value: scaled(r.value),
        low: scaled(r.low),
        high: scaled(r.high),
        unit: factor === 1 && !column ? ''
          : r.quantity === 'mean'     ? column.unit
                                      : '',
        isShare: r.quantity !== 'mean'
      }]);
    }
    const entries = [...groups].filter(([, series]) => series.some((s) => s.samples.length));
    if (!entries.length) return;
    const section = open('convergence'),
          thinned = data.growth.filter((g) => g.samples.length < g.all).map((g) => `${g.samples.length} of ${g.all} of ${g.method}`),
          isSeveral = data.growth.some((g) => lastSampling(g) !== g);
    section.append(make('p', { class: 'note' },
      `The estimate as samples came in, and its interval.${isSeveral ? ' Of several samplings the last is drawn.' : ''}${
        thinned.length ? ` Drawn: ${thinned.join(', ')}.` : ''}`));
    several(section, entries, (box, [title, series]) => settled(box, title, series));
  }

  // --- all estimates ---------------------------------------------------------------------------------
  function everything() {
    const list = data.findings;
    if (!list.length) return;
    const section = open('estimates'), some = 60, element = table(heads, list.slice(0, some).map(row), [3, 5]),
          told = make('p', { class: 'note pager' });
    element.className = 'stacked';
    let shown = Math.min(some, list.length);
    const more = make('button', { type: 'button' }, 'Show more');
    const tell = () => {
      told.replaceChildren(`${shown} of ${list.length} estimates are shown. `);
      if (shown < list.length) told.append(more);
    };
    more.addEventListener('click', () => {
      const next = Math.min(list.length, shown + 500);
      element.tBodies[0].append(...table(null, list.slice(shown, next).map(row), [3, 5]).tBodies[0].rows);
      shown = next;
      tell();
    });
    tell();
    const isUnknown = list.some((f) => f.unit === 'SI');
    section.append(make('p', { class: 'note' },
                     `Where there is an interval, two digits of its width are written.${
                       isUnknown ? ' SI: in SI units, of a quantity that this page knows nothing of.' : ''}`),
      make('div', { class: 'scroll tall' }, element), told);
  }
  function variables() {
    if (!data.about.variables.length && !data.about.numbers.length) return;
    const value = (v) => {
      const c = data.named(v.name);
      return v.value === null ? '–' : data.plain(v.value * (c ? c.factor : 1)) + (c && c.unit ? `\u202f${data.pretty(c.unit)}` : '');
    };
    const places = (v) => {
      if (v.paths.length) return `${v.factor ? 'multiplies ' : ''}${v.paths.join(', ')}${v.model ? ` of ${v.model}` : ''}`;
      return v.name === 'variant' && data.about.variants.length ? 'which simplification of the model' : 'in expressions';
    };
    const rows = data.about.variables.map(
      (v) => [v.name, 'variable', { text: v.varies, class: 'words' }, value(v), { text: places(v), class: 'words' }]);
    const roles = { border: 'its zeros are looked for' };
    for (const n of data.about.numbers)
      rows.push([n.name, roles[n.role] || n.role, { text: n.is, class: 'words' }, '', n.unit ? `in ${data.pretty(n.unit)}` : '']);
    open('variables').append(scroll(table(['name', '', 'is', 'stands at', ''], rows, [3])));
  }
  return { answer, designPoints, influence, indices, needs, fit, convergence, everything, variables, bySubject };
})();
