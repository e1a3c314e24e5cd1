// Tables of results, for one run and for comparisons of several.
steplap.results = (() => {
  const make = steplap.make, { table, fold } = steplap.tables,
        { column, one, instant, roundingOf, roundingIn, isKnown, withUnit, percent, full } = steplap.numbers;
  const q = steplap.quantities;
  const head = (name, unit) => ({ text: unit ? `${name} [${unit}]` : name });
  const cell = (text, number) => ({ text, value: number.value, full: number.full });

  // --- one run -------------------------------------------------------------------------------------
  // Returns the cell with the time of a value; empty for values that are rounding errors.
  const at = (run, n) =>
    (isKnown(n.at) && !(Math.abs(n.value) <= roundingOf(run, n.unit)) ? { text: instant(n.at, run.end, n.atError), full: n.atFull } : '');
  function criteria(run) {
    const list = q.criteria(run);
    if (!list.length) return null;
    const rows = list.map((c) => {
      const { texts, unit } =
        column([{ value: c.value, error: c.error, limit: c.limit }, { value: c.limit }], c.unit, roundingOf(run, c.unit));
      return [
        c.reason ? make('span', { title: c.reason }, c.name) : c.name, c.asked, { text: c.outcome, class: c.outcome },
        cell(withUnit(texts[0], unit), c), { text: withUnit(texts[1], unit), value: c.limit, full: full(c.limit, c.unit) }, at(run, c),
        c.doubt || ''
      ];
    });
    const hasDoubt = list.some((c) => c.doubt);
    return fold('Criteria', true,
      table(['criterion', 'asked', 'result', 'value', 'limit', 'at', ...(hasDoubt ? ['doubt'] : [])],
        hasDoubt ? rows : rows.map((r) => r.slice(0, 6)), [3, 4, 5]));
  }
  // Returns columns of numbers, each with one unit: { heads, cells[row][column] }.
  function columnsOf(run, rows) {
    const heads = rows[0].map(([name]) => name), cells = rows.map(() => []);
    rows[0].forEach(([, { unit }], k) => {
      const isTime = unit === 's', found = isTime ? null : column(rows.map((r) => r[k][1]), unit, roundingOf(run, unit));
      if (!isTime) heads[k] = head(heads[k], found.unit).text;
      rows.forEach((r, i) => cells[i].push(cell(isTime ? instant(r[k][1].value, run.end, r[k][1].error) : found.texts[i], r[k][1])));
    });
    return { heads, cells };
  }
  function joints(run) {
    const list = q.joints(run);
    if (!list.length) return null;
    const { heads, cells } = columnsOf(run, list.map((j) => j.figures));
    const rows = list.map((j, i) => [j.name, { text: j.verdict, class: j.class }, ...cells[i]]);
    return fold('Step-lap joints', true,
      make('p', { class: 'note' }, 'Least margin, largest pressure needed, distances slid and area lost at the end.'),
      table(['joint', 'verdict', ...heads], rows, [2, 3, 4, 5, 6, 7, 8]), ...edges(run, list), ...shared(list));
  }
  // Returns a note on joints whose limbs were drawn towards their yokes, so that sheet edges may carry load.
  function edges(run, list) {
    const bearing = list.filter((j) => j.raw.largest_edge_load !== undefined);
    if (!bearing.length) return [];
    const figures =
      bearing.map(({ raw }) => [['line load', q.number(raw, 'largest_edge_load', 'N/m')],
                    ['pressure', q.number(raw, 'largest_edge_pressure', 'Pa')], ['allowed', q.number(raw, 'allowed_line_load', 'N/m')]]);
    const { heads, cells } = columnsOf(run, figures);
    const rows =
      bearing.map(({ name, raw }, i) => [name, ...cells[i], raw.largest_edge_load ? instant(raw.t_largest_edge_load, run.end) : '–',
                    raw.largest_edge_share === undefined ? '–'
                      : raw.largest_edge_share === 0     ? '∞'
                                                         : { text: one(raw.smallest_edge_margin, ''), value: raw.smallest_edge_margin },
                    raw.crushed_edges === undefined || raw.crushed_edges === null
                      ? '–'
                      : { text: raw.crushed_edges ? 'crushed' : 'borne', class: raw.crushed_edges ? 'reject' : 'met' }]);
    return [
      make('h4', {}, 'Sheet edges along the mitres: largest line load, of all sheets at a corner'),
      table(['joint', ...heads, 'at', 'margin', 'edges'], rows, [1, 2, 3, 4, 5])
    ];
  }
  // Returns a note on elements that carry load in parallel with a joint; the joint's margin refers to its own share.
  function shared(list) {
    return list.filter((j) => j.raw.shared_with)
      .map(
        ({ name, raw }) => make('p', { class: 'note' },
          `${name}: the margin is that of its own share. Beside it bear ${
            raw.shared_with.map((s) => s.element + (s.largest_force === null ? '' : ` (up to ${one(s.largest_force, 'N')})`)).join(', ')}` +
            (raw.shares_before_it_slides ? '.' : ', which take no part before the joint slides: it is rigid.')));
  }
  const slipText = (slips) => (slips ? `slipped ${slips} time${slips > 1 ? 's' : ''}` : 'held');
  function friction(run) {
    const list = q.friction(run);
    if (!list.length) return null;
    const { heads, cells } = columnsOf(run, list.map((f) => [['largest slide', f.slide], ['left at the end', f.left]]));
    return fold('Friction', true,
      table(['contact', 'it', heads[0], 'at', heads[1]],
        list.map((f, i) => [f.name, slipText(f.slips), cells[i][0], at(run, f.slide), cells[i][1]]), [2, 3, 4]));
  }
  const most = 60; // largest number of forces; the extremes contain all
  function forces(run) {
    const all = q.forces(run), list = all.slice(0, most);
    if (!list.length) return [];
    return ['N', 'N m', ...steplap.data.unique([list.map((f) => f.unit)]).filter((u) => u !== 'N' && u !== 'N m')]
      .map((unit) => {
        const own = list.filter((f) => f.unit === unit);
        if (!own.length) return null;
        const { texts, unit: shown } =
          column([...own, ...own.filter((f) => isKnown(f.limit)).map((f) => ({ value: f.limit }))], unit, roundingOf(run, unit));
        const limits = texts.slice(own.length), hasLimit = limits.length > 0, hasOpened = own.some((f) => f.opens.length);
        const rows = own.map((f, i) => [f.name, cell(texts[i], f), at(run, f),
                               ...(hasLimit ? [isKnown(f.limit) ? { text: limits.shift(), value: f.limit } : '–'] : []),
                               ...(hasOpened ? [f.opens.length ? `${f.opens.length} ×, first at ${instant(f.opens[0][0], run.end)}`
                                   : f.kind === 'contacts' ? 'never'
                                                           : '']
                                                               : [])]);
        return fold(q.headingOf(own), true,
          table(
            [
              'element', head('largest', shown).text, 'at', ...(hasLimit ? [head('allowed', shown).text] : []),
              ...(hasOpened ? ['opens'] : [])
            ],
            rows, hasLimit ? [1, 2, 3] : [1, 2]));
      })
      .filter(Boolean);
  }

  // --- several runs --------------------------------------------------------------------------------
  // Returns the rows of all runs, matched by key: { group, name, unit, isTime, isShare, entries }.
  function compared(runs) {
    const rows = new Map();
    const add = (k, group, name, n, more = {}) => {
      const key = `${group}\n${name}`;
      if (!rows.has(key)) rows.set(key, { group, name, unit: n.unit || '', ...more, entries: runs.map(() => null) });
      const row = rows.get(key);
      if (row.entries[k] === null && row.unit === (n.unit || '')) row.entries[k] = n;
    };
    runs.forEach((run, k) => {
      for (const u of steplap.overview.of(run).utilisations)
        add(k, 'Share of the limit', u.name,
          { value: u.share, error: u.error, unit: '', full: full(u.share), word: u.beyond ? 'beyond' : '' }, { isShare: true });
      for (const c of q.criteria(run))
        add(k, 'Criteria', c.name === c.asked ? c.name : `${c.name}: ${c.asked}`, {...c, word: c.outcome },
          { isSize: c.asked.includes('|') });
      for (const j of q.joints(run))
        for (const [name, n] of j.figures) add(k, 'Step-lap joints', `${j.name}: ${name}`, n, { isTime: n.unit === 's' });
      for (const f of q.friction(run)) {
        add(k, 'Friction', `${f.name}: largest slide`, f.slide, { isSize: true });
        add(k, 'Friction', `${f.name}: slide left at the end`, f.left);
      }
      for (const f of q.forces(run))
        add(k, 'Forces and couples', f.name + (f.channel.endsWith('.force') ? '' : `: ${f.channel.slice(f.name.length + 1)}`), f,
          { isSize: true });
    });
    return [...rows.values()];
  }
  // Returns the difference of two runs (second minus first), or the range of several. Magnitudes are compared if the criterion limits the
  // magnitude.
  function differenceOf({ entries, isSize }) {
    const values = entries.map((e) => (e && isKnown(e.value) && isFinite(e.value) ? (isSize ? Math.abs(e.value) : e.value) : null));
    if (values.length === 2) return values.includes(null) ? null : values[1] - values[0];
    const known = values.filter((v) => v !== null);
    return known.length > 1 ? Math.max(...known) - Math.min(...known) : null;
  }
  // Returns "+3 kN"; for magnitudes "3 kN more".
  function changeText(text, value, { isSize }, isTwo) {
    if (!isTwo || text === '0') return text;
    if (isSize) return `${text.replace('−', '')} ${value > 0 ? 'more' : 'less'}`;
    return value > 0 ? `+${text}` : text;
  }
  function rowCells(row, runs) {
    const isTwo = runs.length === 2, difference = differenceOf(row), end = Math.max(...runs.map((r) => r.end));
    const errors = row.entries.reduce((sum, e) => sum + (e && e.error > 0 ? e.error : 0), 0);
    const isSame = difference !== null && Math.abs(difference) <= errors;
    const write = row.isShare ? (v) => percent(v) : row.isTime ? (v) => instant(v, end) : null;
    const all = [...row.entries.map((e) => e || { value: null }), { value: difference }];
    const found = write ? { texts: all.map((e) => write(e.value)), unit: '' } : column(all, row.unit, roundingIn(runs, row.unit));
    const texts = found.texts.map((text) => withUnit(text, found.unit));
    if (row.isShare && difference !== null)
      texts[texts.length - 1] = withUnit(steplap.numbers.fixed(100 * difference, 1), difference === 0 ? '' : 'points');
    const cells = row.entries.map(
      (e, i) =>
        (e ? { text: texts[i] + (e.word && e.word !== 'met' ? `, ${e.word}` : ''), value: e.value, full: e.full, class: e.word || 'number' }
           : '–'));
    const last = {
      text: difference === null ? '–'
        : isSame                ? '0'
                                : changeText(texts[texts.length - 1], difference, row, isTwo),
      value: difference === null ? undefined : difference,
      full: full(difference, row.unit) + (isSame && difference !== 0 ? ', less than the errors' : '')
    };
    return [row.name, ...cells, last];
  }
  function compare(runs) {
    const rows = [[
      'verdict', ...runs.map((run) => {
        const badge = steplap.overview.badgeOf(run);
        return { text: badge.word, class: { hold: 'met' }[badge.name] || badge.name };
      }),
      ''
    ]];
    let group = '';
    for (const row of compared(runs)) {
      if (row.entries.every((e) => !e || !isKnown(e.value))) continue;
      if (row.group !== group) rows.push((group = row.group));
      rows.push(rowCells(row, runs));
    }
    const heads = ['', ...runs.map((r) => r.name), runs.length === 2 ? 'difference' : 'spread'];
    return table(heads, rows, heads.map((_, i) => i).slice(1));
  }

  function build(box, runs) {
    if (runs.length > 1) {
      box.append(fold('The runs beside each other', true, compare(runs)));
      return;
    }
    const [run] = runs;
    for (const part of [criteria(run), joints(run), friction(run), ...forces(run)])
      if (part) box.append(part);
    box.hidden = !box.querySelector('table');
  }
  return { build };
})();
