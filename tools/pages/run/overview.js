// Contents of the first screen, taken from the summary; the page judges nothing. Results of earlier versions have no overview: only events
// and judgement are shown, with a note.
steplap.overview = (() => {
  const sentences = {
    hold: 'All criteria of the model are met.',
    inspect: 'At least one criterion asks for an inspection.',
    reject: 'At least one criterion rejects the machine.',
    open: 'Not every criterion could be judged.'
  };
  const words = { hold: 'HOLD', inspect: 'INSPECT', reject: 'REJECT', open: 'OPEN' };

  function trustOf(summary, distrust) {
    if (distrust) return { level: 'none', text: `Not to be trusted: ${distrust}.` };
    return summary.global_error
      ? { level: 'good', text: 'Errors are estimated by a finer run.' }
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
    return {
      isOld: true,
      verdict: judgement ? judgement.verdict : null,
      reason: reasonOf(run.summary, judgement),
      trust: trustOf(run.summary, judgement && judgement.distrust),
      worst_instant: null,
      story: [],
      utilisations: [],
      moved: [...new Set(moved)]
    };
  }
  const found = new WeakMap();
  function of (run) {
    if (!found.has(run)) {
      const given = run.summary.overview;
      found.set(
        run, given ? { story: [], utilisations: [], moved: [], worst_instant: null, ...given, isOld: false } : withoutOverview(run));
    }
    return found.get(run);
  }
  // Returns { word, name } for the badge: its text and its style class.
  function badgeOf(run) {
    const { verdict, is_judged: isJudged } = of(run);
    if (isJudged !== false && verdict in words) return { word: words[verdict], name: verdict };
    return { word: isJudged !== false && verdict ? String(verdict).toUpperCase() : 'NO CRITERIA', name: 'none' };
  }
  // Earlier versions do not mark judged utilisations; they have a limit.
  const isJudged = (u) => u.is_judged ?? (u.limit !== null && u.limit !== undefined);
  // Returns the worst instant of the run with the largest utilisation; null if no run has a worst instant.
  function worstOf(runs) {
    const shareOf = (o) => {
      const u = o.utilisations.find(isJudged) || o.utilisations[0];
      return u ? u.share ?? Infinity : 0;
    };
    const known = runs.map(of).filter((o) => o.worst_instant !== null && o.worst_instant !== undefined);
    return known.length ? known.reduce((a, b) => (shareOf(b) > shareOf(a) ? b : a)).worst_instant : null;
  }
  // Entries of the story have verbs of their own (mbd/run/story.cpp), which are not the words of events.
  const isAbout = (entry, verb) => entry.what === verb;
  // --- instant at which the page opens ---------------------------------------------------------------
  const leaders = ['tips', 'comes apart', 'breaks', 'slips', 'lifts', 'opens']; // order of importance in a run without criteria
  const leastTurn = (3 * Math.PI) / 180; // smallest rotation that is visible as tipping, rad
  // Returns the time of the largest force for a contact that closes; for other entries their begin.
  function pressedAt(run, entry) {
    const force = run.summary.extremes[`${entry.who[0]}.force`];
    return isAbout(entry, 'closes') && force ? force.t_max : entry.from;
  }
  // Returns the time at which a slide is largest or has ended. Afterwards rounding decides where it is largest.
  function endOf(run, entry) {
    const slide = run.summary.extremes[`${entry.who[0]}.slide`], end = entry.to ?? run.end;
    if (slide && slide.max > slide.min) return Math.min(end, slide.max > -slide.min ? slide.t_max : slide.t_min);
    return end;
  }
  // Returns the largest rotation of these bodies up to `until`, rad, and its time.
  function furthestTurn(run, names, until) {
    let best = { t: 0, turn: 0 };
    for (const angle of names.map((name) => run.channel(`${name}.theta`)).filter(Boolean)) {
      const turns = Array.from(angle.times).map((t, i) => (t <= until ? Math.abs(angle.value(i) - angle.value(0)) : 0)),
            turn = Math.max(...turns);
      if (turn > best.turn) best = { t: angle.times[turns.findIndex((v) => v > 0.99 * turn)], turn };
    }
    return best;
  }
  // Returns the time that best shows an entry of the story: the largest rotation of a tipping body; the end of a slide; the largest
  // rotation or gap of a lifting body, before the next contact closes.
  function instantOfEntry(run, entry, story) {
    const placesOf = (name) => (run.drawing.elements.find((e) => e.name === name) || { at: [] }).at;
    const bodies = entry.what === 'tips' ? entry.who
      : entry.what === 'lifts'           ? entry.who.flatMap((name) => placesOf(name).slice(0, 1).map((p) => p.body))
                                         : [];
    const strikes = entry.what === 'lifts' ? story.filter((e) => isAbout(e, 'closes') && e.from > entry.from).map((e) => e.from) : [];
    const { t, turn } = furthestTurn(run, bodies, Math.min(run.end, ...strikes)), gap = run.summary.extremes[`${entry.who[0]}.gap`];
    if (turn > leastTurn) return t;
    return isAbout(entry, 'slips') ? endOf(run, entry) : entry.what === 'lifts' && gap ? gap.t_max : pressedAt(run, entry);
  }
  function largestShift(scene, t) {
    const pose = scene.look(t, scene.seenFrom, scene.magnification);
    return Math.max(0, ...[...scene.bodies.values()].map((body) => scene.shiftOf(body, pose)));
  }
  const isSeenToMove = (scene, t) => largestShift(scene, t) > 0.005 * scene.size;
  // Returns the time of the largest displacement from the start, for runs without entries.
  function furthestInstant(scene) {
    const times = Array.from({ length: 61 }, (_, k) => (scene.run.end * k) / 60), far = times.map((t) => largestShift(scene, t));
    return times[far.indexOf(Math.max(...far))];
  }
  function instantOf(scene) {
    const { run } = scene, { story, reason, worst_instant: worst, utilisations } = of(run);
    const hasCriteria = utilisations.some(isJudged),
          slid = story.find((e) => isAbout(e, 'slips') && e.who.length === 1 && reason.startsWith(`Joint '${e.who[0]}' slips`));
    if (slid) return endOf(run, slid);
    if (hasCriteria && worst !== null) return worst;
    const told = leaders.map((what) => story.find((e) => e.what === what)).find(Boolean) || story[0];
    if (!told) return furthestInstant(scene);
    const t = instantOfEntry(run, told, story), furthest = isSeenToMove(scene, t) ? t : furthestInstant(scene);
    return isSeenToMove(scene, furthest) ? furthest : t;
  }
  // Returns the opening instant for the run that is nearest to its limits. If the motion there was not recorded (machine.js), returns the
  // nearest recorded instant.
  function openingOf(scenes) {
    const worst = worstOf(scenes.map((s) => s.run)),
          first = scenes.find((s) => worst !== null && of(s.run).worst_instant === worst) || scenes[0], wanted = instantOf(first);
    const guessed = scenes.find((scene) => scene.isGuessed(wanted));
    return guessed ? guessed.run.nearestTime(wanted) : wanted;
  }
  // Rounds up to 1, 1.5, 2, 2.5, 3, 4, 5, 6 or 8 times a power of ten, for ends of time axes.
  function nice(t) {
    const power = 10 ** Math.floor(Math.log10(t));
    return Number((power * [1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10].find((k) => k * power >= 0.999999 * t)).toPrecision(3));
  }
  // Returns the end of the time axis: shortly after the last event and worst instant, if most of the run follows them; otherwise the end of
  // the longest run.
  function horizonOf(runs) {
    const isCounted = (e) => e[0] > 0 && steplap.signs.has(e[4]);
    const end = Math.max(...runs.map((run) => run.end)), events = runs.flatMap((run) => run.events.filter(isCounted).map((e) => e[0]));
    if (!events.length || runs.some((run) => run.events_left_out)) return end;
    const last = nice(1.08 * Math.max(...events, ...runs.map((run) => of(run).worst_instant ?? 0)));
    return last < 0.6 * end ? last : end;
  }
  return { of, isAbout, isJudged, badgeOf, worstOf, openingOf, nice, horizonOf };
})();
