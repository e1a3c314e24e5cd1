// A static proof: its cases, and for each direction the acceleration at which something first slips, slides or lifts, or equilibrium is
// lost.
steplap.statics = (() => {
  const make = steplap.make, { table } = steplap.tables, { one, percent, isKnown } = steplap.numbers, A = steplap.assessment;
  const kinds = {
    slips: 'a joint slips',
    slides: 'friction on the floor gives way',
    lifts: 'a foot lifts',
    ends: 'there is no equilibrium beyond',
    first: 'something first gives way'
  };

  // Returns, for each kind of limit, the points [angle in degrees, acceleration or null], sorted by angle.
  function limitsOf(proof) {
    const found = new Map(),
          angles = [...A.list(proof.polar)].filter((p) => isKnown(p.angle_deg)).sort((a, b) => a.angle_deg - b.angle_deg);
    const hasKinds = angles.some((p) => A.list(p.limits).length);
    const wanted = hasKinds ? Object.keys(kinds).filter((k) => angles.some((p) => A.list(p.limits).some((l) => l.kind === k))) : ['first'];
    for (const kind of wanted)
      found.set(kind, angles.map((p) => {
        if (!hasKinds) return [p.angle_deg, isKnown(p.acceleration) ? p.acceleration : null];
        const limit =
          A.list(p.limits).filter((l) => l.kind === kind && isKnown(l.acceleration)).sort((a, b) => a.acceleration - b.acceleration)[0];
        return [p.angle_deg, limit ? limit.acceleration : null];
      }));
    return found;
  }
  function niceStep(largest) {
    const rough = largest / 4, power = 10 ** Math.floor(Math.log10(rough));
    return power * [1, 2, 2.5, 5, 10].find((k) => k * power >= rough * 0.999);
  }
  function polar(proof) {
    const limits = limitsOf(proof), values = [...limits.values()].flatMap((l) => l.map((p) => p[1])).filter(isKnown);
    const loads = A.list(proof.cases)
                    .map((c) => ({...c, at: A.list(c.load).length === 2 && c.load.every(Number.isFinite) ? c.load : null }))
                    .filter((c) => c.at);
    if (!values.length) return null;
    // The range of the diagram is 2.5 times the median and includes all loads. Larger values are cut off, because they would compress the
    // others.
    const sorted = [...values].sort((a, b) => a - b), middle = sorted[Math.floor(sorted.length / 2)];
    const reach = 1.05 * Math.max(Math.min(sorted[sorted.length - 1], 2.5 * middle), ...loads.map((c) => Math.hypot(...c.at))),
          step = niceStep(reach);
    const w = 440, h = 400, cx = 220, cy = 200, R = 155,
          at = (angle,
            a) => [cx + (R * a * Math.cos((angle * Math.PI) / 180)) / reach, cy - (R * a * Math.sin((angle * Math.PI) / 180)) / reach];
    const svg = make('svg', {
      viewBox: `0 0 ${w} ${h}`,
      class: 'polar',
      role: 'img',
      'aria-label': `Acceleration at which something gives way, by direction: ${proof.model}`
    });
    const text = (content, x, y, anchor = 'middle') => svg.append(make('text', { x, y, 'text-anchor': anchor }, content));
    for (let a = step; a <= reach * 1.0001; a += step) {
      svg.append(make('circle', { class: 'ring', cx, cy, r: (R * a) / reach }));
      text(one(a, 'm/s^2'), cx + 3, cy - (R * a) / reach - 2, 'start');
    }
    for (let d = 0; d < 180; d += 30) {
      const [x, y] = at(d, reach);
      svg.append(make('line', { class: 'spoke', x1: x, y1: y, x2: 2 * cx - x, y2: 2 * cy - y }));
    }
    text('forward', cx + R + 4, cy + 3, 'start');
    text('back', cx - R - 4, cy + 3, 'end');
    text('up', cx, cy - R - 16);
    text('down', cx, cy + R + 14);
    for (const [kind, points] of limits) {
      let path = '', isDown = false;
      for (const [angle, a] of [...points, points[0]]) {
        if (!isKnown(a) || a > reach) {
          isDown = false;
          continue;
        }
        const [x, y] = at(angle, a);
        path += `${isDown ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`;
        isDown = true;
      }
      svg.append(make('path', { class: `limit-${kind}`, 'data-kind': kind, d: path || 'M0 0' }));
    }
    for (const c of loads) {
      const size = Math.hypot(...c.at), [x, y] = at((Math.atan2(c.at[1], c.at[0]) * 180) / Math.PI, size);
      svg.append(make('circle', { class: `case ${A.outcomes[c.verdict] ? c.verdict : 'open'}`, cx: x, cy: y, r: 4.5 },
        make('title', {}, `${c.name}: ${A.outcomes[c.verdict] || c.verdict}`)));
    }
    const keys = make('ul', { class: 'polar-keys' },
      ...[...limits.keys()].map(
        (kind) => make('li', {},
          make('svg', { viewBox: '0 0 34 8' }, make('path', { class: `limit-${kind}`, d: 'M0 4H34', fill: 'none', 'stroke-width': 2 })),
          kinds[kind])),
      ...(loads.length ? [make('li', {}, 'Dots: the loads of the cases; full where they hold or do not hold, hollow where open.')] : []),
      make('li', {},
        `Directions are those in which everything is pulled besides its weight.${
          isKnown(proof.largest_acceleration) ? ` Where a line is missing, nothing of its kind happens up to ${
                                                  one(proof.largest_acceleration, 'm/s^2')}, or it lies outside the picture.`
                                              : ''}`));
    return { svg, keys };
  }
  const limitText = (reaction) => `${reaction.name} ${percent(reaction.share)}`;
  const squared = (text) => String(text || '').replace(/m\/s\^2/g, 'm/s²');
  function cases(proof) {
    const list = A.list(proof.cases);
    if (!list.length) return make('p', { class: 'note' }, 'No cases were computed.');
    const rows = list.map((c) => {
      const nearest = A.list(c.reactions).filter((r) => isKnown(r.share)).sort((a, b) => b.share - a.share)[0],
            lifted = A.list(c.feet).filter((f) => f.lifts).map((f) => f.name);
      return [
        c.name, `${one(c.ax, 'm/s^2')}, ${one(c.ay, 'm/s^2')}`,
        { text: A.outcomes[c.verdict] || String(c.verdict), class: A.outcomes[c.verdict] ? c.verdict : 'open' },
        { text: A.margin(c), value: c.margin }, squared(c.first) || '–', lifted.join(', ') || '–', nearest ? limitText(nearest) : '–',
        squared([c.why, ...A.list(c.remarks)].filter((t) => t).join(' '))
      ];
    });
    return table(
      [
        'case', 'acceleration with gravity along x, y', 'verdict', 'margin of the joints', 'first to give way', 'feet lifted',
        'highest load of allowed', 'why'
      ],
      rows, [3]);
  }
  const weakest = (proof) => A.list(proof.polar).filter((p) => isKnown(p.acceleration)).sort((a, b) => a.acceleration - b.acceleration)[0];
  function weakestText(proof) {
    const p = weakest(proof);
    return p ? `Weakest direction: ${p.first} at ${A.acceleration(p.acceleration)}, pulled at ${
                 one(p.angle_deg, '')}° from forward, upwards counted positive.`
             : 'Nothing gives way in any direction that was tried.';
  }
  function section(proof) {
    const picture = polar(proof);
    const left = make('div', {},
      make('p', {},
        make('b', { class: proof.verdict in A.outcomes ? proof.verdict : 'open' }, A.outcomes[proof.verdict] || String(proof.verdict)),
        proof.reason ? `: ${proof.reason}` : ''),
      make('p', {}, weakestText(proof)),
      make('p', { class: 'note' }, `${proof.preset || ''}${proof.source ? `. Source: ${proof.source}` : ''}`),
      ...(picture ? [picture.keys] : []));
    return make('div', { class: 'one-proof', 'data-model': String(proof.model) },
      make('h3', {}, `${proof.model}${proof.plane && !String(proof.model).includes(proof.plane) ? `, ${proof.plane}` : ''}`),
      make('div', { class: 'proof' }, left, ...(picture ? [make('div', {}, picture.svg)] : [])), cases(proof));
  }
  return { polar, cases, section, weakestText };
})();
