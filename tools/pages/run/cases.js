// The sheet of load cases: drawing, cases with their sources, the matrix of limits, room for two signatures.
(() => {
  const make = steplap.make, at = (id) => document.getElementById(id), { quantity } = steplap.data, { table } = steplap.tables, { percent } = steplap.numbers;
  const { load_cases: found, program } = JSON.parse(at('data').textContent), { model, cases } = found;
  const smallest = 4.5, usual = 8.5; // pt
  const free = 270; // mm of height: A4 without the margins of page.css, less 3 mm, because paper rounds otherwise than the screen

  const limitOf = (one, name) => one.limits.findIndex((l) => l.limit === name);
  // A limit that has no utilisation, such as an event, shows its outcome.
  function used(one, name) {
    const limit = one.limits[limitOf(one, name)];
    if (!limit) return '–';
    if (limit.utilisation === null) return { hold: 'met', open: 'open' }[limit.outcome] || 'not met';
    return `${percent(limit.utilisation)}${limit.outcome === 'open' ? ' ?' : ''}`;
  }
  const marked = (text, outcome) => ({ text, class: outcome === 'hold' ? 'met' : 'beyond' });
  const word = (text) => ({ text, class: 'word' }); // is not broken
  function caseRow(one, k) {
    const governing = one.governing_limit;
    return [String(k + 1), one.name, word(one.plane || '–'), one.source, marked(one.verdict, one.verdict), governing || '–', governing ? used(one, governing) : '–'];
  }
  function limitRow({ limit, governing_case: governing }) {
    const worst = cases.find((one) => one.name === governing), i = limitOf(worst, limit), c = worst.judgement.criteria[i], { margin } = worst.limits[i];
    return [`${limit} (${c.criterion}${c.reason ? `; ${c.reason}` : ''})`, ...cases.map((one) => { const own = one.limits[limitOf(one, limit)]; return own ? marked(used(one, limit), own.outcome) : '–'; }),
      String(cases.indexOf(worst) + 1), quantity(c.value, c.unit), quantity(margin, c.unit), c.error === null ? '–' : quantity(c.error, c.unit, 2)];
  }
  const signature = (who) => make('div', {}, make('p', { class: 'who' }, who), ...['Name', 'Date', 'Signature'].map((what) => make('p', {}, what)));

  at('title').textContent = `Load cases: ${model.title || model.name}`;
  at('model').textContent = `${model.inputs.map((file) => `${file.file} (SHA-256 ${file.sha256.slice(0, 16)}…)`).join('; ')}. Made by ${program}.`;
  at('verdict').textContent = found.verdict.toUpperCase();
  at('verdict').classList.add(found.verdict);
  at('reason').textContent = found.reason;
  at('cases').append(table(['no.', 'case', 'plane', 'source', 'verdict', 'governing limit', 'used'], cases.map(caseRow), [6]));
  const numbers = cases.map((_, k) => k + 1);
  at('limits').append(table(['limit', ...numbers.map(String), 'governs', 'value', 'margin', 'error'], found.limits.map(limitRow), [...numbers, ...[1, 2, 3, 4].map((k) => cases.length + k)]));
  at('values').append(...cases.map((one, k) => make('p', {}, `${k + 1}: ${one.overrides.join('; ') || 'those of the model'}${one.verdict === 'hold' ? '' : `. ${one.reason}`}`)));
  at('signatures').append(signature('Prepared by'), signature('Approved by'));

  const run = steplap.data.runs[0];
  run.poseOf = () => null; // every body stays in its reference pose
  const scene = new steplap.Scene(run);
  at('drawing').append(scene.svg);
  // Letters as large as one page allows. Below the smallest size the sheet continues on a second page; nothing is left out.
  const height = () => (186 * at('sheet').getBoundingClientRect().height) / at('sheet').getBoundingClientRect().width;
  steplap.Scene.fitAll([scene], 'ground', 1, [at('drawing').clientWidth], 0.34 * at('drawing').clientWidth);
  scene.show(0);
  for (let size = usual; size >= smallest; size -= 0.25) {
    at('sheet').style.fontSize = `${size}pt`;
    if (height() <= free) break;
  }
  document.body.setAttribute('data-ready', 'true');
})();
