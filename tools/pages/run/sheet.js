// The sheet to be signed, one page of A4: heading, verdict, parts, space for two signatures. Runs, load cases, static proofs and
// assessments provide their parts; this builder lays them out and shortens them until they fit the page.
steplap.sheet = (() => {
  const make = steplap.make;
  // Size of A4 without the margins of page.css, mm. The height is reduced by 3 mm, because printing rounds differently from the screen.
  const width = 186, height = 270;

  function short(text, limit) {
    const letters = [...String(text)]; // splits at code points, so that no surrogate pair is cut
    return letters.length > limit ? `${letters.slice(0, limit - 1).join('')}…` : letters.join('');
  }
  const part = (title, ...content) => make('div', {}, make('h2', {}, title), ...content);
  // Place of the lines that do not fit: an assessment shows them after the sheet; for a single sheet they are in the report.
  const elsewhere = document.body.classList.contains('assessment') ? 'on the sheets behind' : 'in the report';
  const rest = (all, kept, what) => (all > kept ? [make('p', { class: 'more' }, `${all - kept} more ${what} ${elsewhere}.`)] : []);
  const list = (texts) => make('ul', {}, ...texts.map((t) => make('li', {}, t)));
  const bullets = (texts, kept, limit, what) => [list(texts.slice(0, kept).map((t) => short(t, limit))), ...rest(texts.length, kept, what)];
  // Returns the shortened text, or a blank line to be filled in by hand.
  const orBlank = (text, limit) => (text ? short(text, limit) : make('span', { class: 'blank' }));
  const named = (file, sha256) => `${file} (SHA-256 ${String(sha256 || 'unknown').slice(0, 16)}…)`;

  // Draws the machine of a run at time t. `seenFrom`: reference body, '' for the usual one.
  function drawing(run, t, columns = 1, seenFrom = '') {
    const scene = new steplap.Scene(run), { moved, story } = steplap.overview.of(run);
    scene.setMoved(moved, story);
    const room = 703 / columns, standpoint = seenFrom || scene.usualStandpoint(); // width, 186 mm in CSS pixels
    steplap.Scene.fitAll([scene], standpoint, 'usual', [room], 0.34 * 703);
    scene.show(t);
    return make('div', { class: 'drawing' }, scene.svg);
  }
  const verdictLine = ({ word, verdict, reason }) => make('div', { class: 'verdict-line' },
    ...(word ? [make('span', { class: `badge ${verdict}` }, word)] : []), make('span', { class: 'reason' }, reason));
  const signature = (who) => make('div', {}, make('p', { class: 'who' }, who),
    ...['Name', 'Date', 'Place'].map((what) => make('p', {}, what)), make('p', { class: 'long' }, 'Signature'));
  const signatures = (who) => make('div', { class: 'signatures' }, ...who.map(signature));

  // Fills the sheet with `content`: { title, about, word, verdict, reason, parts, signed }.
  function fill(place, size, content) {
    place.style.fontSize = `${size}pt`;
    place.replaceChildren(
      make('h1', {}, content.title), make('p', {}, content.about), verdictLine(content), ...content.parts, signatures(content.signed));
    for (const t of place.querySelectorAll('table')) t.classList.remove('cards'); // a sheet does not use the layout for narrow screens
  }
  // Lays out contentOf(keep), reduced until it fits the page, and returns the `keep` that was used. `most`: what is kept if there is room,
  // by name; its `size` is the font size in points. `cuts`: [name, reduced value] in the order in which they are applied. `dear`: name
  // whose cuts are undone first if there is room.
  function fit(contentOf, { most, cuts, dear = '' }) {
    const place = document.getElementById('sheet');
    place.classList.add('measured');
    const measure = () => (width * place.getBoundingClientRect().height) / place.getBoundingClientRect().width;
    const isFitting = (keep) => {
      fill(place, keep.size, contentOf(keep));
      return measure() <= height;
    };
    // a later entry replaces an earlier one of the same name
    const cutBy = (count) => ({...most, ...Object.fromEntries(cuts.slice(0, count)) });
    // Finds the smallest sufficient number of cuts by bisection.
    let few = 0, many = cuts.length;
    while (few < many) {
      const middle = (few + many) >> 1;
      if (isFitting(cutBy(middle))) many = middle;
      else few = middle + 1;
    }
    let keep = cutBy(few);
    // Undoes cuts that turn out to be unnecessary, starting with the last.
    const undone = cuts.slice(0, few).map(([what], i) => [what, cutBy(i)[what]]).reverse();
    for (const [what, before] of [...undone.filter(([what]) => what === dear), ...undone.filter(([what]) => what !== dear)])
      if (isFitting({...keep, [what]: before })) keep = {...keep, [what]: before };
    isFitting(keep);
    place.dataset.height = measure().toFixed(1);
    place.classList.remove('measured');
    return keep;
  }
  // Returns cuts that reduce the font size in steps of 0.25 pt. If the smallest size is too large, the sheet continues on a second page.
  const smaller = (from, to) => Array.from({ length: Math.round((from - to) / 0.25) }, (_, k) => ['size', from - 0.25 * (k + 1)]);
  return { short, part, rest, list, bullets, orBlank, named, drawing, fit, smaller };
})();
