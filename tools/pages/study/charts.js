// Draws charts by Plotly in one style, with the width of the paper for printing.
study.charts = (() => {
  const { make } = study;
  const colours = {
    blue: '#0072b2',
    vermillion: '#d55e00',
    green: '#007a5a',
    orange: '#e69f00',
    purple: '#a8487c',
    sky: '#56b4e9',
    grey: '#6b6b6b'
  };
  const cycle = [colours.blue, colours.vermillion, colours.green, colours.purple, colours.orange, colours.sky, colours.grey];
  const all = [];
  const isTouched = matchMedia('(pointer: coarse), (max-width: 600px)').matches;
  // Escapes text, because Plotly interprets some markup.
  const safe = (text) => String(text).replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;');
  const axis = (title, more = {}) => ({ title: { text: safe(title), standoff: 8 }, automargin: true, exponentformat: 'power', ...more });

  // Axes and texts have the colours of the page; curves have colours that are visible on light and dark backgrounds.
  const scheme = matchMedia('(prefers-color-scheme: dark)');
  const ink = '#7d858e'; // colour of lines and marks on light and dark backgrounds
  function look(layout, isPaper) {
    if (isPaper) document.documentElement.classList.add('paper');
    const style = getComputedStyle(document.documentElement), colour = (name) => style.getPropertyValue(`--${name}`).trim();
    const found = { 'font.color': colour('ink'), paper_bgcolor: colour('paper'), plot_bgcolor: colour('paper') };
    for (const name of Object.keys(layout).filter((key) => /^[xy]axis\d*$/.test(key)))
      Object.assign(
        found, { [`${name}.gridcolor`]: colour('grid'), [`${name}.linecolor`]: colour('axis'), [`${name}.zerolinecolor`]: colour('axis') });
    if (isPaper) document.documentElement.classList.remove('paper');
    return found;
  }

  // Settings of Plotly. Buttons that contact a server are removed; one would upload the chart.
  const config = {
    responsive: true,
    displaylogo: false,
    ...(isTouched ? { displayModeBar: false } : {}),
    plotlyServerURL: '',
    modeBarButtons: [['toImage', 'zoom2d', 'pan2d', 'zoomIn2d', 'zoomOut2d', 'resetScale2d']]
  };

  // charts that are drawn once the page is complete, because only then the columns have their final width
  const waiting = [];
  const draw = () => {
    for (const one of waiting.splice(0)) one();
  };

  // Adds a chart with a heading at the end of `parent`. Clicking a point with `customdata`, the index of a sample, shows this sample.
  function add(parent, { title = '', note = '', traces, layout = {}, height = 320, name = '' }) {
    const canvas = make('div', { class: 'canvas' });
    const box = make('div', { class: 'chart', 'data-chart': name || title }, ...(title ? [make('h3', {}, title)] : []), canvas,
      ...(note ? [make('p', { class: 'note' }, note)] : []));
    parent.append(box);
    const whole = {
      height,
      margin: { l: 58, r: 14, t: 12, b: 44 },
      font: { family: '"DejaVu Sans", "Segoe UI", Arial, sans-serif', size: 12 },
      hovermode: 'closest',
      dragmode: isTouched ? false : 'zoom',
      showlegend: traces.filter((t) => t.showlegend !== false && t.name).length > 1,
      legend: { orientation: 'h', y: 1.02, yanchor: 'bottom', x: 0, font: { size: 11 } },
      bargap: 0.3,
      ...layout
    };
    if (!waiting.length) queueMicrotask(draw);
    waiting.push(() => {
      for (const [path, value] of Object.entries(look(whole, false))) {
        const [part, key] = path.split('.');
        if (key) whole[part] = {...whole[part], [key]: value };
        else whole[part] = value;
      }
      Plotly.newPlot(canvas, traces, whole, config);
      canvas.on('plotly_click', (event) => {
        const picked = event.points.find((p) => Number.isInteger(p.customdata));
        if (picked) study.samples.show(picked.customdata);
      });
    });
    all.push({ canvas, box });
    return { canvas, box };
  }
  // Returns the outline of the band between two curves.
  function band(x, low, high, colour, more = {}) {
    return {
      x: [...x, ...[...x].reverse()],
      y: [...high, ...[...low].reverse()],
      type: 'scatter',
      mode: 'none',
      fill: 'toself',
      fillcolor: `${colour}33`,
      hoverinfo: 'skip',
      ...more
    };
  }
  // Removes all charts in a box.
  function clear(box) {
    for (let i = all.length; i-- > 0;)
      if (box.contains(all[i].canvas)) Plotly.purge(all.splice(i, 1)[0].canvas);
    box.replaceChildren();
  }
  // Sets width and colours of all charts for printing, or resets them.
  function fit(isPaper) {
    for (const { canvas, box } of all) {
      const isWide = box.parentElement.classList.contains('one');
      Plotly.relayout(canvas, {
        ...look(canvas.layout, isPaper),
        ...(isPaper ? { width: isWide ? 690 : 335, autosize: false } : { width: null, autosize: true })
      });
    }
  }
  scheme.addEventListener('change', () => {
    for (const { canvas } of all)
      if (canvas.layout) Plotly.relayout(canvas, look(canvas.layout, false));
  });
  window.addEventListener('beforeprint', () => fit(true));
  window.addEventListener('afterprint', () => fit(false));
  return { add, clear, band, safe, axis, colours, cycle, ink, all };
})();
