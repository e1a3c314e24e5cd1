// The sheet of load cases: drawing, cases with sources, utilisation of each limit in each case, values of each case.
steplap.casesSheet = (found) => {
  const make = steplap.make, { quantity } = steplap.data, { table } = steplap.tables, { percent } = steplap.numbers;
  const { part, named, drawing, smaller } = steplap.sheet, { model, cases } = found, usual = 8.5; // usual font size, pt

  const limitOf = (one, name) => one.limits.findIndex((l) => l.limit === name);
  // Returns the utilisation of a limit, or its outcome if it has none, such as an event.
  function used(one, name) {
    const limit = one.limits[limitOf(one, name)];
    if (!limit) return '–';
    if (limit.utilisation === null) return { hold: 'met', open: 'open' }[limit.outcome] || 'not met';
    return `${percent(limit.utilisation)}${limit.outcome === 'open' ? ' ?' : ''}`;
  }
  const marked = (text, outcome) => ({ text, class: outcome === 'hold' ? 'met' : 'beyond' });
  function caseRow(one, k) {
    const governing = one.governing_limit, plane = { text: one.plane || '–', class: 'word' };
    return [
      String(k + 1), one.name, plane, one.source, marked(one.verdict, one.verdict), governing || '–', governing ? used(one, governing) : '–'
    ];
  }
  function limitRow({ limit, governing_case: governing }) {
    const worst = cases.find((one) => one.name === governing), i = limitOf(worst, limit);
    const c = worst.judgement.criteria[i], { margin } = worst.limits[i];
    const inCase = (one) => {
      const own = one.limits[limitOf(one, limit)];
      return own ? marked(used(one, limit), own.outcome) : '–';
    };
    return [
      `${limit} (${c.criterion}${c.reason ? `; ${c.reason}` : ''})`, ...cases.map(inCase), String(cases.indexOf(worst) + 1),
      quantity(c.value, c.unit), quantity(margin, c.unit), c.error === null ? '–' : quantity(c.error, c.unit, 2)
    ];
  }
  const values = (one, k) =>
    make('p', {}, `${k + 1}: ${one.overrides.join('; ') || 'those of the model'}${one.verdict === 'hold' ? '' : `. ${one.reason}`}`);
  const numbers = cases.map((_, k) => k + 1), last = [1, 2, 3, 4].map((k) => cases.length + k);
  const machines = steplap.data.runs.map((run) => drawing(steplap.data.still(run.name, run.drawing), 0));
  const inputs = [model, ...(found.other_planes || [])].flatMap((plane) => plane.inputs);
  const parts = [
    machines.length > 1 ? make('div', { class: 'beside' }, ...machines) : machines[0],
    part('Cases',
      make(
        'div', { id: 'cases' }, table(['no.', 'case', 'plane', 'source', 'verdict', 'governing limit', 'used'], cases.map(caseRow), [6]))),
    part('Limits: utilisation in each case',
      make('div', { id: 'limits' },
        table(
          ['limit', ...numbers.map(String), 'governs', 'value', 'margin', 'error'], found.limits.map(limitRow), [...numbers, ...last]))),
    part('Values of each case', ...cases.map(values))
  ];
  const content = {
    title: `Load cases: ${model.title || model.name}`,
    about: `${inputs.map((file) => named(file.file, file.sha256)).join('; ')}. Made by ${steplap.data.program}.`,
    word: found.verdict.toUpperCase(),
    verdict: found.verdict,
    reason: found.reason,
    parts,
    signed: ['Prepared by', 'Approved by']
  };
  return { contentOf: () => content, room: { most: { size: usual }, cuts: smaller(usual, 4.5) } };
};
