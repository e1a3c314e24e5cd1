// Diagrams of the distributions of variables and responses: cumulative fractions or counts, with confidence bands.
study.distributions = (() => {
  const { make, data, charts } = study;
  const { colours, axis, band } = charts;
  const words = {
    independently:
      'Blue: the share of samples up to a value, and the band in which the whole distribution lies at 95 % (Dvoretzky, Kiefer, Wolfowitz).',
    'by design':
      'Blue: the share of samples up to a value. The samples were not drawn independently of each other, so that there is no band.',
    otherwise: 'The samples were taken where the method looked, not as the variables are distributed: of them no distribution can be shown.'
  };
  const percent = { tickformat: ',.0%', rangemode: 'tozero' };

  function remarks(t) {
    const parts = [];
    if (t.missing)
      parts.push(`${t.missing} of ${t.total} samples have no value; they widen the band on both sides, as they could be anywhere`);
    if (t.above) parts.push(`${t.above} are infinite`);
    if (t.below) parts.push(`${t.below} are minus infinite`);
    const steps = t.cumulative.x.length, all = t.total - t.missing - t.above - t.below;
    if (steps < all) parts.push(`${steps} steps are drawn of ${all} values`);
    return parts.length ? `${parts.join('; ')}.` : '';
  }
  const scaled = (list, factor) => list.map((v) => (v === null ? null : v * factor));

  function cumulative(box, t, column) {
    const x = scaled(t.cumulative.x, column.factor), traces = [], law = (data.about.variables.find((v) => v.name === t.name) || {}).law;
    if (t.cumulative.low.length)
      traces.push(band(x, t.cumulative.low, t.cumulative.high, colours.blue, { name: 'band', showlegend: false, line: { shape: 'hv' } }));
    traces.push({
      type: 'scatter',
      mode: x.length > 1 ? 'lines' : 'markers',
      line: { shape: 'hv', color: colours.blue, width: 1.6 },
      name: 'samples',
      x,
      y: t.cumulative.p,
      hovertemplate: '%{y:.3%} up to %{x:.6g}<extra></extra>'
    });
    if (law)
      traces.push({
        type: 'scatter',
        mode: 'lines',
        line: { color: colours.vermillion, width: 1.4, dash: 'dash' },
        name: 'distribution of the study',
        x: scaled(law.x, column.factor),
        y: law.p,
        hovertemplate: '%{y:.3%} up to %{x:.6g}<extra></extra>'
      });
    charts.add(box, {
      name: `distribution ${t.name}`,
      title: t.name,
      note: remarks(t),
      height: 290,
      traces,
      layout: { xaxis: axis(column.head), yaxis: axis('share up to it', {...percent, range: [0, 1.02] }) }
    });
  }
  function histogram(box, t, column) {
    const h = t.histogram, edges = scaled(h.edges, column.factor), total = h.counts.reduce((a, b) => a + b, 0) || 1;
    const middle = h.counts.map((_, i) => 0.5 * (edges[i] + edges[i + 1])), share = h.counts.map((n) => n / total);
    const error = h.low.length ? {
      error_y: {
        type: 'data',
        symmetric: false,
        array: h.high.map((v, i) => v - share[i]),
        arrayminus: h.low.map((v, i) => share[i] - v),
        color: study.charts.ink,
        thickness: 1,
        width: 2
      }
    }
                               : {};
    charts.add(box, {
      name: `distribution ${t.name}`,
      title: t.name,
      note: `${h.counts.length} bins of ${total} values${h.low.length ? '; intervals of 95 % (Clopper and Pearson)' : ''}. ${
        t.missing ? `${t.missing} samples have no value and are left out.` : ''}`,
      height: 290,
      traces: [{
        type: 'bar',
        x: middle,
        y: share,
        width: h.counts.map((_, i) => edges[i + 1] - edges[i] || undefined),
        customdata: h.counts.map(String),
        hovertemplate: '%{customdata} values, %{y:.3%}<extra></extra>',
        marker: { color: `${colours.blue}aa`, line: { color: colours.blue, width: 1 } },
        ...error
      }],
      layout: { bargap: 0, xaxis: axis(column.head), yaxis: axis('share in the bin', percent) }
    });
  }
  function draw() {
    const { drawn, of: list, left_out: leftOut } = data.distributions, section = document.getElementById('distributions');
    if (drawn === 'otherwise') {
      if (!study.kind.showsLaws || !data.about.variables.some((v) => v.law)) return;
      section.hidden = false;
      section.append(make('p', { class: 'note' }, words.otherwise, ' These are the distributions that the study gives its variables.'));
      const box = make('div', { class: 'charts' });
      section.append(box);
      for (const v of data.about.variables.filter((one) => one.law)) {
        const column = data.named(v.name);
        charts.add(box, {
          name: `distribution ${v.name}`,
          title: v.name,
          note: v.varies,
          height: 260,
          traces: [{
            type: 'scatter',
            mode: 'lines',
            x: scaled(v.law.x, column.factor),
            y: v.law.p,
            line: { color: colours.vermillion, dash: 'dash', width: 1.6 }
          }],
          layout: { xaxis: axis(column.head), yaxis: axis('share up to it', {...percent, range: [0, 1.02] }) }
        });
      }
      return;
    }
    if (!list.length) return;
    section.hidden = false;
    const choice = make('select', { id: 'distribution-kind' }, make('option', { value: 'cumulative' }, 'share up to a value'),
      make('option', { value: 'histogram' }, 'histogram'));
    const box = make('div', { class: 'charts' });
    section.append(
      make('div', { class: 'controls' }, make('label', {}, 'Shown as ', choice)), make('p', { class: 'note' }, words[drawn]), box);
    if (leftOut) section.append(make('p', { class: 'note' }, `${list.length} of ${list.length + leftOut} are drawn.`));
    const build = () => {
      charts.clear(box);
      for (const t of list) (choice.value === 'histogram' ? histogram : cumulative)(box, t, data.named(t.name));
    };
    choice.addEventListener('change', build);
    build();
  }
  return { draw };
})();
