// How near each limit is: bars to one scale, the worst first, with the limit as a line through all of them. Of several
// runs a bar each under the same name.
steplap.bars = (() => {
  const make = steplap.make, { percent, one, full, isKnown } = steplap.numbers;
  const first = 8, firstOfSeveral = 6; // rows that are seen without asking for more
  const longest = 1.6; // of the limit: what is beyond it is cut off, with an arrow that says so

  const stateOf = (u) => (u.beyond || u.share > 1 ? 'bad' : u.share >= 0.7 ? 'warn' : 'good');
  const size = (u) => (isKnown(u.share) ? u.share : Infinity); // no number, but a limit: an infinite load or no capacity
  // Rows { name, entries: [one a run, or undefined] }, the worst first.
  function rowsOf(runs) {
    const rows = new Map();
    runs.forEach((run, k) => {
      for (const u of steplap.overview.of(run).utilisations) {
        if (!rows.has(u.name)) rows.set(u.name, { name: u.name, entries: runs.map(() => undefined) });
        rows.get(u.name).entries[k] = u;
      }
    });
    const worst = (row) => Math.max(...row.entries.filter(Boolean).map(size));
    return [...rows.values()].sort((a, b) => worst(b) - worst(a));
  }
  // "124 of 156 kN", or "1.1, asked 1.2" where more is better; nothing where the share says it all.
  function ofLimit(u) {
    if (!isKnown(u.value) || !isKnown(u.limit) || (!u.unit && u.limit === 1)) return '';
    const { texts, unit } = steplap.numbers.column([{ value: u.value }, { value: u.limit }], u.unit || '');
    const isLeast = Math.abs(u.value) > 0 && Math.abs(u.share - u.limit / u.value) < 1e-6 * Math.abs(u.share) && u.value !== u.limit;
    if (isLeast) return `${steplap.numbers.withUnit(texts[0], unit)}, asked ${steplap.numbers.withUnit(texts[1], unit)}`;
    return steplap.numbers.withUnit(`${texts[0].replace('−', '')} of ${texts[1].replace('−', '')}`, unit);
  }
  function barOf(u, scale, run, isOne, onChoose) {
    const share = size(u), isCut = share > scale, length = Math.min(share, scale) / scale;
    const bar = make('span', { class: `bar ${stateOf(u)}${isCut ? ' cut' : ''}`, style: `width:${(100 * length).toFixed(3)}%`, 'data-share': String(u.share) });
    const track = make('span', { class: 'track' }, bar, make('span', { class: 'limit', style: `left:${(100 / scale).toFixed(3)}%` }));
    const button = make('button', { type: 'button', class: 'utilisation', 'data-channel': u.channel || '', 'data-at': isKnown(u.at) ? String(u.at) : '',
      title: [u.text, `value ${full(u.value, u.unit)}`, `limit ${full(u.limit, u.unit)}`, isKnown(u.at) ? `at ${full(u.at, 's')}` : ''].filter(Boolean).join('\n') },
    make('span', { class: 'who' }, isOne ? u.name : run.name), make('span', { class: 'of-limit' }, ofLimit(u)), make('span', { class: `percent ${stateOf(u)}` }, percent(u.share, u.error)), track);
    button.addEventListener('click', () => onChoose(u, run));
    return button;
  }
  // `onChoose(utilisation, run)`: a reader asks for its curve and instant.
  function build(box, runs, onChoose) {
    const rows = rowsOf(runs), isOne = runs.length === 1, seen = isOne ? first : firstOfSeveral;
    box.hidden = !rows.length;
    if (!rows.length) return;
    const worst = Math.max(...rows.map((row) => Math.max(...row.entries.filter(Boolean).map(size))));
    const scale = Math.min(longest, Math.max(1.04, 1.02 * worst));
    const list = (some) => make('ul', { class: 'bars' }, ...some.map((row) => make('li', {}, ...(isOne ? [] : [make('h4', {}, row.name)]),
      ...row.entries.map((u, k) => (u ? barOf(u, scale, runs[k], isOne, onChoose) : '')).filter(Boolean))));
    box.append(make('h2', {}, 'How near to the limits'), make('p', { class: 'note scale-note', style: `--limit:${(100 / scale).toFixed(3)}%` }, make('span', {}, 'limit')), list(rows.slice(0, seen)));
    if (rows.length > seen) box.append(make('details', {}, make('summary', {}, `${rows.length - seen} more`), list(rows.slice(seen))));
  }
  return { build };
})();
