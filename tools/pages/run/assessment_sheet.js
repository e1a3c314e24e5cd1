// The sheet of an assessment: shipping data, decision, worst events, dependence of the decision, assumptions, criteria, findings on
// arrival. The sheet of a static proof: drawing, load cases, reactions of each part. Lines that do not fit are counted and are on the
// following sheets.
steplap.assessmentSheet = () => {
  const make = steplap.make, { table } = steplap.tables, { one, percent, isKnown } = steplap.numbers, A = steplap.assessment;
  const { short, part, rest, bullets, orBlank, named, drawing } = steplap.sheet;
  const most = {
    size: 8,
    texts: 2000,
    events: 14,
    joints: 10,
    reasons: 8,
    hangs: 6,
    tests: 10,
    assumptions: 14,
    unknown: 8,
    records: 6,
    cases: 12,
    machine: 1,
    polar: 1,
    reactions: 40
  };
  const cuts = [
    ['texts', 600], ['size', 7.5], ['assumptions', 9], ['events', 10], ['joints', 7], ['texts', 300], ['records', 3], ['tests', 6],
    ['unknown', 5], ['events', 8], ['reasons', 5], ['hangs', 4], ['cases', 9], ['size', 7], ['texts', 200], ['assumptions', 6],
    ['joints', 5], ['events', 6], ['machine', 0], ['texts', 140], ['tests', 4], ['unknown', 3], ['hangs', 3], ['assumptions', 4],
    ['texts', 100], ['reactions', 25], ['events', 5], ['records', 2], ['reasons', 3], ['joints', 3], ['polar', 0], ['cases', 6],
    ['texts', 70], ['events', 4], ['reactions', 12], ['assumptions', 3], ['tests', 3], ['unknown', 2], ['hangs', 2], ['texts', 45],
    ['reasons', 2], ['joints', 2], ['events', 3], ['tests', 2], ['assumptions', 2], ['reactions', 6], ['texts', 30], ['cases', 4]
  ];

  let still; // drawn once, because drawing is slow and the sheet is laid out a dozen times
  const worstMachine = () => (still = still === undefined ? steplap.eventMachine.of(A.worst[0], 3) : still);
  const joined = (parts) => parts.flatMap((p, i) => (i ? [' · ', ...p] : p));
  function papers(keep) {
    const p = A.papers, limit = Math.min(keep.texts, 140), shown = p.recorders.slice(0, keep.records);
    const fields =
      (r) => [['serial number', r.serial], ['calibrated', r.calibrated], ['range', r.range], ['filter', r.filter], ['mounted', r.place]];
    const recorder = (r) => make('span', {}, ...joined(fields(r).map(([label, value]) => [`${label} `, orBlank(value, limit)])));
    const handovers = p.handovers.slice(0, keep.records).flatMap((h) => [` · handover ${short(h.place, limit)}, ${short(h.time, limit)}`]);
    const share = A.coveredShare === null || A.coveredShare === undefined ? '' : ` Of the journey ${percent(A.coveredShare)} are covered.`;
    const rows = [
      ['Transformer', make('span', {}, 'serial number ', orBlank(p.transformer, limit))],
      ...shown.map((r) => [`Recorder${r.record ? ` of ${short(r.record, 30)}` : ''}`, recorder(r)]),
      ['Journey', make('span', {}, 'departure ', orBlank(p.departure, limit), ...handovers, ' · arrival ', orBlank(p.arrival, limit))],
      ['Recorded', `${short(A.covered || 'Not stated.', limit)}${A.journey ? ` Asked: ${short(A.journey, limit)}.` : ''}${share}`],
      ...A.recorders.map((r, i) => [`${i ? 'Second' : 'First'} recorder alone`, short(`${A.recorderText(r)}: ${r.reason}`, 1.5 * limit)])
    ];
    const curve = A.worst.length ? steplap.events.curve(A.worst[0]) : null, still = keep.machine && A.worst.length ? worstMachine() : null;
    const left = [
      table(null, rows), ...rest(p.recorders.length, shown.length, 'recorders'),
      ...rest(p.handovers.length, Math.min(p.handovers.length, keep.records), 'handovers')
    ];
    const pictures = [...(still ? [still.picture] : []), ...(curve ? [curve] : [])];
    return make('div', { class: `papers pictures-${pictures.length}` }, make('div', {}, ...left), ...pictures);
  }
  // Returns a line to be filled in by hand by the receiver.
  const blank = (what) => make('p', {}, `${what} `, make('span', { class: 'blank' }));
  const found = () => part('Found on arrival',
    make('div', { class: 'found' },
      ...['Dew point of the gas', 'Pressure of the gas', 'Resistance core to earth', 'Visible damage'].map(blank)));

  const peaks = (e, limit) => short(e.peaks.map((p) => A.peakText(p, true)).join('; ') || '–', Math.max(60, limit));
  function eventRow(e, m, k, limit) {
    const common = [String(e.number), k ? '' : short(A.timeText(e), limit), k ? '' : peaks(e, limit)];
    if (!m) return [...common, '–', 'not run', '–', '–', '–', '–'];
    const verdict = { text: A.outcomes[m.verdict] || short(m.verdict, 20), class: m.verdict in A.outcomes ? m.verdict : 'open' };
    return [
      ...common, short(m.model, limit), verdict, short(m.joints.length ? A.slipText(m) : '–', limit), A.marginText(m), A.slidText(m.slid),
      A.chanceText(m.probability)
    ];
  }
  function events(keep) {
    const rows = A.worst.slice(0, keep.events).flatMap((e) => (e.models.length ? e.models : [
      null
    ]).slice(0, 2).map((m, k) => eventRow(e, m, k, keep.texts)));
    const heads = ['no.', 'time', 'peaks, with bandwidth', 'model', 'verdict', 'joints', 'margin', 'slid', 'probability of slip'];
    const box = table(heads, rows, [6, 7]);
    box.firstChild.classList.add('worst-table');
    return part(A.events.length > keep.events ? `The worst of ${A.events.length} events` : 'Events, the worst first',
      ...(rows.length ? [box] : [make('p', {}, 'No event was recorded.')]), ...rest(A.events.length, keep.events, 'events'));
  }
  function totals(keep) {
    const sorted = [...A.totals].sort((a, b) => (b.slid_total || 0) - (a.slid_total || 0)), limit = Math.min(40, keep.texts);
    const row =
      (j) => [short(j.name, limit), short(j.model || '', limit), A.slidText(j.slid_total), String(j.slips ?? '–'), percent(j.overlap_left)];
    const rows = sorted.slice(0, keep.joints).map(row), damage = A.voyage.damage_probability;
    const box = table(['joint', 'model', 'slid in all', 'slips', 'overlap left'], rows, [2, 3, 4]);
    return part('Joints over the voyage', rows.length ? box : make('p', {}, 'No joints were judged.'),
      ...rest(sorted.length, keep.joints, 'joints'),
      ...(damage ? [make('p', {}, `Probability of damage in the voyage: ${A.chanceText(damage)}.`)] : []));
  }
  function sourced(r, limit) {
    const criterion = r.criterion ? `${short(r.criterion, limit)}: ` : '', source = r.source ? ` (${short(r.source, limit)})` : '';
    return `${criterion}${A.outcomes[r.outcome] || r.outcome || ''}. ${short(r.text || '', limit)}${source}`;
  }
  function criteria(keep) {
    const c = A.criteria, texts = c ? [c.name, c.file, c.text, c.source ? `source: ${c.source}` : ''].filter((t) => t).join(' · ') : '';
    return part('Criteria and their sources', make('p', {}, c ? short(texts, 1.5 * keep.texts) : 'No criteria are named.'),
      ...bullets(A.reasons.map((r) => sourced(r, keep.texts)), keep.reasons, 4 * keep.texts, 'reasons'));
  }
  // Returns the parts that flow in two columns.
  function notes(keep) {
    const listed = (title, texts, kept, what, none) =>
      part(title, ...(texts.length ? bullets(texts, kept, keep.texts, what) : [make('p', {}, none)]));
    const none = A.given ? 'None are stated.' : 'Loads act so slowly that nothing vibrates.';
    const assumed = listed('Assumptions', A.assumptions, keep.assumptions, 'assumptions', none);
    if (!A.given) return [assumed];
    const unknown = A.unknown.flatMap((u) => u.list);
    return [
      totals(keep), listed('What the decision depends on', A.hangs, keep.hangs, 'values', 'Not examined.'), assumed,
      listed('Tests', A.tests, keep.tests, 'tests', 'No tests are named.'),
      listed('What the planar models do not know', unknown, keep.unknown, 'things', 'Not stated.')
    ];
  }

  // --- static proofs ---------------------------------------------------------------------------------
  // Returns a table of the forces and couples of each part in each case, the highest utilisation first.
  const isReaction = (r) => r.unit === 'N' || r.unit === 'N m';
  function reactions(p, keep) {
    const cases = A.list(p.cases), rows = new Map();
    cases.forEach((c, k) => A.list(c.reactions).filter(isReaction).forEach((r) => {
      if (!rows.has(r.name)) rows.set(r.name, { name: r.name, unit: r.unit, values: cases.map(() => null), allowed: null, share: null });
      const row = rows.get(r.name);
      row.values[k] = r.value;
      if (isKnown(r.allowed)) row.allowed = r.allowed;
      if (isKnown(r.share)) row.share = Math.max(row.share ?? 0, r.share);
    }));
    const sorted = [...rows.values()].sort((a, b) => (b.share ?? -1) - (a.share ?? -1));
    if (!sorted.length) return [];
    const rounding =
      // smaller values are rounding errors of the equilibrium
      1e-9 * Math.max(...sorted.flatMap((r) => r.values.filter(isKnown).map(Math.abs)));
    const allowed = (r) => (isKnown(r.allowed) ? one(r.allowed, r.unit) : 'not limited');
    const cells = (r) => [...r.values.map((v) => one(v, r.unit, { rounding })), allowed(r), percent(r.share)];
    const heads = ['part', ...cases.map((c) => short(c.name, 24)), 'allowed', 'used'];
    const box = table(heads, sorted.slice(0, keep.reactions).map((r) => [r.name, ...cells(r)]), heads.map((_, k) => k).slice(1));
    return [make('div', { class: 'reactions' }, box), ...rest(sorted.length, keep.reactions, 'reactions')];
  }
  const stills = new Map();
  function machine(p) {
    if (!p.drawing) return null;
    if (!stills.has(p)) stills.set(p, drawing(steplap.data.still(p.model, p.drawing), 0, 2));
    return stills.get(p);
  }
  function proof(p, keep) {
    const isAlone = !A.given && A.statics.length === 1, polar = keep.polar && isAlone ? steplap.statics.polar(p) : null;
    const text = (words) => short(words || '', keep.texts);
    const shorter = (c) => ({...c, name: text(c.name), first: text(c.first || '–'), why: text(c.why), remarks: [] });
    const shown = {...p, cases: A.list(p.cases).slice(0, keep.cases).map(shorter) };
    const weakest = short(steplap.statics.weakestText(p), keep.texts + 60);
    const line = make('p', {}, `${text(p.model)}: ${A.outcomes[p.verdict] || p.verdict}. ${text(p.reason)} ${weakest}`);
    const pictures = [isAlone ? machine(p) : null, polar ? polar.svg : null].filter((picture) => picture);
    const details = A.given ? [] : [
      ...(pictures.length ? [make('div', { class: 'beside' }, ...pictures)] : []), steplap.statics.cases(shown),
      ...rest(A.list(p.cases).length, keep.cases, 'cases')
    ];
    const forces = A.given ? [] : reactions(p, keep);
    return [
      part(`Static proof, ${text(p.preset)}${p.source ? `: ${text(p.source)}` : ''}`, line, ...details),
      ...(forces.length ? [part('Reactions of each part', ...forces)] : [])
    ];
  }

  function about(keep) {
    const limit = keep.texts, records = A.records.map((r) => named(short(r.file, limit), r.sha256));
    const of = (m) => `${short(m.name, limit)}${m.recorder ? `, recorder at ${short(m.recorder.marker, limit)}` : ''}`;
    const proven = (p) => `${short(p.model, limit)}, ${named(p.file || 'file not named', p.sha256)}`;
    const models = A.models.length ? A.models.map(of) : A.statics.map(proven), more = records.length - keep.records;
    const recorded = records.length ? `Records: ${records.slice(0, keep.records).join('; ')}${more > 0 ? ` and ${more} more` : ''}. ` : '';
    return `${recorded}${models.length ? `Models: ${models.slice(0, 4).join('; ')}. ` : ''}Made by ${A.program}.`;
  }
  function contentOf(keep) {
    const { verdict, reason } = A.answer(), limit = keep.texts;
    const odd = A.contradictions().slice(0, 1).map((t) => make('p', {}, `Look at this: ${short(t, limit)}`));
    return {
      title: A.given ? 'Assessment of a transport' : 'Static proof',
      about: about(keep),
      word: A.words[verdict] || 'OPEN',
      verdict: A.words[verdict] ? verdict : 'open',
      reason: short(reason, Math.max(80, limit)),
      parts: [
        ...odd, ...(A.given ? [papers(keep), events(keep)] : []), ...A.statics.slice(0, 2).flatMap((p) => proof(p, keep)),
        make('div', { class: 'flow' }, ...notes(keep)), ...(A.given ? [criteria(keep), found()] : [])
      ],
      signed: A.given ? ['For the receiver', 'For the carrier'] : ['Prepared by', 'Approved by']
    };
  }
  return { contentOf, room: { most, cuts, dear: 'events' } };
};
