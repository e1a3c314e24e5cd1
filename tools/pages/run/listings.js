// Long lists that the reader can open: events, extremes of all channels, text of the model, then files, programs and digests.
steplap.listings = (() => {
  const make = steplap.make, { table, fold } = steplap.tables, { column, instant, roundingIn, isKnown, full, withUnit } = steplap.numbers;
  const tall = (content) => make('div', { class: 'tall', tabindex: '0' }, content);

  function events(box, runs, onTime) {
    const total = runs.reduce((sum, r) => sum + r.events.length + r.events_left_out, 0), lists = make('div', { class: 'columns' });
    for (const run of runs) {
      const rows = run.events.map(([t, element, what, text]) => {
        const button = make('button', { type: 'button', class: 'event-time', title: text }, instant(t, run.end));
        button.addEventListener('click', () => onTime(t));
        return [button, element, what];
      });
      const note = run.events_left_out ? [make('p', { class: 'note' }, `and ${run.events_left_out} more: see events.csv`)] : [];
      lists.append(make('div', {}, ...(runs.length > 1 ? [make('h4', {}, run.name)] : []),
        rows.length ? tall(table(['t', 'element', 'event'], rows)) : make('p', {}, 'none'), ...note));
    }
    box.append(fold(`Events (${total})`, false, lists));
  }

  const extremeOf = (run, name) => run.summary.extremes[name];
  // Returns the row of a channel: minimum and maximum of all runs in one unit.
  function extremeRow(runs, name) {
    const known = runs.map((r) => extremeOf(r, name)), unit = (known.find(Boolean) || { unit: '' }).unit;
    const entries = known.flatMap(
      (e) => (e ? [{ value: e.min, error: e.error_min }, { value: e.max, error: e.error_max }] : [{ value: null }, { value: null }]));
    const found = column(entries, unit, roundingIn(runs, unit));
    const meaning = runs.map((r) => r.meaning(name)).find(Boolean) || '';
    const cells = runs.flatMap((run, k) => ['min', 'max'].flatMap((key, j) => {
      const e = known[k];
      if (!e) return ['–', ''];
      return [
        { text: withUnit(found.texts[2 * k + j], found.unit), value: e[key], full: full(e[key], unit, e[`text_${key}`]) }, {
          text: isKnown(e[`t_${key}`]) ? instant(e[`t_${key}`], run.end, e[`error_t_${key}`]) : '–',
          full: full(e[`t_${key}`], 's', e[`text_t_${key}`])
        }
      ];
    }));
    return [make('span', { title: meaning }, name), ...cells];
  }
  const most = 1000; // largest number of rows shown at once
  function extremes(box, runs) {
    const names = steplap.data.unique(runs.map((r) => Object.keys(r.summary.extremes)));
    const heads = [
      'channel', ...runs.flatMap((r) => {
        const of = runs.length > 1 ? ` ${r.name}` : '';
        return [`least${of}`, 'at', `largest${of}`, 'at'];
      })
    ];
    const filter = make('input', { type: 'search', id: 'extremes-filter' }), place = make('div', { id: 'extremes-table' });
    function fill(wanted) {
      const found = names.filter((name) => name.toLowerCase().includes(wanted));
      const note = found.length > most ? [make('p', { class: 'note' }, `and ${found.length - most} more: name what they contain`)] : [];
      place.replaceChildren(
        tall(table(heads, found.slice(0, most).map((name) => extremeRow(runs, name)), heads.map((_, i) => i).slice(1))), ...note);
    }
    filter.addEventListener('input', () => fill(filter.value.toLowerCase()));
    const part =
      fold(`Least and largest values (${names.length} channels)`, false, make('label', {}, 'Channels that contain ', filter), place);
    part.addEventListener('toggle', () => {
      if (part.open && !place.firstChild) fill(filter.value.toLowerCase());
    });
    box.append(part);
  }

  // Builds a table of the parameters: one row per parameter, one column per run.
  function parameters(box, runs) {
    const of = (run) => run.summary.model.parameters || [];
    const names = steplap.data.unique(runs.map((run) => of(run).map((p) => p.name)));
    if (!names.length) return;
    const found = (run, name) => of(run).find((p) => p.name === name);
    const meaning = (name) => (runs.map((run) => found(run, name)).find(Boolean) || {}).meaning || '';
    const value = (run, name) => {
      const p = found(run, name);
      return p ? `${Number(p.value.toPrecision(4))} ${p.unit}`.trim() + (p.given.startsWith('=') ? ` (${p.given})` : '') : '–';
    };
    const rows = names.map((name) => [name, meaning(name), ...runs.map((run) => value(run, name))]);
    box.append(fold('Parameters', false, table(['parameter', 'meaning', ...runs.map((run) => run.name)], rows)));
  }

  function models(box, runs) {
    parameters(box, runs);
    // Each core is shown once, even if several runs have it. It is included as an image, so that the page's style does not affect it.
    const cores = new Map(runs.flatMap((run) => (run.drawing.cores || []).map((core) => [core.svg, core.name])));
    if (cores.size) {
      const images = [...cores].map(([svg, name]) => make('img', {
        src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`,
        alt: `Core ${name}: elevation, corner, section, book`,
        class: 'core'
      }));
      box.append(fold(cores.size > 1 ? 'Cores' : 'Core', true, make('div', { class: 'columns', id: 'cores' }, ...images)));
    }
    for (const run of runs) box.append(fold(`Model of ${run.name}, as it was run`, false, make('pre', { tabindex: '0' }, run.model_text)));
  }

  // Builds the list of files, programs and digests with which the results can be checked or repeated.
  function origin(box, runs) {
    const rows = [
      ['title', (r) => r.summary.model.title || '–'],
      [
        'model file',
        (r) => r.summary.model.file + (r.summary.model.overrides.length ? ` with ${r.summary.model.overrides.join('; ')}` : '')
      ],
      ['model.toml written', (r) => r.model_date], ['its SHA-256', (r) => ({ text: r.model_sha256, class: 'hash' })],
      ['program', (r) => `${r.summary.program.name} ${r.summary.program.version}`]
    ];
    const files = steplap.data.unique(runs.map((r) => Object.keys(r.summary.files || {})));
    for (const name of files)
      rows.push([
        name,
        (r) => {
          const f = (r.summary.files || {})[name];
          return f ? { text: `${f.bytes} bytes, SHA-256 ${f.sha256}`, class: 'hash' } : '–';
        }
      ]);
    box.append(fold(
      'Files, versions, digests', false, table(['', ...runs.map((r) => r.name)], rows.map(([name, text]) => [name, ...runs.map(text)]))));
  }
  return { events, extremes, models, origin };
})();
