// The verdict with its reason, and a line about the reliability of the results, with details that can be opened.
steplap.verdict = (() => {
  const make = steplap.make, { few, table } = steplap.tables, { one, instant, full } = steplap.numbers;
  const levels = {
    good: 'Numerical error: small.',
    limited: 'Numerical error: not known to be small.',
    none: 'Numerical error: not known.'
  };

  function trustLine(run) {
    const { trust } = steplap.overview.of(run);
    const level = trust && trust.level in levels ? trust.level : 'limited';
    return [
      make('span', { class: `lamp ${level}`, 'aria-hidden': 'true' }), make('strong', {}, levels[level]), ` ${trust ? trust.text : ''}`
    ];
  }
  function card(run, isOne) {
    const overview = steplap.overview.of(run), badge = steplap.overview.badgeOf(run);
    const box = make('div', { class: 'card', 'data-run': run.name });
    if (!isOne) box.append(make('h2', { class: 'run-name' }, run.name));
    const sign = badge.name === 'none' ? '' : make('span', { class: `badge ${badge.name}` }, badge.word); // no verdict without criteria
    box.append(make('p', { class: 'verdict-line' }, sign, make('span', { class: 'reason' }, overview.reason)));
    if (overview.isOld)
      box.append(make('p', { class: 'note old' },
        'These results are older than this program. Run the model again to see how near it is to its limits and what happened in words.'));
    if (!isOne) box.append(make('p', { class: 'trust-line' }, ...trustLine(run)));
    return box;
  }

  // --- details of the reliability -------------------------------------------------------------------
  function settingText(run) {
    const s = run.summary, isFixed = s.integrator === 'rk4' || s.integrator === 'moreau';
    return `${s.integrator}, ` +
      (isFixed ? `step ${one(s.settings.step, 's')}`
          : s.settings.tolerance === null || s.settings.tolerance === undefined ? 'its usual tolerance'
                                                                                : `tolerance ${few(s.settings.tolerance)} for each step`);
  }
  function errorText(run) {
    const e = run.summary.global_error;
    if (!e) return `not estimated: ${run.summary.error_not_estimated || 'it was not asked for'}`;
    const size = (v) => (v.error === null ? Infinity : v.error);
    const worst = Object.entries(e).filter(([, v]) => v && typeof v === 'object').sort((a, b) => size(b[1]) - size(a[1]))[0];
    return worst ? `${worst[1].error === null ? 'unknown' : `${few(worst[1].error)} of range`} (${worst[0]}: ${worst[1].where})` : '–';
  }
  function opinionText(run) {
    const o = run.summary.second_opinion;
    return !o          ? 'not asked'
      : o.none_because ? `none: ${o.none_because}`
      : o.agrees ? `${o.method} agrees`
                 : `${o.method} disagrees: ${o.disagreement}`;
  }
  const list = (texts) => (texts.length ? make('ul', { class: 'caps' }, ...texts.map((text) => make('li', {}, text))) : 'nothing');
  const sourcesOf = (r) => (r.summary.findings || []).filter((f) => f.code === 'friction_by_source').map((f) => f.text);
  function rows(runs) {
    const energy = (r) => r.summary.accuracy;
    return [
      [
        'run',
        (r) => (r.summary.completed ? `complete, 0 to ${instant(r.end, r.end)}`
                                    : `stopped at ${instant(r.end, r.end)}: ${r.summary.failure || ''}`)
      ],
      ['integrator', settingText], ['estimated error', errorText], ['second opinion', opinionText],
      ['checked by', (r) => (steplap.overview.of(r).trust?.guards || []).join(', ') || '–'],
      ['forbids “hold”', (r) => list(r.summary.judgement ? r.summary.judgement.capped_by : [])],
      ['energy residual', (r) => `${few(energy(r).energy_residual)} J, ${few(energy(r).relative_energy_residual)} of what was exchanged`],
      [
        'dissipated energy', (r) => ({
          text: one(energy(r).dissipated, 'J', { error: energy(r).error_dissipated }),
          value: energy(r).dissipated,
          full: full(energy(r).dissipated, 'J', energy(r).text_dissipated)
        })
      ],
      ['constraint residual', (r) => `${few(energy(r).max_position_residual)} m or rad`],
      ['steps, evaluations', (r) => `${r.summary.statistics.steps}, ${r.summary.statistics.evaluations}`],
      ['events', (r) => String(r.summary.statistics.events)],
      ...(runs.some((r) => r.summary.left_out) ? [['not in the model', (r) => list(r.summary.left_out || [])]] : []),
      ...(runs.some((r) => sourcesOf(r).length) ? [['unusual, with its source', (r) => list(sourcesOf(r))]] : []),
      ['warnings', (r) => list((r.summary.findings || []).filter((f) => f.level === 'warning').map((f) => f.text))]
    ];
  }
  function buildCards(runs) {
    document.getElementById('verdict-cards').replaceChildren(...runs.map((run) => card(run, runs.length === 1)));
  }
  function build(runs) {
    const isOne = runs.length === 1;
    buildCards(runs);
    const summary = isOne ? make('summary', {}, ...trustLine(runs[0])) : make('summary', {}, 'How far these can be trusted');
    document.getElementById('trust').append(summary);
  }
  // Builds the details, which are not part of the first screen.
  function buildTrust(runs) {
    const heads = ['', ...runs.map((r) => r.name)];
    document.getElementById('trust').append(
      table(runs.length > 1 ? heads : null, rows(runs).map(([name, text]) => [name, ...runs.map(text)])));
  }
  return { build, buildCards, buildTrust };
})();
