// Chooses the curves to show: channels limited by criteria that no figure of the model contains, then the model's figures. A model without
// figures gets one figure per kind of channel. Channels with rounding errors only are omitted.
steplap.figures = (() => {
  const { isRounding } = steplap.numbers, q = steplap.quantities;
  const most = 8, mostAsked = 4, mostCurves = 7;
  const unitOf = (run, name) => run.channel(name).unit;
  const endingOf = (name) => name.slice(name.lastIndexOf('.') + 1);

  // Returns true if a channel is constant up to rounding errors. It is then shown only if a criterion limits it.
  function isFlat(run, name) {
    const e = run.summary.extremes[name];
    if (!e || e.min === null || e.max === null) return false;
    return isRounding(run, name) || e.max - e.min <= 1e-9 * Math.max(Math.abs(e.min), Math.abs(e.max));
  }
  const isFlatIn = (runs, name) => runs.every((run) => !run.channel(name) || isFlat(run, name));

  const titles = {
    force: 'Forces',
    tension: 'Tensions',
    couple: 'Couples',
    reaction: 'Reactions',
    friction: 'Friction forces',
    share: 'Shares of what friction holds',
    slide: 'Slides',
    margin: 'Margins of the joints',
    p_req: 'Pressures that the joints need',
    theta: 'Angles',
    x: 'Horizontal positions',
    y: 'Vertical positions',
    ax: 'Horizontal accelerations',
    ay: 'Vertical accelerations',
    gap: 'Gaps',
    slid_share: 'Slid shares of the overlaps'
  };
  // Returns a title; for forces it includes the kind of the element.
  function titleOf(run, name) {
    const ending = endingOf(name), element = run.drawing.elements.find((e) => `${e.name}.${ending}` === name);
    if (!element || !['force', 'couple', 'reaction'].includes(ending)) return titles[ending] || ending.replace(/_/g, ' ');
    return `${titles[ending]} of ${q.groupOf(element.kind)}`;
  }
  // Groups channels with the same title and unit into figures.
  function grouped(runs, names, limit) {
    const groups = new Map();
    for (const name of names) {
      const run = runs.find((r) => r.channel(name)), unit = unitOf(run, name), title = titleOf(run, name), key = `${title}\n${unit}`;
      if (!groups.has(key)) groups.set(key, { title, unit, channels: [] });
      groups.get(key).channels.push(name);
    }
    const count = new Map();
    for (const g of groups.values()) count.set(g.title, (count.get(g.title) || 0) + 1);
    return [...groups.values()].slice(0, limit).map((g) => ({
      name: count.get(g.title) > 1 ? `${g.title}, ${g.unit || 'shares'}` : g.title,
      title: '',
      channels: g.channels.slice(0, mostCurves).map((name) => name.replace(/[*?]/g, '?')),
      bounds: []
    }));
  }
  function automatic(runs) {
    const endings = ['slide', 'friction', 'force', 'couple', 'tension', 'reaction', 'margin', 'p_req', 'theta', 'x', 'y'], names = [];
    for (const ending of endings) {
      const found = steplap.data.unique(runs.map((r) => r.matching([`*.${ending}`]))).filter((name) => !isFlatIn(runs, name));
      // Channels with a large range come first, because a figure shows only some of them.
      const reach = (name) => Math.max(...runs.map((r) => {
        const e = r.summary.extremes[name];
        return e ? e.max - e.min || 0 : 0;
      }));
      names.push(...found.sort((a, b) => reach(b) - reach(a)));
    }
    return grouped(runs, names, most);
  }
  function asked(runs, shown) {
    const names = steplap.data.unique(runs.map((run) => [...q.limitsOf(run).keys()]));
    return grouped(runs, names.filter((name) => !shown.has(name) && !isFlatIn(runs, name)), mostAsked);
  }
  // Returns one figure per plot of the models; without plots, one per kind of channel that varies.
  function of (runs) {
    const own = new Map();
    for (const run of runs)
      for (const plot of run.drawing.plots)
        if (!own.has(plot.name)) own.set(plot.name, plot);
    const given = own.size ? [...own.values()] : [];
    const shown = new Set(runs.flatMap((run) => given.flatMap((plot) => run.matching(plot.channels))));
    const first = asked(runs, shown), names = new Set(first.map((f) => f.name));
    return [...first, ...(given.length ? given : automatic(runs).filter((f) => !names.has(f.name)))];
  }
  return { of, isRounding };
})();
