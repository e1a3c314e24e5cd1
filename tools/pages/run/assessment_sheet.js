// The sheet that is signed: papers, decision, worst events, what it hangs on, assumptions, criteria, room for two signatures, on one page
// of A4 whatever the lengths of lists and texts. What does not fit is counted, and stands on the sheets behind.
steplap.sheet = (() => {
  const make = steplap.make, { table } = steplap.tables, { percent } = steplap.numbers, A = steplap.assessment;
  const place = document.getElementById('sheet');
  // In the order in which room is made: [what, how much of it is kept].
  const most = { size: 8, texts: 2000, events: 14, joints: 10, reasons: 8, hangs: 6, tests: 10, assumptions: 14, unknown: 8, records: 6, cases: 12, polar: 1 };
  const cuts = [['texts', 600], ['size', 7.5], ['assumptions', 9], ['events', 10], ['joints', 7], ['texts', 300], ['records', 3], ['tests', 6], ['unknown', 5], ['events', 8], ['reasons', 5], ['hangs', 4], ['cases', 9], ['size', 7], ['texts', 200], ['assumptions', 6],
    ['joints', 5], ['events', 6], ['texts', 140], ['tests', 4], ['unknown', 3], ['hangs', 3], ['assumptions', 4], ['texts', 100], ['events', 5], ['records', 2], ['reasons', 3], ['joints', 3], ['polar', 0], ['cases', 6], ['texts', 70], ['events', 4],
    ['assumptions', 3], ['tests', 3], ['unknown', 2], ['hangs', 2], ['texts', 45], ['reasons', 2], ['joints', 2], ['events', 3], ['tests', 2], ['assumptions', 2], ['texts', 30], ['cases', 4]];

  function short(text, limit) {
    const letters = [...String(text)]; // not half of a letter
    return letters.length > limit ? `${letters.slice(0, limit - 1).join('')}…` : letters.join('');
  }
  const rest = (all, kept, what) => (all > kept ? [make('p', { class: 'more' }, `${all - kept} more ${what} on the sheets behind.`)] : []);
  const part = (title, ...content) => make('div', {}, make('h2', {}, title), ...content);
  const bullets = (texts, kept, limit, what) => [make('ul', {}, ...texts.slice(0, kept).map((t) => make('li', {}, short(t, limit)))), ...rest(texts.length, kept, what)];

  // A line to be filled in by hand where nothing is known.
  const orBlank = (text, limit) => (text ? short(text, limit) : make('span', { class: 'blank' }));
  const joined = (parts) => parts.flatMap((p, i) => (i ? [' · ', ...p] : p));
  function papers(keep) {
    const p = A.papers, limit = Math.min(keep.texts, 140), shown = p.recorders.slice(0, keep.records);
    const recorder = (r) => make('span', {}, ...joined([['serial number', r.serial], ['calibrated', r.calibrated], ['range', r.range], ['filter', r.filter], ['mounted', r.place]].map(([label, value]) => [`${label} `, orBlank(value, limit)])));
    const rows = [['Transformer', make('span', {}, 'serial number ', orBlank(p.transformer, limit))], ...shown.map((r) => [`Recorder${r.record ? ` of ${short(r.record, 30)}` : ''}`, recorder(r)]),
      ['Journey', make('span', {}, 'departure ', orBlank(p.departure, limit), ...p.handovers.slice(0, keep.records).flatMap((h) => [` · handover ${short(h.place, limit)}, ${short(h.time, limit)}`]), ' · arrival ', orBlank(p.arrival, limit))],
      ['Recorded', `${short(A.covered || 'Not stated.', limit)}${A.journey ? ` Asked: ${short(A.journey, limit)}.` : ''}${A.coveredShare === null || A.coveredShare === undefined ? '' : ` Of the journey ${percent(A.coveredShare)} are covered.`}`]];
    const drawing = A.worst.length ? steplap.events.curve(A.worst[0]) : null;
    return make('div', { class: 'papers' }, make('div', {}, table(null, rows), ...rest(p.recorders.length, shown.length, 'recorders'), ...rest(p.handovers.length, Math.min(p.handovers.length, keep.records), 'handovers')), ...(drawing ? [drawing] : []));
  }
  // Adds blank lines for the findings that the receiver writes by hand.
  const found = () => part('Found on arrival', make('div', { class: 'found' }, ...['Dew point of the gas', 'Pressure of the gas', 'Resistance core to earth', 'Visible damage'].map((what) => make('p', {}, `${what} `, make('span', { class: 'blank' })))));

  const peaks = (e, limit) => short(e.peaks.map((p) => A.peakText(p, true)).join('; ') || '–', Math.max(60, limit));
  function events(keep) {
    const rows = A.worst.slice(0, keep.events).flatMap((e) => (e.models.length ? e.models : [null]).slice(0, 2).map((m, k) => [String(e.number), k ? '' : short(A.timeText(e), keep.texts), k ? '' : peaks(e, keep.texts),
      m ? short(m.model, keep.texts) : '–', m ? { text: A.outcomes[m.verdict] || short(m.verdict, 20), class: m.verdict in A.outcomes ? m.verdict : 'open' } : 'not run', m ? short(m.joints.length ? A.slipText(m) : '–', keep.texts) : '–', m ? A.marginText(m) : '–', m ? A.slidText(m.slid) : '–', m ? A.chanceText(m.probability) : '–']));
    const box = table(['no.', 'time', 'peaks, with bandwidth', 'model', 'verdict', 'joints', 'margin', 'slid', 'probability of slip'], rows, [6, 7]);
    box.firstChild.classList.add('worst-table');
    return part(A.events.length > keep.events ? `The worst of ${A.events.length} events` : 'Events, the worst first', ...(rows.length ? [box] : [make('p', {}, 'No event was recorded.')]), ...rest(A.events.length, keep.events, 'events'));
  }
  function totals(keep) {
    const sorted = [...A.totals].sort((a, b) => (b.slid_total || 0) - (a.slid_total || 0));
    const rows = sorted.slice(0, keep.joints).map((j) => [short(j.name, Math.min(40, keep.texts)), short(j.model || '', Math.min(40, keep.texts)), A.slidText(j.slid_total), String(j.slips ?? '–'), percent(j.overlap_left)]);
    return part('Joints over the voyage', ...(rows.length ? [table(['joint', 'model', 'slid in all', 'slips', 'overlap left'], rows, [2, 3, 4])] : [make('p', {}, 'No joints were judged.')]), ...rest(sorted.length, keep.joints, 'joints'),
      ...(A.voyage.damage_probability ? [make('p', {}, `Probability of damage in the voyage: ${A.chanceText(A.voyage.damage_probability)}.`)] : []));
  }
  const sourced = (r, limit) => `${r.criterion ? `${short(r.criterion, limit)}: ` : ''}${A.outcomes[r.outcome] || r.outcome || ''}. ${short(r.text || '', limit)}${r.source ? ` (${short(r.source, limit)})` : ''}`;
  function criteria(keep) {
    const c = A.criteria;
    const named = c ? [make('p', {}, short([c.name, c.file, c.text, c.source ? `source: ${c.source}` : ''].filter((t) => t).join(' · '), 1.5 * keep.texts))] : [make('p', {}, 'No criteria are named.')];
    return part('Criteria and their sources', ...named, ...bullets(A.reasons.map((r) => sourced(r, keep.texts)), keep.reasons, 4 * keep.texts, 'reasons'));
  }
  // What flows in two columns.
  function notes(keep) {
    const listed = (title, texts, kept, what, none) => part(title, ...(texts.length ? bullets(texts, kept, keep.texts, what) : [make('p', {}, none)]));
    const assumed = listed('Assumptions', A.assumptions, keep.assumptions, 'assumptions', A.given ? 'None are stated.' : 'Loads act so slowly that nothing vibrates.');
    if (!A.given) return [assumed];
    return [totals(keep), listed('What the decision hangs on', A.hangs, keep.hangs, 'values', 'Not examined.'), assumed, listed('Tests', A.tests, keep.tests, 'tests', 'No tests are named.'),
      listed('What the planar models do not know', A.unknown.flatMap((u) => u.list), keep.unknown, 'things', 'Not stated.')];
  }
  const signature = (who) => make('div', {}, make('p', { class: 'who' }, who), make('p', {}, 'Name'), make('p', {}, 'Date'), make('p', {}, 'Place'), make('p', { class: 'long' }, 'Signature'));
  function proofs(keep) {
    return A.statics.slice(0, 2).map((p) => {
      const shown = { ...p, cases: A.list(p.cases).slice(0, keep.cases).map((c) => ({ ...c, name: short(c.name, keep.texts), first: short(c.first || '–', keep.texts), why: short(c.why || '', keep.texts), remarks: [] })) };
      const picture = keep.polar && !A.given && A.statics.length === 1 ? steplap.statics.polar(p) : null;
      const line = make('p', {}, `${short(p.model, keep.texts)}: ${A.outcomes[p.verdict] || p.verdict}. ${short(p.reason || '', keep.texts)} ${short(steplap.statics.weakestText(p), keep.texts + 60)}`);
      return part(`Static proof, ${short(p.preset || '', keep.texts)}${p.source ? `: ${short(p.source, keep.texts)}` : ''}`, line, ...(A.given ? [] : [steplap.statics.cases(shown), ...rest(A.list(p.cases).length, keep.cases, 'cases'), ...(picture ? [picture.svg] : [])]));
    });
  }
  function fill(keep) {
    const { given } = A, limit = keep.texts, decision = given ? given.decision : A.statics[0].verdict;
    const records = A.records.map((r) => `${short(r.file, limit)} (SHA-256 ${String(r.sha256 || 'unknown').slice(0, 16)}…)`), models = (A.models.length ? A.models : A.statics.map((p) => ({ name: `${p.model} (${p.file || 'file not named'}, SHA-256 ${String(p.sha256 || 'unknown').slice(0, 16)}…)` }))).map((m) => `${short(m.name, limit)}${m.recorder ? `, recorder at ${short(m.recorder.marker, limit)}` : ''}`);
    place.style.fontSize = `${keep.size}pt`;
    place.replaceChildren(make('h1', {}, given ? 'Assessment of a transport' : 'Static proof'),
      make('p', {}, [records.length ? `Records: ${records.slice(0, keep.records).join('; ')}${records.length > keep.records ? ` and ${records.length - keep.records} more` : ''}.` : '', models.length ? ` Models: ${models.slice(0, 4).join('; ')}.` : '', ` Made by ${A.program}.`].join('')),
      make('div', { class: 'verdict-line' }, make('span', { class: `badge ${A.words[decision] ? decision : 'open'}` }, A.words[decision] || 'OPEN'), make('span', { class: 'reason' }, short((given ? given.reason : A.statics[0].reason) || '', Math.max(80, limit)))),
      ...A.contradictions().slice(0, 1).map((t) => make('p', {}, `Look at this: ${short(t, limit)}`)),
      ...(given ? [papers(keep), events(keep)] : []), ...proofs(keep), make('div', { class: 'flow' }, ...notes(keep)),
      ...(given ? [criteria(keep), found()] : []), make('div', { class: 'signatures' }, signature('For the receiver'), signature('For the carrier')));
    for (const t of place.querySelectorAll('table')) t.classList.remove('cards'); // paper is no telephone, also when printed from one
  }
  // Between the margins of page.css 297 - 2 * 12 mm are free; three of them stay so, because paper rounds otherwise than the screen.
  function fit() {
    const free = 270;
    let keep = { ...most };
    place.classList.add('measured');
    const height = () => (186 * place.getBoundingClientRect().height) / place.getBoundingClientRect().width;
    const isFitting = () => { fill(keep); return height() <= free; };
    const cutBy = (count) => ({ ...most, ...Object.fromEntries(cuts.slice(0, count)) }); // the last of a name counts
    // The fewest cuts that suffice.
    let few = 0, many = cuts.length;
    while (few < many) {
      const middle = (few + many) >> 1;
      keep = cutBy(middle);
      if (isFitting()) many = middle; else few = middle + 1;
    }
    keep = cutBy(few);
    const undone = cuts.slice(0, few).map(([what], i) => [what, cutBy(i)[what]]);
    // What was cut without need comes back, the last first; events before all else.
    undone.reverse();
    for (const [what, before] of [...undone.filter(([what]) => what === 'events'), ...undone.filter(([what]) => what !== 'events')]) {
      const now = keep[what];
      keep[what] = before;
      if (!isFitting()) keep[what] = now;
    }
    fill(keep);
    place.dataset.height = height().toFixed(1);
    place.classList.remove('measured');
    return keep;
  }
  return { fit, most };
})();
