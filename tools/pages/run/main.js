// The page of runs: one clock drives picture, timeline and curves. The first screen is built first, the rest after the browser has painted
// it.
(() => {
  const make = steplap.make, runs = steplap.data.runs, at = (id) => document.getElementById(id);
  const end = Math.max(...runs.map((r) => r.end)), isOne = runs.length === 1;
  const worst = steplap.overview.worstOf(runs);
  let t = 0, last = null, plots = null, isUntouched = true, horizon = steplap.overview.horizonOf(runs);
  const scenes = [], insets = [];

  // Runs `action` with the colours of paper, so that saved files are black on white for any theme of the screen.
  steplap.onPaper = (action) => {
    document.documentElement.classList.add('paper');
    try {
      return action();
    } finally {
      document.documentElement.classList.remove('paper');
    }
  };

  function showTitles() {
    const titles = [...new Set(runs.map((r) => r.summary.model.title || r.name))];
    at('title').textContent = titles.length === 1 ? titles[0] : `${titles.length} runs compared`;
    at('subtitle').textContent = titles.length === 1 ? runs.map((r) => r.name).join(', ') : titles.join(' · ');
    at('footer').textContent = `Written by ${
      steplap.data.program}. Plots by dygraphs, © Dan Vanderkam and contributors, MIT licence (text at the end of this file's source).`;
    at('overview').classList.toggle('several', !isOne);
    if (!isOne) at('overview').style.setProperty('--runs', String(runs.length));
  }

  // --- drawing -------------------------------------------------------------------------------------
  function buildScenes() {
    for (const run of runs) {
      const scene = new steplap.Scene(run), { moved, story } = steplap.overview.of(run);
      scene.setMoved(moved, story);
      scenes.push(scene);
    }
    const largestForce = Math.max(...scenes.map((scene) => scene.ownLargestForce()));
    scenes.forEach((scene, i) => {
      const box = make('div', { class: 'scene', 'data-run': runs[i].name });
      if (!isOne) box.append(make('h3', {}, runs[i].name));
      box.append(scene.svg);
      scene.largestForce = largestForce;
      const save = steplap.save.buttons({
        SVG: () => steplap.onPaper(() => steplap.save.svg(scene.svg, runs[i].name)),
        PNG: () => steplap.onPaper(() => steplap.save.png(scene.svg, runs[i].name)),
        Animation: (event) => saveAnimation(scene, event.currentTarget)
      });
      box.append(save);
      at('scenes').append(box);
    });
    const undrawn = Math.max(...runs.map((run) => run.bodies_left_out || 0)), remarks = [];
    if (undrawn) remarks.push(`${undrawn} more bodies, and all elements, are not drawn: the page would be too slow.`);
    if (scenes.some((scene) => [...scene.bodies.values()].some((body) => body.isUnrecorded)))
      remarks.push('Dashed bodies are drawn where they begin: their motion is not among the channels.');
    at('legend').textContent = remarks.join(' ');
    const help = [
      'Wedges and dots are contacts, filled while they press. Arrows are forces, all to one scale. Hatched is what is solid. ' +
        'What slipped, lifted or broke is orange, with the sign that it has in the timeline.',
      'Motion is enlarged relative to what carries a body, by at most 5 % of the machine. Dashed is the start pose.',
      'A blue arrow is the load, hollow while it does not act.',
      'Closer: Ctrl and wheel, two fingers, or + and - on the picture. 0 or a double click shows all. Drag to move.'
    ];
    if (runs.some((run) => run.drawing.sheets.length)) help.splice(1, 0, 'Limbs have an orange edge once their joint has slipped.');
    at('picture-help').append(make('summary', {}, 'How to read the picture'), make('p', { class: 'note' }, help.join(' ')));
  }
  // Saves the motion at the chosen speed as an animation.
  async function saveAnimation(scene, button) {
    const before = t, label = button.textContent;
    setPlaying(false);
    button.disabled = true;
    const tell = (done, all) => { button.textContent = `${Math.round((100 * done) / all)} %`; };
    await steplap.animation.save(scene, scene.run.name, scene.run.end, Number(at('speed').value), tell);
    button.textContent = label;
    button.disabled = false;
    show(before);
  }
  function buildInsets() {
    runs.forEach((run, i) => {
      for (const sheet of steplap.data.corners(run).slice(0, 8)) insets.push(new steplap.Inset(run, scenes[i], sheet));
    });
    at('sheets').hidden = !insets.length;
    for (const run of runs) {
      const own = insets.filter((inset) => inset.run === run), more = run.drawing.sheets.length - own.length;
      if (!own.length) continue;
      at('insets').append(make('div', { class: 'whole-row' }, make('h3', {}, `Sheets at the joints${isOne ? '' : `, ${run.name}`}`),
                            make('p', { class: 'note' },
                              `Yoke sheet orange, limb sheet blue, the overlap that carries dark; true displacements, drawn ${
                                own[0].caption}.${more > 0 ? ` ${more} more kinds of interface are not drawn.` : ''}`)),
        ...own.map((inset) => inset.box));
    }
  }
  const isPrinted = window.matchMedia('print');
  // Returns the height available for the pictures on the first screen. Below a width of 900 pixels the parts are stacked (page.css), and a
  // picture gets half of the screen.
  function tallest() {
    if (window.innerWidth <= 900) return Math.max(220, Math.min(0.5 * window.innerHeight, 700));
    const heightOf = (id) => (at(id).hidden ? 0 : at(id).getBoundingClientRect().height);
    const picture = Math.max(...scenes.map((s) => s.svg.getBoundingClientRect().height)), around = heightOf('machine') - picture;
    const top = at('verdict').getBoundingClientRect().bottom + window.scrollY, gaps = 22;
    const left = window.innerHeight - top - heightOf('timeline') - gaps;
    const height = isOne ? Math.max(left, heightOf('limits') + heightOf('story') + gaps) : left - heightOf('limits');
    return Math.max(250, Math.min(height - around, 900));
  }
  const magnification = () => steplap.magnificationOf(at('magnification'));
  const put = (widths, height) => steplap.Scene.fitAll(scenes, at('seen-from').value, magnification(), widths, height);
  function fit() {
    if (isPrinted.matches) return;
    const widths = scenes.map((s) => Math.max(240, s.svg.parentNode.clientWidth));
    put(widths, 260); // needed to measure the parts around the picture
    timeline.build();
    put(widths, tallest());
  }
  // Sets the width of an A4 sheet for printing, in CSS pixels.
  function fitPaper() {
    const whole = 700;
    put(scenes.map(() => (isOne ? whole : 0.48 * whole)), isOne ? 400 : 280);
    timeline.build(whole);
    show(t);
  }
  function choices() {
    const speeds = [100, 10, 1, 1 / 2, 1 / 5, 1 / 10, 1 / 20, 1 / 50, 1 / 100, 1 / 1000], wanted = horizon / 10;
    for (const s of speeds) at('speed').append(make('option', { value: s }, s >= 1 ? `${s} ×` : `1/${Math.round(1 / s)}`));
    at('speed').value = String(speeds.reduce((best, s) => (Math.abs(Math.log(s / wanted)) < Math.abs(Math.log(best / wanted)) ? s : best)));
    steplap.pictureChoices(scenes, at('magnification'), at('seen-from'));
    steplap.layers.build(at('layers'), at('scenes'));
    const moving = [...scenes[0].bodies.values()].filter((b) => b.moves).map((b) => b.name);
    for (const [value, text] of [['', 'none'], ...(moving.length <= 100 ? [['*', 'all']] : []), ...moving.slice(0, 40).map((n) => [n, n])])
      at('trails').append(make('option', { value }, text));
    at('trails').addEventListener('change', (event) => {
      for (const s of scenes) s.setTrails(event.target.value === '*' ? moving : [event.target.value]);
      show(t);
    });
    for (const id of ['magnification', 'seen-from'])
      at(id).addEventListener('change', () => {
        fit();
        view.reset();
      });
    at('values').addEventListener('change', (event) => {
      for (const s of scenes) s.withValues = event.target.checked;
      show(t);
    });
  }

  // --- time ----------------------------------------------------------------------------------------
  const decimals = Math.max(0, 4 - Math.ceil(Math.log10(end) - 1e-9));
  function show(time) {
    t = Math.min(Math.max(time, 0), end);
    at('now').textContent = `t = ${
      t.toFixed(t > 0 ? Math.max(decimals, Math.min(6, 2 - Math.floor(Math.log10(t))))
                      : decimals)} s`; // at least three digits for short and long runs
    for (const scene of scenes) scene.show(t);
    for (const inset of insets) inset.show(t);
    timeline.show(t);
    if (plots) plots.show(t);
  }
  // Shows the instant that the reader has selected.
  function go(time) {
    isUntouched = false;
    setPlaying(false);
    show(time);
  }
  function setPlaying(isPlaying) {
    at('play').replaceChildren(steplap.icon(isPlaying ? 'pause' : 'play'), isPlaying ? ' Pause' : ' Play');
    at('play').setAttribute('aria-pressed', String(isPlaying));
    last = null;
    // Playing starts from the beginning, also on a new page, which opens at a later instant (overview.js).
    if (isPlaying && (t >= timeline.end || isUntouched)) show(0);
    if (isPlaying) {
      isUntouched = false;
      requestAnimationFrame(frame);
    }
  }
  const isPlaying = () => at('play').getAttribute('aria-pressed') === 'true';
  function frame(now) {
    if (!isPlaying()) return;
    if (last !== null) show(Math.min(timeline.end, t + ((now - last) / 1000) * Number(at('speed').value)));
    last = now;
    if (t >= timeline.end) setPlaying(false);
    else requestAnimationFrame(frame);
  }
  // Sets the end of the time axis: the last main event, or the end of the run.
  function setHorizon(wanted) {
    timeline.end = wanted;
    at('time').max = String(wanted);
    const instant = (time) => `${steplap.data.plain(time, 3)} s`;
    const more = `No event after ${instant(horizon)}; show all ${instant(end)}`;
    at('whole-time').textContent = wanted === end ? `Axis to ${instant(horizon)}` : more;
  }
  function listen() {
    setHorizon(horizon);
    at('whole-time').hidden = horizon === end;
    at('whole-time').addEventListener('click', () => {
      setHorizon(timeline.end === end ? horizon : end);
      timeline.build();
      show(t);
    });
    at('time').addEventListener('input', (event) => go(Number(event.target.value)));
    at('play').addEventListener('click', () => setPlaying(!isPlaying()));
    at('worst').hidden = worst === null;
    at('worst').addEventListener('click', () => go(worst));
    for (const [id, direction, icon] of [['before', -1, 'M4 2H6V14H4ZM14 2V14L6 8Z'], ['after', 1, 'M2 2L10 8L2 14ZM10 2H12V14H10Z']]) {
      at(id).append(make('svg', { viewBox: '0 0 16 16', class: 'icon', 'aria-hidden': 'true' }, make('path', { d: icon })));
      at(id).addEventListener('click', () => go(timeline.beside(t, direction)));
    }
    document.addEventListener('keydown', (event) => {
      const isSlider = event.target === at('time');
      if ((!isSlider && /^(INPUT|SELECT|BUTTON|SUMMARY|TEXTAREA)$/.test(event.target.tagName)) || event.ctrlKey || event.altKey ||
        event.metaKey)
        return;
      const step = (event.shiftKey ? 0.05 : 0.005) * timeline.end;
      const moves = { ArrowRight: t + step, ArrowLeft: t - step, Home: 0, End: timeline.end };
      if (event.key === ' ') setPlaying(!isPlaying());
      else if (event.key in moves) go(moves[event.key]);
      else return;
      event.preventDefault();
    });
    let seen = [document.documentElement.clientWidth, window.innerHeight];
    window.addEventListener('resize', () => {
      const now = [document.documentElement.clientWidth, window.innerHeight];
      // On telephones scrolling changes the height; this needs no redrawing.
      if (isPrinted.matches || (now[0] === seen[0] && (now[1] === seen[1] || now[0] < 900))) return;
      seen = now;
      fit();
      show(t);
    });
  }

  // --- curves, tables --------------------------------------------------------------------------------
  // Shows the curve of a utilisation and the instant at which it is largest.
  function jump(utilisation, run) {
    if (utilisation.at !== null && utilisation.at !== undefined) go(utilisation.at);
    const plot = plots && utilisation.channel ? plots.figureWith(utilisation.channel, run) : null;
    if (!plot) return;
    plots.show(t);
    for (const p of plots.plots) p.box.classList.toggle('chosen', p === plot);
    plot.box.scrollIntoView(
      { block: 'center', behavior: window.matchMedia('(prefers-reduced-motion: reduce)').matches ? 'auto' : 'smooth' });
  }
  // Selects the element whose events are marked on the curves.
  function chooseEvents() {
    const names = steplap.data.unique(runs.map((run) => run.events.filter((e) => steplap.signs.has(e[4])).map((e) => e[1])));
    const elements = names.slice(0, 100).map((name) => [`of ${name}`, name]);
    const choices = [['own', 'those of each figure'], ['all', 'all'], ['none', 'none'], ...elements];
    at('events-of').append(...choices.map(([value, text]) => make('option', { value }, text)));
    at('events-of').addEventListener('change', (event) => {
      plots.eventsOf = event.target.value;
      plots.build();
      show(t);
    });
  }
  function buildPlots() {
    plots = new steplap.Plots(at('plot-grid'), go);
    chooseEvents();
    at('layout-control').hidden = isOne;
    at('layout').addEventListener('change', (event) => {
      plots.layout = event.target.value;
      plots.build();
      show(t);
    });
    at('zoom-out').addEventListener('click', () => plots.zoomOut());
    for (const [value, text] of [
           ['', 'choose a channel'], ...steplap.data.unique(runs.map((r) => [...r.channels.keys()])).map((n) => [n, n])])
      at('add-channel').append(make('option', { value, title: runs.map((r) => r.meaning(value)).find(Boolean) || '' }, text));
    at('add-channel').addEventListener('change', (event) => {
      if (event.target.value) plots.add(event.target.value);
      event.target.value = '';
      show(t);
    });
    const left = runs.reduce((sum, r) => sum + r.channels_left_out, 0), isThinned = runs.some((r) => r.is_thinned);
    if (left || isThinned)
      at('event-key')
        .append(` ${isThinned ? 'Curves are thinned for this page, their peaks are kept.' : ''} ${
          left ? `${left} channels are left out.` : ''} All samples: trajectory.csv.`);
    plots.build();
    at('plots').hidden = !plots.plots.length;
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
      plots.build();
      show(t);
    });
  }
  // Opens the results before printing and closes them afterwards if they were closed.
  function listenToPrint() {
    let opened = [];
    window.addEventListener('beforeprint', () => {
      fitPaper();
      plots.preparePrint();
      opened = [...document.querySelectorAll('#results details')].filter((d) => !d.open);
      for (const d of opened) d.open = true;
    });
    window.addEventListener('afterprint', () => {
      for (const d of opened) d.open = false;
      fit();
      show(t);
    });
  }
  function buildRest() {
    steplap.verdict.buildTrust(runs);
    steplap.results.build(at('results'), runs);
    buildInsets();
    steplap.listings.events(at('events'), runs, go);
    steplap.listings.extremes(at('extremes'), runs);
    steplap.listings.models(at('model'), runs);
    steplap.listings.origin(at('origin'), runs);
    buildPlots();
    listenToPrint();
    show(t);
    Object.assign(steplap.page, { insets, plots });
    document.body.setAttribute('data-ready', 'true');
  }

  showTitles();
  steplap.verdict.build(runs);
  buildScenes();
  choices();
  steplap.bars.build(at('limits'), runs, jump);
  steplap.story.build(at('story'), runs, go);
  const timeline = new steplap.Timeline(runs, horizon,
    { causes: scenes.map((scene) => scene.causes()), lanes: at('lanes'), axis: at('time-axis'), slider: at('time'), onTime: go });
  const view = new steplap.View(scenes, () => show(t));
  for (const [id, action] of [['closer', () => view.zoomAt(scenes[0], 1.5)], ['further', () => view.zoomAt(scenes[0], 1 / 1.5)],
         ['whole', () => view.reset()]]) {
    at(id).append(steplap.icon(id));
    at(id).addEventListener('click', action);
  }
  listen();
  setPlaying(false);
  at('near').hidden = at('limits').hidden && at('story').hidden;
  at('overview').classList.toggle('alone', at('near').hidden);
  fit();
  const opening = steplap.overview.openingOf(scenes);
  for (const scene of scenes) scene.opening = opening;
  if (opening > horizon) {
    horizon = Math.min(end, steplap.overview.nice(opening));
    setHorizon(horizon);
    at('whole-time').hidden = horizon === end;
  }
  fit();
  show(opening);
  steplap.page = { scenes, view, show: go, time: () => t, timeline, shown: performance.now() };
  // Runs after the browser has painted: one frame to paint, then a task.
  requestAnimationFrame(() => setTimeout(buildRest));
})();
