// Animates one vibration mode at a time: rest + amplitude Re(shape exp(i phase)). The scene's time is in periods.
(() => {
  const { apply, minus, length } = steplap.geometry;
  const make = steplap.make, at = (id) => document.getElementById(id), { plain } = steplap.data;
  const run = steplap.data.runs[0], found = steplap.data.modes, modes = found.modes;
  const cycle = 1.6; // duration of a period on the screen, s
  const memory = 3; // a motion without oscillation is shown until its amplitude has changed by a factor exp(3)
  let mode = modes[0], amplitude = 0, phase = 0, last = null;

  const oscillates = (m) => m.imaginary !== 0;
  function kindOf(m) {
    const grows = m.real > 1e-9 * Math.hypot(m.real, m.imaginary);
    if (oscillates(m))
      return grows ? 'vibrates and grows: not stable' : m.damping_ratio < 1e-9 ? 'vibrates without damping' : 'vibrates and decays';
    return grows ? 'runs away: not stable' : 'creeps back without vibrating';
  }
  const hertz = (f) => `${plain(f, 5)} Hz`;
  const damping = (m) =>
    (oscillates(m) ? `${plain(Math.abs(m.damping_ratio) < 1e-9 ? 0 : 100 * m.damping_ratio, 4)} %` : `${plain(m.real, 4)} /s`);

  // Returns the complex factor of the mode after t periods.
  function factor(t) {
    if (!oscillates(mode)) return [Math.exp(mode.real > 0 ? memory * (t - 1) : -memory * t), 0];
    const size = at('decaying').checked ? Math.exp((2 * Math.PI * t * mode.real) / mode.imaginary) : 1;
    return [size * Math.cos(2 * Math.PI * t), size * Math.sin(2 * Math.PI * t)];
  }
  run.poseOf = (name, t) => {
    const rest = found.rest[name];
    if (!rest) return null;
    const shape = mode && mode.shape[name];
    if (!shape) return rest;
    const [c, s] = factor(t);
    return rest.map((v, i) => v + amplitude * (c * shape[i][0] - s * shape[i][1]));
  };

  at('title').textContent = found.title || run.name;
  at('footer').textContent = `Written by ${steplap.data.program}.`;
  const scene = new steplap.Scene(run), box = make('div', { class: 'scene', 'data-run': run.name });
  box.append(scene.svg,
    steplap.save.buttons({ SVG: () => steplap.save.svg(scene.svg, pictureName()), PNG: () => steplap.save.png(scene.svg, pictureName()) }));
  at('scenes').append(box);
  const pictureName = () => `${run.name}_mode_${modes.indexOf(mode) + 1}`;

  const show = (t) => {
    phase = t;
    scene.show(t);
  };
  function fit() {
    // The amplitude gives a largest displacement of 1/20 of the picture.
    amplitude = 1;
    let furthest = 0;
    for (let k = 0; k < 8; ++k)
      for (const body of scene.bodies.values()) {
        const rest = found.rest[body.name];
        if (!mode || !rest) continue;
        const small = 1e-3, pose = body.poseAt(k / 8).map((v, i) => rest[i] + small * (v - rest[i]));
        for (const p of body.points) furthest = Math.max(furthest, length(minus(apply(pose, p), apply(rest, p))) / small);
      }
    amplitude = furthest > 0 ? (0.06 * scene.size * Number(at('amplitude').value)) / furthest : 0;
    steplap.Scene.fitAll([scene], 'ground', 1, [Math.max(240, box.clientWidth)], Math.max(260, Math.min(0.62 * window.innerHeight, 900)));
  }
  const view = new steplap.View([scene], () => show(phase));
  function choose(k) {
    mode = modes[k];
    at('mode').value = String(k);
    const speed = oscillates(mode) ? 1 / (cycle * mode.frequency) : memory / (cycle * Math.abs(mode.real));
    at('shown').textContent = `Mode ${k + 1}: ${hertz(mode.natural_frequency)}${
      oscillates(mode) ? `, damped ${hertz(mode.frequency)}, damping ${damping(mode)}` : `, ${damping(mode)}`}; ${kindOf(mode)}. Shown ${
      speed < 1 ? `${plain(1 / speed, 3)} times slower` : `${plain(speed, 3)} times faster`} than it is.`;
    for (const row of document.querySelectorAll('#modes-table tbody tr')) row.classList.toggle('chosen', Number(row.dataset.mode) === k);
    fit();
    show(0);
  }

  function table() {
    const heads = ['mode', 'frequency', 'damped', 'damping', 'kind', 'what moves most (turning as at the radius of gyration)'];
    const rows = modes.map((m, k) => {
      const button = make('button', { type: 'button', class: 'event-time' }, String(k + 1));
      button.addEventListener('click', () => choose(k));
      const cells = [hertz(m.natural_frequency), oscillates(m) ? hertz(m.frequency) : '–', damping(m), kindOf(m), m.moves_most];
      return make('tr', { 'data-mode': k }, make('th', { scope: 'row' }, button),
        ...cells.map((c, i) => make('td', i < 3 ? { class: 'number' } : {}, c)));
    });
    return make('table', {},
      make('thead', {},
        make('tr', {}, ...heads.map((h, i) => make('th', { scope: 'col', ...(i > 0 && i < 4 ? { class: 'number' } : {}) }, h)))),
      make('tbody', {}, ...rows));
  }
  if (found.rigid_motions)
    at('remarks').append(make('p', {},
      `${found.rigid_motions} coordinate${found.rigid_motions > 1 ? 's move' : ' moves'} freely: nothing holds the scene along ${
        found.rigid_motions > 1 ? 'them' : 'it'}.`));
  for (const remark of found.remarks) at('remarks').append(make('p', { class: 'note' }, remark));

  const isPlaying = () => at('play').getAttribute('aria-pressed') === 'true';
  function setPlaying(is) {
    at('play').replaceChildren(steplap.icon(is ? 'pause' : 'play'), is ? ' Pause' : ' Play');
    at('play').setAttribute('aria-pressed', String(is));
    last = null;
    if (is) requestAnimationFrame(frame);
  }
  function frame(now) {
    if (!isPlaying()) return;
    const periods = oscillates(mode) ? (at('decaying').checked ? 6 : 1) : 1.25;
    if (last !== null) show((phase + (now - last) / 1000 / cycle) % periods);
    last = now;
    requestAnimationFrame(frame);
  }
  for (const [id, action] of [
         ['closer', () => view.zoomAt(scene, 1.5)], ['further', () => view.zoomAt(scene, 1 / 1.5)], ['whole', () => view.reset()]]) {
    at(id).append(steplap.icon(id));
    at(id).addEventListener('click', action);
  }
  modes.forEach((m, k) => at('mode').append(make('option', { value: k }, `${k + 1}: ${hertz(m.natural_frequency)}`)));
  at('mode').addEventListener('change', (event) => choose(Number(event.target.value)));
  at('amplitude').addEventListener('input', () => {
    fit();
    show(phase);
  });
  at('decaying').addEventListener('change', () => show(phase));
  at('play').addEventListener('click', () => setPlaying(!isPlaying()));
  let seenWidth = document.documentElement.clientWidth;
  window.addEventListener('resize', () => {
    if (document.documentElement.clientWidth === seenWidth) return;
    seenWidth = document.documentElement.clientWidth;
    fit();
    show(phase);
  });
  at('modes-table').append(table());
  setPlaying(false);
  if (modes.length) {
    choose(0);
    setPlaying(!window.matchMedia('(prefers-reduced-motion: reduce)').matches);
  } else {
    at('play').disabled = true;
    at('shown').textContent = 'Nothing vibrates: no coordinate is both free and held.';
    fit();
    show(0);
  }
  steplap.page = { scene, view, show, choose, setPlaying, phase: () => phase };
  document.body.setAttribute('data-ready', 'true');
})();
