// The page of an assessment, or of a static proof alone.
(() => {
  const make = steplap.make, { table } = steplap.tables, { one, percent, isKnown } = steplap.numbers, A = steplap.assessment,
        E = steplap.events;
  const at = (id) => document.getElementById(id), { given } = A;
  function put(id, ...content) {
    const parts = content.filter((c) => c);
    if (!parts.length) return;
    at(id).append(...parts);
    at(id).hidden = false;
  }
  const bullets = (texts) => (texts.length ? make('ul', {}, ...texts.map((t) => make('li', {}, t))) : null);
  const note = (text) => make('p', { class: 'note' }, text);

  function keyFigures() {
    const figure = (value, words) => make('li', {}, make('b', {}, value), ` ${words}`),
          count = (test) => A.events.filter((e) => e.models.some(test)).length;
    return make('ul', { class: 'key-figures' }, figure(String(A.events.length), A.events.length === 1 ? 'event' : 'events'),
      figure(String(count((m) => m.slipping.length)), 'in which a joint slips'),
      figure(String(count((m) => m.verdict === 'reject')), 'in which a model does not hold'),
      figure(String(count((m) => m.verdict === 'open')), 'in which a verdict is open'),
      ...(A.voyage.damage_probability ? [figure(A.chanceText(A.voyage.damage_probability), 'probability of damage in the voyage')] : []));
  }
  function decision() {
    const { verdict, reason } = A.answer();
    const badge = make('span', { class: `badge ${A.words[verdict] ? verdict : 'open'}` }, A.words[verdict] || 'OPEN');
    at('decision')
      .append(make('div', { class: 'verdict-line' }, badge, make('span', { class: 'reason' }, reason)),
        ...A.contradictions().map((t) => make('p', { class: 'contradiction' }, `Look at this: ${t}`)));
    if (!given) return;
    at('decision').append(keyFigures());
    if (A.reasons.length)
      at('decision')
        .append(table(['criterion', 'outcome', 'reason', 'source'],
          A.reasons.map((r) => [r.criterion || '',
                          { text: A.outcomes[r.outcome] || String(r.outcome), class: r.outcome in A.outcomes ? r.outcome : 'open' },
                          r.text || '', r.source || ''])));
  }
  function voyage() {
    if (!A.totals.length) return;
    put('voyage',
      table(['joint', 'model', 'slid in all', 'slips', 'overlap left'],
        A.totals.map((j) => [j.name, j.model || '', { text: A.slidText(j.slid_total), value: j.slid_total }, String(j.slips ?? '–'),
                       { text: percent(j.overlap_left), value: j.overlap_left }]),
        [2, 3, 4]),
      note('What one event leaves slid is where the next one begins.'));
  }
  function hangs() {
    const shares = A.uncertain.map((u) => u.share).filter(isKnown), largest = Math.max(1e-12, ...shares);
    const share = (u) =>
      (isKnown(u.share) ? make('span', {}, make('span', { class: 'share-bar', style: `width:${(5 * Math.max(0, u.share)) / largest}rem` }),
                            percent(u.share))
                        : '–');
    put('hangs', bullets(A.hangs),
      A.uncertain.length ? table(['uncertain value', 'model', 'taken', 'range', 'law', 'share of the uncertainty', 'known by', 'source'],
                             [...A.uncertain]
                               .sort((a, b) => (b.share || 0) - (a.share || 0))
                               .map((u) => [make('span', { title: String(u.path || '') }, u.name || u.path || ''), u.model,
                                      one(u.nominal, u.unit), `${one(u.low, u.unit)} to ${one(u.high, u.unit)}`, u.law || '', share(u), {
                                        text: String(u.source || 'not stated'),
                                        class: u.source === 'measured' ? 'met'
                                          : u.source === 'assumed'     ? 'beyond'
                                          : u.source === 'specified'   ? 'plain'
                                                                       : 'words'
                                      },
                                      u.source_text || '']),
                             [2])
                         : null);
  }
  const warnings = (r) => [...A.list(r.faults), ...A.list(r.warnings),
    ...(A.list(r.peaks_only).length && !r.events
        ? [`${A.list(r.peaks_only).length} shocks of this record are peaks without a waveform: no model was run with them.`]
        : [])];
  function sources() {
    const c = A.criteria;
    put('sources',
      c ? make('div', {}, make('h3', {}, `Criteria: ${c.name || ''}`),
            make('p', { class: 'note' }, [c.file, c.source].filter((t) => t).join('. Source: ')), c.text ? make('pre', {}, c.text) : '')
        : null,
      ...A.records.map(
        (r) => make('div', {}, make('h3', {}, `Record: ${r.file}`),
          table(null, [['SHA-256', make('span', { class: 'hash' }, r.sha256 || 'unknown')]]), bullets(A.list(r.taken_for)) || '',
          warnings(r).length ? make('div', { class: 'warnings' }, make('h4', {}, 'Warnings'), bullets(warnings(r))) : '')),
      A.models.length ? make('div', {}, make('h3', {}, 'Models'),
                          table(['model', 'plane', 'file', 'recorder at', 'its axes', 'SHA-256'],
                            A.models.map((m) => [m.name, m.plane || '', m.file || '', m.recorder ? m.recorder.marker : 'not stated',
                                           m.recorder ? `x = ${m.recorder.x}, y = ${m.recorder.y}` : '', m.sha256 || ''])))
                      : null);
  }
  function worstEvent() {
    const found = A.worst.length ? steplap.eventMachine.of(A.worst[0], 1) : null;
    if (found) put('worst-event', make('div', {}, found.picture, make('p', {}, found.text)), E.curve(A.worst[0]));
  }
  function events() {
    if (!A.events.length) return;
    const shown = A.worst.slice(0, 6), drawn = A.worst.slice(0, 12);
    put('worst',
      note('Those that do not hold come first, then the likeliest to slip, then the smallest margins. ' +
        'A peak is written with the bandwidth to which it was read.'),
      E.tableOf(shown), E.curves(drawn));
    put('events', note('In the order of the voyage. A line opens with all that is known of its event.'), E.tableOf(A.events),
      ...A.events.map(E.fold));
  }

  at('title').textContent = given ? 'Assessment of a transport' : 'Static proof';
  at('subtitle').textContent = [
    A.records.map((r) => r.file).join(', '), (A.models.length ? A.models.map((m) => m.name) : A.statics.map((s) => s.model)).join(', ')
  ].filter((t) => t).join(' · ');
  const sheet = steplap.assessmentSheet();
  // before the rest of the page is built, because each of a dozen layouts would take longer with it
  const kept = steplap.sheet.fit(sheet.contentOf, sheet.room);
  decision();
  worstEvent();
  events();
  voyage();
  hangs();
  put('tests', bullets(A.tests));
  put('unknown', ...A.unknown.map((u) => make('div', {}, make('h3', {}, u.name), bullets(u.list))));
  put('assumptions', bullets(A.assumptions));
  put('static', ...A.statics.map(steplap.statics.section));
  sources();
  at('footer').textContent = `Written by ${A.program} from ${A.folder}.`;
  steplap.page = { kept };
  document.body.setAttribute('data-ready', 'true');
})();
