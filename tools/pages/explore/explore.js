// The page: sliders request runs, and the answers are drawn next to the old state.
(() => {
  const make = steplap.make, at = (id) => document.getElementById(id);
  const settleAfter = 250; // ms without a change after which errors are estimated and slow drawings are updated
  let version = 0, models = [], model = 0, before = null, now = null, isKept = false, t = 0, end = 1, isUntouched = true, settled = null;
  const scenes = [], latencies = [];
  let view = null, plots = null, timeline = null;

  // --- errors and progress --------------------------------------------------------------------------------
  const troubles = { file: [], run: [], server: [] };
  function showTroubles() {
    const place = (e) => [e.file, e.line || '', e.line && e.column ? e.column : ''].filter((v) => v !== '').join(':');
    const lines = [...troubles.server, ...troubles.file, ...troubles.run].map(
      (e) => make('p', {}, make('span', { class: 'place' }, place(e)), place(e) ? ': ' : '', e.message));
    at('troubles').replaceChildren(...lines);
    at('troubles').hidden = !lines.length;
    at('overview').classList.toggle('stale', troubles.run.length > 0 || troubles.file.length > 0);
    if (troubles.file.length)
      at('troubles')
        .append(
          make('p', { class: 'note' }, 'The file is read again when it is saved. What is shown below is the last state without errors.'));
    else if (troubles.run.length)
      at('troubles').append(make('p', { class: 'note' }, 'There is no run with these values. What is shown below is the last one.'));
  }

  // --- requests ---------------------------------------------------------------------------------------------
  function onSilence() {
    troubles.server = [{ message: 'steplap does not answer: it has ended, or is being stopped.' }];
    showTroubles();
  }
  const answers = new steplap.Answers(onAnswer, onSilence);
  const sliders = new steplap.Sliders(at('sliders'), { search: at('search'), found: at('found'), onChange: onChange });
  const request = (isSettled) => ({ model, values: sliders.changed(), is_settled: isSettled });
  function onChange() {
    isUntouched = false;
    answers.want(request(false));
    tellWaiting();
    settleLater();
    showMapHere();
  }
  // Announces a slow run, so that the previous picture is not mistaken for its result.
  let waiting = null;
  function tellWaiting() {
    clearTimeout(waiting);
    waiting = setTimeout(() => {
      if (!answers.isIdle) at('pace').textContent = 'computing …';
    }, 300);
  }
  function settleLater() {
    clearTimeout(settled);
    settled = setTimeout(() => {
      if (answers.isIdle) {
        answers.want(request(true));
        restartMap();
      } else settleLater();
    }, settleAfter);
  }
  const runOf = (answer, name) => {
    const run = new steplap.data.Run(answer.data.runs[0]);
    run.name = name;
    return run;
  };
  function onAnswer(answer, asked) {
    if (asked.request.model !== model) return;
    // A run of a newer version of the file cannot be compared with the old state. Both are requested again, if they were not already.
    if (!answer.errors && !isKept && answer.version !== versionOfOld) return;
    clearTimeout(waiting);
    at('pace').textContent = '';
    troubles.server = [];
    troubles.run = answer.errors || [];
    showTroubles();
    if (answer.errors) return;
    const old = now;
    now = runOf(answer, 'new');
    if (!asked.request.is_settled) Object.assign(now.summary.overview.trust, { text: 'Errors are estimated as soon as the values rest.' });
    if (!before) before = runOf(answer, 'old');
    const isSettled = asked.request.is_settled;
    draw(old, isSettled);
    if (!isSettled) notePace(asked.since);
  }
  // Measures the time from the user's action until the browser has painted the result.
  function notePace(since) {
    requestAnimationFrame(() => {
      const channel = new MessageChannel();
      channel.port1.onmessage = () => {
        channel.port1.close();
        latencies.push(performance.now() - since);
        if (latencies.length > 5000) latencies.shift();
        const last = latencies[latencies.length - 1];
        at('pace').textContent = `${last < 1000 ? `${Math.round(last)} ms` : `${(last / 1000).toFixed(1)} s`} to the picture`;
      };
      channel.port2.postMessage(0);
    });
  }

  // --- old and new state ------------------------------------------------------------------------------------
  let versionOfOld = 0,
      asksOfOld = 0; // version of the file for which the old state was last requested; number of these requests in progress
  async function askOld() {
    ++asksOfOld;
    try {
      await takeOld();
    } finally {
      --asksOfOld;
    }
  }
  async function takeOld() {
    const asked = model, known = version,
          answer = await answers.post('run', { model, values: {}, is_settled: true, page: `${answers.page} old` });
    if (asked !== model || answer.is_superseded) return;
    versionOfOld = answer.errors ? known : answer.version;
    if (answer.errors) {
      troubles.run = answer.errors;
      showTroubles();
      return;
    }
    if (!isKept) before = runOf(answer, 'old');
    if (!Object.keys(sliders.changed()).length) {
      const old = now;
      now = runOf(answer, 'new');
      draw(old, true);
    } else answers.want(request(true));
  }
  function keep() {
    isKept = !isKept;
    at('keep').setAttribute('aria-pressed', String(isKept));
    if (!isKept) {
      askOld().catch(onSilence);
      return;
    }
    before = Object.assign(Object.create(Object.getPrototypeOf(now)), now, { name: 'old' });
    draw(now, true);
  }
  function sceneOf(run, k) {
    const scene = new steplap.Scene(run), { moved, story } = steplap.overview.of(run);
    scene.setMoved(moved, story);
    scene.view = view ? { zoom: view.zoom, shift: [...view.shift] } : scene.view;
    let box = at('scenes').children[k];
    if (!box) at('scenes').append(box = make('div', { class: 'scene' }));
    box.setAttribute('data-run', run.name);
    box.replaceChildren(make('h3', {}, run.name === 'old' ? 'Old' : 'New'), scene.svg);
    if (view) view.listen(scene);
    return scene;
  }
  // run that was drawn as the new state before
  let drawnBefore = null;
  function draw(old, isSettled) {
    const runs = [before, now], isWhole = drawnBefore !== before;
    drawnBefore = before;
    steplap.data.runs = runs;
    end = Math.max(...runs.map((r) => r.end));
    if (t > end) t = end;
    const like = scenes[0] && scenes[0].run === before && scenes[1] && scenes[1].width ? scenes[1] : null;
    for (const [k, run] of runs.entries())
      if (!scenes[k] || scenes[k].run !== run) scenes[k] = sceneOf(run, k);
    const largestForce = Math.max(...scenes.map((scene) => scene.ownLargestForce()));
    for (const scene of scenes) scene.largestForce = largestForce;
    if (!view) begin();
    steplap.verdict.buildCards(runs);
    for (const id of ['limits', 'story']) at(id).replaceChildren();
    steplap.bars.build(at('limits'), runs, jump);
    steplap.story.build(at('story'), runs, go);
    at('time').max = String(end);
    at('worst').hidden = steplap.overview.worstOf(runs) === null;
    // The view of the new machine is kept while a slider is dragged; afterwards both machines are fitted to the picture.
    if (isSettled || !like) fit();
    else {
      scenes[1].fitLike(like);
      buildTimeline();
    }
    if (isWhole) plots.setRuns(null, now);
    else plots.setRuns(old, now);
    if (isSettled && plots.isOutdated) plots.renew();
    if (isSettled || !like) show(t);
    else {
      scenes[1].show(t);
      timeline.show(t);
      tellTime();
    }
    document.body.setAttribute('data-ready', 'true');
  }
  function begin() {
    steplap.pictureChoices(scenes, at('magnification'), at('seen-from'));
    if (!at('layers').firstChild) steplap.layers.build(at('layers'), at('scenes'));
    const speeds = [100, 10, 1, 1 / 2, 1 / 5, 1 / 10, 1 / 20, 1 / 50, 1 / 100, 1 / 1000], wanted = end / 10;
    at('speed').replaceChildren(...speeds.map((s) => make('option', { value: s }, s >= 1 ? `${s} ×` : `1/${Math.round(1 / s)}`)));
    at('speed').value = String(speeds.reduce((best, s) => (Math.abs(Math.log(s / wanted)) < Math.abs(Math.log(best / wanted)) ? s : best)));
    view = new steplap.View(scenes, () => show(t));
    if (plots) plots.end();
    plots = new steplap.LivePlots(at('plot-grid'), go);
    t = steplap.overview.worstOf([before, now]) ?? 0;
  }
  function fit() {
    const widths = scenes.map((s) => Math.max(220, s.svg.parentNode.clientWidth));
    steplap.Scene.fitAll(scenes, at('seen-from').value, steplap.magnificationOf(at('magnification')), widths,
      Math.max(220, Math.min(0.42 * window.innerHeight, 520)));
    buildTimeline();
  }
  function buildTimeline() {
    // A new element, because the listeners of the old one are removed with it.
    const lanes = make('div', { id: 'lanes' });
    at('lanes').replaceWith(lanes);
    timeline = new steplap.Timeline(
      [before, now], end, { causes: scenes.map((scene) => scene.causes()), lanes, axis: at('time-axis'), slider: at('time'), onTime: go });
    timeline.build();
  }

  // --- time ---------------------------------------------------------------------------------------------------
  let lastFrame = null;
  const isPlaying = () => at('play').getAttribute('aria-pressed') === 'true';
  const tellTime = () => { at('now').textContent = `t = ${steplap.numbers.instant(t, end)}`; };
  function show(time) {
    t = Math.min(Math.max(time, 0), end);
    tellTime();
    for (const scene of scenes) scene.show(t);
    timeline.show(t);
    plots.show(t);
  }
  function go(time) {
    isUntouched = false;
    setPlaying(false);
    show(time);
  }
  function setPlaying(wanted) {
    at('play').replaceChildren(steplap.icon(wanted ? 'pause' : 'play'), wanted ? ' Pause' : ' Play');
    at('play').setAttribute('aria-pressed', String(wanted));
    lastFrame = null;
    if (wanted && (t >= end || isUntouched)) show(0);
    if (wanted) {
      isUntouched = false;
      requestAnimationFrame(frame);
    }
  }
  function frame(moment) {
    if (!isPlaying() || !now) return;
    if (lastFrame !== null) show(t + ((moment - lastFrame) / 1000) * Number(at('speed').value));
    lastFrame = moment;
    if (t >= end) setPlaying(false);
    else requestAnimationFrame(frame);
  }
  function jump(utilisation, run) {
    if (utilisation.at !== null && utilisation.at !== undefined) go(utilisation.at);
    const plot = utilisation.channel ? plots.figureWith(utilisation.channel, run) : null;
    if (!plot) return;
    for (const p of plots.plots) p.box.classList.toggle('chosen', p === plot);
    plot.box.scrollIntoView({ block: 'center' });
  }
  function listenToKeys() {
    document.addEventListener('keydown', (event) => {
      const isSlider = event.target === at('time');
      if ((!isSlider && /^(INPUT|SELECT|BUTTON|SUMMARY|TEXTAREA|CANVAS)$/.test(event.target.tagName)) || event.ctrlKey || event.altKey ||
        event.metaKey)
        return;
      const step = (event.shiftKey ? 0.05 : 0.005) * end, moves = { ArrowRight: t + step, ArrowLeft: t - step, Home: 0, End: end };
      if (!now) return;
      if (event.key === ' ') setPlaying(!isPlaying());
      else if (event.key in moves) go(moves[event.key]);
      else return;
      event.preventDefault();
    });
  }

  // --- the map --------------------------------------------------------------------------------------------------
  const map = new steplap.ValueMap({
    canvas: at('map'),
    text: at('map-text'),
    what: at('map-what'),
    onChoose: chooseOnMap,
    ask: async (x, y, cells) => {
      const values = sliders.changed();
      if (!answers.isIdle) return { cells: [] }; // a run has priority over the map
      try {
        return await answers.post('cells', { model, values, x, y, cells });
      } catch {
        return null;
      }
    }
  });
  const isMapping = () => at('map-start').getAttribute('aria-pressed') === 'true';
  // The map is restarted if any other value changes.
  let mappedWith = '';
  const othersThanAxes = () => JSON.stringify([
    model, version, at('map-x').value, at('map-y').value,
    Object.entries(sliders.changed()).filter(([path]) => path !== at('map-x').value && path !== at('map-y').value)
  ]);
  function axisOf(path) {
    const slider = sliders.given.get(path), row = sliders.rows.get(path);
    return {
      path,
      label: steplap.Sliders.label(slider),
      unit: slider.unit,
      least: row ? Number(row.range.min) : slider.least,
      most: row ? Number(row.range.max) : slider.most,
      isWhole: slider.is_whole
    };
  }
  function restartMap() {
    if (!isMapping() || othersThanAxes() === mappedWith) return;
    mappedWith = othersThanAxes();
    map.start([axisOf(at('map-x').value), axisOf(at('map-y').value)]);
    showMapHere();
  }
  function showMapHere() {
    if (at('map-x').value && at('map-y').value) map.setHere([at('map-x').value, at('map-y').value].map((path) => sliders.value(path)));
  }
  function chooseOnMap(x, y) {
    for (const [id, value] of [['map-x', x], ['map-y', y]]) sliders.put(at(id).value, value);
  }
  function offerAxes() {
    const options = () => sliders.shown.map((path) => make('option', { value: path }, steplap.Sliders.label(sliders.given.get(path))));
    for (const [id, k] of [['map-x', 0], ['map-y', 1]]) {
      const had = at(id).value;
      at(id).replaceChildren(...options());
      at(id).value = sliders.shown.includes(had) ? had : sliders.shown[Math.min(k, sliders.shown.length - 1)] || '';
    }
    at('map-panel').hidden = sliders.shown.length < 2;
  }
  function toggleMap() {
    const wanted = !isMapping();
    at('map-start').setAttribute('aria-pressed', String(wanted));
    at('map-start').textContent = wanted ? 'Stop' : 'Fill in';
    mappedWith = '';
    if (wanted && at('map-x').value !== at('map-y').value) restartMap();
    else map.stop();
    if (wanted && at('map-x').value === at('map-y').value) {
      at('map-text').textContent = 'Choose two different values.';
      toggleMap();
    }
  }

  // --- saving, reports --------------------------------------------------------------------------------------------
  async function save(event) {
    event.preventDefault();
    at('saved').textContent = '';
    try {
      const answer = await answers.post('save', { model, values: sliders.changed(), name: at('save-name').value.trim() });
      at('saved').textContent = answer.errors ? answer.errors.map((e) => e.message).join(' ')
                                              : `Saved: ${answer.file}. Run it with: steplap simulate ${answer.file}`;
    } catch (error) {
      at('saved').textContent = `Not saved: ${error.message}`;
    }
  }
  const openReport = () =>
    window.open(`report?model=${model}&values=${encodeURIComponent(JSON.stringify(sliders.changed()))}`, '_blank', 'noopener');

  // --- models and their files ---------------------------------------------------------------------------------------
  function showModel() {
    const one = models[model];
    at('title').textContent = one.title || one.name;
    at('subtitle').textContent = one.path;
    document.title = `steplap explore: ${one.name}`;
    if (!at('save-name').value || at('save-name').dataset.of !== one.name) {
      at('save-name').value = `${one.name}_changed.toml`;
      at('save-name').dataset.of = one.name;
    }
    troubles.file = one.errors;
    showTroubles();
    sliders.set(one.sliders);
    offerAxes();
  }
  // Waits for new versions of the files. Draws the machine of the new version, or shows its errors.
  async function follow() {
    for (;;) {
      try {
        const state = await answers.state(version);
        if (troubles.server.length) {
          troubles.server = [];
          showTroubles();
        }
        if (state.version === version) continue;
        const isFirst = version === 0;
        version = state.version;
        models = state.models;
        if (isFirst) {
          at('footer').textContent = `Served by ${state.program} on this computer only, until it is ended with Ctrl-C. ` +
            'Plots by dygraphs, © Dan Vanderkam and contributors, MIT licence.';
          at('model').replaceChildren(...models.map((m, k) => make('option', { value: k }, m.name)));
          at('model-control').hidden = models.length < 2;
        }
        showModel();
        if (!models[model].errors.length) await askOld();
        else versionOfOld = version; // the last valid machine stays visible
      } catch {
        onSilence();
        await new Promise((resolve) => setTimeout(resolve, 2000));
      }
    }
  }
  function chooseModel() {
    model = Number(at('model').value);
    before = now = null;
    scenes.length = 0;
    at('scenes').replaceChildren();
    view = null;
    isKept = false;
    at('keep').setAttribute('aria-pressed', 'false');
    sliders.values.clear();
    sliders.shown = [];
    map.stop();
    at('map-start').setAttribute('aria-pressed', 'false');
    at('map-start').textContent = 'Fill in';
    showModel();
    askOld().catch(onSilence);
  }

  for (const [id, action] of [['closer', () => view.zoomAt(scenes[0], 1.5)], ['further', () => view.zoomAt(scenes[0], 1 / 1.5)],
         ['whole', () => view.reset()]]) {
    at(id).append(steplap.icon(id));
    at(id).addEventListener('click', action);
  }
  for (const id of ['magnification', 'seen-from'])
    at(id).addEventListener('change', () => {
      fit();
      view.reset();
    });
  at('time').addEventListener('input', (event) => go(Number(event.target.value)));
  at('play').addEventListener('click', () => setPlaying(!isPlaying()));
  at('worst').addEventListener('click', () => go(steplap.overview.worstOf([before, now])));
  at('reset').addEventListener('click', () => {
    sliders.reset();
    onChange();
  });
  at('keep').addEventListener('click', keep);
  at('report').addEventListener('click', openReport);
  at('save-form').addEventListener('submit', save);
  at('model').addEventListener('change', chooseModel);
  at('map-start').addEventListener('click', toggleMap);
  for (const id of ['map-x', 'map-y'])
    at(id).addEventListener('change', () => {
      mappedWith = '';
      restartMap();
      showMapHere();
    });
  sliders.onShown = offerAxes;
  window.addEventListener('resize', () => {
    if (now) {
      fit();
      show(t);
    }
  });
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    if (plots) {
      plots.build();
      show(t);
    }
  });
  listenToKeys();
  setPlaying(false);
  steplap.onPaper = (action) => action();
  steplap.page = {
    answers,
    isIdle: () => answers.isIdle && !asksOfOld,
    sliders,
    map,
    latencies,
    show: go,
    time: () => t,
    scenes,
    runs: () => [before, now],
    version: () => version,
    get plots() { return plots; },
    get view() { return view; }
  };
  follow();
})();
