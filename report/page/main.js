// One clock for drawing and plots.
(() => {
  const make = steplap.make, runs = steplap.data.runs, at = (id) => document.getElementById(id);
  const end = Math.max(...runs.map((r) => r.end));
  const titles = [...new Set(runs.map((r) => r.summary.model.title || r.name))];
  at('title').textContent = titles.length === 1 ? titles[0] : `${titles.length} runs compared`;
  at('subtitle').textContent = titles.length === 1 ? runs.map((r) => r.name).join(', ') : titles.join(' · ');
  at('footer').textContent = `Written by ${steplap.data.program}. Plots by dygraphs, © Dan Vanderkam and contributors, MIT licence (text at the end of this file's source).`;

  steplap.tables.trust(runs);
  steplap.tables.verdict(runs);
  steplap.tables.events(runs, (t) => show(t));
  steplap.tables.extremes(runs);
  steplap.tables.models(runs);

  // Each core once, however many runs share it; as an image, so that its style stays its own.
  const cores = new Map(runs.flatMap((run) => (run.drawing.cores || []).map((core) => [core.svg, core.name])));
  for (const [svg, name] of cores)
    at('cores').append(make('img', { src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`, alt: `Core ${name}: elevation, corner, section, book`, style: 'max-width:100%' }));

  // --- drawing -------------------------------------------------------------------------------------
  const scenes = runs.map((run) => new steplap.Scene(run));
  const largestForce = Math.max(...scenes.map((scene) => scene.ownLargestForce()));
  const insets = [];
  at('scenes').classList.toggle('few', runs.length > 1);
  scenes.forEach((scene, i) => {
    const box = make('div', { class: 'scene', 'data-run': runs[i].name });
    if (runs.length > 1) box.append(make('h3', {}, runs[i].name));
    box.append(scene.svg);
    scene.largestForce = largestForce;
    box.append(steplap.save.buttons({ SVG: () => steplap.save.svg(scene.svg, runs[i].name), PNG: () => steplap.save.png(scene.svg, runs[i].name) }));
    const names = [...scene.bodies.values()].map((b, k) => `${k + 1} ${b.label || b.name}`);
    if (names.length <= 40) box.append(make('p', { class: 'names' }, names.join(' · ')));
    at('scenes').append(box);
    for (const sheet of steplap.data.corners(runs[i]).slice(0, 8)) insets.push(new steplap.Inset(runs[i], scene, sheet));
  });
  if (insets.length) {
    const box = at('insets');
    runs.forEach((run) => {
      const own = insets.filter((inset) => inset.run === run);
      if (!own.length) return;
      const more = run.drawing.sheets.length - own.length;
      box.append(make('div', { style: 'flex-basis:100%' }, make('h3', {}, `Sheets at the joints${runs.length > 1 ? `, ${run.name}` : ''}`),
        make('p', { class: 'note' }, `Yoke sheet orange, limb sheet blue, the overlap that carries dark; true displacements, drawn ${own[0].caption}.${more > 0 ? ` ${more} more kinds of interface are not drawn.` : ''}`)), ...own.map((inset) => inset.box));
    });
  }
  const legend = ['Wedges and dots are contacts, filled while they press; arrows are forces, all to one scale. Hatched is what is solid.'];
  if (runs.some((run) => run.drawing.sheets.length)) legend.push('Limbs turn orange once their joint has slipped.');
  const undrawn = Math.max(...runs.map((run) => run.bodies_left_out || 0));
  if (undrawn) legend.push(`${undrawn} more bodies, and all elements, are not drawn: the page would be too slow.`);
  if (scenes.some((scene) => [...scene.bodies.values()].some((body) => body.isUnrecorded))) legend.push('Dashed bodies are drawn where they begin: their motion is not among the channels.');
  legend.push('Displacements are drawn against the reference pose, as seen from the body chosen. Closer: Ctrl and wheel, two fingers, or + and - on the picture; 0 or a double click shows all; drag to move.');
  at('legend').textContent = legend.join(' ');

  const speeds = [100, 10, 1, 1 / 2, 1 / 5, 1 / 10, 1 / 20, 1 / 50, 1 / 100, 1 / 1000];
  const wanted = end / 10;
  const usualSpeed = speeds.reduce((best, s) => (Math.abs(Math.log(s / wanted)) < Math.abs(Math.log(best / wanted)) ? s : best));
  for (const s of speeds) at('speed').append(make('option', { value: s }, s >= 1 ? `${s} ×` : `1/${Math.round(1 / s)}`));
  at('speed').value = String(usualSpeed);

  const standpoint = scenes[0].usualStandpoint();
  for (const name of ['ground', ...[...scenes[0].bodies.keys()].slice(0, 40)]) at('seen-from').append(make('option', { value: name }, name));
  at('seen-from').value = standpoint;
  const moving = [...scenes[0].bodies.values()].filter((b) => b.moves).map((b) => b.name);
  for (const [value, text] of [['', 'none'], ...(moving.length <= 100 ? [['*', 'all']] : []), ...moving.slice(0, 40).map((n) => [n, n])]) at('trails').append(make('option', { value }, text));
  const usual = Math.min(...scenes.map((s) => s.usualMagnification(standpoint)));
  const factors = [...new Set([1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, usual])].sort((a, b) => a - b);
  for (const f of factors) at('magnification').append(make('option', { value: f }, `${f} ×`));
  at('magnification').value = String(usual);

  // --- time ----------------------------------------------------------------------------------------
  let t = 0, last = null;
  const plots = new steplap.Plots(at('plot-grid'), (time) => show(time));
  const isPrinted = window.matchMedia('print');
  const fit = () => {
    if (isPrinted.matches) return;
    const tallest = Math.max(260, Math.min(0.62 * window.innerHeight, 900));
    steplap.Scene.fitAll(scenes, at('seen-from').value, Number(at('magnification').value), scenes.map((s) => Math.max(240, s.svg.parentNode.clientWidth)), tallest);
  };
  function show(time) {
    t = Math.min(Math.max(time, 0), end);
    at('time').value = String(t);
    at('now').textContent = `t = ${t.toFixed(4)} s`;
    for (const scene of scenes) scene.show(t);
    for (const inset of insets) inset.show(t);
    plots.show(t);
  }
  function setPlaying(isPlaying) {
    at('play').replaceChildren(steplap.icon(isPlaying ? 'pause' : 'play'), isPlaying ? ' Pause' : ' Play');
    at('play').setAttribute('aria-pressed', String(isPlaying));
    last = null;
    if (isPlaying && t >= end) show(0);
    if (isPlaying) requestAnimationFrame(frame);
  }
  const isPlaying = () => at('play').getAttribute('aria-pressed') === 'true';
  function frame(now) {
    if (!isPlaying()) return;
    if (last !== null) show(t + ((now - last) / 1000) * Number(at('speed').value));
    last = now;
    if (t >= end) setPlaying(false); else requestAnimationFrame(frame);
  }
  at('time').max = String(end);
  at('time').addEventListener('input', (event) => { setPlaying(false); show(Number(event.target.value)); });
  at('play').addEventListener('click', () => setPlaying(!isPlaying()));
  for (const id of ['magnification', 'seen-from']) at(id).addEventListener('change', () => { fit(); view.reset(); });
  at('values').addEventListener('change', (event) => { for (const s of scenes) s.withValues = event.target.checked; show(t); });
  at('trails').addEventListener('change', (event) => { for (const s of scenes) s.setTrails(event.target.value === '*' ? moving : [event.target.value]); show(t); });
  const view = new steplap.View(scenes, () => show(t));
  for (const [id, icon, action] of [['closer', 'closer', () => view.zoomAt(scenes[0], 1.5)], ['further', 'further', () => view.zoomAt(scenes[0], 1 / 1.5)], ['whole', 'whole', () => view.reset()]]) {
    at(id).append(steplap.icon(icon));
    at(id).addEventListener('click', action);
  }
  let seenWidth = document.documentElement.clientWidth;
  window.addEventListener('resize', () => {
    if (isPrinted.matches || document.documentElement.clientWidth === seenWidth) return;
    seenWidth = document.documentElement.clientWidth;
    fit(); show(t);
  });
  document.addEventListener('keydown', (event) => {
    if (/^(INPUT|SELECT|BUTTON|SUMMARY|TEXTAREA)$/.test(event.target.tagName) || event.ctrlKey || event.altKey || event.metaKey) return;
    const step = (event.shiftKey ? 0.05 : 0.005) * end;
    const moves = { ArrowRight: t + step, ArrowLeft: t - step, Home: 0, End: end };
    if (event.key === ' ') setPlaying(!isPlaying());
    else if (event.key in moves) { setPlaying(false); show(moves[event.key]); }
    else return;
    event.preventDefault();
  });

  // --- plots ---------------------------------------------------------------------------------------
  at('layout-control').hidden = runs.length < 2;
  at('layout').addEventListener('change', (event) => { plots.layout = event.target.value; plots.build(); show(t); });
  at('zoom-out').addEventListener('click', () => plots.zoomOut());
  for (const [value, text] of [['', 'choose a channel'], ...[...new Set(runs.flatMap((r) => [...r.channels.keys()]))].map((n) => [n, n])])
    at('add-channel').append(make('option', { value, title: runs.map((r) => r.meaning(value)).find(Boolean) || '' }, text));
  at('add-channel').addEventListener('change', (event) => { if (event.target.value) plots.add(event.target.value); event.target.value = ''; });
  const left = runs.reduce((sum, r) => sum + r.channels_left_out, 0), isThinned = runs.some((r) => r.is_thinned);
  if (left || isThinned) at('event-key').append(` ${isThinned ? 'Curves are thinned for this page, their peaks are kept.' : ''} ${left ? `${left} channels are left out.` : ''} All samples: trajectory.csv.`);
  window.addEventListener('beforeprint', () => plots.preparePrint());
  setPlaying(false);
  fit();
  plots.build();
  show(0);
  steplap.page = { scenes, insets, plots, view, show, time: () => t };
  document.body.setAttribute('data-ready', 'true');
})();
