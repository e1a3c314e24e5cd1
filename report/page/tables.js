// Everything that is read: trust, verdict, events, extremes, the model's text.
steplap.tables = (() => {
  const make = steplap.make, { quantity, plain } = steplap.data;
  const few = (value) => (value === null || value === undefined ? '–' : Number(value).toExponential(1).replace('-', '−'));
  const seconds = (t) => (t === null || t === undefined ? '–' : `${Number(t).toFixed(4)} s`);

  // Cells: a text, a node, or { text, value } for a number, whose full value is kept as data-value.
  function table(heads, rows, numeric = []) {
    const cell = (name, content, i) => {
      const isNumber = numeric.includes(i);
      const td = make(name, isNumber ? { class: 'number' } : {});
      if (content && content.text !== undefined && !(content instanceof Node)) {
        td.append(content.text);
        if (content.value !== undefined) td.setAttribute('data-value', String(content.value));
        if (content.class) td.classList.add(content.class);
      } else td.append(content === undefined ? '' : content);
      return td;
    };
    const element = make('table');
    if (heads) element.append(make('thead', {}, make('tr', {}, ...heads.map((h, i) => { const th = cell('th', h, i); th.scope = 'col'; return th; }))));
    element.append(make('tbody', {}, ...rows.map((row) => make('tr', {}, ...row.map((c, i) => cell(i === 0 ? 'th' : 'td', c, i))))));
    for (const th of element.querySelectorAll('tbody th')) th.scope = 'row';
    return element;
  }
  const number = (value, unit, digits) => ({ text: quantity(value, unit, digits), value });
  // A number of the summary with its error, in the words of the screen; without an estimate as it is.
  const written = (text) => text.replace(/-(?=[\d.])/g, '−').replace(/ (?=[±µkMGmnNJPr])/g, '\u00a0').replace(/\^2/g, '²').replace(/\^3/g, '³');
  const known = (entry, key, unit, digits) => (entry[`text_${key}`] ? { text: written(entry[`text_${key}`]), value: entry[key] } : number(entry[key], unit, digits));
  const instant = (entry, key) => (entry[`text_${key}`] ? written(entry[`text_${key}`]) : seconds(entry[key]));

  // --- trust ---------------------------------------------------------------------------------------
  function settingText(run) {
    const s = run.summary, fixed = s.integrator === 'rk4' || s.integrator === 'moreau';
    return `${s.integrator}, ` + (fixed ? `step ${quantity(s.settings.step, 's')}` : s.settings.tolerance === null || s.settings.tolerance === undefined ? 'its usual tolerance' : `tolerance ${few(s.settings.tolerance)} for each step`);
  }
  function errorText(run) {
    const e = run.summary.global_error;
    if (!e) return `not estimated: ${run.summary.error_not_estimated || 'ask with simulate --estimate-error'}`;
    const size = (v) => (v.error === null ? Infinity : v.error);
    const worst = Object.entries(e).filter(([, v]) => v && typeof v === 'object').sort((a, b) => size(b[1]) - size(a[1]))[0];
    return worst ? `${worst[1].error === null ? 'unknown' : `${few(worst[1].error)} of range`} (${worst[0]}: ${worst[1].where})` : '–';
  }
  function trust(runs) {
    const rows = [
      ['title', (r) => r.summary.model.title || '–'],
      ['run', (r) => (r.summary.completed ? `complete, 0 to ${seconds(r.end)}` : `stopped at ${seconds(r.end)}: ${r.summary.failure || ''}`)],
      ['integrator', settingText],
      ['estimated error', errorText],
      ['energy residual', (r) => `${few(r.summary.accuracy.energy_residual)} J, ${few(r.summary.accuracy.relative_energy_residual)} of what was exchanged`],
      ['dissipated energy', (r) => known(r.summary.accuracy, 'dissipated', 'J')],
      ['constraint residual', (r) => `${few(r.summary.accuracy.max_position_residual)} m or rad`],
      ['steps, evaluations', (r) => `${r.summary.statistics.steps}, ${r.summary.statistics.evaluations}`],
      ['events', (r) => String(r.summary.statistics.events)],
      ['model file', (r) => r.summary.model.file + (r.summary.model.overrides.length ? ` with ${r.summary.model.overrides.join('; ')}` : '')],
      ['model.toml written', (r) => r.model_date],
      ['its SHA-256', (r) => ({ text: r.model_sha256, class: 'hash' })],
      ['program', (r) => `${r.summary.program.name} ${r.summary.program.version}`]];
    document.getElementById('trust-table').append(table(['', ...runs.map((r) => r.name)], rows.map(([name, text]) => [name, ...runs.map(text)])));
  }

  // --- verdict -------------------------------------------------------------------------------------
  const sentences = {
    hold: 'All criteria of the model are met.',
    inspect: 'At least one criterion asks for an inspection.',
    reject: 'At least one criterion rejects the machine.',
    open: 'Not every criterion could be judged.' };
  const outcome = (c) => (c.is_met === null ? 'open' : c.is_met ? 'met' : c.consequence);

  function criteria(run) {
    const list = run.summary.judgement.criteria;
    const heads = ['criterion', 'asked', '', 'value', 'limit', 'at', ''];
    return table(heads, list.map((c) => [
      c.reason ? make('span', { title: c.reason }, c.name) : c.name, c.criterion.replace(/<=/g, '≤').replace(/\^2/g, '²'), { text: outcome(c), class: outcome(c) },
      known(c, 'value', c.unit), number(c.limit, c.unit), c.t === null ? '' : instant(c, 't'), c.doubt || '']), [3, 4, 5]);
  }
  function joints(run) {
    const list = Object.entries(run.summary.joints || {});
    if (!list.length) return [];
    const rows = list.map(([name, j]) => [name, { text: j.verdict, class: { hold: 'met', reject: 'reject' }[j.outcome] || 'inspect' }, j.first_slip === null ? '–' : instant(j, 'first_slip'),
      known(j, 'smallest_margin', ''), known(j, 'largest_required_pressure', 'Pa'), known(j, 'slid_x', 'm'), known(j, 'slid_y', 'm'), known(j, 'slid_angle', 'rad'), known(j, 'area_lost', 'm^2', 4)]);
    return [make('h3', {}, 'Step-lap joints: least margin, largest pressure needed, slid distances at the end'), scroll(table(['', '', 'first slip', 'margin', 'needs', 'dx', 'dy', 'turn', 'area lost'], tidy(rows), [2, 3, 4, 5, 6, 7, 8])),
      ...edges(list), ...shared(list)];
  }
  // Where limbs were drawn towards their yokes and sheet edges can bear.
  function edges(list) {
    const bearing = list.filter(([, j]) => j.largest_edge_load !== undefined);
    if (!bearing.length) return [];
    const rows = bearing.map(([name, j]) => [name, known(j, 'largest_edge_load', 'N/m'), j.largest_edge_load ? seconds(j.t_largest_edge_load) : '–',
      j.largest_edge_pressure === null ? '–' : number(j.largest_edge_pressure, 'Pa'), j.allowed_line_load === null ? '–' : number(j.allowed_line_load, 'N/m'),
      j.largest_edge_share === undefined ? '–' : j.largest_edge_share === 0 ? '∞' : number(j.smallest_edge_margin, ''),
      j.crushed_edges === undefined || j.crushed_edges === null ? '–' : { text: j.crushed_edges ? 'crushed' : 'borne', class: j.crushed_edges ? 'reject' : 'met' }]);
    return [make('h3', {}, 'Sheet edges along the mitres: largest line load, of all sheets at a corner'), scroll(table(['', 'line load', 'at', 'pressure', 'allowed', 'margin', ''], rows, [1, 3, 4, 5]))];
  }
  // What bears beside a joint: its margin is of its own share.
  function shared(list) {
    return list.filter(([, j]) => j.shared_with).map(([name, j]) => make('p', { class: 'note' },
      `${name}: the margin is that of its own share; beside it bear ${j.shared_with.map((s) => s.element + (s.largest_force === null ? '' : ` (up to ${quantity(s.largest_force, 'N')})`)).join(', ')}` +
      (j.shares_before_it_slides ? '.' : ', which take no part before the joint slides: it is rigid.')));
  }
  // What is rounding beside a micrometre or a microradian is shown as zero; data-value keeps the digits.
  function tidy(rows) {
    for (const row of rows) for (const c of row.slice(5)) if (c.value !== null && c.value !== undefined && Math.abs(c.value) < 1e-12 && !c.text.includes('±')) c.text = '0';
    return rows;
  }
  const scroll = (content) => make('div', { class: 'scroll' }, content);
  const extremesOf = (run, name) => run.summary.extremes[name];
  const larger = (e) => (Math.abs(e.min) > Math.abs(e.max) ? 'min' : 'max');

  function friction(run) {
    const list = run.drawing.elements.filter((e) => e.kind === 'coulomb_stick' && extremesOf(run, `${e.name}.slide`));
    if (!list.length) return [];
    const rows = list.map((e) => {
      const slide = extremesOf(run, `${e.name}.slide`), key = larger(slide);
      const slips = run.events.filter((v) => v[1] === e.name && v[4] === 'slip').length;
      return [e.name, slips ? `slipped ${slips} time${slips > 1 ? 's' : ''}` : 'held', known(slide, key, 'm'), instant(slide, `t_${key}`), known(slide, 'final', 'm')];
    });
    return [make('h3', {}, 'Friction'), scroll(table(['', '', 'largest slide', 'at', 'left at the end'], rows, [2, 3, 4]))];
  }
  // Springs and contacts between bodies: the arresting devices, blocks and feet of a transformer.
  function devices(run) {
    const list = run.drawing.elements.filter((e) => ['spring_damper', 'unilateral_contact', 'bushing'].includes(e.kind) && extremesOf(run, `${e.name}.force`));
    if (!list.length || list.length > 40) return [];
    const judged = (run.summary.judgement || { criteria: [] }).criteria;
    const rows = list.map((e) => {
      const force = extremesOf(run, `${e.name}.force`), key = larger(force);
      const limit = judged.find((c) => c.where === `${e.name}.force`);
      const lifts = run.events.filter((v) => v[1] === e.name && v[4] === 'open');
      return [e.name, known(force, key, 'N'), instant(force, `t_${key}`), limit ? number(limit.limit, 'N') : '–', lifts.length ? `${lifts.length} ×, first at ${written(lifts[0][3])}` : e.kind === 'unilateral_contact' ? 'never' : ''];
    });
    return [make('h3', {}, 'Springs, arresting devices, contacts'), scroll(table(['', 'largest force', 'at', 'allowed', 'lifts off'], rows, [1, 2, 3]))];
  }
  function verdict(runs) {
    const cards = document.getElementById('verdict-cards');
    for (const run of runs) {
      const card = make('div', { class: 'card', 'data-run': run.name });
      const judgement = run.summary.judgement;
      if (runs.length > 1) card.append(make('h3', {}, run.summary.model.title || run.name));
      if (judgement) {
        const sentence = judgement.criteria.length ? sentences[judgement.verdict] : 'The model states no criteria.';
        card.append(make('span', { class: `badge ${judgement.verdict}` }, judgement.verdict.toUpperCase()), make('p', {}, sentence + (run.summary.completed ? '' : ` The run broke off; what was computed until then: ${judgement.so_far}.`) + (judgement.distrust ? ` NOT TO BE TRUSTED: ${judgement.distrust}.` : '')));
        if (judgement.capped_by.length) card.append(make('p', {}, 'It cannot be “hold”:'), make('ul', { class: 'caps' }, ...judgement.capped_by.map((why) => make('li', {}, why))));
        if (judgement.criteria.length) card.append(scroll(criteria(run)));
      } else card.append(make('p', {}, 'The model states no criteria: what happened is below.'));
      card.append(...joints(run));
      const parts = [friction(run), devices(run)].filter((part) => part.length).map((part) => make('div', {}, ...part));
      card.append(make('div', { class: 'columns few' }, ...parts));
      cards.append(card);
    }
  }

  // --- events, extremes, model ---------------------------------------------------------------------
  function events(runs, onTime) {
    const box = document.getElementById('events-tables');
    for (const run of runs) {
      const rows = run.events.map(([t, element, what, text]) => {
        const button = make('button', { type: 'button', class: 'event-time' }, written(text));
        button.addEventListener('click', () => onTime(t));
        return [button, element, what];
      });
      const note = run.events_left_out ? [make('p', { class: 'note' }, `and ${run.events_left_out} more: see events.csv`)] : [];
      box.append(make('div', {}, make('h3', {}, run.name), make('div', { class: 'tall' }, rows.length ? table(['t', 'element', 'event'], rows) : 'none'), ...note));
    }
  }
  function extremes(runs) {
    const names = [...new Set(runs.flatMap((r) => Object.keys(r.summary.extremes)))];
    const heads = ['channel', ...runs.flatMap((r) => { const of = runs.length > 1 ? ` ${r.name}` : ''; return [`least${of}`, 'at', `largest${of}`, 'at']; })];
    const meaning = (name) => runs.map((r) => r.meaning(name)).find(Boolean) || '';
    const row = (name) => [make('span', { title: meaning(name) }, name), ...runs.flatMap((r) => {
      const e = extremesOf(r, name);
      return e ? [known(e, 'min', e.unit), instant(e, 't_min'), known(e, 'max', e.unit), instant(e, 't_max')] : ['–', '', '–', ''];
    })];
    const most = 1000; // rows that a reader could want to see at once
    function fill(wanted) {
      const found = names.filter((name) => name.toLowerCase().includes(wanted));
      const note = found.length > most ? [make('p', { class: 'note' }, `and ${found.length - most} more: name what they contain`)] : [];
      document.getElementById('extremes-table').replaceChildren(make('div', { class: 'tall' }, table(heads, found.slice(0, most).map(row), heads.map((_, i) => i).slice(1))), ...note);
    }
    fill('');
    document.getElementById('extremes-filter').addEventListener('input', (event) => fill(event.target.value.toLowerCase()));
  }
  function models(runs) {
    const box = document.getElementById('model-texts');
    for (const run of runs) box.append(make('details', {}, make('summary', {}, `${run.name}: the model as it was run`), make('pre', {}, run.model_text)));
  }
  return { trust, verdict, events, extremes, models };
})();
