// Results of a run as named numbers: criteria, step-lap joints, friction, forces. Used by the tables of single runs and of comparisons.
steplap.quantities = (() => {
  const { isKnown, full } = steplap.numbers;
  const kinds = [
    [/contact/, 'contacts'], [/^spring/, 'springs'], [/^bushing$/, 'bushings'], [/^limit$/, 'stops'], [/^rope|wound/, 'ropes'],
    [/^distance|^rod/, 'rods'], [/^tie$/, 'ties'], [/^motor$/, 'motors'], [/^prescribed/, 'drives'], [/^load$/, 'loads'],
    [/^gear/, 'gears'], [/joint|revolute|prismatic|weld|pin/, 'joints'], [/stick|friction/, 'friction']
  ];
  const groupOf = (kind) => (kinds.find(([pattern]) => pattern.test(kind)) || [0, 'other elements'])[1];
  const extreme = (run, name) => run.summary.extremes[name];
  const larger = (e) => (Math.abs(e.min) > Math.abs(e.max) ? 'min' : 'max');

  // Returns a number of the summary with its error and all digits. `t`: key of the time at which it occurred.
  function number(entry, key, unit, t) {
    return {
      value: entry[key],
      error: entry[`error_${key}`],
      unit,
      full: full(entry[key], unit, entry[`text_${key}`]),
      at: t && isKnown(entry[t]) ? entry[t] : null,
      atError: t ? entry[`error_${t}`] : null,
      atFull: t ? full(entry[t], 's', entry[`text_${t}`]) : ''
    };
  }
  const largest = (run, channel) => {
    const e = extreme(run, channel), key = larger(e);
    return number(e, key, e.unit, `t_${key}`);
  };

  const outcome = (c) => (c.is_met === null ? 'open' : c.is_met ? 'met' : c.consequence);
  function criteria(run) {
    const list = (run.summary.judgement || { criteria: [] }).criteria;
    return list.map((c) => ({
      name: c.name,
      asked: c.criterion.replace(/<=/g, '≤').replace(/>=/g, '≥').replace(/\^2/g, '²').replace(/\^3/g, '³'),
      reason: c.reason,
      doubt: c.doubt,
      outcome: outcome(c),
      where: c.where,
      limit: c.limit,
      ...number({...c, error_value: c.error }, 'value', c.unit, 't')
    }));
  }
  // Returns the limits of each channel from criteria and utilisations: name -> [{ limit, isBoth }].
  function limitsOf(run) {
    const found = new Map();
    const add = (name, limit, isBoth) => {
      if (!name || !run.channel(name)) return;
      if (!found.has(name)) found.set(name, []);
      if (isKnown(limit) && !found.get(name).some((l) => Math.abs(l.limit - limit) <= 1e-9 * Math.abs(limit)))
        found.get(name).push({ limit, isBoth });
    };
    for (const c of criteria(run)) add(c.where, c.limit, c.asked.includes('|'));
    for (const u of steplap.overview.of(run).utilisations) {
      const channel = run.channel(u.channel);
      add(u.channel, channel && channel.unit === (u.unit || '') ? u.limit : null, false);
    }
    return found;
  }

  function joints(run) {
    return Object.entries(run.summary.joints || {}).map(([name, j]) => ({
      name,
      verdict: j.verdict,
      class: { hold: 'met', reject: 'reject' }[j.outcome] || 'inspect',
      raw: j,
      figures: [
        ['first slip', number(j, 'first_slip', 's')], ['margin', number(j, 'smallest_margin', '')],
        ['needs', number(j, 'largest_required_pressure', 'Pa')], ['dx', number(j, 'slid_x', 'm')], ['dy', number(j, 'slid_y', 'm')],
        ['turn', number(j, 'slid_angle', 'rad')], ['area lost', number(j, 'area_lost', 'm^2')]
      ]
    }));
  }
  function friction(run) {
    return run.drawing.elements.filter((e) => e.kind === 'coulomb_stick' && extreme(run, `${e.name}.slide`)).map((e) => {
      const slips = run.events.filter((v) => v[1] === e.name && v[4] === 'slip').length;
      return { name: e.name, slips, slide: largest(run, `${e.name}.slide`), left: number(extreme(run, `${e.name}.slide`), 'final', 'm') };
    });
  }
  // Returns the largest force or couple of each element that transmits one.
  function forces(run) {
    const limits = limitsOf(run), found = [];
    for (const e of run.drawing.elements)
      for (const ending of ['force', 'tension', 'couple', 'reaction']) {
        const channel = `${e.name}.${ending}`;
        if (!extreme(run, channel) || e.kind === 'coulomb_stick' || steplap.numbers.isRounding(run, channel)) continue;
        const own = limits.get(channel), opens = run.events.filter((v) => v[1] === e.name && v[4] === 'open');
        found.push({
          name: e.name,
          kind: groupOf(e.kind),
          channel,
          limit: own && own.length ? own[0].limit : null,
          opens,
          ...largest(run, channel)
        });
      }
    return found;
  }
  // Returns a heading that names the kinds of elements in the list: "Forces of contacts, springs and joints".
  function headingOf(list) {
    const names = steplap.data.unique([list.map((f) => f.kind)]);
    const what = list.every((f) => f.unit === 'N m') ? 'Couples' : 'Forces';
    return `${what} of ${names.length > 1 ? `${names.slice(0, -1).join(', ')} and ${names[names.length - 1]}` : names[0]}`;
  }
  return { criteria, limitsOf, joints, friction, forces, headingOf, groupOf, largest, number };
})();
