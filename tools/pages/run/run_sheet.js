// The sheet of a run: the machine when a limit is nearest, load case, limits with sources and utilisation, events.
steplap.runSheet = (run) => {
  const make = steplap.make, { table } = steplap.tables, { one, percent, instant, isKnown } = steplap.numbers, q = steplap.quantities;
  const { part, rest, list, named, drawing, smaller } = steplap.sheet, overview = steplap.overview.of(run), { model } = run.summary;
  const usual = 8.5; // usual font size, pt

  // Returns the utilisation that belongs to a criterion: the one with the same value and limit. A criterion names an element or a channel.
  const usedBy = (c) => overview.utilisations.find(
    (u) => u.is_judged && u.value === c.value && u.limit === c.limit && (u.channel === c.where || u.channel.startsWith(`${c.where}.`)));
  const words = (c) => (c.outcome === 'met' ? 'met' : c.outcome === 'open' ? 'open' : `not met: ${c.outcome}`);
  function limitRow({ c, used }) {
    const value = one(c.value, c.unit, { error: c.error, limit: c.limit }), error = isKnown(c.error) ? one(c.error, c.unit) : 'not known';
    return [
      c.name, c.asked, c.reason || 'not stated', value, error, one(c.limit, c.unit), used ? percent(used.share, used.error) : '–',
      isKnown(c.at) ? instant(c.at, run.run_end, c.atError) : '–', { text: words(c), class: c.outcome === 'met' ? 'met' : 'beyond' }
    ];
  }
  function limits() {
    const share = ({ used }) => used?.share ?? Infinity;
    const rows = q.criteria(run).map((c) => ({ c, used: usedBy(c) })).sort((a, b) => share(b) - share(a));
    if (!rows.length) return [make('p', {}, 'The model states no criteria: nothing was judged.')];
    const heads = ['limit', 'asked', 'source that the model gives', 'governing value', 'its error', 'limit', 'used', 'at', 'result'];
    return [make('div', { id: 'limits' }, table(heads, rows.map(limitRow), [3, 4, 5, 6, 7]))];
  }
  const length = one(run.run_end, 's'), duration = run.summary.completed ? length : `stopped at ${length}: ${run.summary.failure || ''}`;
  const rows = [...run.load_case, ...model.overrides.map((text) => ['changed by', text]), ['duration', duration]];
  const loads = part('Load case', make('div', { id: 'loads' }, table(null, rows)), make('p', {}, 'Numbers without a unit are SI.'));
  const pictured = `The machine at ${instant(run.end, run.run_end)}${isKnown(overview.worst_instant) ? ', where a limit is nearest' : ''}`;
  const machine = part(pictured, drawing(run, run.end, 2));
  const { judgement, findings = [] } = run.summary, warnings = findings.filter((f) => f.level === 'warning').map((f) => f.text);
  const doubts = [...(overview.trust ? [overview.trust.text] : []), ...(judgement ? judgement.capped_by : []), ...warnings];
  const badge = steplap.overview.badgeOf(run), word = badge.name === 'none' ? '' : badge.word; // without criteria there is no verdict
  function story(kept) {
    if (!overview.story.length) return [make('p', {}, 'Nothing slipped, lifted, opened or broke.')];
    return [list(overview.story.slice(0, kept).map((entry) => entry.text)), ...rest(overview.story.length, kept, 'happenings')];
  }
  const inputs = model.inputs.map((file) => named(file.file, file.sha256));
  const digests = [...inputs, named('effective model.toml', run.model_sha256)].join('; ');
  const { name, version } = run.summary.program;
  const contentOf = (keep) => ({
    title: `Run: ${model.title || run.name}`,
    about: `${digests}. Made by ${name} ${version}.`,
    word,
    verdict: badge.name,
    reason: overview.reason,
    parts: [
      make('div', { class: 'beside' }, machine, loads), part('Limits', ...limits()),
      make('div', { class: 'flow' }, part('Numerical error', list(doubts)), part('What happened', ...story(keep.story)),
        ...(run.summary.left_out ? [part('Not in the model', list(run.summary.left_out))] : []))
    ],
    signed: ['Prepared by', 'Approved by']
  });
  return { contentOf, room: { most: { size: usual, story: 12 }, cuts: [...smaller(usual, 7), ['story', 6], ...smaller(7, 4.5)] } };
};
