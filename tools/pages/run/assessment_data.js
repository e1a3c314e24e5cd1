// Reads an assessment in the order in which the page shows it. Missing parts are empty lists.
steplap.assessment = (() => {
  const raw = JSON.parse(document.getElementById('data').textContent);
  const { one, percent, isKnown } = steplap.numbers;
  const given = raw.assessment, list = (value) => (Array.isArray(value) ? value.filter((v) => v !== null && v !== undefined) : []);
  const gravity = 9.80665;
  const words = { energise: 'ENERGISE', inspect: 'INSPECT', return: 'RETURN', open: 'OPEN', hold: 'HOLDS', reject: 'DOES NOT HOLD' };
  const outcomes = { hold: 'holds', reject: 'does not hold', open: 'open', inspect: 'inspect', energise: 'energise', return: 'return' };
  const known = (values) => values.filter((v) => isKnown(v) && isFinite(v));
  const least = (values) => (known(values).length ? Math.min(...known(values)) : null);
  const most = (values) => (known(values).length ? Math.max(...known(values)) : null);

  const verdicts = ['reject', 'inspect', 'open', 'hold'];
  const rankOf = (verdict) => (verdicts.includes(verdict) ? verdicts.indexOf(verdict) : 2);
  // Returns one sentence or more about the result of one model for one event.
  function said(m) {
    const joints = list(m.joints), slipping = joints.filter((j) => j.slips || j.came_apart).map((j) => j.name),
          byMargin = joints.filter((j) => isKnown(j.margin)).sort((a, b) => a.margin - b.margin);
    return {
      ...m,
      joints,
      slipping,
      weakest: byMargin[0] || null,
      margin: byMargin.length ? byMargin[0].margin : null,
      slid: most(joints.map((j) => j.slid)),
      slidTotal: most(joints.map((j) => j.slid_total)),
      overlap: least(joints.map((j) => j.overlap_left)),
      lifted: list(m.feet).filter((f) => f.lifts).map((f) => f.name),
      share: most(list(m.reactions).map((r) => r.share)),
      reactions: list(m.reactions),
      clearances: list(m.clearances),
      findings: list(m.findings),
      feet: list(m.feet),
      probability: m.slip_probability || null
    };
  }
  const events = list(given && given.events).map((e, i) => {
    const models = list(e.models).map(said), peaks = list(e.peaks);
    return {
      ...e,
      number: e.number ?? i + 1,
      models,
      peaks,
      rank: Math.min(3, ...models.map((m) => rankOf(m.verdict))),
      margin: least(models.map((m) => m.margin)),
      chance: most(models.map((m) => (m.probability ? m.probability.value : null))),
      peak: most(peaks.map((p) => Math.abs(p.value)))
    };
  });
  const byNeed = (a, b) => a.rank - b.rank || (b.chance ?? -1) - (a.chance ?? -1) || (a.margin ?? Infinity) - (b.margin ?? Infinity) ||
    (b.peak ?? 0) - (a.peak ?? 0);
  const worst = [...events].sort(byNeed);

  const gravest = ['return', 'inspect', 'open', 'energise'],
        graveness = (r) => (gravest.includes(r.outcome) ? gravest.indexOf(r.outcome) : -1);
  const inG = (value) => `${String(Number((value / gravity).toPrecision(3))).replace('-', '−')}\u00a0g`;
  const acceleration = (value, unit = 'm/s^2') =>
    (isKnown(value) ? `${one(value, unit)}${unit === 'm/s^2' ? ` (${inG(value)})` : ''}` : '–');
  // Returns a peak with the bandwidth at which it was measured.
  const peakText = (p, brief) => `${p.axis}: ${brief && p.unit === 'm/s^2' ? inG(p.value) : acceleration(p.value, p.unit)} up to ${
    isKnown(p.bandwidth) ? one(p.bandwidth, 'Hz')
                         : 'an unknown bandwidth'}${!brief && isKnown(p.velocity_change) ? `, Δv ${one(p.velocity_change, 'm/s')}` : ''}`;
  const chanceText = (p) =>
    (p && isKnown(p.value) ? `${percent(p.value)} (${percent(p.low)} to ${percent(p.high)}${isKnown(p.runs) ? `, ${p.runs} runs` : ''}${
                               p.unknown ? `, ${p.unknown} without a result` : ''})`
                                         : '–');
  const slipText = (m) => (m.slipping.length ? `${m.joints.some((j) => j.came_apart) ? 'comes apart' : 'slips'}: ${m.slipping.join(', ')}`
      : m.joints.length ? 'no joint slips'
                        : 'no joints');
  // Formats a margin. A joint that slips has no error; a joint with hardly any load is shown as "over 1000".
  const margin = (j) => (j.margin > 1000 ? 'over\u00a01000' : one(j.margin, '', j.slips ? {} : { error: j.error, limit: 1 }));
  const marginText = (m) => (m.weakest ? margin(m.weakest) : '–');
  const slidText = (value) => one(value, 'm', { rounding: 1e-9 });
  // The results by one of two recorders, in a line.
  const recorderText = (r) => [outcomes[r.decision] || r.decision, `${r.events} events`,
    ...['x', 'y', 'z'].filter((axis) => isKnown(r.greatest[axis])).map((axis) => `${axis} up to ${inG(r.greatest[axis])}`),
    ...(isKnown(r.least_margin) ? [`least margin ${one(r.least_margin, '')}`] : [])]
                                .join(', ');
  const timeText = (e) => (e.clock ? String(e.clock).replace('T', ' ').replace(/\.0+$/, '') : isKnown(e.time) ? one(e.time, 's') : '–');

  // Returns contradictions within the file. They are shown at the head of the page, because the reader signs it.
  function contradictions() {
    if (!given) return [];
    const found = [];
    const rejected = events.filter((e) => e.rank === 0), open = events.filter((e) => e.models.some((m) => m.verdict === 'open'));
    if (given.decision === 'energise' && rejected.length)
      found.push(`The decision is to energise, although a model does not hold in event ${
        rejected.slice(0, 5).map((e) => e.number).join(', ')}. Look at the criteria.`);
    if (given.decision === 'energise' && open.length)
      found.push(`The decision is to energise, although a model's verdict is open in event ${
        open.slice(0, 5).map((e) => e.number).join(', ')}. Look at the criteria.`);
    for (const e of events)
      for (const m of e.models)
        for (const j of m.joints)
          if (!j.slips && isKnown(j.slid) && j.slid > 1e-9)
            found.push(`Event ${e.number}: joint '${j.name}' slid ${one(j.slid, 'm')}, but is said not to slip.`);
    for (const t of list(given.voyage && given.voyage.joints)) {
      const sums =
              events.flatMap((e) => e.models.filter((m) => m.model === t.model).flatMap((m) => m.joints.filter((j) => j.name === t.name))),
            sum = sums.reduce((s, j) => s + (j.slid || 0), 0);
      if (sums.length && isKnown(t.slid_total) && Math.abs(sum - t.slid_total) > 1e-6 + 1e-3 * Math.abs(sum))
        found.push(
          `Joint '${t.name}' of '${t.model}' slid ${one(t.slid_total, 'm')} in the voyage, but ${one(sum, 'm')} in its events together.`);
    }
    return found.slice(0, 8);
  }
  // Returns the decision, or the worst verdict of the static proofs, with its reason.
  function answer() {
    if (given) return { verdict: given.decision, reason: given.reason || '' };
    const verdict = ['reject', 'open', 'hold'].find((v) => statics.some((s) => s.verdict === v)) || 'open';
    const text = (s) => (statics.length > 1 ? `${s.model}: ` : '') + (s.reason || steplap.statics.weakestText(s));
    return { verdict, reason: statics.map(text).join(' ') };
  }
  // Returns range and bandwidth of the recorder from the record, for fields that the shipping data leaves empty.
  const recorderOf = (record) => ({
    record: record.file,
    range: isKnown(record.sensor_range) ? inG(record.sensor_range) : '',
    filter: isKnown(record.bandwidth) ? `read up to ${one(record.bandwidth, 'Hz')}` : ''
  });
  function papers() {
    const p = (given && given.shipment) || {}, stated = list(p.recorders), read = list(given && given.records).map(recorderOf);
    const filled = (r) => {
      const found = read.find((q) => q.record === r.record) || (read.length === 1 && stated.length === 1 ? read[0] : {});
      return {...r, record: r.record || found.record || '', range: r.range || found.range || '', filter: r.filter || found.filter || '' };
    };
    return {
      transformer: p.transformer || '',
      departure: p.departure || '',
      arrival: p.arrival || '',
      handovers: list(p.handovers),
      recorders: stated.length ? stated.map(filled)
        : read.length          ? read
                               : [{}]
    };
  }
  const statics = raw.static ? list(raw.static.static_proofs || [raw.static]) : [];
  const models = list(given && given.models);
  return {
    papers: papers(),
    covered: (given && given.covered) || '',
    coveredShare: given ? given.covered_share : null,
    journey: (given && given.journey) || '',
    program: raw.program,
    folder: raw.folder,
    given,
    events,
    worst,
    models,
    statics,
    records: list(given && given.records),
    recorders: list(given && given.recorders),
    reasons: list(given && given.reasons).sort((a, b) => graveness(a) - graveness(b)),
    hangs: list(given && given.hangs_on),
    tests: list(given && given.tests),
    assumptions: [...list(given && given.assumptions), ...statics.flatMap((s) => list(s.assumptions))],
    criteria: (given && given.criteria) || null,
    voyage: (given && given.voyage) || {},
    totals: list(given && given.voyage && given.voyage.joints),
    uncertain: models.flatMap((m) => list(m.uncertain).map((u) => ({...u, model: m.name }))),
    unknown: models.map((m) => ({ name: m.name, list: list(m.knows_not) })).filter((m) => m.list.length),
    list,
    rankOf,
    words,
    outcomes,
    acceleration,
    peakText,
    chanceText,
    slipText,
    slidText,
    margin,
    marginText,
    timeText,
    recorderText,
    contradictions,
    answer
  };
})();
