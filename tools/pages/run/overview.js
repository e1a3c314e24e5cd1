// Contents of the first screen, as given in the summary. For results of earlier versions without overview only events and judgement are
// shown, with a note: nothing is judged here.
steplap.overview = (() => {
  const sentences = {
    hold: 'All criteria of the model are met.',
    inspect: 'At least one criterion asks for an inspection.',
    reject: 'At least one criterion rejects the machine.',
    open: 'Not every criterion could be judged.' };
  const words = { hold: 'HOLD', inspect: 'INSPECT', reject: 'REJECT', open: 'OPEN' };

  function trustOf(summary, distrust) {
    if (distrust) return { level: 'none', text: `Not to be trusted: ${distrust}.` };
    return summary.global_error ? { level: 'good', text: 'Errors are estimated by a finer run.' }
      : { level: 'limited', text: `Errors are not estimated: ${summary.error_not_estimated || 'nobody asked for it'}.` };
  }
  function reasonOf(summary, judgement) {
    const broken = summary.completed ? '' : ' The run broke off before its end.';
    if (!judgement) return `The model states no criteria.${broken}`;
    return (judgement.criteria.length ? sentences[judgement.verdict] : 'The model states no criteria.') + broken;
  }
  function withoutOverview(run) {
    const judgement = run.summary.judgement;
    const moved = run.events.filter((e) => ['slip', 'apart', 'break'].includes(e[4])).map((e) => e[1]);
    return { isOld: true, verdict: judgement ? judgement.verdict : null, reason: reasonOf(run.summary, judgement), trust: trustOf(run.summary, judgement && judgement.distrust),
      worst_instant: null, story: [], utilisations: [], moved: [...new Set(moved)] };
  }
  const found = new WeakMap();
  function of(run) {
    if (!found.has(run)) {
      const given = run.summary.overview;
      found.set(run, given ? { story: [], utilisations: [], moved: [], worst_instant: null, ...given, isOld: false } : withoutOverview(run));
    }
    return found.get(run);
  }
  // Returns { word, name }: the text of the badge and its style class.
  function badgeOf(run) {
    const { verdict, is_judged: isJudged } = of(run);
    if (isJudged !== false && verdict in words) return { word: words[verdict], name: verdict };
    return { word: isJudged !== false && verdict ? String(verdict).toUpperCase() : 'NO CRITERIA', name: 'none' };
  }
  // Returns the worst instant of the run that is nearest to or farthest beyond its limits; null if none has one.
  function worstOf(runs) {
    const shareOf = (o) => { const u = o.utilisations.find((each) => each.is_judged) || o.utilisations[0]; return u ? u.share ?? Infinity : 0; };
    const known = runs.map(of).filter((o) => o.worst_instant !== null && o.worst_instant !== undefined);
    return known.length ? known.reduce((a, b) => (shareOf(b) > shareOf(a) ? b : a)).worst_instant : null;
  }
  // Rounds up to 1, 1.5, 2, 2.5, 3, 4, 5, 6 or 8 times a power of ten, for ends of time axes.
  function nice(t) {
    const power = 10 ** Math.floor(Math.log10(t));
    return Number((power * [1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10].find((k) => k * power >= 0.999999 * t)).toPrecision(3));
  }
  // Returns the end of the time axis: shortly after the last event and worst instant if most of the run follows them, otherwise the end of
  // the runs.
  function horizonOf(runs) {
    const isCounted = (e) => e[0] > 0 && steplap.signs.has(e[4]);
    const end = Math.max(...runs.map((run) => run.end)), events = runs.flatMap((run) => run.events.filter(isCounted).map((e) => e[0]));
    if (!events.length || runs.some((run) => run.events_left_out)) return end;
    const last = nice(1.08 * Math.max(...events, ...runs.map((run) => of(run).worst_instant ?? 0)));
    return last < 0.6 * end ? last : end;
  }
  return { of, badgeOf, worstOf, horizonOf };
})();
