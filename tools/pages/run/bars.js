// Draws the utilisation of each limit as a bar, all on one scale, the highest first, with the limit as a line. Several runs have one bar
// each under a common name; bars of one kind at the same position are paired even if their names differ.
steplap.bars = (() => {
  const make = steplap.make, { percent, full, isKnown } = steplap.numbers;
  const first = 8, firstOfSeveral = 6, firstOfOthers = 3; // number of bars shown initially: for one run, for several runs, of other limits
  const longest = 1.6; // length of a bar relative to the limit at which it is cut off with an arrow

  const { isJudged } = steplap.overview;
  // a joint that slipped; shown as a word, because value and limit are equal
  const isSlip = (u) => u.beyond && !isKnown(u.value) && u.share === 1;
  // Style class of a bar. Utilisations without a criterion never get an alarm colour.
  const stateOf = (u) => (!isJudged(u) ? 'plain' : u.beyond || u.share > 1 ? 'bad' : u.share >= 0.7 ? 'warn' : 'good');
  const size = (u) => (isKnown(u.share) ? u.share : Infinity); // sorts utilisations without a number (infinite load, or no capacity) first
  // Returns what a bar is about, without its name: kind of element, kind of limit, and position in the reference pose; null without an
  // element.
  function subjectOf(u, run) {
    const element =
            run.drawing.elements.filter((e) => (u.channel || '').startsWith(`${e.name}.`)).sort((a, b) => b.name.length - a.name.length)[0],
          place = element && placeOf(element, run);
    if (!place) return null;
    const body = run.drawing.bodies.find((b) => b.name === place.body),
          aspect = u.name.startsWith(element.name) ? u.name.slice(element.name.length) : '';
    return {
      what: [element.kind, u.channel.slice(element.name.length), aspect].join('\n'),
      at: steplap.geometry.apply((body && body.pose) || [0, 0, 0], place.point)
    };
  }
  // Returns the position of the element, of its limb, or of the first contact on which its friction acts; undefined if there is none.
  function placeOf(element, run) {
    if (element.at && element.at.length) return element.at[0];
    if (element.limb) return { body: element.limb, point: [0, 0] };
    const contact = run.drawing.elements.find((e) => (element.contacts || []).includes(e.name));
    return contact && contact.at && contact.at[0];
  }
  const sizeOf = (run) => {
    const box = run.drawing.bodies.reduce((b, body) => b.take((body.pose || [0, 0]).slice(0, 2)), new steplap.Box());
    return Math.max(...box.span);
  };
  // Pairs rows that exist in some runs only with rows at the same position in the others, if the match is unique.
  function pairByPlace(rows, runs) {
    const near = 0.01 * Math.max(...runs.map(sizeOf)),
          subjects = rows.map((row) => row.entries.map((u, k) => (u ? subjectOf(u, runs[k]) : null)));
    const isSame = (i, j) => rows[i].entries.every((u, k) => !u || !rows[j].entries[k]) &&
      subjects[i].some(
        (a) => a && subjects[j].some((b) => b && a.what === b.what && steplap.geometry.length(steplap.geometry.minus(a.at, b.at)) <= near));
    const gone = new Set();
    rows.forEach((row, i) => {
      if (gone.has(i) || row.entries.every(Boolean)) return;
      const found = rows.map((_, j) => j).filter((j) => j !== i && !gone.has(j) && isSame(i, j));
      const back = found.length === 1 ? rows.map((_, j) => j).filter((j) => j !== found[0] && !gone.has(j) && isSame(found[0], j)) : [];
      if (back.length !== 1) return;
      rows[found[0]].entries.forEach((u, k) => {
        if (u) row.entries[k] = u;
      });
      gone.add(found[0]);
    });
    return rows.filter((_, i) => !gone.has(i));
  }
  // Returns the heading of a row: its name, both names if runs differ, and the runs without this bar.
  function headOf(row, runs) {
    const names = [...new Set(row.entries.filter(Boolean).map((u) => u.name))], without = runs.filter((_, k) => !row.entries[k]);
    const alone = without.length ? make('span', { class: 'alone-note' }, ` not in ${without.map((r) => r.name).join(', ')}`) : '';
    return make('h4', {}, names.join(' / '), alone);
  }
  // Returns the name under which bars of several runs are matched. A criterion for many elements names the worst one in brackets, which may
  // differ between runs: "joint margin (back joint)".
  function keyOf(u) {
    const element = (u.channel || '').replace(/\.[^.]*$/, '');
    return element && u.name.endsWith(` (${element})`) ? u.name.slice(0, -element.length - 3) : u.name;
  }
  // Returns rows { name, entries }, the worst first. `entries` has one utilisation per run, or undefined.
  function rowsOf(runs) {
    const rows = new Map();
    runs.forEach((run, k) => {
      for (const u of steplap.overview.of(run).utilisations) {
        const key = keyOf(u);
        if (!rows.has(key)) rows.set(key, { name: key, entries: runs.map(() => undefined) });
        rows.get(key).entries[k] = u;
      }
    });
    const worst = (row) => Math.max(...row.entries.filter(Boolean).map(size));
    return pairByPlace([...rows.values()], runs).sort((a, b) => worst(b) - worst(a));
  }
  // Returns value and limit: "124 of 156 kN", or "1.1, asked 1.2" if larger is better; '' if the percentage suffices.
  function ofLimit(u) {
    if (isSlip(u) || u.limit === 0) return u.detail || ''; // for a limit of zero there is no percentage
    if (!isKnown(u.value) || !isKnown(u.limit) || (!u.unit && u.limit === 1)) return '';
    if (!u.unit && (u.channel || '').endsWith('share')) return `${percent(u.value)} of ${percent(u.limit)}`;
    if (!u.unit && u.detail) return u.detail; // `detail` describes the number
    const { texts, unit } = steplap.numbers.column([{ value: u.value }, { value: u.limit }], u.unit || '');
    const isLeast = Math.abs(u.value) > 0 && Math.abs(u.share - u.limit / u.value) < 1e-6 * Math.abs(u.share) && u.value !== u.limit;
    if (isLeast) return `${steplap.numbers.withUnit(texts[0], unit)}, asked ${steplap.numbers.withUnit(texts[1], unit)}`;
    return steplap.numbers.withUnit(`${texts[0].replace('−', '')} of ${texts[1].replace('−', '')}`, unit);
  }
  function barOf(u, scale, run, isOne, onChoose) {
    const share = size(u), isCut = share > scale, length = Math.min(share, scale) / scale;
    const bar = make('span',
      { class: `bar ${stateOf(u)}${isCut ? ' cut' : ''}`, style: `width:${(100 * length).toFixed(3)}%`, 'data-share': String(u.share) });
    const track = make('span', { class: 'track' }, bar, make('span', { class: 'limit', style: `left:${(100 / scale).toFixed(3)}%` }));
    const button = make('button', {
      type: 'button',
      class: 'utilisation',
      'data-channel': u.channel || '',
      'data-at': isKnown(u.at) ? String(u.at) : '',
      title: [u.text, `value ${full(u.value, u.unit)}`, `limit ${full(u.limit, u.unit)}`, isKnown(u.at) ? `at ${full(u.at, 's')}` : '']
               .filter(Boolean)
               .join('\n')
    },
      make('span', { class: 'who' }, isOne ? u.name : run.name), make('span', { class: 'of-limit' }, ofLimit(u)),
      make('span', { class: `percent ${stateOf(u)}` }, percent(u.share, u.error)), track);
    button.addEventListener('click', () => onChoose(u, run));
    return button;
  }
  // Builds the bars. Calls `onChoose(utilisation, run)` when the reader selects one.
  function build(box, runs, onChoose) {
    const rows = rowsOf(runs), isOne = runs.length === 1, seen = isOne ? first : firstOfSeveral;
    box.hidden = !rows.length;
    if (!rows.length) return;
    const isOfCriterion = (row) => row.entries.some((u) => u && isJudged(u)), criteria = rows.filter(isOfCriterion),
          others = rows.filter((row) => !isOfCriterion(row));
    const worst = Math.max(...rows.map((row) => Math.max(...row.entries.filter(Boolean).map(size))));
    const scale = Math.min(longest, Math.max(1.04, 1.02 * worst));
    const list = (some) => make('ul', { class: 'bars' },
      ...some.map((row) => make('li', {}, ...(isOne ? [] : [headOf(row, runs)]),
                    ...row.entries.map((u, k) => (u ? barOf(u, scale, runs[k], isOne, onChoose) : '')).filter(Boolean))));
    const put = (heading, some, most) => {
      if (!some.length) return;
      box.append(make('h2', {}, heading),
        make('p', { class: 'note scale-note', style: `--limit:${(100 / scale).toFixed(3)}%` }, make('span', {}, 'limit')),
        list(some.slice(0, most)));
      if (some.length > most) box.append(make('details', {}, make('summary', {}, `${some.length - most} more`), list(some.slice(most))));
    };
    put('How near to the limits', criteria, seen);
    put('Friction and strength without a criterion', others, criteria.length ? firstOfOthers : seen);
  }
  return { build };
})();
